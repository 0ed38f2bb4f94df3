//! The penumbra wedges that a technique builds for a scene, to be looked at.

use crate::geometry::wedge::{Construction, WedgeMesh};

/// How a technique's wedges are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WedgeKind {
    /// Each edge on its own (papers III and IV, and the exact penumbra).
    Single(Construction),
    /// Linked along silhouette loops (papers I and II).
    Linked,
}

impl WedgeKind {
    /// In a few words, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single(Construction::Exact) => "exact",
            Self::Single(Construction::BoundingSphere) => "round a sphere, paper III",
            Self::Single(Construction::Tight) => "tight, paper IV",
            Self::Linked => "linked, paper I",
        }
    }
}

/// Wedges of all lights that shine.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneWedges {
    /// How they are built.
    pub kind: WedgeKind,
    /// Closed meshes, world space, light after light.
    pub meshes: Vec<WedgeMesh>,
}
