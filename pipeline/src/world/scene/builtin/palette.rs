//! Materials and small parts that several built-in scenes share.

use crate::world::mesh::Shading;
use crate::world::scene::{Material, Object};
use crate::world::shape::{self, Shape};

pub(super) const FLOOR: Material = Material::matt([0.72, 0.70, 0.66]);
pub(super) const STONE: Material = Material::glossy([0.66, 0.62, 0.55], 0.08, 10.0);
pub(super) const CLAY: Material = Material::glossy([0.72, 0.36, 0.22], 0.18, 20.0);
pub(super) const MOSS: Material = Material::glossy([0.30, 0.50, 0.26], 0.15, 18.0);
pub(super) const STEEL: Material = Material::glossy([0.38, 0.46, 0.58], 0.55, 60.0);
pub(super) const BRASS: Material = Material::glossy([0.78, 0.58, 0.22], 0.50, 48.0);

/// Round where it turns by less than 40 degrees, sharp elsewhere.
pub(super) const CREASED: Shading = Shading::Crease { degrees: 40.0 };

/// A caster with creased shading.
pub(super) fn solid(name: &str, shape: Shape, material: Material) -> Object {
    let mesh = shape.into_mesh(CREASED);
    Object::new(name, mesh.expect("built-in shapes are finite"), material)
}

/// A square floor at y = 0 that only receives.
pub(super) fn floor(half: f64) -> Object {
    solid("floor", shape::plane(half, 0.0), FLOOR).receiver_only()
}
