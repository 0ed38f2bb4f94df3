//! The states that most draws have, in one straight line of code: no clip planes,
//! no bounds, nobody listening, a stencil that only tests or only counts, tests
//! before the shader. Same bits and same counters as the general way in `block`.

use super::block::{self, BlockStage, Env, General, Place, count};
use super::config::{DrawConfig, StencilFace};
use super::depth::{Decision, DepthBlock};
use super::target::DepthTile;
use super::{TileStageCounters, depth_test, output, stencil};
use crate::geometry::Triangle;
use crate::simd::{I32, Lanes, outlined};
use crate::state::CompareFunction;
use crate::texture::Block;
use crate::texture::PACKETS;

/// With a fragment shader, or without.
pub(super) struct Lean<const SHADED: bool>;

impl<const SHADED: bool> BlockStage for Lean<SHADED> {
    const DECIDED_GROUPS: bool = true;

    #[inline(always)]
    fn run<L: Lanes, const D24: bool>(
        l: L,
        env: &mut Env<'_, '_>,
        t: &Triangle,
        place: Place,
        plane: &DepthBlock<D24>,
        decision: Option<Decision>,
        covered: u64,
    ) {
        if t.is_special() {
            return General::run(l, env, t, place, plane, decision, covered);
        }
        let config = env.config;
        count(&mut env.counters.fragments.generated, covered);
        let mut alive = covered;
        if config.attached {
            let face = config.face(t);
            let Some(decision) = block::consult(l, env, face, place, plane, decision, covered)
            else {
                return;
            };
            alive = tests(l, env, face, place, plane, decision, covered);
        }
        if SHADED {
            if alive == 0 {
                return;
            }
            alive = block::shaded(l, env, t, place, plane, alive);
        }
        if SHADED && alive != 0 {
            output::write(l, env, place, alive);
        }
    }
}

/// Stencil and depth tests with their writes; gives what passes both.
#[inline(always)]
fn tests<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    face: &StencilFace,
    place: Place,
    plane: &DepthBlock<D24>,
    decision: Decision,
    covered: u64,
) -> u64 {
    let config = env.config;
    let inside = if config.depth_write {
        env.target.inside(place.x, place.y)
    } else {
        0
    };
    let c = &mut *env.counters;
    let d = env.target.depth.as_mut().expect("tests only with depth");
    let reached = if face.enabled && face.counts.is_none() {
        stencil_test(l, c, face, &d.stencil[place.index], covered)
    } else {
        covered
    };
    let decided = match (config.compare, decision) {
        (CompareFunction::Always, _) | (_, Decision::Pass) => Some(reached),
        (CompareFunction::Never, _) | (_, Decision::Fail) => Some(0),
        _ => None,
    };
    let passed = match decided {
        Some(passed) => {
            if config.depth_write && passed != 0 {
                outlined(
                    l,
                    #[inline(always)]
                    || {
                        let z = plane.packets(l);
                        write(l, config, c, d, place.index, &z, plane, inside, passed);
                    },
                );
            }
            passed
        }
        None => {
            count(&mut c.accesses.z_read, reached);
            outlined(
                l,
                #[inline(always)]
                || {
                    let z = plane.packets(l);
                    let passed = depth_test::compare(
                        l,
                        config.compare,
                        &d.depth[place.index],
                        #[inline(always)]
                        |k| z[k],
                    );
                    let passed = passed & reached;
                    if config.depth_write && passed != 0 {
                        write(l, config, c, d, place.index, &z, plane, inside, passed);
                    }
                    passed
                },
            )
        }
    };
    count(&mut c.fragments.depth_failed, reached & !passed);
    if let Some([on_fail, on_pass]) = face.counts {
        let block = &mut d.stencil[place.index];
        add(l, config, c, block, reached & !passed, on_fail);
        add(l, config, c, block, passed, on_pass);
    }
    passed
}

/// A stencil stage that changes nothing; gives what passes.
#[inline(always)]
fn stencil_test<L: Lanes>(
    l: L,
    c: &mut TileStageCounters,
    face: &StencilFace,
    stored: &Block<u8>,
    mask: u64,
) -> u64 {
    let passed = outlined(
        l,
        #[inline(always)]
        || stencil::test(l, face, stored, mask),
    );
    count(&mut c.fragments.stencil_failed, mask & !passed);
    if face.state.compare.reads_stored() {
        count(&mut c.accesses.stencil_read, mask);
    }
    passed
}

/// Counts ±1 on the pixels of `mask`.
#[inline(always)]
fn add<L: Lanes>(
    l: L,
    config: &DrawConfig<'_>,
    c: &mut TileStageCounters,
    stored: &mut Block<u8>,
    mask: u64,
    step: i8,
) {
    if step != 0 && mask != 0 {
        if config.counting.is_none() {
            count(&mut c.accesses.stencil_read, mask);
            count(&mut c.accesses.stencil_write, mask);
        }
        outlined(
            l,
            #[inline(always)]
            || stencil::add(l, stored, mask, step),
        );
    }
}

/// Writes the plane's depths where `mask` is set.
#[inline(always)]
#[allow(
    clippy::too_many_arguments,
    reason = "the inputs of one pipeline stage"
)]
fn write<L: Lanes, const D24: bool>(
    l: L,
    config: &DrawConfig<'_>,
    c: &mut TileStageCounters,
    d: &mut DepthTile<'_>,
    index: usize,
    z: &[I32<L>; PACKETS],
    plane: &DepthBlock<D24>,
    inside: u64,
    mask: u64,
) {
    let whole = mask == u64::MAX && inside == u64::MAX;
    let span = if whole { Some(plane.span()) } else { None };
    depth_test::write(
        l,
        config,
        c,
        d,
        index,
        span,
        mask,
        #[inline(always)]
        |k| z[k],
    );
}
