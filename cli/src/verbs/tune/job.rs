//! What the command line asked for, checked.

use gnomon_pipeline::measure::comparison::CompareError;
use gnomon_pipeline::technique::Technique;
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::truth::oracle::cache::OracleCache;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::GpuConfig;

use super::args::TuneArgs;
use super::budget::Budget;
use crate::error::CliError;
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
    pub(super) techniques: Vec<&'static dyn Technique>,
    pub(super) budget: Budget,
    pub(super) light: usize,
    pub(super) size: [u32; 2],
    pub(super) gpu: GpuConfig,
    pub(super) cache: OracleCache,
}

impl TuneJob {
    pub(super) fn new(args: &TuneArgs, registry: &Registry) -> Result<Self, CliError> {
        files::check_folder("--out-dir", &args.out_dir)?;
        let named = args.techniques.iter().map(|name| registry.find(name));
        let mut techniques = named.collect::<Result<Vec<_>, _>>()?;
        if techniques.is_empty() {
            techniques = registry.all().to_vec();
        }
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
