//! The command line of `gnomon render`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use gnomon_pipeline::measure::render::MAX_SUPERSAMPLE;

use super::show::ShowRequest;
use crate::flags::FrameArgs;
use crate::overlay::OverlayKind;

/// Flags of `render`.
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// What to draw.
    #[command(flatten)]
    pub(crate) frame: FrameArgs,
    /// Picture to write, .png or .exr (linear light, 32-bit floats), or - for a PNG on stdout
    /// [default: out/SCENE-TECHNIQUE.png, with the settings and the time that were given];
    /// with --frames the folder of frame-0000.png and so on [default: out/SCENE-TECHNIQUE]
    #[arg(
        short = 'o',
        long,
        alias = "out-dir",
        value_name = "FILE.png|.exr|-|DIR"
    )]
    pub(crate) out: Option<PathBuf>,
    /// Also write visibility, 1 = fully lit, as a float32 array (height, width)
    #[arg(long, value_name = "FILE.npy")]
    pub(crate) visibility: Option<PathBuf>,
    /// Also write explaining pictures beside the render, as OUT-OVERLAY.png
    #[arg(long, value_name = "OVERLAY", value_enum, value_delimiter = ',')]
    pub(crate) overlay: Vec<OverlayKind>,
    /// Also write what a buffer holds, after a pass or a draw or at the end, by labels or
    /// numbers (`gnomon record` and `dump` list them); .depth or .stencil, :MIP and :LAYER
    /// may stand behind the buffer. PNG has a legend, EXR and NPY all digits [default file:
    /// beside the render]; may be repeated
    #[arg(long, value_name = "BUFFER[@PASS[/DRAW]][=FILE]", value_parser = ShowRequest::parse)]
    pub(crate) show: Vec<ShowRequest>,
    /// Samples along each side of a pixel: the picture is resolved from N x N of them, in
    /// linear light, by a pass that is counted
    #[arg(long, value_name = "N", default_value_t = 1,
        value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SUPERSAMPLE)))]
    pub(crate) supersample: u32,
    /// Frames to time; the median is reported
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) repeat: u32,
    /// Hold the render against the JSON document of an earlier one, and say what differs:
    /// hashes, parameters, counters; exit code 1 if anything does
    #[arg(long, value_name = "BASELINE.json", conflicts_with = "frames")]
    pub(crate) expect: Option<PathBuf>,
    /// Print one JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
    /// What the JSON document has work of, besides the frame: each pass, or each pass
    /// and each draw
    #[arg(long, value_name = "WHAT", value_enum, default_value_t = Per::Pass, requires = "json")]
    pub(crate) per: Per,
    /// Also print what each draw counted, in full numbers, in the order of submission
    #[arg(long, conflicts_with = "frames")]
    pub(crate) draws: bool,
}

/// What has work of its own in the JSON document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Per {
    Pass,
    Draw,
}
