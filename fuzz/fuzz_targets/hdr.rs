//! Radiance pictures as environment maps.
#![no_main]

use gnomon_pipeline::world::environment::{Environment, MapSettings};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let path = gnomon_fuzz::file("f.hdr", data);
    let settings = MapSettings {
        side: 4,
        ..MapSettings::default()
    };
    let _ = Environment::open(&path.to_string_lossy(), settings);
});
