//! Area lights as soft shadow volumes need them: corners or a radius, a centre,
//! a lit side, and what of an edge lies in front of the light.
//!
//! Flat lights shine into the half-space in front of them only: an edge behind
//! the light's plane casts nothing, and of an edge that crosses the plane only
//! the part in front counts. [`AreaLight::reversed`] gives the other side.

mod clip;

pub(crate) use clip::nearest_on_segment;
pub use clip::{Clipped, LitEdge};

use glam::DVec3;
use thiserror::Error;

use crate::world::light::LightShape;

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
        /// Where hard shadow quads start: of a scene's polygon the centre of area, else the
        /// mean of the corners.
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

impl AreaLight {
    /// The convex light of a scene's light. Rectangles shine towards
    /// `edge_u x edge_v`, discs along their normal, polygons to where they are seen
    /// counter-clockwise.
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
            LightShape::Polygon(ref polygon) => {
                let mut light = Self::polygon(polygon.vertices().to_vec())?;
                if let Self::Polygon { centre, .. } = &mut light {
                    *centre = polygon.centroid();
                }
                Ok(light)
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

    /// How far it reaches from its centre in a direction of length 1.
    pub fn reach(&self, direction: DVec3) -> f64 {
        match self {
            Self::Polygon {
                corners, centre, ..
            } => {
                let along = corners.iter().map(|c| (*c - *centre).dot(direction));
                along.fold(0.0, f64::max)
            }
            Self::Disc { normal, radius, .. } => {
                let sine2 = 1.0 - normal.dot(direction) * normal.dot(direction);
                radius * sine2.max(0.0).sqrt()
            }
            Self::Sphere { radius, .. } => *radius,
        }
    }

    /// Unit normal into the lit half-space; `None` for spheres.
    pub fn normal(&self) -> Option<DVec3> {
        match self {
            Self::Polygon { normal, .. } | Self::Disc { normal, .. } => Some(*normal),
            Self::Sphere { .. } => None,
        }
    }
}

/// Consecutive pairs, the last with the first.
fn ring(points: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> {
    (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]])
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
        let bow_tie = vec![
            DVec3::ZERO,
            DVec3::X,
            DVec3::new(0.2, 1.0, 0.0),
            DVec3::new(0.9, 1.2, 0.0),
        ];
        assert!(AreaLight::polygon(bow_tie).is_err());
    }
}
