//! Models, materials, maps and scenes as other programs write them: what users
//! bring is read as they mean it, or refused with its place.

mod edges;
mod formats;
mod maps;
mod models;
mod paint;
mod reach;
mod scenes;

use std::path::{Path, PathBuf};

use crate::common::Folder;
use serde_json::Value;

/// The files that lie beside these tests.
fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/wild")
        .join(name)
}

/// A folder with copies of `files`.
fn folder_of(test: &str, files: &[&str]) -> Folder {
    let folder = Folder::new(&format!("wild-{test}"));
    for file in files {
        std::fs::copy(fixture(file), folder.path(file)).unwrap();
    }
    folder
}

const SMALL: &str = "--size 160x120 --json";

/// The document of a render.
fn render(folder: &Folder, arguments: &str) -> Value {
    folder.gnomon(&format!("render {arguments} {SMALL}")).json()
}

/// Hashes of a render's visibility and colour.
fn hashes(document: &Value) -> [&str; 2] {
    ["visibility", "color"].map(|of| document["hash"][of].as_str().unwrap())
}

fn codes(document: &Value) -> Vec<&str> {
    let warnings = document["warnings"].as_array().unwrap();
    warnings
        .iter()
        .map(|w| w["code"].as_str().unwrap())
        .collect()
}

/// Pixels of two pictures that differ by more than 8 of 255 in any channel.
fn differing(folder: &Folder, a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|name| image::open(folder.path(name)).unwrap().into_rgb8());
    assert_eq!(a.dimensions(), b.dimensions());
    let far = |(p, q): &(&image::Rgb<u8>, &image::Rgb<u8>)| {
        p.0.iter().zip(q.0).any(|(x, y)| x.abs_diff(y) > 8)
    };
    a.pixels().zip(b.pixels()).filter(far).count()
}
