//! How many pixels a comparison is of, and why the others were left out.

use super::sight::Match;
use crate::technique::Warning;

/// Pixels that were left out. Each is in one of the counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Neither truth nor picture shows a surface.
    pub background: usize,
    /// An outline or sharp edge is so near that what the pixel shows is a matter of
    /// rounding.
    pub outline: usize,
    /// Both show a surface, not at the same depth.
    pub other_depth: usize,
    /// The truth shows a surface, the picture none.
    pub missing_surface: usize,
    /// The picture shows a surface, the truth none.
    pub extra_surface: usize,
    /// Both show the surface, and one of them has no finite number for it.
    pub no_value: usize,
}

/// Why pixels were left out, and how many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reason {
    /// Stable, snake case.
    pub key: &'static str,
    /// For people, in few words.
    pub text: &'static str,
    /// How many.
    pub pixels: usize,
}

/// Pixels that were compared, and the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelCounts {
    /// Those that errors are of.
    pub compared: usize,
    /// The others.
    pub left_out: LeftOut,
}

impl LeftOut {
    /// Counts what keeps pixels from being compared.
    pub(super) fn of(matches: impl Iterator<Item = Match>) -> Self {
        let mut counts = Self::default();
        for found in matches {
            let counter = match found {
                Match::Surface => continue,
                Match::Background => &mut counts.background,
                Match::Outline => &mut counts.outline,
                Match::OtherDepth => &mut counts.other_depth,
                Match::MissingSurface => &mut counts.missing_surface,
                Match::ExtraSurface => &mut counts.extra_surface,
            };
            *counter += 1;
        }
        counts
    }

    /// Every reason, those of no pixel too.
    pub fn reasons(&self) -> [Reason; 6] {
        [
            ("background", "no surface", self.background),
            ("outline", "edge too near", self.outline),
            ("other_depth", "other depth", self.other_depth),
            ("missing_surface", "surface missing", self.missing_surface),
            ("extra_surface", "extra surface", self.extra_surface),
            ("no_value", "no value", self.no_value),
        ]
        .map(|(key, text, pixels)| Reason { key, text, pixels })
    }

    /// Where picture and truth show different surfaces, or may do so.
    pub fn other_surface(&self) -> usize {
        self.outline + self.other_depth + self.missing_surface + self.extra_surface
    }

    /// All of them.
    pub fn total(&self) -> usize {
        self.reasons().iter().map(|r| r.pixels).sum()
    }
}

impl PixelCounts {
    /// Pixels at which truth or picture shows a surface.
    pub fn surfaces(&self) -> usize {
        self.compared + self.left_out.total() - self.left_out.background
    }

    /// Says so where less than half of the surfaces was compared: errors then tell
    /// little of the picture.
    pub fn warning(&self) -> Option<Warning> {
        let (compared, surfaces) = (self.compared, self.surfaces());
        if compared > 0 && 2 * compared >= surfaces {
            return None;
        }
        Some(Warning {
            code: "few-pixels-compared",
            count: surfaces - compared,
            message: match surfaces {
                0 => "nothing was compared: no pixel shows a surface".to_owned(),
                _ => format!(
                    "{compared} of {surfaces} pixels that show a surface were compared; \
                     left out: {}",
                    self.named_reasons()
                ),
            },
        })
    }

    fn named_reasons(&self) -> String {
        let reasons = self.left_out.reasons();
        let told = reasons
            .iter()
            .filter(|r| r.pixels > 0 && r.key != "background");
        let told: Vec<String> = told.map(|r| format!("{} ({})", r.text, r.pixels)).collect();
        told.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn little_of_the_surfaces_is_warned_of_with_the_reasons() {
        let mut counts = PixelCounts {
            compared: 50,
            left_out: LeftOut {
                background: 1000,
                missing_surface: 30,
                outline: 20,
                ..LeftOut::default()
            },
        };
        assert_eq!((counts.surfaces(), counts.warning()), (100, None));
        counts.left_out.no_value = 1;
        let warning = counts.warning().unwrap();
        assert_eq!((warning.code, warning.count), ("few-pixels-compared", 51));
        for part in ["50 of 101", "surface missing (30)", "edge too near (20)"] {
            assert!(warning.message.contains(part), "{}", warning.message);
        }
        assert!(
            !warning.message.contains("no surface"),
            "{}",
            warning.message
        );
        let none = PixelCounts::default().warning().unwrap();
        assert!(none.message.contains("no pixel"), "{}", none.message);
    }
}
