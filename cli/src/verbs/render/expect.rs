//! A render held against the JSON document of an earlier one.

use std::path::{Path, PathBuf};

use gnomon_pipeline::world::files;
use serde_json::Value;

use crate::documents::RenderDocument;
use crate::error::CliError;

/// Bytes of a document that are read at most.
const MOST: u64 = 64 << 20;

/// Differences that are told.
const TOLD: usize = 20;

/// What is told first.
const FIRST: [&str; 7] = [
    "scene",
    "technique",
    "params",
    "size",
    "skip",
    "hash",
    "totals",
];

/// What may differ between equal renders: how and when they were executed, and what was
/// written where.
const FREE: [&str; 8] = [
    "threads", "tile", "simd", "repeat", "time_ms", "files", "warnings", "draws",
];

/// An earlier render.
pub(super) struct Baseline {
    path: PathBuf,
    document: Value,
}

impl Baseline {
    /// Reads and checks the document, before any work is done.
    pub(super) fn read(path: &Path) -> Result<Self, CliError> {
        let wrong = |problem: String| CliError::Results {
            path: path.to_owned(),
            problem,
        };
        let bytes = files::read(path, MOST).map_err(|e| wrong(e.to_string()))?;
        let document: Value = serde_json::from_slice(&bytes).map_err(|e| {
            wrong(format!(
                "{e}; expected the document of `gnomon render --json`"
            ))
        })?;
        let hash = |of: &str| document["hash"][of].is_string();
        if !(hash("color") && hash("visibility")) {
            let problem = "has no hashes; expected the document of `gnomon render --json`";
            return Err(wrong(problem.to_owned()));
        }
        Ok(Self {
            path: path.to_owned(),
            document,
        })
    }

    /// Lines that say what differs in `now`; none if nothing does.
    pub(super) fn differences(&self, now: &RenderDocument) -> Vec<String> {
        // By way of text, as the other one has come.
        let text = serde_json::to_string(now).expect("documents have keys and numbers");
        let now: Value = serde_json::from_str(&text).expect("JSON was written");
        let mut found = Vec::new();
        let others = now
            .as_object()
            .into_iter()
            .flatten()
            .map(|(key, _)| key.as_str());
        let others = others.filter(|k| !FIRST.contains(k) && !FREE.contains(k));
        for key in FIRST.into_iter().chain(others) {
            // Keys are only ever added.
            if let Some(before) = self.document.get(key) {
                compare(key, before, &now[key], &mut found);
            }
        }
        found
    }

    /// What is said of the differences.
    pub(super) fn tell(&self, differences: &[String]) -> String {
        let path = self.path.display();
        if differences.is_empty() {
            return format!("as {path} has it\n");
        }
        let mut text = format!("differs from {path} in {} values:\n", differences.len());
        for line in differences.iter().take(TOLD) {
            text += &format!("  {line}\n");
        }
        if differences.len() > TOLD {
            text += &format!("  and {} more\n", differences.len() - TOLD);
        }
        text
    }
}

fn compare(at: &str, before: &Value, now: &Value, found: &mut Vec<String>) {
    match (before, now) {
        (Value::Object(a), Value::Object(b)) => {
            for (key, now) in b {
                if key == "time_ms" {
                    continue;
                }
                let at = format!("{at}.{key}");
                match a.get(key) {
                    Some(before) => compare(&at, before, now, found),
                    // A counter that is newer than the document.
                    None if at.starts_with("passes") || at.starts_with("totals") => {}
                    None => found.push(format!("{at}: nothing, now {now}")),
                }
            }
            let gone = a.keys().filter(|k| !b.contains_key(*k));
            found.extend(gone.map(|k| format!("{at}.{k}: {}, now nothing", a[k])));
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (k, (before, now)) in a.iter().zip(b).enumerate() {
                compare(&format!("{at}[{k}]"), before, now, found);
            }
        }
        (Value::Array(a), Value::Array(b)) => {
            found.push(format!("{at}: {} of them, now {}", a.len(), b.len()));
        }
        _ if before == now => {}
        _ => found.push(format!("{at}: {before}, now {now}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[track_caller]
    fn check(before: Value, now: Value, expected: &[&str]) {
        let mut found = Vec::new();
        compare("a", &before, &now, &mut found);
        assert_eq!(found, expected);
    }

    #[test]
    fn differences_have_their_place_and_both_values() {
        check(
            json!({"b": 1, "c": [1, 2]}),
            json!({"b": 1, "c": [1, 2]}),
            &[],
        );
        check(json!({"b": 1}), json!({"b": 2}), &["a.b: 1, now 2"]);
        check(
            json!({"c": [1, 2]}),
            json!({"c": [1, 3]}),
            &["a.c[1]: 2, now 3"],
        );
        check(json!([1]), json!([1, 2]), &["a: 1 of them, now 2"]);
        check(json!({"b": "x"}), json!({}), &["a.b: \"x\", now nothing"]);
        check(json!({}), json!({"b": 3}), &["a.b: nothing, now 3"]);
        check(json!({"time_ms": 1}), json!({"time_ms": 2}), &[]);
        check(json!(1), json!("1"), &["a: 1, now \"1\""]);
    }
}
