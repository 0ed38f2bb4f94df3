//! What is cut out of a frame, and how.

use core::ops::Range;

use gnomon_raster::{Error, GpuConfig, Recording, RenderPass};

use super::{Keep, check};
use crate::error::TraceError;
use crate::walk::{Walk, part};

/// What is kept of a frame.
pub(super) struct Cut {
    /// The first pass, and its first draw.
    pub(super) first: [usize; 2],
    /// The last pass, and the end of its draws.
    last: [usize; 2],
}

impl Cut {
    pub(super) fn whole(recording: &Recording) -> Self {
        let passes = &recording.list.passes;
        Self {
            first: [0, 0],
            last: [
                passes.len().saturating_sub(1),
                passes.last().map_or(0, |p| p.draws.len()),
            ],
        }
    }

    pub(super) fn of(recording: &Recording, keep: &Keep) -> Result<Self, TraceError> {
        let passes = &recording.list.passes;
        match keep {
            Keep::Frames(_) => Ok(Self::whole(recording)),
            Keep::Passes(_, kept) => {
                check("passes", kept, passes.len())?;
                let last = kept.end - 1;
                Ok(Self {
                    first: [kept.start, 0],
                    last: [last, passes[last].draws.len()],
                })
            }
            Keep::Draws(_, kept) => {
                check("draws", kept, passes.iter().map(|p| p.draws.len()).sum())?;
                let [pass, draw] = place(passes, kept.end - 1);
                Ok(Self {
                    first: place(passes, kept.start),
                    last: [pass, draw + 1],
                })
            }
        }
    }

    /// The frame that is kept.
    pub(super) fn apply(
        &self,
        recording: &Recording,
        config: GpuConfig,
    ) -> Result<Recording, Error> {
        let mut kept = self.state_before(recording, config)?;
        for (name, id) in recording.outputs() {
            kept.name_output(name, id)?;
        }
        let (first, last) = (self.first[0], self.last[0]);
        let passes = recording.list.passes.get(first..=last).unwrap_or_default();
        let kept_of = |(number, pass): (usize, &RenderPass)| {
            let count = pass.draws.len();
            let draws = self.draws_of(number, count);
            part(pass, draws.start, draws.end.min(count), draws.end > count)
        };
        kept.list.passes = (first..).zip(passes).map(kept_of).collect();
        Ok(kept)
    }

    /// Textures before the first draw that is kept.
    fn state_before(&self, recording: &Recording, config: GpuConfig) -> Result<Recording, Error> {
        let mut walk = Walk::start(recording, config)?;
        match self.first {
            [pass, 0] => walk.finish_passes(pass)?,
            [pass, draw] => walk.reach([pass, draw - 1]).map(|_| ())?,
        }
        walk.gpu.save()
    }

    /// Which draws are kept of a pass; without end where all behind the first are.
    pub(super) fn draws_of(&self, pass: usize, count: usize) -> Range<usize> {
        let start = if pass == self.first[0] {
            self.first[1]
        } else {
            0
        };
        let is_cut = pass == self.last[0] && self.last[1] < count;
        let end = if is_cut { self.last[1] } else { usize::MAX };
        start..end
    }
}

/// Pass and draw of a draw that is counted over all passes.
fn place(passes: &[RenderPass], mut draw: usize) -> [usize; 2] {
    for (number, pass) in passes.iter().enumerate() {
        if draw < pass.draws.len() {
            return [number, draw];
        }
        draw -= pass.draws.len();
    }
    unreachable!("the range was checked")
}
