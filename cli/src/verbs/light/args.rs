//! The command line of `gnomon light`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::{SceneArgs, parse_size, parse_time};

/// Flags of `light`.
#[derive(Debug, Args)]
#[command(after_help = "Example: gnomon light demo --pixel 620 420 --out light.png")]
pub(crate) struct LightArgs {
    /// The scene.
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The pixel whose surface looks at the light: column from the left, row from the top
    #[arg(long, num_args = 2, value_names = ["X", "Y"], required = true)]
    pub(crate) pixel: Vec<u32>,
    /// Which light: a rectangle, a disc or a sphere
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) light: usize,
    /// Image size in pixels [default: the scene file's, or else 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// The time of animated scenes, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// Draw the light as it is seen, with the edges before it
    #[arg(short = 'o', long, alias = "out-dir", value_name = "FILE.png")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
