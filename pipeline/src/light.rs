//! Light sources as data, and the point or direction that hard shadows use.

use glam::DVec3;

/// A light: its shape and its colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Shape and place, world space.
    pub shape: LightShape,
    /// Linear RGB intensity; 1 shades a facing white surface to 1.
    pub colour: [f32; 3],
}

/// Shape of a light, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
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
        match self.shape {
            LightShape::Point { position } => HardLight::Point(position),
            LightShape::Rectangle { centre, .. }
            | LightShape::Disc { centre, .. }
            | LightShape::Sphere { centre, .. } => HardLight::Point(centre),
            LightShape::Directional { towards } => HardLight::Directional(towards),
        }
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
