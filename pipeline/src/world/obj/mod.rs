//! Meshes from Wavefront OBJ files.
//!
//! `tobj` builds the mesh. Before it, a scan reads the text once on its own,
//! because tobj's errors name no line, it renumbers vertices object by object
//! (so a solid split over several `g` groups would fall apart), and its fan
//! triangulation does not say when a polygon was not convex. The scan rejects
//! what is invalid, with the line and the value, and hands tobj only the
//! positions and faces, as one object: two faces share a vertex exactly when
//! they name the same `v` line.
//!
//! Of materials, `Kd`, `Ks`, `Ns` and `illum` of the files that `mtllib` names are
//! used, as linear RGB; whatever is wrong with them is a warning. Texture
//! coordinates and the file's own normals are not used.

mod mtl;
mod polygon;
mod scan;

use std::path::Path;

use thiserror::Error;

use crate::world::error::MeshError;
use crate::world::material::MaterialPart;
use crate::world::mesh::{Mesh, Shading};
use crate::world::warning::SceneWarning;

/// A mesh read from OBJ text, and what was amiss without stopping it.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjMesh {
    /// All faces of the file as one mesh; vertices in order of first use.
    pub mesh: Mesh,
    /// Triangles that have a material, material after material.
    pub parts: Vec<MaterialPart>,
    /// Codes `concave-polygons`, `skipped-faces`, `unsupported-statements`,
    /// `missing-mtl`, `bad-mtl`, `limited-mtl`, `ignored-maps`, `unknown-material`.
    pub warnings: Vec<SceneWarning>,
}

/// Why OBJ text could not be used. Displays as `file:line: in object: problem`.
#[derive(Debug, Error)]
#[error("{file}{}: {}{problem}", place(*.line), inside(.object))]
pub struct ObjError {
    /// File as given by the caller.
    pub file: String,
    /// Line, from 1, when the problem has one.
    pub line: Option<usize>,
    /// Name of the `o` or `g` in force there.
    pub object: Option<String>,
    /// What is wrong.
    pub problem: ObjProblem,
}

fn place(line: Option<usize>) -> String {
    line.map_or(String::new(), |l| format!(":{l}"))
}

fn inside(object: &Option<String>) -> String {
    object
        .as_ref()
        .map_or(String::new(), |o| format!("in '{o}': "))
}

/// What is wrong with OBJ text, with the value met and what would be valid.
#[derive(Debug, Error)]
pub enum ObjProblem {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// No face with at least three vertices.
    #[error("no faces; expected at least one line such as 'f 1 2 3'")]
    NoFaces,
    /// A vertex line without three numbers.
    #[error("vertex line '{line}'; expected 'v x y z' with three numbers")]
    BadVertex {
        /// The line met.
        line: String,
    },
    /// A vertex coordinate that f32 cannot hold as a finite number.
    #[error(
        "vertex {vertex} has the coordinate '{value}'; every coordinate must be finite and below 3.4e38"
    )]
    NonFinite {
        /// Number of the vertex, from 1.
        vertex: usize,
        /// The coordinate as written.
        value: String,
    },
    /// A face corner that is not an index.
    #[error(
        "face corner '{value}'; expected v, v/vt, v//vn or v/vt/vn with v a whole number other than 0"
    )]
    BadCorner {
        /// The corner as written.
        value: String,
    },
    /// A face index without vertex.
    #[error(
        "face uses vertex {index}, but {vertices} vertices are defined up to here; valid are 1..={vertices} and -{vertices}..=-1"
    )]
    OutOfRange {
        /// The index as written.
        index: i64,
        /// Vertices defined before this line.
        vertices: usize,
    },
    /// `tobj` refused what the scan accepted.
    #[error("tobj: {0}")]
    Tobj(#[from] tobj::LoadError),
    /// The triangles do not make a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Reads an OBJ file and its material libraries.
///
/// # Errors
/// See [`ObjProblem`]. A missing or invalid `.mtl` is a warning.
pub fn load(path: &Path, shading: Shading) -> Result<ObjMesh, ObjError> {
    let file = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| whole_file(&file, e.into()))?;
    let library = |name: &str| {
        let path = path.with_file_name(name);
        Some((path.display().to_string(), std::fs::read(&path).ok()?))
    };
    parse_with(&bytes, &file, shading, Some(&library))
}

/// Reads OBJ text without its materials; `file` names it in messages. Any bytes are accepted or
/// refused with an error, never a panic.
///
/// # Errors
/// See [`ObjProblem`].
pub fn parse(bytes: &[u8], file: &str, shading: Shading) -> Result<ObjMesh, ObjError> {
    parse_with(bytes, file, shading, None)
}

fn parse_with(
    bytes: &[u8],
    file: &str,
    shading: Shading,
    library: Option<&scan::Library<'_>>,
) -> Result<ObjMesh, ObjError> {
    let scan = scan::Scan::of(bytes).map_err(|e| ObjError {
        file: file.to_owned(),
        line: Some(e.line),
        object: e.object,
        problem: e.problem,
    })?;
    let built = build(&scan, shading).map_err(|problem| whole_file(file, problem))?;
    let mut paint = library.map_or_else(Default::default, |l| scan.paint(l));
    let parts = scan.parts(&mut paint);
    Ok(ObjMesh {
        mesh: built,
        parts,
        warnings: scan.warnings(&paint),
    })
}

fn whole_file(file: &str, problem: ObjProblem) -> ObjError {
    ObjError {
        file: file.to_owned(),
        line: None,
        object: None,
        problem,
    }
}

fn build(scan: &scan::Scan, shading: Shading) -> Result<Mesh, ObjProblem> {
    if scan.faces == 0 {
        return Err(ObjProblem::NoFaces);
    }
    let options = tobj::LoadOptions {
        triangulate: true,
        single_index: false,
        ..tobj::LoadOptions::default()
    };
    let no_materials = |_: &Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut scan.geometry.as_bytes(), &options, no_materials)?;
    let mesh = models.into_iter().next().ok_or(ObjProblem::NoFaces)?.mesh;
    let positions = mesh.positions.as_chunks::<3>().0.to_vec();
    let triangles = mesh.indices.as_chunks::<3>().0.to_vec();
    Ok(Mesh::new(positions, triangles, shading)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;
    use proptest::prelude::*;

    const CUBE: &str = "\
# a cube in two groups that share vertices
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
vn 0 0 1
g front\nf 5//1 6//1 7//1 8//1\nf -5 -6 -7 -8\n
g rest\nusemtl paint\nf 1/1 2/1 6/1 5/1\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

    const CUBE_WITH_LIBRARY: &str = "mtllib l\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";

    fn read(text: &str) -> Result<ObjMesh, ObjError> {
        parse(text.as_bytes(), "t.obj", Shading::Smooth)
    }

    fn message(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    #[test]
    fn groups_do_not_tear_a_solid_apart() {
        let cube = read(CUBE).unwrap();
        assert_eq!(cube.mesh.positions().len(), 8);
        let report = EdgeAdjacency::new(cube.mesh.triangles()).closedness(&cube.mesh);
        assert!(report.is_closed(), "{report}");
        assert_eq!(cube.mesh.signed_volume(), 8.0);
        assert_eq!(cube.warnings, []);
    }

    #[test]
    fn errors_name_file_line_object_and_value() {
        assert_eq!(
            message("o thing\nv 0 0 0\nv 1 0 0\n\nf 1 2 3\n"),
            "t.obj:5: in 'thing': face uses vertex 3, but 2 vertices are defined up to here; \
             valid are 1..=2 and -2..=-1"
        );
        assert!(message("v 0 nan 0\n").starts_with("t.obj:1: vertex 1 has the coordinate 'nan'"));
        assert!(message("v 0 1e39 0\n").contains("'1e39'"));
        assert!(message("v 0 1\n").contains("'v 0 1'"));
        assert!(message("v 0 0 0\nf 1 x 1\n").contains("'x'"));
        assert!(message("v 0 0 0\nf 0 1 1\n").contains("'0'"));
        assert!(message("v 0 0 0\n").contains("no faces"));
        let missing = load(Path::new("no-such-file.obj"), Shading::Flat).unwrap_err();
        assert!(
            missing
                .to_string()
                .starts_with("no-such-file.obj: cannot be read")
        );
    }

    #[test]
    fn concave_polygons_and_skipped_statements_are_counted() {
        let dart = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\nf 1 2 3 4\nf 2 3 4 1\nf 1 2\ncurv 0 1\n";
        let read = read(dart).unwrap();
        let codes: Vec<_> = read.warnings.iter().map(|w| (w.code, w.count)).collect();
        // The fan from the reflex corner's opposite works; from its neighbour not.
        assert_eq!(
            codes,
            [
                ("concave-polygons", 1),
                ("skipped-faces", 1),
                ("unsupported-statements", 1)
            ]
        );
    }

    fn painted(text: &str, library: &str) -> ObjMesh {
        let read = |name: &str| (name == "paint.mtl").then(|| (name.to_owned(), library.into()));
        parse_with(text.as_bytes(), "t.obj", Shading::Flat, Some(&read)).unwrap()
    }

    #[test]
    fn faces_get_the_materials_they_use() {
        let text = "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\
                    f 1 2 3\nusemtl red paint\nf 1 2 3 4\nusemtl b\nf 1 3 4\nf 1 2\nusemtl red paint\nf 4 3 2\n";
        let read = painted(text, "newmtl b\nKd 0 0 1\nnewmtl red paint\nKd 1 0 0\n");
        let parts: Vec<_> = read
            .parts
            .iter()
            .map(|p| (p.material.albedo, &p.triangles[..]))
            .collect();
        assert_eq!(
            parts,
            [
                ([1.0, 0.0, 0.0], &[1, 2, 4][..]),
                ([0.0, 0.0, 1.0], &[3][..])
            ]
        );
        assert_eq!(read.warnings.len(), 1, "the face of two corners");
    }

    #[test]
    fn materials_that_cannot_be_had_are_warnings() {
        let codes = |text: &str, library: &str| -> Vec<_> {
            let read = painted(text, library);
            read.warnings
                .into_iter()
                .map(|w| (w.code, w.message))
                .collect()
        };
        let model = |l: &str| format!("mtllib {l}\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n");
        let missing = codes(&model("none.mtl"), "");
        assert!(missing.len() == 1 && missing[0].0 == "missing-mtl");
        assert!(missing[0].1.contains("'none.mtl'"), "{missing:?}");
        let unknown = codes(&model("paint.mtl"), "newmtl b\n");
        assert!(unknown.len() == 1 && unknown[0].0 == "unknown-material");
        let bad = codes(&model("paint.mtl"), "newmtl a\nKd red\n");
        assert!(bad.len() == 1 && bad[0].0 == "bad-mtl");
        assert!(bad[0].1.contains("paint.mtl:2: 'Kd red'"), "{bad:?}");
    }

    #[test]
    fn comments_need_not_be_utf8_and_lines_may_continue() {
        let text = b"# caf\xe9\nv 0 0 0\nv 1 0 0\nv 0 \\\n 1 0\nf 1 2 3\n";
        assert_eq!(
            parse(text, "t", Shading::Flat).unwrap().mesh.triangles(),
            [[0, 1, 2]]
        );
    }

    /// Lines that look like OBJ, mostly.
    fn line() -> impl Strategy<Value = String> {
        let number = prop_oneof![
            any::<f32>().prop_map(|x| x.to_string()),
            (-9i64..9).prop_map(|x| x.to_string()),
            any::<i64>().prop_map(|x| x.to_string()),
            Just("1/2/3".to_owned()),
            Just("-1//".to_owned()),
            Just("\\".to_owned()),
            "[ -~]{0,3}",
        ];
        let keyword = prop::sample::select(vec![
            "v", "f", "f", "vn", "vt", "o", "g", "l", "p", "mtllib", "usemtl", "s", "#",
        ]);
        (keyword, prop::collection::vec(number, 0..6))
            .prop_map(|(k, n)| format!("{k} {}", n.join(" ")))
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let library = |_: &str| Some(("l".to_owned(), bytes.clone()));
            let _ = parse_with(CUBE_WITH_LIBRARY.as_bytes(), "fuzz", Shading::Smooth, Some(&library));
            let _ = parse(&bytes, "fuzz", Shading::Smooth);
        }

        #[test]
        fn no_near_obj_text_makes_it_panic(lines in prop::collection::vec(line(), 0..20)) {
            let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", lines.join("\n"));
            if let Ok(read) = parse(text.as_bytes(), "fuzz", Shading::Smooth) {
                prop_assert!(!read.mesh.triangles().is_empty());
            }
        }

        #[test]
        fn corrupting_a_byte_never_panics(at in 0..CUBE.len(), to in any::<u8>()) {
            let mut bytes = CUBE.as_bytes().to_vec();
            bytes[at] = to;
            let _ = parse(&bytes, "fuzz", Shading::Smooth);
        }
    }
}
