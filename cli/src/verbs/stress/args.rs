//! The command line of `gnomon stress`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::{EntryArg, GpuArgs, parse_entry, parse_size};

/// Flags of `stress`.
#[derive(Debug, Args)]
#[command(after_help = STRESS_HELP)]
pub(crate) struct StressArgs {
    /// Built-in scene, .toml scene file or model (.obj, .ply, .gltf, .glb)
    #[arg(long, value_name = "SCENE", default_value = "parallel-plates")]
    pub(crate) scene: String,
    /// Read files outside the scene's folder too, where the scene names them
    #[arg(long)]
    pub(crate) allow_outside: bool,
    /// Techniques, each with settings if need be: NAME:KEY=VALUE:... [default: all]
    #[arg(
        long,
        alias = "techniques",
        value_name = "NAME,...",
        value_delimiter = ',',
        value_parser = parse_entry
    )]
    pub(crate) technique: Vec<EntryArg>,
    /// What is varied: scale, offset, slivers, pieces, near, near-d32f, light-size,
    /// light-down, light-near, eye-near, eye-shadow [default: all]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub(crate) axis: Vec<String>,
    /// The light that shines, by its number; the others are off
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) light: usize,
    /// Image size in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "120x80")]
    pub(crate) size: [u32; 2],
    /// Folder for stress.md, stress.csv, stress.json and a plot for each axis
    #[arg(
        short = 'o',
        long,
        alias = "out",
        value_name = "DIR",
        default_value = "out/stress"
    )]
    pub(crate) out_dir: PathBuf,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print the JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
}

const STRESS_HELP: &str = "\
Example: gnomon stress --scene cylinder --technique soft-shadow-volumes,pcss --axis scale,near

Each picture is compared with the exact soft shadow of the same scene. A technique holds
as far as its RMSE is at most 1.25 times that of the scene as it is, plus 0.001.

That a technique breaks down is a result, not an error.

Exit codes: 0 fine, 2 bad input.";
