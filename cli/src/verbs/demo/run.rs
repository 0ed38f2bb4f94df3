//! From the command line to pictures, tables and the report.

use std::path::PathBuf;
use std::time::Instant;

use gnomon_pipeline::measure::heat;
use gnomon_pipeline::world::scene::{Scene, builtin};
use serde::Serialize;

use super::args::DemoArgs;
use super::checks::Checks;
use super::errors::{ErrorDocument, Errors};
use super::shots::{ENTRIES, REPEAT, Shot, same_bits, settings, shoot};
use crate::documents::{FileDocument, RenderDocument, worker_threads};
use crate::error::CliError;
use crate::output::files::{self, Batch};
use crate::output::html::{Figure, Report};
use crate::output::progress::Progress;
use crate::output::tables::{self, Named, Table};
use crate::output::wrap::hanging;
use crate::output::{self, numbers, png};
use crate::overlay::{self, OverlayKind};

pub(super) const SCENE: &str = "demo";
/// The entry that overlays are drawn over.
const EXPLAINED: usize = 3;

const OVERLAYS: &[(OverlayKind, &str)] = &[
    (
        OverlayKind::Silhouette,
        "Edges between lit and unlit faces of the casters",
    ),
    (OverlayKind::Volumes, "The volumes that grow from them"),
    (OverlayKind::Stencil, "How often each point is in shadow"),
    (OverlayKind::Overdraw, "Where fragments are spent"),
    (OverlayKind::Traffic, "Where memory bandwidth is spent"),
];

#[derive(Serialize)]
struct DemoDocument {
    scene: &'static str,
    size: [u32; 2],
    seconds: f64,
    checks: Checks,
    renders: Vec<RenderDocument>,
    no_skip: Vec<RenderDocument>,
    errors: Vec<ErrorDocument>,
    files: Vec<FileDocument>,
}

/// Runs the demo.
pub(crate) fn run(args: &DemoArgs) -> Result<(), CliError> {
    let start = Instant::now();
    files::check_target(&args.out_dir.join("report.html"))?;
    let progress = Progress::new((ENTRIES.len() + OVERLAYS.len() + 1) as u64);
    progress.doing("building the scene");
    let scene = builtin::build(SCENE).map_err(gnomon_pipeline::world::scene::SceneError::from)?;
    let shots = shoot(&scene, args, &progress)?;
    let checks = Checks::of(&shots);
    progress.doing("measuring errors");
    let errors = Errors::measure(&scene, &shots, &settings(args, 1))?;
    progress.step();
    let mut demo = Demo {
        args,
        scene: &scene,
        shots: &shots,
        errors: &errors,
        batch: Batch::default(),
        figures: Vec::new(),
        files: Vec::new(),
    };
    demo.stage_pictures(&progress)?;
    let tables = demo.tables();
    let notes: Vec<String> = checks
        .lines()
        .into_iter()
        .chain(collect_warnings(&shots))
        .collect();
    demo.stage_report(&tables, &notes)?;
    let Demo { batch, files, .. } = demo;
    batch.commit()?;
    drop(progress);
    let seconds = start.elapsed().as_secs_f64();
    if args.json {
        output::print_json(&make_document(
            args, &scene, &shots, checks, &errors, &files, seconds,
        ))?;
    }
    output::print_summary(
        &summarise(args, &tables, &notes, &files, seconds),
        args.json,
    )?;
    checks.verdict()
}

/// The demo's products on their way to the folder.
struct Demo<'a> {
    args: &'a DemoArgs,
    scene: &'a Scene,
    shots: &'a [Shot],
    errors: &'a Errors,
    batch: Batch,
    figures: Vec<Figure>,
    files: Vec<FileDocument>,
}

impl Demo<'_> {
    fn stage_pictures(&mut self, progress: &Progress) -> Result<(), CliError> {
        for shot in self.shots {
            png::check_room(shot.done.size)?;
            let bytes = png::encode(&overlay::picture(&shot.done));
            self.stage_picture("render", shot.entry.name, shot.entry.caption, bytes)?;
        }
        let shot = &self.shots[EXPLAINED];
        let settings = settings(self.args, 1);
        let heat = heat::record(self.scene, shot.technique, &shot.params, &settings)?;
        let source = overlay::Source {
            scene: self.scene,
            params: &shot.params,
            done: &shot.done,
            heat: Some(&heat),
            carries: None,
            wedges: None,
        };
        for (kind, caption) in OVERLAYS {
            progress.doing(format!("drawing {}", kind.name()));
            let bytes = png::encode(&overlay::draw(*kind, &source));
            self.stage_picture(kind.name(), kind.name(), caption, bytes)?;
            progress.step();
        }
        Ok(())
    }

    fn stage_picture(
        &mut self,
        kind: &'static str,
        name: &str,
        caption: &str,
        bytes: Vec<u8>,
    ) -> Result<(), CliError> {
        let path = self.args.out_dir.join(format!("{SCENE}-{name}.png"));
        self.stage(kind, path, &bytes)?;
        self.figures.push(Figure {
            name: name.to_owned(),
            caption: caption.to_owned(),
            png: bytes,
        });
        Ok(())
    }

    fn stage_report(&mut self, tables: &[Table], notes: &[String]) -> Result<(), CliError> {
        let report = Report {
            title: "gnomon demo".to_owned(),
            lead: describe_run(self.args),
            figures: &self.figures,
            tables,
            notes,
        };
        let html = report.to_html();
        self.stage(
            "report",
            self.args.out_dir.join("report.html"),
            html.as_bytes(),
        )
    }

    fn stage(&mut self, kind: &'static str, path: PathBuf, bytes: &[u8]) -> Result<(), CliError> {
        self.batch.stage(&path, bytes)?;
        self.files.push(FileDocument {
            kind,
            path: path.display().to_string(),
        });
        Ok(())
    }

    fn tables(&self) -> Vec<Table> {
        let named: Vec<Named<'_>> = self
            .shots
            .iter()
            .map(|s| Named {
                label: s.entry.name,
                done: &s.done,
            })
            .collect();
        vec![
            tables::work(&named),
            tables::traffic(&named),
            self.errors.table(),
            tabulate_skipping(self.shots),
        ]
    }
}

/// What skipping saved: frames with it beside frames without.
fn tabulate_skipping(shots: &[Shot]) -> Table {
    let header = [
        "frame",
        "time",
        "no skip",
        "bytes",
        "no skip",
        "saved",
        "culled",
        "hiz kill",
        "same bits",
    ];
    let mut table = Table::new(
        "What skipping saved, beside the same frames with --no-skip",
        &header,
    );
    for shot in shots {
        let (with, without) = (
            tables::frame_bytes(&shot.done.report),
            tables::frame_bytes(&shot.plain.report),
        );
        let counters = tables::frame_counters(&shot.done.report);
        let same = same_bits(&shot.done, &shot.plain);
        table.rows.push(vec![
            shot.entry.name.to_owned(),
            numbers::milliseconds(shot.done.frame_ms),
            numbers::milliseconds(shot.plain.frame_ms),
            numbers::bytes(with),
            numbers::bytes(without),
            numbers::percent(without.saturating_sub(with), without),
            numbers::percent(counters.tiles.culled, counters.tiles.tested),
            numbers::percent(counters.fragments.hiz_killed, counters.fragments.generated),
            if same { "yes" } else { "NO" }.to_owned(),
        ]);
    }
    table
}

fn describe_run(args: &DemoArgs) -> String {
    let gpu = args.gpu.config();
    format!(
        "{}x{} pixels, {} threads, {}, execution tiles of {}, skipping {}; times are medians of {REPEAT} frames",
        args.size[0],
        args.size[1],
        worker_threads(gpu.threads),
        gpu.simd,
        gpu.tile,
        if gpu.skip { "on" } else { "off" },
    )
}

/// Every frame's warnings.
fn collect_warnings(shots: &[Shot]) -> impl Iterator<Item = String> {
    shots.iter().flat_map(|shot| {
        let name = shot.entry.name;
        let warnings = shot.done.warnings.iter();
        warnings.map(move |w| format!("warning: {name}: {}: {}", w.code, w.message))
    })
}

fn make_document(
    args: &DemoArgs,
    scene: &Scene,
    shots: &[Shot],
    checks: Checks,
    errors: &Errors,
    files: &[FileDocument],
    seconds: f64,
) -> DemoDocument {
    let describe = |s: &Shot, skip: bool| {
        RenderDocument::new(
            s.job(scene, args, skip),
            if skip { &s.done } else { &s.plain },
            Vec::new(),
        )
    };
    DemoDocument {
        scene: SCENE,
        size: args.size,
        seconds,
        checks,
        renders: shots.iter().map(|s| describe(s, true)).collect(),
        no_skip: shots.iter().map(|s| describe(s, false)).collect(),
        errors: errors.documents(),
        files: files.to_vec(),
    }
}

fn summarise(
    args: &DemoArgs,
    tables: &[Table],
    notes: &[String],
    files: &[FileDocument],
    seconds: f64,
) -> String {
    let mut text = hanging("", 0, &describe_run(args));
    for table in tables {
        text += &format!("\n{}", table.to_text());
    }
    for line in notes {
        text += &format!("{line}\n");
    }
    text += &format!(
        "\n{} pictures and report.html are in {} ({seconds:.1} s)\n",
        files.len() - 1,
        args.out_dir.display()
    );
    text
}
