//! What a scene file or a command line asks of an environment, and maps that
//! have been read, so that the frames of an animation read theirs once.

use std::sync::Arc;

use super::place;
use crate::world::environment::{Environment, EnvironmentError, Fit, FitSettings, MapSettings};
use crate::world::files::SceneFolder;
use crate::world::scene::Scene;

/// A map by name, and how to make lights of it.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentRequest {
    /// As [`Environment::open`] takes it.
    pub map: String,
    /// The folder that the map must lie in, where a scene names it.
    pub folder: Option<SceneFolder>,
    /// How to read it.
    pub settings: MapSettings,
    /// How to fit it.
    pub fit: FitSettings,
}

impl EnvironmentRequest {
    /// The map called `map`, everything else at its default.
    pub fn new(map: impl Into<String>) -> Self {
        Self {
            map: map.into(),
            folder: None,
            settings: MapSettings::default(),
            fit: FitSettings::default(),
        }
    }

    /// Reads the map, fits it, and lights `scene` by it alone; `known` is asked
    /// first and keeps what was read.
    ///
    /// # Errors
    /// As [`Environment::open`], [`Environment::fit`] and [`place`].
    pub fn light(&self, scene: &mut Scene, known: &mut FittedMaps) -> Result<(), EnvironmentError> {
        let found = known.0.iter().find(|(request, _)| request == self);
        let fitted = match found {
            Some((_, fitted)) => fitted.clone(),
            None => {
                let map = Environment::open_from(&self.map, self.folder.as_ref(), self.settings)?;
                let fit = map.fit(&self.fit)?;
                let fitted = Arc::new((map, fit));
                known.0.push((self.clone(), fitted.clone()));
                fitted
            }
        };
        place(scene, &fitted.0, fitted.1.clone())
    }
}

/// Maps that were read and fitted.
#[derive(Clone, Debug, Default)]
pub struct FittedMaps(Vec<(EnvironmentRequest, Arc<(Environment, Fit)>)>);
