//! Command lists that are valid: to the bit and to the count what the naive twin does, under
//! any configuration.
#![no_main]

use gnomon_tests::check::{fault, random_config};
use gnomon_tests::random::{Random, case_of};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut r = Random::of_bytes(data);
    let config = random_config(&mut r);
    if let Some(what) = fault(&case_of(r), config) {
        panic!("{config:?}: {what}");
    }
});
