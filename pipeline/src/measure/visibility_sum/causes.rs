//! Why the sum of edges is not the truth.
//!
//! The sum may as well be taken over triangles: as seen from a receiver, every triangle
//! that faces the light's centre hides its share of the light; shares add up, and those of
//! triangles whose other side the receiver sees are taken away. Beside what the same
//! triangles hide together, and what all hide, the difference has a cause.

use glam::DVec3;

use super::SumError;
use crate::geometry::silhouette::light_facing;
use crate::truth::oracle::area::{AreaOracle, Workspace};
use crate::truth::oracle::surfaces::Receiver;
use crate::world::scene::Scene;

/// What makes most of an error of soft shadow volumes (docs/papers.md, paper III).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// Shares that are hidden twice count twice: too dark.
    Overlap,
    /// Shares are taken away that nothing had hidden, behind surfaces that turn away from
    /// a part of the light: too bright. A single silhouette is not that of all points of
    /// the light.
    TakenAway,
    /// Silhouettes from other points of the light hide more: too bright.
    OtherSilhouettes,
}

/// Corners, bit by bit.
type Key = [[u64; 3]; 3];

fn key(corners: &[DVec3; 3]) -> Key {
    corners.map(|p| p.to_array().map(f64::to_bits))
}

/// The triangles that face the centre of a light.
#[derive(Clone, Debug)]
pub struct Causes {
    /// What each hides, one by one.
    each: Vec<([DVec3; 3], AreaOracle)>,
    /// Corners of all, sorted, to find a facet among them.
    keys: Vec<Key>,
    /// What they hide together.
    all: AreaOracle,
    /// Nothing, so that only a receiver's own facet hides.
    none: AreaOracle,
}

impl Causes {
    /// Prepares the casters of `scene` for light number `light`.
    ///
    /// # Errors
    /// There is no such light, or it has no extent where it should.
    pub fn new(scene: &Scene, light: usize) -> Result<Self, SumError> {
        let count = scene.lights.len();
        let source = scene.lights.get(light);
        let source = source.ok_or(SumError::NoSuchLight { light, count })?;
        let mut triangles = Vec::new();
        for object in scene.casters() {
            let facing = light_facing(&object.mesh, source.hard());
            let lit = (0..facing.len()).filter(|t| facing[*t]);
            triangles.extend(lit.map(|t| object.mesh.corners(t)));
        }
        let kind = super::kind_of(&source.shape);
        let of = |triangles: &[[DVec3; 3]]| {
            AreaOracle::of_triangles(triangles, &source.shape)
                .map_err(|_| SumError::Light { light, kind })
        };
        let each = triangles.iter().map(|t| Ok((*t, of(&[*t])?)));
        let mut keys: Vec<Key> = triangles.iter().map(key).collect();
        keys.sort_unstable();
        Ok(Self {
            keys,
            each: each.collect::<Result<_, SumError>>()?,
            all: of(&triangles)?,
            none: of(&[])?,
        })
    }

    /// The receiver as one whose own facet, `own`, is among these, or is not.
    fn on_own(&self, receiver: &Receiver, own: &[DVec3; 3]) -> Receiver {
        let is_lit = self.is_lit(own);
        // Not the number of any triangle: all others are asked.
        receiver.with_caster(is_lit.then_some(u32::MAX))
    }

    fn is_lit(&self, own: &[DVec3; 3]) -> bool {
        self.keys.binary_search(&key(own)).is_ok()
    }

    /// The papers' sum, taken over triangles and not clamped, for a receiver on the facet
    /// `own`.
    ///
    /// # Panics
    /// The receiver is free: no point of a facet.
    pub fn summed(&self, receiver: &Receiver, own: &[DVec3; 3]) -> f64 {
        let mut sum = 1.0;
        if self.is_lit(own) {
            // All that is behind its plane, which the receiver is too near to see.
            let hidden = 1.0 - self.none.visibility(&self.on_own(receiver, own));
            let [a, b, c] = *own;
            let facing = receiver.normal.expect("a point of a facet");
            let behind = (b - a).cross(c - a).dot(facing) < 0.0;
            sum -= if behind { hidden } else { -hidden };
        }
        let near = self.all.near(receiver.point, &mut Workspace::default());
        let near = near.unwrap_or_else(|| (0..self.each.len() as u32).collect());
        for (corners, oracle) in near.iter().map(|i| &self.each[*i as usize]) {
            if corners != own {
                sum -= signed_share(corners, oracle, receiver.point);
            }
        }
        sum
    }

    /// Visibility behind what these triangles hide together.
    pub fn united(&self, receiver: &Receiver, own: &[DVec3; 3]) -> f64 {
        self.all.visibility(&self.on_own(receiver, own))
    }

    /// What makes most of the difference between the sum and `truth`.
    ///
    /// # Panics
    /// As [`Causes::summed`].
    pub fn of(&self, receiver: &Receiver, own: &[DVec3; 3], truth: f64) -> Cause {
        let summed = self.summed(receiver, own).clamp(0.0, 1.0);
        let united = self.united(receiver, own);
        if (summed - united).abs() < (united - truth).abs() {
            Cause::OtherSilhouettes
        } else if summed < united {
            Cause::Overlap
        } else {
            Cause::TakenAway
        }
    }
}

/// What a triangle hides of the light; negative where its other side is seen.
fn signed_share(corners: &[DVec3; 3], oracle: &AreaOracle, point: DVec3) -> f64 {
    let [a, b, c] = *corners;
    let hidden = 1.0 - oracle.visibility(&Receiver::free(point));
    let behind = (b - a).cross(c - a).dot(point - a) < 0.0;
    if behind { hidden } else { -hidden }
}
