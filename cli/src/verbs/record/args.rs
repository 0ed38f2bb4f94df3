//! The command line of `gnomon record`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::{
    EnvArgs, GpuArgs, SceneArgs, parse_rate, parse_setting, parse_size, parse_time,
};

/// Flags of `record`.
#[derive(Debug, Args)]
pub(crate) struct RecordArgs {
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
    /// The trace to write
    #[arg(long, value_name = "FILE.gnt")]
    pub(crate) out: PathBuf,
    /// The time of animated scenes, in seconds: of the frame, or of the first one
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// Record that many frames of an animation
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) frames: Option<u32>,
    /// Frames per second of an animation [default: 24]
    #[arg(long, value_name = "F", value_parser = parse_rate, requires = "frames")]
    pub(crate) fps: Option<f64>,
    /// Leave block accesses out: the trace replays, but says nothing of traffic
    #[arg(long)]
    pub(crate) no_traffic: bool,
    /// Keep what shaders gave instead of the shaders: larger, and drawn again without
    /// the code
    #[arg(long)]
    pub(crate) frozen: bool,
    /// How to execute; no byte of the trace depends on it, but that --no-skip turns off
    /// what techniques leave out themselves.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print one JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
    /// A map that lights the scene.
    #[command(flatten)]
    pub(crate) environment: EnvArgs,
    /// Most area lights fitted to the map, 1 to 1024 [default: 30]
    #[arg(long, value_name = "N", requires = "env")]
    pub(crate) lights: Option<usize>,
}
