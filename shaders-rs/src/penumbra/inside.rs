//! Paper II: the penumbra apart from the umbra.
//!
//! The umbra's boundary is the front planes, which the depth test counts. Whether a
//! surface is inside the wedge then follows from the *same* depth test
//! (docs/papers.md, paper II, hazards), or a surface on the front plane would be counted
//! by one and missed by the other. So a wedge is drawn by its faces on the front plane's
//! side, towards or away from the eye. A ray that meets the front face first of those
//! that enter, or first of those that leave, is decided by that face's own depth; one
//! that meets another is inside of the front plane wherever it is inside of that other,
//! since the wedge is convex. Where depth is 1 there is no surface.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, Lanes, Mask, uniforms};

use super::intensity::{Distances, IntensityRates};
use super::plane::{ScreenPlane, ScreenPoint};
use super::tiles::{TileLookUp, WedgePlanes};
use super::{FULL, at_depth, stored_depth};

/// How a drawn face decides whether a surface is inside of the front plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrontTest {
    /// It is another face, and need not.
    Implied,
    /// It is the front face, which rays enter by: the surface lies beyond it.
    Entered,
    /// It is the front face, which rays leave by: the surface lies on or before it.
    Left,
    /// It is the front face, and the depth test has let pass what is inside. What passes
    /// is counted: 255 are taken off, wedge or no wedge.
    Counted,
}
uniforms!(enum FrontTest { 0: Implied, 1: Entered, 2: Left, 3: Counted });

/// Adds `round(255 s)` to attachment 0 at surfaces inside the wedge, and discards others;
/// with [`FrontTest::Counted`] it discards nothing and adds the umbra's -255 too. Texture
/// 0 is depth, in the format that the draw's depth is in; texture 1 holds classes of tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WedgeInside {
    /// The wedge.
    pub wedge: WedgePlanes,
    /// For the intensity.
    pub rates: IntensityRates,
    /// Which face is drawn.
    pub front: FrontTest,
    /// Classes of tiles, if tiles are culled.
    pub classes: Option<TileLookUp>,
}
uniforms!(WedgeInside {
    wedge,
    rates,
    front,
    classes
});

impl FragmentShader for WedgeInside {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: self.front != FrontTest::Counted,
            textures: 1 + usize::from(self.classes.is_some()),
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let zero = F32::splat(l, 0.0);
        let counted = self.front == FrontTest::Counted;
        let umbra = F32::splat(l, if counted { -FULL } else { 0.0 });
        let nothing = Mask::splat(l, false);
        // No `map_or`: it stays a call, and its lanes would lose their instructions.
        let [culled, accepted] = match &self.classes {
            Some(classes) => classes.classes(l, f, 1),
            None => [nothing; 2],
        };
        if !counted {
            // Lanes without tile left read no depth.
            f.discard(culled);
        }
        if !(f.live() & !culled).any() {
            f.set_color(0, [umbra, zero, zero, zero]);
            return;
        }
        let depth = stored_depth(l, f, 0);
        let (point, surface) = at_depth(l, f, depth);
        let values = Values::new(&self.wedge.planes, &point);
        let tested = values.inside(-self.wedge.front_margin) & self.of_front(l, f, depth);
        let below = self.wedge.below(
            l,
            #[inline(always)]
            |b| b.at(&point),
        );
        let inside = ((tested & !below) | accepted) & surface & !culled;
        if !counted {
            f.discard(!inside);
        }
        let light = inside.select_f32(values.light(&self.rates, FULL), zero);
        f.set_color(0, [umbra + light, zero, zero, zero]);
    }
}

impl WedgeInside {
    /// What the depth of the drawn face says of the front plane.
    #[inline(always)]
    fn of_front<L: Lanes>(&self, l: L, f: &Fragment<'_, L>, surface: F32<L>) -> Mask<L> {
        match self.front {
            FrontTest::Implied | FrontTest::Counted => Mask::splat(l, true),
            FrontTest::Entered => f.depth().lt(surface),
            FrontTest::Left => f.depth().ge(surface),
        }
    }
}

/// Plane values of a surface point.
pub(super) struct Values<L: Lanes> {
    pub(super) front: F32<L>,
    back: F32<L>,
    first: F32<L>,
    second: F32<L>,
}

impl<L: Lanes> Values<L> {
    #[inline(always)]
    pub(super) fn new([front, back, first, second]: &[ScreenPlane; 4], p: &ScreenPoint<L>) -> Self {
        Self {
            front: front.at(p),
            back: back.at(p),
            first: first.at(p),
            second: second.at(p),
        }
    }

    /// Inside of the planes; of the front plane from `front` on.
    #[inline(always)]
    pub(super) fn inside(&self, front: f32) -> Mask<L> {
        let l = self.front.lanes();
        let zero = F32::splat(l, 0.0);
        self.front.ge(F32::splat(l, front))
            & self.back.ge(zero)
            & self.first.ge(zero)
            & self.second.gt(zero)
    }

    /// `full` times the intensity, rounded; meaningful inside.
    #[inline(always)]
    pub(super) fn light(&self, rates: &IntensityRates, full: f32) -> F32<L> {
        let zero = F32::splat(self.front.lanes(), 0.0);
        let s = rates.intensity(&Distances {
            front: self.front.max(zero),
            back: self.back,
            first: self.first,
            second: self.second,
        });
        (s * full).round_ties_even()
    }
}
