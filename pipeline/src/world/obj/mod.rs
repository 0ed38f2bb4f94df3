//! Meshes from Wavefront OBJ files.
//!
//! `tobj` builds the mesh, from text that is rewritten for it: its errors name no
//! line, it renumbers vertices object by object (so a solid split over several `g`
//! groups would fall apart), it knows neither CR alone as the end of a line nor
//! comments behind statements, and its triangulation is a fan whatever the polygon.
//! So a scan reads the text once on its own (`lines`, `scan`), its faces are cut into
//! triangles (`world/faces`), and tobj gets positions and triangles of one
//! object (`mesh`).
//!
//! Coordinates stay in f64 until the model has its place in a scene: in f32 a model
//! far from its origin, as geodetic coordinates are, would lose its shape.
//!
//! Of materials, `Kd`, `Ks`, `Ns` and `illum` of the files that `mtllib` names are
//! used, as linear RGB, and the pictures of `map_Kd` (`map`); whatever is wrong with them
//! is a warning. The file's own normals are not used.

mod library;
mod lines;
mod map;
mod mesh;
mod mtl;
mod paint;
mod scan;

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::world::files::{self, FileError, Outside, SceneFolder};
use crate::world::material::MaterialPart;
use crate::world::shape::Shape;
use crate::world::tally::{Tally, beginning};
use crate::world::texture::{CornerCoordinates, Gallery, MAX_PICTURE_BYTES};
use crate::world::warning::SceneWarning;
pub use lines::NotText;
use mesh::Faces;
use paint::{Libraries, Paint};
use scan::Scan;

/// Bytes of a model that are read at most: some four million triangles.
pub const MAX_OBJ_BYTES: u64 = 256 << 20;

/// Bytes of a material library that are read at most.
pub const MAX_MTL_BYTES: u64 = 16 << 20;

/// A mesh read from OBJ text, and what was amiss without stopping it.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjMesh {
    /// All faces of the file as one solid, in the file's own coordinates; points in
    /// order of first use, no two of them equal.
    pub shape: Shape,
    /// Triangles that have a material, material after material.
    pub parts: Vec<MaterialPart>,
    /// Of each triangle the texture coordinates of its corners, v counted from above; empty
    /// where the file has none.
    pub coordinates: Vec<CornerCoordinates>,
    /// Codes `crossing-polygons`, `repeated-corners`, `degenerate-faces`,
    /// `skipped-faces`, `unsupported-statements`, `missing-mtl`, `bad-mtl`,
    /// `limited-mtl`, `ignored-maps`, `missing-maps`, `bad-coordinates`, `unknown-material`.
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
    #[source]
    pub problem: ObjProblem,
}

impl ObjError {
    fn whole_file(file: &str, problem: ObjProblem) -> Self {
        Self {
            file: file.to_owned(),
            line: None,
            object: None,
            problem,
        }
    }
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
#[non_exhaustive]
pub enum ObjProblem {
    /// The file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The bytes are no text.
    #[error(transparent)]
    NotText(#[from] NotText),
    /// No face that covers anything.
    #[error("no faces; expected at least one line such as 'f 1 2 3'")]
    NoFaces,
    /// A vertex line without three numbers.
    #[error("vertex line '{}'; expected 'v x y z' with three numbers", excerpt(.line))]
    BadVertex {
        /// The line met.
        line: String,
    },
    /// A vertex coordinate that f32 cannot hold as a finite number.
    #[error(
        "vertex {vertex} has the coordinate '{}'; every coordinate must be finite and below 3.4e38",
        excerpt(.value)
    )]
    NonFinite {
        /// Number of the vertex, from 1.
        vertex: usize,
        /// The coordinate as written.
        value: String,
    },
    /// A face corner that is not an index.
    #[error(
        "face corner '{}'; expected v, v/vt, v//vn or v/vt/vn with v a whole number other than 0",
        excerpt(.value)
    )]
    BadCorner {
        /// The corner as written.
        value: String,
    },
    /// A face index above all vertices of the file.
    #[error("face uses vertex {index}, but the file defines {}", up_to(*.vertices))]
    OutOfRange {
        /// The index as written, or what it means counted from the first vertex.
        index: i64,
        /// Vertices of the file.
        vertices: usize,
    },
    /// A face index that counts back beyond the first vertex.
    #[error("face uses vertex {index}, but up to here there are {}", back_to(*.vertices))]
    BeforeFirst {
        /// The index as written.
        index: i64,
        /// Vertices defined before this line.
        vertices: usize,
    },
    /// `tobj` refused what the scan accepted.
    #[error("tobj: {0}")]
    Tobj(#[from] tobj::LoadError),
}

/// How many vertices there are, and which indices name them.
fn up_to(vertices: usize) -> String {
    match vertices {
        0 => "no vertices; expected lines such as 'v 0 0 0'".to_owned(),
        n => format!("{n} vertices; valid are 1..={n}"),
    }
}

/// The same, counted back.
fn back_to(vertices: usize) -> String {
    match vertices {
        0 => "no vertices to count back to".to_owned(),
        n => format!("{n} vertices; valid are -{n}..=-1"),
    }
}

/// The beginning of what a file says: lines may be as long as the file.
fn excerpt(text: &str) -> String {
    beginning(text, 80)
}

/// Reads an OBJ file and its material libraries, which must lie in its folder.
///
/// # Errors
/// See [`ObjProblem`]. A missing or invalid `.mtl` is a warning.
pub fn load(path: &Path) -> Result<ObjMesh, ObjError> {
    load_given(path, Outside::Refused)
}

/// Reads an OBJ file that the user names, wherever it is.
///
/// # Errors
/// As [`load`].
pub fn load_given(path: &Path, outside: Outside) -> Result<ObjMesh, ObjError> {
    let folder = SceneFolder::of(path, outside);
    let bytes = files::read(path, MAX_OBJ_BYTES);
    of_bytes(bytes, path, &folder, &mut Gallery::default())
}

/// Reads an OBJ file that a scene in `folder` names; `gallery` has the scene's pictures.
///
/// # Errors
/// As [`load`].
pub fn load_from(
    path: &Path,
    folder: &SceneFolder,
    gallery: &mut Gallery,
) -> Result<ObjMesh, ObjError> {
    of_bytes(folder.read(path, MAX_OBJ_BYTES), path, folder, gallery)
}

fn of_bytes(
    bytes: Result<Vec<u8>, FileError>,
    path: &Path,
    folder: &SceneFolder,
    gallery: &mut Gallery,
) -> Result<ObjMesh, ObjError> {
    let file = path.display().to_string();
    let bytes = bytes.map_err(|e| ObjError::whole_file(&file, e.into()))?;
    parse_with(&bytes, &file, Some((&Beside { path, folder }, gallery)))
}

/// Libraries in the folder of a model.
struct Beside<'a> {
    path: &'a Path,
    folder: &'a SceneFolder,
}

impl Beside<'_> {
    fn path_of(&self, name: &str) -> PathBuf {
        self.path_beside(self.path, name)
    }

    /// Names may be written with the separators of another system.
    fn path_beside(&self, file: &Path, name: &str) -> PathBuf {
        let folder = file.parent().unwrap_or(Path::new(""));
        let written = folder.join(name);
        let turned = folder.join(name.replace('\\', "/"));
        if !self.is_file(&written) && self.is_file(&turned) {
            turned
        } else {
            written
        }
    }

    fn is_file(&self, path: &Path) -> bool {
        self.folder.check(path).is_ok() && path.is_file()
    }
}

impl Libraries for Beside<'_> {
    fn has(&self, name: &str) -> bool {
        self.is_file(&self.path_of(name))
    }

    fn read(&self, name: &str) -> Result<(String, Vec<u8>), FileError> {
        let path = self.path_of(name);
        let bytes = self.folder.read(&path, MAX_MTL_BYTES)?;
        Ok((path.display().to_string(), bytes))
    }

    fn has_picture(&self, library: &str, name: &str) -> bool {
        self.is_file(&self.path_beside(&self.path_of(library), name))
    }

    fn picture(&self, library: &str, name: &str) -> Result<Vec<u8>, FileError> {
        let path = self.path_beside(&self.path_of(library), name);
        self.folder.read(&path, MAX_PICTURE_BYTES)
    }
}

/// Reads OBJ text without its materials; `file` names it in messages. Any bytes are accepted or
/// refused with an error, never a panic.
///
/// # Errors
/// See [`ObjProblem`].
pub fn parse(bytes: &[u8], file: &str) -> Result<ObjMesh, ObjError> {
    parse_with(bytes, file, None)
}

fn parse_with(
    bytes: &[u8],
    file: &str,
    libraries: Option<(&dyn Libraries, &mut Gallery)>,
) -> Result<ObjMesh, ObjError> {
    let scan = Scan::of(bytes, file)?;
    let faces = Faces::of(&scan);
    let shape = faces.shape(&scan.points);
    let shape = shape.map_err(|problem| ObjError::whole_file(file, problem))?;
    let paint = libraries.map_or_else(Paint::default, |(libraries, gallery)| {
        Paint::of(&scan, &faces, libraries, gallery)
    });
    let warnings = faces.triangles.warnings();
    let warnings = warnings.chain(warnings_of(&scan, &paint)).collect();
    Ok(ObjMesh {
        shape,
        coordinates: paint.coordinates(&faces),
        parts: paint.parts,
        warnings,
    })
}

fn warnings_of(scan: &Scan, paint: &Paint) -> impl Iterator<Item = SceneWarning> {
    let materials = &paint.materials;
    // Nobody looks at coordinates without a texture.
    let none = Tally::default();
    let textured = paint.parts.iter().any(|p| p.texture.is_some());
    let bad_texels = if textured { &scan.bad_texels } else { &none };
    let all: [(_, &Tally, _); 9] = [
        (
            "skipped-faces",
            &scan.skipped,
            "faces with fewer than three corners were skipped",
        ),
        (
            "unsupported-statements",
            &scan.unsupported,
            "statements were ignored; only polygons are read",
        ),
        (
            "missing-mtl",
            &paint.missing,
            "material libraries are missing or cannot be read; their faces are drawn in one material",
        ),
        (
            "bad-mtl",
            &materials.bad,
            "statements of material libraries are not valid and were left out",
        ),
        (
            "limited-mtl",
            &materials.limited,
            "reflectances were limited to 0..=1",
        ),
        (
            "ignored-maps",
            &materials.maps,
            "maps of other things than Kd were ignored",
        ),
        (
            "missing-maps",
            &paint.missing_maps,
            "pictures of map_Kd cannot be used; Kd alone is",
        ),
        (
            "bad-coordinates",
            bad_texels,
            "texture coordinates are no numbers or are missing, and are 0",
        ),
        (
            "unknown-material",
            &paint.unknown,
            "materials are used that no library defines",
        ),
    ];
    let all = all.map(|(code, tally, what)| tally.warning(code, what));
    all.into_iter().flatten()
}

#[cfg(test)]
mod map_tests;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::mesh::Shading;
    use proptest::prelude::*;

    const CUBE: &str = "\
# a cube in two groups that share vertices
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
vn 0 0 1
g front\nf 5//1 6//1 7//1 8//1\nf -5 -6 -7 -8\n
g rest\nusemtl paint\nf 1/1 2/1 6/1 5/1\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

    const CUBE_WITH_LIBRARY: &str =
        "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";

    fn read(text: &str) -> Result<ObjMesh, ObjError> {
        parse(text.as_bytes(), "t.obj")
    }

    fn message(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    fn volume_if_closed(read: &ObjMesh) -> f64 {
        let mesh = read.shape.clone().into_mesh(Shading::Smooth).unwrap();
        let report = EdgeAdjacency::new(mesh.triangles()).closedness(&mesh);
        assert!(report.is_closed(), "{report}");
        mesh.signed_volume()
    }

    #[test]
    fn groups_do_not_tear_a_solid_apart() {
        let cube = read(CUBE).unwrap();
        assert_eq!(cube.shape.positions.len(), 8);
        assert_eq!(volume_if_closed(&cube), 8.0);
        assert_eq!(cube.warnings, []);
    }

    #[test]
    fn errors_name_file_line_object_and_value() {
        assert_eq!(
            message("o thing\nv 0 0 0\nv 1 0 0\n\nf 1 2 3\n"),
            "t.obj:5: in 'thing': face uses vertex 3, but the file defines 2 vertices; \
             valid are 1..=2"
        );
        assert_eq!(
            message("v 0 0 0\nf -1 -1 -2\nv 0 0 0"),
            "t.obj:2: face uses vertex -2, but up to here there are 1 vertices; valid are -1..=-1"
        );
        for none in ["f 1 2 3", "f -1 -2 -3"] {
            let message = message(none);
            assert!(
                message.contains("no vertices") && !message.contains("..="),
                "{message}"
            );
        }
        let long = format!("v 0 0 {}", "x".repeat(1_000_000));
        assert!(message(&long).len() < 300);
        assert!(message("v 1,5 0 0\n").contains("'v 1,5 0 0'"));
        assert!(message("v 0 nan 0\n").starts_with("t.obj:1: vertex 1 has the coordinate 'nan'"));
        assert!(message("v 0 1e39 0\n").contains("'1e39'"));
        assert!(message("v 0 1\n").contains("'v 0 1'"));
        assert!(message("v 0 0 0\nf 1 x 1\n").contains("'x'"));
        assert!(message("v 0 0 0\nf 0 1 1\n").contains("'0'"));
        assert!(message("v 0 0 0\n").contains("no faces"));
        let missing = load(Path::new("no-such-file.obj")).unwrap_err();
        assert!(
            missing
                .to_string()
                .starts_with("no-such-file.obj: cannot be read")
        );
    }

    #[test]
    fn what_is_left_out_is_counted_with_its_first_line() {
        let text = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\nf 1 2 3 4\nf 2 3 4 1\nf 1 2\n\
                    curv 0 1\nf 1 2 2 3 3\nf 1 2 1\nf 1 2 3 2\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 6 5 7\n";
        let read = read(text).unwrap();
        let found: Vec<_> = read
            .warnings
            .iter()
            .map(|w| (w.code, w.count, &w.message))
            .collect();
        let expected = [
            ("crossing-polygons", 1, "line 15"),
            ("repeated-corners", 2, "line 9"),
            ("degenerate-faces", 2, "line 10"),
            ("skipped-faces", 1, "line 7"),
            ("unsupported-statements", 1, "'curv' in line 8"),
        ];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for ((code, count, message), (c, n, first)) in found.into_iter().zip(expected) {
            assert_eq!((code, count), (c, n));
            assert!(message.ends_with(&format!("(first: {first})")), "{message}");
        }
    }

    #[test]
    fn vertices_may_follow_faces_and_come_many_times() {
        let forward = read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unwrap();
        assert_eq!(forward.shape.triangles, [[0, 1, 2]]);
        // A tetrahedron of faces with vertices of their own.
        let [a, b, c, d] = ["v 0 0 0\n", "v 1 0 0\n", "v 0 1 -0\n", "v 0 0 1\n"];
        let faces = [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        let text: String = faces
            .iter()
            .map(|f| format!("{}f -3 -2 -1\n", f.concat()))
            .collect();
        let apart = read(&text).unwrap();
        assert_eq!(apart.shape.positions.len(), 4);
        assert!((volume_if_closed(&apart) - 1.0 / 6.0).abs() < 1e-12);
        assert_eq!(apart.warnings, []);
    }

    #[test]
    fn coordinates_keep_their_digits() {
        let read = read("v 5400000.001 0.1 0\nv 1 0 0\nv 0 1e-320 0\nf 1 2 3\n").unwrap();
        assert_eq!(
            read.shape.positions[0].to_array(),
            [5_400_000.001, 0.1, 0.0]
        );
        assert_eq!(read.shape.positions[2].y, 1e-320);
    }

    fn painted(text: &str, library: &str) -> ObjMesh {
        let libraries = One(library.as_bytes());
        let beside = (&libraries as &dyn Libraries, &mut Gallery::default());
        parse_with(text.as_bytes(), "t.obj", Some(beside)).unwrap()
    }

    /// A folder with `paint.mtl` in it.
    struct One<'a>(&'a [u8]);

    impl Libraries for One<'_> {
        fn has(&self, name: &str) -> bool {
            name == "paint.mtl"
        }

        fn read(&self, name: &str) -> Result<(String, Vec<u8>), FileError> {
            let missing = || FileError::from(std::io::Error::from(std::io::ErrorKind::NotFound));
            let bytes = self.has(name).then(|| self.0.to_vec());
            Ok((name.to_owned(), bytes.ok_or_else(missing)?))
        }

        fn has_picture(&self, _: &str, _: &str) -> bool {
            false
        }

        fn picture(&self, _: &str, _: &str) -> Result<Vec<u8>, FileError> {
            Err(std::io::Error::from(std::io::ErrorKind::NotFound).into())
        }
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
        let none = codes(&model("").replace("mtllib \n", ""), "");
        assert!(
            none.len() == 1 && none[0].0 == "unknown-material",
            "{none:?}"
        );
        let unknown = codes(&model("paint.mtl # old"), "newmtl b\n");
        assert!(unknown.len() == 1 && unknown[0].0 == "unknown-material");
        let bad = codes(&model("paint.mtl"), "newmtl a\nKd red\n");
        assert!(bad.len() == 1 && bad[0].0 == "bad-mtl");
        assert!(bad[0].1.contains("paint.mtl:2: 'Kd red'"), "{bad:?}");
    }

    #[test]
    fn comments_need_not_be_utf8_and_lines_may_continue() {
        let text = b"# caf\xe9\nv 0 0 0\nv 1 0 0\nv 0 \\\n 1 0\nf 1 2 3\n";
        assert_eq!(parse(text, "t").unwrap().shape.triangles, [[0, 1, 2]]);
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
            let beside = (&One(&bytes) as &dyn Libraries, &mut Gallery::default());
            let _ = parse_with(CUBE_WITH_LIBRARY.as_bytes(), "fuzz", Some(beside));
            let _ = parse(&bytes, "fuzz");
        }

        #[test]
        fn no_near_obj_text_makes_it_panic(lines in prop::collection::vec(line(), 0..20)) {
            let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", lines.join("\n"));
            if let Ok(read) = parse(text.as_bytes(), "fuzz") {
                prop_assert!(!read.shape.triangles.is_empty());
            }
        }

        #[test]
        fn corrupting_a_byte_never_panics(at in 0..CUBE.len(), to in any::<u8>()) {
            let mut bytes = CUBE.as_bytes().to_vec();
            bytes[at] = to;
            let _ = parse(&bytes, "fuzz");
        }
    }
}
