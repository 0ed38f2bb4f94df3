//! Materials of OBJ files.

use super::{codes, folder_of, hashes, render};
use crate::common::Folder;

/// Draws `file` in the colours of `base-red.obj`, with these warnings.
#[track_caller]
fn is_red(folder: &Folder, file: &str, warnings: &[&str]) {
    let [red, other] = ["base-red.obj", file].map(|f| render(folder, f));
    assert_eq!(hashes(&red)[1], hashes(&other)[1], "{file}");
    assert_eq!(codes(&other), warnings, "{file}");
}

fn folder(name: &str, files: &[&str]) -> Folder {
    folder_of(
        name,
        &[&["base-red.obj", "red.mtl", "base.obj"], files].concat(),
    )
}

#[test]
fn comments_do_not_lose_the_paint() {
    let folder = folder(
        "comments",
        &["comment-usemtl.obj", "comment-kd.obj", "c.mtl"],
    );
    is_red(&folder, "comment-usemtl.obj", &[]);
    is_red(&folder, "comment-kd.obj", &[]);
    let [red, plain] = ["base-red.obj", "base.obj"].map(|f| render(&folder, f));
    assert_ne!(hashes(&red)[1], hashes(&plain)[1]);
}

#[test]
fn byte_order_marks_do_not_lose_the_paint() {
    let folder = folder("marks", &["bom-mtllib.obj", "bom-mtl.obj", "bom.mtl"]);
    is_red(&folder, "bom-mtllib.obj", &[]);
    is_red(&folder, "bom-mtl.obj", &[]);
}

#[test]
fn names_may_have_blanks_quotes_and_signs() {
    let folder = folder("names", &["mtl-blank.obj", "my paint.mtl"]);
    is_red(&folder, "mtl-blank.obj", &[]);
    let text = std::fs::read_to_string(folder.path("base-red.obj")).unwrap();
    for (library, material) in [
        ("mtllib \"my paint.mtl\"", "usemtl red"),
        (
            "mtllib my paint.mtl   # the one with a blank",
            "usemtl red\t",
        ),
        ("mtllib none.mtl my paint.mtl", "usemtl red # body"),
        ("mtllib .\\red.mtl", "usemtl \"red\""),
        ("mtllib ./red.mtl", "usemtl red #2"),
    ] {
        let text = text.replace("mtllib red.mtl", library);
        let text = text.replace("usemtl red", material);
        folder.write("n.obj", &text);
        let missing = library.contains("none.mtl").then_some("missing-mtl");
        is_red(&folder, "n.obj", missing.as_slice());
    }
    let paint = std::fs::read_to_string(folder.path("red.mtl")).unwrap();
    folder.write(
        "p.mtl",
        &paint
            .replace("newmtl red", "newmtl Material #1")
            .replace('\n', "\r"),
    );
    folder.write(
        "n.obj",
        &text
            .replace("red.mtl", "p.mtl")
            .replace("usemtl red", "usemtl Material #1"),
    );
    is_red(&folder, "n.obj", &[]);
}

#[test]
fn what_is_not_drawn_is_told() {
    let folder = folder("told", &[]);
    let text = std::fs::read_to_string(folder.path("red.mtl")).unwrap();
    folder.write(
        "red.mtl",
        &format!("{text}map_Kd wood.png # wood\nbump b.png\nKD 1 1 1\n"),
    );
    let document = render(&folder, "base-red.obj");
    let found = codes(&document);
    assert_eq!(found, ["bad-mtl", "ignored-maps", "missing-maps"]);
    for (number, name) in [(1, "red.mtl:"), (2, "wood.png")] {
        let maps = &document["warnings"][number];
        assert_eq!(maps["count"], 1);
        assert!(maps["message"].as_str().unwrap().contains(name), "{maps}");
    }
    let text = std::fs::read_to_string(folder.path("base-red.obj")).unwrap();
    folder.write("n.obj", &text.replace("mtllib red.mtl\n", ""));
    assert_eq!(codes(&render(&folder, "n.obj")), ["unknown-material"]);
}
