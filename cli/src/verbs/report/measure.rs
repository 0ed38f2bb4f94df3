//! Draws each technique and gathers what the page shows.

use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind, Score, shaded};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::scene::Scene;
use gnomon_traces::FrameShape;
use gnomon_traces::findings::{Finding, findings};
use gnomon_traces::history::{self, History, HistoryOptions};
use gnomon_traces::maps::{Maps, observe};
use gnomon_traces::report::FrameReport;

use super::args::ReportArgs;
use crate::error::CliError;
use crate::verbs;
use crate::verbs::compare::EntryArg;

/// A technique's frame.
pub(super) struct Subject {
    pub(super) label: String,
    pub(super) done: Rendered,
    pub(super) maps: Maps,
    pub(super) frame: FrameReport,
    pub(super) findings: Vec<Finding>,
    pub(super) histories: Vec<History>,
    /// Against the exact soft shadow, where there are several techniques.
    pub(super) score: Option<Score>,
}

/// A technique and its settings.
pub(super) struct Entry {
    label: String,
    technique: &'static dyn Technique,
    params: Params,
}

/// The techniques that were asked for.
pub(super) fn entries(args: &ReportArgs, registry: &Registry) -> Result<Vec<Entry>, CliError> {
    let default = EntryArg {
        technique: "shadow-volumes".to_owned(),
        settings: Vec::new(),
    };
    let given = match args.techniques.is_empty() {
        true => vec![default],
        false => args.techniques.clone(),
    };
    let entry = |arg: EntryArg| {
        let technique = registry.find(&arg.technique)?;
        let settings = arg.settings.iter().map(|(k, v)| format!(" {k}={v}"));
        Ok(Entry {
            label: std::iter::once(arg.technique.clone())
                .chain(settings)
                .collect(),
            params: verbs::parameters(technique, &arg.settings, args.gpu.no_skip)?,
            technique,
        })
    };
    given.into_iter().map(entry).collect()
}

impl Subject {
    pub(super) fn new(
        entry: &Entry,
        scene: &Scene,
        settings: &RenderSettings,
        pixels: &[[u32; 2]],
    ) -> Result<Self, CliError> {
        let done = render(scene, entry.technique, &entry.params, settings)?;
        let frame = entry.technique.frame(scene, settings.size, &entry.params)?;
        let recording = &frame.recording;
        let gpu = |e| CliError::Render(gnomon_pipeline::measure::render::RenderError::Gpu(e));
        let (maps, report) = observe(recording, frame.outputs.color, settings.gpu).map_err(gpu)?;
        let frame = FrameReport::new(&FrameShape::of(recording), &report, settings.gpu);
        let options = HistoryOptions {
            config: settings.gpu,
            image: None,
        };
        let history = |p: &[u32; 2]| history::pixel(recording, &options, *p);
        let histories = pixels.iter().map(history).collect::<Result<_, _>>()?;
        Ok(Self {
            label: entry.label.clone(),
            findings: findings(&frame, settings.size),
            done,
            maps,
            frame,
            histories,
            score: None,
        })
    }
}

/// Errors against the exact soft shadow. They are of one light: scenes of several have
/// none, and the page says so.
pub(super) fn measure_errors(
    scene: &Scene,
    settings: &RenderSettings,
    entries: &[Entry],
    subjects: &mut [Subject],
) -> Result<(), CliError> {
    if subjects.len() < 2 || scene.lights.len() != 1 || scene.environment.is_some() {
        return Ok(());
    }
    let kind = ReferenceKind::Exact;
    let truth = Reference::new(scene, 0, settings.size, kind, None, &|| {})?;
    for (entry, subject) in entries.iter().zip(subjects) {
        let under = truth.under(&subject.done.depth)?;
        let picture = shaded(scene, &truth, &under, &entry.params, settings)?;
        subject.score = Some(Score::measure(&under, &subject.done, &picture)?);
    }
    Ok(())
}
