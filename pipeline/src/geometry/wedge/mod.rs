//! Penumbra wedges: for each silhouette edge, a convex volume with all receivers
//! whose view of an area light the edge cuts.
//!
//! | construction | light | source | encloses the penumbra |
//! | --- | --- | --- | --- |
//! | [`Construction::BoundingSphere`] | any, by its bounding sphere | paper III, §3.1 | yes |
//! | [`Construction::Tight`] | rectangle, polygon, disc; spheres as above | paper IV, §4.1 | yes |
//! | [`Construction::Exact`] | any | [`exact`] | is the penumbra itself (under round lights up to the facets at its ends) |
//! | [`paper1`] | sphere | paper I, §4.1 | no, and does not claim to |
//!
//! The first three treat every edge on its own and share one shape, [`Wedge`]; the
//! wedges of paper I share planes with their neighbours in a silhouette loop and
//! are types of their own.
//!
//! Edges are directed as in [`crate::geometry::silhouette::Silhouette`], with the occluder
//! on their left seen from the light; so `(e1 - e0) x (light - e0)` points out of
//! the umbra. All is f64; [`mesh::WedgeMesh::positions_f32`] rounds once. Nothing is
//! skipped in silence: [`WedgeStatistics`] counts whatever needed special care.

pub mod exact;
mod halves;
pub mod mesh;
pub mod paper1;
pub mod paper3;
pub mod paper4;
pub mod plane;
pub mod polyhedron;

use glam::DVec3;

pub use halves::WedgeHalves;
pub use mesh::WedgeMesh;
pub use plane::Plane;

use crate::geometry::area_light::{AreaLight, Clipped, LitEdge};
use paper3::Undefined;
use polyhedron::{Ends, Polyhedron};

/// How wedges are built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Construction {
    /// Four planes round a sphere that holds the light (paper III).
    BoundingSphere,
    /// The light reflected through both ends (paper IV).
    Tight,
    /// The penumbra volume itself.
    #[default]
    Exact,
}

/// The wedge of one silhouette edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Wedge {
    /// The part of the silhouette edge in front of the light, for visibility;
    /// the wedge's own edge may be relocated.
    pub edge: [DVec3; 2],
    /// The light's centre, where the hard shadow quad starts.
    pub light_centre: DVec3,
    /// How it was built: not as asked where that was undefined.
    pub construction: Construction,
    /// The volume.
    pub volume: Polyhedron,
}

/// What wedge construction met; counts of edges unless said otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WedgeStatistics {
    /// Edges given.
    pub edges: u64,
    /// Wedges made; at most two per edge.
    pub wedges: u64,
    /// No wedge: both ends equal.
    pub zero_length: u64,
    /// No wedge: behind a flat light, or inside a spherical one.
    pub behind_light: u64,
    /// No wedge: in a flat light's plane, beside it; covers nothing from anywhere.
    pub in_light_plane: u64,
    /// Clipped against the light or its plane.
    pub clipped: u64,
    /// Wedges that are half-spaces, because the edge touches the light.
    pub touching_light: u64,
    /// Wedges that are one end's cone: the edge's line pierces the light.
    pub stabbing_light: u64,
    /// Wedges built exactly instead: the edge points at the light's centre.
    pub aimed_at_centre: u64,
    /// Wedges built exactly instead: the moved edge's line meets the light or
    /// its bounding sphere.
    pub meets_light: u64,
}

impl Wedge {
    /// The wedges of one edge: one, two where the edge pierces a spherical
    /// light, none where it casts nothing. `statistics` counts which.
    pub fn of_edge(
        construction: Construction,
        light: &AreaLight,
        edge: [DVec3; 2],
        statistics: &mut WedgeStatistics,
    ) -> Vec<Self> {
        statistics.edges += 1;
        if edge[0] == edge[1] {
            statistics.zero_length += 1;
            return Vec::new();
        }
        let parts = match light.clip(edge) {
            Clipped::Parts(parts) => parts,
            Clipped::Behind => {
                statistics.behind_light += 1;
                return Vec::new();
            }
            Clipped::InPlane => {
                statistics.in_light_plane += 1;
                return Vec::new();
            }
        };
        statistics.clipped += u64::from(parts.iter().any(|part| part.clipped));
        statistics.wedges += parts.len() as u64;
        let wedges = parts.into_iter();
        wedges
            .map(|part| Self::of_part(construction, light, part, statistics))
            .collect()
    }

    fn of_part(
        construction: Construction,
        light: &AreaLight,
        part: LitEdge,
        statistics: &mut WedgeStatistics,
    ) -> Self {
        let (construction, ends) = match part.touch {
            Some(touch) => {
                statistics.touching_light += 1;
                (Construction::Exact, half_space(light, touch))
            }
            None => build(construction, light, part.ends, statistics),
        };
        Self {
            edge: part.ends,
            light_centre: light.centre(),
            construction,
            volume: Polyhedron::new(ends),
        }
    }

    /// The plane of the hard shadow quad, positive outside the umbra: it splits
    /// the wedge into an outer and an inner half. `None` when the edge points at
    /// the light's centre; then it covers nothing.
    pub fn hard_plane(&self) -> Option<Plane> {
        hard_plane(self.light_centre, self.edge)
    }

    /// The hard shadow quad as homogeneous vertices: the edge, then the
    /// directions from the light's centre through its ends, not normalised. Drawn
    /// as `[1, 0, 2]` and `[1, 2, 3]` it is the quad of
    /// [`crate::geometry::volume::ShadowVolume`] to the bit, facing out of the umbra.
    pub fn hard_quad(&self) -> [glam::DVec4; 4] {
        let [e0, e1] = self.edge;
        let away = self.edge.map(|e| (e - self.light_centre).extend(0.0));
        [e0.extend(1.0), e1.extend(1.0), away[0], away[1]]
    }
}

/// The plane through the light's centre and the edge, positive outside the umbra.
pub(crate) fn hard_plane(light_centre: DVec3, [e0, e1]: [DVec3; 2]) -> Option<Plane> {
    // Through the end nearer to the light, for the better conditioned product.
    let [d0, d1] = [e0, e1].map(|e| (e - light_centre).length_squared());
    let point = if d0 <= d1 { e0 } else { e1 };
    Plane::spanned(point, e1 - e0, light_centre - point)
}

/// All that a light seen through a point of itself can reach.
fn half_space(light: &AreaLight, touch: DVec3) -> Ends {
    let outwards = || (touch - light.centre()).normalize_or(DVec3::Z);
    Ends::HalfSpace(Plane {
        normal: light.normal().unwrap_or_else(outwards),
        point: touch,
    })
}

fn build(
    construction: Construction,
    light: &AreaLight,
    edge: [DVec3; 2],
    statistics: &mut WedgeStatistics,
) -> (Construction, Ends) {
    let tried = match construction {
        Construction::BoundingSphere => {
            Some(paper3::ends(light.centre(), light.bounding_radius(), edge))
        }
        Construction::Tight => Some(paper4::ends(light, edge)),
        Construction::Exact => None,
    };
    match tried {
        Some(Ok(ends)) => return (construction, ends),
        Some(Err(Undefined::AimedAtCentre)) => statistics.aimed_at_centre += 1,
        Some(Err(Undefined::MeetsLight)) => statistics.meets_light += 1,
        None => {}
    }
    let ends = exact::ends(light, edge);
    statistics.stabbing_light += u64::from(matches!(ends, Ends::One(_)));
    (Construction::Exact, ends)
}
