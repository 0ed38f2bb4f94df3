//! What of an edge lies in front of a light, and whether it touches the light.

use glam::DVec3;

use super::{AreaLight, ring};

/// The part of an edge that can cast a penumbra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitEdge {
    /// End points, in the order of the edge.
    pub ends: [DVec3; 2],
    /// Where the part touches the light, if it does.
    pub touch: Option<DVec3>,
    /// Whether it is shorter than the edge given.
    pub clipped: bool,
}

/// What of an edge lies in front of a light.
#[derive(Clone, Debug, PartialEq)]
pub enum Clipped {
    /// One part, or two where a sphere is pierced.
    Parts(Vec<LitEdge>),
    /// All of it is behind a flat light, or inside a sphere.
    Behind,
    /// All of it lies in the plane of a flat light, beside the light.
    InPlane,
}

/// What counts as in the plane of a flat light, in radii of the light.
const IN_PLANE: f64 = 1e-9;
/// What counts as touching, in radii of the light: near the light, rays from the
/// ends of an edge become opposite, and f32 could not tell their sides.
const TOUCH: f64 = 1e-6;

impl AreaLight {
    /// What of the edge can cast: the part in front of a flat light, the parts
    /// outside a sphere. A part that comes within 1e-6 radii of the light is
    /// said to touch it.
    pub fn clip(&self, ends: [DVec3; 2]) -> Clipped {
        match self {
            Self::Sphere { centre, radius } => clip_to_sphere(*centre, *radius, ends),
            Self::Polygon { centre, normal, .. } | Self::Disc { centre, normal, .. } => {
                self.clip_to_front(*centre, *normal, ends)
            }
        }
    }

    fn clip_to_front(&self, centre: DVec3, normal: DVec3, ends: [DVec3; 2]) -> Clipped {
        let near = IN_PLANE * self.bounding_radius();
        let heights = ends.map(|e| normal.dot(e - centre));
        let in_plane = heights.map(|z| z.abs() <= near);
        if in_plane == [true, true] {
            return match self.meets(ends) {
                Some(touch) => Clipped::Parts(vec![LitEdge {
                    ends,
                    touch: Some(touch),
                    clipped: false,
                }]),
                None => Clipped::InPlane,
            };
        }
        if heights.iter().all(|z| *z <= near) {
            return Clipped::Behind;
        }
        let part = front_part(ends, heights);
        let low = heights.map(|z| z <= TOUCH * self.bounding_radius());
        let touch = match low {
            [true, true] => self.meets(part),
            [true, false] => self.meets([part[0]; 2]),
            [false, true] => self.meets([part[1]; 2]),
            [false, false] => None,
        };
        let onto_plane = |p: DVec3| p - normal * normal.dot(p - centre);
        Clipped::Parts(vec![LitEdge {
            ends: part,
            touch: touch.map(onto_plane),
            clipped: part != ends,
        }])
    }

    /// A point that a segment in a flat light's plane shares with the light.
    fn meets(&self, ends: [DVec3; 2]) -> Option<DVec3> {
        self.meets_within(ends, IN_PLANE * self.bounding_radius())
    }

    /// A point of a segment in a flat light's plane that is at most about `near`
    /// outside the light.
    pub(crate) fn meets_within(&self, [a, b]: [DVec3; 2], near: f64) -> Option<DVec3> {
        match self {
            Self::Sphere { .. } => None,
            Self::Disc { centre, radius, .. } => {
                let nearest = nearest_on_segment([a, b], *centre);
                ((nearest - *centre).length() <= radius + near).then_some(nearest)
            }
            Self::Polygon {
                corners, normal, ..
            } => {
                let [mut from, mut to] = [0.0f64, 1.0];
                for [v, w] in ring(corners) {
                    let inward = normal.cross(w - v).normalize();
                    let [fa, fb] = [a, b].map(|p| inward.dot(p - v) + near);
                    if fa < 0.0 && fb < 0.0 {
                        return None;
                    } else if fa < 0.0 {
                        from = from.max(fa / (fa - fb));
                    } else if fb < 0.0 {
                        to = to.min(fa / (fa - fb));
                    }
                }
                (from <= to).then(|| a + (b - a) * (0.5 * (from + to)))
            }
        }
    }
}

/// The part of a segment with positive height; one end has it.
fn front_part(ends: [DVec3; 2], [za, zb]: [f64; 2]) -> [DVec3; 2] {
    let [a, b] = ends;
    let crossing = || a + (b - a) * (za / (za - zb));
    match (za < 0.0, zb < 0.0) {
        (true, false) => [crossing(), b],
        (false, true) => [a, crossing()],
        _ => ends,
    }
}

/// Point of a segment that is nearest to `p`.
pub(crate) fn nearest_on_segment([a, b]: [DVec3; 2], p: DVec3) -> DVec3 {
    let d = b - a;
    let along = d.dot(p - a) / d.length_squared();
    // Not a number for a segment without length.
    if along > 0.0 {
        a + d * along.min(1.0)
    } else {
        a
    }
}

fn clip_to_sphere(centre: DVec3, radius: f64, ends: [DVec3; 2]) -> Clipped {
    let nearest = nearest_on_segment(ends, centre);
    let gap2 = (nearest - centre).length_squared();
    if gap2 >= radius * radius {
        let reach = radius * (1.0 + TOUCH);
        return Clipped::Parts(vec![LitEdge {
            ends,
            touch: (gap2 <= reach * reach).then_some(nearest),
            clipped: false,
        }]);
    }
    // From each end to where the edge meets the sphere.
    let from = nearest - centre;
    let parts = [0, 1].into_iter().filter_map(|k| {
        let outward = ends[k] - centre;
        if outward.length_squared() <= radius * radius {
            return None;
        }
        let along = (ends[k] - nearest).normalize_or_zero();
        let b = from.dot(along);
        let reach = (b * b + radius * radius - gap2).sqrt() - b;
        let hit = nearest + along * reach;
        Some(LitEdge {
            ends: if k == 0 {
                [ends[0], hit]
            } else {
                [hit, ends[1]]
            },
            touch: Some(hit),
            clipped: true,
        })
    });
    let parts: Vec<LitEdge> = parts.collect();
    if parts.is_empty() {
        return Clipped::Behind;
    }
    Clipped::Parts(parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::light::LightShape;

    fn square() -> AreaLight {
        AreaLight::new(&LightShape::Rectangle {
            centre: DVec3::ZERO,
            edge_u: DVec3::X,
            edge_v: DVec3::Y,
        })
        .unwrap()
    }

    fn sphere() -> AreaLight {
        AreaLight::new(&LightShape::Sphere {
            centre: DVec3::ZERO,
            radius: 0.5,
        })
        .unwrap()
    }

    fn v(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    fn parts(clipped: Clipped) -> Vec<LitEdge> {
        match clipped {
            Clipped::Parts(parts) => parts,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn edges_behind_or_beside_the_plane_cast_nothing() {
        let light = square();
        assert_eq!(light.normal(), Some(DVec3::Z));
        assert_eq!(
            light.clip([v(0.0, 0.0, -1.0), v(3.0, 0.0, -2.0)]),
            Clipped::Behind
        );
        assert_eq!(
            light.clip([v(1.0, 0.0, 0.0), v(3.0, 0.0, 0.0)]),
            Clipped::InPlane
        );
        let other_side = light.reversed();
        assert_eq!(
            parts(other_side.clip([v(0.0, 0.0, -1.0), v(3.0, 0.0, -2.0)])).len(),
            1
        );
    }

    #[test]
    fn edges_that_cross_the_plane_are_cut_there() {
        let part = parts(square().clip([v(3.0, 0.0, -1.0), v(3.0, 0.0, 3.0)]))[0];
        assert_eq!(part.ends, [v(3.0, 0.0, 0.0), v(3.0, 0.0, 3.0)]);
        assert!(part.clipped && part.touch.is_none());
        let stab = parts(square().clip([v(0.25, 0.0, 1.0), v(0.25, 0.0, -1.0)]))[0];
        assert_eq!(stab.touch, Some(v(0.25, 0.0, 0.0)));
    }

    #[test]
    fn edges_in_the_plane_touch_the_light_or_not() {
        let across = parts(square().clip([v(-3.0, 0.2, 0.0), v(3.0, 0.2, 0.0)]))[0];
        assert_eq!(across.touch, Some(v(0.0, 0.2, 0.0)));
        assert_eq!(
            square().clip([v(-3.0, 0.6, 0.0), v(3.0, 0.6, 0.0)]),
            Clipped::InPlane
        );
    }

    #[test]
    fn spheres_are_pierced_into_two_parts() {
        let two = parts(sphere().clip([v(-2.0, 0.3, 0.0), v(2.0, 0.3, 0.0)]));
        assert_eq!(two.len(), 2);
        for part in &two {
            let touch = part.touch.unwrap();
            assert!((touch.length() - 0.5).abs() < 1e-8, "{touch}");
            assert!((touch.y - 0.3).abs() < 1e-12);
        }
        assert_eq!(
            sphere().clip([v(0.1, 0.0, 0.0), v(0.2, 0.0, 0.0)]),
            Clipped::Behind
        );
        assert_eq!(
            parts(sphere().clip([v(-2.0, 0.6, 0.0), v(2.0, 0.6, 0.0)])).len(),
            1
        );
    }
}
