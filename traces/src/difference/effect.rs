//! Where two frames first draw something different: the draw, the tile, the pixels.

use std::collections::BTreeMap;

use gnomon_raster::{Error, Gpu, GpuConfig, Recording, RenderPass};

use super::align::Pair;
use super::image::{Aspect, Image};
use super::state::Alignment;
use crate::hashes::DrawHashes;
use crate::prefix::until;
use crate::run::draw;

/// Side of a tile of [`DrawHashes`] in pixels.
const TILE: u32 = 64;

/// Where two frames first differ in what they drew.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstDifference {
    /// Pass and draw in the first frame and in the second; `None` where the draw is in
    /// one frame only.
    pub draws: [Option<[usize; 2]>; 2],
    /// Labels of the pass and of the draw.
    pub labels: [String; 2],
    /// Column and row of the first tile of 64×64 pixels that differs.
    pub tile: [u16; 2],
    /// How the attachments differ in that tile after the draw.
    pub attachments: Vec<AttachmentDifference>,
}

/// How an attachment differs in a tile.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachmentDifference {
    /// Its texture's label.
    pub label: String,
    /// `color`, `depth` or `stencil`.
    pub aspect: &'static str,
    /// Number of pixels that differ.
    pub pixels: usize,
    /// The first of them, column and row.
    pub first: [u32; 2],
    /// What it holds in both frames, raw.
    pub values: [[u32; 4]; 2],
}

/// A draw of two frames, or of one.
type Place = [Option<[usize; 2]>; 2];

/// Finds where the frames of `a` and `b` first differ in what they drew, and how; `None`
/// where every draw left the same behind, and there are the same draws. Draws that wrote
/// nothing do not count.
///
/// # Errors
/// What the GPU refuses.
pub fn first_difference(
    frames: [&Recording; 2],
    hashes: [&DrawHashes; 2],
    config: GpuConfig,
) -> Result<Option<FirstDifference>, Error> {
    let mut places = draws_side_by_side(frames).into_iter();
    let found = places.find_map(|place| Some((place, differing_tile(hashes, place)?)));
    let Some((place, tile)) = found else {
        return Ok(None);
    };
    let after = [0, 1].map(|side| place[side].map(|at| state_after(frames[side], at, config)));
    let [a, b] = after;
    let attachments = match (a.transpose()?, b.transpose()?) {
        (Some(a), Some(b)) => differing_attachments(&a, &b, tile)?,
        _ => Vec::new(),
    };
    let of = if place[0].is_some() { 0 } else { 1 };
    let [pass, draw] = place[of].expect("one of both");
    let pass = &frames[of].list.passes[pass];
    Ok(Some(FirstDifference {
        draws: place,
        labels: [pass.label.clone(), pass.draws[draw].label.clone()],
        tile,
        attachments,
    }))
}

/// The draws of both frames in their order, those with one label in aligned passes side by
/// side.
fn draws_side_by_side(frames: [&Recording; 2]) -> Vec<Place> {
    let mut places = Vec::new();
    for (pass, draws) in Alignment::of(frames[0], frames[1]).passes {
        match pass {
            Pair::Both(i, j) => places.extend(draws.into_iter().map(|d| match d {
                Pair::Both(k, l) => [Some([i, k]), Some([j, l])],
                Pair::First(k) => [Some([i, k]), None],
                Pair::Second(l) => [None, Some([j, l])],
            })),
            Pair::First(i) => places.extend(all_draws(frames[0], i).map(|at| [Some(at), None])),
            Pair::Second(j) => places.extend(all_draws(frames[1], j).map(|at| [None, Some(at)])),
        }
    }
    places
}

fn all_draws(of: &Recording, pass: usize) -> impl Iterator<Item = [usize; 2]> {
    let count = of.list.passes[pass].draws.len();
    (0..count).map(move |draw| [pass, draw])
}

/// The first tile, in rows, that a draw left different.
fn differing_tile(hashes: [&DrawHashes; 2], place: Place) -> Option<[u16; 2]> {
    let tiles = [0, 1].map(|side| place[side].and_then(|[p, d]| hashes[side].tiles(p, d)));
    let [a, b] = tiles;
    let known = a.into_iter().chain(b).flat_map(|t| t.keys());
    let hash = |tiles: Option<&BTreeMap<[u16; 2], u64>>, at: &[u16; 2]| {
        tiles.and_then(|t| t.get(at)).copied()
    };
    let differing = known.filter(|at| hash(a, at) != hash(b, at));
    differing.min_by_key(|at| (at[1], at[0])).copied()
}

/// A GPU as it is right after a draw, and the pass that the draw is in.
struct After<'a> {
    gpu: Gpu,
    pass: &'a RenderPass,
}

fn state_after(frame: &Recording, at: [usize; 2], config: GpuConfig) -> Result<After<'_>, Error> {
    let (gpu, _) = draw(frame, &until(&frame.list, at), config)?;
    let pass = &frame.list.passes[at[0]];
    Ok(After { gpu, pass })
}

impl After<'_> {
    /// Depth, stencil and colours of the pass, with their textures' labels.
    fn images(&self) -> Result<Vec<(String, Aspect, Image)>, Error> {
        let depth = self.pass.depth_stencil.iter();
        let depth = depth.flat_map(|a| {
            [Aspect::Depth, Aspect::Stencil].map(|aspect| (a.texture, a.subresource, aspect))
        });
        let color = self.pass.color.iter();
        let color = color.map(|a| (a.texture, a.subresource, Aspect::Color));
        let read = |(id, image, aspect)| {
            let label = self.gpu.texture(id)?.descriptor().label.clone();
            Ok((label, aspect, Image::read(&self.gpu, id, image, aspect)?))
        };
        depth.chain(color).map(read).collect()
    }
}

fn differing_attachments(
    a: &After<'_>,
    b: &After<'_>,
    tile: [u16; 2],
) -> Result<Vec<AttachmentDifference>, Error> {
    let in_tile = |pixel: [u32; 2]| pixel.map(|p| p / TILE) == tile.map(u32::from);
    let mut found = Vec::new();
    for ((label, aspect, a), (_, _, b)) in a.images()?.into_iter().zip(b.images()?) {
        let mut differing = a.differing(&b).filter(|(pixel, _)| in_tile(*pixel));
        if let Some((first, values)) = differing.next() {
            found.push(AttachmentDifference {
                label,
                aspect: aspect.name(),
                pixels: 1 + differing.count(),
                first,
                values,
            });
        }
    }
    Ok(found)
}
