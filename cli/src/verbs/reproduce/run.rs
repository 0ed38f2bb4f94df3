//! From the command line to findings and plots.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use gnomon_claims::chart::Chart;
use gnomon_claims::{Claim, Finding, Lab, LabSettings, claims, find};
use gnomon_pipeline::truth::oracle::cache::OracleCache;

use super::args::ReproduceArgs;
use super::document::ReproduceDocument;
use super::text;
use crate::documents::FileDocument;
use crate::draw::plot;
use crate::error::CliError;
use crate::output::files::{self, Batch};
use crate::output::progress::Progress;
use crate::output::{self, png};

/// A claim and what came of it.
pub(super) struct Outcome {
    pub(super) claim: &'static Claim,
    /// `None` for claims that are quoted, or only listed.
    pub(super) finding: Option<Finding>,
    /// Plots that were written.
    pub(super) files: Vec<FileDocument>,
    /// What measuring took.
    pub(super) time: Duration,
}

/// Lists or measures, prints, and writes plots.
pub(crate) fn run(args: &ReproduceArgs) -> Result<(), CliError> {
    let chosen: Vec<&'static Claim> = match &args.claim {
        Some(id) => vec![find(id)?],
        None => claims().collect(),
    };
    let settings = LabSettings {
        size: args.size,
        gpu: args.gpu.config(),
        repeat: args.repeat,
        full: args.full,
    };
    files::check_target(&args.out_dir.join("plot.svg"))?;
    let start = Instant::now();
    let outcomes = if args.list {
        chosen.into_iter().map(Outcome::listed).collect()
    } else {
        measure_claims(args, settings, chosen)?
    };
    if args.json {
        let document = ReproduceDocument::new(&settings, &outcomes);
        output::print_json(&document)?;
    }
    let mut text: String = outcomes.iter().map(|o| text::of(o, args.list)).collect();
    if !args.list {
        text += &text::summarise(&outcomes, &settings, start.elapsed());
    }
    output::print_summary(&text, args.json)
}

fn measure_claims(
    args: &ReproduceArgs,
    settings: LabSettings,
    chosen: Vec<&'static Claim>,
) -> Result<Vec<Outcome>, CliError> {
    let cache = OracleCache::new(args.out_dir.join("oracle-cache"));
    let mut lab = Lab::new(settings, Some(cache));
    let progress = Progress::new(chosen.len() as u64);
    let mut outcomes = Vec::new();
    for claim in chosen {
        progress.doing(claim.id);
        let start = Instant::now();
        let finding = claim.measure(&mut lab)?;
        let time = start.elapsed();
        let charts = finding.iter().flat_map(|f| &f.charts);
        let files = write_plots(&args.out_dir, charts)?;
        outcomes.push(Outcome {
            claim,
            finding,
            files,
            time,
        });
        progress.step();
    }
    Ok(outcomes)
}

impl Outcome {
    fn listed(claim: &'static Claim) -> Self {
        Self {
            claim,
            finding: None,
            files: Vec::new(),
            time: Duration::ZERO,
        }
    }
}

/// Each chart as PNG and SVG.
fn write_plots<'a>(
    folder: &Path,
    charts: impl Iterator<Item = &'a Chart>,
) -> Result<Vec<FileDocument>, CliError> {
    let mut batch = Batch::default();
    let mut written = Vec::new();
    for chart in charts {
        let mut stage = |extension: &str, bytes: &[u8]| -> Result<(), CliError> {
            let path: PathBuf = folder.join(format!("{}.{extension}", chart.name));
            batch.stage(&path, bytes)?;
            written.push(FileDocument {
                kind: "plot",
                path: path.display().to_string(),
            });
            Ok(())
        };
        stage("svg", plot::svg(chart).as_bytes())?;
        stage("png", &png::encode(&plot::picture(chart)))?;
    }
    batch.commit()?;
    Ok(written)
}
