//! Scene files in TOML.
//!
//! ```toml
//! name = "example"
//! size = [640, 480]               # optional; so are the next two
//! ambient = [0.15, 0.15, 0.15]
//! background = [0.05, 0.06, 0.08]
//!
//! [camera]
//! eye = [0.0, 2.0, 5.0]
//! target = [0.0, 0.5, 0.0]
//! up = [0.0, 1.0, 0.0]            # optional; so are the next two
//! fov = 45.0                      # vertical, degrees
//! near = 0.1
//!
//! [[lights]]                      # point, square, rectangle, polygon, disc, sphere,
//!                                 # directional
//! shape.square = { centre = [1.5, 4.0, 1.0], side = 1.0 }
//! colour = [1.0, 1.0, 1.0]        # optional
//!
//! [[objects]]
//! mesh.plane = { half = 5.0 }     # sheets cast nothing unless told to
//!
//! [[objects]]
//! name = "bunny"
//! mesh.obj = "bunny.obj"          # relative to this file
//! scale = 10.0                    # a number or three; applied first,
//! rotate = [0.0, 30.0, 0.0]       # then degrees about x, then y, then z,
//! translate = [0.0, -0.3, 0.0]    # then this
//! crease = 40.0                   # edges that turn by more are shaded sharp
//! material = { albedo = [0.7, 0.4, 0.2], specular = [0.3, 0.3, 0.3], shininess = 30.0 }
//! casts = true
//! receives = true
//! ```
//!
//! Unknown keys are errors; every error names file, line and column and says
//! what would be valid.

mod build;
mod check;
mod schema;
mod shapes;

use std::path::Path;

use thiserror::Error;

use super::Scene;

/// Why a scene file could not be used.
#[derive(Debug, Error)]
pub enum SceneFileError {
    /// The file could not be read.
    #[error("{file}: cannot be read: {source}")]
    Unreadable {
        /// File as given.
        file: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The text is not a valid scene.
    #[error("{file}:{line}:{column}: {message}")]
    Invalid {
        /// File as given.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What is wrong, and what would be valid.
        message: String,
    },
}

/// Reads a scene file; mesh paths are relative to it.
///
/// # Errors
/// The file or a mesh cannot be read, is not TOML, or holds a value that makes
/// no scene.
pub fn load(path: &Path) -> Result<Scene, SceneFileError> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|source| SceneFileError::Unreadable {
        file: file.clone(),
        source,
    })?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut scene = parse(&text, &file, path.parent().unwrap_or(Path::new(".")))?;
    if scene.name.is_empty() {
        scene.name = stem.into_owned();
    }
    Ok(scene)
}

/// Reads scene text; `file` names it in messages, `folder` holds its meshes.
///
/// # Errors
/// As [`load`].
pub fn parse(text: &str, file: &str, folder: &Path) -> Result<Scene, SceneFileError> {
    let source = check::Source { text, file };
    let table: schema::SceneTable = toml::from_str(text).map_err(|e| {
        let span = e.span().unwrap_or(0..0);
        source.error(span, e.message().to_owned())
    })?;
    build::scene(&source, folder, table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::LightShape;
    use glam::DVec3;

    const HEAD: &str = "\
[camera]
eye = [0, 2, 5]
target = [0, 0.5, 0]
[[lights]]
shape.point = { position = [1, 4, 1] }
";

    fn read(text: &str) -> Result<Scene, SceneFileError> {
        parse(text, "s.toml", Path::new("."))
    }

    fn message(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    fn with_object(lines: &str) -> String {
        format!("{HEAD}[[objects]]\n{lines}\n")
    }

    #[test]
    fn the_documented_example_is_valid() {
        let doc = include_str!("mod.rs");
        let lines = doc.lines().filter_map(|l| l.strip_prefix("//!"));
        let body: Vec<&str> = lines
            .skip_while(|l| !l.contains("```toml"))
            .skip(1)
            .collect();
        let end = body.iter().position(|l| l.contains("```")).unwrap();
        let text = body[..end].join("\n").replace(
            "mesh.obj = \"bunny.obj\"",
            "mesh.box = { size = [1, 1, 1] }",
        );
        let scene = read(&text).unwrap();
        assert_eq!(
            (scene.name.as_str(), scene.size),
            ("example", Some([640, 480]))
        );
        let casts: Vec<bool> = scene.objects.iter().map(|o| o.casts).collect();
        assert_eq!(casts, [false, true]);
        assert!(matches!(
            scene.lights[0].shape,
            LightShape::Rectangle { .. }
        ));
    }

    #[test]
    fn polygon_lights_are_read_and_judged() {
        let with = |vertices: &str| {
            let light = format!("shape.polygon = {{ vertices = {vertices} }}");
            let head = HEAD.replace("shape.point = { position = [1, 4, 1] }", &light);
            format!("{head}[[objects]]\nmesh.box = {{ size = [1, 1, 1] }}\n")
        };
        let scene = read(&with("[[0, 3, 0], [1, 3, 0], [0, 3, 1]]")).unwrap();
        let LightShape::Polygon(polygon) = &scene.lights[0].shape else {
            panic!("{:?}", scene.lights[0].shape);
        };
        assert_eq!(polygon.vertices()[2], DVec3::new(0.0, 3.0, 1.0));
        let two = message(&with("[[0, 3, 0], [1, 3, 0]]"));
        assert!(two.starts_with("s.toml:5:"), "{two}");
        assert!(two.contains("at least 3"), "{two}");
    }

    #[test]
    fn transforms_apply_scale_then_rotation_then_translation() {
        let text = with_object(
            "mesh.box = { size = [2, 2, 2] }\nscale = [1, 2, 3]\nrotate = [0, 90, 0]\ntranslate = [10, 0, 0]",
        );
        let (low, high) = read(&text).unwrap().objects[0].mesh.bounds().unwrap();
        assert!((low - DVec3::new(7.0, -2.0, -1.0)).length() < 1e-5, "{low}");
        assert!(
            (high - DVec3::new(13.0, 2.0, 1.0)).length() < 1e-5,
            "{high}"
        );
    }

    #[test]
    fn x_is_rotated_before_z() {
        let text = with_object(
            "mesh.capsule = { from = [0, 1, 0], to = [0, 3, 0], radius = 0.1 }\nrotate = [90, 0, 90]",
        );
        // +y turns to +z about x; +z stays under the turn about z.
        let (low, high) = read(&text).unwrap().objects[0].mesh.bounds().unwrap();
        assert!(
            (low.z - 0.9).abs() < 1e-6 && (high.z - 3.1).abs() < 1e-6,
            "{low} {high}"
        );
    }

    #[test]
    fn errors_name_place_and_remedy() {
        let unknown = message(&with_object("mesh.plane = { half = 5 }\nroughness = 1"));
        assert!(
            unknown.starts_with("s.toml:8:1: unknown field `roughness`"),
            "{unknown}"
        );
        assert!(unknown.contains("`material`"), "{unknown}");

        let shape = message(&with_object("mesh.cube = { half = 5 }"));
        assert!(shape.starts_with("s.toml:7:"), "{shape}");
        assert!(
            shape.contains("unknown variant `cube`") && shape.contains("`box`"),
            "{shape}"
        );

        let infinite = message(&HEAD.replace("[1, 4, 1]", "[1, inf, 1]"));
        assert!(
            infinite.starts_with("s.toml:5:28: position is [1.0, inf, 1.0]"),
            "{infinite}"
        );

        let eye = message(&HEAD.replace("eye = [0, 2, 5]", "eye = [0, 0.5, 0]"));
        assert!(eye.starts_with("s.toml:3:10: target equals eye"), "{eye}");

        let up = message(&HEAD.replace("eye = [0, 2, 5]", "eye = [0, 2, 0]"));
        assert!(
            up.starts_with("s.toml:2:7: up is parallel to the line of sight"),
            "{up}"
        );

        let fov = message(&HEAD.replace("eye =", "fov = 180\neye ="));
        assert!(
            fov.starts_with("s.toml:2:7: fov is 180; valid is above 0 and below 180"),
            "{fov}"
        );

        let near = message(&HEAD.replace("eye =", "near = -1\neye ="));
        assert!(
            near.starts_with("s.toml:2:8: near is -1; valid is above 0"),
            "{near}"
        );

        let text = message("name = \"x");
        assert!(text.starts_with("s.toml:1:"), "{text}");

        let missing = message(&with_object("mesh.obj = \"nowhere.obj\""));
        assert!(
            missing.starts_with("s.toml:7:12: ") && missing.contains("nowhere.obj: cannot be read"),
            "{missing}"
        );

        let segments = message(&with_object(
            "mesh.cylinder = { segments = 2, radius = 1, height = 1 }",
        ));
        assert!(
            segments.contains("segments is 2; valid is 3..=4096"),
            "{segments}"
        );

        assert!(message(HEAD).contains("no objects"));
        let dark = HEAD.replace("[[lights]]\nshape.point = { position = [1, 4, 1] }", "");
        assert!(
            message(&format!("{dark}[[objects]]\nmesh.plane = {{ half = 1 }}"))
                .contains("no lights")
        );

        let size = message(&format!("size = [0, 5]\n{HEAD}"));
        assert!(size.starts_with("s.toml:1:8: size is [0, 5]"), "{size}");

        let scale = message(&with_object("mesh.plane = { half = 5 }\nscale = 0"));
        assert!(scale.starts_with("s.toml:8:9: scale"), "{scale}");
    }

    #[test]
    fn the_scene_files_of_the_project_load() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
        let mut names = Vec::new();
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "toml") {
                let scene = load(&path).unwrap_or_else(|e| panic!("{e}"));
                assert!(scene.casters().count() > 0);
                names.push(scene.name);
            }
        }
        assert!(names.len() >= 3, "{names:?}");
    }
}
