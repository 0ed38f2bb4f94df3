//! What is said of a scene or a frame without stopping the work.

/// Something amiss in a scene that did not stop it from being made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneWarning {
    /// Stable kebab-case code, e.g. `concave-polygons`.
    pub code: &'static str,
    /// How many times.
    pub count: usize,
    /// For people: what, where, and what to do about it.
    pub message: String,
}

/// The first of some names, and how many more there are.
pub(crate) fn first_few(names: &[String], shown: usize) -> String {
    let list = names[..names.len().min(shown)].join(", ");
    match names.len().saturating_sub(shown) {
        0 => list,
        more => format!("{list} and {more} more"),
    }
}
