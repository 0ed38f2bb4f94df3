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
//! near = 0.1                      # if not given, before all that is seen
//!
//! [[lights]]                      # point, square, rectangle, polygon, disc, sphere,
//!                                 # directional
//! shape.square = { centre = [1.5, 4.0, 1.0], side = 1.0 }
//! colour = [1.0, 1.0, 1.0]        # optional; color as well
//!
//! [[objects]]
//! mesh.plane = { half = 5.0 }     # sheets cast nothing unless told to
//!
//! [[objects]]
//! name = "bunny"
//! mesh.obj = "bunny.obj"          # relative to this file; mesh.model = "a.glb" for PLY and
//!                                 # glTF as well
//! scale = 10.0                    # a number or three; applied first,
//! rotate = [0.0, 30.0, 0.0]       # then degrees about x, then y, then z,
//! translate = [0.0, -0.3, 0.0]    # then this
//! crease = 40.0                   # edges that turn by more are shaded sharp
//! material = { albedo = [0.7, 0.4, 0.2], specular = [0.3, 0.3, 0.3], shininess = 30.0 }
//! casts = true
//! receives = true
//! open = false                    # may cast though its mesh is not closed
//! [objects.motion]                # optional; added to rotate and translate
//! velocity = [0.2, 0.0, 0.0]      # per second
//! spin = [0.0, 90.0, 0.0]         # degrees per second
//! keys = [                        # linear between them
//!     { time = 0.0 },
//!     { time = 1.0, translate = [0.0, 0.5, 0.0], rotate = [0.0, 0.0, 20.0] },
//!     { time = 2.0 },
//! ]
//! repeat = true                   # from the first key again after the last one
//!
//! [[objects]]
//! mesh.creature = { phase = 0.0, walk = 6.0 }   # radians, radians per second
//! ```
//!
//! Instead of lights a scene may have an environment, which lights it alone and
//! sets ambient light and background; see [`crate::world::environment`]:
//!
//! ```toml
//! [environment]
//! map = "sky"                     # or a .hdr or .exr file, or a folder of six
//! lights = 30                     # optional, as everything below
//! form = "square"                 # or "rectangle"
//! threshold = 0.05                # looked for by the number of lights if not given
//! residual = "excess"             # or "mean"
//! place = "moments"               # or "centroid", or "texels"
//! ambient = "harmonic"            # or "even"
//! side = 128                      # texels along a cube face
//! turn = 0.0                      # degrees about +y
//! brightness = 1.0
//! ```
//!
//! Unknown keys are errors; every error names file, line and column and says
//! what would be valid.

mod array;
mod build;
mod check;
mod environment;
mod motion;
mod schema;
mod shapes;
mod texture;

use std::path::Path;

use thiserror::Error;

use super::Scene;
use crate::world::files::{self, FileError, Outside, SceneFolder};
use crate::world::scene::environment::{EnvironmentRequest, FittedMaps};

/// Bytes of a scene file that are read at most.
pub const MAX_SCENE_BYTES: u64 = 16 << 20;

/// Why a scene file could not be used.
#[derive(Debug, Error)]
pub enum SceneFileError {
    /// The file could not be read.
    #[error("{file}: {source}")]
    Unreadable {
        /// File as given.
        file: String,
        /// Why not.
        source: FileError,
    },
    /// The bytes are no text.
    #[error("{file}: not UTF-8 (byte {at} is the first that is not); save it as UTF-8")]
    NotText {
        /// File as given.
        file: String,
        /// The first byte that is not, from 0.
        at: usize,
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

/// When and under which light a scene is wanted.
#[derive(Debug)]
pub struct Moment<'a> {
    /// Seconds.
    pub time: f64,
    /// Whether files that the scene names may lie outside its folder.
    pub outside: Outside,
    /// Takes the place of the file's own lights and environment.
    pub environment: Option<&'a EnvironmentRequest>,
    /// Maps that were read before; those of this scene are added.
    pub maps: &'a mut FittedMaps,
}

/// Reads a scene file at time 0; mesh paths are relative to it.
///
/// # Errors
/// The file or a mesh cannot be read, is not TOML, or holds a value that makes
/// no scene.
pub fn load(path: &Path) -> Result<Scene, SceneFileError> {
    let mut moment = Moment {
        time: 0.0,
        outside: Outside::Refused,
        environment: None,
        maps: &mut FittedMaps::default(),
    };
    named(path, &read(path)?, &mut moment)
}

/// The text of a scene file.
pub(super) fn read(path: &Path) -> Result<String, SceneFileError> {
    let file = || path.display().to_string();
    let read = files::read(path, MAX_SCENE_BYTES);
    let bytes = read.map_err(|source| SceneFileError::Unreadable {
        file: file(),
        source,
    })?;
    String::from_utf8(bytes).map_err(|e| SceneFileError::NotText {
        file: file(),
        at: e.utf8_error().valid_up_to(),
    })
}

/// The scene of `text`, which is that of `path`; named after it where it has no
/// name of its own.
pub(super) fn named(
    path: &Path,
    text: &str,
    moment: &mut Moment<'_>,
) -> Result<Scene, SceneFileError> {
    let file = path.display().to_string();
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut scene = parse_at(text, &file, folder, moment)?;
    if scene.name.is_empty() {
        scene.name = stem.into_owned();
    }
    Ok(scene)
}

/// Reads scene text at time 0; `file` names it in messages, `folder` holds its
/// meshes.
///
/// # Errors
/// As [`load`].
pub fn parse(text: &str, file: &str, folder: &Path) -> Result<Scene, SceneFileError> {
    let mut moment = Moment {
        time: 0.0,
        outside: Outside::Refused,
        environment: None,
        maps: &mut FittedMaps::default(),
    };
    parse_at(text, file, folder, &mut moment)
}

/// The same at any moment.
///
/// # Errors
/// As [`load`].
pub fn parse_at(
    text: &str,
    file: &str,
    folder: &Path,
    moment: &mut Moment<'_>,
) -> Result<Scene, SceneFileError> {
    // A byte order mark is no part of the text.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let source = check::Source { text, file };
    let table: schema::SceneTable = toml::from_str(text).map_err(|e| {
        let span = e.span().unwrap_or(0..0);
        source.error(span, e.message().to_owned())
    })?;
    let folder = SceneFolder::new(folder, moment.outside);
    build::scene(&source, &folder, table, moment)
}

#[cfg(test)]
mod documented;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::light::LightShape;
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
        assert_eq!(casts, [false, true, true]);
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

    fn at(text: &str, time: f64) -> Result<Scene, SceneFileError> {
        let mut moment = Moment {
            time,
            outside: Outside::Refused,
            environment: None,
            maps: &mut FittedMaps::default(),
        };
        parse_at(text, "s.toml", Path::new("."), &mut moment)
    }

    #[test]
    fn objects_move_by_rates_and_keys() {
        let text = with_object(
            "mesh.box = { size = [2, 2, 2] }\ntranslate = [10, 0, 0]\n[objects.motion]\n\
             velocity = [1, 0, 0]\nspin = [0, 45, 0]\nrepeat = true\n\
             keys = [{ time = 1 }, { time = 3, translate = [0, 4, 0] }]",
        );
        let bounds = |time| at(&text, time).unwrap().objects[0].mesh.bounds().unwrap();
        let middle = |time| (bounds(time).0 + bounds(time).1) * 0.5;
        assert_eq!(middle(1.0), DVec3::new(11.0, 0.0, 0.0));
        assert!((middle(2.0) - DVec3::new(12.0, 2.0, 0.0)).length() < 1e-6);
        assert!(
            (middle(3.5) - DVec3::new(13.5, 1.0, 0.0)).length() < 1e-6,
            "from the first key"
        );
        // Half a right angle makes the box wider by the square root of 2.
        let wide = bounds(1.0).1.x - bounds(1.0).0.x;
        assert!(
            (wide - 2.0 * std::f64::consts::SQRT_2).abs() < 1e-6,
            "{wide}"
        );
        let held = text.replace("repeat = true", "");
        assert_eq!(
            at(&held, 9.0).unwrap().objects[0]
                .mesh
                .bounds()
                .unwrap()
                .1
                .y,
            5.0
        );
        let wrong = text.replace("time = 3", "time = 1");
        let message = at(&wrong, 0.0).unwrap_err().to_string();
        assert!(message.contains("time is 1; valid is above 1"), "{message}");
    }

    #[test]
    fn a_creature_walks() {
        let text = with_object("mesh.creature = { phase = 0, walk = 2 }");
        let later = with_object("mesh.creature = { phase = 3 }");
        let mesh = |text: &str, time| at(text, time).unwrap().objects[0].mesh.clone();
        assert!(mesh(&text, 1.5) == mesh(&later, 0.0));
        assert!(mesh(&text, 1.5) != mesh(&text, 1.0));
    }

    #[test]
    fn an_environment_takes_the_place_of_lights() {
        let camera = HEAD.split("[[lights]]").next().unwrap();
        let object = "[[objects]]\nmesh.box = { size = [1, 1, 1] }\n";
        let with = |lines: &str| format!("{camera}[environment]\n{lines}\n{object}");
        let scene = read(&with("map = \"sky\"\nside = 32\nlights = 20\nturn = 30")).unwrap();
        assert!(
            (15..=20).contains(&scene.lights.len()),
            "{}",
            scene.lights.len()
        );
        assert!(scene.environment.is_some());
        let missing = message(&with("map = \"nowhere.hdr\""));
        assert!(
            missing.starts_with("s.toml:5:7: ") && missing.contains("nowhere.hdr"),
            "{missing}"
        );
        let form = message(&with("map = \"sky\"\nform = \"round\""));
        assert!(form.contains("rectangle"), "{form}");
        let none = message(&with("map = \"sky\"\nlights = 0"));
        assert!(none.contains("1 to 1024"), "{none}");
        let both = message(&format!("{HEAD}[environment]\nmap = \"sky\"\n{object}"));
        assert!(both.contains("beside [environment]"), "{both}");
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
