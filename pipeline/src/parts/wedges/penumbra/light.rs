//! The sphere that papers I and II put in a light's place.

use glam::DVec3;

use crate::choices;
use crate::geometry::wedge::paper1::TouchedLight;

use crate::technique::{Condition, LightFact, Param, Warning};
use crate::world::light::{HardLight, Light, LightShape};
use crate::world::mesh::Mesh;

choices! {
    /// What wedges take a light for.
    pub(crate) enum LightAs {
        /// The sphere round it.
        BoundingSphere = "bounding-sphere",
        /// The sphere with a cross section of its area.
        EqualArea = "equal-area",
        /// Itself, by its corners.
        Corners = "corners",
    }
}

pub(crate) const LIGHT_AS: Param<LightAs> = Param::choice(
    "light-as",
    LightAs::BoundingSphere.word(),
    "what lights that are no spheres are taken for: the sphere round them, one of equal cross \
     section, or themselves, front and back planes touching opposite corners",
)
.when(Condition::Lights(LightFact::Extended));

/// Corners of the polygon round a disc.
const DISC_CORNERS: u32 = 64;

/// A spherical light, or one by its corners, world space.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LightSphere {
    pub(crate) centre: DVec3,
    /// 0 for lights without extent.
    pub(crate) radius: f64,
    /// Of lights that are taken for themselves; else none.
    corners: Vec<DVec3>,
}

impl LightSphere {
    /// The sphere itself; for flat lights what `light_as` says. `None` for parallel light
    /// and points: their shadows are hard.
    pub(crate) fn of(light: &Light, light_as: LightAs) -> Option<Self> {
        let HardLight::Point(centre) = light.hard() else {
            return None;
        };
        let corners = corners(&light.shape);
        let farthest = corners.iter().map(|c| (*c - centre).length());
        let round = farthest.fold(0.0, f64::max);
        let equal = (area(&light.shape) / std::f64::consts::PI).sqrt();
        let (radius, corners) = match (&light.shape, light_as) {
            (LightShape::Sphere { radius, .. }, _) => (*radius, Vec::new()),
            (LightShape::Disc { radius, .. }, LightAs::BoundingSphere) => (*radius, Vec::new()),
            (_, LightAs::BoundingSphere) => (round, Vec::new()),
            (_, LightAs::EqualArea) => (equal, Vec::new()),
            (_, LightAs::Corners) => (round, corners),
        };
        (radius > 0.0).then_some(Self {
            centre,
            radius,
            corners,
        })
    }

    /// As wedges are built for it.
    pub(crate) fn touched(&self) -> TouchedLight {
        TouchedLight {
            centre: self.centre,
            radius: self.radius,
            corners: self.corners.clone(),
        }
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

/// Corners of flat lights; of a disc those of a polygon round it.
fn corners(shape: &LightShape) -> Vec<DVec3> {
    match shape {
        LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        } => [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
            .map(|[s, t]| *centre + *edge_u * s + *edge_v * t)
            .to_vec(),
        LightShape::Polygon(polygon) => polygon.vertices().to_vec(),
        LightShape::Disc {
            centre,
            normal,
            radius,
        } => {
            let (u, v) = normal.any_orthonormal_pair();
            let step = std::f64::consts::TAU / f64::from(DISC_CORNERS);
            let reach = radius / libm::cos(0.5 * step);
            let corner = |k: u32| {
                let angle = step * f64::from(k);
                *centre + (u * libm::cos(angle) + v * libm::sin(angle)) * reach
            };
            (0..DISC_CORNERS).map(corner).collect()
        }
        _ => Vec::new(),
    }
}

fn area(shape: &LightShape) -> f64 {
    match shape {
        LightShape::Rectangle { edge_u, edge_v, .. } => edge_u.cross(*edge_v).length(),
        LightShape::Polygon(polygon) => polygon.area_vector().length(),
        LightShape::Disc { radius, .. } => std::f64::consts::PI * radius * radius,
        _ => 0.0,
    }
}

/// Says so where a light is not what it is drawn as.
pub(crate) fn substitution(number: usize, light: &Light, light_as: LightAs) -> Option<Warning> {
    let what = match light.shape {
        LightShape::Rectangle { .. } => "rectangle",
        LightShape::Polygon(_) => "polygon",
        LightShape::Disc { .. } => "disc",
        _ => return None,
    };
    let sphere = LightSphere::of(light, light_as)?;
    let which = match light_as {
        LightAs::BoundingSphere => "the sphere round it",
        LightAs::EqualArea => "the sphere with a cross section of equal area",
        LightAs::Corners => return None,
    };
    Some(Warning {
        code: "light-as-sphere",
        count: 1,
        message: format!(
            "light {number} is a {what}; this technique draws {which}, radius {:.4}",
            sphere.radius
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_lights_become_spheres_or_keep_their_corners() {
        let square = Light::horizontal_square(DVec3::Y, 2.0);
        let of = |light_as| LightSphere::of(&square, light_as).unwrap();
        let sphere = of(LightAs::EqualArea);
        assert!((sphere.radius * sphere.radius * std::f64::consts::PI - 4.0).abs() < 1e-12);
        assert_eq!(sphere.centre, DVec3::Y);
        let round = of(LightAs::BoundingSphere);
        assert!((round.radius - 2f64.sqrt()).abs() < 1e-12 && round.corners.is_empty());
        assert_eq!(of(LightAs::Corners).corners.len(), 4);
        let said = |light_as| substitution(0, &square, light_as).map(|w| w.message);
        assert!(
            said(LightAs::BoundingSphere)
                .unwrap()
                .contains("sphere round it, radius 1.4142")
        );
        assert!(said(LightAs::EqualArea).unwrap().contains("rectangle"));
        assert_eq!(said(LightAs::Corners), None);
    }

    /// Planes that touch the corners of a disc's polygon leave none of the disc out, and
    /// hardly anything beside it.
    #[test]
    fn a_disc_lies_in_the_polygon_of_its_corners_and_touches_it() {
        let shape = LightShape::Disc {
            centre: DVec3::new(1.0, 3.0, -2.0),
            normal: DVec3::new(0.3, -1.0, 0.2).normalize(),
            radius: 0.7,
        };
        let light = Light {
            shape,
            colour: [1.0; 3],
        };
        let round = LightSphere::of(&light, LightAs::Corners).unwrap();
        let next = |k: usize| round.corners[(k + 1) % round.corners.len()];
        for (k, corner) in round.corners.iter().enumerate() {
            let middle = 0.5 * (*corner + next(k));
            let off = (middle - round.centre).length() - 0.7;
            assert!(off.abs() < 1e-12, "{k}: {off}");
        }
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
            assert_eq!(LightSphere::of(&light, LightAs::BoundingSphere), None);
            assert_eq!(substitution(0, &light, LightAs::BoundingSphere), None);
        }
    }
}
