//! Geometry of OBJ files.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use super::{codes, differing, folder_of, hashes, render};

/// Renders like `base.obj`, to the bit, with these warnings.
#[track_caller]
fn as_base(text: impl AsRef<[u8]>, technique: &str, warnings: &[&str]) {
    let place = std::panic::Location::caller().line();
    let folder = folder_of(
        &format!("model-{place}-{:x}", text.as_ref().len()),
        &["base.obj"],
    );
    std::fs::write(folder.path("other.obj"), text).unwrap();
    let draw = |file: &str| render(&folder, &format!("{file} --technique {technique}"));
    let (base, other) = (draw("base.obj"), draw("other.obj"));
    assert_eq!(hashes(&base), hashes(&other));
    assert_eq!(codes(&other), warnings);
}

fn read(name: &str) -> String {
    std::fs::read_to_string(super::fixture(name)).unwrap()
}

fn base() -> String {
    read("base.obj")
}

#[test]
fn comments_may_stand_behind_anything() {
    as_base(read("comment-f.obj"), "shadow-volumes", &[]);
    let behind: String = base().lines().map(|l| format!("{l}# side\n")).collect();
    as_base(behind, "shadow-volumes", &[]);
    let others = "o thing # one\ng a b # two\ns 1 # smooth\nvt 0 0 # u\nvn 0 0 1 # n\n#\n";
    as_base(format!("{others}{}", base()), "shadow-volumes", &[]);
}

#[test]
fn a_backslash_that_ends_a_comment_joins_nothing() {
    as_base(read("backslash-comment-f.obj"), "shadow-map", &[]);
    as_base(read("backslash-comment-v.obj"), "shadow-volumes", &[]);
    as_base(
        base().replace("f 5 8 7 6", "f 5 8 \\\n7\\\n6"),
        "shadow-volumes",
        &[],
    );
}

#[test]
fn byte_order_marks_and_line_ends_are_no_part_of_lines() {
    as_base(
        std::fs::read(super::fixture("bom-v.obj")).unwrap(),
        "shadow-volumes",
        &[],
    );
    as_base(
        std::fs::read(super::fixture("cr-only.obj")).unwrap(),
        "shadow-volumes",
        &[],
    );
    as_base(base().replace('\n', "\r\n"), "shadow-volumes", &[]);
    as_base(
        base().replace("f 5 8 7 6\n", "f 5 8 \\\r\n 7 6\r\n"),
        "shadow-volumes",
        &[],
    );
    as_base(base().replace(' ', "\t\u{a0} "), "shadow-volumes", &[]);
    as_base(base().replace('\n', " \u{c}\n"), "shadow-volumes", &[]);
}

#[test]
fn wide_characters_are_refused_by_name() {
    let folder = folder_of("wide", &[]);
    let wide: Vec<u8> = base().encode_utf16().flat_map(u16::to_le_bytes).collect();
    std::fs::write(folder.path("w.obj"), [&b"\xff\xfe"[..], &wide].concat()).unwrap();
    folder
        .gnomon("render w.obj")
        .refused(&["w.obj", "UTF-16", "UTF-8"]);
    std::fs::write(folder.path("z.obj"), b"v 0 0 0\nf 1 1 1\n\0\x01\x02").unwrap();
    folder
        .gnomon("render z.obj")
        .refused(&["z.obj", "byte 16 is 0"]);
    std::fs::write(folder.path("e.obj"), b"").unwrap();
    folder
        .gnomon("render e.obj")
        .refused(&["e.obj", "no faces"]);
}

#[test]
fn corners_that_repeat_and_faces_of_none_are_left_out() {
    as_base(
        read("doubled-corner.obj"),
        "shadow-volumes",
        &["repeated-corners"],
    );
    as_base(
        read("degenerate-face.obj"),
        "shadow-volumes",
        &["degenerate-faces"],
    );
    let spike = base().replace("f 5 8 7 6", "f 5 8 7 2 7 6");
    as_base(spike, "shadow-volumes", &["repeated-corners"]);
    // Other numbers, the same place.
    let twice = format!("{}v -1.1 0.2 -0.7\nf 1 9 2\nf 1 9 1\n", base());
    as_base(twice, "shadow-volumes", &["degenerate-faces"]);
}

#[test]
fn vertices_may_follow_their_faces() {
    as_base(read("f-first.obj"), "shadow-volumes", &[]);
    let folder = folder_of("none", &[]);
    for (text, part) in [
        ("f 1 2 3", "no vertices"),
        ("v 0 0 0\nf 1 2 3", "valid are 1..=1"),
    ] {
        std::fs::write(folder.path("n.obj"), text).unwrap();
        let run = folder.gnomon("render n.obj");
        let message = run.stderr();
        assert!(
            !message.contains("1..=0") && !message.contains("-0"),
            "{message}"
        );
        run.refused(&["n.obj:", part]);
    }
}

#[test]
fn points_of_equal_coordinates_are_one() {
    let folder = folder_of(
        "seam",
        &[
            "seam.obj",
            "seam-welded.obj",
            "seam.toml",
            "seam-welded.toml",
        ],
    );
    let [apart, welded] = ["seam.obj", "seam-welded.obj"].map(|f| render(&folder, f));
    assert_eq!(hashes(&apart), hashes(&welded));
    assert_eq!(codes(&apart), codes(&welded));
    let [apart, welded] = ["seam.toml", "seam-welded.toml"]
        .map(|f| render(&folder, &format!("{f} --technique soft-shadow-volumes")));
    assert_eq!(hashes(&apart), hashes(&welded));
}

#[test]
fn a_notch_stays_open() {
    let folder = folder_of("notch", &["concave-L.obj", "concave-L-ears.obj"]);
    let polygon = render(&folder, "concave-L.obj --out polygon.png");
    assert_eq!(codes(&polygon), [""; 0]);
    render(&folder, "concave-L-ears.obj --out ears.png");
    let differ = differing(&folder, "polygon.png", "ears.png");
    assert_eq!(differ, 0);
}

#[test]
fn rounded_corners_on_straight_sides_are_no_reason_to_warn() {
    let folder = folder_of("prism", &["prism6.obj"]);
    assert_eq!(codes(&render(&folder, "prism6.obj")), [""; 0]);
}

#[test]
fn polygons_that_cross_themselves_are_told() {
    let folder = folder_of("bow", &[]);
    let text = "v 0 0 0\nv 1 0 1\nv 1 0 0\nv 0 0 1\nf 1 2 3 4\n";
    std::fs::write(folder.path("b.obj"), text).unwrap();
    let codes_of = |technique| {
        let document = render(&folder, &format!("b.obj --technique {technique}"));
        codes(&document)
            .iter()
            .map(|c| (*c).to_owned())
            .collect::<Vec<_>>()
    };
    let found = codes_of("shadow-map");
    assert!(found.iter().any(|c| c == "crossing-polygons"), "{found:?}");
}

#[test]
fn a_model_far_from_its_origin_keeps_its_shape() {
    let folder = folder_of("utm", &["utm.obj", "utm-0.obj"]);
    render(&folder, "utm.obj --out far.png");
    render(&folder, "utm-0.obj --out near.png");
    let differ = differing(&folder, "far.png", "near.png");
    assert!(differ <= 4, "{differ} pixels");
}

/// A closed double cone.
fn cone(valence: u32) -> String {
    let mut text = String::from("v 0 1 0\nv 0 0 0\n");
    for k in 0..valence {
        // Any turn serves: points of the unit circle by half angles.
        let t = (f64::from(k) + 0.5) / f64::from(valence) * 2.0 - 1.0;
        let (x, y) = if t.abs() < 0.5 {
            (2.0 * t, 1.0)
        } else {
            (2.0 * t.signum() * (1.0 - t.abs()), -1.0)
        };
        let (x, y) = ((1.0 - x * x) * y / (1.0 + x * x), 2.0 * x / (1.0 + x * x));
        writeln!(text, "v {x:.9} 0.4 {y:.9}").unwrap();
    }
    let at = |k: u32| 3 + k % valence;
    for k in 0..valence {
        writeln!(text, "f 1 {1} {0}\nf 2 {0} {1}", at(k), at(k + 1)).unwrap();
    }
    text
}

/// Four times the triangles round a vertex take about four times as long, and not
/// sixteen; small ones are read in no time.
#[test]
fn loading_is_linear_in_valence() {
    let folder = folder_of("cone", &[]);
    let time = |valence: u32| {
        std::fs::write(folder.path("c.obj"), cone(valence)).unwrap();
        let start = || Instant::now();
        let each = (0..3).map(|_| {
            let start = start();
            folder
                .gnomon("render c.obj --technique unshadowed --size 16x12")
                .fine();
            start.elapsed()
        });
        each.min().unwrap_or_default()
    };
    let (small, large) = (time(8_000), time(32_000));
    let most = small.max(Duration::from_millis(200)) * 9;
    assert!(large < most, "{small:?} for 8,000, {large:?} for 32,000");
}
