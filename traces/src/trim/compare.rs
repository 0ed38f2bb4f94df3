//! Whether what is kept is what it was: what every draw and pass leaves, what they count,
//! and each of their accesses.

use core::ops::Range;

use gnomon_raster::{AccessBatch, BlockAccess, Counters, SubmitReport, TexelAccess};

use super::cut::Cut;
use crate::error::TraceError;
use crate::format::v1::TileHash;
use crate::shape::FrameShape;
use crate::stream::{PassSections, PassStream};
use crate::trace::Trace;

/// A frame of a trace.
type Frame<'a> = (&'a Trace, usize);

/// Compares frame `now`, which is `cut` out of `then`.
///
/// # Errors
/// They differ, or one is damaged.
pub(super) fn compare(cut: &Cut, then: Frame<'_>, now: Frame<'_>) -> Result<(), TraceError> {
    let (old, new) = (then.0.hashes(then.1)?, now.0.hashes(now.1)?);
    let (counted, counts) = (then.0.counters(then.1)?, now.0.counters(now.1)?);
    let reports = [
        (Some(&counted.skipping), Some(&counts.skipping)),
        (counted.unskipped.as_ref(), counts.unskipped.as_ref()),
    ];
    for (pass, end) in new.ends.iter().enumerate() {
        let before = pass + cut.first[0];
        let all = counted.skipping.passes.get(before);
        let draws = cut.draws_of(before, all.map_or(0, |p| p.draws.len()));
        let differs = |what: &str| Err(differs(then.1, before, what));
        if draws.end == usize::MAX && old.ends.get(before) != Some(end) {
            return differs("what it leaves");
        }
        let tiles_then = old.draws.get(before).map(|t| tiles(t, &draws));
        if tiles_then != new.draws.get(pass).cloned() {
            return differs("what its draws leave");
        }
        let changed = |(a, b): &(Option<&SubmitReport>, Option<&SubmitReport>)| {
            a.map(|a| counters(a, before, &draws)) != b.map(|b| counters(b, pass, &(0..usize::MAX)))
        };
        if reports.iter().any(changed) {
            return differs("what its draws count");
        }
        if counted.unskipped.is_some() {
            accesses(&draws, (then, before), (now, pass))?;
        }
    }
    Ok(())
}

fn differs(frame: usize, pass: usize, what: &str) -> TraceError {
    TraceError::Trimmed {
        frame,
        pass,
        what: what.to_owned(),
    }
}

/// Hashes of some draws, numbered as if they were the first.
fn tiles(all: &[TileHash], draws: &Range<usize>) -> Vec<TileHash> {
    let kept = all.iter().filter(|t| draws.contains(&(t.draw as usize)));
    let moved = kept.map(|t| TileHash {
        draw: t.draw - draws.start as u32,
        ..*t
    });
    moved.collect()
}

fn counters(report: &SubmitReport, pass: usize, draws: &Range<usize>) -> Vec<Counters> {
    let all = report.passes.get(pass).map_or(&[][..], |p| &p.draws);
    let draws = all.iter().enumerate().filter(|(i, _)| draws.contains(i));
    draws.map(|(_, d)| d.counters).collect()
}

/// Compares accesses one by one, those of `draws` then and all of now.
fn accesses(
    draws: &Range<usize>,
    (then, before): (Frame<'_>, usize),
    (now, pass): (Frame<'_>, usize),
) -> Result<(), TraceError> {
    let shapes = (then.0.shape(then.1)?, now.0.shape(now.1)?);
    let sections = (
        then.0.pass_sections(then.1, before)?,
        now.0.pass_sections(now.1, pass)?,
    );
    let mut old = Accesses::new(&sections.0, &shapes.0, before, draws.clone())?;
    let mut new = Accesses::new(&sections.1, &shapes.1, pass, 0..usize::MAX)?;
    for number in 0_u64.. {
        match (old.next()?, new.next()?) {
            (None, None) => break,
            (a, b) if a == b => {}
            (a, b) => {
                let draw = a.or(b).map_or(0, |(block, _)| block.draw);
                let what = format!("access {number} (of draw {draw} of those kept)");
                return Err(differs(then.1, before, &what));
            }
        }
    }
    Ok(())
}

/// Accesses of some draws of a pass with their texels, draws numbered as if they were the
/// first.
struct Accesses<'a> {
    stream: PassStream<'a>,
    draws: Range<usize>,
    blocks: Vec<BlockAccess>,
    texels: Vec<TexelAccess>,
    /// The next of `blocks` and of `texels`.
    at: [usize; 2],
}

impl<'a> Accesses<'a> {
    fn new(
        sections: &'a PassSections,
        shape: &'a FrameShape,
        pass: usize,
        draws: Range<usize>,
    ) -> Result<Self, TraceError> {
        Ok(Self {
            stream: sections.stream(shape, pass)?,
            draws,
            blocks: Vec::new(),
            texels: Vec::new(),
            at: [0; 2],
        })
    }

    /// The next access and its texels, events numbered from 0 in each.
    fn next(&mut self) -> Result<Option<(BlockAccess, Vec<TexelAccess>)>, TraceError> {
        loop {
            let [event, _] = self.at;
            if event == self.blocks.len() {
                if !self.refill()? {
                    return Ok(None);
                }
                continue;
            }
            let mut block = self.blocks[event];
            let own = self.texels[self.at[1]..].iter();
            let own = own.take_while(|t| t.event as usize == event);
            let texels: Vec<_> = own.map(|t| TexelAccess { event: 0, ..*t }).collect();
            self.at = [event + 1, self.at[1] + texels.len()];
            if self.draws.contains(&(block.draw as usize)) {
                block.draw -= self.draws.start as u32;
                return Ok(Some((block, texels)));
            }
        }
    }

    /// Reads the next batch; false where there is none.
    fn refill(&mut self) -> Result<bool, TraceError> {
        self.at = [0; 2];
        let Some(AccessBatch { blocks, texels, .. }) = self.stream.next()? else {
            self.blocks.clear();
            return Ok(false);
        };
        self.blocks.clear();
        self.blocks.extend_from_slice(blocks);
        self.texels.clear();
        self.texels.extend_from_slice(texels);
        Ok(true)
    }
}
