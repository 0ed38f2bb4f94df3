//! One file or folder per verb.

pub(crate) mod bisect;
pub(crate) mod compare;
pub(crate) mod debug;
pub(crate) mod demo;
pub(crate) mod diff;
pub(crate) mod dump;
pub(crate) mod info;
pub(crate) mod pixel;
pub(crate) mod profiles;
pub(crate) mod record;
pub(crate) mod render;
pub(crate) mod replay;
pub(crate) mod report;
pub(crate) mod reproduce;
pub(crate) mod scenes;
pub(crate) mod techniques;
pub(crate) mod traffic;
pub(crate) mod trim;

use gnomon_pipeline::technique::{Params, Technique, TechniqueError};

/// Parameters from `--set`. With `no_skip`, techniques that can leave work out
/// themselves do not, unless told otherwise.
fn parameters(
    technique: &dyn Technique,
    settings: &[(String, String)],
    no_skip: bool,
) -> Result<Params, TechniqueError> {
    let can_skip = technique.params().iter().any(|p| p.name == "skip");
    let implied = (no_skip && can_skip).then(|| "skip=off".to_owned());
    let given = settings.iter().map(|(key, value)| format!("{key}={value}"));
    Params::parse(technique, implied.into_iter().chain(given))
}

/// A scene's name with nothing in it that could leave a folder.
fn file_stem(scene: &str) -> String {
    let safe = |c: char| {
        if c.is_alphanumeric() || "-_".contains(c) {
            c
        } else {
            '-'
        }
    };
    scene.chars().map(safe).collect()
}
