//! One file or folder per verb.

pub(crate) mod bench;
pub(crate) mod bisect;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod debug;
pub(crate) mod demo;
pub(crate) mod diff;
pub(crate) mod dump;
pub(crate) mod export;
pub(crate) mod info;
pub(crate) mod light;
pub(crate) mod man;
pub(crate) mod pixel;
pub(crate) mod profiles;
pub(crate) mod record;
pub(crate) mod render;
pub(crate) mod replay;
pub(crate) mod report;
pub(crate) mod reproduce;
pub(crate) mod scenes;
pub(crate) mod stress;
pub(crate) mod techniques;
pub(crate) mod traffic;
pub(crate) mod trim;
pub(crate) mod tune;
pub(crate) mod view;
pub(crate) mod wedge;

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
