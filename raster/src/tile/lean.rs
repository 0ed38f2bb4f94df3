//! The states that most draws have, in one straight line of code: no clip planes,
//! no bounds, nobody listening, a stencil that only tests or only counts, tests
//! before the shader. Same bits and same counters as the general way in `block`.

use super::block::{self, BlockStage, Env, General, Place, count, packets};
use super::config::{DrawConfig, StencilFace};
use super::depth::{self, Decision, DepthBlock};
use super::target::DepthTile;
use super::{COUNT, TileStageCounters, output, stencil};
use crate::geometry::Triangle;
use crate::shader::PACKETS;
use crate::simd::{I32, Lanes, Mask, each4, outlined};
use crate::state::CompareFunction;
use crate::texture::{Block, HIZ_STALE};

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
                        write_depth(l, config, c, d, place.index, &z, plane, inside, passed);
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
                    let passed = compare(l, config.compare, &z, &d.depth[place.index]) & reached;
                    if config.depth_write && passed != 0 {
                        write_depth(l, config, c, d, place.index, &z, plane, inside, passed);
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

/// All 64 pixels, covered or not: a branch on which packets matter costs more.
#[inline(always)]
fn compare<L: Lanes>(l: L, f: CompareFunction, z: &[I32<L>; PACKETS], stored: &Block<u32>) -> u64 {
    match f {
        CompareFunction::Less => packets(
            #[inline(always)]
            |k| z[k].lt(depth::load(l, stored, k)).bits(),
        ),
        CompareFunction::LessEqual => packets(
            #[inline(always)]
            |k| z[k].le(depth::load(l, stored, k)).bits(),
        ),
        CompareFunction::Equal => packets(
            #[inline(always)]
            |k| z[k].eq(depth::load(l, stored, k)).bits(),
        ),
        _ => {
            let (mut less, mut equal) = (0, 0);
            for (k, z) in z.iter().enumerate() {
                let s = depth::load(l, stored, k);
                less |= u64::from(z.lt(s).bits()) << (16 * k);
                equal |= u64::from(z.eq(s).bits()) << (16 * k);
            }
            depth::outcome(f, less, equal)
        }
    }
}

/// Writes depth where `mask` is set, and keeps zmin/zmax or marks them stale.
#[inline(always)]
#[allow(
    clippy::too_many_arguments,
    reason = "the inputs of one pipeline stage"
)]
fn write_depth<L: Lanes, const D24: bool>(
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
    if COUNT {
        c.accesses.hiz_write += 1;
    }
    let stored = &mut d.depth[index];
    let differs = matches!(
        config.compare,
        CompareFunction::Less | CompareFunction::Greater | CompareFunction::NotEqual
    );
    if COUNT && !differs {
        let same = each4(
            #[inline(always)]
            |k| {
                let m = Mask::from_bits(l, (mask >> (16 * k)) as u16);
                z[k].eq(depth::load(l, stored, k)) & m
            },
        );
        block::count_lanes(&mut c.events.silent_z_writes, &same);
    }
    for (k, z) in z.iter().enumerate() {
        depth::store(l, stored, k, *z, (mask >> (16 * k)) as u16);
    }
    [d.hiz_min[index], d.hiz_max[index]] = if mask == u64::MAX && inside == u64::MAX {
        plane.span()
    } else {
        HIZ_STALE
    };
}
