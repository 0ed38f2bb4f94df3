//! The same tetrahedron in all encodings and disguises; damaged files.

use proptest::prelude::*;

use super::*;
use crate::world::adjacency::EdgeAdjacency;
use crate::world::mesh::Shading;

const HEAD: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\n\
    property float x\nproperty float y\nproperty float z\n\
    element face 4\nproperty list uchar int vertex_indices\nend_header\n";
const POINTS: &str = "0 0 0\n1.1 0 0\n0 1 0\n0 0 1\n";
const FACES: &str = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

fn text() -> String {
    format!("{HEAD}{POINTS}{FACES}")
}

fn read(bytes: impl AsRef<[u8]>) -> Result<PlyMesh, PlyError> {
    parse(bytes.as_ref(), "t.ply")
}

fn message(bytes: impl AsRef<[u8]>) -> String {
    read(bytes).unwrap_err().to_string()
}

fn codes(mesh: &PlyMesh) -> Vec<&'static str> {
    mesh.warnings.iter().map(|w| w.code).collect()
}

/// The tetrahedron, to the bit.
#[track_caller]
fn same(bytes: impl AsRef<[u8]>, warnings: &[&str]) {
    let mesh = read(bytes).unwrap();
    assert_eq!(mesh.shape, read(text()).unwrap().shape);
    assert_eq!(codes(&mesh), warnings);
}

/// The tetrahedron in binary.
fn binary(big: bool, line_end: &str) -> Vec<u8> {
    let name = if big {
        "binary_big_endian"
    } else {
        "binary_little_endian"
    };
    let head = HEAD.replace("ascii", name).replace('\n', line_end);
    let mut bytes = head.into_bytes();
    let mut put = |le: [u8; 4]| {
        let mut word = le;
        if big {
            word.reverse();
        }
        bytes.extend(word);
    };
    for word in POINTS.split_whitespace() {
        put(word.parse::<f32>().unwrap().to_le_bytes());
    }
    for line in FACES.lines() {
        bytes.push(3);
        for word in line.split(' ').skip(1) {
            let index = word.parse::<i32>().unwrap();
            bytes.extend(if big {
                index.to_be_bytes()
            } else {
                index.to_le_bytes()
            });
        }
    }
    bytes
}

#[test]
fn a_tetrahedron_is_closed_and_right_way_round() {
    let shape = read(text()).unwrap().shape;
    let mesh = shape.into_mesh(Shading::Flat).unwrap();
    assert!(
        EdgeAdjacency::new(mesh.triangles())
            .closedness(&mesh)
            .is_closed()
    );
    assert!((mesh.signed_volume() - 1.1 / 6.0).abs() < 1e-6);
}

#[test]
fn all_encodings_say_the_same_to_the_bit() {
    for big in [false, true] {
        for line_end in ["\n", "\r\n", "\r"] {
            same(binary(big, line_end), &[]);
        }
    }
    same(text().replace('\n', "\r\n"), &[]);
    same(text().replace('\n', "\r"), &[]);
    same(format!("\u{feff}{}", text()), &[]);
    same([text().as_bytes(), b"  \n\n"].concat(), &[]);
    // Values need no lines of their own, and need not be where others put them.
    same(
        format!("{HEAD}{}", format!("{POINTS}{FACES}").replace('\n', " ")),
        &[],
    );
    let mut latin = text().into_bytes();
    let at = text().find("by hand").unwrap();
    latin[at] = 0xe9;
    same(latin, &[]);
}

#[test]
fn other_properties_and_elements_are_stepped_over() {
    let head = HEAD
        .replace(
            "property float y",
            "property list uchar short ring\nproperty float y",
        )
        .replace("property float z", "property double z\nproperty uchar red")
        .replace(
            "element face",
            "element edge 1\nproperty int a\nproperty int b\nelement face",
        )
        .replace(
            "uchar int vertex_indices",
            "int double vertex_index\nproperty float32 quality",
        );
    let points = "0 2 7 8 0 0 255\n1.1 0 0 0 255\n0 1 5 1 0 0\n0 0 0 1 9\n";
    let faces = FACES.replace('\n', " .5\n");
    let file = format!("{head}{points}0 1\n{faces}");
    same(file, &["ignored-elements", "ignored-colours"]);
}

#[test]
fn faces_may_come_first_and_vertices_twice() {
    let [vertex, face] = [
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n",
        "element face 4\nproperty list uchar int vertex_indices\n",
    ];
    let head = format!("ply\nformat ascii 1.0\n{face}{vertex}end_header\n");
    same(format!("{head}{FACES}{POINTS}"), &[]);
    let twice = text()
        .replace("vertex 4", "vertex 5")
        .replace("0 0 1\n", "0 0 1\n0 0 1\n");
    same(twice.replace("3 1 2 3", "3 1 2 4"), &[]);
}

#[test]
fn strips_turn_every_other_triangle() {
    let head = HEAD.replace("element face 4", "element tristrips 1");
    // 0 1 2 | 1 3 2 as a strip, another one after -1, and a joint without area.
    let strips = format!("{head}{POINTS}9 0 2 1 3 -1 3 0 2 2\n");
    let mut triangles = read(strips).unwrap().shape.triangles;
    triangles.iter_mut().for_each(|t| {
        let least = (0..3).min_by_key(|k| t[*k]).unwrap();
        t.rotate_left(least);
    });
    assert_eq!(triangles, [[0, 1, 2], [1, 3, 2], [0, 1, 3]]);
}

#[test]
fn polygons_are_cut_and_what_covers_nothing_is_told() {
    let l = "0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0";
    let file = format!(
        "{}{l}\n6 0 1 2 3 4 5\n2 0 1\n3 0 0 1\n",
        HEAD.replace("vertex 4", "vertex 6")
            .replace("face 4", "face 3")
    );
    let mesh = read(file).unwrap();
    assert_eq!(mesh.shape.triangles.len(), 4);
    assert_eq!(codes(&mesh), ["degenerate-faces", "skipped-faces"]);
}

#[test]
fn errors_name_place_value_and_what_is_valid() {
    for (from, to, parts) in [
        ("ply\n", "plx\n", &["t.ply", "'plx'", "'ply'"][..]),
        (
            "ascii 1.0",
            "ascii 2.0",
            &["line 2", "ascii 2.0", "version 1.0"],
        ),
        (
            "ascii",
            "ebcdic",
            &["line 2", "ebcdic", "binary_big_endian"],
        ),
        ("format ascii 1.0\n", "", &["no line 'format'"]),
        (
            "property float x",
            "property quad x",
            &["line 5", "quad", "float64"],
        ),
        (
            "element vertex 4",
            "element vertex four",
            &["line 4", "element NAME COUNT"],
        ),
        (
            "element vertex 4\n",
            "",
            &["line 4", "before its properties"],
        ),
        (
            "property float y\n",
            "",
            &["'vertex' lacks one of x, y and z"],
        ),
        (
            "vertex_indices",
            "corners",
            &["'face' has no list", "vertex_indices"],
        ),
        ("end_header", "end", &["'end'", "end_header"]),
        (
            "vertex 4",
            "vertex 400000000000",
            &["400000000000 of 'vertex'", "bytes are left"],
        ),
        (
            "face 4",
            "face 5",
            &["the data end in face 4", "declares 5"],
        ),
        ("1.1", "nan", &["vertex 1 has x = NaN", "finite"]),
        ("1.1", "1e39", &["vertex 1 has x = inf", "finite"]),
        ("1.1", "one", &["'one' in line 2", "vertex 1, 'x'"]),
        (
            "3 0 2 1",
            "3 0 2 4",
            &["face 0 uses vertex 4", "there are 4"],
        ),
        (
            "3 0 2 1",
            "3 0 2 -1",
            &["face 0 uses vertex -1", "whole number from 0"],
        ),
        (
            "3 0 2 1",
            "3 0 2 1.5",
            &["face 0 uses vertex 1.5", "whole number"],
        ),
        ("3 0 2 1", "-3 0 2 1", &["face 0 has the length -3"]),
    ] {
        let message = message(text().replacen(from, to, 1));
        assert!(parts.iter().all(|p| message.contains(p)), "{to}: {message}");
    }
    assert!(message("").contains("begins with ''"));
    let cloud = format!("{}{POINTS}", HEAD.replace("face 4", "face 0"));
    assert!(message(cloud).contains("no faces, and 4 points"));
    let cut = &binary(false, "\n")[..];
    assert!(message(&cut[..cut.len() - 1]).contains("the data end in face 3"));
    let more = [cut, b"xyz"].concat();
    assert_eq!(codes(&read(more).unwrap()), ["trailing-data"]);
}

#[test]
fn counts_without_data_take_no_memory() {
    let none = text().replace(
        "element face 4",
        "element nothing 18446744073709551615\nelement face 4",
    );
    same(none, &["ignored-elements"]);
    // The sum of both is more than a count holds.
    let twice = text().replace(
        "element face 4",
        "element a 9223372036854775808\nelement b 9223372036854775808\nelement face 4",
    );
    let mesh = read(twice).unwrap();
    assert_eq!(codes(&mesh), ["ignored-elements"]);
    assert_eq!(mesh.warnings[0].count, usize::MAX);
    let list = format!(
        "{}{POINTS}20000000 0 1 2",
        HEAD.replace("uchar int", "uint int")
    );
    let list = list.replace("face 4", "face 1");
    assert!(message(&list).contains("the data end in face 0"));
    let longer = list.replace("20000000", "4294967295");
    assert!(message(longer).contains("25165824 corners of one list"));
}

#[test]
fn more_than_is_drawn_is_refused_before_it_is_kept() {
    let problem = |text: &str, most| {
        let read = parse_at_most(text.as_bytes(), "t.ply", most);
        read.err().map(|e| e.to_string())
    };
    let whole = text();
    assert_eq!(problem(&whole, 4), None);
    let vertices = problem(&whole, 3).unwrap();
    assert!(
        vertices.contains("vertex 3") && vertices.contains("the 3 vertices"),
        "{vertices}"
    );
    let faces = HEAD.replace("face 4", "face 3");
    // Two triangles each.
    let polygons = format!("{faces}{POINTS}4 0 1 2 3\n4 0 2 1 3\n4 0 1 3 2\n");
    assert_eq!(problem(&polygons, 6), None);
    let triangles = problem(&polygons, 5).unwrap();
    assert!(
        triangles.contains("face 2") && triangles.contains("the 5 triangles"),
        "{triangles}"
    );
    let strips = HEAD.replace("face 4", "tristrips 1");
    let strip = format!("{strips}{POINTS}7 0 1 2 3 0 1 2\n");
    assert_eq!(problem(&strip, 5), None);
    let triangles = problem(&strip, 4).unwrap();
    assert!(
        triangles.contains("tristrips 0") && triangles.contains("the 4 triangles"),
        "{triangles}"
    );
    let long = format!("{strips}{POINTS}13 0 1 2 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1\n");
    assert_eq!(problem(&long, 5), None);
    let corners = problem(&long, 4).unwrap();
    assert!(corners.contains("the 12 corners of one list"), "{corners}");
    // What is not used may be of any length.
    let other = whole.replace(
        "end_header",
        "element other 1\nproperty list uchar int a\nend_header",
    ) + "20 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
    assert_eq!(problem(&other, 4), None);
}

proptest! {
    /// Whatever is changed, the file is read or refused.
    #[test]
    fn damaged_files_are_no_panic(
        kind in 0..3_usize,
        changes in prop::collection::vec((0.0..1.0_f64, any::<u8>()), 1..6),
        keep in 0.5..1.1_f64,
    ) {
        let mut bytes = match kind {
            0 => text().into_bytes(),
            other => binary(other == 1, "\n"),
        };
        for (at, byte) in changes {
            let at = (at * bytes.len() as f64) as usize;
            bytes[at] = byte;
        }
        bytes.truncate((keep * bytes.len() as f64) as usize);
        if let Ok(mesh) = read(&bytes) {
            prop_assert!(mesh.shape.clone().into_mesh(Shading::Flat).is_ok());
        }
    }
}
