//! Images of other renderers held against the truth.

use serde_json::Value;

use crate::common::Folder;

const SIZE: &str = "--size 96x72";

fn against(folder: &Folder, more: &str) -> Value {
    folder
        .gnomon(&format!("compare cylinder {more} --json"))
        .json()
}

fn number(document: &Value, key: &str) -> f64 {
    document[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key}: {document}"))
}

/// The renders of a technique as somebody else's files.
fn theirs(folder: &Folder, technique: &str) {
    folder
        .gnomon(&format!(
            "render cylinder {SIZE} --technique {technique} --out mine.png --visibility mine.npy"
        ))
        .fine();
}

#[test]
fn a_visibility_has_the_errors_that_compare_finds() {
    let folder = Folder::new("against-visibility");
    theirs(&folder, "shadow-volumes");
    let own = folder
        .gnomon(&format!(
            "compare cylinder {SIZE} --techniques shadow-volumes --json"
        ))
        .json();
    let found = against(&folder, "--against mine.npy");
    assert_eq!(found["content"], "visibility");
    for key in [
        "rmse",
        "max",
        "p99",
        "mean",
        "rmse_umbra",
        "rmse_penumbra",
        "rmse_lit",
    ] {
        assert_eq!(found[key], own["results"][0][key], "{key}");
    }
    assert_eq!(found["compared"], own["results"][0]["pixels"]["compared"]);
    // A hard shadow is on both sides of a soft one.
    assert!(number(&found, "too_dark") > 20.0 && number(&found, "too_bright") > 20.0);
    let worst = &found["worst"][0];
    let off = number(worst, "theirs") - number(worst, "truth");
    assert_eq!(off.abs(), number(&found, "max"));
    assert_eq!(
        worst["side"],
        if off < 0.0 { "too dark" } else { "too bright" }
    );
    assert!(folder.path("out/cylinder-against.png").is_file());
}

#[test]
fn without_shadows_everything_that_differs_is_too_bright() {
    let folder = Folder::new("against-bright");
    theirs(&folder, "unshadowed");
    for file in ["mine.npy", "mine.png"] {
        let found = against(&folder, &format!("--against {file}"));
        assert_eq!(number(&found, "too_dark"), 0.0, "{file}");
        assert!(number(&found, "too_bright") > 100.0 && number(&found, "mean") > 0.0);
        assert!(
            found["worst"]
                .as_array()
                .unwrap()
                .iter()
                .all(|w| w["side"] == "too bright")
        );
    }
    let text = folder
        .gnomon("compare cylinder --against mine.png")
        .fine()
        .stdout();
    assert!(
        text.contains("farthest from the truth") && text.contains("too bright"),
        "{text}"
    );
}

#[test]
fn pictures_and_gray_images_are_told_apart() {
    let folder = Folder::new("against-kinds");
    theirs(&folder, "soft-shadow-volumes");
    let picture = against(&folder, "--against mine.png");
    assert_eq!(picture["content"], "picture");
    let soft = number(&picture, "rmse");
    theirs(&folder, "shadow-volumes");
    assert!(soft < number(&against(&folder, "--against mine.png"), "rmse") / 4.0);
    // Gray is visibility, here lit everywhere.
    let white = image::GrayImage::from_pixel(96, 72, image::Luma([255]));
    white.save(folder.path("gray.png")).unwrap();
    let gray = against(&folder, "--against gray.png");
    assert_eq!(gray["content"], "visibility");
    assert_eq!(
        (number(&gray, "rmse_lit"), number(&gray, "rmse_umbra")),
        (0.0, 1.0)
    );
    // Linear light, encoded as pictures here are: black.
    image::Rgb32FImage::from_pixel(96, 72, image::Rgb([0.0; 3]))
        .save(folder.path("black.exr"))
        .unwrap();
    let black = against(&folder, "--against black.exr");
    assert_eq!(
        (black["content"].as_str(), number(&black, "too_bright")),
        (Some("picture"), 0.0)
    );
}

#[test]
fn a_truth_can_be_given() {
    let folder = Folder::new("against-truth");
    theirs(&folder, "soft-shadow-volumes");
    let same = against(&folder, "--against mine.npy --truth mine.npy");
    assert_eq!((number(&same, "rmse"), number(&same, "max")), (0.0, 0.0));
    assert_eq!(same["truth"], "mine.npy");
    assert!(same["worst"].as_array().unwrap().is_empty());
    assert!(number(&against(&folder, "--against mine.npy"), "rmse") > 0.0);
}

#[test]
fn files_that_cannot_be_compared_are_refused() {
    let folder = Folder::new("against-bad");
    theirs(&folder, "unshadowed");
    folder.write("x.npy", "no array");
    folder.write("x.exr", "no picture");
    folder.write("x.png", "no picture");
    folder.write("x.tif", "");
    for (flags, parts) in [
        ("--against none.npy", &["none.npy", "cannot be read"][..]),
        ("--against x.npy", &["x.npy", "NumPy"]),
        ("--against x.exr", &["x.exr", "OpenEXR"]),
        ("--against x.png", &["x.png"]),
        ("--against x.tif", &["x.tif", ".exr"]),
        ("--against mine.npy --size 8x8", &["--size", "8x8", "96x72"]),
        ("--against mine.npy --light 9", &["light 9"]),
        (
            "--against mine.npy --techniques unshadowed",
            &["--techniques"],
        ),
        (
            "--truth mine.npy --techniques unshadowed",
            &["--truth", "--techniques"],
        ),
        ("--truth mine.npy", &["--against"]),
    ] {
        folder
            .gnomon(&format!("compare cylinder {flags}"))
            .refused(parts);
    }
}
