//! When HiZ is on, by whose rules.

mod anchor_support;

use anchor_support::Case;
use gnomon_raster::LoadOp;
use gnomon_raster::state::{
    CompareFunction, DepthState, DepthStencilState, StencilFaceState, StencilOperation,
};
use gnomon_traces::FrameShape;
use gnomon_traces::profile::DisabledReason::{
    Compare, ContentsInvalid, DepthFailOp, DirectionChanged, NoHiz, NoMemory, ShaderDepth,
    StencilFailOp,
};
use gnomon_traces::profile::{DisabledReason, Judge, profile};

/// A pass of draws with these states.
fn frame(states: &[DepthStencilState]) -> FrameShape {
    let mut shape = Case::new(64, 64).shape();
    let draw = shape.passes[0].draws[0].clone();
    let with = |state: &DepthStencilState| {
        let mut draw = draw.clone();
        draw.depth_stencil = *state;
        draw
    };
    shape.passes[0].draws = states.iter().map(with).collect();
    shape
}

fn reasons(name: &str, shape: &FrameShape) -> Vec<Option<DisabledReason>> {
    let traffic = Judge::new(&profile(name).unwrap(), shape).unwrap().finish();
    let draws = traffic.rows.iter().filter(|r| r.draw.is_some());
    draws.map(|r| r.disabled).collect()
}

fn depth(compare: CompareFunction, write: bool) -> DepthStencilState {
    DepthStencilState {
        depth: DepthState {
            compare,
            write,
            bounds: None,
        },
        ..DepthStencilState::default()
    }
}

const HARDWARE: [&str; 3] = ["imr-2003", "imr-2008", "tbr-adreno"];

#[test]
fn z_fail_volumes_turn_hiz_off_and_z_pass_volumes_do_not() {
    let opaque = DepthStencilState::opaque();
    let fail = frame(&[opaque, DepthStencilState::z_fail_volumes()]);
    let pass = frame(&[opaque, DepthStencilState::z_pass_volumes()]);
    for name in HARDWARE {
        assert_eq!(reasons(name, &fail), [None, Some(DepthFailOp)], "{name}");
        assert_eq!(reasons(name, &pass), [None, None], "{name}");
    }
    for name in ["naive", "compulsory", "tbr-mali"] {
        assert_eq!(reasons(name, &fail), [Some(NoHiz); 2], "{name}");
    }
    assert_eq!(reasons("gnomon", &fail), [None, None]);
}

#[test]
fn one_operation_set_to_keep_turns_it_on_again() {
    let face = |stencil_fails, depth_fails| StencilFaceState {
        fail_op: stencil_fails,
        depth_fail_op: depth_fails,
        ..StencilFaceState::IGNORE
    };
    let (keep, zero) = (StencilOperation::Keep, StencilOperation::Zero);
    let state = |front, back| {
        let mut state = depth(CompareFunction::Less, false);
        (state.stencil.front, state.stencil.back) = (front, back);
        frame(&[DepthStencilState::opaque(), state])
    };
    let second = |name: &str, shape: &FrameShape| reasons(name, shape)[1];
    let quiet = face(keep, keep);
    for name in HARDWARE {
        let fails = |front, back| second(name, &state(front, back));
        assert_eq!(fails(face(keep, zero), quiet), Some(DepthFailOp), "{name}");
        assert_eq!(
            fails(face(zero, keep), quiet),
            Some(StencilFailOp),
            "{name}"
        );
        assert_eq!(fails(quiet, quiet), None, "{name}");
        // Only the simulator leaves the back face out of account.
        let back = (name != "imr-2008").then_some(DepthFailOp);
        assert_eq!(fails(quiet, face(keep, zero)), back, "{name}");
        // Without a bit to write nothing happens.
        let masked = StencilFaceState {
            write_mask: 0,
            ..face(zero, zero)
        };
        assert_eq!(fails(masked, quiet), None, "{name}");
    }
}

#[test]
fn direction_equality_and_contents() {
    use CompareFunction as C;
    let shape = frame(&[
        depth(C::Less, true),
        depth(C::Greater, false),
        depth(C::Equal, false),
        depth(C::Always, true),
        depth(C::Less, true),
    ]);
    let changed = Some(DirectionChanged);
    let compare = Some(Compare);
    let invalid = Some(ContentsInvalid);
    // Mesa leaves HiZ on for Always, whose writes the entries follow.
    assert_eq!(
        reasons("imr-2003", &shape),
        [None, changed, compare, compare, None]
    );
    assert_eq!(
        reasons("imr-2008", &shape),
        [None, compare, None, compare, invalid]
    );
    assert_eq!(
        reasons("tbr-adreno", &shape),
        [None, changed, compare, compare, invalid]
    );
    assert_eq!(reasons("gnomon", &shape), [None, None, None, compare, None]);
}

/// A clear makes contents valid, loading what nobody cleared does not.
#[test]
fn contents_are_valid_from_a_clear_on() {
    let mut shape = frame(&[DepthStencilState::opaque()]);
    let mut second = shape.passes[0].clone();
    second.depth_stencil.as_mut().unwrap().depth_load = LoadOp::Load;
    shape.passes.push(second.clone());
    for name in HARDWARE {
        assert_eq!(reasons(name, &shape), [None, None], "{name}");
    }
    shape.passes = vec![second];
    for name in HARDWARE {
        assert_eq!(reasons(name, &shape), [Some(ContentsInvalid)], "{name}");
    }
}

#[test]
fn shaders_that_write_depth_have_none() {
    let mut shape = frame(&[DepthStencilState::opaque()]);
    shape.passes[0].draws[0].fragment.as_mut().unwrap().depth = true;
    for name in [&HARDWARE[..], &["gnomon"]].concat() {
        assert_eq!(reasons(name, &shape), [Some(ShaderDepth)], "{name}");
    }
}

/// R300: what is drawn first sets the direction, Always that of Less; depth written where
/// HiZ is not allowed leaves it off until the next clear.
#[test]
fn what_turns_hiz_of_r300_off() {
    use CompareFunction as C;
    let of = |states: &[DepthStencilState]| reasons("imr-2003", &frame(states));
    let (less, greater) = (depth(C::Less, true), depth(C::Greater, false));
    let changed = Some(DirectionChanged);
    assert_eq!(
        of(&[depth(C::Always, true), greater, less]),
        [Some(Compare), changed, None]
    );
    assert_eq!(of(&[greater, less]), [None, changed]);
    let invalid = Some(ContentsInvalid);
    for forbidden in [depth(C::Equal, true), depth(C::NotEqual, true)] {
        assert_eq!(of(&[less, forbidden, less]), [None, Some(Compare), invalid]);
    }
    for allowed in [depth(C::Equal, false), depth(C::Never, true)] {
        assert_eq!(of(&[less, allowed, less]), [None, Some(Compare), None]);
    }
    let mut stencil = less;
    stencil.stencil.front.depth_fail_op = StencilOperation::Zero;
    assert_eq!(
        of(&[less, stencil, less]),
        [None, Some(DepthFailOp), invalid]
    );
}

/// Mesa has room for 40,960 blocks with the two pipes of R300.
#[test]
fn large_pictures_have_no_room_on_chip() {
    let of = |width: u32, height: u32| {
        let mut shape = Case::new(width, height).shape();
        shape.passes[0].draws[0].depth_stencil = DepthStencilState::opaque();
        reasons("imr-2003", &shape)
    };
    assert_eq!(of(1920, 1080), [None]);
    assert_eq!(of(2560, 1024), [None]);
    assert_eq!(of(2560, 1032), [Some(NoMemory)]);
}

/// Depth is drawn near, stencil is counted somehow, depth is drawn farther: what low-
/// resolution Z culls of a last draw tells whether the second reached it.
mod low_resolution_z {
    use super::*;
    use anchor_support::draw_layers;
    use gnomon_traces::profile::JudgeOptions;

    /// Culled blocks of the last of three draws at depths 0.5, 0.25, 0.375.
    fn culled(second: DepthStencilState) -> u64 {
        let mut case = draw_layers(1, 0);
        case.layers = vec![0.5, 0.25, 0.375];
        let opaque = DepthStencilState::opaque();
        case.states = vec![opaque, second, opaque];
        let adreno = profile("tbr-adreno").unwrap();
        let traffic = case.judge(&adreno, JudgeOptions::default());
        let draws: Vec<_> = traffic.rows.iter().filter(|r| r.draw.is_some()).collect();
        draws[2].hiz.culled
    }

    #[test]
    fn stencils_that_depend_on_depth_stop_its_writes() {
        let opaque = DepthStencilState::opaque();
        assert_eq!(culled(opaque), 64);
        let mut z_pass = DepthStencilState::z_pass_volumes();
        z_pass.depth.write = true;
        assert_eq!(culled(z_pass), 0);
        let mut z_fail = DepthStencilState::z_fail_volumes();
        z_fail.depth.write = true;
        assert_eq!(culled(z_fail), 0);
        let mut compares = opaque;
        compares.stencil.front.compare = CompareFunction::Equal;
        assert_eq!(culled(compares), 0);
    }
}
