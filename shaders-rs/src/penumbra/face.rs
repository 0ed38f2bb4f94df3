//! Paper I as it was implemented (§5, §6): one face of a wedge at a time.
//!
//! Which plane a ray enters by is known, since a face of it is drawn, and intensities are
//! only computed at surfaces inside: full light at front planes, none at back planes, and
//! at side planes none either, since what a wedge gains there its neighbour takes
//! (figure 10). What is left of a wedge then is a step of 255 at its front plane and the
//! intensity of surfaces inside. (255 is the shades of grey that the buffer tells apart, the
//! paper's k of §4: [`WedgeFace::shades`].) It is drawn by the faces on the front plane's side of the
//! eye, of which each ray meets one; the paper takes those that face the eye.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, Lanes, Mask, uniforms};

use super::inside::Values;
use super::intensity::IntensityRates;
use super::seen;
use super::tiles::WedgePlanes;

/// The face that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrossedFace {
    /// The front face, on the way in: 255 are lost, and the surface's intensity won if it
    /// is inside.
    FrontEntered,
    /// The front face, on the way out: 255 are won if the surface lies beyond.
    FrontLeft,
    /// Another: only surfaces inside count.
    Other,
    /// A piece of front plane without wedge: 255 are lost on faces towards the eye, won
    /// on others, if the surface lies beyond.
    Boundary,
}
uniforms!(enum CrossedFace { 0: FrontEntered, 1: FrontLeft, 2: Other, 3: Boundary });

/// Adds to attachment 0 what a ray gains in a wedge. Texture 0 is depth. Discards where
/// nothing changes hands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WedgeFace {
    /// The wedge; of pieces of front plane the first plane is all that counts.
    pub wedge: WedgePlanes,
    /// For surfaces inside.
    pub rates: IntensityRates,
    /// What is drawn.
    pub face: CrossedFace,
    /// The buffer's full light: as many steps of grey has a penumbra (the paper's k).
    pub shades: f32,
}
uniforms!(WedgeFace {
    wedge,
    rates,
    face,
    shades
});

impl FragmentShader for WedgeFace {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let zero = F32::splat(l, 0.0);
        let (point, surface) = seen(l, f, 0);
        let values = Values::new(&self.wedge.planes, &point);
        let passed = self.passes_front(l, &values) & surface;
        let inside = self.is_inside(l, &values) & surface;
        f.discard(!(passed | inside));
        let step = passed.select_f32(F32::splat(l, self.step(f.front_facing())), zero);
        let light = inside.select_f32(values.light(&self.rates, self.shades), zero);
        f.set_color(0, [step + light, zero, zero, zero]);
    }
}

impl WedgeFace {
    /// Where the drawn front plane lies between eye and surface.
    #[inline(always)]
    fn passes_front<L: Lanes>(&self, l: L, values: &Values<L>) -> Mask<L> {
        let within = values.front.ge(F32::splat(l, 0.0));
        match self.face {
            CrossedFace::FrontEntered => within,
            CrossedFace::FrontLeft => !within,
            CrossedFace::Other => Mask::splat(l, false),
            CrossedFace::Boundary => within ^ Mask::splat(l, self.wedge.planes[0].eye_is_inside()),
        }
    }

    #[inline(always)]
    fn is_inside<L: Lanes>(&self, l: L, values: &Values<L>) -> Mask<L> {
        match self.face {
            CrossedFace::Boundary => Mask::splat(l, false),
            CrossedFace::Other => values.inside(-self.wedge.front_margin),
            CrossedFace::FrontEntered | CrossedFace::FrontLeft => values.inside(0.0),
        }
    }

    fn step(&self, front_facing: bool) -> f32 {
        match self.face {
            CrossedFace::FrontEntered => -self.shades,
            CrossedFace::FrontLeft => self.shades,
            CrossedFace::Other => 0.0,
            CrossedFace::Boundary if front_facing => -self.shades,
            CrossedFace::Boundary => self.shades,
        }
    }
}
