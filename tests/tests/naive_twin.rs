//! The GPU equals the naive twin, to the bit, on every attachment and counter.
//!
//! `GNOMON_TWIN_CASES` and `GNOMON_TWIN_SEED` choose how many seeds, from which;
//! `GNOMON_TWIN_SHOW` how many differences are printed;
//! the skip setting, tile size, threads and SIMD level differ from seed to seed.

use gnomon_raster::MIN_VIEWPORT_SIDE;
use gnomon_raster::state::Viewport;
use gnomon_tests::check::{check, config_of, explain, fault};
use gnomon_tests::parallel;
use gnomon_tests::random::random_case;

fn setting(name: &str, default: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|_| panic!("{name} is `{text}`; a number is needed")),
        Err(_) => default,
    }
}

#[test]
fn gpu_equals_twin_on_random_cases() {
    let first = setting("GNOMON_TWIN_SEED", 0);
    let cases = setting("GNOMON_TWIN_CASES", 2000);
    // Panics of the GPU are caught and reported with their seed.
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let results = parallel::map(first..first + cases, |seed| (seed, check(seed)));
    let failures: Vec<_> = results
        .into_iter()
        .filter_map(|(seed, r)| Some((seed, r.err()?)))
        .collect();
    for (_, e) in failures
        .iter()
        .take(setting("GNOMON_TWIN_SHOW", 5) as usize)
    {
        println!("{e}\n");
    }
    if let (1, Some((seed, _))) = (cases, failures.first()) {
        println!("{}", explain(*seed));
    }
    std::panic::set_hook(hook);
    let seeds: Vec<_> = failures.iter().map(|(seed, _)| *seed).collect();
    assert!(
        seeds.is_empty(),
        "{} of {cases} seeds differ: {seeds:?}",
        seeds.len()
    );
}

/// Every draw of a random case in a viewport at the ends of what is valid.
fn in_viewport(seed: u64, viewport: Viewport) -> Result<(), String> {
    let mut case = random_case(seed);
    let draws = case.passes.iter_mut().flat_map(|p| &mut p.draws);
    draws.for_each(|d| d.viewport = Some(viewport));
    match fault(&case, config_of(seed)) {
        Some(what) => Err(format!("seed {seed}, {viewport:?}: {what}")),
        None => Ok(()),
    }
}

#[test]
fn gpu_equals_twin_in_extreme_viewports() {
    let least = f32::from_bits(1);
    let spans = [
        [0.0, MIN_VIEWPORT_SIDE],
        [12288.0, MIN_VIEWPORT_SIDE],
        [-4096.0, 1e-30],
        // The far edge is rounded away.
        [4095.9, 1e-4],
        [3.0, 1e-3],
        [-4096.0, 16384.0],
        [-least, 12288.0],
    ];
    let depths = [
        [0.0, 1.0],
        [least, 1.0],
        [-0.0, least],
        [1.0, -0.0],
        [0.5, 0.5],
    ];
    let mut viewports = Vec::new();
    for (k, [x, width]) in spans.into_iter().enumerate() {
        for (i, [y, height]) in spans.into_iter().enumerate() {
            let [min_depth, max_depth] = depths[(k + i) % depths.len()];
            viewports.push(Viewport {
                x,
                y,
                width,
                height,
                min_depth,
                max_depth,
            });
        }
    }
    let seeds = 0..viewports.len() as u64 * 8;
    let of = |seed: u64| in_viewport(seed, viewports[seed as usize % viewports.len()]);
    let failures: Vec<_> = parallel::map(seeds, of)
        .into_iter()
        .filter_map(Result::err)
        .collect();
    assert!(failures.is_empty(), "{failures:#?}");
}
