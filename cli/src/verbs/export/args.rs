//! The command line of `gnomon export`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use gnomon_pipeline::world::export::ExportFormat;

use crate::flags::{SceneArgs, parse_size, parse_time};

/// Flags of `export`.
#[derive(Debug, Args)]
#[command(
    after_help = "Files: SCENE.glb (glTF), SCENE.toml with SCENE-N.obj and SCENE.mtl (OBJ), \
and always SCENE.json\nwith camera, lights and matrices.\n\
Example: gnomon export demo --out-dir out/demo && gnomon render out/demo/demo.toml\n\n\
Exit codes: 0 fine, 2 bad input."
)]
pub(crate) struct ExportArgs {
    /// The scene.
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Folder for the files
    #[arg(
        short = 'o',
        long,
        alias = "out",
        value_name = "DIR",
        default_value = "out/export"
    )]
    pub(crate) out_dir: PathBuf,
    /// Formats of the meshes
    #[arg(long, value_name = "FORMAT", value_enum, value_delimiter = ',', default_values_t = [Format::Gltf, Format::Obj])]
    pub(crate) format: Vec<Format>,
    /// Image size in pixels, which the matrices are of [default: the scene file's, or else
    /// 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// The time of animated scenes, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// Formats by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Binary glTF 2.0
    Gltf,
    /// OBJ, and a scene file
    Obj,
}

impl Format {
    pub(super) fn of(self) -> ExportFormat {
        match self {
            Self::Gltf => ExportFormat::Gltf,
            Self::Obj => ExportFormat::Obj,
        }
    }
}
