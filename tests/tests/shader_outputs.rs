//! What becomes of a fragment shader's outputs: those that it leaves alone are 0,
//! and a shader of one colour that is not run gives what it would have given.

use std::sync::Arc;

use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, FragmentStage, ScalarFragmentOutput,
    ScalarVertexOutput, VertexStage, per_fragment, per_vertex,
};
use gnomon_raster::state::{
    BlendState, ColorTargetState, ColorWrites, DepthStencilState, PrimitiveState,
};
use gnomon_raster::{
    ColorAttachment, CommandList, Counters, Draw, Error, F32, Format, Gpu, GpuConfig, I32, Lanes,
    LoadOp, PassReport, RenderPass, RenderPipeline, SimdLevel, StoreOp, Subresource,
    TextureDescriptor, TextureId,
};

const SIZE: u32 = 72;

/// Colour 1 everywhere, in every attachment.
struct Both;

impl FragmentShader for Both {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let one = F32::splat(l, 1.0);
        f.set_color(0, [one; 4]);
        f.set_color(1, [one; 4]);
    }
}

/// Sets attachment 1 never, and attachment 0 in every other block.
struct Sometimes;

impl FragmentShader for Sometimes {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        if f.column().to_array()[0] / 8 % 2 == 0 {
            f.set_color(0, [F32::splat(l, 0.5); 4]);
        }
    }
}

/// One colour; says so or not.
#[derive(Clone, Copy)]
struct Plain {
    color: [f32; 4],
    says_so: bool,
}

impl FragmentShader for Plain {
    fn constant(&self) -> Option<[f32; 4]> {
        self.says_so.then_some(self.color)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [r, g, b, a] = self.color;
        f.set_color(
            0,
            [
                F32::splat(l, r),
                F32::splat(l, g),
                F32::splat(l, b),
                F32::splat(l, a),
            ],
        );
    }
}

/// Counts odd columns and what it discards.
struct Counting;

impl FragmentShader for Counting {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            counts: &["odd columns", "left of 20"],
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let column = f.column();
        let odd = (column & I32::splat(l, 1)).eq(I32::splat(l, 1));
        f.count(0, odd);
        let left = column.lt(I32::splat(l, 20));
        f.discard(left);
        f.count(1, left);
        f.count(9, left);
        f.set_color(0, [F32::splat(l, 1.0); 4]);
    }
}

/// A triangle over most of the image and beyond its edges.
fn corners() -> VertexStage {
    per_vertex(&[], |v| {
        let [x, y] = [[-1.3, -0.9], [1.2, -1.1], [0.1, 1.4]][v.vertex_index as usize % 3];
        ScalarVertexOutput {
            position: [x, y, 0.5, 1.0],
            ..Default::default()
        }
    })
}

fn draw(fragment: FragmentStage, targets: Vec<ColorTargetState>) -> Draw {
    let pipeline = RenderPipeline {
        label: "draw".into(),
        vertex: corners(),
        fragment: Some(fragment),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: targets,
    };
    Draw::vertices_only("triangle", &Arc::new(pipeline), 3)
}

type Images = Vec<Vec<[u8; 4]>>;

fn run(config: GpuConfig, formats: &[Format], draws: Vec<Draw>) -> (Images, Vec<Counters>) {
    let (images, pass) = submit(config, formats, draws);
    (images, pass.draws.iter().map(|d| d.counters).collect())
}

fn submit(config: GpuConfig, formats: &[Format], draws: Vec<Draw>) -> (Images, PassReport) {
    let (gpu, textures, report) = try_submit(config, formats, draws).unwrap();
    let read = |&t| {
        let texels = gpu
            .texture(t)
            .unwrap()
            .read_color(Subresource::default())
            .unwrap();
        texels
            .iter()
            .map(|t| t.0.map(|c| (c * 255.0) as u8))
            .collect()
    };
    (textures.iter().map(read).collect(), report)
}

fn try_submit(
    config: GpuConfig,
    formats: &[Format],
    draws: Vec<Draw>,
) -> Result<(Gpu, Vec<TextureId>, PassReport), Error> {
    let mut gpu = Gpu::new(config).unwrap();
    let textures: Vec<_> = formats
        .iter()
        .map(|&f| {
            gpu.create_texture(&TextureDescriptor::d2("image", f, SIZE, SIZE))
                .unwrap()
        })
        .collect();
    let color = textures.iter().map(|&texture| ColorAttachment {
        texture,
        subresource: Subresource::default(),
        load: LoadOp::Clear([0.25, 0.5, 0.75, 1.0]),
        store: StoreOp::Store,
    });
    let mut report = gpu.submit(&CommandList {
        passes: vec![RenderPass {
            label: "main".into(),
            color: color.collect(),
            depth_stencil: None,
            draws,
        }],
    })?;
    Ok((gpu, textures, report.passes.remove(0)))
}

#[test]
fn outputs_that_are_not_set_are_zero_whatever_was_drawn_before() {
    for simd in SimdLevel::available() {
        for (threads, tile) in [(1, 16), (2, 32), (4, 128)] {
            let config = GpuConfig {
                threads,
                tile,
                simd,
                ..GpuConfig::default()
            };
            let two = || vec![ColorTargetState::OPAQUE; 2];
            let draws = vec![draw(Both.into(), two()), draw(Sometimes.into(), two())];
            let (images, _) = run(config, &[Format::Rgba8Unorm; 2], draws);
            let touched = |at: usize| images[1][at] == [0; 4];
            let all = images[0].len();
            assert!((0..all).filter(|&i| touched(i)).count() > all / 3);
            for at in (0..all).filter(|&at| touched(at)) {
                let set = (at as u32 % SIZE / 8).is_multiple_of(2);
                let expect = if set { [128; 4] } else { [0; 4] };
                assert_eq!(images[0][at], expect, "{simd}, {threads}, {tile} at {at}");
            }
            assert!(images[1].iter().all(|t| *t != [255; 4]), "drawn over");
        }
    }
}

/// Fragments are counted, helper lanes are not, and reports give them by name.
#[test]
fn shaders_count_fragments() {
    let mut before = None;
    for simd in SimdLevel::available() {
        for (threads, tile) in [(1, 16), (4, 64)] {
            let config = GpuConfig {
                threads,
                tile,
                simd,
                ..GpuConfig::default()
            };
            let opaque = vec![ColorTargetState::OPAQUE];
            let twice = vec![
                draw(Counting.into(), opaque.clone()),
                draw(Counting.into(), opaque),
            ];
            let (images, pass) = submit(config, &[Format::Rgba8Unorm], twice);
            let covered = |at: &usize| images[0][*at] == [255; 4];
            let written = (0..images[0].len()).filter(covered);
            let odd = written.filter(|at| at % 2 == 1).count() as u64;
            let counts = pass.shader_counts();
            let c = pass.draws[0].counters;
            assert_eq!(counts[1], ("left of 20", 2 * c.fragments.discarded));
            assert!(c.fragments.discarded > 100 && c.fragments.discarded % 64 != 0);
            // Those left of 20 are counted too, before they are discarded.
            assert_eq!(counts[0].0, "odd columns");
            let hidden = counts[0].1 / 2 - odd;
            assert!(hidden * 2 > c.fragments.discarded * 9 / 10, "{hidden}");
            assert!(hidden < c.fragments.discarded, "{hidden}");
            assert_eq!(c.shader_counts[2..], [0, 0]);
            assert_eq!(*before.get_or_insert(counts.clone()), counts);
        }
    }
}

/// A shader may count four things; more are refused.
#[test]
fn more_counts_than_there_are_places_are_refused() {
    let shader = per_fragment(
        FragmentOutputs {
            counts: &["a", "b", "c", "d", "e"],
            ..FragmentOutputs::default()
        },
        |_| ScalarFragmentOutput::color([1.0; 4]),
    );
    let list = vec![draw(shader, vec![ColorTargetState::OPAQUE])];
    let error = try_submit(GpuConfig::default(), &[Format::Rgba8Unorm], list)
        .err()
        .expect("five counts");
    let text = error.to_string();
    assert!(
        text.contains("counts") && text.contains('5') && text.contains('4'),
        "{text}"
    );
}

#[test]
fn one_colour_is_the_same_with_and_without_running_the_shader() {
    let masked = |blend| ColorTargetState {
        blend,
        write_mask: ColorWrites(0b0101),
    };
    let whole = |blend| ColorTargetState {
        blend,
        write_mask: ColorWrites::ALL,
    };
    let blends = [
        None,
        Some(BlendState::ADDITIVE),
        Some(BlendState::SUBTRACTIVE),
        Some(BlendState::MIN),
    ];
    let colors = [
        [0.1, 0.7, 1.0, 0.0],
        [-0.0, 0.5, 0.5, 0.5],
        [2.0, -1.0, f32::NAN, 0.3],
        [40_000.0, 1e9, -1e-8, f32::INFINITY],
        [f32::NAN, 0.0, 0.0, 0.0],
    ];
    for format in Format::ALL {
        let states = blends.into_iter().flat_map(|b| [masked(b), whole(b)]);
        let valid = |t: &ColorTargetState| t.blend.is_none() || format.is_blendable();
        if format.is_depth_stencil() {
            continue;
        }
        for (color, target) in colors
            .into_iter()
            .flat_map(|c| states.clone().filter(valid).map(move |t| (c, t)))
        {
            for simd in SimdLevel::available() {
                let config = GpuConfig {
                    threads: 1,
                    simd,
                    ..GpuConfig::default()
                };
                let result = |says_so| {
                    let shader = Plain { color, says_so };
                    let draws = vec![draw(shader.into(), vec![target]); 2];
                    let (gpu, textures, pass) = try_submit(config, &[format], draws).unwrap();
                    let texture = gpu.texture(textures[0]).unwrap();
                    let raw = texture.read_raw(Subresource::default()).unwrap();
                    let counters: Vec<Counters> = pass.draws.iter().map(|d| d.counters).collect();
                    (raw, counters)
                };
                let (run, not_run) = (result(false), result(true));
                assert!(
                    run == not_run,
                    "{simd}, {format:?}, {color:?}, {target:?}: {:?} and {:?}",
                    run.1,
                    not_run.1
                );
            }
        }
    }
}
