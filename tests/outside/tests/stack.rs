//! Frames on small stacks, at every SIMD level that the machine has. A stack that is
//! too small ends the whole run, with the thread's name.

use gnomon_outside::{FRAMES, on_stack};
use gnomon_raster::SimdLevel;

/// What `gnomon-raster` promises to do with.
const STACK: usize = 1 << 20;

/// Renders every frame at every level; all hashes of a frame must be equal.
fn render_all(threads: usize) {
    for (name, frame) in FRAMES {
        let hashes: Vec<u64> = SimdLevel::available()
            .into_iter()
            .map(|simd| on_stack(STACK, frame, simd, threads))
            .collect();
        assert!(
            hashes.iter().all(|h| *h == hashes[0]),
            "{name} differs between {:?}: {hashes:016x?}",
            SimdLevel::available()
        );
    }
}

#[test]
fn the_callers_thread_needs_less_than_a_megabyte() {
    render_all(1);
}

#[test]
fn workers_render_the_same_for_a_caller_with_a_megabyte() {
    render_all(3);
}

#[test]
fn threads_do_not_change_a_frame() {
    for (name, frame) in FRAMES {
        let simd = SimdLevel::detect();
        let [one, three] = [1, 3].map(|threads| on_stack(STACK, frame, simd, threads));
        assert_eq!(one, three, "{name}");
    }
}
