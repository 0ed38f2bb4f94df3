//! What a trace says about itself.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// What was recorded, and by what: no time, no host, so that equal runs give equal files.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Meta {
    /// Program and version that wrote the file.
    pub producer: String,
    /// The scene's name; empty for a recording of one's own.
    #[serde(default)]
    pub scene: String,
    /// The technique's name; empty for a recording of one's own.
    #[serde(default)]
    pub technique: String,
    /// Settings, by name.
    #[serde(default)]
    pub params: BTreeMap<String, String>,
    /// Width and height of the picture in pixels.
    #[serde(default)]
    pub size: [u32; 2],
    /// How shaders are there.
    #[serde(default)]
    pub mode: Mode,
    /// How many frames there are.
    #[serde(default)]
    pub frames: u32,
    /// Frames per second of an animation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fps: Option<f64>,
    /// Time of the first frame in seconds.
    #[serde(default)]
    pub time: f64,
    /// Block accesses were recorded.
    #[serde(default)]
    pub traffic: bool,
}

/// How a trace holds shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// By name, version and uniforms: replaying runs them.
    #[default]
    Live,
    /// By what they gave: replaying looks it up.
    Frozen,
}

impl Meta {
    /// Of a frame of one's own, called `scene`.
    #[must_use]
    pub fn new(scene: &str) -> Self {
        Self {
            scene: scene.to_owned(),
            ..Self::default()
        }
    }
}
