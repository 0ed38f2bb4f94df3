//! Same bits for every thread count, execution tile and SIMD level.
//!
//! `GNOMON_DIGEST_FILE` names a file for the combined digest, so that a script
//! can compare debug with release.

use gnomon_raster::{GpuConfig, SimdLevel};
use gnomon_tests::digest::{Digest, digest};
use gnomon_tests::gpu_run::run_observed;
use gnomon_tests::parallel;
use gnomon_tests::random::random_case;

const CASES: u64 = 40;

fn configs(skip: bool) -> Vec<GpuConfig> {
    let mut list = Vec::new();
    for threads in [1, 2, 4] {
        for tile in [16, 32, 64, 128] {
            for simd in SimdLevel::available() {
                list.push(GpuConfig {
                    threads,
                    tile,
                    simd,
                    skip,
                });
            }
        }
    }
    list
}

/// Digest of one case, equal under all configurations.
fn same_everywhere(seed: u64) -> Digest {
    let case = random_case(0xd00d_0000 + seed);
    let mut of_case = Digest::default();
    for skip in [true, false] {
        let mut first = None;
        for config in configs(skip) {
            let outcome = run_observed(&case, config)
                .unwrap_or_else(|e| panic!("case {seed}, {config:?}: {e}"));
            let d = (
                digest(&outcome),
                outcome
                    .passes
                    .iter()
                    .map(|p| p.events.clone())
                    .collect::<Vec<_>>(),
            );
            let (reference, events) = first.get_or_insert_with(|| d.clone());
            assert_eq!(
                *reference, d.0,
                "attachments or counters of case {seed} differ under {config:?}"
            );
            assert!(
                *events == d.1,
                "observed accesses of case {seed} differ under {config:?}"
            );
        }
        of_case.number(first.expect("there are configurations").0.0);
    }
    of_case
}

#[test]
fn threads_tiles_and_simd_levels_change_no_bit() {
    let digests = parallel::map(0..CASES, same_everywhere);
    let mut all = Digest::default();
    digests.iter().for_each(|d| all.number(d.0));
    println!("combined digest of {CASES} cases: {:016x}", all.0);
    if let Ok(path) = std::env::var("GNOMON_DIGEST_FILE") {
        std::fs::write(&path, format!("{:016x}\n", all.0))
            .unwrap_or_else(|e| panic!("{path}: {e}"));
    }
}
