//! Random draws.

use gnomon_raster::Format;
use gnomon_raster::shader::Interpolation;
use gnomon_raster::state::{DepthStencilState, Viewport};

use super::geometry::{Screen, random_positions};
use super::{Random, state};
use crate::twin::{ColorSource, DepthSource, Discard, Program, Tier, TwinDraw, VertexSource};

const INTERPOLATION: [Interpolation; 3] = [
    Interpolation::Perspective,
    Interpolation::Linear,
    Interpolation::Flat,
];

/// A draw for attachments of the given formats; perhaps the geometry of an earlier one.
pub(super) fn random_draw(
    r: &mut Random,
    size: [u32; 2],
    formats: &[Format],
    depth: bool,
    earlier: Option<&TwinDraw>,
) -> TwinDraw {
    let mut d = match earlier {
        Some(e) if r.one_in(3) => e.clone(),
        _ => random_vertices(r, size),
    };
    d.primitive = state::primitive(r);
    if r.one_in(4) {
        d.primitive.cull_mode = gnomon_raster::state::CullMode::None;
    }
    d.depth_stencil = if depth {
        state::depth_stencil(r)
    } else {
        DepthStencilState::default()
    };
    d.targets = formats.iter().map(|&f| state::target(r, f)).collect();
    d.stencil_reference = r.array(|r| r.pick(&[0, 1, 2, 127, 128, 255]));
    d.blend_constant = r.array(|r| r.float(-0.1, 1.1));
    d.scissor = state::scissor(r, size);
    d.program = (formats.is_empty() && r.one_in(2))
        .then_some(())
        .map_or_else(|| Some(program(r, formats)), |()| None);
    let tier = |r: &mut Random| {
        if r.one_in(3) {
            Tier::Closure
        } else {
            Tier::Lanes
        }
    };
    d.fragment_tier = tier(r);
    d.vertex_tier = tier(r);
    d.vertex_source = if r.one_in(6) {
        VertexSource::Table
    } else {
        VertexSource::Buffer
    };
    d
}

/// Geometry, varyings, indices, instances and the viewport they are made for.
fn random_vertices(r: &mut Random, size: [u32; 2]) -> TwinDraw {
    let viewport = state::viewport(r, size);
    let screen = Screen::new(viewport.unwrap_or_else(|| Viewport::full(size[0], size[1])));
    let mut d = TwinDraw::triangles(random_positions(r, &screen));
    d.viewport = viewport;
    if r.one_in(2) {
        d.interpolation = (0..r.between(1, 7))
            .map(|_| r.pick(&INTERPOLATION))
            .collect();
    }
    let n = d.interpolation.len();
    let mut vertex = || (0..n).map(|_| varying(r)).collect();
    d.varyings = d.positions.iter().map(|_| vertex()).collect();
    order(r, &mut d);
    if r.one_in(6) {
        d.instances = r.between(0, 3) as u32;
        d.instance_offset = [
            r.float(-0.3, 0.3),
            r.float(-0.3, 0.3),
            r.float(-0.1, 0.1),
            0.0,
        ];
    }
    d
}

fn varying(r: &mut Random) -> f32 {
    match r.below(32) {
        0 => r.pick(&[
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::MAX,
            -0.0,
            1e-40,
        ]),
        1..4 => r.float(-300.0, 300.0),
        4..12 => r.pick(&[0.0, 1.0, 0.5, 0.25]),
        _ => r.float(-0.25, 1.25),
    }
}

/// Vertices in order, or indices: in order, shuffled, a part, with a rest.
fn order(r: &mut Random, d: &mut TwinDraw) {
    let n = d.positions.len() as u32;
    if r.one_in(2) {
        if r.one_in(4) {
            d.first = r.below(n);
            d.count = r.below(n - d.first + 1);
        }
        return;
    }
    let mut indices: Vec<u32> = (0..n).collect();
    if r.one_in(3) {
        indices.iter_mut().for_each(|i| *i = r.below(n));
    }
    if r.one_in(4) {
        indices.extend((0..r.below(4)).map(|_| r.below(n)));
    }
    d.count = indices.len() as u32;
    if r.one_in(4) {
        d.first = r.below(d.count);
        d.count = r.below(d.count - d.first + 1);
    }
    d.indices = Some(indices);
}

fn program(r: &mut Random, formats: &[Format]) -> Program {
    let color = match r.below(5) {
        0 => ColorSource::Constant(r.array(|r| r.array(|r| r.float(-0.1, 1.1)))),
        1 => ColorSource::Wild,
        2 => ColorSource::Geometry,
        _ => ColorSource::Varyings,
    };
    let mut uint = [false; 4];
    for (u, f) in uint.iter_mut().zip(formats) {
        // Wild colours and varyings show their bits instead, NaN among them.
        let colors = matches!(color, ColorSource::Wild | ColorSource::Varyings);
        *u = *f == Format::R32Uint && !colors;
    }
    Program {
        color,
        outputs: formats.len(),
        uint,
        discard: discard(r),
        depth: depth(r),
        look_ups: Vec::new(),
        textures: 0,
        discards_first: false,
    }
}

fn discard(r: &mut Random) -> Option<Discard> {
    match r.below(12) {
        0 => Some(Discard::Never),
        1 => Some(Discard::Checker(r.below(4))),
        2 => Some(Discard::Below(r.below(3) as usize, 0.5)),
        3 if r.one_in(3) => Some(Discard::Always),
        _ => None,
    }
}

fn depth(r: &mut Random) -> Option<DepthSource> {
    match r.below(16) {
        0 => Some(DepthSource::Same),
        1 => Some(DepthSource::Varying(
            r.below(3) as usize,
            r.pick(&[1.0, 1.25, -1.0]),
        )),
        2 => Some(DepthSource::Wild(r.below(3) as usize)),
        _ => None,
    }
}
