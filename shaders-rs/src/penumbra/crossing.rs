//! Paper I: what the ray of a pixel gains between entering a wedge and leaving it
//! or meeting a surface inside.
//!
//! Draw the wedge's *back* faces, without depth test: each ray that meets the
//! convex wedge in front of the eye leaves it exactly once, also where the eye is
//! inside or on a plane. (The paper takes front faces, of which a wedge round the
//! eye has none; both cover the same pixels.) Entry and exit follow from the four
//! planes.
//!
//! Points on the ray are ordered by q = 1 - depth, which falls from infinity at
//! the eye to 0 at infinity. A plane is met at `-far / d`; wedges that share it
//! find the same q, bit for bit.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, Lanes, Mask, uniforms};

use super::intensity::{Distances, IntensityRates, Interpolation, quotient};
use super::plane::{ScreenPlane, ScreenPoint};
use super::seen;

/// The intensity in a side plane. It uses what two neighbours share and nothing
/// else, so both round it alike and it cancels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideIntensity {
    /// Planes through the side plane's front and back line, square to it,
    /// positive between them.
    pub between: [ScreenPlane; 2],
    /// Along the side direction: the back line's rate over the front line's.
    pub back_over_front: f32,
}
uniforms!(SideIntensity {
    between,
    back_over_front
});

/// Adds `round(255 s)` at the exit, or at a surface before it, less
/// `round(255 s)` at the entry, to attachment 0. Texture 0 is depth. Discards
/// where nothing changes hands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WedgeCrossing {
    /// Front, back, first and second side, positive inside.
    pub planes: [ScreenPlane; 4],
    /// For surfaces inside.
    pub rates: IntensityRates,
    /// For the two side planes, what neighbours share. `None`: equation (3) wherever a ray
    /// enters or leaves, on front and back planes too, and the difference rounded once, as
    /// in the paper's pseudocode (§4): neighbours round apart.
    pub sides: Option<[SideIntensity; 2]>,
    /// `shades` times the intensity at the eye, rounded; for rays that start inside.
    pub at_eye: f32,
    /// The buffer's full light: as many steps of grey has a penumbra (the paper's k, 255).
    pub shades: f32,
}
uniforms!(WedgeCrossing {
    planes,
    rates,
    sides,
    at_eye,
    shades
});

/// Where a ray enters or leaves, and the rounded intensity there.
#[derive(Clone, Copy)]
struct Event<L: Lanes> {
    q: F32<L>,
    value: F32<L>,
}

impl FragmentShader for WedgeCrossing {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (point, surface) = seen(l, f, 0);
        let (entry, exit, misses) = self.events(l, &point);
        // The wedge begins before the surface, and before infinity.
        let met = entry.q.gt(point.q) & entry.q.gt(exit.q) & surface & !misses;
        let inside = point.q.ge(exit.q);
        let gained = inside.select_f32(self.value_at(&point), exit.value) - entry.value;
        let gained = match self.sides {
            Some(_) => gained,
            None => gained.round_ties_even(),
        };
        f.discard(!met);
        let zero = F32::splat(l, 0.0);
        f.set_color(0, [gained, zero, zero, zero]);
    }
}

impl WedgeCrossing {
    /// Entry, exit, and rays that are outside of a plane all along.
    #[inline(always)]
    fn events<L: Lanes>(&self, l: L, point: &ScreenPoint<L>) -> (Event<L>, Event<L>, Mask<L>) {
        let splat = |x: f32| F32::splat(l, x);
        let mut entry = Event {
            q: splat(f32::INFINITY),
            value: splat(self.at_eye),
        };
        let mut exit = Event {
            q: splat(f32::NEG_INFINITY),
            value: splat(0.0),
        };
        let mut misses = Mask::splat(l, false);
        for k in 0..4 {
            let plane = &self.planes[k];
            let far = plane.far(point);
            let rate = plane.0[3];
            if rate == 0.0 {
                misses = misses | far.lt(splat(0.0));
                continue;
            }
            let q = -far / splat(rate);
            let met = Event {
                q,
                value: self.value_on(l, k, point, q),
            };
            if rate < 0.0 {
                entry = pick(q.lt(entry.q), met, entry);
            } else {
                exit = pick(q.gt(exit.q), met, exit);
            }
        }
        (entry, exit, misses)
    }

    /// The rounded intensity where the ray meets plane k.
    #[inline(always)]
    fn value_on<L: Lanes>(&self, l: L, k: usize, point: &ScreenPoint<L>, q: F32<L>) -> F32<L> {
        let zero = F32::splat(l, 0.0);
        let at = ScreenPoint { q, ..*point };
        match (k, &self.sides) {
            (_, None) => self.value_at(&at),
            (0, _) => F32::splat(l, self.shades),
            (1, _) => zero,
            (_, Some(sides)) => {
                let side = &sides[k - 2];
                let front = side.between[0].at(&at).max(zero);
                let back = side.between[1].at(&at).max(zero);
                let s = quotient(back, front * side.back_over_front + back);
                self.rounded(self.interpolation().apply(s))
            }
        }
    }

    /// The intensity at a surface inside, times `shades`; rounded where side planes are.
    #[inline(always)]
    fn value_at<L: Lanes>(&self, point: &ScreenPoint<L>) -> F32<L> {
        let zero = F32::splat(point.q.lanes(), 0.0);
        let [front, back, first, second] = &self.planes;
        let s = self.rates.intensity(&Distances {
            front: front.at(point).max(zero),
            back: back.at(point).max(zero),
            first: first.at(point).max(zero),
            second: second.at(point).max(zero),
        });
        match self.sides {
            Some(_) => self.rounded(s),
            None => s * self.shades,
        }
    }

    /// The buffer's whole number for an intensity.
    #[inline(always)]
    fn rounded<L: Lanes>(&self, s: F32<L>) -> F32<L> {
        (s * self.shades).round_ties_even()
    }

    #[inline(always)]
    fn interpolation(&self) -> Interpolation {
        self.rates.interpolation
    }
}

#[inline(always)]
fn pick<L: Lanes>(first: Mask<L>, a: Event<L>, b: Event<L>) -> Event<L> {
    Event {
        q: first.select_f32(a.q, b.q),
        value: first.select_f32(a.value, b.value),
    }
}
