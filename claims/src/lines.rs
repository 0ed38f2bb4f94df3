//! The lines of a source that a claim was read from.

use std::fmt;

/// Some lines of the plain-text transcription of a source, counted from 1.
/// docs/papers.md, *Line numbers*, says which transcription that is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Lines {
    /// The first of them.
    pub first: u32,
    /// The last of them, itself included.
    pub last: u32,
}

impl Lines {
    /// One line.
    pub const fn one(line: u32) -> Self {
        Self {
            first: line,
            last: line,
        }
    }

    /// All from `first` to `last`.
    pub const fn to(first: u32, last: u32) -> Self {
        Self { first, last }
    }
}

impl fmt::Display for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.first == self.last {
            write!(f, "{}", self.first)
        } else {
            write!(f, "{}-{}", self.first, self.last)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims;

    #[test]
    fn a_range_of_one_line_is_one_number() {
        assert_eq!(Lines::one(1101).to_string(), "1101");
        assert_eq!(Lines::to(1101, 1103).to_string(), "1101-1103");
    }

    /// First and last line of each chapter of the thesis, by how names of claims begin.
    const CHAPTERS: [(&str, u32, u32); 6] = [
        ("thesis", 1, 548),
        ("paper1", 549, 858),
        ("paper2", 859, 1203),
        ("paper3", 1204, 1536),
        ("paper4", 1537, 1795),
        ("paper5", 1796, 1852),
    ];

    /// Lines go upwards, do not overlap, and lie in the chapter of the claim's paper; or in
    /// the thesis's summary of it, or in another chapter that the claim names as a source.
    #[test]
    fn lines_lie_in_the_papers_that_a_claim_names() {
        for claim in claims() {
            let apart = |w: &[Lines]| w[0].last < w[1].first;
            assert!(claim.lines.windows(2).all(apart), "{}", claim.id);
            for lines in claim.lines {
                assert!(lines.first <= lines.last, "{}: {lines}", claim.id);
                let named = CHAPTERS.iter().filter(|(name, ..)| names(claim, name));
                let within = |(_, first, last): &&(&str, u32, u32)| {
                    *first <= lines.first && lines.last <= *last
                };
                assert!(named.clone().any(|c| within(&c)), "{}: {lines}", claim.id);
            }
        }
    }

    /// Whether a claim's name or source names the chapter.
    fn names(claim: &crate::Claim, chapter: &str) -> bool {
        let roman = [
            ("paper1", "paper I,"),
            ("paper2", "paper II,"),
            ("paper3", "paper III,"),
            ("paper4", "paper IV,"),
            ("paper5", "paper V,"),
            ("thesis", "thesis"),
        ];
        let in_source = roman
            .iter()
            .any(|(name, long)| *name == chapter && claim.source.contains(long));
        claim.id.starts_with(chapter) || in_source
    }

    /// With the transcription at hand: every line that is named says something.
    #[test]
    #[ignore = "needs GNOMON_THESIS, the path of the transcription"]
    fn named_lines_hold_text() {
        let path = std::env::var("GNOMON_THESIS").expect("GNOMON_THESIS is not set");
        let text = std::fs::read_to_string(path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let of_thesis =
            claims().filter(|c| c.id.starts_with("paper") || c.id.starts_with("thesis"));
        for claim in of_thesis {
            for range in claim.lines {
                let named = &lines[range.first as usize - 1..range.last as usize];
                let ends = [named[0], named[named.len() - 1]];
                assert!(
                    ends.iter().all(|l| !l.trim().is_empty()),
                    "{}: {range}",
                    claim.id
                );
            }
        }
    }
}
