//! Area lights as soft shadow volumes need them: corners or a radius, a centre,
//! a lit side, and what of an edge lies in front of the light.
//!
//! Flat lights shine into the half-space in front of them only: an edge behind
//! the light's plane casts nothing, and of an edge that crosses the plane only
//! the part in front counts. [`AreaLight::reversed`] gives the other side.

use glam::DVec3;
use thiserror::Error;

use crate::light::LightShape;

/// Why a light has no penumbrae, or is no convex light.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AreaLightError {
    /// A point or directional light.
    #[error(
        "a {0} light has no area; penumbra wedges need a rectangle, disc, sphere or convex polygon"
    )]
    NoArea(&'static str),
    /// A number that is not finite, or a size that is not positive.
    #[error("the light's {what} is {value}; it must be finite and above {limit}")]
    BadSize {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must exceed.
        limit: f64,
    },
    /// A polygon with too few corners.
    #[error("the light has {0} corners; a polygon needs at least 3")]
    TooFewCorners(usize),
    /// A polygon that turns the wrong way at a corner, or leaves its plane.
    #[error(
        "corner {corner} of the light makes it {fault}; corners must run counter-clockwise \
         round a convex, flat polygon"
    )]
    NotConvex {
        /// Index of the corner.
        corner: usize,
        /// What is wrong there.
        fault: &'static str,
    },
}

/// A convex area light, world space.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaLight {
    /// A flat convex polygon; rectangles are such.
    Polygon {
        /// At least three, counter-clockwise seen from the lit side.
        corners: Vec<DVec3>,
        /// Where hard shadow quads start: the mean of the corners.
        centre: DVec3,
        /// Unit, into the lit half-space.
        normal: DVec3,
    },
    /// A flat disc.
    Disc {
        /// Centre.
        centre: DVec3,
        /// Unit, into the lit half-space.
        normal: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A sphere, lit all round.
    Sphere {
        /// Centre.
        centre: DVec3,
        /// Radius.
        radius: f64,
    },
}

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
    /// The convex light of a scene's light. Rectangles shine towards
    /// `edge_u x edge_v`, discs along their normal.
    ///
    /// # Errors
    /// Lights without area, and sizes that are not finite and positive.
    pub fn new(shape: &LightShape) -> Result<Self, AreaLightError> {
        match *shape {
            LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            } => {
                let corner = |s: f64, t: f64| centre + 0.5 * (s * edge_u + t * edge_v);
                let corners = vec![
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(1.0, 1.0),
                    corner(-1.0, 1.0),
                ];
                let mut light = Self::polygon(corners)?;
                if let Self::Polygon { centre: mean, .. } = &mut light {
                    *mean = centre; // to the bit what hard shadows use
                }
                Ok(light)
            }
            LightShape::Disc {
                centre,
                normal,
                radius,
            } => {
                positive("normal's length", normal.length())?;
                sized(centre, radius)?;
                Ok(Self::Disc {
                    centre,
                    normal: normal.normalize(),
                    radius,
                })
            }
            LightShape::Sphere { centre, radius } => {
                sized(centre, radius)?;
                Ok(Self::Sphere { centre, radius })
            }
            LightShape::Point { .. } => Err(AreaLightError::NoArea("point")),
            LightShape::Directional { .. } => Err(AreaLightError::NoArea("directional")),
        }
    }

    /// A flat convex polygon, corners counter-clockwise seen from the lit side.
    ///
    /// # Errors
    /// Fewer than three corners, no area, not flat, or not convex.
    pub fn polygon(corners: Vec<DVec3>) -> Result<Self, AreaLightError> {
        if corners.len() < 3 {
            return Err(AreaLightError::TooFewCorners(corners.len()));
        }
        let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let edges = ring(&corners).map(|[a, b]| (a - centre).cross(b - centre));
        let area = edges.sum::<DVec3>() / 2.0;
        positive("area", area.length())?;
        let normal = area.normalize();
        check_convex(&corners, centre, normal)?;
        Ok(Self::Polygon {
            corners,
            centre,
            normal,
        })
    }

    /// The same light shining from its other side; spheres are lit all round.
    pub fn reversed(mut self) -> Self {
        match &mut self {
            Self::Polygon {
                corners, normal, ..
            } => {
                corners.reverse();
                *normal = -*normal;
            }
            Self::Disc { normal, .. } => *normal = -*normal,
            Self::Sphere { .. } => {}
        }
        self
    }

    /// Where hard shadow quads start.
    pub fn centre(&self) -> DVec3 {
        match self {
            Self::Polygon { centre, .. }
            | Self::Disc { centre, .. }
            | Self::Sphere { centre, .. } => *centre,
        }
    }

    /// Radius of the smallest sphere round the centre that holds the light.
    pub fn bounding_radius(&self) -> f64 {
        match self {
            Self::Polygon {
                corners, centre, ..
            } => corners
                .iter()
                .map(|v| (*v - *centre).length())
                .fold(0.0, f64::max),
            Self::Disc { radius, .. } | Self::Sphere { radius, .. } => *radius,
        }
    }

    /// Unit normal into the lit half-space; `None` for spheres.
    pub fn normal(&self) -> Option<DVec3> {
        match self {
            Self::Polygon { normal, .. } | Self::Disc { normal, .. } => Some(*normal),
            Self::Sphere { .. } => None,
        }
    }

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
    fn meets(&self, [a, b]: [DVec3; 2]) -> Option<DVec3> {
        let near = IN_PLANE * self.bounding_radius();
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

/// Consecutive pairs, the last with the first.
pub(crate) fn ring(points: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> {
    (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]])
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
fn nearest_on_segment([a, b]: [DVec3; 2], p: DVec3) -> DVec3 {
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

fn positive(what: &'static str, value: f64) -> Result<(), AreaLightError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(AreaLightError::BadSize {
        what,
        value,
        limit: 0.0,
    })
}

fn sized(centre: DVec3, radius: f64) -> Result<(), AreaLightError> {
    positive("radius", radius)?;
    positive("centre's squared length + 1", centre.length_squared() + 1.0)
}

fn check_convex(corners: &[DVec3], centre: DVec3, normal: DVec3) -> Result<(), AreaLightError> {
    const FLAT: f64 = 1e-6;
    let n = corners.len();
    for k in 0..n {
        let [a, b, c] = [corners[k], corners[(k + 1) % n], corners[(k + 2) % n]];
        let size = (a - centre).length();
        let fault = if normal.dot(a - centre).abs() > FLAT * size {
            "leave its plane"
        } else if (b - a).cross(c - b).dot(normal) < 0.0 {
            "turn clockwise"
        } else if (b - a).length() == 0.0 {
            "repeat a corner"
        } else {
            continue;
        };
        return Err(AreaLightError::NotConvex { corner: k, fault });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn lights_that_are_none_are_refused() {
        let error = |shape: &LightShape| AreaLight::new(shape).unwrap_err().to_string();
        assert!(error(&LightShape::Point { position: DVec3::X }).contains("point light has no"));
        assert!(
            error(&LightShape::Sphere {
                centre: DVec3::X,
                radius: -1.0
            })
            .contains("radius is -1")
        );
        assert!(
            error(&LightShape::Rectangle {
                centre: DVec3::X,
                edge_u: DVec3::X,
                edge_v: DVec3::X
            })
            .contains("area is 0")
        );
        let bow_tie = vec![DVec3::ZERO, DVec3::X, v(0.2, 1.0, 0.0), v(0.9, 1.2, 0.0)];
        assert!(AreaLight::polygon(bow_tie).is_err());
    }
}
