//! Fixed point for integer summed-area tables.

use gnomon_shaders::convolution::Encoding;

/// Most bits of a value: what a float can hold exactly.
pub const MAX_FIXED_BITS: u32 = 24;

/// Values as integers of so many bits that the sum over a whole tile stays below
/// 2³²: any box's sum is then exact, though the table's entries may wrap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedPoint {
    largest: u32,
}

impl FixedPoint {
    /// For tiles of `side` by `side` texels, a power of two up to 2¹⁵.
    pub fn of_tile(side: u32) -> Self {
        let bits = 32u32.saturating_sub(2 * side.ilog2());
        Self {
            largest: (1 << bits.clamp(1, MAX_FIXED_BITS)) - 1,
        }
    }

    /// For sums over no more than `texels` texels, at least one: where boxes are known to
    /// be smaller than the tile, more bits are left for each.
    pub fn of_box(texels: u64) -> Self {
        let largest = u64::from(u32::MAX) / texels.max(1);
        Self {
            largest: (largest as u32).clamp(1, (1 << MAX_FIXED_BITS) - 1),
        }
    }

    /// What 1 is stored as.
    pub fn largest(&self) -> u32 {
        self.largest
    }

    /// −1..=1 as 0..=[`Self::largest`].
    pub fn signed(&self) -> Encoding {
        let half = self.largest as f32 / 2.0;
        Encoding {
            scale: half,
            shift: half,
        }
    }

    /// 0..=1 as 0..=[`Self::largest`].
    pub fn unsigned(&self) -> Encoding {
        Encoding {
            scale: self.largest as f32,
            shift: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_tile_overflows_and_few_bits_are_wasted() {
        for log in 0..=15 {
            let side = 1u64 << log;
            let largest = u64::from(FixedPoint::of_tile(side as u32).largest());
            let total = largest * side * side;
            assert!(total < 1 << 32, "{side}");
            let capped = largest == (1 << MAX_FIXED_BITS) - 1;
            assert!(
                capped || 2 * (largest + 1) * side * side > 1 << 32,
                "{side}"
            );
        }
        for texels in [0, 1, 255, 256, 257, 1 << 20, 1 << 32, 1 << 40] {
            let largest = u64::from(FixedPoint::of_box(texels).largest());
            let fits = largest * texels < 1 << 32;
            assert!(largest == 1 || fits, "{texels}");
            let capped = largest == (1 << MAX_FIXED_BITS) - 1;
            assert!(capped || (largest + 1) * texels >= 1 << 32, "{texels}");
        }
        assert_eq!(FixedPoint::of_tile(512).largest(), (1 << 14) - 1);
    }
}
