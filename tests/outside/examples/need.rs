//! How much stack a frame needs: `need` prints a table in KiB, found by bisection over
//! processes of its own.

use std::process::{Command, Stdio};

use gnomon_outside::{FRAMES, on_stack};
use gnomon_raster::SimdLevel;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    match &args[1..] {
        [frame, level, kib] => {
            let simd: SimdLevel = level.parse().expect("a level of this machine");
            let frame = FRAMES.iter().find(|f| f.0 == frame).expect("a frame").1;
            let stack = 1024 * kib.parse::<usize>().expect("KiB");
            println!("{:016x}", on_stack(stack, frame, simd, 1));
        }
        _ => table(),
    }
}

fn table() {
    for (frame, _) in FRAMES {
        for level in SimdLevel::available() {
            println!("{frame:<10} {level:<8} {:>6} KiB", need(frame, level));
        }
    }
}

/// Smallest stack, to 8 KiB, on which `frame` is rendered.
fn need(frame: &str, level: SimdLevel) -> u32 {
    let (mut low, mut high) = (8, 16384);
    while high - low > 8 {
        let middle = (low + high) / 2;
        if fits(frame, level, middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

fn fits(frame: &str, level: SimdLevel, kib: u32) -> bool {
    Command::new(std::env::current_exe().expect("this program"))
        .args([frame, level.name(), &kib.to_string()])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .expect("starts")
        .success()
}
