//! The sphere that papers I and II put in a light's place.

use glam::DVec3;

use crate::technique::Warning;
use crate::world::light::{HardLight, Light, LightShape};
use crate::world::mesh::Mesh;

/// A spherical light, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightSphere {
    pub(crate) centre: DVec3,
    /// 0 for lights without extent.
    pub(crate) radius: f64,
}

impl LightSphere {
    /// The sphere itself; for flat lights the one at their centre whose cross
    /// section has their area. `None` for parallel light and points: their
    /// shadows are hard.
    pub(crate) fn of(light: &Light) -> Option<Self> {
        let HardLight::Point(centre) = light.hard() else {
            return None;
        };
        let of_area = |area: f64| (area / std::f64::consts::PI).sqrt();
        let radius = match &light.shape {
            LightShape::Point { .. } | LightShape::Directional { .. } => 0.0,
            LightShape::Sphere { radius, .. } | LightShape::Disc { radius, .. } => *radius,
            LightShape::Rectangle { edge_u, edge_v, .. } => of_area(edge_u.cross(*edge_v).length()),
            LightShape::Polygon(polygon) => of_area(polygon.area_vector().length()),
        };
        (radius > 0.0).then_some(Self { centre, radius })
    }

    /// Whether the light is so small beside its distance from the mesh that the
    /// front and back planes of wedges are too close for f32: their shadow is hard.
    pub(crate) fn is_point_for(&self, mesh: &Mesh) -> bool {
        let distance = |i: u32| (mesh.position(i) - self.centre).length_squared();
        let vertices = 0..mesh.positions().len() as u32;
        let farthest = vertices.map(distance).fold(0.0, f64::max).sqrt();
        self.radius < SMALLEST * farthest
    }
}

/// The least radius over distance of which wedges can be told from their planes.
const SMALLEST: f64 = 1e-5;

/// Says so where casters have no wedges since the light is too small for them.
pub(crate) fn point_warning(number: usize, casters: usize) -> Option<Warning> {
    (casters > 0).then(|| Warning {
        code: "light-as-point",
        count: casters,
        message: format!(
            "light {number} is smaller than {SMALLEST} of its distance from {casters} casters; \
             their shadows are hard"
        ),
    })
}

/// Says so where a light is not the sphere that it is drawn as.
pub(crate) fn substitution(number: usize, light: &Light) -> Option<Warning> {
    let what = match light.shape {
        LightShape::Rectangle { .. } => "rectangle",
        LightShape::Polygon(_) => "polygon",
        LightShape::Disc { .. } => "disc",
        _ => return None,
    };
    let sphere = LightSphere::of(light)?;
    Some(Warning {
        code: "light-as-sphere",
        count: 1,
        message: format!(
            "light {number} is a {what}; this technique draws the sphere with a cross section \
             of equal area, radius {:.4}",
            sphere.radius
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_lights_become_spheres_of_equal_cross_section() {
        let square = Light::horizontal_square(DVec3::Y, 2.0);
        let sphere = LightSphere::of(&square).unwrap();
        assert!((sphere.radius * sphere.radius * std::f64::consts::PI - 4.0).abs() < 1e-12);
        assert_eq!(sphere.centre, DVec3::Y);
        assert!(
            substitution(0, &square)
                .unwrap()
                .message
                .contains("rectangle")
        );
    }

    #[test]
    fn points_and_directions_have_no_sphere() {
        for shape in [
            LightShape::Point { position: DVec3::Y },
            LightShape::Directional { towards: DVec3::Y },
            LightShape::Sphere {
                centre: DVec3::Y,
                radius: 0.0,
            },
        ] {
            let light = Light {
                shape,
                colour: [1.0; 3],
            };
            assert_eq!(LightSphere::of(&light), None);
            assert_eq!(substitution(0, &light), None);
        }
    }
}
