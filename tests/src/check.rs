//! One seed: the twin against the GPU under a random configuration.

use std::panic::{AssertUnwindSafe, catch_unwind};

use gnomon_raster::{GpuConfig, SimdLevel};

use crate::compare::difference;
use crate::gpu_run;
use crate::random::{Random, random_case};
use crate::shrink::shrink;
use crate::twin::{TwinCase, render_with};

/// The configuration that a seed's case runs under.
#[must_use]
pub fn config_of(seed: u64) -> GpuConfig {
    random_config(&mut Random::new(seed ^ 0x5eed_c0de))
}

/// Any configuration.
#[must_use]
pub fn random_config(r: &mut Random) -> GpuConfig {
    GpuConfig {
        threads: r.pick(&[1, 2, 3]),
        tile: r.pick(&[16, 32, 64, 128]),
        simd: r.pick(&SimdLevel::available()),
        skip: !r.one_in(4),
    }
}

/// What is wrong with a case under a configuration.
#[must_use]
pub fn fault(case: &TwinCase, config: GpuConfig) -> Option<String> {
    let run = catch_unwind(AssertUnwindSafe(|| gpu_run::run(case, config)));
    let gpu = match run {
        Ok(Ok(gpu)) => gpu,
        Ok(Err(e)) => return Some(format!("the GPU refuses the case: {e}")),
        Err(panic) => return Some(format!("the GPU panics: {}", message(panic.as_ref()))),
    };
    difference(&render_with(case, config.skip), &gpu, case.size[0])
}

fn message(panic: &dyn std::any::Any) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("(no message)")
}

/// Checks one seed; the error tells all that is needed to look into it.
///
/// # Errors
/// Where twin and GPU differ.
pub fn check(seed: u64) -> Result<(), String> {
    let (case, config) = (random_case(seed), config_of(seed));
    let Some(what) = fault(&case, config) else {
        return Ok(());
    };
    Err(format!(
        "seed {seed}, {config:?}\n  {what}\n  reproduce, with the smallest case that still differs:\n  \
         GNOMON_TWIN_SEED={seed} GNOMON_TWIN_CASES=1 cargo test -p gnomon-tests --test naive_twin -- --nocapture"
    ))
}

/// The smallest case with a fault that shrinking the seed's case leads to, printed.
#[must_use]
pub fn explain(seed: u64) -> String {
    let config = config_of(seed);
    let small = shrink(&random_case(seed), |c| fault(c, config).is_some());
    let what = fault(&small, config).unwrap_or_default();
    format!(
        "smallest case of seed {seed}, {config:?}:\n{:#?}\n  {what}",
        without_pixels(&small)
    )
}

/// A case as it should be printed.
fn without_pixels(case: &TwinCase) -> TwinCase {
    let mut c = case.clone();
    c.color.iter_mut().for_each(|i| i.texels.truncate(1));
    let images = c.textures.iter_mut().flat_map(|t| &mut t.images);
    images.flatten().for_each(|i| i.truncate(1));
    if let Some(d) = &mut c.depth {
        d.depth.truncate(1);
        d.stencil.truncate(1);
    }
    c
}
