//! What was found while wedges were made, as warnings.

use crate::geometry::wedge::paper1::LinkedStatistics;
use crate::technique::Warning;

/// Counts over the casters of one light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LinkedReport {
    /// Of the wedges.
    pub(crate) linked: LinkedStatistics,
    /// Silhouette loops.
    pub(crate) loops: u64,
    /// Casters without shadow, since their silhouette does not close.
    pub(crate) unbalanced: u64,
    /// Pieces of umbra boundary without wedge, which keep the volume closed.
    pub(crate) gaps: u64,
    /// Volumes that go to infinity, since not all of them comes to the end asked for.
    pub(crate) endless: u64,
}

/// Loops from which an 8-bit count of nested umbrae could pass 127.
pub(crate) const STENCIL_LOOPS: u64 = 128;

impl LinkedReport {
    /// A warning for each count that is not 0; `light` is the light's number.
    pub(crate) fn warnings(&self, light: usize) -> Vec<Warning> {
        let l = &self.linked;
        let counted = [
            (
                "extra-wedges",
                l.extra_wedges,
                "extra wedges fill the turns at acute vertices",
            ),
            (
                "nearly-parallel-edges",
                l.nearly_parallel,
                "silhouette edges point at the light within 1.2 degrees and were collapsed; \
                 shadows next to the object may be off",
            ),
            (
                "zero-length-edges",
                l.zero_length,
                "silhouette edges have no length and were left out",
            ),
            (
                "edges-aimed-at-light",
                l.aimed_at_centre,
                "silhouette edges point at the light's centre exactly and have no wedge",
            ),
            (
                "overlapping-side-planes",
                l.overlapping_sides,
                "wedges have side planes that meet; beyond, the umbra of so large a light is wrong",
            ),
            (
                "wedges-without-sides",
                l.without_sides,
                "wedges have no side planes that could bound them and were left out; \
                 there the shadow's edge is hard",
            ),
            (
                "dropped-loops",
                l.dropped_loops,
                "silhouette loops have fewer than two usable edges; their shadow is hard",
            ),
            (
                "unbalanced-silhouettes",
                self.unbalanced,
                "silhouettes do not close and cast nothing",
            ),
            (
                "umbra-gaps",
                self.gaps,
                "pieces of the umbra's boundary have no wedge",
            ),
            (
                "endless-volumes",
                self.endless,
                "volumes have sides that do not come to the plane of wedge-length, and go to \
                 infinity",
            ),
        ];
        let warning = |(code, count, what): (&'static str, u64, &str)| Warning {
            code,
            count: count as usize,
            message: format!("light {light}: {count} {what}"),
        };
        let met = counted.into_iter().filter(|(_, count, _)| *count != 0);
        met.map(warning).collect()
    }

    /// Where a signed 8-bit stencil may not hold all nested umbrae (paper II, §6.1).
    pub(crate) fn stencil_warning(&self, light: usize) -> Option<Warning> {
        (self.loops >= STENCIL_LOOPS).then(|| Warning {
            code: "stencil-capacity",
            count: self.loops as usize,
            message: format!(
                "light {light}: {} silhouette loops share an 8-bit stencil that holds 127 nested \
                 umbrae; passes=single has no such limit",
                self.loops
            ),
        })
    }
}
