//! `gnomon scenes`.

use gnomon_pipeline::world::scene::Scene;
use gnomon_pipeline::world::scene::builtin::{BuiltinScene, SCENES};
use serde::Serialize;

use crate::error::CliError;
use crate::flags::ListArgs;
use crate::output;
use crate::output::wrap::hanging;

#[derive(Serialize)]
struct ScenesDocument {
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

/// Lists the built-in scenes.
pub(crate) fn run(args: &ListArgs) -> Result<(), CliError> {
    if args.json {
        let scenes = SCENES.iter().map(SceneDocument::new).collect();
        return output::print_json(&ScenesDocument { scenes });
    }
    let widest = SCENES.iter().map(|s| s.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for scene in SCENES {
        let name = format!("{:widest$}  ", scene.name);
        text += &hanging(&name, widest + 2, scene.description);
    }
    text += "\nRender one with `gnomon render NAME`, or give a .toml scene or a model\n(.obj, .ply, .gltf, .glb).";
    output::print(&text)
}
