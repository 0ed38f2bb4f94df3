//! Renders the techniques and measures them.

use std::time::Instant;

use gnomon_pipeline::measure::comparison::{Aligned, Origin, Reference, Score, ShadingKey, shaded};
use gnomon_pipeline::measure::render::{Rendered, render};

use super::job::{CompareJob, Entry};
use crate::error::CliError;
use crate::output::progress::Progress;
use crate::prepared::prepare;

/// The truth and all techniques.
pub(super) struct Comparison {
    pub(super) reference: Reference,
    /// What it took; `None` where it was read.
    pub(super) reference_ms: Option<f64>,
    /// One for each of the job's entries.
    pub(super) measured: Vec<Measured>,
    /// Pictures of the truth, by how they are shaded; the first is that of the
    /// first entry.
    pub(super) shaded: Vec<(ShadingKey, Vec<[u8; 4]>)>,
}

/// A technique's picture and how far it is from the truth.
pub(super) struct Measured {
    pub(super) label: String,
    pub(super) done: Rendered,
    /// The truth under its depth buffer.
    pub(super) under: Aligned,
    pub(super) score: Score,
}

/// Asks the oracle, then renders and measures each entry in turn; `grown` is told of the
/// comparison so far after each but the last.
pub(super) fn run(
    job: &CompareJob,
    progress: &Progress,
    grown: &mut dyn FnMut(&Comparison),
) -> Result<Comparison, CliError> {
    progress.doing("computing the truth");
    let start = Instant::now();
    let reference = Reference::with_light_image(
        &job.scene,
        (job.light, job.image.as_ref()),
        job.settings.size,
        job.reference,
        Some(&job.cache),
        &|| progress.step(),
    )?;
    if reference.origin == Origin::Read {
        progress.steps(u64::from(job.settings.size[1]));
    }
    let elapsed = start.elapsed().as_secs_f64() * 1e3;
    let mut found = Comparison {
        reference_ms: (reference.origin == Origin::Computed).then_some(elapsed),
        reference,
        measured: Vec::new(),
        shaded: Vec::new(),
    };
    for entry in &job.entries {
        progress.doing(&entry.label);
        found.measure(job, entry, progress)?;
        progress.step();
        if found.measured.len() < job.entries.len() {
            grown(&found);
        }
    }
    Ok(found)
}

impl Comparison {
    fn measure(
        &mut self,
        job: &CompareJob,
        entry: &Entry,
        progress: &Progress,
    ) -> Result<(), CliError> {
        let (technique, params) = (entry.technique, &entry.params);
        let ahead = prepare(technique, params, &job.scene, &job.cache, progress)?;
        let draw = || render(&job.scene, technique, params, &job.settings);
        let mut done = progress.of_step(&entry.label, draw)?;
        done.warnings.extend(ahead);
        let under = self.reference.under(&done.depth)?;
        let truth = self.picture_of_truth(job, entry, &under)?;
        let score = Score::measure(&under, &done, &self.shaded[truth].1)?;
        done.warnings.extend(score.pixels.warning());
        self.measured.push(Measured {
            label: entry.label.clone(),
            done,
            under,
            score,
        });
        Ok(())
    }

    /// Number of the picture that the truth gives under the entry's shading;
    /// made where there is none yet.
    fn picture_of_truth(
        &mut self,
        job: &CompareJob,
        entry: &Entry,
        under: &Aligned,
    ) -> Result<usize, CliError> {
        let key = ShadingKey::of(&entry.params);
        if let Some(known) = self.shaded.iter().position(|(k, _)| *k == key) {
            return Ok(known);
        }
        let picture = shaded(
            &job.scene,
            &self.reference,
            under,
            &entry.params,
            &job.settings,
        )?;
        self.shaded.push((key, picture));
        Ok(self.shaded.len() - 1)
    }
}
