//! How much of the penumbra shader's work was in penumbrae.
//!
//! A wedge is drawn so that only pixels inside a penumbra run the shader. The
//! least that it could run for is one fragment for each pair of a pixel and a
//! wedge that covers it; wedges that enclose their penumbra loosely, and pixels
//! whose surface lies before or behind it, come on top.

use gnomon_raster::{Counters, SubmitReport};

use crate::technique::{DrawRole, Roles};

/// Fragments of penumbra shaders, and those that were needed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WedgeWork {
    /// Fragments shaded.
    pub shaded: u64,
    /// Pairs of a penumbra pixel and a wedge that covers it: fragments that
    /// changed what the buffer holds. Coverage below its resolution changes
    /// nothing, so this is never above the number of pairs.
    pub covering: u64,
}

impl WedgeWork {
    /// From the counters of a frame; `None` for techniques that add no coverage of
    /// wedges.
    pub fn of(report: &SubmitReport, roles: &Roles) -> Option<Self> {
        let mut work = Self::default();
        for (number, pass) in report.passes.iter().enumerate() {
            for (k, draw) in pass.draws.iter().enumerate() {
                if roles.of_draw(number, k) == DrawRole::Coverage {
                    work.shaded += draw.counters.fragment_shader_invocations;
                    work.covering += changes(&draw.counters);
                }
            }
        }
        (work.shaded != 0).then_some(work)
    }

    /// Shaded over needed fragments; at best 1, infinite where none was needed.
    pub fn ratio(&self) -> f64 {
        self.shaded as f64 / self.covering as f64
    }
}

/// Colour writes that stored something new. A fragment adds to one attachment
/// only; what it writes to others is as silent as if it covered nothing.
fn changes(c: &Counters) -> u64 {
    let written = c.traffic.color.iter().map(|t| t.write_accesses);
    let silent = c.events.silent_color_writes;
    written.zip(silent).map(|(w, s)| w.saturating_sub(s)).sum()
}
