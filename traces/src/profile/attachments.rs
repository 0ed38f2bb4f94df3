//! What passes do to attachments at their ends, and which passes a tiler can merge.

use gnomon_raster::{LoadOp, StoreOp, Subresource, TextureId};

use crate::shape::{FrameShape, PassShape};

/// An attachment of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Attachment {
    pub(super) texture: TextureId,
    pub(super) subresource: Subresource,
    pub(super) cleared: bool,
    pub(super) loaded: bool,
    pub(super) stored: bool,
    /// Bytes of a pixel that are cleared, by aspect; one for colour.
    pub(super) cleared_bytes: u8,
    /// Depth is other than what it was before the pass.
    pub(super) new_depth: bool,
    /// Depth is forgotten at the end.
    pub(super) lost_depth: bool,
}

/// Depth and stencil, then colour.
pub(super) fn attachments(shape: &FrameShape, pass: &PassShape) -> Vec<Option<Attachment>> {
    let mut all = vec![depth_stencil(shape, pass)];
    for a in &pass.color {
        let cleared = matches!(a.load, LoadOp::Clear(_));
        let bytes = shape.textures[a.texture.index()].format.bytes() as u8;
        all.push(Some(Attachment {
            texture: a.texture,
            subresource: a.subresource,
            cleared,
            loaded: matches!(a.load, LoadOp::Load),
            stored: a.store == StoreOp::Store,
            cleared_bytes: if cleared { bytes } else { 0 },
            new_depth: false,
            lost_depth: false,
        }));
    }
    all
}

fn depth_stencil(shape: &FrameShape, pass: &PassShape) -> Option<Attachment> {
    let a = pass.depth_stencil.as_ref()?;
    let depth = matches!(a.depth_load, LoadOp::Clear(_));
    let stencil = matches!(a.stencil_load, LoadOp::Clear(_));
    let loads = [
        matches!(a.depth_load, LoadOp::Load),
        matches!(a.stencil_load, LoadOp::Load),
    ];
    let depth_bytes = shape.textures[a.texture.index()].format.bytes() as u8;
    Some(Attachment {
        texture: a.texture,
        subresource: a.subresource,
        cleared: (depth || stencil) && !loads.contains(&true),
        loaded: loads.contains(&true),
        stored: [a.depth_store, a.stencil_store].contains(&StoreOp::Store),
        cleared_bytes: u8::from(depth) * depth_bytes + u8::from(stencil),
        new_depth: !loads[0],
        lost_depth: a.depth_store == StoreOp::Discard,
    })
}

/// Whether each pass can go on in the tiles of the one before it: the same attachments,
/// loaded and not cleared, and none of them sampled.
pub(super) fn mergeable(shape: &FrameShape) -> Vec<bool> {
    let all = &shape.passes;
    let goes_on = |i: usize| i > 0 && continues(shape, &all[i - 1], &all[i]);
    (0..all.len()).map(goes_on).collect()
}

fn continues(shape: &FrameShape, before: &PassShape, pass: &PassShape) -> bool {
    let (old, new) = (attachments(shape, before), attachments(shape, pass));
    let image = |a: &Attachment| (a.texture, a.subresource);
    let same = old.len() == new.len()
        && old
            .iter()
            .zip(&new)
            .all(|(a, b)| a.as_ref().map(image) == b.as_ref().map(image));
    let loads = new.iter().flatten().all(|a| a.loaded);
    let sampled = |a: &Attachment| samples(pass, a.texture);
    same && loads && !old.iter().flatten().any(sampled)
}

/// Whether a draw of the pass has the texture in a slot.
pub(super) fn samples(pass: &PassShape, texture: TextureId) -> bool {
    let mut bound = pass.draws.iter().flat_map(|d| &d.textures);
    bound.any(|b| b.texture == texture)
}
