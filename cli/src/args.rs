//! The command line: verbs, flags and the values they take.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use gnomon_raster::{GpuConfig, MAX_TEXTURE_SIZE, MAX_THREADS, SimdLevel};

/// A deterministic software GPU for shadow algorithms that counts memory traffic.
#[derive(Debug, Parser)]
#[command(name = "gnomon", version, propagate_version = true)]
#[command(after_help = "Exit codes: 0 fine, 1 differs or check failed, 2 bad input.")]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Render the default scene with the principal techniques and show what each cost
    Demo(DemoArgs),
    /// Render one frame of a scene
    Render(Box<RenderArgs>),
    /// List the built-in scenes
    Scenes(ListArgs),
    /// List the techniques and their parameters
    Techniques(ListArgs),
}

/// Flags of the listing verbs.
#[derive(Debug, Args)]
pub(crate) struct ListArgs {
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// Flags of `demo`.
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Folder for pictures and the report
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out_dir: PathBuf,
    /// Image size in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "960x640")]
    pub(crate) size: [u32; 2],
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print one JSON document on stdout, the tables on stderr
    #[arg(long)]
    pub(crate) json: bool,
}

/// Flags of `render`.
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// Built-in scene (see `gnomon scenes`), .toml scene file or .obj model
    pub(crate) scene: String,
    /// Technique (see `gnomon techniques`)
    #[arg(long, value_name = "NAME", default_value = "shadow-volumes")]
    pub(crate) technique: String,
    /// A parameter of the technique; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = parse_setting)]
    pub(crate) settings: Vec<(String, String)>,
    /// Image size in pixels [default: the scene file's, or else 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Picture to write [default: out/SCENE-TECHNIQUE.png]
    #[arg(long, value_name = "FILE.png")]
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
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print one JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
}

/// How to execute; none of it changes a bit of the result.
#[derive(Debug, Args)]
pub(crate) struct GpuArgs {
    /// Worker threads, 0 for one per core
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
    /// The GPU's own form.
    pub(crate) fn config(&self) -> GpuConfig {
        GpuConfig {
            threads: self.threads,
            tile: self.tile,
            simd: self.simd,
            skip: !self.no_skip,
        }
    }
}

/// Pictures that explain a render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub(crate) enum OverlayKind {
    /// Fragments generated per pixel
    Overdraw,
    /// Stencil values left at the end
    Stencil,
    /// Bytes read and written per 8x8 block
    Traffic,
    /// Silhouette edges of the casters, seen from the lights
    Silhouette,
    /// Sides of the shadow volumes
    Volumes,
}

impl OverlayKind {
    /// Its name on the command line and in file names.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Overdraw => "overdraw",
            Self::Stencil => "stencil",
            Self::Traffic => "traffic",
            Self::Silhouette => "silhouette",
            Self::Volumes => "volumes",
        }
    }
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let valid =
        format!("expected WIDTHxHEIGHT in pixels, each 1 to {MAX_TEXTURE_SIZE}, such as 800x600");
    let sides = text.split_once(['x', 'X']).ok_or(&valid)?;
    let side = |s: &str| match s.parse::<u32>() {
        Ok(n) if (1..=MAX_TEXTURE_SIZE).contains(&n) => Ok(n),
        _ => Err(format!("`{s}` is no valid side; {valid}")),
    };
    Ok([side(sides.0)?, side(sides.1)?])
}

fn parse_setting(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.is_empty() => Ok((key.to_owned(), value.to_owned())),
        _ => Err("expected KEY=VALUE, such as method=zfail".to_owned()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }

    #[test]
    fn sizes_are_checked() {
        assert_eq!(parse_size("800x600"), Ok([800, 600]));
        assert_eq!(parse_size("1X8192"), Ok([1, 8192]));
        for bad in ["", "800", "0x0", "8193x1", "-1x2", "axb", "1x2x3", "1.5x2"] {
            let message = parse_size(bad).unwrap_err();
            assert!(message.contains("WIDTHxHEIGHT"), "{bad}: {message}");
        }
    }

    #[test]
    fn settings_keep_further_equals_signs() {
        let pair = parse_setting("a=b=c").unwrap();
        assert_eq!(pair, ("a".to_owned(), "b=c".to_owned()));
        assert!(parse_setting("a").is_err() && parse_setting("=b").is_err());
    }
}
