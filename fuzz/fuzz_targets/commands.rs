//! Uses of the API, valid and not: a report or an error, never a panic, and the same twice.
#![no_main]

use gnomon_tests::random::{Random, misuse};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let once = misuse(Random::of_bytes(data));
    assert!(once == misuse(Random::of_bytes(data)), "not the same twice");
});
