//! The quantitative claims of the papers, measured again (docs/papers.md, claims).
//!
//! A [`Claim`] says what was published and where; measuring it gives a [`Finding`]:
//! figures of theirs and ours side by side, what was counted with how many bytes an
//! access has, and whether direction and rough size hold. To add one, write its
//! function in the file of its paper and add one entry to that file's list.
//!
//! ```
//! use gnomon_claims::{Judgement, Lab, LabSettings, find};
//!
//! let claim = find("paper4-table-memory")?;
//! let finding = claim.measure(&mut Lab::new(LabSettings::default(), None))?.unwrap();
//! assert_eq!(finding.measures[0].ours, 331_776.0); // bytes
//! assert_eq!(finding.measures[0].judgement(), Judgement::Holds);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod annen;
mod annen_shadows;
mod annen_sky;
mod annen_table;
pub mod chart;
mod cones;
mod equal_error;
mod finding;
mod judge;
mod lab;
mod lines;
mod overlaps;
mod paper1;
mod paper1_buffer;
mod paper1_sizes;
mod paper2;
mod paper2_ending;
mod paper2_range;
mod paper2_recorded;
mod paper2_rest;
mod paper2_tiles;
mod paper2_time;
mod paper3;
mod paper3_images;
mod paper3_recorded;
mod paper3_scaling;
mod paper4;
mod paper4_quality;
mod paper5;
mod recorded;
mod scenes;
mod shader_work;
mod smoothies;
mod tally;
mod tamura;
mod thesis;

use thiserror::Error;

pub use finding::{Finding, Measure, Unit};
pub use judge::{Judgement, SLACK, Theirs};
pub use lab::{Lab, LabSettings, ReproduceError};
pub use lines::Lines;

/// How a claim can be checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// A: exact arithmetic.
    Arithmetic,
    /// B: a ratio of counters.
    Counters,
    /// C: direction and rough ratio of times on this machine.
    Times,
    /// D: bound to hardware of its time; quoted only.
    Quoted,
}

impl Verdict {
    /// The letter of docs/papers.md, claims.
    pub fn letter(self) -> char {
        match self {
            Self::Arithmetic => 'A',
            Self::Counters => 'B',
            Self::Times => 'C',
            Self::Quoted => 'D',
        }
    }
}

/// How a claim is measured.
type Measuring = fn(&mut Lab) -> Result<Finding, ReproduceError>;

/// A published claim.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// Name on the command line, kebab-case.
    pub id: &'static str,
    /// Paper and section.
    pub source: &'static str,
    /// What was claimed, in our words.
    pub statement: &'static str,
    /// How it can be checked.
    pub verdict: Verdict,
    /// The lines of the source's transcription that it was read from, in order; empty
    /// where they are not recorded.
    pub lines: &'static [Lines],
    measuring: Option<Measuring>,
}

impl Claim {
    const fn new(
        id: &'static str,
        source: &'static str,
        verdict: Verdict,
        statement: &'static str,
        measuring: Measuring,
    ) -> Self {
        Self {
            id,
            source,
            statement,
            verdict,
            lines: &[],
            measuring: Some(measuring),
        }
    }

    const fn quoted(id: &'static str, source: &'static str, statement: &'static str) -> Self {
        Self {
            id,
            source,
            statement,
            verdict: Verdict::Quoted,
            lines: &[],
            measuring: None,
        }
    }

    /// The same claim, with the lines that it was read from.
    const fn read_from(mut self, lines: &'static [Lines]) -> Self {
        self.lines = lines;
        self
    }

    /// Measures it; `None` for claims that can only be quoted.
    ///
    /// # Errors
    /// A scene cannot be rendered at the size, or there is no truth to compare with.
    pub fn measure(&self, lab: &mut Lab) -> Result<Option<Finding>, ReproduceError> {
        self.measuring.map(|measure| measure(lab)).transpose()
    }
}

/// All claims, paper by paper.
pub fn claims() -> impl Iterator<Item = &'static Claim> {
    let papers: [&'static [Claim]; 16] = [
        thesis::CLAIMS,
        paper1::CLAIMS,
        paper1_buffer::CLAIMS,
        paper1_sizes::CLAIMS,
        paper2::CLAIMS,
        paper2_range::CLAIMS,
        paper2_recorded::CLAIMS,
        paper2_rest::CLAIMS,
        paper3::CLAIMS,
        paper3_recorded::CLAIMS,
        paper4::CLAIMS,
        paper5::CLAIMS,
        annen::CLAIMS,
        cones::CLAIMS,
        smoothies::CLAIMS,
        tamura::CLAIMS,
    ];
    papers.into_iter().flatten()
}

/// No claim of that name.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("no claim is called '{name}'{}; there are: {}", gnomon_pipeline::world::error::suggestion(.nearest), .known.join(", "))]
pub struct UnknownClaim {
    /// The name asked for.
    pub name: String,
    /// The closest known name, when one is close.
    pub nearest: Option<&'static str>,
    /// All known names.
    pub known: Vec<&'static str>,
}

/// The claim called `id`.
///
/// # Errors
/// There is none: the error lists all and suggests the nearest.
pub fn find(id: &str) -> Result<&'static Claim, UnknownClaim> {
    claims().find(|c| c.id == id).ok_or_else(|| {
        let known: Vec<&'static str> = claims().map(|c| c.id).collect();
        UnknownClaim {
            name: id.to_owned(),
            nearest: gnomon_pipeline::world::error::nearest(id, &known),
            known,
        }
    })
}

#[cfg(test)]
mod tests;
