//! Irradiance of the visible part of a polygonal light, in closed form.
//!
//! Lambert's formula: a polygon of radiance L with corners v_k, seen from a
//! point with normal n, gives the irradiance L/2 times the sum over edges of the
//! angle between v_k and v_k+1 times n . unit(v_k x v_k+1). The visible
//! fragments of a light are polygons, so it holds for them, and measures what
//! the usual separation into shading times visibility gets wrong.

use glam::DVec3;

use super::emitter::{Emitter, Frame};
use super::fragments::Fragments;
use super::{AreaOracle, Workspace};
use crate::truth::oracle::surfaces::Receiver;

/// Irradiance over pi times the light's radiance: the share of a hemisphere's
/// cosine-weighted light that the light would give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormFactor {
    /// Of the visible part.
    pub visible: f64,
    /// Of the whole light, casters left out.
    pub unoccluded: f64,
}

impl AreaOracle {
    /// Form factor of a receiver's facet towards the light; light from behind
    /// the facet does not count. `None` for lights that are not polygons, and
    /// for receivers without a facet.
    pub fn form_factor(&self, receiver: &Receiver, work: &mut Workspace) -> Option<FormFactor> {
        let normal = receiver.normal?;
        if !matches!(self.emitter, Emitter::Polygon { .. }) {
            return None;
        }
        let light = self.emitter.seen_from(receiver.point)?;
        let frame = light.frame.relative_to(receiver.point);
        let in_front = |work: &mut Workspace| {
            work.fragments.keep(frame.trace(normal, 0.0));
            lambert(&frame, &work.fragments, normal)
        };
        self.cut(&light, receiver, work);
        let visible = in_front(work);
        work.fragments.reset(light.outline, light.emitting);
        let unoccluded = in_front(work);
        Some(FormFactor {
            visible,
            unoccluded,
        })
    }
}

/// Lambert's sum over fragments in front of a receiver at the origin, over 2 pi.
fn lambert(frame: &Frame, fragments: &Fragments, normal: DVec3) -> f64 {
    let edge = |from: DVec3, to: DVec3| {
        let across = from.cross(to);
        let sine = across.length();
        if sine == 0.0 {
            return 0.0;
        }
        libm::atan2(sine, from.dot(to)) * (normal.dot(across) / sine)
    };
    let of = |polygon: &[[f64; 2]]| {
        let next = polygon.iter().cycle().skip(1);
        let edges = polygon.iter().zip(next);
        edges
            .map(|(a, b)| edge(frame.at(*a), frame.at(*b)))
            .sum::<f64>()
    };
    let sum: f64 = fragments.polygons().map(of).sum();
    // The sign tells which side of the light is seen; both emit.
    sum.abs() / std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::light::{Light, LightShape};

    const FLOOR: [DVec3; 3] = [DVec3::ZERO, DVec3::Z, DVec3::X];

    fn at(x: f64, z: f64) -> Receiver {
        Receiver::on_facet(&FLOOR, DVec3::new(x, 0.0, z), DVec3::NEG_Y)
    }

    fn factor(triangles: &[[DVec3; 3]], light: &LightShape, receiver: &Receiver) -> FormFactor {
        let oracle = AreaOracle::of_triangles(triangles, light).unwrap();
        let found = oracle.form_factor(receiver, &mut Workspace::default());
        found.unwrap()
    }

    /// A rectangle a x b parallel to a patch under one of its corners at
    /// distance 1 (the textbook configuration factor).
    fn corner(a: f64, b: f64) -> f64 {
        let [ra, rb] = [a, b].map(|s| (1.0 + s * s).sqrt());
        (a / ra * libm::atan(b / ra) + b / rb * libm::atan(a / rb)) / std::f64::consts::TAU
    }

    #[test]
    fn a_parallel_square_has_the_textbook_factor() {
        let light = Light::horizontal_square(DVec3::Y, 2.0).shape;
        let whole = factor(&[], &light, &at(0.0, 0.0));
        assert!(
            (whole.unoccluded - 4.0 * corner(1.0, 1.0)).abs() < 1e-11,
            "{whole:?}"
        );
        assert_eq!(whole.visible, whole.unoccluded);
    }

    /// A half-plane that hides the light left of x = 0.25 leaves a rectangle.
    #[test]
    fn a_hidden_part_does_not_count() {
        let light = Light::horizontal_square(DVec3::Y, 2.0).shape;
        let [a, b] = [-9.0, 0.125].map(|x| DVec3::new(x, 0.5, -9.0));
        let [c, d] = [0.125, -9.0].map(|x| DVec3::new(x, 0.5, 9.0));
        let found = factor(&[[a, b, c], [a, c, d]], &light, &at(0.0, 0.0));
        let expected = 2.0 * (corner(1.0, 1.0) - corner(0.25, 1.0));
        assert!(
            (found.visible - expected).abs() < 1e-11,
            "{found:?} {expected}"
        );
        // Shading times visibility is not the same: light near the zenith counts more.
        let separated = found.unoccluded * (0.75 / 2.0);
        assert!((separated - found.visible).abs() > 0.01, "{separated}");
    }

    /// Against midpoint sums of cos cos / (pi r^2), a tilted light partly below
    /// the horizon.
    #[test]
    fn a_light_through_the_horizon_agrees_with_quadrature() {
        let (centre, edge_u, edge_v) = (
            DVec3::new(1.5, 0.2, 0.3),
            DVec3::new(0.4, 1.1, 0.0),
            DVec3::new(0.0, 0.2, 1.3),
        );
        let light = LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        };
        let receiver = at(0.1, -0.2);
        let n = 1200;
        let place = |k: u32| (f64::from(k) + 0.5) / f64::from(n) - 0.5;
        let area_vector = edge_u.cross(edge_v) / f64::from(n * n);
        let mut sum = 0.0;
        for (i, k) in (0..n).flat_map(|i| (0..n).map(move |k| (i, k))) {
            let to = centre + edge_u * place(i) + edge_v * place(k) - receiver.point;
            let r2 = to.dot(to);
            sum += to.y.max(0.0) * area_vector.dot(to).abs() / (r2 * r2);
        }
        let expected = sum / std::f64::consts::PI;
        let found = factor(&[], &light, &receiver).unoccluded;
        assert!(
            expected > 0.01 && (found - expected).abs() < 1e-6,
            "{found} {expected}"
        );
    }

    #[test]
    fn only_polygons_over_facets_have_one() {
        let sphere = LightShape::Sphere {
            centre: DVec3::Y,
            radius: 0.5,
        };
        let square = Light::horizontal_square(DVec3::Y, 2.0).shape;
        let of = |light: &LightShape, receiver: &Receiver| {
            let oracle = AreaOracle::of_triangles(&[], light).unwrap();
            oracle.form_factor(receiver, &mut Workspace::default())
        };
        assert_eq!(of(&sphere, &at(0.0, 0.0)), None);
        assert_eq!(of(&square, &Receiver::free(DVec3::ZERO)), None);
        assert!(of(&square, &at(0.0, 0.0)).is_some());
    }
}
