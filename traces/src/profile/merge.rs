//! Which passes a tiler can draw in one go, tile by tile, so that what they share stays on
//! chip: as the subpasses of a Vulkan render pass.

use core::fmt;

use super::attachments::{Attachment, attachments, samples};
use super::model::{Order, Profile};
use super::surface::Images;
use super::tiles::{PixelBytes, least_side, room};
use crate::shape::{FrameShape, PassShape};

/// Why a pass begins tiles of its own, and does not go on in those of the passes before it
/// (after Vulkan's `VkSubpassMergeStatusEXT`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MergeRefusal {
    /// They have no attachment in common: nothing would stay on chip for it.
    NothingShared,
    /// Its attachments have another size.
    Size {
        /// Width and height of theirs.
        before: [u32; 2],
        /// Width and height of its own.
        now: [u32; 2],
    },
    /// They have a depth and stencil attachment, and it has another.
    SecondDepth,
    /// It clears the depth that they drew: entries of low resolution are lost by that.
    DepthCleared,
    /// It loads what one of them discards.
    Discarded {
        /// The texture's label.
        texture: String,
    },
    /// It samples one of their attachments, wherever its shaders want.
    Sampled {
        /// The texture's label.
        texture: String,
    },
    /// It draws to what one of them samples, wherever that one's shaders want.
    DrawnAfterSampling {
        /// The texture's label.
        texture: String,
    },
    /// All attachments together do not fit into the memory of the smallest tile.
    TileMemory {
        /// Bytes that they take there.
        bytes: u64,
        /// Bytes that there are.
        room: u64,
    },
}

impl fmt::Display for MergeRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingShared => f.write_str("no attachment in common"),
            Self::Size { before, now } => {
                let ([a, b], [c, d]) = (before, now);
                write!(f, "attachments of {c}x{d} after {a}x{b}")
            }
            Self::SecondDepth => f.write_str("another depth and stencil attachment"),
            Self::DepthCleared => f.write_str("it clears the depth"),
            Self::Discarded { texture } => write!(f, "it loads `{texture}`, which was discarded"),
            Self::Sampled { texture } => write!(f, "it samples `{texture}`, drawn before"),
            Self::DrawnAfterSampling { texture } => {
                write!(f, "it draws to `{texture}`, sampled before")
            }
            Self::TileMemory { bytes, room } => write!(
                f,
                "all attachments take {bytes} bytes of the smallest tile, which has {room}"
            ),
        }
    }
}

/// Whether a pass goes on in the tiles of those before it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PassMerge {
    /// Number of the pass, from 1: the first has none before it.
    pub pass: usize,
    /// Its label.
    pub label: String,
    /// Why not; `None` if it does.
    pub refused: Option<MergeRefusal>,
}

/// What a pass moves at its ends, and what its tiles hold.
#[derive(Clone, Debug, Default)]
pub(super) struct OnChip {
    /// It goes on in the tiles of the pass before.
    pub(super) continues: bool,
    /// By attachment: read from memory at the beginning.
    pub(super) loads: Vec<bool>,
    /// By attachment: written to memory at the end.
    pub(super) stores: Vec<bool>,
    /// A pixel of all passes that share the tiles.
    pub(super) pixel: PixelBytes,
}

/// Whether passes go on in the tiles of those before them, for all but the first.
pub(super) fn merges(profile: &Profile, shape: &FrameShape, images: &Images) -> Vec<PassMerge> {
    if profile.order != Order::Tiled {
        return Vec::new();
    }
    let mut group: Vec<&PassShape> = shape.passes.first().into_iter().collect();
    let mut all = Vec::new();
    for (i, pass) in shape.passes.iter().enumerate().skip(1) {
        let refused = refusal(profile, shape, images, &group, pass).err();
        if refused.is_some() {
            group.clear();
        }
        group.push(pass);
        all.push(PassMerge {
            pass: i,
            label: pass.label.clone(),
            refused,
        });
    }
    all
}

fn refusal(
    profile: &Profile,
    shape: &FrameShape,
    images: &Images,
    group: &[&PassShape],
    pass: &PassShape,
) -> Result<(), MergeRefusal> {
    let new: Vec<Attachment> = attached(shape, pass).collect();
    let held: Vec<Attachment> = group.iter().flat_map(|p| attached(shape, p)).collect();
    same_size(images, &held, &new)?;
    shares(&held, &new)?;
    keeps_contents(shape, &held, &new)?;
    samples_nothing_held(shape, group, &held, pass, &new)?;
    let all = held.iter().chain(&new);
    fits(profile, PixelBytes::of(images, all))
}

fn attached(shape: &FrameShape, pass: &PassShape) -> impl Iterator<Item = Attachment> {
    attachments(shape, pass).into_iter().flatten()
}

fn same_size(images: &Images, held: &[Attachment], new: &[Attachment]) -> Result<(), MergeRefusal> {
    let size = |all: &[Attachment]| {
        let first = all.first();
        first.map(|a| images.get(a.texture, a.subresource).size)
    };
    match (size(held), size(new)) {
        (Some(before), Some(now)) if before != now => Err(MergeRefusal::Size { before, now }),
        _ => Ok(()),
    }
}

fn shares(held: &[Attachment], new: &[Attachment]) -> Result<(), MergeRefusal> {
    let is_held = |a: &&Attachment| held.iter().any(|h| h.is_image_of(a));
    if !new.iter().any(|a| is_held(&a)) {
        return Err(MergeRefusal::NothingShared);
    }
    let has_depth = held.iter().any(|h| h.is_depth);
    let mut second = new.iter().filter(|a| a.is_depth && has_depth);
    match second.find(|a| !is_held(a)) {
        Some(_) => Err(MergeRefusal::SecondDepth),
        None => Ok(()),
    }
}

/// What the pass loads is what those before it left.
fn keeps_contents(
    shape: &FrameShape,
    held: &[Attachment],
    new: &[Attachment],
) -> Result<(), MergeRefusal> {
    for a in new {
        let last = held.iter().rev().find(|h| h.is_image_of(a));
        let Some(last) = last else {
            continue;
        };
        if a.is_depth && a.new_depth {
            return Err(MergeRefusal::DepthCleared);
        }
        if (0..2).any(|k| a.loads[k] && last.discards[k]) {
            let texture = label(shape, a);
            return Err(MergeRefusal::Discarded { texture });
        }
    }
    Ok(())
}

/// Where a texel that is sampled lies is known to shaders only, so it could be one of a tile
/// that is not finished, or that is finished already.
fn samples_nothing_held(
    shape: &FrameShape,
    group: &[&PassShape],
    held: &[Attachment],
    pass: &PassShape,
    new: &[Attachment],
) -> Result<(), MergeRefusal> {
    if let Some(a) = held.iter().find(|a| samples(pass, a.texture)) {
        let texture = label(shape, a);
        return Err(MergeRefusal::Sampled { texture });
    }
    let sampled = |a: &&Attachment| group.iter().any(|p| samples(p, a.texture));
    match new.iter().find(sampled) {
        Some(a) => Err(MergeRefusal::DrawnAfterSampling {
            texture: label(shape, a),
        }),
        None => Ok(()),
    }
}

fn fits(profile: &Profile, pixel: PixelBytes) -> Result<(), MergeRefusal> {
    let side = u64::from(least_side(&profile.tile));
    for (pixel, room) in room(&profile.tile, pixel) {
        let bytes = side * side * u64::from(pixel);
        if bytes > room {
            return Err(MergeRefusal::TileMemory { bytes, room });
        }
    }
    Ok(())
}

fn label(shape: &FrameShape, a: &Attachment) -> String {
    shape.textures[a.texture.index()].label.clone()
}

/// What each pass moves at its ends, where `merges` says which go on in the tiles of those
/// before.
pub(super) fn on_chip(shape: &FrameShape, images: &Images, merges: &[PassMerge]) -> Vec<OnChip> {
    let all: Vec<Vec<Option<Attachment>>> =
        shape.passes.iter().map(|p| attachments(shape, p)).collect();
    let continues = |i: usize| {
        let merge = merges.iter().find(|m| m.pass == i);
        merge.is_some_and(|m| m.refused.is_none())
    };
    let mut chips = Vec::new();
    let mut first = 0;
    while first < all.len() {
        let more = (first + 1..all.len()).take_while(|i| continues(*i));
        let end = first + 1 + more.count();
        chips.extend(group(images, &all[first..end]));
        first = end;
    }
    chips
}

/// An attachment is read before the first pass that has it, and written behind the last.
fn group(images: &Images, passes: &[Vec<Option<Attachment>>]) -> Vec<OnChip> {
    let has = |passes: &[Vec<Option<Attachment>>], a: &Attachment| {
        let mut all = passes.iter().flatten().flatten();
        all.any(|b| a.is_image_of(b))
    };
    let pixel = PixelBytes::of(images, passes.iter().flatten().flatten());
    let chip = |(i, pass): (usize, &Vec<Option<Attachment>>)| {
        let read = |a: &Attachment| a.loaded && !has(&passes[..i], a);
        let written = |a: &Attachment| a.stored && !has(&passes[i + 1..], a);
        OnChip {
            continues: i > 0,
            loads: pass.iter().map(|a| a.as_ref().is_some_and(read)).collect(),
            stores: pass
                .iter()
                .map(|a| a.as_ref().is_some_and(written))
                .collect(),
            pixel,
        }
    };
    passes.iter().enumerate().map(chip).collect()
}
