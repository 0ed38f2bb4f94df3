//! Light sources as data, and the point or direction that hard shadows use.

use std::sync::Arc;

use glam::DVec3;

use crate::world::error::PolygonError;

/// A light: its shape and its colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Shape and place, world space.
    pub shape: LightShape,
    /// Linear RGB intensity; 1 shades a facing white surface to 1.
    pub colour: [f32; 3],
}

/// Shape of a light, world space.
#[derive(Clone, Debug, PartialEq)]
pub enum LightShape {
    /// A point.
    Point {
        /// Its place.
        position: DVec3,
    },
    /// A parallelogram `centre + s edge_u + t edge_v`, s and t in -1/2..1/2.
    /// A square light is one with perpendicular edges of equal length.
    Rectangle {
        /// Centre.
        centre: DVec3,
        /// First edge, full length.
        edge_u: DVec3,
        /// Second edge, full length.
        edge_v: DVec3,
    },
    /// A flat convex polygon.
    Polygon(ConvexPolygon),
    /// A flat disc.
    Disc {
        /// Centre.
        centre: DVec3,
        /// Unit normal; only its line matters.
        normal: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A sphere.
    Sphere {
        /// Centre.
        centre: DVec3,
        /// Radius.
        radius: f64,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// Towards the light; any non-zero length.
        towards: DVec3,
    },
}

impl Light {
    /// A white horizontal square light of the given side, edges along +x and +z
    /// (the peers' light).
    pub fn horizontal_square(centre: DVec3, side: f64) -> Self {
        Self {
            shape: LightShape::Rectangle {
                centre,
                edge_u: DVec3::X * side,
                edge_v: DVec3::Z * side,
            },
            colour: [1.0; 3],
        }
    }

    /// What hard shadows use: the centre of the shape, or its direction.
    pub fn hard(&self) -> HardLight {
        match &self.shape {
            LightShape::Point { position } => HardLight::Point(*position),
            LightShape::Rectangle { centre, .. }
            | LightShape::Disc { centre, .. }
            | LightShape::Sphere { centre, .. } => HardLight::Point(*centre),
            LightShape::Polygon(polygon) => HardLight::Point(polygon.centroid()),
            LightShape::Directional { towards } => HardLight::Directional(*towards),
        }
    }
}

/// How far a vertex may leave the polygon's plane, and how far a corner may
/// turn the wrong way, as a share of the polygon's extent (and its square).
const FLATNESS: f64 = 1e-9;

/// A flat convex polygon in space, checked when it is made. Collinear vertices
/// are allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPolygon {
    vertices: Arc<[DVec3]>,
}

impl ConvexPolygon {
    /// A polygon through `vertices` in order, either way round (world space).
    ///
    /// # Errors
    /// Fewer than three vertices, a coordinate that is not finite, no area, a
    /// vertex off the plane, or a corner that turns the wrong way.
    pub fn new(vertices: impl Into<Arc<[DVec3]>>) -> Result<Self, PolygonError> {
        let vertices = vertices.into();
        if vertices.len() < 3 {
            let count = vertices.len();
            return Err(PolygonError::TooFewVertices { count });
        }
        if let Some(vertex) = vertices.iter().position(|v| !v.is_finite()) {
            let value = vertices[vertex].to_array();
            return Err(PolygonError::NonFinite { vertex, value });
        }
        let polygon = Self { vertices };
        polygon.check_shape()?;
        Ok(polygon)
    }

    fn check_shape(&self) -> Result<(), PolygonError> {
        let v = &self.vertices;
        let extent = v.iter().map(|p| (*p - v[0]).length()).fold(0.0, f64::max);
        let area_vector = self.area_vector();
        let area = area_vector.length();
        // Also false for NaN, from coordinates whose squares overflow.
        if !(area > FLATNESS * extent * extent && area.is_finite()) {
            return Err(PolygonError::NoArea { area });
        }
        let normal = area_vector / area;
        let mut turns = 0.0;
        for k in 0..v.len() {
            let off = normal.dot(v[k] - v[0]).abs();
            if off > FLATNESS * extent {
                return Err(PolygonError::NotFlat { vertex: k, off });
            }
            let [a, b, c] = [0, 1, 2].map(|i| v[(k + i) % v.len()]);
            let [into, out] = [b - a, c - b];
            let turn = into.cross(out).dot(normal);
            if turn < -FLATNESS * extent * extent || (turn <= 0.0 && into.dot(out) < 0.0) {
                let vertex = (k + 1) % v.len();
                return Err(PolygonError::NotConvex { vertex });
            }
            turns += libm::atan2(turn, into.dot(out));
        }
        // A star turns the right way at every corner, but more than once round.
        if turns > 1.5 * std::f64::consts::TAU {
            return Err(PolygonError::NotConvex { vertex: 0 });
        }
        Ok(())
    }

    /// The vertices in order, world space.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Normal by the right-hand rule, as long as the area.
    pub fn area_vector(&self) -> DVec3 {
        let v = &self.vertices;
        let fan = v.windows(2).map(|e| (e[0] - v[0]).cross(e[1] - v[0]));
        fan.sum::<DVec3>() * 0.5
    }

    /// Centre of area.
    pub fn centroid(&self) -> DVec3 {
        let v = &self.vertices;
        let normal = self.area_vector();
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for e in v.windows(2) {
            let [b, c] = [e[0] - v[0], e[1] - v[0]];
            let weight = b.cross(c).dot(normal);
            sum += (b + c) * (weight / 3.0);
            total += weight;
        }
        v[0] + sum / total
    }
}

/// A light without extent: the homogeneous point `(position, 1)` or `(towards, 0)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HardLight {
    /// A place in the world.
    Point(DVec3),
    /// A direction *towards* the light.
    Directional(DVec3),
}

impl HardLight {
    /// Vector from `p` towards the light; not normalised.
    pub fn towards_from(self, p: DVec3) -> DVec3 {
        match self {
            Self::Point(light) => light - p,
            Self::Directional(towards) => towards,
        }
    }

    /// Direction in which the shadow of `p` extends, `p - light` in f64; not
    /// normalised.
    pub fn shadow_direction(self, p: DVec3) -> DVec3 {
        match self {
            Self::Point(light) => p - light,
            Self::Directional(towards) => -towards,
        }
    }

    /// Whether all shadow directions are the same.
    pub fn is_directional(self) -> bool {
        matches!(self, Self::Directional(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(points: &[[f64; 2]]) -> Result<ConvexPolygon, PolygonError> {
        let lift = |p: &[f64; 2]| DVec3::new(p[0], 3.0, p[1]);
        ConvexPolygon::new(points.iter().map(lift).collect::<Vec<_>>())
    }

    #[test]
    fn hard_shadows_use_the_centre_of_area() {
        let house = flat(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 4.0]]).unwrap();
        assert!((house.area_vector().length() - 6.0).abs() < 1e-12);
        // 4 at (1, 1) and 2 at (2/3, 8/3).
        let expected = DVec3::new((4.0 + 4.0 / 3.0) / 6.0, 3.0, (4.0 + 16.0 / 3.0) / 6.0);
        assert!((house.centroid() - expected).length() < 1e-12);
        let light = Light {
            shape: LightShape::Polygon(house),
            colour: [1.0; 3],
        };
        assert!(matches!(light.hard(), HardLight::Point(p) if (p - expected).length() < 1e-12));
    }

    #[test]
    fn what_is_no_convex_polygon_is_refused() {
        use PolygonError::*;
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert!(flat(&square).is_ok());
        let midpoint = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(flat(&midpoint).is_ok(), "collinear vertices are allowed");
        assert!(matches!(
            flat(&square[..2]),
            Err(TooFewVertices { count: 2 })
        ));
        assert!(matches!(
            flat(&[[0.0, 0.0], [1.0, 0.0], [f64::NAN, 1.0]]),
            Err(NonFinite { vertex: 2, .. })
        ));
        assert!(matches!(
            flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]),
            Err(NoArea { .. })
        ));
        let dent = [[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]];
        assert!(matches!(flat(&dent), Err(NotConvex { vertex: 2 })));
        let spike = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        assert!(matches!(flat(&spike), Err(NotConvex { vertex: 1 })));
        let star: Vec<_> = (0..5u32)
            .map(|k| crate::world::shape::on_circle(f64::from(2 * k) * std::f64::consts::TAU / 5.0))
            .map(|(x, y)| [x, y])
            .collect();
        assert!(matches!(flat(&star), Err(NotConvex { .. })));
        let bent = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.1, 1.0), DVec3::Z];
        let error = ConvexPolygon::new(bent).unwrap_err();
        assert!(matches!(error, NotFlat { .. }), "{error}");
    }
}
