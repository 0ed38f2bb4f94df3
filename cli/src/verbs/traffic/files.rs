//! Traffic as CSV and as arrays.

use std::path::Path;

use gnomon_traces::profile::Traffic;

use crate::documents::{By, TrafficDocument, dram_bytes};
use crate::error::CliError;
use crate::output::csv::cell;
use crate::output::{files, npy};

/// A file that was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Csv,
    Npy,
}

/// Which file `path` is to be.
pub(super) fn kind(path: &Path, by: By, profiles: usize) -> Result<Kind, CliError> {
    files::check_target(path)?;
    let wrong = |valid: &str| {
        Err(CliError::Flag {
            flag: "--out",
            value: path.display().to_string(),
            valid: valid.to_owned(),
        })
    };
    match path.extension().and_then(|e| e.to_str()) {
        Some("csv") => Ok(Kind::Csv),
        Some("npy") if !matches!(by, By::Tile | By::Pixel) => {
            wrong("an array needs --by tile or --by pixel; .csv takes all")
        }
        Some("npy") if profiles != 1 => wrong("an array is of one profile; .csv takes several"),
        Some("npy") => Ok(Kind::Npy),
        _ => wrong("expected a file name that ends in .csv or .npy"),
    }
}

pub(super) fn csv(documents: &[TrafficDocument]) -> String {
    let mut text = "profile,key,client,logical_read_bytes,logical_write_bytes,cache_read_bytes,\
        cache_write_bytes,dram_read_bytes,dram_write_bytes,hiz_disabled_reason\n"
        .to_owned();
    for d in documents {
        for row in &d.rows {
            let l = &row.levels;
            let amounts = [l.logical, l.cache, l.dram];
            let numbers = amounts.map(|a| format!("{},{}", a.read_bytes, a.write_bytes));
            let reason = row.hiz.disabled_reason.as_deref().unwrap_or_default();
            let cells = [
                cell(&d.profile),
                cell(&row.key),
                row.client.clone(),
                numbers.join(","),
                cell(reason),
            ];
            text += &cells.join(",");
            text.push('\n');
        }
    }
    text
}

/// dram bytes in both directions of all clients.
pub(super) fn array(traffic: &Traffic, by: By) -> Vec<u8> {
    let place = match by {
        By::Pixel => traffic.size,
        _ => traffic.grid,
    };
    let values: Vec<f32> = dram_bytes(traffic, by).iter().map(|n| *n as f32).collect();
    npy::encode(place, &values)
}
