//! PLY, text and both orders of bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| gnomon_fuzz::model("f.ply", data));
