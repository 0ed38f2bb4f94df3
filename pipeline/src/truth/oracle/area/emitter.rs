//! A light prepared for integration: a plane frame with an outline.

use glam::DVec3;

use super::disc::UNIT_DISC;
use super::fragments::{self, Emitting, HalfPlane};
use crate::world::error::LightError;
use crate::world::light::{HardLight, LightShape};

/// A plane with coordinates: the point (s, t) is `centre + s u + t v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) centre: DVec3,
    pub(crate) u: DVec3,
    pub(crate) v: DVec3,
}

impl Frame {
    /// The point (s, t), world space.
    pub(crate) fn at(&self, [s, t]: [f64; 2]) -> DVec3 {
        self.centre + self.u * s + self.v * t
    }

    /// Where `normal . (x - p) + offset >= 0` meets the plane; `self` must be
    /// relative to `p`.
    pub(super) fn trace(&self, normal: DVec3, offset: f64) -> HalfPlane {
        HalfPlane {
            k: normal.dot(self.centre) + offset,
            s: normal.dot(self.u),
            t: normal.dot(self.v),
        }
    }

    /// The same frame with `p` as the origin of space.
    pub(super) fn relative_to(&self, p: DVec3) -> Self {
        Self {
            centre: self.centre - p,
            ..*self
        }
    }
}

/// Square about the unit disc.
const ROUND_DISC: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// A light by the way it is integrated over.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Emitter {
    /// No extent: visible or not.
    Hard(HardLight),
    /// A convex polygon; `outline` is counter-clockwise in the frame.
    Polygon {
        frame: Frame,
        outline: Vec<[f64; 2]>,
    },
    /// The unit disc of the frame.
    Disc(Frame),
    /// A sphere: each point of space sees a disc of its own.
    Sphere { centre: DVec3, radius: f64 },
}

/// A flat light as one point of space sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlatLight<'a> {
    pub(crate) frame: Frame,
    pub(crate) outline: &'a [[f64; 2]],
    pub(super) emitting: Emitting,
}

impl FlatLight<'_> {
    /// Emitting area, in the units of the frame's coordinates.
    pub(super) fn area(&self) -> f64 {
        match self.emitting {
            Emitting::Outline => fragments::area(self.outline),
            Emitting::UnitDisc => UNIT_DISC,
        }
    }

    /// Whether the unit disc of the frame emits, not the outline.
    pub(crate) fn is_disc(&self) -> bool {
        self.emitting == Emitting::UnitDisc
    }
}

impl Emitter {
    /// Prepares `shape`.
    ///
    /// # Errors
    /// A light that should have an extent has none.
    pub(crate) fn new(shape: &LightShape) -> Result<Self, LightError> {
        Ok(match shape {
            LightShape::Point { .. } | LightShape::Directional { .. } => Self::Hard(hard(shape)),
            LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            } => {
                extent("area", edge_u.cross(*edge_v).length())?;
                Self::Polygon {
                    frame: Frame {
                        centre: *centre,
                        u: *edge_u,
                        v: *edge_v,
                    },
                    outline: vec![[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]],
                }
            }
            LightShape::Polygon(polygon) => polygon_emitter(polygon),
            LightShape::Disc {
                centre,
                normal,
                radius,
            } => {
                extent("radius", *radius)?;
                extent("normal", normal.length())?;
                Self::Disc(facing(*centre, *normal, *radius))
            }
            LightShape::Sphere { centre, radius } => {
                extent("radius", *radius)?;
                Self::Sphere {
                    centre: *centre,
                    radius: *radius,
                }
            }
        })
    }

    /// The flat light that `p` sees; `None` for lights without extent, and for a
    /// sphere with `p` in it. A sphere is seen as its cone's cross-section
    /// through the centre, a disc of radius `r / sqrt(1 - r^2 / D^2)`, which is
    /// more than r.
    pub(crate) fn seen_from(&self, p: DVec3) -> Option<FlatLight<'_>> {
        let (frame, outline, emitting) = match self {
            Self::Hard(_) => return None,
            Self::Polygon { frame, outline } => (*frame, &outline[..], Emitting::Outline),
            Self::Disc(frame) => (*frame, &ROUND_DISC[..], Emitting::UnitDisc),
            Self::Sphere { centre, radius } => {
                let away = *centre - p;
                let share = radius * radius / away.dot(away);
                // Also None for p in the centre, where the share is infinite.
                let seen = (share < 1.0).then(|| radius / (1.0 - share).sqrt());
                let frame = facing(*centre, away, seen.filter(|r| r.is_finite())?);
                (frame, &ROUND_DISC[..], Emitting::UnitDisc)
            }
        };
        Some(FlatLight {
            frame,
            outline,
            emitting,
        })
    }
}

fn extent(what: &'static str, value: f64) -> Result<(), LightError> {
    let valid = value > 0.0 && value.is_finite();
    valid
        .then_some(())
        .ok_or(LightError::NoExtent { what, value })
}

fn hard(shape: &LightShape) -> HardLight {
    let (shape, colour) = (shape.clone(), [1.0; 3]);
    crate::world::light::Light { shape, colour }.hard()
}

fn polygon_emitter(polygon: &crate::world::light::ConvexPolygon) -> Emitter {
    let centre = polygon.centroid();
    let away = |v: &DVec3| (*v - centre).length();
    let radius = polygon.vertices().iter().map(away).fold(0.0, f64::max);
    let frame = facing(centre, polygon.area_vector(), radius);
    let scale = 1.0 / (radius * radius);
    let place = |v: &DVec3| [frame.u, frame.v].map(|e| e.dot(*v - centre) * scale);
    let outline = polygon.vertices().iter().map(place).collect();
    Emitter::Polygon { frame, outline }
}

/// A frame about `centre` whose axes have length `radius` and `u x v` points
/// along `normal` (any length).
fn facing(centre: DVec3, normal: DVec3, radius: f64) -> Frame {
    let normal = normal / normal.length();
    let size = normal.abs();
    // The axis least along the normal.
    let least = (1..3).fold(0, |best, k| if size[k] < size[best] { k } else { best });
    let u = normal.cross([DVec3::X, DVec3::Y, DVec3::Z][least]);
    let u = u * (radius / u.length());
    Frame {
        centre,
        u,
        v: normal.cross(u),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::light::ConvexPolygon;

    #[test]
    fn frames_are_orthogonal_and_right_handed() {
        for n in [DVec3::X, DVec3::NEG_Y, DVec3::new(0.3, -2.0, 1e-9)] {
            let f = facing(DVec3::ONE, n, 3.0);
            assert!(f.u.dot(f.v).abs() < 1e-14 && (f.u.length() - 3.0).abs() < 1e-14);
            assert!((f.u.cross(f.v) / 9.0 - n / n.length()).length() < 1e-14);
        }
    }

    #[test]
    fn a_polygon_keeps_its_place_and_turns_left() {
        let vertices = [[0.0, 2.0, 0.0], [0.0, 2.0, 1.0], [2.0, 2.0, 0.0]].map(DVec3::from);
        for order in [[0, 1, 2], [0, 2, 1]] {
            let given = order.map(|k| vertices[k]);
            let polygon = ConvexPolygon::new(given.to_vec()).unwrap();
            let emitter = Emitter::new(&LightShape::Polygon(polygon)).unwrap();
            let light = emitter.seen_from(DVec3::ZERO).unwrap();
            for (at, vertex) in light.outline.iter().zip(given) {
                assert!((light.frame.at(*at) - vertex).length() < 1e-14);
            }
            let world = light.area() * light.frame.u.cross(light.frame.v).length();
            assert!((world - 1.0).abs() < 1e-14, "{world}");
        }
    }

    /// The disc's rim is where rays from p touch the sphere.
    #[test]
    fn a_sphere_is_seen_as_the_cross_section_of_its_cone() {
        let (centre, radius) = (DVec3::new(1.0, 4.0, -2.0), 0.7);
        let emitter = Emitter::new(&LightShape::Sphere { centre, radius }).unwrap();
        let p = DVec3::new(0.4, 2.9, -1.0);
        let frame = emitter.seen_from(p).unwrap().frame;
        for k in 0..8 {
            let (s, t) = crate::world::shape::on_circle(f64::from(k));
            let direction = frame.at([s, t]) - p;
            let nearest = direction.cross(centre - p).length() / direction.length();
            assert!((nearest - radius).abs() < 1e-14);
        }
        assert!(emitter.seen_from(centre + DVec3::X * 0.69).is_none());
        assert!(emitter.seen_from(centre).is_none());
    }

    #[test]
    fn lights_without_extent_are_refused() {
        let flat = LightShape::Rectangle {
            centre: DVec3::ZERO,
            edge_u: DVec3::X,
            edge_v: DVec3::X * 2.0,
        };
        let message = Emitter::new(&flat).unwrap_err().to_string();
        assert!(message.contains("area is 0"), "{message}");
        let dot = LightShape::Sphere {
            centre: DVec3::ZERO,
            radius: f64::NAN,
        };
        assert!(Emitter::new(&dot).is_err());
    }
}
