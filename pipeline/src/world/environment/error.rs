//! Why there is no environment.

use thiserror::Error;

/// What is wrong with a map or with what was asked of it.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The file cannot be read or decoded.
    #[error("environment map {name}: {why}")]
    Unreadable {
        /// As given.
        name: String,
        /// What the system or the decoder says.
        why: String,
    },
    /// The file is of another kind.
    #[error(
        "environment map {name} is no map; valid are 'sky', a .hdr or .exr file, or a folder of px, nx, py, ny, pz, nz (.hdr or .exr)"
    )]
    UnknownKind {
        /// As given.
        name: String,
    },
    /// Width and height belong to no layout.
    #[error(
        "environment map {name} is {width}x{height}; valid are 2:1 (latitude-longitude), 4:3 and 3:4 (crosses), 6:1 and 1:6 (strips of +x, -x, +y, -y, +z, -z), and 1x1"
    )]
    Layout {
        /// As given.
        name: String,
        /// Texels across.
        width: usize,
        /// Texels down.
        height: usize,
    },
    /// Not one texel for each place.
    #[error("environment map {name} has {found} texels; {width}x{height} needs {}", .width * .height)]
    Length {
        /// As given.
        name: String,
        /// Texels across.
        width: usize,
        /// Texels down.
        height: usize,
        /// Texels given.
        found: usize,
    },
    /// Faces of a cube in several files differ in size.
    #[error(
        "environment map {name}: {face} is {width}x{height}; all six must be {side}x{side} as px is"
    )]
    Faces {
        /// The folder.
        name: String,
        /// Name of the file.
        face: String,
        /// Its width.
        width: usize,
        /// Its height.
        height: usize,
        /// Side of the first face.
        side: usize,
    },
    /// No texel above 0.
    #[error("environment map {name} has no light in it: no texel is above 0 and finite")]
    Dark {
        /// As given.
        name: String,
    },
    /// No light stands out of the residual.
    #[error(
        "no area light can be fitted to environment map {name}: all of it is residual; use residual=excess"
    )]
    NoLights {
        /// As given.
        name: String,
    },
    /// A setting out of range.
    #[error("environment: {what} is {value}; valid is {valid}")]
    Setting {
        /// The setting.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A scene without casters has no size to place lights by.
    #[error("the scene casts no shadow; an environment is placed round its casters")]
    NoCasters,
}
