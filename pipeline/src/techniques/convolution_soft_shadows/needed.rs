//! What of a light view's images some receiver reads. It follows from the receivers
//! that the camera sees, and so is known before anything is drawn.

use super::settings::Filter;
use crate::parts::maps::light_view::Reads;
use crate::parts::maps::tiles::Texels;

/// The texels needed of each level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Needed {
    /// From the finest level.
    levels: Vec<Texels>,
}

impl Needed {
    /// Everything.
    pub(super) fn all(side: u32) -> Self {
        let levels = (0..=side.ilog2()).map(|level| Texels::all(side >> level));
        Self {
            levels: levels.collect(),
        }
    }

    /// What `reads` takes of images of `side` texels.
    pub(super) fn of(reads: &Reads, side: u32, filter: Filter) -> Self {
        match filter {
            Filter::Mip => Self::of_mips(reads, side),
            Filter::Sat | Filter::SatMean | Filter::SatU32 => Self {
                levels: vec![Texels::of_table(reads, side)],
            },
        }
    }

    fn of_mips(reads: &Reads, side: u32) -> Self {
        let widest = 2.0 * reads.half[0].max(reads.half[1]) * f64::from(side);
        let mut last = 0;
        // Kernels are filtered between the levels with finer and coarser texels.
        while last < side.ilog2() && f64::from(1u32 << last) < widest {
            last += 1;
        }
        let mut levels: Vec<Texels> = (0..=last)
            .map(|level| Texels::read(reads, side >> level))
            .collect();
        for level in (0..levels.len() - 1).rev() {
            levels[level] = levels[level].with_those_under(&levels[level + 1]);
        }
        Self { levels }
    }

    /// The coarsest level that is read.
    pub(super) fn last_level(&self) -> u32 {
        self.levels.len() as u32 - 1
    }

    /// The texels of a level up to [`Self::last_level`].
    pub(super) fn level(&self, level: u32) -> Texels {
        self.levels[level as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const READS: Reads = Reads {
        low: [0.3, -0.5],
        high: [0.4, 0.1],
        half: [0.005, 0.01],
    };

    #[test]
    fn each_level_has_what_the_next_is_made_of() {
        let needed = Needed::of(&READS, 1024, Filter::Mip);
        // 20.5 texels: between levels 4 and 5.
        assert_eq!(needed.last_level(), 5);
        assert_eq!(needed.level(0).side, 1024);
        for level in 1..=needed.last_level() {
            let (fine, coarse) = (needed.level(level - 1), needed.level(level));
            for k in 0..2 {
                assert!(fine.begin[k] <= 2 * coarse.begin[k]);
                assert!(fine.end[k] >= 2 * coarse.end[k]);
            }
        }
        let (first, last) = (needed.level(0), needed.level(5));
        assert!(first.begin[0] > 0 && first.end[1] < 1024, "{first:?}");
        assert_eq!((last.begin, last.end), ([7, 0], [15, 6]));
    }

    #[test]
    fn tables_begin_at_the_corner_and_end_at_the_last_entry() {
        for filter in [Filter::Sat, Filter::SatU32] {
            let needed = Needed::of(&READS, 100, filter);
            let expected = Texels {
                begin: [0, 0],
                end: [43, 13],
                side: 100,
            };
            assert_eq!(needed.levels, [expected]);
        }
        let far = Reads {
            low: [7.0; 2],
            high: [9.0; 2],
            half: [1.0; 2],
        };
        for filter in [Filter::Sat, Filter::Mip] {
            let needed = Needed::of(&far, 64, filter);
            assert_eq!(needed.level(0).end, [64; 2]);
        }
    }
}
