//! Smoothies: fake soft shadows by geometry round silhouettes (Chan and Durand 2003;
//! docs/papers.md).
//!
//! Per light and view of it: a picture of depths, as for shadow mapping; *smoothies*, fins
//! of fixed width in that picture along the casters' silhouettes, drawn twice: their
//! nearest depths, and by minimum blending their alpha, from 0 at the silhouette to 1 at
//! the outer border, remapped by what lies behind; and a look-up with three cases: behind
//! a blocker it is dark, behind a smoothie alpha is seen, else all of the light.
//!
//! `construction=cones` draws cones and sheets instead (Wyman and Hansen 2003): what lies
//! between a silhouette and the outer border of the penumbra of a round light, each as
//! wide as its own distance from the light asks for.
//!
//! # Known errors, of the method
//!
//! Smoothies lie outside of the umbra of the light's centre, so that umbrae do not shrink
//! as lights grow, and penumbrae have the outer half only. The light's shape does not
//! matter. Alpha is that of the nearest smoothie's surface behind; one smoothie hides the
//! others.
//!
//! # Departures from the paper, and why
//!
//! * r is looked up in a picture of *all* surfaces: the paper's depth map has the floor in
//!   it, but here scenes say that floors cast no shadow.
//! * Corners that turn by more than a quarter are several quads, or they would not hold
//!   the part of a disc that alpha fills.
//! * Where an edge is seen as a point from the light, both of its ends have a corner.
//! * Any mesh casts: borders of open ones are edges of their silhouette.

mod attached;
mod pictures;
mod settings;

use self::pictures::SmoothiePictures;
use self::settings::Settings;
use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::maps::mapped::MapSettings;
use crate::parts::maps::pictured::Pictured;
use crate::technique::{
    Capabilities, Frame, LightKinds, ParamInfo, Params, ShadowKind, Technique, TechniqueError,
};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct Smoothies;

impl Technique for Smoothies {
    fn name(&self) -> &'static str {
        "smoothies"
    }

    fn summary(&self) -> &'static str {
        "shadow mapping with edges softened by geometry round silhouettes (Chan and Durand 2003)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            Settings::PARAMS,
            MapSettings::PARAMS,
            &[HORIZON.info],
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            lights: LightKinds {
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
            views: settings.maps.view,
            skip: settings.maps.skip,
            horizon: params.get(&HORIZON)?,
        };
        pictured.frame(|recording| SmoothiePictures::create(self.name(), &settings, recording))
    }
}
