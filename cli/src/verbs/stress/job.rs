//! What the command line asked for, checked.

use gnomon_pipeline::measure::comparison::CompareError;
use gnomon_pipeline::measure::stress::{Axis, Candidate};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::files::Outside;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::scene::{Scene, SceneSource};

use super::args::StressArgs;
use crate::error::CliError;
use crate::flags::{EntryArg, expand_all};
use crate::output::files;

/// Measurements, ready to be made.
pub(super) struct StressJob {
    pub(super) scene: Scene,
    pub(super) axes: Vec<Axis>,
    pub(super) candidates: Vec<Candidate>,
}

impl StressJob {
    pub(super) fn new(args: &StressArgs, registry: &Registry) -> Result<Self, CliError> {
        files::check_folder("--out-dir", &args.out_dir)?;
        let job = Self {
            axes: axes(&args.axis)?,
            candidates: candidates(&args.technique, registry)?,
            scene: open(args)?,
        };
        let (given, count) = (args.light, job.scene.lights.len());
        match job.scene.lights.get(given).map(|l| &l.shape) {
            None => Err(CompareError::NoSuchLight { given, count }.into()),
            Some(LightShape::Directional { .. }) => Err(CliError::Flag {
                flag: "--light",
                value: given.to_string(),
                valid: "it is a directional light, and those that have a place can be stressed"
                    .to_owned(),
            }),
            Some(_) => Ok(job),
        }
    }
}

fn open(args: &StressArgs) -> Result<Scene, CliError> {
    let outside = match args.allow_outside {
        true => Outside::Allowed,
        false => Outside::Refused,
    };
    Ok(SceneSource::open_with(&args.scene, outside)?.at(0.0)?)
}

fn axes(names: &[String]) -> Result<Vec<Axis>, CliError> {
    if names.is_empty() {
        return Ok(Axis::all());
    }
    let wrong = |name: &String, e: &dyn std::fmt::Display| CliError::Flag {
        flag: "--axis",
        value: name.clone(),
        valid: e.to_string(),
    };
    let found = names
        .iter()
        .map(|n| Axis::find(n).map_err(|e| wrong(n, &e)));
    found.collect()
}

fn candidates(given: &[EntryArg], registry: &Registry) -> Result<Vec<Candidate>, CliError> {
    let all = [EntryArg::plain("all")];
    let given = if given.is_empty() { &all } else { given };
    let entries = expand_all(given, registry);
    let parse = |e: &EntryArg| Ok(Candidate::new(e.find(registry)?, &e.written())?);
    entries.iter().map(parse).collect()
}
