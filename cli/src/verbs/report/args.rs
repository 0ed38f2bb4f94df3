//! The command line of `gnomon report`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::{EntryArg, GpuArgs, SceneArgs, parse_entry, parse_size, parse_time};

/// Flags of `report`.
#[derive(Debug, Args)]
#[command(after_help = REPORT_HELP)]
pub(crate) struct ReportArgs {
    /// The scene, or the .gnt file of a recorded frame.
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Techniques, each with settings behind colons if need be: NAME:KEY=VALUE:...; may
    /// be repeated; several are then also measured against the exact soft shadow [default:
    /// shadow-volumes]
    #[arg(
        long = "technique",
        alias = "techniques",
        value_name = "NAME,...",
        value_delimiter = ',',
        value_parser = parse_entry
    )]
    pub(crate) techniques: Vec<EntryArg>,
    /// Frame of a trace, the scene being a .gnt file
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) frame: usize,
    /// Image size in pixels [default: the scene file's, or else 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// The page
    #[arg(short = 'o', long, alias = "out-dir", value_name = "FILE.html")]
    pub(crate) out: PathBuf,
    /// Also show what happened to a pixel, column and row from the top left; may be
    /// repeated
    #[arg(long = "pixel", value_name = "X,Y", value_parser = parse_pixel)]
    pub(crate) pixels: Vec<[u32; 2]>,
    /// Profiles of hardware that judge the frame (see docs), or .toml files of your own;
    /// none for none
    #[arg(
        long = "profile",
        value_name = "P,...",
        value_delimiter = ',',
        default_value = "imr-2003,imr-2008,tbr-mali,tbr-adreno"
    )]
    pub(crate) profiles: Vec<String>,
    /// Also write draws and clients for the timeline of trace viewers such as Perfetto,
    /// where bytes take the place of time: logical ones, or the first profile's; with one
    /// technique
    #[arg(long, value_name = "FILE.json")]
    pub(crate) chrome: Option<PathBuf>,
    /// Frames to time; the median is reported
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) repeat: u32,
    /// The time of animated scenes, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
}

const REPORT_HELP: &str = "\
Example: gnomon report demo --technique shadow-volumes --technique soft-shadow-volumes \
--pixel 400,300 --out demo.html

Exit codes: 0 fine, 2 bad input.";

fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once(',').and_then(|(x, y)| {
        let number = |s: &str| s.trim().parse().ok();
        Some([number(x)?, number(y)?])
    });
    parsed.ok_or_else(|| "expected column and row of a pixel, such as 400,300".to_owned())
}
