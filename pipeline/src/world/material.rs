//! How surfaces are shaded.

use super::texture::SurfaceTexture;

/// Phong material, linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Diffuse reflectance, 0..1; also scales ambient light.
    pub albedo: [f32; 3],
    /// Specular reflectance, 0..1.
    pub specular: [f32; 3],
    /// Phong exponent, at least 1.
    pub shininess: f32,
}

impl Material {
    /// A matt material.
    pub const fn matt(albedo: [f32; 3]) -> Self {
        Self {
            albedo,
            specular: [0.0; 3],
            shininess: 1.0,
        }
    }

    /// A material with a white highlight of strength `specular`.
    pub const fn glossy(albedo: [f32; 3], specular: f32, shininess: f32) -> Self {
        Self {
            albedo,
            specular: [specular; 3],
            shininess,
        }
    }
}

/// Triangles of an object with a material of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialPart {
    /// How they are shaded.
    pub material: Material,
    /// What the material's albedo is multiplied by, at the texture coordinates of the object.
    pub texture: Option<SurfaceTexture>,
    /// Indices into the mesh's triangles, ascending.
    pub triangles: Vec<u32>,
}
