//! What shaders read of casters and lights.

use glam::DVec3;
use gnomon_raster::{Recording, TextureId};
use gnomon_shaders::line_samples::KIND_STEP;
use gnomon_shaders::shadow_rays::Table;

use crate::geometry::line_sampling::edges::{ContourEdge, Facet, Jump, NONE};
use crate::geometry::line_sampling::lists::BlockLists;
use crate::geometry::line_sampling::patches::Plane;
use crate::parts::hierarchy::{self, Node};
use crate::parts::tables::{image, table};
use crate::parts::view::View;
use crate::technique::TechniqueError;
use crate::world::mesh::narrow;

/// A texture and how its texels lie.
pub(super) type Kept = (TextureId, Table);

/// Most planes: numbers and kinds of edges share the digits of a float.
pub(super) const MOST_PLANES: usize = KIND_STEP as usize - 8;

/// What edges and planes are relative to.
#[derive(Clone, Copy)]
pub(super) struct SourceFrame {
    /// World space.
    pub(super) origin: DVec3,
    pub(super) axes: [DVec3; 3],
}

impl SourceFrame {
    pub(super) fn direction(&self, d: DVec3) -> DVec3 {
        DVec3::from_array(self.axes.map(|a| a.dot(d)))
    }

    fn point(&self, p: DVec3) -> [f32; 3] {
        narrow(self.direction(p - self.origin))
    }

    fn plane(&self, plane: &Plane) -> [f32; 4] {
        let [x, y, z] = narrow(self.direction(plane.normal));
        [x, y, z, plane.height(self.origin) as f32]
    }
}

/// Edges, four texels each, and behind them all planes; the number of the first of those.
pub(super) fn edges(
    frame: &SourceFrame,
    edges: &[ContourEdge],
    planes: &[Plane],
    recording: &mut Recording,
) -> Result<(Kept, u32), TechniqueError> {
    let planes: Vec<[f32; 4]> = planes.iter().map(|p| frame.plane(p)).collect();
    let of_edge = |e: &ContourEdge| {
        let [a, b] = e.patches;
        let kind = match e.jump {
            Jump::Facing => 0.0,
            Jump::Both => 1.0,
            Jump::Lone => 2.0,
        };
        let [from, to] = e.ends.map(|end| frame.point(end));
        let other = if b == NONE { -2.0 } else { b as f32 };
        let nothing = [0.0, 0.0, 0.0, -1.0];
        [
            [from[0], from[1], from[2], a as f32 + kind * KIND_STEP],
            [to[0], to[1], to[2], other],
            planes[a as usize],
            planes.get(b as usize).copied().unwrap_or(nothing),
        ]
    };
    let mut texels: Vec<[f32; 4]> = edges.iter().flat_map(of_edge).collect();
    let first = texels.len() as u32;
    texels.extend(planes);
    Ok((table("edges", texels, recording)?, first))
}

/// Where each block's list is, and the lists; and the list of all edges, where blocks are
/// not to leave any out.
pub(super) struct Lists {
    pub(super) blocks: TextureId,
    pub(super) lists: Kept,
    pub(super) all: [u32; 2],
    /// Bytes of both.
    pub(super) bytes: usize,
}

/// Four numbers of edges a texel, from 1 on; lists begin with a texel.
pub(super) fn lists(
    lists: &BlockLists,
    all: Option<usize>,
    recording: &mut Recording,
) -> Result<Lists, TechniqueError> {
    let mut entries: Vec<[f32; 4]> = Vec::with_capacity(lists.len() / 3);
    let push = |entries: &mut Vec<[f32; 4]>, numbers: &mut dyn Iterator<Item = u32>| {
        let first = entries.len();
        let mut count = 0;
        for number in numbers {
            if count % 4 == 0 {
                entries.push([0.0; 4]);
            }
            if let Some(last) = entries.last_mut() {
                last[count % 4] = (number + 1) as f32;
            }
            count += 1;
        }
        [first as u32, count as u32]
    };
    let count = (lists.size[0] * lists.size[1]) as usize;
    let blocks: Vec<[f32; 4]> = (0..count)
        .map(|block| {
            let own = &mut lists.of(block).iter().copied();
            let [first, count] = push(&mut entries, own);
            [first as f32, count as f32, 0.0, 0.0]
        })
        .collect();
    let all = all.map_or([0, 0], |n| push(&mut entries, &mut (0..n as u32)));
    let bytes = 16 * (entries.len() + blocks.len());
    Ok(Lists {
        blocks: image("blocks", lists.size, &blocks, recording)?,
        lists: table("lists", entries, recording)?,
        all,
        bytes,
    })
}

/// Boxes over the facets, and these.
pub(super) struct Boxes {
    pub(super) nodes: Kept,
    pub(super) facets: Kept,
    pub(super) count: u32,
}

pub(super) fn boxes(
    facets: &[Facet],
    view: &View,
    recording: &mut Recording,
) -> Result<Boxes, TechniqueError> {
    let corners = |f: &Facet| f.corners.map(|p| narrow(view.relative(p)));
    let triangles: Vec<_> = facets.iter().map(corners).collect();
    let nodes = hierarchy::build(&triangles);
    let texels = facets.iter().zip(&triangles).flat_map(|(facet, corners)| {
        let both = if facet.both { 1.0 } else { 0.0 };
        let last = [facet.patch as f32, both, 0.0];
        [0, 1, 2].map(|k| {
            let [x, y, z] = corners[k];
            [x, y, z, last[k]]
        })
    });
    Ok(Boxes {
        count: nodes.len() as u32,
        facets: table("facets", texels.collect(), recording)?,
        nodes: table(
            "boxes",
            nodes.iter().flat_map(Node::texels).collect(),
            recording,
        )?,
    })
}
