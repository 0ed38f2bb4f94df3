//! What is known of passes before their first access.

use gnomon_raster::{Format, LoadOp};

use super::attachments::{Attachment, attachments};
use super::hiz::{Contents, DrawHiz};
use super::merge::{OnChip, PassMerge, on_chip};
use super::model::Profile;
use super::surface::{Image, Images};
use crate::shape::{FrameShape, PassShape};

/// What is known of a pass before its first access.
#[derive(Debug)]
pub(super) struct PassPlan {
    pub(super) first_row: u32,
    /// Depth and stencil, then colour.
    pub(super) attachments: Vec<Option<Attachment>>,
    pub(super) images: Vec<Option<Image>>,
    pub(super) draws: Vec<DrawHiz>,
    pub(super) depth_bits: u32,
    pub(super) depth_bytes: u64,
    /// What a tiler moves and keeps.
    pub(super) on_chip: OnChip,
}

/// Plans of all passes, of which `merges` go on in the tiles of those before.
pub(super) fn plans(
    profile: &Profile,
    shape: &FrameShape,
    images: &Images,
    merges: &[PassMerge],
) -> Vec<PassPlan> {
    let mut contents = vec![Contents::INVALID; shape.textures.len()];
    let mut first_row = 0;
    let mut plans = Vec::new();
    let chips = on_chip(shape, images, merges);
    for (pass, on_chip) in shape.passes.iter().zip(chips) {
        let plan = plan(profile, shape, images, (pass, on_chip), &mut contents);
        let next = first_row + plan.draws.len() as u32 + 1;
        plans.push(PassPlan { first_row, ..plan });
        first_row = next;
    }
    plans
}

fn plan(
    profile: &Profile,
    shape: &FrameShape,
    images: &Images,
    (pass, on_chip): (&PassShape, OnChip),
    contents: &mut [Contents],
) -> PassPlan {
    let attachments = attachments(shape, pass);
    let image = |a: &Attachment| images.get(a.texture, a.subresource);
    let format = attachments[0].map(|a| shape.textures[a.texture.index()].format);
    let is_float = format == Some(Format::Depth32FloatStencil8);
    let depth = attachments[0];
    if let Some(a) = depth.filter(|_| !on_chip.continues) {
        contents[a.texture.index()].begin_pass();
    }
    PassPlan {
        first_row: 0,
        images: attachments.iter().map(|a| a.as_ref().map(image)).collect(),
        draws: hiz_of_draws(profile, pass, depth, images, contents),
        attachments,
        depth_bits: if is_float { 30 } else { 24 },
        depth_bytes: format.map_or(0, Format::bytes),
        on_chip,
    }
}

fn hiz_of_draws(
    profile: &Profile,
    pass: &PassShape,
    depth: Option<Attachment>,
    images: &Images,
    contents: &mut [Contents],
) -> Vec<DrawHiz> {
    let mut none = Contents::INVALID;
    let contents = match depth {
        Some(a) => &mut contents[a.texture.index()],
        None => &mut none,
    };
    let cleared = pass.depth_stencil.as_ref();
    if cleared.is_some_and(|d| matches!(d.depth_load, LoadOp::Clear(_))) {
        contents.clear();
    }
    let room = profile.hiz.entries;
    let blocks = depth.map_or(0, |a| {
        let [w, h] = images.get(a.texture, a.subresource).size;
        w.div_ceil(8) * h.div_ceil(8)
    });
    let fits = room == 0 || blocks <= room;
    let draws = pass
        .draws
        .iter()
        .map(|d| contents.draw(&profile.hiz, pass, d));
    let draws = draws.map(|hiz| super::support::within(hiz, fits));
    draws.collect()
}
