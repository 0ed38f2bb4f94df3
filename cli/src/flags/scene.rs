//! Which scene.

use clap::Args;
use gnomon_pipeline::world::files::Outside;
use gnomon_pipeline::world::scene::{SceneError, SceneSource};

/// What to draw.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Built-in scene (see `gnomon scenes`), .toml scene file, or model (.obj, .ply, .gltf, .glb)
    pub(crate) scene: String,
    /// Read files outside the scene's folder too, where the scene names them
    #[arg(long)]
    allow_outside: bool,
}

impl SceneArgs {
    /// The scene, open.
    pub(crate) fn open(&self) -> Result<SceneSource, SceneError> {
        let outside = if self.allow_outside {
            Outside::Allowed
        } else {
            Outside::Refused
        };
        SceneSource::open_with(&self.scene, outside)
    }

    /// The arguments as they were given.
    pub(crate) fn words(&self) -> Vec<String> {
        let outside = self.allow_outside.then(|| "--allow-outside".to_owned());
        std::iter::once(self.scene.clone()).chain(outside).collect()
    }
}
