//! `gnomon scenes`.

use gnomon_pipeline::world::scene::builtin::SCENES;

use crate::documents::ScenesDocument;
use crate::error::CliError;
use crate::flags::ListArgs;
use crate::output;
use crate::output::wrap::hanging;

/// Lists the built-in scenes.
pub(crate) fn run(args: &ListArgs) -> Result<(), CliError> {
    if args.json {
        return output::print_json(&ScenesDocument::built_in());
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
