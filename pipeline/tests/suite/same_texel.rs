//! One texel for all lanes is what each lane would fetch: bits, counters, and what an
//! observer is told of it.

use std::sync::Arc;

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each4;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    AccessBatch, AccessObserver, ColorAttachment, CommandList, Draw, F32, Format, Gpu, GpuConfig,
    I32, Lanes, LoadOp, RenderPass, RenderPipeline, Sampler, StoreOp, Subresource, TextureBinding,
    TextureDescriptor, TextureId, Wants,
};
use gnomon_shaders::transform::FullScreen;

const SIDE: u32 = 13;

/// Reads one place, by either function.
struct Reads {
    at: [u32; 2],
    same: bool,
}

impl FragmentShader for Reads {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let color = if self.same {
            let texel = f.fetch_same_texel(0, self.at);
            each4(
                #[inline(always)]
                |k| F32::splat(l, texel[k]),
            )
        } else {
            let [x, y] = self.at.map(|c| i32::try_from(c).unwrap_or(i32::MAX));
            let at = [I32::splat(l, x), I32::splat(l, y), I32::splat(l, 0)];
            f.fetch_texel(0, at, 0)
        };
        f.set_color(0, color);
    }
}

/// Texels that an observer is told of.
#[derive(Default)]
struct Told(String);

impl AccessObserver for Told {
    fn batch(&mut self, _: usize, batch: &AccessBatch<'_>) {
        self.0 += &format!("{:?}\n", batch.texels);
    }
}

/// A texture whose texels all differ, with one that is no number.
fn filled(gpu: &mut Gpu, format: Format, [width, height]: [u32; 2]) -> TextureId {
    let desc = TextureDescriptor::d2("source", format, width, height);
    let texture = gpu.create_texture(&desc).unwrap();
    let value = |k: u32| match k {
        17 => [f32::NAN, 0.25, 0.5, 1.0],
        _ => [1.0, 2.0, 3.0, 4.0].map(|c: f32| c / ((k % 197) as f32 + 5.0)),
    };
    let texels: Vec<[f32; 4]> = (0..width * height).map(value).collect();
    let stored = gpu.texture_mut(texture).unwrap();
    stored.write_color(Subresource::default(), &texels).unwrap();
    texture
}

/// Bits of the picture, counters, and what an observer was told, if there was one.
fn read(format: Format, size: [u32; 2], shader: Reads, observed: bool) -> (Vec<[u32; 4]>, String) {
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    let source = filled(&mut gpu, format, size);
    let desc = TextureDescriptor::d2("target", Format::Rgba32Float, SIDE, SIDE);
    let target = gpu.create_texture(&desc).unwrap();
    let pipeline = RenderPipeline {
        label: "reads".into(),
        vertex: FullScreen.stage(),
        fragment: Some(shader.into()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    };
    let draw = Draw {
        textures: vec![TextureBinding {
            texture: source,
            sampler: Sampler::default(),
        }],
        ..Draw::vertices_only("reads", &Arc::new(pipeline), 3)
    };
    let pass = RenderPass {
        label: "reads".into(),
        color: vec![ColorAttachment {
            texture: target,
            subresource: Subresource::default(),
            load: LoadOp::Clear([9.0; 4]),
            store: StoreOp::Store,
        }],
        depth_stencil: None,
        draws: vec![draw],
    };
    let list = CommandList { passes: vec![pass] };
    let mut told = Told::default();
    let report = match observed {
        false => gpu.submit(&list).unwrap(),
        true => {
            let wants = Wants {
                texels: true,
                ..Wants::default()
            };
            gpu.submit_observed(&list, wants, &mut told).unwrap()
        }
    };
    let texels = gpu.texture(target).unwrap();
    let texels = texels.read_color(Subresource::default()).unwrap();
    let bits = texels.iter().map(|t| t.0.map(f32::to_bits)).collect();
    let draws: Vec<_> = report.passes[0].draws.iter().map(|d| d.counters).collect();
    (bits, format!("{draws:?} {}", told.0))
}

/// In blocks and superblocks of storage, at edges, outside, in formats that are read slowly,
/// and where a number is none.
#[test]
fn one_texel_for_all_is_what_each_lane_would_fetch() {
    let places = [
        [0, 0],
        [4, 0],
        [5, 1],
        [129, 3],
        [7, 130],
        [139, 140],
        [140, 0],
        [0, 141],
        [u32::MAX, 0],
        [3, u32::MAX],
    ];
    let (mut seen, mut outside) = (0, 0);
    for format in [Format::Rgba32Float, Format::R32Float, Format::Rgba8Unorm] {
        for (at, observed) in places.iter().flat_map(|at| [(*at, false), (*at, true)]) {
            // Texel number 17 is no number in a texture of twelve columns.
            for size in [[140, 141], [12, 12]] {
                let [same, each] =
                    [true, false].map(|same| read(format, size, Reads { at, same }, observed));
                assert_eq!(same, each, "{format:?} {size:?} {at:?} {observed}");
                let is_in = at[0] < size[0] && at[1] < size[1];
                let blank = same.0.iter().all(|t| *t == [0; 4]);
                assert_eq!(blank, !is_in, "{format:?} {size:?} {at:?}");
                seen += usize::from(is_in);
                outside += usize::from(!is_in);
            }
        }
    }
    assert!(seen > 30 && outside > 30, "{seen} {outside}");
}
