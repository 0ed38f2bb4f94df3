//! What overlays are drawn from beside the frame: recorded where they need it, and only there.

use gnomon_pipeline::measure::carries::{self, Carries};
use gnomon_pipeline::measure::heat::{self, Heat};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered};
use gnomon_pipeline::technique::{Params, SceneWedges, Technique};
use gnomon_pipeline::world::scene::Scene;

use super::{OverlayKind, Source, needs_heat};
use crate::error::CliError;

/// A frame, as it is drawn.
#[derive(Clone, Copy)]
pub(crate) struct Explained<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) technique: &'a dyn Technique,
    pub(crate) params: &'a Params,
    pub(crate) settings: &'a RenderSettings,
}

/// What overlays need of it.
#[derive(Default)]
pub(crate) struct Recorded {
    heat: Option<Heat>,
    carries: Option<Carries>,
    wedges: Option<SceneWedges>,
}

impl Recorded {
    /// Adds what `kind` needs, unless it is there already.
    pub(crate) fn add(&mut self, kind: OverlayKind, frame: Explained<'_>) -> Result<(), CliError> {
        let (scene, technique, params) = (frame.scene, frame.technique, frame.params);
        match kind {
            OverlayKind::Carries if self.carries.is_none() => {
                frame.check_carries()?;
                self.carries = carries::record(scene, technique, params, frame.settings)?;
            }
            OverlayKind::Wedges if self.wedges.is_none() => {
                self.wedges = technique.wedges(scene, params)?;
            }
            kind if needs_heat(kind) && self.heat.is_none() => {
                self.heat = Some(heat::record(scene, technique, params, frame.settings)?);
            }
            _ => {}
        }
        Ok(())
    }

    /// Together with the frame.
    pub(crate) fn source<'a>(
        &'a self,
        scene: &'a Scene,
        params: &'a Params,
        done: &'a Rendered,
    ) -> Source<'a> {
        Source {
            scene,
            params,
            done,
            heat: self.heat.as_ref(),
            carries: self.carries.as_ref(),
            wedges: self.wedges.as_ref(),
        }
    }
}

impl Explained<'_> {
    /// Refuses carries where the technique, as it is set, keeps none.
    pub(crate) fn check_carries(&self) -> Result<(), CliError> {
        match self.technique.carry_channels(self.params)? {
            Some(_) => Ok(()),
            None => Err(CliError::Flag {
                flag: "--overlay",
                value: OverlayKind::Carries.name().to_owned(),
                valid: format!(
                    "{}, as it is set, adds no coverage up in 8-bit channels; \
                     soft-shadow-volumes-optimised does, and soft-shadow-volumes with \
                     --set buffer=rgba8 or rgba8x2",
                    self.technique.name()
                ),
            }),
        }
    }
}
