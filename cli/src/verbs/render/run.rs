//! From the command line to pictures and the summary.

use gnomon_pipeline::measure::render::{Rendered, render_supersampled};
use gnomon_pipeline::measure::wedge_work::WedgeWork;
use gnomon_pipeline::techniques::Registry;

use super::args::RenderArgs;
use super::expect::Baseline;
use super::frames;
use super::job::RenderJob;
use super::write::write;
use crate::documents::{FileDocument, worker_threads};
use crate::error::CliError;
use crate::output::progress::Progress;
use crate::output::tables::{self, Named};
use crate::output::{self, draws, numbers, warnings};

/// Renders one frame, or an animation, and writes what was asked for.
pub(crate) fn run(args: &RenderArgs, registry: &Registry) -> Result<(), CliError> {
    if let Some(count) = args.frame.frames {
        return frames::run(args, registry, count);
    }
    let progress = Progress::new(3 + args.overlay.len() as u64);
    let baseline = args.expect.as_deref().map(Baseline::read).transpose()?;
    progress.doing("loading the scene");
    let job = RenderJob::new(args, registry)?;
    progress.step();
    progress.doing("rendering");
    let ahead = (args.frame).prepare(job.technique, &job.params, &job.scene, &progress)?;
    let (scene, technique, params) = (&job.scene, job.technique, &job.params);
    let draw = || render_supersampled(scene, technique, params, &job.settings, job.samples);
    let mut done = progress.of_frame("rendering", draw)?;
    done.warnings.extend(ahead);
    progress.step();
    let files = write(&job, args, &done, &progress)?;
    drop(progress);
    let document = job.document(&done, files.clone());
    let found = baseline.map(|b| (b.differences(&document), b));
    if args.json {
        output::print_json(&document)?;
    }
    let mut text = summarise(&job, &done, &files);
    if args.draws {
        text += &describe_draws(&done);
    }
    let is_taken = args.json || output::is_stdout(&job.out);
    output::print_summary(&text, is_taken)?;
    let mut same = true;
    if let Some((differences, baseline)) = found {
        // Asked for, whether or not the summary is.
        output::print_asked(&baseline.tell(&differences), is_taken)?;
        same = differences.is_empty();
    }
    if same { Ok(()) } else { Err(CliError::Differs) }
}

/// Work and traffic of every draw.
fn describe_draws(done: &Rendered) -> String {
    let tables = [draws::work(&done.report), draws::traffic(&done.report)];
    tables.map(|t| format!("\n{}", t.to_text())).concat()
}

fn summarise(job: &RenderJob, done: &Rendered, files: &[FileDocument]) -> String {
    let settings = &job.settings;
    let mut text = format!(
        "{}, {}, {}x{}: {} on {} threads, {}, skipping {}\n\n",
        job.scene.name,
        job.technique.name(),
        done.size[0],
        done.size[1],
        numbers::milliseconds(done.frame_ms),
        worker_threads(settings.gpu.threads),
        settings.gpu.simd,
        if settings.gpu.skip { "on" } else { "off" },
    );
    let frame = [Named {
        label: job.technique.name(),
        done,
    }];
    text += &tables::work(&frame).to_text();
    text.push('\n');
    text += &tables::traffic(&frame).to_text();
    if let Some(work) = WedgeWork::of(&done.report, &done.roles) {
        text += &format!(
            "\nwedges shaded {} fragments for {} pairs of a pixel and a penumbra that it is in: {:.2} times\n",
            numbers::count(work.shaded),
            numbers::count(work.covering),
            work.ratio(),
        );
    }
    text += &format!(
        "\ncolor      {}\nvisibility {}\n",
        done.color_hash(),
        done.visibility_hash()
    );
    for figure in &done.figures {
        text += &format!("{}: {:.6}\n", figure.name, figure.value);
    }
    for line in warnings::lines(&done.warnings) {
        text += &format!("warning: {line}\n");
    }
    for file in files {
        text += &format!("wrote {} ({})\n", file.path, file.kind);
    }
    text
}
