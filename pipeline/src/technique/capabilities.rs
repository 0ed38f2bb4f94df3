//! What a technique can do and what it needs, apart from its parameters.

use crate::world::light::LightShape;

/// What shadows look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowKind {
    /// There are none.
    None,
    /// Of the light's centre, with sharp edges.
    Hard,
    /// Of the light's extent, with penumbrae.
    Soft,
}

/// Where shadows come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Nowhere: a picture without shadows.
    Nothing,
    /// Volumes and wedges of silhouettes: casters are closed, or asked for with
    /// `open-casters=generalised`.
    Silhouettes,
    /// Pictures taken from the light: any mesh casts.
    LightViews,
    /// Rays to the light: any mesh casts.
    Rays,
    /// Other techniques, whose needs are its own.
    Techniques,
}

/// Penumbra wedges that a technique builds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WedgeUse {
    /// None.
    None,
    /// Of each silhouette edge on its own.
    Single,
    /// Linked along silhouette loops.
    Linked,
}

/// Kinds of lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightKinds {
    /// Points.
    pub points: bool,
    /// Parallel light.
    pub directions: bool,
    /// Rectangles.
    pub rectangles: bool,
    /// Discs.
    pub discs: bool,
    /// Spheres.
    pub spheres: bool,
    /// Convex polygons.
    pub polygons: bool,
}

impl LightKinds {
    /// All kinds.
    pub const ALL: Self = Self {
        points: true,
        directions: true,
        rectangles: true,
        discs: true,
        spheres: true,
        polygons: true,
    };

    /// Whether `shape` is one of them.
    pub fn contains(&self, shape: &LightShape) -> bool {
        match shape {
            LightShape::Point { .. } => self.points,
            LightShape::Directional { .. } => self.directions,
            LightShape::Rectangle { .. } => self.rectangles,
            LightShape::Disc { .. } => self.discs,
            LightShape::Sphere { .. } => self.spheres,
            LightShape::Polygon(_) => self.polygons,
        }
    }
}

/// What a technique can do and what it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// What its shadows look like, for lights with an extent.
    pub shadows: ShadowKind,
    /// Where they come from.
    pub source: Source,
    /// Wedges that it builds.
    pub wedges: WedgeUse,
    /// Lights that it takes; it refuses others.
    pub lights: LightKinds,
}

impl Capabilities {
    /// No shadows of any light.
    pub const UNSHADOWED: Self = Self {
        shadows: ShadowKind::None,
        source: Source::Nothing,
        wedges: WedgeUse::None,
        lights: LightKinds::ALL,
    };

    /// Hard or soft shadows of any light, looked up in light views.
    pub const fn of_light_views(shadows: ShadowKind) -> Self {
        Self {
            shadows,
            source: Source::LightViews,
            ..Self::UNSHADOWED
        }
    }

    /// Hard or soft shadows of any light by rays.
    pub const fn of_rays(shadows: ShadowKind) -> Self {
        Self {
            shadows,
            source: Source::Rays,
            ..Self::UNSHADOWED
        }
    }

    /// Hard or soft shadows of any light by volumes of silhouettes.
    pub const fn of_silhouettes(shadows: ShadowKind) -> Self {
        Self {
            shadows,
            source: Source::Silhouettes,
            ..Self::UNSHADOWED
        }
    }

    /// Whether it draws pictures from the light.
    pub fn uses_light_views(&self) -> bool {
        self.source == Source::LightViews
    }

    /// Whether it refuses casters that are not closed, unless asked otherwise.
    pub fn needs_closed_casters(&self) -> bool {
        self.source == Source::Silhouettes
    }

    /// Whether it builds penumbra wedges.
    pub fn has_wedges(&self) -> bool {
        self.wedges != WedgeUse::None
    }
}
