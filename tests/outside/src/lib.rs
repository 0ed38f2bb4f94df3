//! Frames as a user of `gnomon-raster` renders them, from outside its workspace: the
//! crate's opening example, and one that reaches every kernel. Default profiles, small
//! stacks: see `tests/stack.rs`.

mod opening;
mod rich;
mod shaders;

pub use opening::opening;
pub use rich::rich;

use gnomon_raster::{GpuConfig, SimdLevel};

/// A frame; gives a hash of its attachments and counters.
pub type Frame = fn(GpuConfig) -> u64;

/// Every frame by name.
pub const FRAMES: [(&str, Frame); 2] = [("opening", opening), ("rich", rich)];

/// Renders `frame` on a thread with `stack` bytes; a stack that is too small ends the
/// process.
pub fn on_stack(stack: usize, frame: Frame, simd: SimdLevel, threads: usize) -> u64 {
    let config = GpuConfig {
        threads,
        simd,
        // A small frame has work for several threads.
        tile: 16,
        ..GpuConfig::default()
    };
    std::thread::Builder::new()
        .name(format!("{simd}, {threads} threads"))
        .stack_size(stack)
        .spawn(move || frame(config))
        .expect("a thread")
        .join()
        .expect("no panic")
}

/// FNV-1a over what `value` shows.
fn hash(value: &impl std::fmt::Debug) -> u64 {
    format!("{value:?}")
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325, |h, b| {
            (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)
        })
}
