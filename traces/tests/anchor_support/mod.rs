//! Small frames of one pass, drawn and judged.

#![allow(dead_code, reason = "each test takes what it needs")]

pub(crate) mod sums;

use std::sync::Arc;

use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, FragmentStage, Interpolation, ScalarFragmentOutput,
    ScalarVertexOutput, per_fragment, per_vertex,
};
use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthState, DepthStencilState, PrimitiveState,
};
use gnomon_raster::{
    AccessBatch, AccessObserver, ColorAttachment, DepthStencilAttachment, Draw, F32, Format, Gpu,
    GpuConfig, Lanes, LoadOp, Recording, RenderPass, RenderPipeline, Sampler, StoreOp, Subresource,
    TextureBinding, TextureDescriptor, VertexBuffer, Wants,
};
use gnomon_traces::profile::{Judge, JudgeOptions, Profile, Traffic};
use gnomon_traces::witness::class_of;
use gnomon_traces::{FrameShape, Witness};

#[derive(Clone, Copy)]
pub(crate) struct Vertex {
    /// In pixels, row 0 on top.
    pub(crate) position: [f32; 2],
    pub(crate) color: [f32; 4],
}

/// Triangles into one colour attachment.
#[derive(Clone)]
pub(crate) struct Case {
    pub(crate) size: [u32; 2],
    pub(crate) format: Format,
    pub(crate) depth_format: Format,
    pub(crate) clear: [f32; 4],
    pub(crate) depth: Option<CompareFunction>,
    /// States of draws, where they are not all the same.
    pub(crate) states: Vec<DepthStencilState>,
    /// Depths of draws, each of all vertices.
    pub(crate) layers: Vec<f32>,
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) textured: bool,
    /// Shaders may discard, so that they run before the depth test.
    pub(crate) discards: bool,
    pub(crate) truncated: bool,
    pub(crate) blended: bool,
}

impl Case {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        Self {
            size: [width, height],
            format: Format::Rgba8Unorm,
            depth_format: Format::Depth24Stencil8,
            clear: [0.0; 4],
            depth: Some(CompareFunction::LessEqual),
            states: Vec::new(),
            layers: vec![0.0],
            vertices: Vec::new(),
            textured: false,
            discards: false,
            truncated: false,
            blended: false,
        }
    }

    pub(crate) fn recording(&self) -> Recording {
        let [w, h] = self.size;
        let mut r = Recording::default();
        let d2 = |label, format| TextureDescriptor::d2(label, format, w, h);
        let color = r.create(&d2("color", self.format)).unwrap();
        let depth = r.create(&d2("depth", self.depth_format)).unwrap();
        let image = TextureDescriptor::d2("image", Format::Rgba8Unorm, 256, 256);
        let image = r.create(&image).unwrap();
        let noise = |i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as f32 / 255.0;
        let texels: Vec<[f32; 4]> = (0..256 * 256)
            .map(|i| [noise(i), noise(i + 7), noise(i * 3), 1.0])
            .collect();
        r.write(image, Subresource::default(), &texels).unwrap();
        let draws = self.layers.iter().enumerate().map(|(i, z)| {
            let mut pipeline = self.pipeline();
            if let Some(state) = self.states.get(i) {
                pipeline.depth_stencil = *state;
            }
            let pipeline = Arc::new(pipeline);
            let mut draw = Draw::vertices_only("layer", &pipeline, self.vertices.len() as u32);
            draw.vertices = Some(Arc::new(self.buffer(*z)));
            if self.textured {
                draw.textures = vec![TextureBinding {
                    texture: image,
                    sampler: Sampler::bilinear(),
                }];
            }
            draw
        });
        r.list.passes.push(RenderPass {
            label: "pass".to_owned(),
            color: vec![ColorAttachment {
                texture: color,
                subresource: Subresource::default(),
                load: LoadOp::Clear(self.clear),
                store: StoreOp::Store,
            }],
            depth_stencil: self.depth.map(|_| DepthStencilAttachment {
                texture: depth,
                subresource: Subresource::default(),
                depth_load: LoadOp::Clear(1.0),
                depth_store: StoreOp::Store,
                stencil_load: LoadOp::Clear(0),
                stencil_store: StoreOp::Store,
            }),
            draws: draws.collect(),
        });
        r
    }

    fn buffer(&self, z: f32) -> VertexBuffer {
        let [w, h] = self.size.map(|s| s as f32);
        let data = self.vertices.iter().flat_map(|v| {
            let [x, y] = v.position;
            let [r, g, b, a] = v.color;
            [2.0 * x / w - 1.0, 1.0 - 2.0 * y / h, z, r, g, b, a]
        });
        VertexBuffer {
            data: data.collect(),
            stride: 7,
        }
    }

    fn pipeline(&self) -> RenderPipeline {
        let vertex = per_vertex(&[Interpolation::Linear; 4], |v| {
            let a = v.attributes;
            let mut out = ScalarVertexOutput {
                position: [a[0], a[1], a[2], 1.0],
                ..ScalarVertexOutput::default()
            };
            out.varyings[..4].copy_from_slice(&a[3..7]);
            out
        });
        let target = match self.blended {
            true => ColorTargetState::ADDITIVE,
            false => ColorTargetState::OPAQUE,
        };
        RenderPipeline {
            label: "case".to_owned(),
            vertex,
            fragment: Some(self.fragment()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState {
                depth: self
                    .depth
                    .map_or(DepthState::DISABLED, |compare| DepthState {
                        compare,
                        write: true,
                        bounds: None,
                    }),
                ..DepthStencilState::default()
            },
            color_targets: vec![target],
        }
    }

    fn fragment(&self) -> FragmentStage {
        if self.textured {
            return FragmentStage::from(Textured {
                discards: self.discards,
            });
        }
        let truncated = self.truncated;
        per_fragment(FragmentOutputs::default(), move |f| {
            let [r, g, b, a] = [0, 1, 2, 3].map(|i| {
                let value = f.varyings[i];
                match truncated {
                    true => (value * 255.0).floor() / 255.0,
                    false => value,
                }
            });
            ScalarFragmentOutput::color([r, g, b, a])
        })
    }

    pub(crate) fn shape(&self) -> FrameShape {
        FrameShape::of(&self.recording())
    }

    fn observe(&self, observer: &mut dyn AccessObserver) {
        observe(&self.recording(), observer);
    }

    pub(crate) fn judge(&self, profile: &Profile, options: JudgeOptions) -> Traffic {
        judge(&self.recording(), profile, options)
    }

    pub(crate) fn fragments(&self) -> u64 {
        let mut tally = Tally::default();
        self.observe(&mut tally);
        tally.fragments
    }

    /// Blocks of colour by the class of what was last written to them.
    pub(crate) fn color_classes(&self) -> [usize; 4] {
        let mut tally = Tally::default();
        self.observe(&mut tally);
        let mut classes = [0; 4];
        tally
            .classes
            .values()
            .for_each(|c| classes[usize::from(*c)] += 1);
        classes
    }
}

/// Draws a frame, with skipping off.
pub(crate) fn observe(recording: &Recording, observer: &mut dyn AccessObserver) {
    let mut gpu = Gpu::new(GpuConfig {
        threads: 1,
        skip: false,
        ..GpuConfig::default()
    })
    .unwrap();
    gpu.load(recording).unwrap();
    let wants = Wants {
        depth_ranges: true,
        texels: true,
        witness: Some(&Witness),
        ..Wants::default()
    };
    gpu.submit_observed(&recording.list, wants, observer)
        .unwrap();
}

/// Draws a frame and judges it.
pub(crate) fn judge(recording: &Recording, profile: &Profile, options: JudgeOptions) -> Traffic {
    let shape = FrameShape::of(recording);
    let mut judge = Judge::with_options(profile, &shape, options).unwrap();
    observe(recording, &mut judge);
    judge.finish()
}

#[derive(Default)]
struct Tally {
    fragments: u64,
    classes: std::collections::BTreeMap<[u16; 2], u8>,
}

impl AccessObserver for Tally {
    fn batch(&mut self, _: usize, batch: &AccessBatch<'_>) {
        for e in batch.blocks {
            self.fragments += u64::from(e.covered.count_ones());
            self.classes.insert(e.block, class_of(e.witness, 1));
        }
    }
}

struct Textured {
    discards: bool,
}

impl FragmentShader for Textured {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            discards: self.discards,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let at = [f.varying(0), f.varying(1), F32::splat(l, 0.0)];
        let texel = f.sample(0, at);
        f.set_color(0, texel);
    }
}

/// Full-screen layers at `count` depths in an order that `seed` shuffles.
pub(crate) fn draw_layers(count: usize, seed: u64) -> Case {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 1;
    let mut below = |n: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let mut layers: Vec<f32> = (0..count).map(|i| i as f32 / 16.0).collect();
    for i in (1..count).rev() {
        layers.swap(i, below(i + 1));
    }
    let corner = |x, y| Vertex {
        position: [x, y],
        color: [1.0; 4],
    };
    Case {
        depth: Some(CompareFunction::Less),
        layers,
        vertices: vec![corner(0.0, 0.0), corner(128.0, 0.0), corner(0.0, 128.0)],
        ..Case::new(64, 64)
    }
}
