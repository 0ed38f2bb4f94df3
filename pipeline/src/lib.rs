//! Scenes, geometry and shadow techniques.
