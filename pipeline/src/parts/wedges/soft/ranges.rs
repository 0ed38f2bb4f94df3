//! Silhouettes of more layers than seven bits of a stencil count, in groups that they
//! do: what the groups hide is added up afterwards, at most all of the light.
//!
//! A caster that lies over itself too often is cut into pieces of its surface, each
//! with an outline of its own ([`crate::geometry::layers`] bounds how often).

use glam::DVec3;
use gnomon_shaders::split_volumes::resolve::MOST_COUNTED;

use super::edges::{Silhouettes, SoftCasters};
use crate::geometry::layers::most_layers;
use crate::geometry::outlines::{compact, pieces};
use crate::geometry::volume::ShadowVolume;
use crate::parts::volumes::stencil_ranges::groups_within;
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::HardLight;
use crate::world::mesh::Mesh;

/// Layers that a group may have.
const MOST: usize = MOST_COUNTED as usize;

impl SoftCasters<'_> {
    /// Silhouettes seen from `centre`, of all casters together as far as a count holds
    /// them.
    pub(crate) fn in_ranges(&self, centre: DVec3) -> Vec<Silhouettes> {
        let light = HardLight::Point(centre);
        let volumes: Vec<ShadowVolume> = self
            .examined
            .iter()
            .map(|e| e.caster.volume(&e.object.mesh, light))
            .collect();
        let all: Vec<&ShadowVolume> = volumes.iter().collect();
        if most_layers(light, &all) <= MOST {
            return vec![self.silhouettes(centre)];
        }
        let of_caster = |(index, volume): (usize, &ShadowVolume)| {
            let layers = most_layers(light, &[volume]);
            self.parts_of_caster(index, layers, centre)
        };
        let parts = volumes.iter().enumerate().flat_map(of_caster);
        let groups = groups_within(MOST, parts).into_iter();
        groups.map(Silhouettes::together).collect()
    }

    /// Silhouettes of each caster in parts that a count holds.
    pub(crate) fn each_in_ranges(&self, centre: DVec3) -> Vec<Silhouettes> {
        let light = HardLight::Point(centre);
        let of_caster = |index: usize| {
            let examined = &self.examined[index];
            let volume = examined.caster.volume(&examined.object.mesh, light);
            self.parts_of_caster(index, most_layers(light, &[&volume]), centre)
        };
        let parts = (0..self.examined.len()).flat_map(of_caster);
        parts.map(|(silhouettes, _)| silhouettes).collect()
    }

    fn parts_of_caster(
        &self,
        index: usize,
        layers: usize,
        centre: DVec3,
    ) -> Vec<(Silhouettes, usize)> {
        if layers <= MOST {
            return vec![(self.of_caster(index, centre), layers)];
        }
        let (examined, light) = (&self.examined[index], HardLight::Point(centre));
        let adjacency = examined.caster.adjacency();
        let orientation = examined.orientation(light);
        pieces(&examined.object.mesh, adjacency, &orientation)
            .iter()
            .flat_map(|piece| self.parts_of_piece(piece, centre))
            .collect()
    }

    /// A piece as it is, or in as many triangles as a count holds if it lies over itself
    /// more often.
    pub(super) fn parts_of_piece(&self, piece: &Mesh, centre: DVec3) -> Vec<(Silhouettes, usize)> {
        let light = HardLight::Point(centre);
        let adjacency = EdgeAdjacency::new(piece.triangles());
        let volume = ShadowVolume::generalised(piece, &adjacency, light);
        let layers = most_layers(light, &[&volume]);
        if layers <= MOST {
            return vec![(self.of_piece(piece, centre), layers)];
        }
        let chunks = piece.triangles().chunks(MOST);
        let parts = chunks.filter_map(|c| Some((compact(piece, c.to_vec())?, c.len())));
        parts
            .map(|(part, layers)| (self.of_piece(&part, centre), layers))
            .collect()
    }
}
