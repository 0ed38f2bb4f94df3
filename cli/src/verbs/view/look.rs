//! What is looked at: everything that a frame depends on.

use super::orbit::Pose;
use crate::overlay::OverlayKind;

/// A frame that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Look {
    /// Where from; the scene's own eye where there is none.
    pub(super) pose: Option<Pose>,
    /// Number of the technique in the list.
    pub(super) technique: usize,
    /// The only light that shines; as the settings have it where there is none.
    pub(super) light: Option<usize>,
    /// What explains the picture.
    pub(super) overlay: Option<OverlayKind>,
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
}

impl Look {
    /// Whether both show the same thing, be it from elsewhere or at another size.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.technique == other.technique
            && self.light == other.light
            && self.overlay == other.overlay
    }
}

/// The size of a picture that is to take `budget` milliseconds, where one of `full` takes
/// `ms`: a half, a quarter or an eighth of the sides, if need be.
pub(super) fn draft_size(full: [u32; 2], ms: f64, budget: f64) -> [u32; 2] {
    let part = [1u32, 2, 4]
        .into_iter()
        .find(|part| ms <= budget * f64::from(part * part));
    full.map(|side| side.div_ceil(part.unwrap_or(8)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drafts_are_as_small_as_they_have_to_be() {
        let size = |ms| draft_size([101, 60], ms, 40.0);
        assert_eq!(size(40.0), [101, 60]);
        assert_eq!(size(41.0), [51, 30]);
        assert_eq!(size(161.0), [26, 15]);
        assert_eq!(size(1e9), [13, 8]);
        assert_eq!(draft_size([1, 1], 1e9, 40.0), [1, 1]);
    }
}
