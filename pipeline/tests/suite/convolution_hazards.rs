//! Depths and positions that are no numbers, or too large: nothing of it leaves the
//! shaders of convolution soft shadows.

use std::sync::Arc;

use gnomon_pipeline::geometry::convolution::{Series, Suppression};
use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, CommandList, Counters, Draw, Format, Gpu, GpuConfig, LoadOp, RenderPass,
    RenderPipeline, Sampler, StoreOp, Subresource, TextureBinding, TextureDescriptor, TextureId,
};
use gnomon_shaders::convolution::basis::{BasisImages, DepthImage, Source};
use gnomon_shaders::convolution::look_up::{BoxEdges, FloatTables, Images, Mipmaps, Prefiltered};
use gnomon_shaders::convolution::prefilter::SumStep;
use gnomon_shaders::convolution::visibility::{ConvolutionShadow, Sharpening};
use gnomon_shaders::convolution::{Atlas, Encoding};
use gnomon_shaders::light_view::{DepthRange, LightMapping, Projection, ViewRegion};
use gnomon_shaders::transform::FullScreen;

const SIDE: u32 = 16;
const ATLAS: Atlas = Atlas {
    side: SIDE,
    columns: 1,
    rows: 1,
};

struct Bench {
    gpu: Gpu,
    counted: Counters,
}

impl Bench {
    fn new() -> Self {
        Self {
            gpu: Gpu::new(GpuConfig::default()).unwrap(),
            counted: Counters::default(),
        }
    }

    fn texture(&mut self, label: &str, format: Format, texels: &[[f32; 4]]) -> TextureId {
        let desc = TextureDescriptor::d2(label, format, SIDE, SIDE);
        let id = self.gpu.create_texture(&desc).unwrap();
        if !texels.is_empty() {
            let texture = self.gpu.texture_mut(id).unwrap();
            texture.write_color(Subresource::default(), texels).unwrap();
        }
        id
    }

    fn pass(&mut self, shader: FragmentStage, from: &[TextureId], to: &[TextureId]) {
        let pipeline = Arc::new(RenderPipeline {
            label: "pass".into(),
            vertex: FullScreen.stage(),
            fragment: Some(shader),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE; to.len()],
        });
        let bound = |texture: &TextureId| TextureBinding {
            texture: *texture,
            sampler: Sampler::bilinear(),
        };
        let attached = |texture: &TextureId| ColorAttachment {
            texture: *texture,
            subresource: Subresource::default(),
            load: LoadOp::Clear([1.0; 4]),
            store: StoreOp::Store,
        };
        let draw = Draw {
            textures: from.iter().map(bound).collect(),
            ..Draw::vertices_only("pass", &pipeline, 3)
        };
        let pass = RenderPass {
            label: "pass".into(),
            color: to.iter().map(attached).collect(),
            depth_stencil: None,
            draws: vec![draw],
        };
        let report = self.gpu.submit(&CommandList { passes: vec![pass] });
        self.counted.add(&report.unwrap().passes[0].totals());
    }

    fn read(&self, id: TextureId) -> Vec<f32> {
        let texels = self.gpu.texture(id).unwrap();
        let texels = texels.read_color(Subresource::default()).unwrap();
        texels.iter().map(|t| t.0[0]).collect()
    }
}

fn series() -> Series {
    Series::new(2, Suppression::Scale, 1.0)
}

/// Visibility at `positions` of a light at the origin that looks along +z, from a
/// picture of `depths` over the distances 1 to 3.
fn visibility<P: Prefiltered>(
    depths: &[f32],
    positions: &[[f32; 4]],
    prefiltered: P,
    exclusive: bool,
) -> (Vec<f32>, Counters)
where
    FragmentStage: From<ConvolutionShadow<P>>,
{
    let mut bench = Bench::new();
    let texels: Vec<[f32; 4]> = depths.iter().map(|d| [*d, 0.0, 0.0, 0.0]).collect();
    let view = bench.texture("view", Format::R32Float, &texels);
    let [csm, csm_z] = ["csm", "csm-z"].map(|l| bench.texture(l, Format::Rgba32Float, &[]));
    let depth = bench.texture("depth", Format::R32Float, &[]);
    let expansion = series().expansion();
    let source = Source {
        origin: [0; 2],
        exclusive,
    };
    let basis = BasisImages {
        expansion,
        pair: 0,
        channel: None,
        source,
        encodings: [Encoding::PLAIN; 2],
    };
    bench.pass(basis.stage(), &[view], &[csm, csm_z]);
    let image = DepthImage {
        reach: expansion.reach,
        integer: false,
        source,
        encoding: Encoding::PLAIN,
    };
    bench.pass(image.stage(), &[view], &[depth]);
    let mut images = [csm, csm_z, depth];
    if exclusive {
        images = images.map(|id| table(&mut bench, id));
    }
    let at = bench.texture("positions", Format::Rgba32Float, positions);
    let out = bench.texture("visibility", Format::R32Float, &[]);
    let images_in = |slot| Images {
        slot,
        atlas: ATLAS,
        encoding: Encoding::PLAIN,
    };
    let shadow = ConvolutionShadow {
        mapping: LightMapping {
            centre: [0.0; 3],
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            projection: Projection::Perspective,
            scale: 0.5,
            offset: [0.5; 2],
            base: 0.0,
            range: DepthRange {
                near: 1.0,
                far: 3.0,
            },
            size: SIDE,
            region: ViewRegion::Front,
        },
        light_half: [0.3, 0.2],
        expansion,
        prefiltered,
        csm: images_in(1),
        csm_z: images_in(2),
        depth: images_in(3),
        threshold: 0.02,
        iterations: 1,
        sharpening: Sharpening {
            strength: 30.0,
            falloff: 10.0,
        },
        plane_offset: None,
    };
    let [csm, csm_z, depth] = images;
    bench.pass(shadow.into(), &[at, csm, csm_z, depth], &[out]);
    (bench.read(out), bench.counted)
}

fn table(bench: &mut Bench, id: TextureId) -> TextureId {
    let format = bench.gpu.texture(id).unwrap().descriptor().format;
    let mut both = [id, bench.texture("table", format, &[])];
    for axis in 0..2 {
        for step in [1, 2, 4, 8] {
            let shader = SumStep {
                textures: 1,
                axis,
                step,
                twice: false,
                side: SIDE,
                integer: false,
            };
            bench.pass(shader.stage(), &both[..1], &both[1..]);
            both.reverse();
        }
    }
    both[0]
}

/// Pixels cycle through coordinates of which most are no place.
fn positions() -> Vec<[f32; 4]> {
    let odd = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        0.0,
        -0.0,
        1.0,
        2.0,
        2.9,
        1e20,
    ];
    let pixel = |i: usize| {
        let pick = |k: usize| odd[(i / k) % odd.len()];
        [
            pick(1),
            pick(5),
            pick(12),
            if i.is_multiple_of(17) { 0.0 } else { 1.0 },
        ]
    };
    (0..(SIDE * SIDE) as usize).map(pixel).collect()
}

fn sane((values, counted): &(Vec<f32>, Counters)) {
    assert!(values.iter().all(|v| (0.0..=1.0).contains(v)), "{values:?}");
    assert_eq!(counted.events.nan_canonicalised, 0);
    assert!(counted.fragments.written > 0);
}

const MIPMAPS: Mipmaps = Mipmaps {
    side: SIDE,
    lod_bias: 0.0,
    probes: 2,
    along: 0,
};
const TABLES: FloatTables = FloatTables {
    side: SIDE,
    edges: BoxEdges::Exact,
    centred: false,
};

#[test]
fn positions_that_are_no_place_give_light_or_shadow() {
    let depths = [0.0; (SIDE * SIDE) as usize];
    let mips = visibility(&depths, &positions(), MIPMAPS, false);
    let tables = visibility(&depths, &positions(), TABLES, true);
    for found in [mips, tables] {
        sane(&found);
        // What is no place, or shadow does not fall on, is lit.
        for (v, [x, y, z, w]) in found.0.iter().zip(positions()) {
            let nowhere = !(z.is_finite() && z > 1.0) || w == 0.0;
            assert!(!nowhere || *v == 1.0, "{x} {y} {z}: {v}");
        }
    }
}

/// Depth that is no number counts as nothing in the way, and depth out of 0..1 as the
/// nearer end: the same bits as with these.
#[test]
fn depths_out_of_range_are_limited() {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0, 7.0, 0.25];
    let limited = [1.0, 1.0, 0.0, 0.0, 1.0, 0.25];
    let texels = SIDE * SIDE;
    let fill =
        |from: &[f32; 6]| -> Vec<f32> { (0..texels).map(|i| from[(i / 3 % 6) as usize]).collect() };
    let places: Vec<[f32; 4]> = (0..texels)
        .map(|i| {
            let [x, y] = [i % SIDE, i / SIDE].map(|k| k as f32 / 4.0 - 2.0);
            [x, y, 2.0 + y / 4.0, 1.0]
        })
        .collect();
    let mips = |from| visibility(&fill(from), &places, MIPMAPS, false);
    let tables = |from| visibility(&fill(from), &places, TABLES, true);
    for (found, expected) in [
        (mips(&odd), mips(&limited)),
        (tables(&odd), tables(&limited)),
    ] {
        sane(&found);
        assert_eq!(found.0, expected.0);
        assert!(found.0.iter().any(|v| *v < 0.9));
    }
}
