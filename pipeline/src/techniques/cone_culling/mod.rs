//! Soft shadows of spheres by cone culling (Bavoil and Silva 2006; docs/papers.md).
//!
//! Per light and view of it, a picture of *micro-patches*: where in the world each texel
//! is, and the radius of the sphere round its rectangle (four float channels). Each
//! receiver sums the solid angles of the patches whose centres are in the cone of its
//! shadow rays, over the light's solid angle.
//!
//! * `method=kernel` looks them up at N points of a disc round the receiver's place on the
//!   view's near plane, Poisson-distributed with Gaussian density and the same for all
//!   receivers; each counts by the reciprocal of its density. The disc holds all that the
//!   cone cuts out of the plane, so that its size follows receiver, light and near distance.
//! * `method=octree` finds all of them by a tree of boxes over the patches, and takes
//!   their rectangles' exact solid angles: the paper's second form, which it has on the
//!   CPU. A node has four children, for no two patches share a texel.
//! * `method=all` looks at every texel: what both are held against.
//!
//! # Known errors, of the method
//!
//! Patches behind each other as the receiver sees them are summed all the same, and what
//! the light's centre does not see is no patch: penumbrae that overlap come out wrong.
//! Spheres' solid angles are π/2 of facing rectangles', so that umbrae are too large. A
//! patch is in a cone or not by its centre: where cones are as narrow as texels, shadows
//! have holes and dots.
//!
//! # Departures from the paper, and why
//!
//! * It does not say how samples are weighted: 1/(N·p), which makes the sum that of all
//!   texels as N grows.
//! * Lights of other shapes are taken for spheres of their area, which is said.

mod pictures;
mod samples;
mod settings;
#[cfg(test)]
mod tests;
mod tree;

use self::pictures::PatchPictures;
use self::settings::Settings;
use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::maps::mapped::ViewSettings;
use crate::parts::maps::pictured::Pictured;
use crate::technique::{
    Capabilities, Frame, LightKinds, ParamInfo, Params, ShadowKind, Technique, TechniqueError,
};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct ConeCulling;

impl Technique for ConeCulling {
    fn name(&self) -> &'static str {
        "cone-culling"
    }

    fn summary(&self) -> &'static str {
        "soft shadows by the solid angles of shadow map patches in cones (Bavoil and Silva 2006)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            Settings::PARAMS,
            ViewSettings::PARAMS,
            &[HORIZON.info],
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            lights: LightKinds {
                points: false,
                directions: false,
                ..LightKinds::ALL
            },
            ..Capabilities::of_light_views(ShadowKind::Soft)
        }
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = Settings::read(params)?;
        let pictured = Pictured {
            scene,
            size,
            frame: settings.frame,
            views: settings.view,
            skip: settings.skip,
            horizon: params.get(&HORIZON)?,
        };
        pictured.frame(|recording| PatchPictures::create(self.name(), &settings, recording))
    }
}
