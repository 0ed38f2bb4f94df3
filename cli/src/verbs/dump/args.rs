//! The command line of `gnomon dump`.

use std::path::PathBuf;

use clap::Args;

/// Flags of `dump`.
#[derive(Debug, Args)]
pub(crate) struct DumpArgs {
    /// The trace
    #[arg(value_name = "FILE.gnt")]
    pub(crate) trace: PathBuf,
    /// Which frame
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) frame: usize,
    /// Also draw the frame, and write what each image of each texture holds before and
    /// after: texture-0-mip-0-layer-0-last.npy, what is stored (depth and stencil in files
    /// of their own), and .png, how a colour looks
    #[arg(long, value_name = "DIR")]
    pub(crate) images: Option<PathBuf>,
    /// Also write vertices and indices: pass-0-draw-0-vertices.bin, -indices.bin
    #[arg(long, value_name = "DIR")]
    pub(crate) buffers: Option<PathBuf>,
}
