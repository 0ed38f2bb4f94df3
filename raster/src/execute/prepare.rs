//! A draw's state, translated once for the geometry and the tile stage.

use crate::command::Draw;
use crate::counters::AccessSizes;
use crate::format::{self, Format};
use crate::geometry::{DepthEncoding, GeometryState, ViewportTransform};
use crate::gpu::Gpu;
use crate::observer::Wants;
use crate::sampling::BoundTexture;
use crate::shader::{ErasedFragmentShader, FragmentOutputs, Interpolation};
use crate::state::{CompareFunction, DepthStencilState, Viewport};
use crate::texture::Texture;
use crate::tile::{DrawConfig, StencilFace, TargetConfig};

/// What the attachments of a pass are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) sizes: AccessSizes,
}

/// A draw ready for both stages.
pub(super) struct Prepared<'a> {
    pub(super) draw: &'a Draw,
    pub(super) geometry: GeometryState,
    pub(super) config: DrawConfig<'a>,
    pub(super) sizes: AccessSizes,
}

pub(super) fn prepare<'a>(
    gpu: &'a Gpu,
    target: &Target,
    draw: &'a Draw,
    wants: Wants,
) -> Prepared<'a> {
    let viewport = draw
        .viewport
        .unwrap_or_else(|| Viewport::full(target.width, target.height));
    let geometry = geometry_state(target, draw, &viewport);
    let mut config = draw_config(gpu, target, draw, &viewport, &geometry);
    config.listen(wants);
    let mut sizes = target.sizes;
    for (size, t) in sizes.tex.iter_mut().zip(&config.textures) {
        *size = Some(t.texture.desc.format);
    }
    Prepared {
        draw,
        geometry,
        config,
        sizes,
    }
}

fn encoding(target: &Target) -> DepthEncoding {
    if target.sizes.depth == Some(Format::Depth24Stencil8) {
        DepthEncoding::D24
    } else {
        DepthEncoding::Float
    }
}

/// Bit i: varying i is of kind `kind`.
fn varying_bits(draw: &Draw, kind: Interpolation) -> u32 {
    let varyings = draw.pipeline.vertex.0.varyings().iter().enumerate();
    varyings
        .filter(|(_, v)| **v == kind)
        .fold(0, |m, (i, _)| m | 1 << i)
}

fn geometry_state(target: &Target, draw: &Draw, viewport: &Viewport) -> GeometryState {
    let p = &draw.pipeline.primitive;
    GeometryState {
        topology: p.topology,
        front_face: p.front_face,
        cull_mode: p.cull_mode,
        depth_clamp: p.depth_clamp,
        line_width: p.line_width,
        point_size: p.point_size,
        viewport: ViewportTransform::new(viewport),
        encoding: encoding(target),
        bias: draw.pipeline.depth_stencil.bias,
        rect: draw_rect(target, draw, viewport),
        varyings: draw.pipeline.vertex.0.varyings().len(),
        flat: varying_bits(draw, Interpolation::Flat),
    }
}

/// Attachments ∩ scissor ∩ viewport (rules §4), half-open.
fn draw_rect(target: &Target, draw: &Draw, v: &Viewport) -> [i32; 4] {
    let edge = |at: f32| (f64::from(at) - 0.5).ceil() as i32;
    let mut r = [
        edge(v.x),
        edge(v.y),
        edge(v.x + v.width),
        edge(v.y + v.height),
    ];
    let mut cut = |x0: u32, y0: u32, x1: u32, y1: u32| {
        let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(|v| v.min(i32::MAX as u32) as i32);
        r = [r[0].max(x0), r[1].max(y0), r[2].min(x1), r[3].min(y1)];
    };
    cut(0, 0, target.width, target.height);
    if let Some(s) = draw.scissor {
        cut(s.x, s.y, s.x + s.width, s.y + s.height);
    }
    r
}

fn encode_depth(e: DepthEncoding, v: f32) -> i32 {
    match e {
        DepthEncoding::D24 => format::d24_from_f32(v) as i32,
        DepthEncoding::Float => (if v > 0.0 { v } else { 0.0 }).to_bits() as i32,
    }
}

fn draw_config<'a>(
    gpu: &'a Gpu,
    target: &Target,
    draw: &'a Draw,
    viewport: &Viewport,
    geometry: &GeometryState,
) -> DrawConfig<'a> {
    let attached = target.sizes.depth.is_some();
    let ds = if attached {
        draw.pipeline.depth_stencil
    } else {
        DepthStencilState::default()
    };
    let outputs = draw
        .pipeline
        .fragment
        .as_ref()
        .map(|f| f.0.outputs())
        .unwrap_or_default();
    let encoding = geometry.encoding;
    let depth_tested = attached && ds.depth.compare.reads_stored();
    let ends = [viewport.min_depth, viewport.max_depth].map(|v| encode_depth(encoding, v));
    let face = |f, reference| StencilFace::new(f, reference, attached);
    let shader = draw.pipeline.fragment.as_ref().map(|f| &*f.0);
    let constant = shader.and_then(ErasedFragmentShader::constant).filter(|_| {
        target.sizes.color.iter().flatten().count() == 1 && outputs == FragmentOutputs::default()
    });
    let mut config = DrawConfig {
        encoding,
        rect: geometry.rect,
        attached,
        compare: if attached {
            ds.depth.compare
        } else {
            CompareFunction::Always
        },
        depth_write: attached && ds.depth.write,
        bounds: ds
            .depth
            .bounds
            .map(|b| b.map(|v| encode_depth(encoding, v))),
        depth_range: [ends[0].min(ends[1]), ends[0].max(ends[1])],
        depth_reversed: ends[0] > ends[1],
        hiz: gpu.config.skip && depth_tested && ds.depth.bounds.is_none() && !outputs.depth,
        lean: false,
        counting: None,
        plain: draw.pipeline.primitive.clip_planes.is_empty() && ds.depth.bounds.is_none(),
        depth_ranges: false,
        needs_depth: depth_tested
            || (attached && ds.depth.write)
            || (shader.is_some() && constant.is_none()),
        stencil: [
            face(ds.stencil.front, draw.stencil_reference[0]),
            face(ds.stencil.back, draw.stencil_reference[1]),
        ],
        targets: color_targets(target, draw, constant),
        blend_constant: draw.blend_constant,
        shader,
        constant,
        discards: outputs.discards,
        writes_shader_depth: outputs.depth,
        varyings: geometry.varyings,
        perspective: varying_bits(draw, Interpolation::Perspective),
        flat: geometry.flat,
        clip_planes: draw.pipeline.primitive.clip_planes.clone(),
        textures: draw
            .textures
            .iter()
            .map(|b| BoundTexture {
                texture: texture(gpu, b.texture.0),
                sampler: b.sampler,
            })
            .collect(),
    };
    config.lean = config.is_lean();
    config.counting = config.counts_alike();
    config
}

fn texture(gpu: &Gpu, id: u32) -> &Texture {
    &gpu.textures[id as usize]
}

fn color_targets(target: &Target, draw: &Draw, constant: Option<[f32; 4]>) -> Vec<TargetConfig> {
    let formats = target.sizes.color.iter().flatten();
    formats
        .zip(&draw.pipeline.color_targets)
        .map(|(&format, t)| {
            let target = TargetConfig::new(format, t.blend, t.write_mask);
            constant.map_or(target, |color| target.with_constant(color))
        })
        .collect()
}
