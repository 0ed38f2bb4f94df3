//! What the demo proves about itself.

use serde::Serialize;

use super::shots::{Shot, same_bits};
use crate::error::CliError;

/// Verdicts on the demo's own frames.
#[derive(Clone, Copy, Serialize)]
pub(super) struct Checks {
    /// Rendering without skipping gives the same bits.
    skipping_is_invisible: bool,
    /// z-pass, z-fail and their mixture give the same bits.
    methods_agree: bool,
}

impl Checks {
    pub(super) fn of(shots: &[Shot]) -> Self {
        let volumes: Vec<&Shot> = shots
            .iter()
            .filter(|s| s.entry.technique == "shadow-volumes")
            .collect();
        Self {
            skipping_is_invisible: shots.iter().all(|s| same_bits(&s.done, &s.plain)),
            methods_agree: volumes
                .windows(2)
                .all(|w| same_bits(&w[0].done, &w[1].done)),
        }
    }

    pub(super) fn lines(self) -> [String; 2] {
        let verdict = |fine: bool| if fine { "yes" } else { "NO" };
        [
            format!(
                "same bits without skipping: {}",
                verdict(self.skipping_is_invisible)
            ),
            format!(
                "z-pass, z-fail and auto agree to the bit: {}",
                verdict(self.methods_agree)
            ),
        ]
    }

    pub(super) fn verdict(self) -> Result<(), CliError> {
        if self.skipping_is_invisible && self.methods_agree {
            return Ok(());
        }
        Err(CliError::Check(self.lines().join("; ")))
    }
}
