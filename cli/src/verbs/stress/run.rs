//! From the command line to curves, verdicts and files.

use gnomon_pipeline::measure::stress::{Curve, Stress};
use gnomon_pipeline::techniques::Registry;

use super::args::StressArgs;
use super::document::StressDocument;
use super::job::StressJob;
use super::{charts, csv, record, text};
use crate::documents::FileDocument;
use crate::draw::plot;
use crate::error::CliError;
use crate::output;
use crate::output::files::Batch;
use crate::output::progress::Progress;

/// Measures, writes the files, and prints the verdicts.
pub(crate) fn run(args: &StressArgs, registry: &Registry) -> Result<(), CliError> {
    let job = StressJob::new(args, registry)?;
    let curves = measure(&job, args);
    let document = StressDocument::new(&job, args, &curves);
    let files = write(&curves, &document, args)?;
    if args.json {
        output::print_json(&document.with_files(&files))?;
    }
    output::print_summary(&text::summarise(args, &curves, &files), args.json)
}

fn measure(job: &StressJob, args: &StressArgs) -> Vec<Curve> {
    let stress = Stress {
        scene: &job.scene,
        light: args.light,
        size: args.size,
        gpu: args.gpu.config(),
    };
    let steps: usize = job.axes.iter().map(|a| a.values.len()).sum();
    let progress = Progress::new(steps as u64);
    let mut curves = Vec::new();
    for axis in &job.axes {
        progress.doing(axis.name);
        curves.push(stress.curve(axis, &job.candidates, &mut |_, _| progress.step()));
    }
    curves
}

/// Writes everything, together or not at all.
fn write(
    curves: &[Curve],
    document: &StressDocument,
    args: &StressArgs,
) -> Result<Vec<FileDocument>, CliError> {
    let json = serde_json::to_string_pretty(document).map_err(|e| CliError::Stdout(e.into()))?;
    let mut outputs = vec![
        ("table", "stress.csv".to_owned(), csv::write(curves)),
        ("document", "stress.json".to_owned(), json + "\n"),
        (
            "record",
            "stress.md".to_owned(),
            record::write(args, curves),
        ),
    ];
    for curve in curves {
        let svg = plot::panels_svg(&charts::of_curve(&args.scene, curve));
        outputs.push(("plot", format!("stress-{}.svg", curve.axis.name), svg));
    }
    let mut batch = Batch::default();
    let mut written = Vec::new();
    for (kind, name, text) in &outputs {
        let path = args.out_dir.join(name);
        batch.stage(&path, text.as_bytes())?;
        written.push(FileDocument {
            kind,
            path: path.display().to_string(),
        });
    }
    batch.commit()?;
    Ok(written)
}
