//! Flags that say how to execute.

use clap::Args;
use gnomon_raster::{GpuConfig, MAX_THREADS, SimdLevel};

/// How to execute; none of it changes a bit of the result.
#[derive(Debug, Args)]
pub(crate) struct GpuArgs {
    /// Most worker threads, 0 for RAYON_NUM_THREADS or one per core
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_threads)]
    pub(crate) threads: usize,
    /// Side of execution tiles in pixels: 16, 32, 64 or 128
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = parse_tile)]
    pub(crate) tile: u32,
    /// Instruction set: auto, scalar, sse2, avx2, avx512 or neon
    #[arg(long, value_name = "LEVEL", default_value = "auto", value_parser = parse_simd)]
    pub(crate) simd: SimdLevel,
    /// Do not use zmin/zmax of 8x8 blocks to skip work
    #[arg(long)]
    pub(crate) no_skip: bool,
}

impl GpuArgs {
    /// As given, or as many as the threads that the program has started with.
    fn threads(&self) -> usize {
        match self.threads {
            0 => rayon::current_num_threads().min(MAX_THREADS),
            n => n,
        }
    }

    /// The GPU's own form.
    pub(crate) fn config(&self) -> GpuConfig {
        GpuConfig {
            threads: self.threads(),
            tile: self.tile,
            simd: self.simd,
            skip: !self.no_skip,
        }
    }
}

fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if n <= MAX_THREADS => Ok(n),
        _ => Err(format!(
            "expected a number from 0 (one per core) to {MAX_THREADS}"
        )),
    }
}

fn parse_tile(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(n) if [16, 32, 64, 128].contains(&n) => Ok(n),
        _ => Err("expected 16, 32, 64 or 128".to_owned()),
    }
}

fn parse_simd(text: &str) -> Result<SimdLevel, String> {
    text.parse()
        .map_err(|e: gnomon_raster::simd::UnknownSimdLevel| e.to_string())
}
