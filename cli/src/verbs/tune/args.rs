//! The command line of `gnomon tune`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::{EntryArg, GpuArgs, SceneArgs, parse_entry, parse_rate, parse_size, parse_time};

/// Flags of `tune`.
#[derive(Debug, Args)]
#[command(after_help = TUNE_HELP)]
#[command(group = clap::ArgGroup::new("budget").required(true).multiple(true))]
pub(crate) struct TuneArgs {
    /// The scene.
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Keep the RMSE of visibility at or below this, at the least time
    #[arg(long, value_name = "E", group = "budget", value_parser = parse_limit)]
    pub(crate) max_error: Option<f64>,
    /// Keep building and drawing within so many milliseconds
    #[arg(long, value_name = "T", group = "budget", value_parser = parse_limit)]
    pub(crate) max_ms: Option<f64>,
    /// Keep bytes read and written by a frame at or below this
    #[arg(long, value_name = "B", group = "budget", value_parser = parse_limit)]
    pub(crate) max_bytes: Option<f64>,
    /// Techniques that may be chosen, each with settings that stay if need be:
    /// NAME:KEY=VALUE:... [default: all]
    #[arg(
        long,
        alias = "technique",
        value_name = "NAME,...",
        value_delimiter = ',',
        value_parser = parse_entry
    )]
    pub(crate) techniques: Vec<EntryArg>,
    /// The light that shines, by its number; the others are off
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) light: usize,
    /// Image size in pixels [default: the scene file's, or else 640x480]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// The time of animated scenes, in seconds: of the picture, or of the first frame
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// Keep the budget in each of so many frames of an animation
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) frames: u32,
    /// Frames per second of the animation
    #[arg(long, value_name = "F", value_parser = parse_rate, default_value_t = 24.0)]
    pub(crate) fps: f64,
    /// Folder for the truth, oracle-cache/
    #[arg(
        short = 'o',
        long,
        alias = "out",
        value_name = "DIR",
        default_value = "out"
    )]
    pub(crate) out_dir: PathBuf,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print one JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
}

const TUNE_HELP: &str = "\
Example: gnomon tune creature --max-error 0.02

With --max-error the fastest that keeps all limits wins, else the one that errs least.
Candidates are tried on small pictures first, and the better quarter goes on.

That nothing fits is a result, not an error.

Exit codes: 0 fine, 2 bad input.";

fn parse_limit(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(limit) if limit.is_finite() && limit > 0.0 => Ok(limit),
        _ => Err("expected a number above 0".to_owned()),
    }
}
