//! Shaders of a light's diffuse and specular light on a surface: with and without a
//! texture, dimmed by visibility or not.

use gnomon_raster::shader::FragmentStage;
use gnomon_shaders::surface::{Lambert, Phong};
use gnomon_shaders::textured::{TexturedLambert, TexturedPhong};

use super::visibility::VisibilityTexture;

/// What a light does on a surface.
#[derive(Clone, Copy)]
pub(super) enum LitSurface {
    /// Diffuse light.
    Lambert(Lambert),
    /// Diffuse and specular light.
    Phong(Phong),
}

/// The stage of a surface's shader, dimmed where there is a visibility.
macro_rules! stage {
    ($surface:expr, $visibility:expr) => {
        match $visibility {
            Some(v) if v.bytes => v.shadowed_by_bytes($surface).stage(),
            Some(v) => v.shadowed($surface).stage(),
            None => $surface.stage(),
        }
    };
}

impl LitSurface {
    /// The shader of a surface of one colour.
    pub(super) fn shader(self, visibility: Option<VisibilityTexture>) -> FragmentStage {
        match self {
            Self::Lambert(lambert) => stage!(lambert, visibility),
            Self::Phong(phong) => stage!(phong, visibility),
        }
    }

    /// The shader of a surface with a texture, which is behind that of the visibility.
    pub(super) fn textured_shader(self, visibility: Option<VisibilityTexture>) -> FragmentStage {
        let slot = u32::from(visibility.is_some());
        match self {
            Self::Lambert(lambert) => stage!(TexturedLambert { lambert, slot }, visibility),
            Self::Phong(phong) => stage!(TexturedPhong { phong, slot }, visibility),
        }
    }
}
