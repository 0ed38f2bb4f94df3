//! Random fixed-function state.

use gnomon_raster::Format;
use gnomon_raster::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
    CompareFunction, CullMode, DepthBias, DepthState, DepthStencilState, FrontFace, PrimitiveState,
    PrimitiveTopology, ScissorRect, StencilFaceState, StencilOperation, StencilState, Viewport,
};

use super::Random;

pub(super) fn primitive(r: &mut Random) -> PrimitiveState {
    let topology = match r.below(8) {
        0 => PrimitiveTopology::LineList,
        1 => PrimitiveTopology::PointList,
        _ => PrimitiveTopology::TriangleList,
    };
    let clip_planes = if r.one_in(4) { r.between(1, 6) } else { 0 };
    PrimitiveState {
        topology,
        front_face: r.pick(&[FrontFace::Ccw, FrontFace::Cw]),
        cull_mode: r.pick(&[
            CullMode::None,
            CullMode::None,
            CullMode::None,
            CullMode::Front,
            CullMode::Back,
        ]),
        depth_clamp: r.one_in(2),
        clip_planes: (0..clip_planes).map(|_| clip_plane(r)).collect(),
        line_width: r.pick(&[0.1, 1.0, 1.0, 2.5, 9.0]),
        point_size: r.pick(&[0.1, 1.0, 3.0, 7.5, 20.0]),
    }
}

fn clip_plane(r: &mut Random) -> [f32; 4] {
    match r.below(4) {
        0 => r.pick(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 0.5],
            [0.0, 0.0, -1.0, 0.5],
            [0.0, 0.0, 0.0, 1.0],
        ]),
        _ => [
            r.float(-1.0, 1.0),
            r.float(-1.0, 1.0),
            r.float(-1.0, 1.0),
            r.float(0.0, 1.0),
        ],
    }
}

pub(super) fn viewport(r: &mut Random, [w, h]: [u32; 2]) -> Option<Viewport> {
    if r.one_in(2) {
        return None;
    }
    let (w, h) = (w as f32, h as f32);
    let [min_depth, max_depth] = if r.one_in(2) {
        [0.0, 1.0]
    } else {
        r.pick(&[[0.25, 0.75], [1.0, 0.0], [0.75, 0.125], [0.5, 0.5]])
    };
    let whole = r.one_in(2);
    let [x, y, width, height] = if whole {
        [0.0, 0.0, w, h]
    } else {
        let x = r.float(-0.5 * w, 0.75 * w);
        let y = r.float(-0.5 * h, 0.75 * h);
        [x, y, r.float(0.25, 1.5) * w, r.float(0.25, 1.5) * h]
    };
    Some(Viewport {
        x,
        y,
        width,
        height,
        min_depth,
        max_depth,
    })
}

pub(super) fn scissor(r: &mut Random, [w, h]: [u32; 2]) -> Option<ScissorRect> {
    r.one_in(4).then(|| {
        let (x, y) = (r.below(w), r.below(h));
        ScissorRect {
            x,
            y,
            width: r.below(w - x + 1),
            height: r.below(h - y + 1),
        }
    })
}

fn compare(r: &mut Random) -> CompareFunction {
    r.pick(&CompareFunction::ALL)
}

fn face(r: &mut Random) -> StencilFaceState {
    if r.one_in(4) {
        return StencilFaceState::IGNORE;
    }
    let op = |r: &mut Random| {
        if r.one_in(2) {
            StencilOperation::Keep
        } else {
            r.pick(&StencilOperation::ALL)
        }
    };
    let mask = |r: &mut Random| r.pick(&[0xff, 0xff, 0xff, 0x0f, 0xf0, 0x01, 0x00]);
    StencilFaceState {
        compare: if r.one_in(2) {
            CompareFunction::Always
        } else {
            compare(r)
        },
        fail_op: op(r),
        depth_fail_op: op(r),
        pass_op: op(r),
        read_mask: mask(r),
        write_mask: mask(r),
    }
}

/// State of the shadow volume passes half of the time, anything else otherwise.
pub(super) fn depth_stencil(r: &mut Random) -> DepthStencilState {
    let mut s = match r.below(8) {
        0 => DepthStencilState::opaque(),
        1 => DepthStencilState::z_pass_volumes(),
        2 => DepthStencilState::z_fail_volumes(),
        3 => DepthStencilState::equal_where_stencil_matches(),
        _ => DepthStencilState {
            depth: DepthState {
                compare: compare(r),
                write: r.one_in(2),
                bounds: bounds(r),
            },
            stencil: StencilState {
                front: face(r),
                back: face(r),
            },
            bias: DepthBias::default(),
        },
    };
    if r.one_in(5) {
        s.bias = bias(r);
    }
    s
}

fn bounds(r: &mut Random) -> Option<[f32; 2]> {
    r.one_in(6).then(|| {
        let lo = r.float(0.0, 1.0);
        [lo, r.float(lo, 1.0)]
    })
}

fn bias(r: &mut Random) -> DepthBias {
    DepthBias {
        constant: r.pick(&[0.0, 1.0, -3.0, 1e6]),
        slope: r.pick(&[0.0, 1.0, -2.5]),
        clamp: r.pick(&[0.0, 0.001, -0.001]),
    }
}

pub(super) fn target(r: &mut Random, format: Format) -> ColorTargetState {
    let write_mask = if r.one_in(3) {
        ColorWrites(r.below(16) as u8)
    } else {
        ColorWrites::ALL
    };
    let blend = match format {
        Format::R32Uint => None,
        _ if r.one_in(3) => None,
        _ if r.one_in(3) => Some(r.pick(&[
            BlendState::ADDITIVE,
            BlendState::SUBTRACTIVE,
            BlendState::MIN,
        ])),
        _ => Some(BlendState {
            color: component(r, format),
            alpha: component(r, format),
        }),
    };
    ColorTargetState { blend, write_mask }
}

fn component(r: &mut Random, format: Format) -> BlendComponent {
    let factor = |r: &mut Random| match format {
        Format::R16Sint => r.pick(&[BlendFactor::Zero, BlendFactor::One]),
        _ => r.pick(&BlendFactor::ALL),
    };
    BlendComponent {
        src_factor: factor(r),
        dst_factor: factor(r),
        operation: r.pick(&BlendOperation::ALL),
    }
}
