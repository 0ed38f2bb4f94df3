//! Fixed function on one block: zmin/zmax, bounds, stencil, depth, and what the
//! shader and the output make of the rest (rules §7).

use super::config::{DrawConfig, StencilFace};
use super::depth::{self, Decision, DepthBlock};
use super::target::TileTarget;
use super::{COUNT, ChunkRef, Recorder, TileStageCounters, output, shade, stencil};
use crate::geometry::Triangle;
use crate::observer::BlockAccess;
use crate::shader::{PACKETS, PacketOutput};
use crate::simd::{Lanes, SimdLevel, outlined};
use crate::state::CompareFunction;
use crate::texture::layout::morton;
use crate::texture::{Block, HizEntry};

/// What the triangles of one bin share.
pub(super) struct Env<'a, 't> {
    pub(super) level: SimdLevel,
    pub(super) config: &'a DrawConfig<'a>,
    pub(super) draw: u32,
    pub(super) chunk: &'a ChunkRef<'a>,
    pub(super) target: &'a mut TileTarget<'t>,
    pub(super) counters: &'a mut TileStageCounters,
    pub(super) outputs: &'a mut [PacketOutput; PACKETS],
}

/// One triangle in one block.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Index of the block in the tile's slices.
    pub(super) index: usize,
    /// Its top-left pixel.
    pub(super) x: u32,
    pub(super) y: u32,
}

/// Depths of a block's fragments: planes, or what the shader wrote.
pub(super) enum Depths<const D24: bool> {
    Plane(DepthBlock<D24>),
    Shader(Box<Block<u32>>),
}

#[inline(always)]
fn count(counter: &mut u64, mask: u64) {
    if COUNT {
        *counter += u64::from(mask.count_ones());
    }
}

/// Runs the pixels of `covered` in block (bx, by) of the tile.
#[inline(always)]
pub(super) fn run<L: Lanes, R: Recorder, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    recorder: &mut R,
    t: &Triangle,
    [bx, by]: [i32; 2],
    covered: u64,
) {
    if covered != 0 {
        outlined(
            l,
            #[inline(always)]
            || run_covered::<L, R, D24>(l, env, recorder, t, [bx, by], covered),
        );
    }
}

#[inline(always)]
fn run_covered<L: Lanes, R: Recorder, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    recorder: &mut R,
    t: &Triangle,
    [bx, by]: [i32; 2],
    covered: u64,
) {
    let place = Place {
        index: morton(bx as u32, by as u32),
        x: env.target.x + 8 * bx as u32,
        y: env.target.y + 8 * by as u32,
    };
    let config = env.config;
    let plane = if config.needs_depth {
        DepthBlock::<D24>::new(t, place.x, place.y, config.depth_range)
    } else {
        DepthBlock::<D24>::UNUSED
    };
    let mut mask = covered;
    if !config.depth_clamp {
        mask &= outlined(
            l,
            #[inline(always)]
            || plane.not_beyond_far(l),
        );
    }
    if !config.clip_planes.is_empty() {
        mask &= outlined(
            l,
            #[inline(always)]
            || shade::inside_clip_planes(l, env, t, place),
        );
    }
    if mask != 0 {
        let access = fragments(l, env, t, place, plane, mask);
        if R::ON {
            record(env, recorder, t, place, access);
        }
    }
}

#[inline(always)]
fn fragments<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    plane: DepthBlock<D24>,
    mask: u64,
) -> BlockAccess {
    let config = env.config;
    let face = if t.front { &config.stencil[0] } else { &config.stencil[1] };
    let mut access = BlockAccess { covered: mask, ..BlockAccess::default() };
    count(&mut env.counters.fragments.generated, mask);

    let mut decision = Decision::Unknown;
    if config.hiz {
        decision = ask_hiz(l, env, place, &plane);
        access.hiz_read = true;
        if decision == Decision::Fail && !face.acts_on_depth_failure() {
            if COUNT {
                env.counters.tiles.culled += 1;
            }
            count(&mut env.counters.fragments.hiz_killed, mask);
            return access;
        }
        if COUNT && decision != Decision::Unknown {
            env.counters.tiles.accepted += 1;
        }
    }
    let late = config.is_late(face);
    let mut alive = mask;
    let mut depths = Depths::Plane(plane);
    if late {
        alive = shaded::<D24>(env, t, place, &plane, alive);
        if config.writes_shader_depth {
            depths = Depths::Shader(shade::shader_depths::<D24>(env, alive));
        }
    }
    if config.attached {
        alive = tests::<L, D24>(l, env, place, face, &depths, decision, alive, &mut access);
    }
    if !late && config.shader.is_some() {
        alive = shaded::<D24>(env, t, place, &plane, alive);
    }
    count(&mut env.counters.fragments.written, alive);
    if alive != 0 && config.shader.is_some() {
        output::write(l, env, place, alive, &mut access);
    }
    access
}

/// Runs the shader on `alive`; gives what it did not discard.
#[inline(always)]
fn shaded<const D24: bool>(
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    plane: &DepthBlock<D24>,
    alive: u64,
) -> u64 {
    if alive == 0 {
        return 0;
    }
    if COUNT {
        env.counters.invocations += u64::from(alive.count_ones());
    }
    let discarded = shade::run::<D24>(env, t, place, plane, alive);
    count(&mut env.counters.fragments.discarded, discarded);
    alive & !discarded
}

#[inline(always)]
fn ask_hiz<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    place: Place,
    plane: &DepthBlock<D24>,
) -> Decision {
    if COUNT {
        env.counters.tiles.tested += 1;
        env.counters.accesses.hiz_read += 1;
    }
    let inside = env.target.inside(place.x, place.y);
    let d = env.target.depth.as_mut().expect("zmin/zmax only with depth");
    let entry = &mut d.hiz[place.index];
    if entry.is_stale() {
        *entry = outlined(
            l,
            #[inline(always)]
            || depth::block_range(l, &d.depth[place.index], inside),
        );
    }
    depth::decide(env.config.compare, plane.range(), *entry)
}

/// Bounds, stencil and depth tests with their writes; gives what passes all.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "the inputs of one pipeline stage")]
fn tests<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    place: Place,
    face: &StencilFace,
    depths: &Depths<D24>,
    decision: Decision,
    mask: u64,
    access: &mut BlockAccess,
) -> u64 {
    let config = env.config;
    let c = &mut *env.counters;
    let inside = env.target.inside(place.x, place.y);
    let d = env.target.depth.as_mut().expect("tests only with depth");
    let stored = &mut d.depth[place.index];
    let mut alive = mask;
    if let Some([lo, hi]) = config.bounds {
        let ok = alive
            & outlined(
                l,
                #[inline(always)]
                || within_bounds(l, stored, lo, hi),
            );
        count(&mut c.accesses.z_read, alive);
        access.z_read = alive;
        count(&mut c.fragments.bounds_failed, alive & !ok);
        alive = ok;
    }
    let stencil_block = &mut d.stencil[place.index];
    let stencil_pass = if face.enabled && face.state.compare != CompareFunction::Always {
        outlined(
            l,
            #[inline(always)]
            || stencil::test(l, face, stencil_block, alive),
        )
    } else {
        alive
    };
    count(&mut c.fragments.stencil_failed, alive & !stencil_pass);

    let depth_pass = match (config.compare, decision) {
        (CompareFunction::Always, _) | (_, Decision::Pass) => stencil_pass,
        (CompareFunction::Never, _) | (_, Decision::Fail) => 0,
        _ => {
            if config.bounds.is_none() {
                count(&mut c.accesses.z_read, stencil_pass);
                access.z_read = stencil_pass;
            }
            compare_block(l, config.compare, depths, stored) & stencil_pass
        }
    };
    count(&mut c.fragments.depth_failed, stencil_pass & !depth_pass);
    if face.enabled {
        let outcomes = [alive & !stencil_pass, stencil_pass & !depth_pass, depth_pass];
        outlined(
            l,
            #[inline(always)]
            || update_stencil(l, face, c, stencil_block, alive, outcomes, access),
        );
    }
    if config.depth_write && depth_pass != 0 {
        if COUNT {
            c.accesses.hiz_write += 1;
        }
        count(&mut c.accesses.z_write, depth_pass);
        access.z_write = depth_pass;
        access.hiz_write = true;
        let same = write_block(l, config.compare, depths, stored, depth_pass);
        count(&mut c.events.silent_z_writes, same);
        d.hiz[place.index] = match depths {
            Depths::Plane(p) if depth_pass == u64::MAX && inside == u64::MAX => {
                let [min, max] = p.range();
                HizEntry { min, max }
            }
            _ => HizEntry::STALE,
        };
    }
    depth_pass
}

#[inline(always)]
fn packets(mut f: impl FnMut(usize) -> u16) -> u64 {
    u64::from(f(0)) | u64::from(f(1)) << 16 | u64::from(f(2)) << 32 | u64::from(f(3)) << 48
}

#[inline(always)]
fn within_bounds<L: Lanes>(l: L, stored: &Block<u32>, lo: i32, hi: i32) -> u64 {
    use crate::simd::I32;
    packets(
        #[inline(always)]
        |k| {
            let z = depth::load(l, stored, k);
            (z.ge(I32::splat(l, lo)) & z.le(I32::splat(l, hi))).bits()
        },
    )
}

#[inline(always)]
fn fragment_depth<L: Lanes, const D24: bool>(l: L, depths: &Depths<D24>, k: usize) -> crate::simd::I32<L> {
    match depths {
        Depths::Plane(p) => p.packet(l, k),
        Depths::Shader(b) => depth::load(l, b, k),
    }
}

#[inline(always)]
fn compare_block<L: Lanes, const D24: bool>(
    l: L,
    f: CompareFunction,
    depths: &Depths<D24>,
    stored: &Block<u32>,
) -> u64 {
    let (mut less, mut equal) = (0, 0);
    for k in 0..PACKETS {
        let (z, s) = (fragment_depth(l, depths, k), depth::load(l, stored, k));
        less |= u64::from(z.lt(s).bits()) << (16 * k);
        equal |= u64::from(z.eq(s).bits()) << (16 * k);
    }
    depth::outcome(f, less, equal)
}

/// Writes depth where `mask` is set; gives the pixels whose depth stayed the same.
#[inline(always)]
fn write_block<L: Lanes, const D24: bool>(
    l: L,
    f: CompareFunction,
    depths: &Depths<D24>,
    stored: &mut Block<u32>,
    mask: u64,
) -> u64 {
    let differs = matches!(f, CompareFunction::Less | CompareFunction::Greater | CompareFunction::NotEqual);
    packets(
        #[inline(always)]
        |k| {
            let m = (mask >> (16 * k)) as u16;
            let z = fragment_depth(l, depths, k);
            let same = if differs || !COUNT { 0 } else { z.eq(depth::load(l, stored, k)).bits() & m };
            depth::store(l, stored, k, z, m);
            same
        },
    )
}

/// Applies the three operations; `outcomes` are the pixels that failed the
/// stencil test, failed the depth test, and passed.
#[inline(always)]
fn update_stencil<L: Lanes>(
    l: L,
    face: &StencilFace,
    c: &mut TileStageCounters,
    block: &mut Block<u8>,
    reached: u64,
    outcomes: [u64; 3],
    access: &mut BlockAccess,
) {
    let tested = face.state.compare.reads_stored();
    let mut read = if tested { reached } else { 0 };
    let ops = [face.state.fail_op, face.state.depth_fail_op, face.state.pass_op];
    for k in 0..3 {
        if face.effective[k] && outcomes[k] != 0 {
            if !tested && (ops[k].reads_stored() || face.state.write_mask != 0xff) {
                read |= outcomes[k];
            }
            let same = stencil::apply(l, face, ops[k], block, outcomes[k]);
            count(&mut c.events.silent_stencil_writes, same);
            count(&mut c.accesses.stencil_write, outcomes[k]);
            access.stencil_write |= outcomes[k];
        }
    }
    count(&mut c.accesses.stencil_read, read);
    access.stencil_read = read;
}

#[inline(always)]
fn record<R: Recorder>(env: &Env<'_, '_>, recorder: &mut R, t: &Triangle, place: Place, access: BlockAccess) {
    recorder.record(BlockAccess {
        draw: env.draw,
        primitive: t.primitive,
        piece: u32::from(t.piece),
        block: [(place.x / 8) as u16, (place.y / 8) as u16],
        ..access
    });
}
