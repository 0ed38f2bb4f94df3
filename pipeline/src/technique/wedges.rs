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

/// How 8-bit channels that wedges add coverage to are shared: a contribution takes some bits,
/// and what is left above them is for carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CarryChannels {
    /// Bits of a contribution.
    pub bits: u32,
    /// Channels of a buffer that coverage is added to, from red on.
    pub count: usize,
}

impl CarryChannels {
    /// Contributions that fit for certain.
    pub fn capacity(self) -> u32 {
        255 / ((1 << self.bits) - 1)
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
