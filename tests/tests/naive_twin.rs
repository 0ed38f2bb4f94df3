//! The GPU equals the naive twin, to the bit, on every attachment and counter.
//!
//! `GNOMON_TWIN_CASES` and `GNOMON_TWIN_SEED` choose how many seeds, from which;
//! `GNOMON_TWIN_SHOW` how many differences are printed;
//! the skip setting, tile size, threads and SIMD level differ from seed to seed.

use gnomon_tests::check::{check, explain};
use gnomon_tests::parallel;

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
