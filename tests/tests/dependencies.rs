//! The shape of the workspace: which crate may need which, and what none may do.

use std::fs;
use std::path::{Path, PathBuf};

use gnomon_tests::sources::{below, read, root};
use toml::{Table, Value};

/// Crate, its folder, and the workspace crates that it may need.
/// Dependency goes one way: raster ← shaders ← pipeline ← claims ← cli, raster ← traces ← claims,
/// traces ← golden.
const LAYERS: &[(&str, &str, &[&str])] = &[
    ("gnomon-raster", "raster", &[]),
    ("gnomon-shaders", "shaders-rs", &["gnomon-raster"]),
    (
        "gnomon-pipeline",
        "pipeline",
        &["gnomon-raster", "gnomon-shaders"],
    ),
    (
        "gnomon-claims",
        "claims",
        &[
            "gnomon-raster",
            "gnomon-shaders",
            "gnomon-pipeline",
            "gnomon-traces",
        ],
    ),
    ("gnomon-traces", "traces", &["gnomon-raster"]),
    (
        "gnomon-golden",
        "golden",
        &["gnomon-raster", "gnomon-traces"],
    ),
    (
        "gnomon",
        "cli",
        &[
            "gnomon-raster",
            "gnomon-shaders",
            "gnomon-pipeline",
            "gnomon-claims",
            "gnomon-traces",
            "gnomon-golden",
        ],
    ),
    (
        "gnomon-tests",
        "tests",
        &[
            "gnomon-raster",
            "gnomon-shaders",
            "gnomon-pipeline",
            "gnomon-traces",
        ],
    ),
];

/// Everything that the GPU needs. A new line is a decision; files, formats of
/// files and serialisation are none of its business.
const RASTER_NEEDS: &[&str] = &["bytemuck", "fearless_simd", "half", "rayon", "thiserror"];

/// What draws, prints or encodes stays in the command line.
const REPORTING: &[&str] = &[
    "clap",
    "comfy-table",
    "crossterm",
    "indicatif",
    "ratatui-core",
    "serde_json",
    "tiny-skia",
];

fn manifest(folder: &str) -> Table {
    let path = root().join(folder).join("Cargo.toml");
    let text = read(&path);
    text.parse()
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn members() -> Vec<String> {
    let workspace = manifest("");
    let members = workspace["workspace"]["members"].as_array();
    let text = |v: &Value| v.as_str().expect("a folder").to_owned();
    members.expect("a list").iter().map(text).collect()
}

fn package(manifest: &Table) -> &str {
    manifest["package"]["name"].as_str().expect("a name")
}

/// Names under `[dependencies]` and `[build-dependencies]`, of targets too.
fn needs(manifest: &Table) -> Vec<String> {
    let targets = manifest.get("target").and_then(Value::as_table);
    let of_targets = targets
        .into_iter()
        .flatten()
        .filter_map(|(_, t)| t.as_table());
    let tables = std::iter::once(manifest).chain(of_targets);
    let kinds = tables.flat_map(|t| {
        ["dependencies", "build-dependencies"].map(|k| t.get(k).and_then(Value::as_table))
    });
    let entries = kinds.flatten().flatten();
    entries
        .map(|(key, value)| {
            let renamed = value.get("package").and_then(Value::as_str);
            renamed.unwrap_or(key).to_owned()
        })
        .collect()
}

/// Whether a file is a module that its parent declares under `#[cfg(test)]`.
fn is_for_tests(path: &Path) -> bool {
    let parent = path.with_file_name("mod.rs");
    let Ok(parent) = fs::read_to_string(parent) else {
        return false;
    };
    let name = path.file_stem().and_then(|s| s.to_str()).expect("a name");
    let lines: Vec<&str> = parent.lines().map(str::trim).collect();
    lines
        .windows(2)
        .any(|w| w[0] == "#[cfg(test)]" && w[1].ends_with(&format!("mod {name};")))
}

/// Lines below `folder` whose code, comments left out, is one to find.
fn lines_where(folder: &Path, wanted: impl Fn(&str) -> bool) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for path in below(folder) {
        for (number, line) in read(&path).lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            if wanted(code) {
                found.push((path.clone(), format!("{}: {}", number + 1, line.trim())));
            }
        }
    }
    found
}

fn lines_with(folder: &Path, words: &[&str]) -> Vec<(PathBuf, String)> {
    lines_where(folder, |code| words.iter().any(|w| code.contains(w)))
}

#[test]
fn dependency_goes_one_way() {
    for folder in members() {
        let manifest = manifest(&folder);
        let name = package(&manifest);
        let layer = LAYERS.iter().find(|(n, ..)| *n == name);
        let (_, home, allowed) = layer.unwrap_or_else(|| panic!("{name} has no layer here"));
        assert_eq!(folder, *home, "the folder of {name}");
        for need in needs(&manifest) {
            let ours = LAYERS.iter().any(|(n, ..)| *n == need);
            assert!(
                !ours || allowed.contains(&need.as_str()),
                "{name} needs {need}; of the workspace it may need {allowed:?}"
            );
        }
    }
}

#[test]
fn the_gpu_needs_what_is_listed_and_no_more() {
    assert_eq!(needs(&manifest("raster")), RASTER_NEEDS);
}

#[test]
fn reporting_stays_in_the_command_line() {
    for folder in ["raster", "shaders-rs", "pipeline", "claims"] {
        let needs = needs(&manifest(folder));
        let found: Vec<_> = needs
            .iter()
            .filter(|n| REPORTING.contains(&n.as_str()))
            // Models and exported scenes are JSON; see the next test.
            .filter(|n| folder != "pipeline" || *n != "serde_json")
            .collect();
        assert!(found.is_empty(), "{folder} needs {found:?}");
    }
}

/// glTF is JSON: the pipeline reads it in one place, and writes it in another.
#[test]
fn json_of_the_pipeline_is_that_of_models() {
    let mut users = lines_with(&root().join("pipeline/src"), &["serde_json"]);
    users.retain(|(path, _)| !is_for_tests(path));
    assert!(!users.is_empty());
    for (path, line) in users {
        let inside = |part: &str| path.parent().is_some_and(|folder| folder.ends_with(part));
        let only = inside("world/model/gltf") || inside("world/export");
        // Checks the JSON Schema of scene files.
        let checks = path.ends_with("scene/file/documented.rs");
        assert!(only || checks, "{}: {line}", path.display());
    }
}

/// Environment maps, images of lights and textures are input: a module of the pipeline
/// decodes each, and none encodes pictures.
#[test]
fn pictures_are_decoded_where_they_are_read() {
    // A module of the oracle is called image, too, and used with `pub use`.
    let uses_it = |code: &str| code.trim_start().starts_with("use image::");
    let users = lines_where(&root().join("pipeline/src"), uses_it);
    assert!(!users.is_empty());
    for (path, line) in users {
        let places = ["environment/read", "light_image/read", "texture/decode"];
        let module = |at: &Path| places.iter().any(|place| at.ends_with(place));
        let only = module(&path.with_extension("")) || path.parent().is_some_and(module);
        assert!(only, "{}: {line}", path.display());
    }
    for folder in ["raster", "shaders-rs"] {
        assert!(!needs(&manifest(folder)).contains(&"image".to_owned()));
    }
}

#[test]
fn the_gpu_touches_nothing_outside() {
    let words = [
        "std::fs",
        "std::io",
        "std::net",
        "std::env",
        "std::process",
        "println!",
    ];
    let mut found = lines_with(&root().join("raster/src"), &words);
    found.retain(|(path, _)| !is_for_tests(path));
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn techniques_touch_no_thread_clock_or_file() {
    let words = [
        "std::fs",
        "std::io",
        "std::env",
        "std::thread",
        "std::time",
        "rayon",
    ];
    for folder in [
        "pipeline/src/technique",
        "pipeline/src/techniques",
        "pipeline/src/parts",
        "shaders-rs/src",
    ] {
        let found = lines_with(&root().join(folder), &words);
        assert!(found.is_empty(), "{found:#?}");
    }
}

#[test]
fn every_crate_is_under_the_lints_of_the_workspace() {
    let workspace = manifest("");
    let lint = workspace["workspace"]["lints"]["rust"]["unsafe_code"].as_str();
    assert!(matches!(lint, Some("deny" | "forbid")), "{lint:?}");
    for folder in members() {
        let manifest = manifest(&folder);
        let inherited = manifest.get("lints").and_then(|l| l.get("workspace"));
        assert_eq!(
            inherited,
            Some(&Value::Boolean(true)),
            "{folder}/Cargo.toml"
        );
    }
}

/// The lint can be allowed line by line; nobody does.
#[test]
fn there_is_no_unsafe_code() {
    let keyword = concat!("un", "safe");
    let uses_it = |code: &str| {
        let mut words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
        words.any(|w| w == keyword)
    };
    for folder in members() {
        let found = lines_where(&root().join(folder), uses_it);
        assert!(found.is_empty(), "{found:#?}");
    }
}

/// With `scalar-math` glam has one arithmetic on every target; its SIMD types,
/// which do not, are aligned to 16 bytes.
#[test]
fn glam_is_scalar() {
    assert_eq!(align_of::<glam::Vec4>(), 4);
    assert_eq!(align_of::<glam::Quat>(), 4);
    assert_eq!(align_of::<glam::Mat4>(), 4);
}
