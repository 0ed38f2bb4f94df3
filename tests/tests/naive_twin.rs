//! The GPU equals the naive twin, to the bit, on every attachment and counter.
//!
//! `GNOMON_TWIN_CASES` and `GNOMON_TWIN_SEED` choose how many seeds, from which;
//! the skip setting, tile size, threads and SIMD level differ from seed to seed.

use std::sync::Mutex;

use gnomon_tests::check::{check, explain};
use rayon::prelude::*;

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
    let failures = Mutex::new(Vec::new());
    (first..first + cases).into_par_iter().for_each(|seed| {
        if let Err(e) = check(seed) {
            failures
                .lock()
                .expect("no panic while locked")
                .push((seed, e));
        }
    });
    let mut failures = failures.into_inner().expect("no panic while locked");
    failures.sort();
    for (_, e) in failures.iter().take(5) {
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
