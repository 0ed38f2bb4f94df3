//! Wedge halves as draws (paper IV, §4.2 and §4.2.2): the outer half is taken
//! away, the inner one given back, each culled by depth and stencil on its own.
//!
//! Which half a fragment belongs to is still the shader's one predicate; the
//! halves only have to hold the pixels that it finds for them. So each is built
//! a little larger, in every direction:
//!
//! * A point of the outer half sees the light's centre past the edge, and loses a
//!   part of the light on the umbra's side of the hard plane; its half has the
//!   edge moved towards the middle of *that* part. The old half lies inside the
//!   new one, away from all its planes.
//! * The plane between the halves is tilted about the edge, into the other half.

use glam::DVec3;

use super::wedges::{AreaStatistics, WedgeArea, enlarged, longer};
use crate::geometry::area_light::AreaLight;
use crate::geometry::wedge::{Construction, Wedge, WedgeStatistics, hard_plane};
use crate::parts::passes::View;

/// How far the edge moves towards the middle of the part of the light.
const MOVED_EDGE: f64 = 1e-3;
/// By how much of the light's reach the plane between halves is tilted.
const TILT: f64 = 1e-2;
/// Reach of the light beside the hard plane, as a share of its radius, below
/// which a wedge is too thin to be split.
const THIN: f64 = 1e-3;

/// One half of a penumbra.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Half {
    /// On the umbra side of the hard shadow quad.
    Inner,
    /// On the lit side.
    Outer,
}

impl WedgeArea {
    /// The pixels that a half may touch: those of the whole wedge where there is
    /// nothing to split by.
    pub(crate) fn half(
        view: &View,
        construction: Construction,
        light: &AreaLight,
        ends: [DVec3; 2],
        half: Half,
        statistics: &mut AreaStatistics,
    ) -> Self {
        Self::try_half(view, construction, light, ends, half).unwrap_or_else(|| {
            statistics.unsplit += 1;
            Self::new(view, construction, light, ends, statistics)
        })
    }

    fn try_half(
        view: &View,
        construction: Construction,
        light: &AreaLight,
        ends: [DVec3; 2],
        half: Half,
    ) -> Option<Self> {
        let centre = light.centre();
        let normal = hard_plane(centre, ends)?.normal;
        // Where the part of the light is that the edge cuts for this half.
        let towards = match half {
            Half::Inner => normal,
            Half::Outer => -normal,
        };
        let reach = light.reach(towards);
        if reach < THIN * light.bounding_radius() {
            return None;
        }
        let middle = centre + towards * (0.4 * reach);
        let moved = longer(ends.map(|e| e + (middle - e) * MOVED_EDGE));
        let mut met = WedgeStatistics::default();
        let mut wedges = Wedge::of_edge(construction, &enlarged(light), moved, &mut met);
        let (Some(mut wedge), true, 0) = (wedges.pop(), wedges.is_empty(), met.touching_light)
        else {
            return None;
        };
        wedge.light_centre = centre - towards * (TILT * reach);
        let halves = wedge.halves()?;
        let eye = view.camera().eye;
        let (mesh, side) = match half {
            Half::Inner => (halves.inner, -halves.plane.distance(eye)),
            Half::Outer => (halves.outer, halves.plane.distance(eye)),
        };
        Self::of_mesh(view, &mesh, wedge.volume.depth(eye).min(side))
    }
}
