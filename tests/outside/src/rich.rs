//! A frame that reaches every kernel: passes of one draw or a few over 24×24 pixels, four tiles.

use std::sync::Arc;

use gnomon_raster::shader::{FragmentOutputs, FragmentStage, ScalarFragmentOutput, per_fragment};
use gnomon_raster::state::{
    BlendState, ColorTargetState, ColorWrites, CompareFunction, CullMode, DepthBias, DepthState,
    DepthStencilState, PrimitiveState, PrimitiveTopology, StencilFaceState, StencilOperation,
    StencilState,
};
use gnomon_raster::{
    AccessBatch, AccessObserver, AddressMode, BlockAccess, ColorAttachment, CommandList, Counters,
    DepthStencilAttachment, Draw, Format, Gpu, GpuConfig, LoadOp, RenderPass, RenderPipeline,
    Sampler, StoreOp, Subresource, TextureBinding, TextureDescriptor, TextureDimension, TextureId,
    VertexBuffer, Wants,
};

use crate::shaders::{Corners, Lit, LookUps};

const SIDE: u32 = 24;
const COLORS: [Format; 8] = [
    Format::R8Unorm,
    Format::Rg8Unorm,
    Format::Rgba8Unorm,
    Format::R16Sint,
    Format::R16Float,
    Format::Rgba16Float,
    Format::R32Float,
    Format::Rgba32Float,
];

/// Renders it; the hash is of all that can be read back, and of all counters.
pub fn rich(config: GpuConfig) -> u64 {
    let mut gpu = Gpu::new(config).expect("valid");
    let mut hashes = Vec::new();
    let images = Images::new(&mut gpu);
    for depth in images.depth {
        let list = CommandList {
            passes: vec![
                prime(depth),
                volumes(depth),
                general(depth, &images),
                widened(depth, &images),
            ],
        };
        hashes.push(run(&mut gpu, &list));
        let s = Subresource::default();
        let t = gpu.texture(depth).expect("exists");
        hashes.push(crate::hash(&(t.read_depth_bits(s), t.read_stencil(s))));
    }
    let passes = images.color.iter().enumerate();
    let list = CommandList {
        passes: passes
            .map(|(i, &c)| shaded(c, COLORS[i], &images))
            .collect(),
    };
    hashes.push(run(&mut gpu, &list));
    for &c in &images.color {
        let t = gpu.texture(c).expect("exists");
        hashes.push(crate::hash(&t.read_raw(Subresource::default())));
    }
    crate::hash(&hashes)
}

/// Submits `list` twice, once observed; gives a hash of counters and accesses.
fn run(gpu: &mut Gpu, list: &CommandList) -> u64 {
    let mut seen = Accesses(Vec::new());
    let wants = Wants {
        depth_ranges: true,
        ..Wants::default()
    };
    let observed = gpu.submit_observed(list, wants, &mut seen);
    let observed = observed.expect("valid");
    let plain = gpu.submit(list).expect("valid");
    let counters = |r: &gnomon_raster::SubmitReport| -> Vec<Counters> {
        r.passes.iter().map(|p| p.totals()).collect()
    };
    crate::hash(&(counters(&observed), counters(&plain), seen.0))
}

struct Accesses(Vec<BlockAccess>);

impl AccessObserver for Accesses {
    fn batch(&mut self, _: usize, batch: &AccessBatch<'_>) {
        self.0.extend_from_slice(batch.blocks);
    }
}

/// Attachments and textures.
struct Images {
    depth: [TextureId; 2],
    color: Vec<TextureId>,
    look_ups: Vec<TextureId>,
}

impl Images {
    fn new(gpu: &mut Gpu) -> Self {
        let mut d2 = |f| {
            let desc = TextureDescriptor::d2("image", f, SIDE, SIDE);
            gpu.create_texture(&desc).expect("valid")
        };
        let depth = [Format::Depth24Stencil8, Format::Depth32FloatStencil8].map(&mut d2);
        let color = COLORS.map(&mut d2).to_vec();
        let mips = filled(
            gpu,
            TextureDimension::D2,
            Format::Rgba8Unorm,
            [16, 16, 1],
            5,
        );
        let cube = filled(
            gpu,
            TextureDimension::Cube,
            Format::Rgba16Float,
            [8, 8, 1],
            1,
        );
        let volume = filled(gpu, TextureDimension::D3, Format::R32Float, [4, 4, 4], 3);
        Self {
            depth,
            color,
            look_ups: vec![mips, cube, volume, depth[0]],
        }
    }
}

fn filled(
    gpu: &mut Gpu,
    dimension: TextureDimension,
    format: Format,
    size: [u32; 3],
    mip_levels: u32,
) -> TextureId {
    let desc = TextureDescriptor {
        dimension,
        size,
        mip_levels,
        ..TextureDescriptor::d2("filled", format, size[0], size[1])
    };
    let id = gpu.create_texture(&desc).expect("valid");
    let layers = if dimension == TextureDimension::Cube {
        6
    } else {
        size[2]
    };
    let t = gpu.texture_mut(id).expect("exists");
    for layer in 0..layers {
        let texel = |i: u32| [0.1, 0.3, 0.7, 0.9].map(|c| c * (1 + (i + layer) % 7) as f32 / 7.0);
        let texels: Vec<[f32; 4]> = (0..size[0] * size[1]).map(texel).collect();
        t.write_color(Subresource { mip: 0, layer }, &texels)
            .expect("fits");
    }
    t.generate_mipmaps().expect("colour");
    id
}

/// Large triangles, one of them cut by the near plane and the guard band, and many
/// small ones.
fn corners() -> Arc<VertexBuffer> {
    let mut data = vec![
        -1.0, -1.0, 0.2, 1.0, 3.0, -1.0, 1.8, 2.0, -1.0, 3.0, 0.4, 1.0, //
        -0.9, 0.8, 0.9, 1.0, 0.9, 0.7, 0.1, 1.0, 0.1, -0.9, 0.5, 1.0, //
        -2.0, 0.1, -0.5, 0.5, 900.0, 0.2, 0.5, 1.0, 0.3, -700.0, 1.4, 1.0,
    ];
    for k in 0..8u16 {
        let at = f32::from(k) / 4.0 - 1.0;
        let z = f32::from(k) / 10.0;
        data.extend([
            at,
            at,
            z,
            1.0,
            at + 0.25,
            at,
            z,
            1.0,
            at,
            at + 0.3,
            z * 0.5,
            1.0,
        ]);
    }
    Arc::new(VertexBuffer { data, stride: 4 })
}

fn draw(pipeline: RenderPipeline) -> Draw {
    let vertices = corners();
    Draw {
        vertices: Some(vertices.clone()),
        stencil_reference: [3, 5],
        blend_constant: [0.5, 0.25, 0.75, 1.0],
        ..Draw::vertices_only("corners", &Arc::new(pipeline), vertices.len() as u32)
    }
}

fn plain(fragment: Option<FragmentStage>, targets: usize) -> RenderPipeline {
    RenderPipeline {
        label: "plain".into(),
        vertex: Corners.into(),
        fragment,
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE; targets],
    }
}

fn depth_stencil(texture: TextureId, clear: bool) -> DepthStencilAttachment {
    DepthStencilAttachment {
        texture,
        subresource: Subresource::default(),
        depth_load: if clear {
            LoadOp::Clear(1.0)
        } else {
            LoadOp::Load
        },
        depth_store: StoreOp::Store,
        stencil_load: if clear {
            LoadOp::Clear(2)
        } else {
            LoadOp::Load
        },
        stencil_store: StoreOp::Store,
    }
}

fn color(texture: TextureId) -> ColorAttachment {
    ColorAttachment {
        texture,
        subresource: Subresource::default(),
        load: LoadOp::Clear([0.25, 0.5, 0.125, 0.5]),
        store: StoreOp::Store,
    }
}

fn pass(
    label: &str,
    color: Vec<ColorAttachment>,
    ds: DepthStencilAttachment,
    draws: Vec<Draw>,
) -> RenderPass {
    RenderPass {
        label: label.into(),
        color,
        depth_stencil: Some(ds),
        draws,
    }
}

/// Depth only, with a bias.
fn prime(depth: TextureId) -> RenderPass {
    let mut p = plain(None, 0);
    p.depth_stencil = DepthStencilState::opaque();
    p.depth_stencil.bias = DepthBias {
        constant: 2.0,
        slope: 1.5,
        clamp: 0.25,
    };
    pass("prime", vec![], depth_stencil(depth, true), vec![draw(p)])
}

/// Counting in the stencil both ways.
fn volumes(depth: TextureId) -> RenderPass {
    let states = [
        DepthStencilState::z_pass_volumes(),
        DepthStencilState::z_fail_volumes(),
    ];
    let draws = states.map(|depth_stencil| {
        draw(RenderPipeline {
            depth_stencil,
            ..plain(None, 0)
        })
    });
    pass(
        "volumes",
        vec![],
        depth_stencil(depth, false),
        draws.to_vec(),
    )
}

/// What the lean kernels leave to the general one: clip planes, bounds, any stencil
/// operation, discards, depths from the shader; four attachments.
fn general(depth: TextureId, images: &Images) -> RenderPass {
    let outputs = FragmentOutputs {
        discards: true,
        depth: true,
        ..FragmentOutputs::default()
    };
    let odd = per_fragment(outputs, |f| ScalarFragmentOutput {
        color: [[f.varyings[0], f.varyings[2], f.w, f.depth]; 4],
        depth: f.depth * 0.5,
        discard: f.x % 3 == 0,
        ..ScalarFragmentOutput::default()
    });
    let face = StencilFaceState {
        compare: CompareFunction::LessEqual,
        fail_op: StencilOperation::Invert,
        depth_fail_op: StencilOperation::IncrementClamp,
        pass_op: StencilOperation::Replace,
        read_mask: 0x7f,
        write_mask: 0xfe,
    };
    let mut p = plain(Some(odd), 4);
    p.primitive.clip_planes = vec![[1.0, 0.5, 0.0, 0.75], [0.0, 0.0, -1.0, 0.9]];
    p.depth_stencil = DepthStencilState {
        depth: DepthState {
            compare: CompareFunction::GreaterEqual,
            write: true,
            bounds: Some([0.125, 0.9375]),
        },
        stencil: StencilState {
            front: face,
            back: face,
        },
        bias: DepthBias::default(),
    };
    let color = images.color[..4].iter().map(|&c| color(c)).collect();
    pass("general", color, depth_stencil(depth, false), vec![draw(p)])
}

/// Lines and points, and triangles with their depth clamped.
fn widened(depth: TextureId, images: &Images) -> RenderPass {
    let one = |topology, depth_clamp| {
        let mut p = plain(Some(Lit.into()), 1);
        p.primitive = PrimitiveState {
            topology,
            depth_clamp,
            line_width: 2.5,
            point_size: 3.0,
            cull_mode: CullMode::Back,
            ..PrimitiveState::default()
        };
        p.depth_stencil = DepthStencilState::opaque();
        draw(p)
    };
    let draws = vec![
        one(PrimitiveTopology::LineList, false),
        one(PrimitiveTopology::PointList, false),
        one(PrimitiveTopology::TriangleList, true),
    ];
    let color = vec![color(images.color[7])];
    pass("widened", color, depth_stencil(depth, false), draws)
}

/// Lane shaders, a shader of one colour and look-ups, blended in every way that the
/// format allows.
fn shaded(texture: TextureId, format: Format, images: &Images) -> RenderPass {
    let mut blends = vec![None];
    if format.is_blendable() && !format.is_integer() {
        let known = [
            BlendState::ADDITIVE,
            BlendState::SUBTRACTIVE,
            BlendState::MIN,
            BlendState::ALPHA,
        ];
        blends.extend(known.map(Some));
    }
    let mut draws = Vec::new();
    for (k, blend) in blends.into_iter().enumerate() {
        let fragment = match k % 2 {
            0 => LookUps.into(),
            _ => Lit.into(),
        };
        let mut p = plain(Some(fragment), 1);
        p.depth_stencil.depth.compare = CompareFunction::NotEqual;
        p.color_targets = vec![ColorTargetState {
            blend,
            write_mask: ColorWrites(if k == 1 { 0b1011 } else { 0b1111 }),
        }];
        let textures = images
            .look_ups
            .iter()
            .enumerate()
            .map(|(i, &texture)| TextureBinding {
                texture,
                sampler: Sampler {
                    address: [[AddressMode::Repeat; 3], [AddressMode::ClampToBorder; 3]][i % 2],
                    ..Sampler::trilinear()
                },
            });
        draws.push(Draw {
            textures: textures.collect(),
            ..draw(p)
        });
    }
    pass(
        "shaded",
        vec![color(texture)],
        depth_stencil(images.depth[1], false),
        draws,
    )
}
