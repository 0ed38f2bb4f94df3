//! The command line of `gnomon trim`.

use core::ops::Range;
use std::path::PathBuf;

use clap::Args;

use crate::flags::GpuArgs;

/// Flags of `trim`.
#[derive(Debug, Args)]
pub(crate) struct TrimArgs {
    /// The trace
    #[arg(value_name = "FILE.gnt")]
    pub(crate) trace: PathBuf,
    /// Keep these draws of a frame, counted over all its passes; B is not kept
    #[arg(long, value_name = "A..B", value_parser = parse_range, group = "keep")]
    pub(crate) draws: Option<Range<usize>>,
    /// Keep these passes of a frame; B is not kept
    #[arg(long, value_name = "A..B", value_parser = parse_range, group = "keep")]
    pub(crate) passes: Option<Range<usize>>,
    /// Keep these frames; B is not kept
    #[arg(long, value_name = "A..B", value_parser = parse_range, group = "keep")]
    pub(crate) frames: Option<Range<usize>>,
    /// The frame that draws or passes are kept of
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) frame: usize,
    /// The trace to write
    #[arg(short = 'o', long, alias = "out-dir", value_name = "FILE.gnt")]
    pub(crate) out: PathBuf,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
}

fn parse_range(text: &str) -> Result<Range<usize>, String> {
    let valid = || "expected A..B, two numbers, the second larger, such as 5..9".to_owned();
    let (start, end) = text.split_once("..").ok_or_else(valid)?;
    let number = |s: &str| s.parse::<usize>().map_err(|_| valid());
    let range = number(start)?..number(end)?;
    match range.is_empty() {
        true => Err(valid()),
        false => Ok(range),
    }
}
