//! How often something was amiss in a file, and first where.

use super::warning::SceneWarning;

/// How often, and first where.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) count: usize,
    pub(crate) first: String,
}

impl Tally {
    pub(crate) fn add(&mut self, first: impl FnOnce() -> String) {
        self.add_many(1, first);
    }

    pub(crate) fn add_many(&mut self, count: usize, first: impl FnOnce() -> String) {
        if self.count == 0 && count > 0 {
            self.first = first();
        }
        // Counts of files may be any.
        self.count = self.count.saturating_add(count);
    }

    /// A warning that says `what` was amiss, if it was.
    pub(crate) fn warning(&self, code: &'static str, what: &str) -> Option<SceneWarning> {
        (self.count > 0).then(|| SceneWarning {
            code,
            count: self.count,
            message: format!("{what} (first: {})", beginning(&self.first, 400)),
        })
    }
}

/// The beginning of what a file says: lines and names may be as long as the file.
pub(crate) fn beginning(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
