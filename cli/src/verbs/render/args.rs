//! The command line of `gnomon render`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::flags::{
    EnvArgs, GpuArgs, SceneArgs, parse_rate, parse_setting, parse_size, parse_time,
};
use crate::overlay::OverlayKind;

/// Flags of `render`.
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// The scene.
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Technique (see `gnomon techniques`)
    #[arg(long, value_name = "NAME", default_value = "shadow-volumes")]
    pub(crate) technique: String,
    /// A parameter of the technique; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = parse_setting)]
    pub(crate) settings: Vec<(String, String)>,
    /// Image size in pixels [default: the scene file's, or else 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Picture to write [default: out/SCENE-TECHNIQUE.png]; with --frames the folder
    /// of frame-0000.png and so on [default: out/SCENE-TECHNIQUE]
    #[arg(long, value_name = "FILE.png|DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Also write visibility, 1 = fully lit, as a float32 array (height, width)
    #[arg(long, value_name = "FILE.npy")]
    pub(crate) visibility: Option<PathBuf>,
    /// Also write explaining pictures beside the render, as OUT-OVERLAY.png
    #[arg(long, value_name = "OVERLAY", value_enum, value_delimiter = ',')]
    pub(crate) overlay: Vec<OverlayKind>,
    /// Frames to time; the median is reported
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) repeat: u32,
    /// The time of animated scenes, in seconds: of the picture, or of the first frame
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// Render that many frames of an animation, each afresh
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) frames: Option<u32>,
    /// Frames per second of an animation [default: 24]
    #[arg(long, value_name = "F", value_parser = parse_rate, requires = "frames")]
    pub(crate) fps: Option<f64>,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
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
    /// A map that lights the scene.
    #[command(flatten)]
    pub(crate) environment: EnvArgs,
    /// Most area lights fitted to the map, 1 to 1024 [default: 30]
    #[arg(long, value_name = "N", requires = "env")]
    pub(crate) lights: Option<usize>,
}

/// What has work of its own in the JSON document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Per {
    Pass,
    Draw,
}
