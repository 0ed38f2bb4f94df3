//! Traces: everything that can be asked of a file without drawing.
#![no_main]

use std::sync::LazyLock;

use gnomon_raster::shader::ShaderTable;
use gnomon_raster::{AccessBatch, AccessObserver};
use gnomon_traces::Trace;
use libfuzzer_sys::fuzz_target;

static SHADERS: LazyLock<ShaderTable> = LazyLock::new(gnomon_shaders::table);

struct Nobody;

impl AccessObserver for Nobody {
    fn batch(&mut self, _: usize, _: &AccessBatch<'_>) {}
}

fuzz_target!(|data: &[u8]| {
    let Ok(trace) = Trace::read(data.to_vec()) else {
        return;
    };
    for frame in 0..trace.frames().min(2) {
        let _ = trace.shape(frame);
        let _ = trace.recording(frame, &SHADERS);
        let _ = trace.shaders(frame);
        let _ = trace.counters(frame);
        let _ = trace.events(frame, &mut Nobody);
    }
    let _ = trace.id();
});
