//! Models in files of other programs: OBJ, PLY, glTF.

pub mod gltf;
pub mod ply;

mod piece;

use std::path::Path;

use thiserror::Error;

pub use piece::{Model, ModelCamera, Piece};

use crate::world::files::{Outside, SceneFolder};
use crate::world::obj::{self, ObjError, ObjMesh};
use crate::world::texture::Gallery;
use gltf::GltfError;
use ply::{PlyError, PlyMesh};

/// Ends of the names of models.
pub const EXTENSIONS: [&str; 4] = ["obj", "ply", "gltf", "glb"];

/// Why a model could not be used.
#[derive(Debug, Error)]
pub enum ModelError {
    /// An OBJ file is wrong.
    #[error(transparent)]
    Obj(#[from] ObjError),
    /// A PLY file is wrong.
    #[error(transparent)]
    Ply(#[from] PlyError),
    /// A glTF file is wrong.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// A name that says of no format that is read.
    #[error("{file}: is no model by its name; valid are names that end in .{}", EXTENSIONS.join(", ."))]
    Unknown {
        /// File as given.
        file: String,
    },
}

/// The format that a file's name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Obj,
    Ply,
    Gltf,
}

fn format(path: &Path) -> Option<Format> {
    let extension = path.extension()?.to_ascii_lowercase();
    match extension.to_str()? {
        "obj" => Some(Format::Obj),
        "ply" => Some(Format::Ply),
        "gltf" | "glb" => Some(Format::Gltf),
        _ => None,
    }
}

/// Whether the name is one of a model.
pub fn is_model(path: &Path) -> bool {
    format(path).is_some()
}

fn unknown(path: &Path) -> ModelError {
    ModelError::Unknown {
        file: path.display().to_string(),
    }
}

/// Reads a model that the user names; what that names in turn must lie in its folder,
/// unless more is allowed.
///
/// # Errors
/// The file cannot be read or holds no valid mesh.
pub fn load_given(path: &Path, outside: Outside) -> Result<Model, ModelError> {
    load_given_at(path, outside, 0.0)
}

/// The same at a time of its animation, in seconds.
///
/// # Errors
/// As [`load_given`].
pub fn load_given_at(path: &Path, outside: Outside, time: f64) -> Result<Model, ModelError> {
    let read = match format(path).ok_or_else(|| unknown(path))? {
        Format::Obj => from_obj(path, obj::load_given(path, outside)?),
        Format::Ply => from_ply(path, ply::load_given(path)?),
        Format::Gltf => gltf::load_given(path, outside, time)?,
    };
    Ok(read)
}

/// Reads a model that a scene in `folder` names, at a time of its animation, in seconds;
/// `gallery` has the scene's pictures.
///
/// # Errors
/// As [`load_given`].
pub fn load_from(
    path: &Path,
    folder: &SceneFolder,
    gallery: &mut Gallery,
    time: f64,
) -> Result<Model, ModelError> {
    let read = match format(path).ok_or_else(|| unknown(path))? {
        Format::Obj => from_obj(path, obj::load_from(path, folder, gallery)?),
        Format::Ply => from_ply(path, ply::load_from(path, folder)?),
        Format::Gltf => gltf::load_from(path, folder, gallery, time)?,
    };
    Ok(read)
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

fn from_obj(path: &Path, read: ObjMesh) -> Model {
    let piece = Piece {
        name: stem(path),
        shape: read.shape,
        parts: read.parts,
        coordinates: read.coordinates,
    };
    Model::of(piece, read.warnings)
}

fn from_ply(path: &Path, read: PlyMesh) -> Model {
    let piece = Piece {
        name: stem(path),
        shape: read.shape,
        parts: Vec::new(),
        coordinates: Vec::new(),
    };
    Model::of(piece, read.warnings)
}
