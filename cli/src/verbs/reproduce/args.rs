//! The command line of `gnomon reproduce`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::{GpuArgs, parse_size};

/// Flags of `reproduce`.
#[derive(Debug, Args)]
#[command(after_help = REPRODUCE_HELP)]
pub(crate) struct ReproduceArgs {
    /// The claim, by its name; all of them without one
    pub(crate) claim: Option<String>,
    /// List the claims and measure nothing
    #[arg(long)]
    pub(crate) list: bool,
    /// Size of pictures in pixels, where a claim does not fix its own
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "512x384")]
    pub(crate) size: [u32; 2],
    /// Folder for plots, CLAIM.svg and CLAIM.png, and for the truth, oracle-cache/
    #[arg(
        short = 'o',
        long,
        alias = "out",
        value_name = "DIR",
        default_value = "out"
    )]
    pub(crate) out_dir: PathBuf,
    /// Frames to time where times are compared; the least time counts
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub(crate) repeat: u32,
    /// Measure whole tables, and pictures of the whole size, where a claim else takes a
    /// part: minutes
    #[arg(long)]
    pub(crate) full: bool,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print one JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
}

const REPRODUCE_HELP: &str = "\
Letters say how a claim can be checked: A exact arithmetic, B a ratio of counters,
C direction and rough ratio of times, D bound to hardware of its time, quoted only.

A claim that does not hold is a result, not an error.

Exit codes: 0 fine, 2 bad input.";
