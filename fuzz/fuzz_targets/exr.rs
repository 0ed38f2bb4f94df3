//! OpenEXR pictures.
#![no_main]

use gnomon_pipeline::world::environment::decode_exr;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    if let Ok(([width, height], texels)) = decode_exr(data) {
        assert_eq!(texels.len() as u64, u64::from(width) * u64::from(height));
    }
});
