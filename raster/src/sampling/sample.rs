//! Texture look-ups of fragment shaders (`docs/texture-rules.md`).
//!
//! Everything but the gathers runs over lanes. Lanes that agree on mip level and
//! filter are looked up together, so that sizes, planes and decoding are the
//! same for all of them; in most packets there is one such group. All 16 lanes
//! are computed, helpers too, for derivatives of what a look-up gives; only
//! fragments are counted.

use super::address::Axis;
use super::cube::{self, Face};
use super::fetch::{self, Aspect, NO_WORDS, Texels, gather};
use super::lod::{self, Detail, Levels};
use super::{BoundTexture, SlotLog};
use crate::counters::COUNT;
use crate::format::lanes::{Words, decode};

use crate::math;
use crate::simd::{F32, I32, LANES, Lanes, Mask, outlined};
use crate::state::{AddressMode, Sampler};
use crate::texture::{Texture, TextureDimension};

/// Where a texture is looked up.
#[derive(Clone, Copy)]
struct Point<L: Lanes> {
    /// Normalised coordinates.
    at: [F32<L>; 3],
    /// Cube face.
    face: I32<L>,
}

/// One look-up, and the texels that it has read.
struct LookUp<'a, L: Lanes> {
    l: L,
    texture: &'a Texture,
    sampler: &'a Sampler,
    /// Lanes whose reads are counted.
    counted: u16,
    texels: u64,
    log: Option<SlotLog<'a>>,
}

/// Number of axes that are filtered.
fn axes(texture: &Texture) -> usize {
    match texture.desc.dimension {
        TextureDimension::D1 => 1,
        TextureDimension::D2 | TextureDimension::Cube => 2,
        TextureDimension::D3 => 3,
    }
}

impl<L: Lanes> LookUp<'_, L> {
    /// The filtered value.
    #[inline(always)]
    fn sample(&mut self, coord: [F32<L>; 3], detail: &Detail<L>) -> [F32<L>; 4] {
        let mut point = Point {
            at: coord,
            face: I32::splat(self.l, 0),
        };
        let mut face = None;
        if self.texture.desc.dimension == TextureDimension::Cube {
            let f = Face::of(coord);
            point = Point {
                at: f.coordinate(coord),
                face: f.number,
            };
            face = Some(f);
        }
        let lod = self.lod(coord, face, detail);
        let levels = Levels::select(self.sampler, lod, self.texture.desc.mip_levels);
        let mut value = self.sample_levels(&point, &levels);
        for c in &mut value {
            *c = c.canonical_nan();
        }
        value
    }

    /// The level of detail within the sampler's limits.
    #[inline(always)]
    fn lod(&self, coord: [F32<L>; 3], face: Option<Face<L>>, detail: &Detail<L>) -> F32<L> {
        if self.texture.desc.mip_levels == 1 && self.sampler.mag == self.sampler.min {
            return F32::splat(self.l, 0.0);
        }
        let mut gradients = match detail {
            Detail::Level(lod) => return lod::limited(self.sampler, *lod, 0.0),
            Detail::Gradients(g) => *g,
            Detail::Quads => quad_changes(&coord),
        };
        if let Some(f) = face {
            gradients = [
                f.gradient(coord, gradients[0]),
                f.gradient(coord, gradients[1]),
            ];
        }
        let lod = lod::from_gradients(self.texture.desc.size, axes(self.texture), gradients);
        lod::limited(self.sampler, lod, self.sampler.lod_bias)
    }

    /// Both levels of each lane, and their mixture.
    #[inline(always)]
    fn sample_levels(&mut self, point: &Point<L>, levels: &Levels<L>) -> [F32<L>; 4] {
        let zero = F32::splat(self.l, 0.0);
        let between = levels.fraction.gt(zero);
        let mut values = [[zero; 4]; 2];
        for (k, value) in values.iter_mut().enumerate() {
            let lanes = if k == 0 { u16::MAX } else { between.bits() };
            *value = self.sample_groups(point, levels, k as i32, lanes);
        }
        let [a, b] = values;
        let mut out = a;
        for c in 0..4 {
            out[c] = between.select_f32(math::mix(a[c], b[c], levels.fraction), a[c]);
        }
        out
    }

    /// `lanes` at their level plus `step`, group after group; others give 0.
    #[inline(always)]
    fn sample_groups(
        &mut self,
        point: &Point<L>,
        levels: &Levels<L>,
        step: i32,
        lanes: u16,
    ) -> [F32<L>; 4] {
        let level = levels.first + I32::splat(self.l, step);
        let numbers = level.to_array();
        let linear = levels.linear.bits();
        let mut values = [F32::splat(self.l, 0.0); 4];
        let mut rest = lanes;
        while rest != 0 {
            let lane = rest.trailing_zeros();
            let alike = if linear >> lane & 1 != 0 {
                linear
            } else {
                !linear
            };
            let same = level.eq(I32::splat(self.l, numbers[lane as usize])).bits() & alike & rest;
            let v = self.sample_level(point, numbers[lane as usize] as u32, alike == linear, same);
            let mask = Mask::from_bits(self.l, same);
            for c in 0..4 {
                values[c] = mask.select_f32(v[c], values[c]);
            }
            rest &= !same;
        }
        values
    }

    /// One level with one filter; meaningful in `lanes`.
    #[inline(always)]
    fn sample_level(
        &mut self,
        point: &Point<L>,
        level: u32,
        linear: bool,
        lanes: u16,
    ) -> [F32<L>; 4] {
        let count = axes(self.texture);
        let on = self.axes_at(point, level, linear);
        let mut values = [[F32::splat(self.l, 0.0); 4]; 8];
        let taps = if linear { 1 << count } else { 1 };
        for (tap, value) in values.iter_mut().enumerate().take(taps) {
            *value = self.tap(point, &on, level, tap, lanes);
        }
        if linear {
            for (k, axis) in on.iter().enumerate().take(count) {
                for j in 0..taps >> (k + 1) {
                    for c in 0..4 {
                        values[j][c] =
                            math::mix(values[2 * j][c], values[2 * j + 1][c], axis.weight);
                    }
                }
            }
        }
        values[0]
    }

    #[inline(always)]
    fn axes_at(&self, point: &Point<L>, level: u32, linear: bool) -> [Axis<L>; 3] {
        let size = self.texture.mip_size(level);
        let mut on = [Axis::none(self.l); 3];
        for (k, axis) in on.iter_mut().enumerate().take(axes(self.texture)) {
            *axis = axis_of(self, k, linear, &point.at[k], size[k]);
        }
        on
    }

    /// Texel `tap` of up to eight: bit k of `tap` chooses along axis k.
    #[inline(always)]
    fn tap(
        &mut self,
        point: &Point<L>,
        on: &[Axis<L>; 3],
        level: u32,
        tap: usize,
        lanes: u16,
    ) -> [F32<L>; 4] {
        let [i, j, k] = [tap & 1, tap >> 1 & 1, tap >> 2];
        let inside = on[0].inside[i] & on[1].inside[j] & on[2].inside[k];
        let read = inside.bits() & lanes;
        if COUNT {
            self.texels += u64::from((read & self.counted).count_ones());
        }
        let (mut x, mut y) = (on[0].index[i], on[1].index[j]);
        let mut layer = on[2].index[k].to_array();
        if self.texture.desc.dimension == TextureDimension::Cube {
            layer = point.face.to_array();
            let (mut columns, mut rows) = (x.to_array(), y.to_array());
            let size = self.texture.mip_size(level)[0];
            fold_lanes(&mut layer, &mut columns, &mut rows, size);
            (x, y) = (
                I32::from_array(self.l, &columns),
                I32::from_array(self.l, &rows),
            );
        }
        let t = Texels {
            mip: level,
            layer: &layer,
            at: &self.texture.layouts[level as usize]
                .locate_lanes(x, y)
                .to_array(),
            lanes: read,
        };
        let texels = read_texels(self.l, self.texture, &t, self.log.as_mut());
        self.bordered(texels, inside)
    }

    /// The border colour where a texel is not inside; channels that the format
    /// lacks stay 0, alpha 1.
    #[inline(always)]
    fn bordered(&self, mut value: [F32<L>; 4], inside: Mask<L>) -> [F32<L>; 4] {
        if self.sampler.address.contains(&AddressMode::ClampToBorder) && !inside.all() {
            for (c, v) in value
                .iter_mut()
                .enumerate()
                .take(self.texture.desc.format.channels())
            {
                *v = inside.select_f32(*v, F32::splat(self.l, self.sampler.border[c]));
            }
        }
        value
    }
}

// The functions below are never inlined: a shader may hold many look-ups,
// and one body for all of them keeps its code, and the time to compile it, small.
// Inside each, `outlined` brings the level's instruction set back.

/// One filtered look-up: its value and the texels counted.
#[inline(never)]
pub(crate) fn look_up<L: Lanes>(
    l: L,
    bound: &BoundTexture<'_>,
    counted: u16,
    coord: &[F32<L>; 3],
    detail: &Detail<L>,
    log: Option<SlotLog<'_>>,
) -> ([F32<L>; 4], u64) {
    outlined(
        l,
        #[inline(always)]
        || {
            let mut look_up = LookUp {
                l,
                texture: bound.texture,
                sampler: &bound.sampler,
                counted,
                texels: 0,
                log,
            };
            (look_up.sample(*coord, detail), look_up.texels)
        },
    )
}

/// The change of a coordinate over each lane's quad, in x and in y.
#[inline(never)]
fn quad_changes<L: Lanes>(coord: &[F32<L>; 3]) -> [[F32<L>; 3]; 2] {
    outlined(
        coord[0].lanes(),
        #[inline(always)]
        || {
            let mut changes = [*coord; 2];
            for (k, v) in coord.iter().enumerate() {
                changes[0][k] = v.quad_ddx();
                changes[1][k] = v.quad_ddy();
            }
            changes
        },
    )
}

/// Axis `k` of a look-up at `u`, in a level of `size` texels.
#[inline(never)]
fn axis_of<L: Lanes>(
    look_up: &LookUp<'_, L>,
    k: usize,
    linear: bool,
    u: &F32<L>,
    size: u32,
) -> Axis<L> {
    outlined(
        look_up.l,
        #[inline(always)]
        || {
            if look_up.texture.desc.dimension == TextureDimension::Cube {
                Axis::on_face(linear, *u, size)
            } else {
                Axis::new(look_up.sampler.address[k], linear, *u, size)
            }
        },
    )
}

/// Decoded texels.
#[inline(never)]
fn read_texels<L: Lanes>(
    l: L,
    texture: &Texture,
    t: &Texels<'_>,
    log: Option<&mut SlotLog<'_>>,
) -> [F32<L>; 4] {
    let mut words = NO_WORDS;
    gather(texture, Aspect::Main, t, log, &mut words);
    outlined(
        l,
        #[inline(always)]
        || decode(l, texture.desc.format, &words),
    )
}

/// Moves texels beyond the edges of their cube face to the neighbouring face.
fn fold_lanes(layer: &mut [i32; LANES], x: &mut [i32; LANES], y: &mut [i32; LANES], size: u32) {
    let n = size as i32;
    for lane in 0..LANES {
        if x[lane].min(y[lane]) < 0 || x[lane].max(y[lane]) >= n {
            let (face, i, j) = cube::fold(layer[lane] as usize, x[lane], y[lane], n);
            (layer[lane], x[lane], y[lane]) = (face as i32, i, j);
        }
    }
}

/// Puts the stored bits at integer coordinates of level `mip` into `words`, which hold
/// zeros; gives the lanes whose texel exists.
#[inline(always)]
pub(crate) fn fetch_words<L: Lanes>(
    texture: &Texture,
    aspect: Aspect,
    at: [I32<L>; 3],
    mip: u32,
    mut log: Option<SlotLog<'_>>,
    words: &mut Words,
) -> u16 {
    let has_aspect = aspect == Aspect::Main || texture.desc.format.is_depth_stencil();
    if mip >= texture.desc.mip_levels || !has_aspect {
        return 0;
    }
    let [w, h, _] = texture.mip_size(mip);
    let layers = texture.planes[mip as usize].len() as u32;
    let mut inside = fetch::inside(at[0], w);
    let (x, mut y, mut layer) = (at[0], at[1], at[2].to_array());
    match texture.desc.dimension {
        TextureDimension::D1 => (y, layer) = (I32::splat(x.l, 0), [0; LANES]),
        TextureDimension::D2 => {
            inside &= fetch::inside(at[1], h);
            layer = [0; LANES];
        }
        TextureDimension::D3 | TextureDimension::Cube => {
            inside &= fetch::inside(at[1], h) & fetch::inside(at[2], layers);
        }
    }
    let t = Texels {
        mip,
        layer: &layer,
        at: &texture.layouts[mip as usize].locate_lanes(x, y).to_array(),
        lanes: inside,
    };
    gather(texture, aspect, &t, log.as_mut(), words);
    inside
}

/// Decoded texels; zero in all channels outside.
#[inline(always)]
pub(crate) fn decode_fetched<L: Lanes>(
    l: L,
    texture: &Texture,
    words: &Words,
    inside: u16,
) -> [F32<L>; 4] {
    let inside = Mask::from_bits(l, inside);
    let zero = F32::splat(l, 0.0);
    let mut v = decode(l, texture.desc.format, words);
    for c in &mut v {
        *c = inside.select_f32(c.canonical_nan(), zero);
    }
    v
}
