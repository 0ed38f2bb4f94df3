//! Where two frames first draw something different: the draw, the tile, the pixels.

use std::collections::BTreeMap;

use gnomon_raster::{Error, Format, GpuConfig, Recording, Subresource, TextureId};

use super::align::Pair;
use super::image::{Aspect, Image};
use super::state::Alignment;
use crate::hashes::DrawHashes;
use crate::walk::Walk;

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
    /// How the attachments differ in that tile after the draw; nothing where the draw is in
    /// one frame only.
    pub attachments: Vec<AttachmentDifference>,
}

/// How an attachment differs in a tile.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachmentDifference {
    /// Its texture's label.
    pub label: String,
    /// Its texture's format.
    pub format: Format,
    /// In both frames, the texture, and which of its images.
    pub images: [(TextureId, Subresource); 2],
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

/// Finds where two frames first differ in what they drew, and how; `None` where every draw
/// left the same behind, and there are the same draws. Draws that wrote nothing do not
/// count, nor does which blocks a draw wrote where it left the same in all.
///
/// # Errors
/// What the GPU refuses.
pub fn first_difference(
    frames: [&Recording; 2],
    hashes: [&DrawHashes; 2],
    config: GpuConfig,
) -> Result<Option<FirstDifference>, Error> {
    let mut walks = [
        Walk::start(frames[0], config)?,
        Walk::start(frames[1], config)?,
    ];
    for place in draws_side_by_side(frames) {
        let Some(written) = differing_tile(hashes, place) else {
            continue;
        };
        let (tile, attachments) = match place {
            [Some(a), Some(b)] => {
                let [first, second] = &mut walks;
                let sides = [images_after(first, a)?, images_after(second, b)?];
                match first_differing_tile(&sides) {
                    Some(tile) => (tile, differing_attachments(&sides, tile)),
                    None => continue,
                }
            }
            _ => (written, Vec::new()),
        };
        return Ok(Some(FirstDifference {
            draws: place,
            labels: labels(frames, place),
            tile,
            attachments,
        }));
    }
    Ok(None)
}

/// Of the pass and of the draw.
fn labels(frames: [&Recording; 2], place: Place) -> [String; 2] {
    let of = if place[0].is_some() { 0 } else { 1 };
    let [pass, draw] = place[of].expect("one of both");
    let pass = &frames[of].list.passes[pass];
    [pass.label.clone(), pass.draws[draw].label.clone()]
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

/// An aspect of an attachment.
struct Attached {
    label: String,
    format: Format,
    image: (TextureId, Subresource),
    aspect: Aspect,
    texels: Image,
}

/// Depth, stencil and colours of the pass that a draw is in, right after the draw.
fn images_after(walk: &mut Walk<'_>, at: [usize; 2]) -> Result<Vec<Attached>, Error> {
    let pass = walk.reach(at)?;
    let depth = pass.depth_stencil.iter();
    let depth = depth.flat_map(|a| {
        [Aspect::Depth, Aspect::Stencil].map(|aspect| (a.texture, a.subresource, aspect))
    });
    let color = pass.color.iter();
    let color = color.map(|a| (a.texture, a.subresource, Aspect::Color));
    let read = |(id, image, aspect)| {
        let texture = walk.gpu.texture(id)?.descriptor();
        Ok(Attached {
            label: texture.label.clone(),
            format: texture.format,
            image: (id, image),
            aspect,
            texels: Image::read(&walk.gpu, id, image, aspect)?,
        })
    };
    depth.chain(color).map(read).collect()
}

fn side_by_side(sides: &[Vec<Attached>; 2]) -> impl Iterator<Item = (&Attached, &Attached)> {
    sides[0].iter().zip(&sides[1])
}

/// The first tile, in rows, in which any attachment differs.
fn first_differing_tile(sides: &[Vec<Attached>; 2]) -> Option<[u16; 2]> {
    let differing = side_by_side(sides).flat_map(|(a, b)| a.texels.differing(&b.texels));
    let tiles = differing.map(|(pixel, _)| pixel.map(|p| (p / TILE) as u16));
    tiles.min_by_key(|[x, y]| (*y, *x))
}

fn differing_attachments(sides: &[Vec<Attached>; 2], tile: [u16; 2]) -> Vec<AttachmentDifference> {
    let in_tile = |pixel: [u32; 2]| pixel.map(|p| p / TILE) == tile.map(u32::from);
    let difference = |(a, b): (&Attached, &Attached)| {
        let differing = a.texels.differing(&b.texels);
        let mut differing = differing.filter(|(pixel, _)| in_tile(*pixel));
        let (first, values) = differing.next()?;
        Some(AttachmentDifference {
            label: a.label.clone(),
            format: a.format,
            images: [a.image, b.image],
            aspect: a.aspect.name(),
            pixels: 1 + differing.count(),
            first,
            values,
        })
    };
    side_by_side(sides).filter_map(difference).collect()
}
