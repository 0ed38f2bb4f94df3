//! Any scene by what a user calls it.

use thiserror::Error;

use super::file::SceneFileError;
use super::{Scene, SceneSource, ViewError};
use crate::world::environment::EnvironmentError;
use crate::world::error::UnknownScene;
use crate::world::model::ModelError;

/// Why a scene could not be had.
#[derive(Debug, Error)]
pub enum SceneError {
    /// Not a path and not a built-in name.
    #[error("{0}; or give the path of a .toml scene or of a model (.obj, .ply, .gltf, .glb)")]
    Unknown(#[from] UnknownScene),
    /// A scene file is wrong.
    #[error(transparent)]
    File(#[from] SceneFileError),
    /// A model is wrong.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The environment is wrong.
    #[error(transparent)]
    Environment(#[from] EnvironmentError),
    /// It cannot be looked at so.
    #[error(transparent)]
    View(#[from] ViewError),
}

/// The scene called `name` at time 0: see [`SceneSource::open`].
///
/// # Errors
/// The file is wrong, or there is no built-in scene of that name.
pub fn open(name: &str) -> Result<Scene, SceneError> {
    SceneSource::open(name)?.at(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kind_of_scene_follows_from_the_name() {
        assert_eq!(open("cylinder").unwrap().name, "cylinder");
        assert!(matches!(open("nowhere.toml"), Err(SceneError::File(_))));
        for model in ["nowhere.OBJ", "nowhere.ply", "nowhere.glTF", "nowhere.glb"] {
            assert!(matches!(open(model), Err(SceneError::Model(_))), "{model}");
        }
        let message = open("cilinder").unwrap_err().to_string();
        assert!(
            message.contains("did you mean 'cylinder'") && message.contains(".toml"),
            "{message}"
        );
    }
}
