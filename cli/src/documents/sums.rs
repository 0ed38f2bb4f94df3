//! What a whole frame counted.

use gnomon_raster::{Counters, SubmitReport};

/// All bytes of a frame, clears included.
pub fn frame_bytes(report: &SubmitReport) -> u64 {
    frame_counters(report).traffic.total_bytes() + clears(report).traffic.total_bytes()
}

/// Sum of a frame's counters, clears left out.
pub fn frame_counters(report: &SubmitReport) -> Counters {
    let mut sum = Counters::default();
    report.passes.iter().for_each(|p| sum.add(&p.totals()));
    sum
}

/// Counters with the traffic of a frame's clears and nothing else.
pub fn clears(report: &SubmitReport) -> Counters {
    let mut sum = Counters::default();
    for pass in &report.passes {
        let mut clear = Counters::default();
        clear.traffic = pass.clear;
        sum.add(&clear);
    }
    sum
}
