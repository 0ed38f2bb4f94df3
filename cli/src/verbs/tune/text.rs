//! The summary for people.

use super::document::command;
use super::job::TuneJob;
use super::search::{Found, Tried};
use crate::output::numbers::{self, error};
use crate::output::tables::Table;
use crate::output::wrap::hanging;

/// Winner, command, runners-up; or that nothing fits, and what comes nearest.
pub(super) fn summarise(job: &TuneJob, found: &Found) -> String {
    let mut text = format!(
        "{}, light {}, {}x{}, {}: {} candidates tried, {} refused the scene\n",
        job.scene,
        job.light,
        job.size[0],
        job.size[1],
        job.budget.describe(),
        found.tried,
        found.refused,
    );
    if job.frames.len() > 1 {
        text += &format!("largest figures of {} frames\n", job.frames.len());
    }
    match &found.winner {
        Some(winner) => {
            text += &table("The winner, measured anew", std::slice::from_ref(winner));
            text += &hanging("render it with: ", 4, &command(job, winner));
            if !found.others.is_empty() {
                text += &table("Behind it", &found.others);
            }
        }
        None => {
            text += "Nothing that was tried keeps this budget.\n";
            if !found.others.is_empty() {
                text += &table("Nearest", &found.others);
            }
        }
    }
    for warning in &found.warnings {
        text += &format!("warning: {warning}\n");
    }
    text
}

fn table(title: &str, rows: &[Tried]) -> String {
    let header = ["technique and settings", "RMSE", "max", "time", "bytes"];
    let mut table = Table::new(title, &header);
    for Tried { candidate, figures } in rows {
        table.rows.push(vec![
            candidate.label(),
            error(figures.rmse),
            error(figures.max),
            numbers::milliseconds(figures.ms),
            numbers::bytes(figures.bytes as u64),
        ]);
    }
    format!("\n{}", table.to_text())
}
