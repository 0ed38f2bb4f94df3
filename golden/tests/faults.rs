//! What is said of frames that are not their goldens.

use std::fs;
use std::path::{Path, PathBuf};

use gnomon_golden::{Golden, GoldenError, Mode};
use gnomon_raster::shader::ScalarFragmentOutput;
use gnomon_raster::{FrameBuilder, LoadOp, Recording, TriangleDraw};

/// A folder of its own, empty at first.
fn golden(name: &str, mode: Mode) -> Golden {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    Golden {
        scratch: folder.join("scratch"),
        folder,
        mode,
    }
}

/// Blessed in a folder of its own.
fn blessed(name: &str, frame: &Recording) -> Golden {
    let golden = golden(name, Mode::Bless);
    let _ = fs::remove_dir_all(&golden.folder);
    let error = golden.check("frame", frame).expect_err("blessing fails");
    assert!(matches!(error, GoldenError::Blessed(_)), "{error}");
    Golden {
        mode: Mode::Compare,
        ..golden
    }
}

const FAR: [[f32; 3]; 3] = [[-0.9, -0.9, 0.8], [0.9, -0.9, 0.8], [-0.9, 0.9, 0.8]];

/// Two triangles over several tiles; the second one is as told.
fn frame(near: [[f32; 3]; 3], green: f32) -> Recording {
    let corners = [FAR, near].concat();
    let color = ScalarFragmentOutput::color([1.0, green, 0.0, 1.0]);
    let mut frame = FrameBuilder::new(192, 128).expect("a valid size");
    frame.draw(TriangleDraw::new("triangles", &corners).shade(move |_| color));
    frame.build()
}

const NEAR: [[f32; 3]; 3] = [[0.5, 0.5, 0.2], [0.9, 0.5, 0.2], [0.5, 0.9, 0.2]];

fn message(golden: &Golden, frame: &Recording) -> String {
    let error = golden.check("frame", frame).expect_err("it differs");
    assert!(matches!(error, GoldenError::Differs(_)), "{error}");
    error.to_string()
}

fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "no `{part}` in\n{message}");
    }
}

#[test]
fn equal_frames_pass() {
    let frame = frame(NEAR, 0.5);
    blessed("equal", &frame)
        .check("frame", &frame)
        .expect("equal");
}

#[test]
fn a_missing_golden_fails_and_nothing_is_written() {
    let golden = golden("missing", Mode::Compare);
    let _ = fs::remove_dir_all(&golden.folder);
    let error = golden.check("frame", &frame(NEAR, 0.5)).expect_err("none");
    assert_says(&error.to_string(), &["no golden", "GNOMON_BLESS=1"]);
    assert!(!golden.folder.exists());
}

#[test]
fn blessing_is_refused_in_ci() {
    let golden = golden("ci", Mode::BlessInCi);
    let _ = fs::remove_dir_all(&golden.folder);
    let error = golden.check("frame", &frame(NEAR, 0.5)).expect_err("CI");
    assert!(matches!(error, GoldenError::BlessInCi), "{error}");
    assert!(!golden.folder.exists());
}

/// Blessing what is equal already writes nothing and passes.
#[test]
fn blessing_writes_what_differs_only() {
    let first = frame(NEAR, 0.5);
    let golden = Golden {
        mode: Mode::Bless,
        ..blessed("again", &first)
    };
    golden.check("frame", &first).expect("equal");
    golden
        .check("frame", &frame(NEAR, 0.75))
        .expect_err("blessed");
    golden
        .check("frame", &frame(NEAR, 0.75))
        .expect("equal now");
}

/// One colour one step off: the first tile, the pixel with both values, its history.
#[test]
fn one_step_of_colour_is_found() {
    let golden = blessed("step", &frame(NEAR, 0.5));
    let told = message(&golden, &frame(NEAR, 0.504));
    assert_says(
        &told,
        &[
            "pass 0 `frame`, draw 0 `triangles`",
            "column 0, row 0",
            "[255, 128, 0, 255] expected, [255, 129, 0, 255] found",
            "history of pixel",
            "primitive 0 front: Written",
        ],
    );
    assert_pictures(&golden.scratch, 3);
}

fn assert_pictures(folder: &PathBuf, count: usize) {
    let files = fs::read_dir(folder).expect("pictures").count();
    assert_eq!(files, count, "{}", folder.display());
}

/// A vertex moved: counters say so, and the tile is the one where it was.
#[test]
fn a_moved_vertex_is_found_in_its_tile() {
    let golden = blessed("vertex", &frame(NEAR, 0.5));
    let mut moved = NEAR;
    moved[1][0] = 0.8;
    let told = message(&golden, &frame(moved, 0.5));
    assert_says(
        &told,
        &[
            "fragments.generated:",
            "column 2, row 0",
            "history of pixel",
        ],
    );
}

/// Depth alone: no picture shows it, the hash and the history do.
#[test]
fn depth_that_no_picture_shows_is_found() {
    let golden = blessed("depth", &frame(NEAR, 0.5));
    let mut nearer = NEAR;
    nearer.iter_mut().for_each(|c| c[2] = 0.1);
    let told = message(&golden, &frame(nearer, 0.5));
    assert_says(
        &told,
        &[
            "\"depth\" mip 0",
            "column 2, row 0",
            "equal in eight bits",
            "history",
        ],
    );
}

/// What no draw did is told as such.
#[test]
fn another_clear_is_found() {
    let golden = blessed("clear", &frame(NEAR, 0.5));
    let mut other = frame(NEAR, 0.5);
    other.list.passes[0].color[0].load = LoadOp::Clear([0.0, 0.0, 1.0, 1.0]);
    let told = message(&golden, &other);
    assert_says(
        &told,
        &["Clear([0.0, 0.0, 0.0, 1.0])", "Clear([0.0, 0.0, 1.0, 1.0])"],
    );
}

#[test]
fn a_golden_that_is_none_is_told_with_its_line() {
    let frame = frame(NEAR, 0.5);
    let golden = blessed("malformed", &frame);
    let path = golden.folder.join("frame.golden");
    let text = fs::read_to_string(&path).expect("a golden");
    fs::write(&path, text.replacen("count ", "cuont ", 1)).expect("written");
    let error = golden.check("frame", &frame).expect_err("malformed");
    let line = 1 + text
        .lines()
        .position(|l| l.contains("count "))
        .expect("one");
    assert_says(&error.to_string(), &["cuont", &format!("line {line}")]);
}

/// The first test of the documentation is the one that is compiled, and is short.
#[test]
fn the_first_test_of_the_documentation_has_fifteen_lines() {
    let test = include_str!("../../cli/tests/first.rs");
    let docs = include_str!("../../docs/testing.md");
    assert!(
        docs.contains(&format!("```rust\n{test}```")),
        "docs/testing.md"
    );
    assert!(test.lines().count() <= 15, "{}", test.lines().count());
}
