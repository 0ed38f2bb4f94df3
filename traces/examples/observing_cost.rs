//! What listening to a frame costs: `cargo run --release -p gnomon-traces --example
//! observing_cost -- FILE.gnt [ROUNDS]`. One thread; the best of some rounds taken in turn.

use std::time::Instant;

use gnomon_raster::{
    AccessBatch, AccessObserver, CommandList, Error, Gpu, GpuConfig, Recording, Wants,
};
use gnomon_traces::{Trace, Witness};

struct Nobody;

impl AccessObserver for Nobody {
    fn batch(&mut self, _: usize, _: &AccessBatch<'_>) {}
}

/// What is asked for, by name; `None` does not listen.
fn kinds() -> Vec<(&'static str, Option<Wants<'static>>)> {
    let events = Wants::default();
    let ranges = Wants {
        depth_ranges: true,
        ..events
    };
    let texels = Wants {
        texels: true,
        ..ranges
    };
    let witness = Wants {
        witness: Some(&Witness),
        ..texels
    };
    vec![
        ("plain", None),
        ("events", Some(events)),
        ("and depth ranges", Some(ranges)),
        ("and texels", Some(texels)),
        ("and a witness", Some(witness)),
        (
            "one pixel",
            Some(Wants {
                probe: Some([1, 1]),
                ..events
            }),
        ),
    ]
}

fn seconds(frame: &Recording, wants: Option<Wants<'_>>) -> Result<f64, Error> {
    let mut gpu = Gpu::new(GpuConfig {
        threads: 1,
        ..GpuConfig::default()
    })?;
    gpu.load(frame)?;
    let list: &CommandList = &frame.list;
    let start = Instant::now();
    match wants {
        None => gpu.submit(list)?,
        Some(wants) => gpu.submit_observed(list, wants, &mut Nobody)?,
    };
    Ok(start.elapsed().as_secs_f64())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("which trace?")?;
    let rounds: usize = arguments.next().map_or(Ok(5), |n| n.parse())?;
    let frame = Trace::open(path)?.recording(0, &gnomon_shaders::table())?;
    let kinds = kinds();
    let mut best = vec![f64::INFINITY; kinds.len()];
    for _ in 0..rounds {
        for ((_, wants), best) in kinds.iter().zip(&mut best) {
            *best = best.min(seconds(&frame, *wants)?);
        }
    }
    for ((name, _), time) in kinds.iter().zip(&best) {
        println!("{name:18} {:8.2} ms {:6.2}", time * 1e3, time / best[0]);
    }
    Ok(())
}
