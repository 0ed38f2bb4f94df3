//! What an observer of a pass is told of each event. Only [`super::block::General`] comes
//! here, and only while somebody listens; none of it is lane code.

use super::block::{Env, Place};
use super::config::{DrawConfig, StencilFace};
use super::shade;
use super::witness::{look_at, wrote};
use crate::geometry::Triangle;
use crate::observer::{BlockAccess, BlockLeft, FragmentEnd, FragmentRecord, ShadedBlock, Wants};
use crate::sampling::TexelLog;
use crate::shader::PacketOutput;
use crate::simd::LANES;
use crate::{MAX_COLOR_ATTACHMENTS, MAX_VARYINGS};

/// What a worker gathers for an observer. Events are numbered by their place in `blocks`.
#[derive(Default)]
pub(crate) struct Gathered {
    pub(crate) blocks: Vec<BlockAccess>,
    /// Where each of `blocks` belongs.
    pub(crate) turns: Vec<Turn>,
    pub(crate) left: Vec<BlockLeft>,
    pub(crate) texels: TexelLog,
    pub(crate) fragments: Vec<FragmentRecord>,
    pub(crate) outputs: Vec<ShadedBlock>,
    pub(crate) values: Vec<u32>,
}

/// Where an event belongs among those of a run.
#[derive(Clone, Copy)]
pub(crate) struct Turn {
    /// Number of its triangle among all of the run.
    pub(crate) triangle: u32,
    /// Block row in the upper half, block column in the lower.
    pub(crate) place: u32,
}

/// Somebody listens.
pub(crate) struct Listening<'a> {
    pub(crate) wants: Wants<'a>,
    pub(crate) gathered: &'a mut Gathered,
}

/// The probed pixel's place in its block.
#[derive(Clone, Copy)]
pub(super) struct Probed {
    pixel: usize,
    /// Its depth in the primitive's plane, as it would be stored.
    depth: u32,
    before: PixelState,
}

/// What is stored at a pixel.
#[derive(Clone, Copy, Default)]
struct PixelState {
    depth: u32,
    stencil: u8,
    color: [[u32; 4]; MAX_COLOR_ATTACHMENTS],
}

/// The probed pixel's number in the block at `place`, if it is one of `covered`.
pub(super) fn probed_pixel(env: &Env<'_, '_>, place: Place, covered: u64) -> Option<usize> {
    let [x, y] = env.listening.as_ref()?.wants.probe?;
    let (dx, dy) = (x.wrapping_sub(place.x), y.wrapping_sub(place.y));
    if dx >= 8 || dy >= 8 {
        return None;
    }
    let pixel = (8 * dy + dx) as usize;
    (covered >> pixel & 1 != 0).then_some(pixel)
}

/// Where a debugger can stop: a fragment of the probed pixel comes next, in the order in
/// which observers are told of them.
#[inline(never)]
pub(super) fn reach_probed_fragment(pixel: usize) {
    core::hint::black_box(pixel);
}

impl Probed {
    /// Before anything is done to the block.
    pub(super) fn new(env: &Env<'_, '_>, place: Place, pixel: usize, depth: u32) -> Self {
        Self {
            pixel,
            depth,
            before: PixelState::of(env, place, pixel),
        }
    }
}

impl PixelState {
    fn of(env: &Env<'_, '_>, place: Place, pixel: usize) -> Self {
        let mut state = Self::default();
        if let Some(d) = &env.target.depth {
            state.depth = d.depth[place.index].0[pixel];
            state.stencil = d.stencil[place.index].0[pixel];
        }
        for (i, tile) in env.target.color.iter().enumerate() {
            let format = env.config.targets[i].format;
            state.color[i] = tile.get(format, place.index, pixel);
        }
        state
    }
}

/// Lends the events so far, to which one is added while its block is worked on;
/// [`end`] takes them back.
pub(super) fn begin(env: &mut Env<'_, '_>) -> Vec<BlockAccess> {
    let lent = env.listening.as_mut();
    lent.map_or_else(Vec::new, |l| core::mem::take(&mut l.gathered.blocks))
}

/// Takes the events back that [`begin`] lent.
pub(super) fn end(env: &mut Env<'_, '_>, blocks: Vec<BlockAccess>) {
    if let Some(l) = &mut env.listening {
        l.gathered.blocks = blocks;
    }
}

/// Takes down an event, the last of those that [`begin`] lent, after all is done to the
/// block.
pub(super) fn take_down<const D24: bool>(
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    probed: Option<Probed>,
    access: &mut BlockAccess,
) {
    access.draw = env.draw;
    access.primitive = t.primitive;
    access.piece = u32::from(t.piece);
    access.block = [(place.x / 8) as u16, (place.y / 8) as u16];
    access.front = t.is_front();
    details::<D24>(env, t, place, probed, access);
    let turn = Turn {
        triangle: env.chunk.number(env.triangle),
        place: ((place.y / 8) << 16) | (place.x / 8),
    };
    let Some(l) = &mut env.listening else { return };
    if (l.wants.witness.is_some() || l.wants.left.is_some()) && wrote(access) {
        env.target.untold.add(env.draw, place.index);
        if let Some(w) = l.wants.witness {
            let at = [place.x / 8, place.y / 8];
            access.witness = look_at(env.target, env.config, place.index, at, w, env.level);
        }
    }
    l.gathered.turns.push(turn);
}

/// Takes down what is told beside the event.
fn details<const D24: bool>(
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    probed: Option<Probed>,
    access: &BlockAccess,
) {
    let shaded = shaded(env.config, env.config.face(t), access);
    let record = probed.map(|p| fragment::<D24>(env, place, &p, shaded, access));
    let Some(l) = &mut env.listening else { return };
    let event = l.gathered.turns.len() as u32;
    l.gathered.texels.end_event(event, &env.config.textures);
    if let Some(record) = record {
        l.gathered
            .fragments
            .push(FragmentRecord { event, ..record });
    }
    if l.wants.outputs && shaded != 0 && env.config.constant.is_none() {
        let discarded = access.ended.discarded;
        outputs(
            l.gathered,
            env.config,
            env.outputs,
            event,
            shaded,
            discarded,
        );
    }
}

/// Fragments that were given to the shader, run or not.
fn shaded(config: &DrawConfig<'_>, face: &StencilFace, access: &BlockAccess) -> u64 {
    let e = &access.ended;
    if config.shader.is_none() || e.hiz {
        0
    } else if config.is_late(face) {
        access.covered
    } else {
        access.covered & !(e.bounds | e.stencil | e.depth)
    }
}

/// What became of the probed fragment.
fn fragment<const D24: bool>(
    env: &Env<'_, '_>,
    place: Place,
    p: &Probed,
    shaded: u64,
    access: &BlockAccess,
) -> FragmentRecord {
    let at = |mask: u64| mask >> p.pixel & 1 != 0;
    let after = PixelState::of(env, place, p.pixel);
    let end = end_of(access, at);
    let is_shaded = at(shaded);
    let has_outputs = is_shaded && end != FragmentEnd::Discarded;
    FragmentRecord {
        event: 0,
        end,
        depth: env
            .config
            .attached
            .then(|| depth_of::<D24>(env, p, has_outputs))
            .flatten(),
        stored_depth: [p.before.depth, after.depth],
        stencil: [p.before.stencil, after.stencil],
        varyings: is_shaded.then(|| varyings(env, p.pixel)).flatten(),
        source: has_outputs.then(|| source(env, p.pixel)),
        color: core::array::from_fn(|i| [p.before.color[i], after.color[i]]),
    }
}

fn end_of(access: &BlockAccess, at: impl Fn(u64) -> bool) -> FragmentEnd {
    let e = &access.ended;
    let ends = [
        (e.bounds, FragmentEnd::Bounds),
        (e.stencil, FragmentEnd::Stencil),
        (e.depth, FragmentEnd::Depth),
        (e.discarded, FragmentEnd::Discarded),
    ];
    if e.hiz {
        return FragmentEnd::Hiz;
    }
    let ended = ends.into_iter().find(|(mask, _)| at(*mask));
    ended.map_or(FragmentEnd::Written, |(_, end)| end)
}

fn depth_of<const D24: bool>(env: &Env<'_, '_>, p: &Probed, has_outputs: bool) -> Option<u32> {
    if !env.config.writes_shader_depth {
        return Some(p.depth);
    }
    let out = &env.outputs[p.pixel / LANES];
    has_outputs.then(|| shade::encode_depth::<D24>(env.config, out.depth[p.pixel % LANES]))
}

/// Varyings of a pixel; none where the shader is not run, since it is of one colour.
fn varyings(env: &Env<'_, '_>, pixel: usize) -> Option<[u32; MAX_VARYINGS]> {
    let n = env.config.varyings;
    let planes = &env.varyings.planes();
    env.config.constant.is_none().then(|| {
        core::array::from_fn(|i| match i < n {
            true => canonical(planes.at(i, (pixel % 8) as u32, (pixel / 8) as u32)),
            false => 0,
        })
    })
}

fn canonical(v: f32) -> u32 {
    if v.is_nan() {
        f32::NAN.to_bits()
    } else {
        v.to_bits()
    }
}

/// What the shader gave each attachment.
fn source(env: &Env<'_, '_>, pixel: usize) -> [[u32; 4]; MAX_COLOR_ATTACHMENTS] {
    let mut all = [[0; 4]; MAX_COLOR_ATTACHMENTS];
    for (i, c) in all.iter_mut().enumerate().take(env.config.targets.len()) {
        *c = color(&env.outputs[pixel / LANES], i, pixel % LANES);
    }
    all
}

/// The bits of one fragment's colour: of an integer as they are, of NaN the canonical
/// ones.
fn color(out: &PacketOutput, attachment: usize, lane: usize) -> [u32; 4] {
    let is_integer = out.integers[attachment] >> lane & 1 != 0;
    out.color[attachment].map(|channel| match is_integer {
        true => channel[lane].to_bits(),
        false => canonical(channel[lane]),
    })
}

/// Takes down what the shader gave the fragments of an event.
fn outputs(
    to: &mut Gathered,
    config: &DrawConfig<'_>,
    packets: &[PacketOutput],
    event: u32,
    shaded: u64,
    discarded: u64,
) {
    let mut block = ShadedBlock {
        event,
        shaded,
        discarded,
        integers: [0; MAX_COLOR_ATTACHMENTS],
        first: to.values.len() as u32,
    };
    let attachments = config.targets.len();
    let left = shaded & !discarded;
    for pixel in (0..64).filter(|p| left >> p & 1 != 0) {
        let (out, lane) = (&packets[pixel / LANES], pixel % LANES);
        for i in 0..attachments {
            block.integers[i] |= u64::from(out.integers[i] >> lane & 1) << pixel;
            to.values.extend(color(out, i, lane));
        }
        if config.writes_shader_depth {
            to.values.push(canonical(out.depth[lane]));
        }
    }
    to.outputs.push(block);
}
