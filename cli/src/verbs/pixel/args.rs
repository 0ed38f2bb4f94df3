//! The command line of `gnomon pixel`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::GpuArgs;

/// Flags of `pixel`.
#[derive(Debug, Args)]
pub(crate) struct PixelArgs {
    /// The pixel.
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// A pixel of a frame of a trace.
#[derive(Debug, Args)]
pub(crate) struct PlaceArgs {
    /// The trace
    #[arg(value_name = "FILE.gnt")]
    pub(crate) trace: PathBuf,
    /// Column of the pixel, 0 at the left
    #[arg(value_name = "X")]
    pub(crate) x: u32,
    /// Row of the pixel, 0 at the top
    #[arg(value_name = "Y")]
    pub(crate) y: u32,
    /// The frame of the trace
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) frame: usize,
    /// Which output of the frame is looked at [default: color, or else the first]
    #[arg(long, value_name = "NAME")]
    pub(crate) image: Option<String>,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
}
