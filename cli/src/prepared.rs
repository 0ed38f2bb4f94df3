//! What techniques compute ahead of their frames, kept between runs.

use std::sync::atomic::{AtomicUsize, Ordering};

use gnomon_pipeline::technique::{Params, Technique, Warning};
use gnomon_pipeline::truth::oracle::cache::OracleCache;
use gnomon_pipeline::world::scene::Scene;

use crate::error::CliError;
use crate::output::progress::Progress;

/// Pieces of work between two words about them.
const TOLD: usize = 1024;

/// Has `technique` compute what frames of `scene` need, or read it from `cache`; says what
/// went wrong with that.
pub(crate) fn prepare(
    technique: &dyn Technique,
    params: &Params,
    scene: &Scene,
    cache: &OracleCache,
    progress: &Progress,
) -> Result<Vec<Warning>, CliError> {
    let total = AtomicUsize::new(0);
    let done = |count: usize| {
        let before = total.fetch_add(count, Ordering::Relaxed);
        if before / TOLD != (before + count) / TOLD {
            progress.doing(format!("computing ahead: {} vertices", before + count));
        }
    };
    let found = technique.prepare(scene, params, cache, &done)?;
    let warnings = found.into_iter().map(|w| Warning {
        code: "cache",
        count: 1,
        message: w.to_string(),
    });
    Ok(warnings.collect())
}
