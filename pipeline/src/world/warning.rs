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
