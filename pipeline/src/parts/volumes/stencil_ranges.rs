//! More overlapping volumes than an 8-bit stencil counts.
//!
//! A stencil that wraps takes 256 volumes for light. Where more than 255 may overlap
//! ([`crate::geometry::layers`] bounds how many), volumes are drawn in groups of which no point
//! is in more than 127: they count in seven bits, and after each group one triangle
//! over the screen turns what is not 0 into the eighth, which stays. A caster that
//! exceeds that alone is cut into pieces of its surface, each with a closed volume of
//! its own, so that the result is exact however often a solid lies over itself.

use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthStencilState, PrimitiveState, StencilFaceState,
    StencilOperation, StencilState,
};
use gnomon_raster::{Draw, RenderPipeline};
use gnomon_shaders::transform::FullScreen;

use crate::choices;
use crate::geometry::layers::most_layers;
use crate::geometry::outlines::{compact, piece_triangles};
use crate::geometry::volume::ShadowVolume;
use crate::parts::casters::Examined;
use crate::parts::visibility::full_screen;
use crate::technique::{Param, Warning};
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::HardLight;
use crate::world::mesh::Mesh;

choices! {
    /// What is done about more volumes than a stencil counts.
    pub(crate) enum Overflow {
        /// They are counted in ranges.
        Ranges = "ranges",
        /// The stencil wraps.
        Wrap = "wrap",
    }
}

pub(crate) const OVERFLOW: Param<Overflow> = Param::choice(
    "overflow",
    Overflow::Ranges.word(),
    "where more than 255 volumes may overlap: count them in ranges, or wrap, 256 being light",
);

/// The most that an 8-bit stencil tells apart from 0.
pub(crate) const CAPACITY: usize = 255;
/// The most in one range.
const RANGE: usize = 127;
/// Set where a range before was not 0.
const SHADOWED: u8 = 0x80;

/// A volume and the most layers that it has.
type Part = (ShadowVolume, usize);

/// The volume of one caster in parts that each fit into a range.
pub(crate) fn parts(examined: &Examined<'_>, whole: ShadowVolume, light: HardLight) -> Vec<Part> {
    let layers = most_layers(light, &[&whole]);
    if layers <= RANGE {
        return vec![(whole, layers)];
    }
    let mesh = &examined.object.mesh;
    let orientation = examined.orientation(light);
    let pieces = piece_triangles(mesh, examined.caster.adjacency(), &orientation).into_iter();
    let chunks = pieces.flat_map(|piece| chunks(mesh, piece, light));
    packed(chunks)
        .into_iter()
        .filter_map(|(triangles, layers)| Some((volume_of(mesh, triangles, light)?, layers)))
        .collect()
}

/// Items in groups, in order, of which each has at most 127 layers unless one item
/// alone has more.
pub(crate) fn groups<T>(items: impl IntoIterator<Item = (T, usize)>) -> Vec<Vec<T>> {
    groups_within(RANGE, items)
}

/// The same with at most `most` layers.
pub(crate) fn groups_within<T>(
    most: usize,
    items: impl IntoIterator<Item = (T, usize)>,
) -> Vec<Vec<T>> {
    let (mut groups, mut used): (Vec<Vec<T>>, usize) = (Vec::new(), usize::MAX);
    for (item, layers) in items {
        match groups.last_mut() {
            Some(group) if used + layers <= most => {
                group.push(item);
                used += layers;
            }
            _ => {
                groups.push(vec![item]);
                used = layers;
            }
        }
    }
    groups
}

/// Counting in the seven bits of a range only.
pub(crate) fn in_range(mut state: DepthStencilState) -> DepthStencilState {
    for face in [&mut state.stencil.front, &mut state.stencil.back] {
        face.write_mask = !SHADOWED;
    }
    state
}

/// Keeps where a range is not 0, and empties it; for a pass with colour attachments
/// `color`, of which none is written.
pub(crate) fn end_of_range(color: &[ColorTargetState]) -> Draw {
    let face = StencilFaceState {
        compare: CompareFunction::NotEqual,
        pass_op: StencilOperation::Replace,
        read_mask: !SHADOWED,
        ..StencilFaceState::IGNORE
    };
    let pipeline = RenderPipeline {
        label: "end of range".into(),
        vertex: FullScreen.stage(),
        fragment: None,
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState {
            stencil: StencilState {
                front: face,
                back: face,
            },
            ..DepthStencilState::default()
        },
        color_targets: color.to_vec(),
    };
    Draw {
        // In the seven bits it is 0, to which the stencil is compared.
        stencil_reference: [SHADOWED; 2],
        ..full_screen(pipeline, Vec::new())
    }
}

/// Says that so many layers do not fit, and what became of them.
pub(crate) fn warning(light: usize, layers: usize, wraps: bool) -> Warning {
    let what = if wraps {
        "overflow=wrap lets it wrap, and 256 volumes count as light"
    } else {
        "they are counted in ranges, and the stencil then tells shadow from light only"
    };
    Warning {
        code: "stencil-overflow",
        count: layers,
        message: format!(
            "light {light}: more volumes may overlap than the 255 of an 8-bit stencil; {what}"
        ),
    }
}

/// A piece as it is, or in as many triangles as a range holds if it lies over itself
/// more often.
fn chunks(mesh: &Mesh, piece: Vec<[u32; 3]>, light: HardLight) -> Vec<(Vec<[u32; 3]>, usize)> {
    let Some(volume) = volume_of(mesh, piece.clone(), light) else {
        return Vec::new();
    };
    let layers = most_layers(light, &[&volume]);
    if layers <= RANGE {
        return vec![(piece, layers)];
    }
    let chunks = piece.chunks(RANGE);
    chunks.map(|c| (c.to_vec(), c.len())).collect()
}

/// Lists of triangles joined as far as a range holds them.
fn packed(lists: impl Iterator<Item = (Vec<[u32; 3]>, usize)>) -> Vec<(Vec<[u32; 3]>, usize)> {
    let with_layers = lists.map(|(triangles, layers)| ((triangles, layers), layers));
    let join = |group: Vec<(Vec<[u32; 3]>, usize)>| {
        let layers = group.iter().map(|(_, n)| n).sum();
        let triangles = group.into_iter().flat_map(|(t, _)| t).collect();
        (triangles, layers)
    };
    groups(with_layers).into_iter().map(join).collect()
}

/// The volume of some of a mesh's triangles.
fn volume_of(mesh: &Mesh, triangles: Vec<[u32; 3]>, light: HardLight) -> Option<ShadowVolume> {
    let part = compact(mesh, triangles)?;
    let adjacency = EdgeAdjacency::new(part.triangles());
    Some(ShadowVolume::generalised(&part, &adjacency, light))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_hold_a_range_each() {
        let grouped = groups([
            (0, 100),
            (1, 27),
            (2, 1),
            (3, 127),
            (4, 500),
            (5, 0),
            (6, 3),
        ]);
        assert_eq!(grouped, [vec![0, 1], vec![2], vec![3], vec![4], vec![5, 6]]);
        assert_eq!(groups::<u8>([]), Vec::<Vec<u8>>::new());
    }
}
