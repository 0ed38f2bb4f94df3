//! Scene files, TOML.
#![no_main]

use std::path::Path;

use gnomon_pipeline::world::scene::file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let Ok(scene) = file::parse(text, "f.toml", Path::new("/nonexistent")) else {
        return;
    };
    // What is taken makes a picture or says why not.
    assert!(scene.camera.eye.is_finite());
});
