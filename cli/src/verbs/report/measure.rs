//! Draws each technique and gathers what the page shows.

use std::borrow::Cow;
use std::path::Path;

use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind, Score, shaded};
use gnomon_pipeline::measure::render::{RenderError, RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::{Recording, TextureId};
use gnomon_traces::FrameShape;
use gnomon_traces::findings::{Finding, findings, profile_findings};
use gnomon_traces::history::{self, History, HistoryOptions};
use gnomon_traces::judged::{Judged, judge};
use gnomon_traces::maps::{Maps, observe};
use gnomon_traces::profile::{Profile, ProfileError, profile};
use gnomon_traces::report::FrameReport;

use super::args::ReportArgs;
use crate::draw::Picture;
use crate::error::CliError;
use crate::flags::{EntryArg, expand_all, parameters};
use crate::overlay;

/// A frame and what the page shows of it.
pub(super) struct Subject {
    pub(super) label: String,
    pub(super) picture: Picture,
    /// Of what the frame leaves behind, by name.
    pub(super) hashes: Vec<(String, String)>,
    pub(super) warnings: Vec<String>,
    pub(super) frame_ms: f64,
    pub(super) maps: Maps,
    pub(super) frame: FrameReport,
    pub(super) judged: Vec<Judged>,
    /// Profiles that cannot do what the frame does.
    pub(super) refused: Vec<ProfileError>,
    pub(super) findings: Vec<Finding>,
    pub(super) histories: Vec<History>,
    /// What there is to compare with the truth: not of recorded frames.
    done: Option<Rendered>,
    /// Against the exact soft shadow, where there are several techniques.
    pub(super) score: Option<Score>,
}

/// How frames are observed.
pub(super) struct Observe<'a> {
    pub(super) settings: &'a RenderSettings,
    pub(super) profiles: &'a [Profile],
    pub(super) pixels: &'a [[u32; 2]],
}

/// A frame that the GPU refuses.
pub(super) fn refuse_gpu(error: gnomon_raster::Error) -> CliError {
    CliError::Render(RenderError::Gpu(error))
}

/// A technique and its settings.
pub(super) struct Entry {
    label: String,
    technique: &'static dyn Technique,
    params: Params,
}

/// The techniques that were asked for.
pub(super) fn entries(args: &ReportArgs, registry: &Registry) -> Result<Vec<Entry>, CliError> {
    let given = match args.techniques.is_empty() {
        true => vec![EntryArg::plain("shadow-volumes")],
        false => expand_all(&args.techniques, registry),
    };
    let entry = |arg: EntryArg| {
        let technique = arg.find(registry)?;
        let settings = arg.settings.iter().map(|(k, v)| format!(" {k}={v}"));
        Ok(Entry {
            label: std::iter::once(arg.technique.clone())
                .chain(settings)
                .collect(),
            params: parameters(technique, &arg.settings, args.gpu.no_skip)?,
            technique,
        })
    };
    given.into_iter().map(entry).collect()
}

/// The profiles that were asked for.
pub(super) fn profiles(args: &ReportArgs) -> Result<Vec<Profile>, CliError> {
    let named = args
        .profiles
        .iter()
        .filter(|n| *n != "none" && !n.is_empty());
    named.map(|name| read_profile(name)).collect()
}

fn read_profile(name: &str) -> Result<Profile, CliError> {
    if !name.ends_with(".toml") {
        return Ok(profile(name)?);
    }
    let text = std::fs::read_to_string(name).map_err(|e| CliError::Flag {
        flag: "--profile",
        value: name.to_owned(),
        valid: format!("the file cannot be read: {e}"),
    })?;
    let stem = Path::new(name).file_stem().unwrap_or_default();
    Ok(Profile::parse(&stem.to_string_lossy(), name, &text)?)
}

impl Subject {
    /// The frame of a technique.
    pub(super) fn of_scene(
        entry: &Entry,
        scene: &Scene,
        how: &Observe<'_>,
    ) -> Result<Self, CliError> {
        let settings = how.settings;
        let done = render(scene, entry.technique, &entry.params, settings)?;
        let frame = entry.technique.frame(scene, settings.size, &entry.params)?;
        let image = frame.outputs.color;
        let observed = Self::observe(entry.label.clone(), &frame.recording, image, how)?;
        let warnings = done.warnings.iter();
        Ok(Self {
            picture: overlay::picture(&done),
            hashes: vec![
                ("Picture".to_owned(), done.color_hash()),
                ("Visibility".to_owned(), done.visibility_hash()),
            ],
            warnings: warnings
                .map(|w| format!("Warning: {}: {}", w.code, w.message))
                .collect(),
            frame_ms: done.frame_ms,
            done: Some(done),
            ..observed
        })
    }

    /// What is observed of a frame whose picture is `image`.
    pub(super) fn observe(
        label: String,
        recording: &Recording,
        image: TextureId,
        how: &Observe<'_>,
    ) -> Result<Self, CliError> {
        let gpu = how.settings.gpu;
        let (maps, report) = observe(recording, image, gpu).map_err(refuse_gpu)?;
        let frame = FrameReport::new(&FrameShape::of(recording), &report, gpu);
        let judged = judge(recording, &frame, how.profiles, gpu).map_err(refuse_gpu)?;
        let (judged, refused) = apart(judged);
        let options = HistoryOptions {
            config: gpu,
            image: None,
        };
        let history = |p: &[u32; 2]| history::pixel(recording, &options, *p);
        let mut findings = findings(&frame, maps.size);
        findings.extend(judged.iter().flat_map(|j| profile_findings(&frame, j)));
        Ok(Self {
            label,
            picture: Picture {
                size: maps.size,
                pixels: Vec::new(),
            },
            hashes: Vec::new(),
            warnings: Vec::new(),
            frame_ms: 0.0,
            histories: how.pixels.iter().map(history).collect::<Result<_, _>>()?,
            maps,
            frame,
            judged,
            refused,
            findings,
            done: None,
            score: None,
        })
    }
}

/// What was judged, and why the rest was not.
fn apart(all: Vec<Result<Judged, ProfileError>>) -> (Vec<Judged>, Vec<ProfileError>) {
    let (mut judged, mut refused) = (Vec::new(), Vec::new());
    for one in all {
        match one {
            Ok(one) => judged.push(one),
            Err(why) => refused.push(why),
        }
    }
    (judged, refused)
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
    let plain = Reference::new(scene, 0, settings.size, kind, None, &|| {})?;
    for (entry, subject) in entries.iter().zip(subjects) {
        let Some(done) = &subject.done else { continue };
        let image = entry.technique.light_image(&entry.params)?;
        let mut truth = Cow::Borrowed(&plain);
        if let Some(image) = &image {
            let of = (0, Some(image));
            let size = settings.size;
            truth = Cow::Owned(Reference::with_light_image(
                scene,
                of,
                size,
                kind,
                None,
                &|| {},
            )?);
        }
        let under = truth.under(&done.depth)?;
        let picture = shaded(scene, &truth, &under, &entry.params, settings)?;
        subject.score = Some(Score::measure(&under, done, &picture)?);
    }
    Ok(())
}
