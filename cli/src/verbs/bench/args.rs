//! The command line of `gnomon bench`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use gnomon_pipeline::measure::comparison::{ReferenceKind, UnknownReference};
use gnomon_raster::MAX_THREADS;

use super::shard::{Shard, parse_shard};
use crate::flags::{parse_size, parse_time};

/// Flags of `bench`.
#[derive(Debug, Args)]
#[command(
    after_help = BENCH_HELP,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    disable_help_subcommand = true
)]
pub(crate) struct BenchArgs {
    /// Join results instead of measuring.
    #[command(subcommand)]
    pub(crate) verb: Option<BenchVerb>,
    /// Scenes: built-in, .toml or models; or one suite: `standard`, or a .toml file with a
    /// table [suite]
    #[arg(value_name = "SCENE|SUITE", required = true)]
    pub(crate) scenes: Vec<String>,
    /// Techniques, each with a grid of settings if need be: NAME:KEY=V1|V2:...; all for
    /// each one's defaults [default: all]
    #[arg(
        long,
        alias = "technique",
        value_name = "NAME,...",
        value_delimiter = ','
    )]
    pub(crate) techniques: Vec<String>,
    /// Image sizes in pixels [default: 320x240]
    #[arg(long, value_name = "WxH,...", value_delimiter = ',', value_parser = parse_size)]
    pub(crate) size: Vec<[u32; 2]>,
    /// Worker threads, 0 for RAYON_NUM_THREADS or one per core [default: 0]
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = parse_threads)]
    pub(crate) threads: Vec<usize>,
    /// Frames to time, at least 5; the median is reported [default: 5]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(5..=1000))]
    pub(crate) repeat: Option<u32>,
    /// The light that shines, by its number; the others are off [default: 0]
    #[arg(long, value_name = "N")]
    pub(crate) light: Option<usize>,
    /// The time of animated scenes, in seconds [default: 0]
    #[arg(long, value_name = "SECONDS", value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: Option<f64>,
    /// The truth: exact (areas in f64) or rays (4096 shadow rays a pixel) [default: exact]
    #[arg(long, value_name = "NAME", value_parser = parse_reference)]
    pub(crate) reference: Option<ReferenceKind>,
    /// Measure part I of N parts only, I from 1; `bench merge` joins the parts' folders
    #[arg(long, value_name = "I/N", value_parser = parse_shard, default_value = "1/1")]
    pub(crate) shard: Shard,
    /// Stop after so many measurements; the same command goes on later
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) limit: Option<u32>,
    /// Folder for results, tables, plots and the page
    #[arg(
        short = 'o',
        long,
        alias = "out",
        value_name = "DIR",
        default_value = "out/bench"
    )]
    pub(crate) out_dir: PathBuf,
    /// Folder of the truth [default: oracle-cache in the other one]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache_dir: Option<PathBuf>,
    /// Read files outside a scene's folder too, where the scene names them
    #[arg(long)]
    pub(crate) allow_outside: bool,
    /// Print the JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
}

/// What `bench` does besides measuring.
#[derive(Debug, Subcommand)]
pub(crate) enum BenchVerb {
    /// Join the results of shards, and write tables, plots and page again
    Merge(MergeArgs),
}

/// Flags of `bench merge`.
#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// Folders that `gnomon bench` has written
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Folder for all results, tables, plots and the page
    #[arg(short = 'o', long, alias = "out", value_name = "DIR")]
    pub(crate) out_dir: PathBuf,
    /// Print the JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
}

const BENCH_HELP: &str = "\
Example: gnomon bench peer-a creature --techniques 'shadow-volumes,pcf:taps=2|4|8'
Whole comparison: gnomon bench standard --out-dir out/standard
In parts: gnomon bench standard --shard 1/2 --out-dir a; ... --shard 2/2 --out-dir b;
  gnomon bench merge a b --out-dir all

A killed run goes on where it was when it is started again: see docs/benchmarks.md.

Exit codes: 0 fine, 2 bad input.";

fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if n <= MAX_THREADS => Ok(n),
        _ => Err(format!(
            "expected numbers from 0 (one per core) to {MAX_THREADS}, separated by commas"
        )),
    }
}

fn parse_reference(text: &str) -> Result<ReferenceKind, String> {
    text.parse().map_err(|e: UnknownReference| e.to_string())
}
