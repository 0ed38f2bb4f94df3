//! `gnomon compare --env`: techniques and numbers of lights against sampled
//! directions of the map (Annen et al. 2008, figures 10 and 11).

mod document;
mod picture;

use std::path::PathBuf;
use std::time::Instant;

use gnomon_pipeline::measure::comparison::{Directions, EnvironmentReference, RadianceScore};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::environment::PlacedEnvironment;
use gnomon_pipeline::world::environment::cube::luminance;
use gnomon_pipeline::world::scene::Scene;
use gnomon_pipeline::world::scene::environment::EnvironmentRequest;

use super::args::CompareArgs;
use super::job::{self, DEFAULT_SIZE, Entry};
use super::pixels;
use crate::documents::{FileDocument, worker_threads};
use crate::error::CliError;
use crate::output::files::{self, Batch};
use crate::output::numbers::{self, error};
use crate::output::progress::Progress;
use crate::output::tables::{self, Table};
use crate::output::{self, png, warnings};
use crate::verbs;

/// Numbers of lights where none are given: the paper's.
const LIGHTS: [usize; 3] = [30, 45, 60];

/// What was asked for, checked, and the scene under each number of lights.
struct EnvironmentJob {
    name: String,
    map: String,
    scenes: Vec<Scene>,
    entries: Vec<Entry>,
    directions: Directions,
    settings: RenderSettings,
    out: PathBuf,
}

/// A technique's picture of one scene.
struct MeasuredLight<'a> {
    label: String,
    entry: &'a Entry,
    placed: &'a PlacedEnvironment,
    done: Rendered,
    difference: Vec<f64>,
    score: RadianceScore,
}

/// Renders, measures, draws and prints.
pub(super) fn run(args: &CompareArgs, registry: &Registry) -> Result<(), CliError> {
    let job = EnvironmentJob::new(args, registry)?;
    let runs = job.scenes.len() * job.entries.len();
    let progress = Progress::new(u64::from(job.settings.size[1]) + runs as u64 + 1);
    progress.doing("tracing the reference");
    let start = Instant::now();
    let references = References::new(&job, &progress);
    let reference_ms = start.elapsed().as_secs_f64() * 1e3;
    let mut measured = Vec::new();
    for scene in &job.scenes {
        for entry in &job.entries {
            let draw = || job.measure(scene, entry, &references);
            measured.push(progress.of_step(&entry.label, draw)?);
            progress.step();
        }
    }
    progress.doing("writing the picture");
    let mut batch = Batch::default();
    let picture = picture::draw(references.first(), &measured);
    batch.stage(&job.out, &png::encode(&picture))?;
    batch.commit()?;
    drop(progress);
    let files = [FileDocument {
        kind: "comparison",
        path: job.out.display().to_string(),
    }];
    if args.json {
        output::print_json(&document::of(&job, reference_ms, &measured, &files))?;
    }
    output::print_summary(&summarise(&job, reference_ms, &measured, &files), args.json)
}

impl EnvironmentJob {
    fn new(args: &CompareArgs, registry: &Registry) -> Result<Self, CliError> {
        let (entries, _) = job::parse_entries(args, registry, None, &|_| true)?;
        let lights = if args.lights.is_empty() {
            &LIGHTS[..]
        } else {
            &args.lights
        };
        let requests = lights
            .iter()
            .filter_map(|n| args.environment.request(Some(*n)));
        let requests: Vec<EnvironmentRequest> = requests.collect();
        let mut scenes = Vec::new();
        for request in &requests {
            let source = args.scene.open()?;
            scenes.push(
                source
                    .with_environment(Some(request.clone()))
                    .at(args.time)?,
            );
        }
        let first = scenes.first();
        let name = first.map_or(String::new(), |s| s.name.clone());
        let size = args.size.or(first.and_then(|s| s.size));
        let file = format!("{}-compare-environment.png", verbs::file_stem(&name));
        let out = args.out_dir.join(file);
        files::check_target(&out)?;
        Ok(Self {
            name,
            map: args.environment.env.clone().unwrap_or_default(),
            scenes,
            entries,
            directions: Directions {
                count: args.directions as usize,
                seed: 1,
            },
            settings: RenderSettings {
                size: size.unwrap_or(DEFAULT_SIZE),
                gpu: args.gpu.config(),
                repeat: args.repeat,
            },
            out,
        })
    }

    fn measure<'a>(
        &self,
        scene: &'a Scene,
        entry: &'a Entry,
        references: &References,
    ) -> Result<MeasuredLight<'a>, CliError> {
        let placed = scene.environment.as_deref();
        let placed = placed.ok_or_else(|| CliError::Check("no environment".to_owned()))?;
        let mut done = render(scene, entry.technique, &entry.params, &self.settings)?;
        let reference = references.of(entry);
        let difference = reference.difference(&done)?;
        let score = RadianceScore::measure(reference, &done)?;
        done.warnings.extend(score.pixels.warning());
        Ok(MeasuredLight {
            label: format!("{} lights={}", entry.label, scene.lights.len()),
            entry,
            placed,
            difference,
            score,
            done,
        })
    }
}

/// The truth with highlights and without; each made where an entry needs it.
struct References([Option<EnvironmentReference>; 2]);

impl References {
    fn new(job: &EnvironmentJob, progress: &Progress) -> Self {
        let wanted = [false, true].map(|h| job.entries.iter().any(|e| has_highlights(e) == h));
        let of = |highlights: bool| {
            let scene = job.scenes.first()?;
            let map = &scene.environment.as_ref()?.map;
            let (size, directions) = (job.settings.size, job.directions);
            Some(EnvironmentReference::new(
                scene,
                map,
                size,
                directions,
                highlights,
                &|| {
                    progress.step();
                },
            ))
        };
        Self([false, true].map(|h| wanted[usize::from(h)].then(|| of(h)).flatten()))
    }

    fn of(&self, entry: &Entry) -> &EnvironmentReference {
        let wanted = &self.0[usize::from(has_highlights(entry))];
        wanted.as_ref().expect("made for every entry")
    }

    fn first(&self) -> &EnvironmentReference {
        let [without, with] = &self.0;
        with.as_ref()
            .or(without.as_ref())
            .expect("there is an entry")
    }
}

fn has_highlights(entry: &Entry) -> bool {
    entry.params.text("shading") != Some("lambert")
}

/// Share of the map's energy that is ambient light.
fn residual_share(placed: &PlacedEnvironment) -> f64 {
    let total = luminance(placed.map.cube.total()) as f64;
    luminance(placed.fit.residual_energy()) as f64 / total
}

type Figure = (&'static str, fn(&MeasuredLight<'_>) -> String);

const FIGURES: &[Figure] = &[
    ("area lights", |m| m.placed.fit.lights.len().to_string()),
    ("ambient share", |m| {
        format!("{:.1}%", 100.0 * residual_share(m.placed))
    }),
    ("RMSE, linear", |m| error(m.score.rmse)),
    ("  of the mean", |m| {
        format!("{:.1}%", 100.0 * m.score.relative_rmse)
    }),
    ("largest error", |m| error(m.score.max)),
    ("99% are within", |m| error(m.score.p99)),
    ("mean, + too bright", |m| format!("{:+.4}", m.score.mean)),
    ("PSNR, linear", |m| format!("{:.1} dB", m.score.linear_psnr)),
    ("PSNR, picture", |m| format!("{:.1} dB", m.score.psnr)),
    ("SSIM", |m| {
        m.score.ssim.map_or("-".to_owned(), |s| format!("{s:.4}"))
    }),
    ("FLIP", |m| error(m.score.flip)),
    ("time", |m| numbers::milliseconds(m.done.frame_ms)),
    ("bytes", |m| {
        numbers::bytes(tables::frame_bytes(&m.done.report))
    }),
];

/// Columns of a table: 80 characters in all.
const COLUMNS: usize = 4;

fn summarise(
    job: &EnvironmentJob,
    ms: f64,
    measured: &[MeasuredLight<'_>],
    files: &[FileDocument],
) -> String {
    let settings = &job.settings;
    let mut text = format!(
        "{}, environment {}, {}x{}: {} threads, {}, skipping {}\n\
         reference: {} directions in proportion to the map's light, traced in {}\n",
        job.name,
        job.map,
        settings.size[0],
        settings.size[1],
        worker_threads(settings.gpu.threads),
        settings.gpu.simd,
        if settings.gpu.skip { "on" } else { "off" },
        job.directions.count,
        numbers::milliseconds(ms),
    );
    for part in measured.chunks(COLUMNS) {
        let names: Vec<String> = part.iter().map(|m| super::table::lines(&m.label)).collect();
        let header = std::iter::once("light").chain(names.iter().map(String::as_str));
        let header: Vec<&str> = header.collect();
        let mut table = Table::new("Errors against the reference, and what they cost", &header);
        for (name, figure) in FIGURES {
            let cells = part.iter().map(figure);
            table
                .rows
                .push(std::iter::once((*name).to_owned()).chain(cells).collect());
        }
        let counts: Vec<_> = part.iter().map(|m| m.score.pixels).collect();
        table.rows.extend(pixels::tabulate(&counts));
        text += &format!("\n{}", table.to_text());
    }
    for m in measured {
        for line in warnings::lines(&m.done.warnings) {
            text += &format!("warning: {}: {line}\n", m.label);
        }
    }
    for file in files {
        text += &format!("wrote {} ({})\n", file.path, file.kind);
    }
    text
}
