//! The order inside crates: pipeline's wings know only those before them, and no
//! folders know each other, round whatever circle.
//!
//! Read from the sources: paths that begin with `crate` or `super`, comments and
//! tests left out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use gnomon_tests::sources::{below, read, root};

/// Pipeline's wings. Each may use those above it.
const WINGS: [&str; 7] = [
    "world",
    "geometry",
    "truth",
    "technique",
    "parts",
    "techniques",
    "measure",
];

/// Crates in which folders form no circle.
const CRATES: [&str; 6] = ["raster", "shaders-rs", "pipeline", "claims", "cli", "tests"];

/// A module's path from the root of its crate.
type Module = Vec<String>;

/// Who uses whom, with one file that does, among the neighbours of one folder.
type Uses = BTreeMap<(String, String), PathBuf>;

fn src(folder: &str) -> PathBuf {
    root().join(folder).join("src")
}

/// Sources without files and folders of tests.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let is_test = |name: &std::ffi::OsStr| name == "tests" || name == "tests.rs";
    let inside = |path: &PathBuf| path.strip_prefix(folder).expect("below it").to_owned();
    let mut all = below(folder);
    all.retain(|path| !inside(path).iter().any(is_test));
    all
}

fn module(root: &Path, file: &Path) -> Module {
    let inside = file.strip_prefix(root).expect("below the root");
    let names = inside.with_extension("");
    let mut path: Module = names
        .components()
        .map(|c| c.as_os_str().to_string_lossy().into_owned())
        .collect();
    if matches!(
        path.last().map(String::as_str),
        Some("mod" | "lib" | "main")
    ) {
        path.pop();
    }
    path
}

/// Code of a file up to its unit tests, without comments.
fn code(file: &Path) -> String {
    let text = read(file);
    let lines = text.lines().take_while(|l| l.trim() != "#[cfg(test)]");
    let bare = lines.map(|l| l.split("//").next().unwrap_or_default());
    bare.collect::<Vec<_>>().join("\n")
}

fn is_path(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == ':'
}

/// `a::{b, c::d}` as `a::b a::c::d`, innermost braces first.
fn without_groups(code: &str) -> String {
    let mut code = code.to_owned();
    while let Some(open) = code.rfind("::{") {
        let inside = &code[open + 3..];
        let close = inside.find('}').map_or(code.len(), |at| open + 3 + at);
        let prefix_at = code[..open].rfind(|c| !is_path(c)).map_or(0, |at| at + 1);
        let prefix = &code[prefix_at..open];
        let items = code[open + 3..close].split(',').map(str::trim);
        let paths =
            items.flat_map(|item| item.split_whitespace().map(|i| format!("{prefix}::{i}")));
        let expanded = paths.collect::<Vec<_>>().join(" ");
        let end = (close + 1).min(code.len());
        code.replace_range(prefix_at..end, &expanded);
    }
    code
}

/// Paths that begin with `crate` or `super`, from the root of the crate.
fn used(own: &Module, code: &str) -> Vec<Module> {
    let code = without_groups(code);
    let paths = code.split(|c: char| !is_path(c));
    paths.filter_map(|p| resolve(own, p)).collect()
}

fn resolve(own: &Module, path: &str) -> Option<Module> {
    let names: Vec<&str> = path.split("::").filter(|n| !n.is_empty()).collect();
    let up = names.iter().take_while(|n| **n == "super").count();
    let start = match (names.first(), up) {
        (Some(&"crate"), _) => Vec::new(),
        (_, 0) => return None,
        _ => own[..own.len().checked_sub(up)?].to_vec(),
    };
    let rest = names[up.max(1)..].iter().map(|n| (*n).to_owned());
    Some(start.into_iter().chain(rest).collect())
}

/// Uses by folder: where two paths part, one neighbour uses the other.
fn uses(root: &Path) -> BTreeMap<Module, Uses> {
    let mut all: BTreeMap<Module, Uses> = BTreeMap::new();
    for file in sources(root) {
        let own = module(root, &file);
        for other in used(&own, &code(&file)) {
            let shared = own.iter().zip(&other).take_while(|(a, b)| a == b).count();
            let (Some(from), Some(to)) = (own.get(shared), other.get(shared)) else {
                continue;
            };
            let folder = own[..shared].to_vec();
            let place = folder.iter().fold(root.to_owned(), |p, name| p.join(name));
            if place.join(to).is_dir() || place.join(format!("{to}.rs")).is_file() {
                let edge = (from.clone(), to.clone());
                all.entry(folder).or_default().insert(edge, file.clone());
            }
        }
    }
    all
}

/// All that `from` uses, straight or by way of others.
fn reached<'a>(uses: &'a Uses, from: &'a str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(at) = open.pop() {
        let next = uses
            .keys()
            .filter(|(a, _)| a == at)
            .map(|(_, b)| b.as_str());
        open.extend(next.filter(|b| found.insert(*b)));
    }
    found
}

fn circles(uses: &Uses) -> Vec<String> {
    let on_circle = |(a, b): &(String, String)| reached(uses, b).contains(a.as_str());
    let edges = uses.iter().filter(|(edge, _)| on_circle(edge));
    edges
        .map(|((a, b), file)| format!("{a} uses {b} in {}", file.display()))
        .collect()
}

#[test]
fn wings_know_only_those_before_them() {
    let root = src("pipeline");
    let uses = &uses(&root)[&Vec::new()];
    let place = |name: &str| WINGS.iter().position(|w| *w == name);
    for ((from, to), file) in uses {
        let (a, b) = (place(from), place(to));
        assert!(a.is_some() && b.is_some(), "{from} or {to} is no wing");
        assert!(b < a, "{from} uses {to} in {}", file.display());
    }
    let all: BTreeSet<&str> = uses
        .keys()
        .flat_map(|(a, b)| [a.as_str(), b.as_str()])
        .collect();
    assert_eq!(
        all,
        BTreeSet::from(WINGS),
        "wings that nothing uses or that use nothing"
    );
}

/// Uses between neighbours that are folders both.
fn between_folders(place: &Path, uses: &Uses) -> Uses {
    let is_folder = |name: &String| place.join(name).is_dir();
    let edges = uses
        .iter()
        .filter(|((a, b), _)| is_folder(a) && is_folder(b));
    edges
        .map(|(edge, file)| (edge.clone(), file.clone()))
        .collect()
}

#[test]
fn no_circle_goes_through_folders() {
    for folder in CRATES {
        let root = src(folder);
        for (place, uses) in uses(&root) {
            let path = place.iter().fold(root.clone(), |p, name| p.join(name));
            let found = circles(&between_folders(&path, &uses));
            assert!(found.is_empty(), "{}: {found:#?}", path.display());
        }
    }
}

/// Files count as well where the order matters most.
#[test]
fn neighbours_in_wings_form_no_circle() {
    for (place, uses) in uses(&src("pipeline")) {
        if place.len() < 2 {
            let found = circles(&uses);
            assert!(found.is_empty(), "{}: {found:#?}", place.join("/"));
        }
    }
}

#[test]
fn circles_are_found() {
    let uses = |edges: &[(&str, &str)]| -> Uses {
        let edge = |(a, b): &(&str, &str)| ((a.to_string(), b.to_string()), PathBuf::new());
        edges.iter().map(edge).collect()
    };
    assert!(circles(&uses(&[("a", "b"), ("b", "c"), ("a", "c")])).is_empty());
    assert_eq!(
        circles(&uses(&[("a", "b"), ("b", "c"), ("c", "a"), ("d", "a")])).len(),
        3
    );
    let own: Module = ["parts", "maps", "fit"].map(str::to_owned).to_vec();
    let of = |path| resolve(&own, path).map(|m| m.join("/"));
    assert_eq!(
        of("super::super::view::View").as_deref(),
        Some("parts/view/View")
    );
    assert_eq!(of("crate::world::light").as_deref(), Some("world/light"));
    assert_eq!(of("std::sync"), None);
    let grouped = "use super::{fit::{self, Fit}, frame};";
    let found: Vec<String> = used(&own, grouped).iter().map(|m| m.join("/")).collect();
    let expected = ["self", "Fit"].map(|n| format!("parts/maps/fit/{n}"));
    assert_eq!(found[..2], expected);
    assert_eq!(found[2], "parts/maps/frame");
}
