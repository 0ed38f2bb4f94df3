//! Fixed function on blocks: zmin/zmax, bounds, stencil, depth, and what the
//! shader and the output make of the rest (rules §7).

use super::config::{DrawConfig, StencilFace};
use super::depth::{self, Decision, Decisions, DepthBlock, GroupDepth};
use super::listen::{self, Listening, Probed};
use super::shade::VaryingCache;
use super::target::TileTarget;
use super::{COUNT, ChunkRef, TileStageCounters, depth_test, output, shade, stencil};
use crate::geometry::Triangle;
use crate::observer::BlockAccess;
use crate::shader::PacketOutput;
use crate::simd::{I32, LANES, Lanes, Mask, SimdLevel, outlined};
use crate::state::CompareFunction;
use crate::texture::Block;
use crate::texture::PACKETS;

/// What the triangles of one bin share.
pub(super) struct Env<'a, 't> {
    pub(super) level: SimdLevel,
    pub(super) config: &'a DrawConfig<'a>,
    pub(super) draw: u32,
    pub(super) chunk: &'a ChunkRef<'a>,
    /// Number of the triangle under way in the chunk.
    pub(super) triangle: u32,
    pub(super) target: &'a mut TileTarget<'t>,
    pub(super) counters: &'a mut TileStageCounters,
    pub(super) outputs: &'a mut [PacketOutput; PACKETS],
    pub(super) varyings: &'a mut VaryingCache,
    /// Somebody may listen.
    pub(super) listening: Option<Listening<'a>>,
}

/// One block of a tile.
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
pub(super) fn count(counter: &mut u64, mask: u64) {
    if COUNT {
        *counter += u64::from(mask.count_ones());
    }
}

/// Counts the lanes of the masks of a block's packets, of which there are rarely any:
/// one test for all is cheaper than moving four masks.
#[inline(always)]
pub(super) fn count_lanes<L: Lanes>(counter: &mut u64, masks: &[Mask<L>; PACKETS]) {
    if COUNT && ((masks[0] | masks[1]) | (masks[2] | masks[3])).bits() != 0 {
        for m in masks {
            *counter += u64::from(m.bits().count_ones());
        }
    }
}

/// 4×4 blocks that a triangle may cover.
pub(super) struct Group<'a> {
    /// Indices of the blocks in the tile's slices; of those of `alive`.
    pub(super) slots: &'a [i32; LANES],
    /// Blocks that may have covered pixels.
    pub(super) alive: u16,
    /// Those of which all pixels are covered.
    pub(super) full: u16,
    /// What zmin/zmax say.
    pub(super) decided: Decisions,
}

/// zmin and zmax of the group's blocks of `alive`, and what they decide.
#[inline(always)]
pub(super) fn ask_group<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    slots: &[i32; LANES],
    aligned: bool,
    alive: u16,
    depth: &GroupDepth<L, D24>,
) -> Decisions {
    let [mut min, mut max] = load_group(l, env, slots, aligned, alive);
    let stale = min.gt(max).bits() & alive;
    if stale != 0 {
        outlined(
            l,
            #[inline(always)]
            || refresh(l, env, slots, stale),
        );
        [min, max] = load_group(l, env, slots, aligned, alive);
    }
    depth::decide_group(env.config.compare, depth.span(), [min, max])
}

#[inline(always)]
fn load_group<L: Lanes>(
    l: L,
    env: &Env<'_, '_>,
    slots: &[i32; LANES],
    aligned: bool,
    alive: u16,
) -> [I32<L>; 2] {
    let d = env
        .target
        .depth
        .as_ref()
        .expect("zmin/zmax only with depth");
    let first = slots[0] as usize;
    if aligned
        && let (Some(min), Some(max)) = (
            d.hiz_min.get(first..first + LANES),
            d.hiz_max.get(first..first + LANES),
        )
    {
        return [
            I32::from_array(l, min.try_into().expect("16 entries")),
            I32::from_array(l, max.try_into().expect("16 entries")),
        ];
    }
    let (mut min, mut max) = ([0; LANES], [0; LANES]);
    let mut left = alive;
    while left != 0 {
        let i = left.trailing_zeros() as usize;
        left &= left - 1;
        let slot = slots[i] as usize;
        (min[i], max[i]) = (d.hiz_min[slot], d.hiz_max[slot]);
    }
    [I32::from_array(l, &min), I32::from_array(l, &max)]
}

/// Finds zmin and zmax of the blocks of `stale` again.
#[inline(always)]
fn refresh<L: Lanes>(l: L, env: &mut Env<'_, '_>, slots: &[i32; LANES], stale: u16) {
    let (x, y) = (env.target.x, env.target.y);
    let mut left = stale;
    while left != 0 {
        let index = slots[left.trailing_zeros() as usize] as usize;
        left &= left - 1;
        let (bx, by) = crate::texture::layout::unmorton(index);
        let inside = env.target.inside(x + 8 * bx, y + 8 * by);
        let d = env
            .target
            .depth
            .as_mut()
            .expect("zmin/zmax only with depth");
        [d.hiz_min[index], d.hiz_max[index]] = depth::block_range(l, &d.depth[index], inside);
    }
}

/// Runs those blocks of a group whose depths nobody needs to look at, and gives
/// them: thrown away by zmin/zmax, or decided with at most one stencil count to
/// add. `mask` gives the covered pixels of a block.
///
/// ```text
/// thrown = blocks that zmin/zmax fail, where that has no effect
/// if depth is not written, nothing is shaded, and the stencil only counts:
///     pass, fail = the blocks whose test is decided
///     add their counts to all of a full block, or to its covered pixels
/// ```
#[inline(always)]
pub(super) fn run_group<L: Lanes>(
    l: L,
    env: &mut Env<'_, '_>,
    face: &StencilFace,
    group: &Group<'_>,
    mask: impl Fn(usize) -> u64,
) -> u16 {
    let config = env.config;
    let thrown = if config.hiz && !face.acts_on_depth_failure() {
        throw_away(env, group, &mask)
    } else {
        0
    };
    if config.shader.is_some() || config.depth_write || !config.attached {
        return thrown;
    }
    let Some([on_fail, on_pass]) = face.counts else {
        return thrown;
    };
    let &Group { alive, decided, .. } = group;
    let (pass, fail) = match config.compare {
        CompareFunction::Always => (alive, 0),
        CompareFunction::Never => (0, alive),
        _ => (alive & decided.pass, alive & decided.fail & !thrown),
    };
    count_stencil(l, env, group, pass, on_pass, false, &mask);
    count_stencil(l, env, group, fail, on_fail, true, &mask);
    thrown | pass | fail
}

/// Counts the blocks that zmin/zmax throw away, and gives them.
#[inline(always)]
fn throw_away(env: &mut Env<'_, '_>, group: &Group<'_>, mask: &impl Fn(usize) -> u64) -> u16 {
    let thrown = group.alive & group.decided.fail;
    if COUNT && thrown != 0 {
        let (mut blocks, mut pixels) = whole(thrown & group.full);
        each_block(
            thrown & !group.full,
            #[inline(always)]
            |i| tally(&mut blocks, &mut pixels, mask(i)),
        );
        let c = &mut *env.counters;
        c.fragments.generated += pixels;
        c.fragments.hiz_killed += pixels;
        c.tiles.tested += blocks;
        c.tiles.culled += blocks;
    }
    thrown
}

/// Adds `step` to the stencil of the covered pixels of the blocks of `run`, which have
/// all passed the depth test or all `failed` it.
#[inline(always)]
fn count_stencil<L: Lanes>(
    l: L,
    env: &mut Env<'_, '_>,
    group: &Group<'_>,
    run: u16,
    step: i8,
    failed: bool,
    mask: &impl Fn(usize) -> u64,
) {
    if run == 0 {
        return;
    }
    let config = env.config;
    let full = run & group.full;
    let (mut blocks, mut pixels) = whole(full);
    if step != 0 {
        let d = env.target.depth.as_mut().expect("attached");
        each_block(
            full,
            #[inline(always)]
            |i| stencil::add_to_all(l, &mut d.stencil[group.slots[i] as usize], step),
        );
        each_block(
            run & !full,
            #[inline(always)]
            |i| {
                let m = mask(i);
                tally(&mut blocks, &mut pixels, m);
                stencil::add(l, &mut d.stencil[group.slots[i] as usize], m, step);
            },
        );
    } else if COUNT {
        each_block(
            run & !full,
            #[inline(always)]
            |i| tally(&mut blocks, &mut pixels, mask(i)),
        );
    }
    if COUNT {
        let c = &mut *env.counters;
        c.fragments.generated += pixels;
        if failed {
            c.fragments.depth_failed += pixels;
        }
        if config.hiz {
            c.tiles.tested += blocks;
            c.tiles.accepted += blocks;
        }
        if config.counting.is_none() && step != 0 {
            c.accesses.stencil_read += pixels;
            c.accesses.stencil_write += pixels;
        }
    }
}

/// How many blocks and pixels.
#[inline(always)]
fn whole(blocks: u16) -> (u64, u64) {
    let n = u64::from(blocks.count_ones());
    (n, 64 * n)
}

/// Counts a block of which `mask` is covered, which may be nothing.
#[inline(always)]
fn tally(blocks: &mut u64, pixels: &mut u64, mask: u64) {
    if COUNT {
        *blocks += u64::from(mask != 0);
        *pixels += u64::from(mask.count_ones());
    }
}

#[inline(always)]
fn each_block(which: u16, mut f: impl FnMut(usize)) {
    let mut left = which;
    while left != 0 {
        f(left.trailing_zeros() as usize);
        left &= left - 1;
    }
}

/// What is done with the covered pixels of a block.
pub(super) trait BlockStage {
    /// [`run_group`] may take blocks away.
    const DECIDED_GROUPS: bool;

    /// Runs the pixels of `covered` of one block; `decision` is what a group's
    /// zmin/zmax have said, if they were asked.
    fn run<L: Lanes, const D24: bool>(
        l: L,
        env: &mut Env<'_, '_>,
        t: &Triangle,
        place: Place,
        plane: &DepthBlock<D24>,
        decision: Option<Decision>,
        covered: u64,
    );
}

/// Any state, with or without an observer.
pub(super) struct General;

impl BlockStage for General {
    const DECIDED_GROUPS: bool = false;

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
        outlined(
            l,
            #[inline(always)]
            || run_covered::<L, D24>(l, env, t, place, plane, decision, covered),
        );
    }
}

#[inline(always)]
fn run_covered<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    plane: &DepthBlock<D24>,
    decision: Option<Decision>,
    covered: u64,
) {
    let config = env.config;
    let mut mask = covered;
    if !config.plain || t.is_cut_far() {
        mask &= outlined(
            l,
            #[inline(always)]
            || visible::<L, D24>(l, env, t, place),
        );
    }
    if mask != 0 {
        if env.listening.is_some() {
            return listened::<L, D24>(l, env, t, place, plane, decision, mask);
        }
        let face = config.face(t);
        let mut access = BlockAccess::default();
        fragments(l, env, t, face, place, plane, decision, mask, &mut access);
    }
}

/// As [`fragments`], and takes down what they did.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn listened<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    plane: &DepthBlock<D24>,
    decision: Option<Decision>,
    mask: u64,
) {
    let probed = listen::probed_pixel(env, place, mask).map(
        #[inline(always)]
        |pixel| {
            listen::reach_probed_fragment(pixel);
            let packet = plane.packet(l, pixel / LANES).to_array();
            Probed::new(env, place, pixel, packet[pixel % LANES] as u32)
        },
    );
    let face = env.config.face(t);
    // The event is made where it will stay: it is too large to be moved for nothing.
    let mut blocks = listen::begin(env);
    let event = blocks.len();
    blocks.push(BlockAccess::default());
    let access = &mut blocks[event];
    fragments(l, env, t, face, place, plane, decision, mask, access);
    listen::take_down::<D24>(env, t, place, probed, access);
    listen::end(env, blocks);
}

/// Pixels on the right side of clip planes and of the far end.
#[inline(always)]
fn visible<L: Lanes, const D24: bool>(l: L, env: &Env<'_, '_>, t: &Triangle, place: Place) -> u64 {
    let c = env.config;
    let near = if t.is_cut_far() {
        DepthBlock::<D24>::not_beyond_far(l, t, place.x, place.y, c.depth_range, c.depth_reversed)
    } else {
        u64::MAX
    };
    near & shade::inside_clip_planes(l, env, t, place)
}

/// Asks zmin/zmax where the draw uses them; `None` where the block is thrown away.
#[inline(always)]
pub(super) fn consult<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    face: &StencilFace,
    place: Place,
    plane: &DepthBlock<D24>,
    decision: Option<Decision>,
    mask: u64,
) -> Option<Decision> {
    if !env.config.hiz {
        return Some(Decision::Unknown);
    }
    let decision = decision.unwrap_or_else(
        #[inline(always)]
        || ask_hiz(l, env, place, plane),
    );
    let c = &mut *env.counters;
    if COUNT {
        c.tiles.tested += 1;
    }
    if decision == Decision::Fail && !face.acts_on_depth_failure() {
        if COUNT {
            c.tiles.culled += 1;
        }
        count(&mut c.fragments.hiz_killed, mask);
        return None;
    }
    if COUNT && decision != Decision::Unknown {
        c.tiles.accepted += 1;
    }
    Some(decision)
}

/// What becomes of the pixels of `mask`, also as an access that begins empty.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "one triangle in one block")]
fn fragments<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    face: &StencilFace,
    place: Place,
    plane: &DepthBlock<D24>,
    decision: Option<Decision>,
    mask: u64,
    access: &mut BlockAccess,
) {
    let config = env.config;
    access.covered = mask;
    access.hiz_read = config.hiz;
    count(&mut env.counters.fragments.generated, mask);
    if config.depth_ranges {
        (access.span, access.stored) = outlined(
            l,
            #[inline(always)]
            || depth_ranges(l, env, place, plane),
        );
    }
    let Some(decision) = consult(l, env, face, place, plane, decision, mask) else {
        access.ended.hiz = true;
        return;
    };
    let late = config.is_late(face);
    let mut alive = mask;
    let mut depths = Depths::Plane(*plane);
    if late {
        alive = shaded::<L, D24>(l, env, t, place, plane, alive);
        access.ended.discarded = mask & !alive;
        if config.writes_shader_depth {
            depths = Depths::Shader(shade::shader_depths::<D24>(env, alive));
        }
    }
    if config.attached {
        alive = outlined(
            l,
            #[inline(always)]
            || tests::<L, D24>(l, env, place, face, &depths, decision, alive, access),
        );
    }
    if !late && config.shader.is_some() {
        let tested = alive;
        alive = shaded::<L, D24>(l, env, t, place, plane, alive);
        access.ended.discarded = tested & !alive;
    }
    if alive != 0 && config.shader.is_some() {
        output::write(l, env, place, alive);
        color_access(config, alive, access);
    }
}

/// Depths of the plane in the block, and of what is stored there.
#[inline(always)]
fn depth_ranges<L: Lanes, const D24: bool>(
    l: L,
    env: &Env<'_, '_>,
    place: Place,
    plane: &DepthBlock<D24>,
) -> ([u32; 2], [u32; 2]) {
    let d = env.target.depth.as_ref().expect("ranges only with depth");
    let mut stored = [d.hiz_min[place.index], d.hiz_max[place.index]];
    // What is stale stays so: listening changes nothing.
    if stored[0] > stored[1] {
        let inside = env.target.inside(place.x, place.y);
        stored = depth::block_range(l, &d.depth[place.index], inside);
    }
    let unsigned = |[low, high]: [i32; 2]| [low as u32, high as u32];
    (unsigned(plane.span()), unsigned(stored))
}

fn color_access(config: &DrawConfig<'_>, live: u64, access: &mut BlockAccess) {
    for (i, target) in config.targets.iter().enumerate() {
        access.color_write[i] = if target.mask.0 != 0 { live } else { 0 };
        access.color_read[i] = if target.reads { live } else { 0 };
    }
}

/// Runs the shader on `alive`; gives what it did not discard.
#[inline(always)]
pub(super) fn shaded<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    plane: &DepthBlock<D24>,
    alive: u64,
) -> u64 {
    if alive == 0 {
        return 0;
    }
    if !env.config.lean {
        count(&mut env.counters.invocations, alive);
    }
    let discarded = shade::run::<L, D24>(l, env, t, place, plane, alive);
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
    let inside = env.target.inside(place.x, place.y);
    let d = env
        .target
        .depth
        .as_mut()
        .expect("zmin/zmax only with depth");
    let (min, max) = (&mut d.hiz_min[place.index], &mut d.hiz_max[place.index]);
    if *min > *max {
        [*min, *max] = outlined(
            l,
            #[inline(always)]
            || depth::block_range(l, &d.depth[place.index], inside),
        );
    }
    depth::decide(env.config.compare, plane.span(), [*min, *max])
}

/// Bounds, stencil and depth tests with their writes; gives what passes all.
#[inline(always)]
#[allow(
    clippy::too_many_arguments,
    reason = "the inputs of one pipeline stage"
)]
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
        let ok = within_bounds(l, stored, lo, hi) & alive;
        count(&mut c.accesses.z_read, alive);
        access.z_read = alive;
        count(&mut c.fragments.bounds_failed, alive & !ok);
        access.ended.bounds = alive & !ok;
        alive = ok;
    }
    let stencil_block = &mut d.stencil[place.index];
    let stencil_pass = if face.enabled {
        stencil::test(l, face, stencil_block, alive)
    } else {
        alive
    };
    count(&mut c.fragments.stencil_failed, alive & !stencil_pass);
    access.ended.stencil = alive & !stencil_pass;

    let depth_pass = match (config.compare, decision) {
        (CompareFunction::Always, _) | (_, Decision::Pass) => stencil_pass,
        (CompareFunction::Never, _) | (_, Decision::Fail) => 0,
        _ => {
            if config.bounds.is_none() {
                count(&mut c.accesses.z_read, stencil_pass);
                access.z_read = stencil_pass;
            }
            let passed = depth_test::compare(
                l,
                config.compare,
                stored,
                #[inline(always)]
                |k| fragment_depth(l, depths, k),
            );
            passed & stencil_pass
        }
    };
    count(&mut c.fragments.depth_failed, stencil_pass & !depth_pass);
    access.ended.depth = stencil_pass & !depth_pass;
    if face.enabled {
        let outcomes = [
            alive & !stencil_pass,
            stencil_pass & !depth_pass,
            depth_pass,
        ];
        update_stencil(l, face, c, stencil_block, alive, outcomes, access);
    }
    if config.depth_write && depth_pass != 0 {
        access.z_write = depth_pass;
        access.hiz_write = true;
        let span = match depths {
            Depths::Plane(p) if depth_pass == u64::MAX && inside == u64::MAX => Some(p.span()),
            _ => None,
        };
        depth_test::write(
            l,
            config,
            c,
            d,
            place.index,
            span,
            depth_pass,
            #[inline(always)]
            |k| fragment_depth(l, depths, k),
        );
    }
    depth_pass
}

#[inline(always)]
pub(super) fn packets(mut f: impl FnMut(usize) -> u16) -> u64 {
    u64::from(f(0)) | u64::from(f(1)) << 16 | u64::from(f(2)) << 32 | u64::from(f(3)) << 48
}

#[inline(always)]
fn within_bounds<L: Lanes>(l: L, stored: &Block<u32>, lo: i32, hi: i32) -> u64 {
    packets(
        #[inline(always)]
        |k| {
            let z = depth::load(l, stored, k);
            (z.ge(I32::splat(l, lo)) & z.le(I32::splat(l, hi))).bits()
        },
    )
}

#[inline(always)]
fn fragment_depth<L: Lanes, const D24: bool>(l: L, depths: &Depths<D24>, k: usize) -> I32<L> {
    match depths {
        Depths::Plane(p) => p.packet(l, k),
        Depths::Shader(b) => depth::load(l, b, k),
    }
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
    let ops = [
        face.state.fail_op,
        face.state.depth_fail_op,
        face.state.pass_op,
    ];
    for k in 0..3 {
        if face.effective[k] && outcomes[k] != 0 {
            if !tested && (ops[k].reads_stored() || face.state.write_mask != 0xff) {
                read |= outcomes[k];
            }
            let same = outlined(
                l,
                #[inline(always)]
                || stencil::apply(l, face, ops[k], block, outcomes[k]),
            );
            count(&mut c.events.silent_stencil_writes, same);
            count(&mut c.accesses.stencil_write, outcomes[k]);
            access.stencil_write |= outcomes[k];
        }
    }
    count(&mut c.accesses.stencil_read, read);
    access.stencil_read = read;
}
