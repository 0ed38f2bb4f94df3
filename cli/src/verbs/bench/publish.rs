//! The folder's tables, plots and page.

use super::document::BenchDocument;
use super::results::Results;
use super::store::Store;
use super::{charts, csv, page};
use crate::documents::FileDocument;
use crate::draw::plot;
use crate::error::CliError;
use crate::output::files::Batch;
use crate::output::png;

/// What is written: its kind, its name, its bytes.
type Output = (&'static str, String, Vec<u8>);

/// Writes everything that is made of the results, together or not at all.
pub(super) fn publish(results: &Results, store: &Store) -> Result<Vec<FileDocument>, CliError> {
    let mut outputs: Vec<Output> = vec![
        ("table", "bench.csv".to_owned(), csv::write(results).into()),
        ("document", "bench.json".to_owned(), json(results)?),
        ("page", "bench.html".to_owned(), page::make(results).into()),
    ];
    for group in results.groups() {
        for chart in charts::of_group(results, &group) {
            let svg = plot::cloud_svg(&chart.cloud).into();
            outputs.push(("plot", format!("{}.svg", chart.name), svg));
            let picture = png::encode(&plot::cloud_picture(&chart.cloud));
            outputs.push(("plot", format!("{}.png", chart.name), picture));
        }
    }
    write(&outputs, store)
}

fn write(outputs: &[Output], store: &Store) -> Result<Vec<FileDocument>, CliError> {
    let mut batch = Batch::default();
    let mut written = Vec::new();
    for (kind, name, bytes) in outputs {
        let path = store.path(name);
        batch.stage(&path, bytes)?;
        written.push(FileDocument {
            kind,
            path: path.display().to_string(),
        });
    }
    batch.commit()?;
    Ok(written)
}

fn json(results: &Results) -> Result<Vec<u8>, CliError> {
    let document = BenchDocument::new(results);
    let text = serde_json::to_string_pretty(&document).map_err(|e| CliError::Stdout(e.into()))?;
    Ok((text + "\n").into_bytes())
}
