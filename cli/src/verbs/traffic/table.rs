//! Traffic as a table.

use gnomon_traces::profile::Levels;

use crate::documents::TrafficDocument;
use crate::output::numbers::bytes;
use crate::output::tables::Table;

/// Most rows that are printed; files and JSON have all.
const MOST: usize = 200;

pub(super) fn text(document: &TrafficDocument) -> String {
    let header = [
        document.by,
        "client",
        "logical",
        "cache",
        "dram read",
        "dram write",
    ];
    let title = format!("{} under {}", document.trace, document.profile);
    let mut table = Table::new(&title, &header);
    let mut last = None;
    for row in document.rows.iter().take(MOST) {
        let key = match last == Some(&row.key) {
            true => String::new(),
            false => row.key.clone(),
        };
        last = Some(&row.key);
        table.rows.push(cells(key, row.client.clone(), &row.levels));
    }
    let total = cells("total".to_owned(), String::new(), &document.totals);
    table.rows.push(total);
    table.to_text() + &notes(document)
}

fn cells(key: String, client: String, levels: &Levels) -> Vec<String> {
    vec![
        key,
        client,
        bytes(levels.logical.bytes()),
        bytes(levels.cache.bytes()),
        bytes(levels.dram.read_bytes),
        bytes(levels.dram.write_bytes),
    ]
}

fn notes(document: &TrafficDocument) -> String {
    let mut notes = String::new();
    if document.rows.len() > MOST {
        let more = document.rows.len() - MOST;
        notes += &format!("{more} more rows: use --out FILE.csv or --json\n");
    }
    let mut last = None;
    for row in &document.rows {
        if let Some(reason) = &row.hiz.disabled_reason
            && last != Some(&row.key)
        {
            notes += &format!("hiz off in {}: {reason}\n", row.key);
        }
        last = Some(&row.key);
    }
    for merge in document.merges.iter().flatten() {
        let said = merge.refused_reason.as_deref();
        let said = said.map_or_else(
            || "goes on in the tiles of the passes before".to_owned(),
            |reason| format!("begins tiles of its own: {reason}"),
        );
        notes += &format!("pass {} {said}\n", merge.key);
    }
    if !document.texels_recorded {
        notes += "no look-ups were recorded: textures have no cache and dram bytes\n";
    }
    notes
}
