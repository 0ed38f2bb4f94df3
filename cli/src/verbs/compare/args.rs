//! The command line of `gnomon compare`.

use std::path::PathBuf;

use clap::Args;
use gnomon_pipeline::measure::comparison::{ReferenceKind, UnknownReference};

use crate::flags::{EntryArg, EnvArgs, GpuArgs, SceneArgs, parse_entry, parse_size, parse_time};

/// Flags of `compare`.
#[derive(Debug, Args)]
#[command(after_help = COMPARE_HELP)]
pub(crate) struct CompareArgs {
    /// The scene.
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Techniques (see `gnomon techniques`), each with settings of its own behind
    /// colons if need be: NAME:KEY=VALUE:...; all for each one that takes the light
    /// [default: shadow-volumes,pcss,convolution-soft-shadows,soft-shadow-volumes]
    #[arg(
        long,
        alias = "technique",
        value_name = "NAME,...",
        value_delimiter = ',',
        value_parser = parse_entry
    )]
    pub(crate) techniques: Vec<EntryArg>,
    /// Somebody else's image of the scene instead of techniques: visibility as .npy
    /// (height, width) or gray .png, or a picture as .npy (height, width, 3) or .exr of
    /// linear RGB, or .png of sRGB. What differs, where, and on which side of the truth
    #[arg(long, value_name = "FILE", conflicts_with_all = ["techniques", "settings", "env", "csv", "repeat"])]
    pub(crate) against: Option<PathBuf>,
    /// The truth for --against, visibility as .npy (height, width) [default: --reference]
    #[arg(long, value_name = "FILE.npy", requires = "against", conflicts_with_all = ["techniques", "settings", "env", "reference"])]
    pub(crate) truth: Option<PathBuf>,
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
    /// Folder for the picture, SCENE-compare.png or SCENE-against.png, and for the truth,
    /// oracle-cache/
    #[arg(
        short = 'o',
        long,
        alias = "out",
        value_name = "DIR",
        default_value = "out"
    )]
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
    /// Also write the table for other programs, a line for each technique with all digits;
    /// - for stdout
    #[arg(long, value_name = "FILE.csv|-", conflicts_with = "env")]
    pub(crate) csv: Option<PathBuf>,
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
Your own renderer: gnomon compare cylinder --against mine.npy
With --env: gnomon compare creature --env sky --lights 30,60 --techniques soft-shadow-volumes

Exit codes: 0 fine, 2 bad input.";

/// A setting of all entries of a technique.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TechniqueSetting {
    /// The technique's name, unchecked.
    pub(crate) technique: String,
    /// Key and value, unchecked.
    pub(crate) setting: (String, String),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_of_all_entries_name_a_technique() {
        let all = parse_technique_setting("a-b.k=1.5").unwrap();
        assert_eq!(
            (all.technique, all.setting),
            ("a-b".to_owned(), ("k".to_owned(), "1.5".to_owned()))
        );
        for bad in ["k=1", "a.k", ".k=1", "a.=1"] {
            let message = parse_technique_setting(bad).unwrap_err();
            assert!(message.contains("TECHNIQUE.KEY=VALUE"), "{message}");
        }
    }
}
