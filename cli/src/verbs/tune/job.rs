//! What the command line asked for, checked.

use gnomon_pipeline::measure::comparison::CompareError;
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::truth::oracle::cache::OracleCache;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::GpuConfig;

use super::args::TuneArgs;
use super::budget::Budget;
use super::candidates::Candidate;
use crate::error::CliError;
use crate::flags::{EntryArg, expand_all};
use crate::output::files;

const DEFAULT_SIZE: [u32; 2] = [640, 480];

/// A search, ready to run.
pub(super) struct TuneJob {
    /// As it was called.
    pub(super) scene: String,
    /// The scene at each frame.
    pub(super) frames: Vec<Scene>,
    /// The time of the first frame.
    pub(super) time: f64,
    /// Techniques, with the settings that stay.
    pub(super) techniques: Vec<Candidate>,
    pub(super) budget: Budget,
    pub(super) light: usize,
    pub(super) size: [u32; 2],
    pub(super) gpu: GpuConfig,
    pub(super) cache: OracleCache,
}

impl TuneJob {
    pub(super) fn new(args: &TuneArgs, registry: &Registry) -> Result<Self, CliError> {
        files::check_folder("--out-dir", &args.out_dir)?;
        let techniques = candidates(&args.techniques, registry)?;
        let frames = open_frames(args)?;
        let size = args.size.or(frames[0].size).unwrap_or(DEFAULT_SIZE);
        Ok(Self {
            scene: args.scene.scene.clone(),
            frames,
            time: args.time,
            techniques,
            budget: Budget {
                error: args.max_error,
                ms: args.max_ms,
                bytes: args.max_bytes,
            },
            light: args.light,
            size,
            gpu: args.gpu.config(),
            cache: OracleCache::new(args.out_dir.join("oracle-cache")),
        })
    }
}

/// The techniques that were asked for, or else all.
fn candidates(given: &[EntryArg], registry: &Registry) -> Result<Vec<Candidate>, CliError> {
    let all = [EntryArg::plain("all")];
    let given = if given.is_empty() { &all } else { given };
    let candidate = |entry: EntryArg| {
        let technique = entry.find(registry)?;
        Params::parse(technique, entry.written())?;
        Ok(Candidate {
            technique,
            settings: entry.settings,
        })
    };
    expand_all(given, registry)
        .into_iter()
        .map(candidate)
        .collect()
}

/// At least one frame; each has the light.
fn open_frames(args: &TuneArgs) -> Result<Vec<Scene>, CliError> {
    let mut source = args.scene.open()?;
    let mut frames = Vec::new();
    for frame in 0..args.frames {
        let time = args.time + f64::from(frame) / args.fps;
        if !time.is_finite() {
            return Err(CliError::Flag {
                flag: "--fps",
                value: args.fps.to_string(),
                valid: "the time of the last frame is not finite: give more frames per second"
                    .to_owned(),
            });
        }
        let scene = source.at(time)?;
        let (given, count) = (args.light, scene.lights.len());
        if given >= count {
            return Err(CompareError::NoSuchLight { given, count }.into());
        }
        frames.push(scene);
    }
    Ok(frames)
}
