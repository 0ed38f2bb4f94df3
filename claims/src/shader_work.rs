//! Operations of the wedge shaders, counted by hand in `gnomon-shaders`.
//!
//! An operation is one of + − × ÷ √, an absolute value, comparison, selection,
//! minimum, maximum, rounding, conversion, shift or bitwise operation on one float
//! of one fragment. A fetch counts apart. The papers count instructions of vertex
//! and pixel shaders of 2003, each of which works on up to four floats at once, so
//! numbers of theirs and ours are not to be compared with one another, only ratios.
//!
//! Rectangles only; the parts are those of `soft_volumes.rs`, `split_volumes.rs`
//! and `coverage/`.

/// Operations and texture fetches of one invocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Work {
    pub(super) operations: u64,
    pub(super) fetches: u64,
}

/// Position relative to the light, and whether shadow falls there.
const RECEIVER: u64 = 3 + 1;
/// Light coordinates of the receiver (3 x 5), images of both ends (2 x 7), side.
const PROJECT: u64 = 15 + 14 + 1;
/// Four cuts: two distances and eleven operations each.
const CLIP: u64 = 4 * (2 + 11);
/// Both clipped ends: interpolation, exact ends, division.
const ENDS: u64 = 2 * 21;
/// Which fragments have a segment.
const SOME: u64 = 5;
/// Two swept areas of 15, ten that join them, cross product, share.
const COVERED: u64 = 2 * 15 + 10 + 4 + 5;
/// Side of the hard plane.
const SIDE: u64 = 6;
/// What both papers' shaders do before coverage, and the side after it.
const COMMON: u64 = RECEIVER + PROJECT + CLIP + ENDS + SOME + SIDE;

/// Paper III, closed form.
pub(super) const PAPER3_EXACT: Work = Work {
    operations: COMMON + COVERED + 6,
    fetches: 1,
};

/// Paper III, 4D texture, nearest: four places of 6, address of 6, three colours
/// of 4, sign.
pub(super) const PAPER3_TABLE: Work = Work {
    operations: COMMON + 4 * 6 + 6 + 3 * 4 + 6,
    fetches: 2,
};

/// Paper IV, arithmetic: 12 bits split by shifts, selection of the buffer.
pub(super) const PAPER4_ARITHMETIC: Work = Work {
    operations: COMMON + COVERED + 18 + 8,
    fetches: 1,
};

/// Paper IV, all tables: two angles of 21, two area coordinates of 4, triangle and
/// share of 8, split of 5. The shader works out the closed form too, for lack of a
/// branch, which is not counted.
pub(super) const PAPER4_TABLES: Work = Work {
    operations: COMMON + 2 * 21 + 2 * 4 + 8 + 5 + 8,
    fetches: 5,
};

/// The papers' own figures: instructions with texture loads (paper III, §4; paper
/// IV, §6).
pub(super) mod published {
    /// Paper III's shader.
    pub(in super::super) const PAPER3: u64 = 250;
    /// Paper IV's for rectangles: 60 arithmetic, 5 loads.
    pub(in super::super) const PAPER4: u64 = 65;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_as_documented() {
        assert_eq!(COMMON, 139);
        assert_eq!(PAPER3_EXACT.operations, 194);
        assert_eq!(PAPER3_TABLE.operations, 187);
        assert_eq!(PAPER4_ARITHMETIC.operations, 214);
        assert_eq!(PAPER4_TABLES.operations, 210);
    }
}
