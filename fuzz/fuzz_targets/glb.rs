//! glTF in one binary file.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| gnomon_fuzz::model("f.glb", data));
