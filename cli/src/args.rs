//! The command line: verbs, flags and the values they take.

mod environment;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use gnomon_pipeline::measure::comparison::{ReferenceKind, UnknownReference};
use gnomon_raster::{GpuConfig, MAX_TEXTURE_SIZE, MAX_THREADS, SimdLevel};

pub(crate) use environment::EnvArgs;

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
    /// Measure techniques against the exact soft shadow
    Compare(Box<CompareArgs>),
    /// Measure the papers' quantitative claims again, theirs beside ours
    Reproduce(Box<ReproduceArgs>),
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
    /// A map that lights the scene.
    #[command(flatten)]
    pub(crate) environment: EnvArgs,
    /// Most area lights fitted to the map, 1 to 1024 [default: 30]
    #[arg(long, value_name = "N", requires = "env")]
    pub(crate) lights: Option<usize>,
}

/// Flags of `compare`.
#[derive(Debug, Args)]
#[command(after_help = COMPARE_HELP)]
pub(crate) struct CompareArgs {
    /// Built-in scene (see `gnomon scenes`), .toml scene file or .obj model
    pub(crate) scene: String,
    /// Techniques (see `gnomon techniques`), each with settings of its own behind
    /// colons if need be: NAME:KEY=VALUE:...
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', required = true, value_parser = parse_entry)]
    pub(crate) techniques: Vec<EntryArg>,
    /// A parameter of all entries of a technique; may be repeated
    #[arg(long = "set", value_name = "TECHNIQUE.KEY=VALUE", value_parser = parse_technique_setting)]
    pub(crate) settings: Vec<TechniqueSetting>,
    /// The light that shines, by its number; the others are off
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) light: usize,
    /// The truth: exact (areas in f64) or rays (4096 stratified shadow rays a pixel)
    #[arg(long, value_name = "NAME", default_value = "exact", value_parser = parse_reference)]
    pub(crate) reference: ReferenceKind,
    /// Image size in pixels [default: the scene file's, or else 640x480]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Folder for the picture, SCENE-compare.png, and for the truth, oracle-cache/
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out_dir: PathBuf,
    /// Frames to time; the median is reported
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) repeat: u32,
    /// The time of animated scenes, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print one JSON document on stdout, the table on stderr
    #[arg(long)]
    pub(crate) json: bool,
    /// A map that lights the scene: all lights shine, and light is compared with
    /// that of sampled directions.
    #[command(flatten)]
    pub(crate) environment: EnvArgs,
    /// Numbers of area lights to compare [default: 30,45,60]
    #[arg(
        long,
        value_name = "N,...",
        value_delimiter = ',',
        requires = "env",
        conflicts_with = "light"
    )]
    pub(crate) lights: Vec<usize>,
    /// Directions of the reference
    #[arg(long, value_name = "N", default_value_t = 1024, requires = "env", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) directions: u32,
}

const COMPARE_HELP: &str = "\
Example: gnomon compare cylinder \
--techniques shadow-volumes,sampled-shadow-volumes:samples=16,sampled-shadow-volumes:samples=256
With --env: gnomon compare creature --env sky --lights 30,60 --techniques soft-shadow-volumes

Exit codes: 0 fine, 2 bad input.";

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
    #[arg(long, value_name = "DIR", default_value = "out")]
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

/// A technique to compare, with the settings that it was given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct EntryArg {
    /// The technique's name, unchecked.
    pub(crate) technique: String,
    /// Keys and values, unchecked.
    pub(crate) settings: Vec<(String, String)>,
}

/// A setting of all entries of a technique.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TechniqueSetting {
    /// The technique's name, unchecked.
    pub(crate) technique: String,
    /// Key and value, unchecked.
    pub(crate) setting: (String, String),
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
    /// Penumbra wedges, as the technique builds them
    Wedges,
    /// The map of the environment with the fitted lights outlined
    EnvLights,
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
            Self::Wedges => "wedges",
            Self::EnvLights => "env-lights",
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

fn parse_entry(text: &str) -> Result<EntryArg, String> {
    let mut parts = text.split(':');
    let technique = parts.next().unwrap_or_default().trim();
    if technique.is_empty() {
        return Err("expected NAME or NAME:KEY=VALUE:..., separated by commas".to_owned());
    }
    Ok(EntryArg {
        technique: technique.to_owned(),
        settings: parts.map(parse_setting).collect::<Result<_, _>>()?,
    })
}

fn parse_technique_setting(text: &str) -> Result<TechniqueSetting, String> {
    let valid = "expected TECHNIQUE.KEY=VALUE, such as shadow-volumes.method=zfail";
    let (name, value) = text.split_once('=').ok_or(valid)?;
    match name.split_once('.') {
        Some((technique, key)) if !technique.is_empty() && !key.is_empty() => {
            Ok(TechniqueSetting {
                technique: technique.to_owned(),
                setting: (key.to_owned(), value.to_owned()),
            })
        }
        _ => Err(valid.to_owned()),
    }
}

fn parse_reference(text: &str) -> Result<ReferenceKind, String> {
    text.parse().map_err(|e: UnknownReference| e.to_string())
}

fn parse_time(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() => Ok(seconds),
        _ => Err("expected a finite number of seconds".to_owned()),
    }
}

fn parse_rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if rate.is_finite() && rate > 0.0 => Ok(rate),
        _ => Err("expected a number of frames per second above 0".to_owned()),
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
    fn entries_have_settings_of_their_own() {
        let entry = parse_entry("a:k=1:l=x=y").unwrap();
        let pair = |k: &str, v: &str| (k.to_owned(), v.to_owned());
        assert_eq!(entry.technique, "a");
        assert_eq!(entry.settings, [pair("k", "1"), pair("l", "x=y")]);
        assert!(parse_entry("").is_err() && parse_entry("a:b").is_err());
        let all = parse_technique_setting("a-b.k=1.5").unwrap();
        assert_eq!(
            (all.technique, all.setting),
            ("a-b".to_owned(), pair("k", "1.5"))
        );
        for bad in ["k=1", "a.k", ".k=1", "a.=1"] {
            let message = parse_technique_setting(bad).unwrap_err();
            assert!(message.contains("TECHNIQUE.KEY=VALUE"), "{message}");
        }
    }

    #[test]
    fn settings_keep_further_equals_signs() {
        let pair = parse_setting("a=b=c").unwrap();
        assert_eq!(pair, ("a".to_owned(), "b=c".to_owned()));
        assert!(parse_setting("a").is_err() && parse_setting("=b").is_err());
    }
}
