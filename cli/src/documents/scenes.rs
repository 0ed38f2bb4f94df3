//! The built-in scenes, as JSON.

use gnomon_pipeline::world::scene::Scene;
use gnomon_pipeline::world::scene::builtin::{BuiltinScene, SCENES};
use serde::Serialize;

/// Scenes that need no file.
#[derive(Serialize)]
pub struct ScenesDocument {
    scenes: Vec<SceneDocument>,
}

#[derive(Serialize)]
struct SceneDocument {
    name: &'static str,
    description: &'static str,
    triangles: usize,
    objects: usize,
    casters: usize,
    lights: usize,
    /// Whether it changes with `--time`.
    animated: bool,
}

impl ScenesDocument {
    /// All of them; each is built, to be counted.
    pub fn built_in() -> Self {
        Self {
            scenes: SCENES.iter().map(SceneDocument::new).collect(),
        }
    }
}

impl SceneDocument {
    fn new(entry: &BuiltinScene) -> Self {
        let scene: Scene = entry.build();
        Self {
            name: entry.name,
            description: entry.description,
            triangles: scene.triangle_count(),
            objects: scene.objects.len(),
            casters: scene.casters().count(),
            lights: scene.lights.len(),
            animated: entry.moves(),
        }
    }
}
