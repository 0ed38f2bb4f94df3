//! Files of any bytes: no panic, and nothing is allocated beyond what sizes allow.
//!
//! For a long run, in an address space that a bomb would burst:
//! `sh -c 'ulimit -v 1000000; GNOMON_FUZZ=10000000 cargo test --release -p gnomon-traces
//! --test suite -- any_bytes::long --ignored --nocapture'`, built before.

use gnomon_raster::{AccessBatch, AccessObserver};
use gnomon_shaders::table;
use gnomon_traces::Trace;

use crate::forge::{Part, put_together, take_apart};
use crate::user_frame;

/// xorshift64*: the same files everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() >> 16) as usize % n.max(1)
    }
}

struct Nobody;

impl AccessObserver for Nobody {
    fn batch(&mut self, _: usize, _: &AccessBatch<'_>) {}
}

fn mutate(r: &mut Random, data: &mut Vec<u8>) {
    for _ in 0..=r.below(4) {
        let at = r.below(data.len());
        match r.below(6) {
            0 if !data.is_empty() => data[at] ^= 1 << r.below(8),
            1 if !data.is_empty() => data[at] = [0, 1, 0x7f, 0x80, 0xff][r.below(5)],
            2 => data.insert(at, r.next() as u8),
            3 if !data.is_empty() => {
                data.remove(at);
            }
            4 => {
                let end = (at + r.below(16)).min(data.len());
                data[at..end].fill(0xff);
            }
            _ => data.truncate(at.max(data.len() / 2)),
        }
    }
}

/// Everything that can be asked of a file without drawing.
fn ask(file: Vec<u8>, shaders: &gnomon_raster::shader::ShaderTable) -> bool {
    let Ok(trace) = Trace::read(file) else {
        return false;
    };
    let mut deep = false;
    for frame in 0..trace.frames().min(2) {
        deep |= trace.shape(frame).is_ok();
        deep |= trace.recording(frame, shaders).is_ok();
        let _ = trace.shaders(frame);
        let _ = trace.counters(frame);
        let _ = trace.events(frame, &mut Nobody);
    }
    let _ = trace.id();
    deep
}

/// Runs `count` mutants; gives how many were good for something.
fn fuzz(seed: u64, count: u64) -> u64 {
    let file = user_frame::trace().to_bytes().to_vec();
    let parts = take_apart(&file);
    let raw = put_together(&parts);
    let (shaders, mut r, mut deep) = (table(), Random(seed | 1), 0);
    for i in 0..count {
        let mutant = if i % 4 == 0 {
            // Hashes do not fit: the container's own checks.
            let mut bytes = raw.clone();
            mutate(&mut r, &mut bytes);
            bytes
        } else {
            let mut parts: Vec<Part> = parts.clone();
            let at = r.below(parts.len());
            mutate(&mut r, &mut parts[at].data);
            put_together(&parts)
        };
        deep += u64::from(ask(mutant, &shaders));
    }
    deep
}

#[test]
fn any_bytes_are_read_or_refused() {
    let deep = fuzz(0x9e37_79b9, 4000);
    assert!(deep > 1000, "only {deep} mutants came as far as a frame");
}

#[test]
#[ignore = "minutes to hours: GNOMON_FUZZ says how many"]
fn long() {
    let count = std::env::var("GNOMON_FUZZ").map_or(1_000_000, |n| n.parse().unwrap());
    let seed = std::env::var("GNOMON_SEED").map_or(1, |n| n.parse().unwrap());
    let deep = fuzz(seed, count);
    println!("{count} executions from seed {seed}, {deep} came as far as a frame");
}

/// Sizes that lie, everywhere that a size is.
#[test]
fn bombs_are_refused_at_once() {
    let file = user_frame::trace().to_bytes().to_vec();
    let parts = take_apart(&file);
    let shaders = table();
    for at in 0..parts.len() {
        for place in 0..parts[at].data.len().min(40) {
            let mut bomb = parts.clone();
            let end = (place + 9).min(bomb[at].data.len());
            bomb[at].data[place..end].fill(0xff);
            ask(put_together(&bomb), &shaders);
        }
    }
}
