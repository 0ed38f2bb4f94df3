//! What passes do to attachments at their ends.

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
    /// Depth and stencil, not colour.
    pub(super) is_depth: bool,
    /// Aspects that are loaded: depth and stencil; colour is the first.
    pub(super) loads: [bool; 2],
    /// Aspects that are forgotten at the end.
    pub(super) discards: [bool; 2],
}

impl Attachment {
    /// Whether both are the same image.
    pub(super) fn is_image_of(&self, other: &Self) -> bool {
        (self.texture, self.subresource) == (other.texture, other.subresource)
    }
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
            is_depth: false,
            loads: [matches!(a.load, LoadOp::Load), false],
            discards: [a.store == StoreOp::Discard, false],
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
        is_depth: true,
        loads,
        discards: [a.depth_store, a.stencil_store].map(|s| s == StoreOp::Discard),
    })
}

/// Whether a draw of the pass has the texture in a slot.
pub(super) fn samples(pass: &PassShape, texture: TextureId) -> bool {
    let mut bound = pass.draws.iter().flat_map(|d| &d.textures);
    bound.any(|b| b.texture == texture)
}
