//! Lending attachments to a pass, and cutting them into tiles.

use crate::command::{ColorAttachment, DepthStencilAttachment, LoadOp, RenderPass, StoreOp};
use crate::counters::{AccessSizes, ClientTraffic, Traffic, packed_word_bytes};
use crate::format::{Format, encode, encode_depth, to_stored};
use crate::gpu::Gpu;
use crate::texture::{
    Block, Block4, ColorBlocks, DepthPlane, Layout, Plane, Subresource, TextureId,
};
use crate::tile::{ColorTile, DepthTile, TileTarget, Untold};

/// The attachments while a pass runs: their storage, and what happens to it at both ends.
pub(super) struct Lent {
    pub(super) layout: Layout,
    pub(super) sizes: AccessSizes,
    color: Vec<LentColor>,
    depth: Option<LentDepth>,
}

struct LentColor {
    attachment: ColorAttachment,
    format: Format,
    blocks: ColorBlocks,
}

struct LentDepth {
    attachment: DepthStencilAttachment,
    format: Format,
    plane: DepthPlane,
}

/// Takes the attachments of `pass` out of the GPU's textures.
pub(super) fn lend(gpu: &mut Gpu, pass: &RenderPass) -> Lent {
    let mut lent = Lent {
        layout: Layout::new(1, 1),
        sizes: AccessSizes::default(),
        color: Vec::new(),
        depth: None,
    };
    for (i, attachment) in pass.color.iter().enumerate() {
        let (format, plane) = lent.take(gpu, attachment.texture, attachment.subresource);
        if let Plane::Color(blocks) = plane {
            lent.sizes.color[i] = Some(format);
            lent.color.push(LentColor {
                attachment: attachment.clone(),
                format,
                blocks,
            });
        }
    }
    if let Some(attachment) = &pass.depth_stencil {
        let (format, plane) = lent.take(gpu, attachment.texture, attachment.subresource);
        if let Plane::Depth(plane) = plane {
            lent.sizes.depth = Some(format);
            lent.depth = Some(LentDepth {
                attachment: attachment.clone(),
                format,
                plane,
            });
        }
    }
    lent
}

/// Puts the attachments back.
pub(super) fn give_back(gpu: &mut Gpu, lent: Lent) {
    let mut put = |id: TextureId, s: Subresource, plane| {
        gpu.textures[id.0 as usize].planes[s.mip as usize][s.layer as usize] = plane;
    };
    for LentColor {
        attachment: a,
        blocks,
        ..
    } in lent.color
    {
        put(a.texture, a.subresource, Plane::Color(blocks));
    }
    if let Some(LentDepth {
        attachment: a,
        plane,
        ..
    }) = lent.depth
    {
        put(a.texture, a.subresource, Plane::Depth(plane));
    }
}

impl Lent {
    fn take(&mut self, gpu: &mut Gpu, id: TextureId, s: Subresource) -> (Format, Plane) {
        let texture = &mut gpu.textures[id.0 as usize];
        self.layout = texture.layouts[s.mip as usize];
        let plane = &mut texture.planes[s.mip as usize][s.layer as usize];
        (texture.desc.format, core::mem::replace(plane, Plane::Lent))
    }

    /// Cuts the attachments into execution tiles of `side` pixels that touch the image.
    pub(super) fn tiles(&mut self, side: u32) -> Vec<TileTarget<'_>> {
        let n = self.layout.tile_blocks(side);
        let side = self.layout.tile_side(side);
        let (width, height) = (self.layout.width, self.layout.height);
        let count = self.layout.blocks() / n;
        let mut color: Vec<_> = self
            .color
            .iter_mut()
            .map(|c| cut_color(&mut c.blocks, n).into_iter())
            .collect();
        let mut depth = self
            .depth
            .as_mut()
            .map(|d| cut_depth(&mut d.plane, n).into_iter());
        let mut tiles = Vec::with_capacity(count);
        for t in 0..count {
            let (x, y) = self.layout.tile_origin(t * n);
            let depth = depth.as_mut().and_then(Iterator::next);
            let color = color.iter_mut().filter_map(Iterator::next).collect();
            if x < width && y < height {
                tiles.push(TileTarget {
                    x,
                    y,
                    side,
                    width,
                    height,
                    depth,
                    color,
                    untold: Untold::default(),
                });
            }
        }
        tiles
    }
}

fn cut_color(blocks: &mut ColorBlocks, n: usize) -> Vec<ColorTile<'_>> {
    match blocks {
        ColorBlocks::B8(v) => v.chunks_mut(n).map(ColorTile::B8).collect(),
        ColorBlocks::B16(v) => v.chunks_mut(n).map(ColorTile::B16).collect(),
        ColorBlocks::B32(v) => v.chunks_mut(n).map(ColorTile::B32).collect(),
        ColorBlocks::B16x4(v) => v.chunks_mut(n).map(ColorTile::B16x4).collect(),
        ColorBlocks::B32x4(v) => v.chunks_mut(n).map(ColorTile::B32x4).collect(),
    }
}

fn cut_depth(d: &mut DepthPlane, n: usize) -> Vec<DepthTile<'_>> {
    let blocks = d.depth.chunks_mut(n).zip(d.stencil.chunks_mut(n));
    let hiz = d.hiz.min.chunks_mut(n).zip(d.hiz.max.chunks_mut(n));
    let tile = |((depth, stencil), (hiz_min, hiz_max))| DepthTile {
        depth,
        stencil,
        hiz_min,
        hiz_max,
    };
    blocks.zip(hiz).map(tile).collect()
}

/// What a pass does to its attachments at one of its ends.
#[derive(Clone, Debug, Default)]
pub(super) struct Fill {
    /// Raw channels by attachment.
    color: Vec<Option<[u32; 4]>>,
    /// Stored depth.
    depth: Option<u32>,
    stencil: Option<u8>,
}

impl Lent {
    /// What the load operations store.
    pub(super) fn loads(&self) -> Fill {
        let color = |c: &LentColor| match c.attachment.load {
            LoadOp::Load => None,
            LoadOp::Clear(v) => Some(encode(c.format, v)),
            LoadOp::DontCare => Some([0; 4]),
        };
        let depth = |d: &LentDepth| match d.attachment.depth_load {
            LoadOp::Load => None,
            LoadOp::Clear(v) => Some(encode_depth(d.format, v)),
            LoadOp::DontCare => Some(0),
        };
        let stencil = |d: &LentDepth| match d.attachment.stencil_load {
            LoadOp::Load => None,
            LoadOp::Clear(v) => Some(v),
            LoadOp::DontCare => Some(0),
        };
        Fill {
            color: self.color.iter().map(color).collect(),
            depth: self.depth.as_ref().and_then(depth),
            stencil: self.depth.as_ref().and_then(stencil),
        }
    }

    /// What the store operations destroy.
    pub(super) fn stores(&self) -> Fill {
        let gone = |s: StoreOp| s == StoreOp::Discard;
        let color = |c: &LentColor| gone(c.attachment.store).then_some([0; 4]);
        let depth = self.depth.as_ref().map(|d| &d.attachment);
        Fill {
            color: self.color.iter().map(color).collect(),
            depth: depth.and_then(|a| gone(a.depth_store).then_some(0)),
            stencil: depth.and_then(|a| gone(a.stencil_store).then_some(0)),
        }
    }

    /// Traffic of the clears: one write a pixel and aspect.
    pub(super) fn clear_traffic(&self) -> ClientTraffic {
        let pixels = u64::from(self.layout.width) * u64::from(self.layout.height);
        let writes = |cleared: bool, bytes: u64| Traffic {
            write_accesses: if cleared { pixels } else { 0 },
            write_bytes: if cleared { pixels * bytes } else { 0 },
            ..Traffic::default()
        };
        let mut t = ClientTraffic::default();
        for (slot, c) in t.color.iter_mut().zip(&self.color) {
            let cleared = matches!(c.attachment.load, LoadOp::Clear(_));
            *slot = writes(cleared, c.format.bytes());
        }
        if let Some(d) = &self.depth {
            let a = &d.attachment;
            t.z = writes(matches!(a.depth_load, LoadOp::Clear(_)), d.format.bytes());
            t.stencil = writes(matches!(a.stencil_load, LoadOp::Clear(_)), 1);
            let words = t.z.write_accesses + t.stencil.write_accesses;
            t.packed_depth_stencil = Traffic {
                write_accesses: words,
                write_bytes: words * packed_word_bytes(d.format),
                ..Traffic::default()
            };
        }
        t
    }
}

impl Fill {
    /// Fills a tile.
    pub(super) fn apply(&self, tile: &mut TileTarget<'_>, sizes: &AccessSizes) {
        for ((tile, value), f) in tile
            .color
            .iter_mut()
            .zip(&self.color)
            .zip(sizes.color.iter().flatten())
        {
            if let Some(v) = value {
                fill_color(tile, *f, *v);
            }
        }
        let Some(d) = &mut tile.depth else { return };
        if let Some(v) = self.depth {
            d.depth.fill(Block([v; 64]));
            d.hiz_min.fill(v as i32);
            d.hiz_max.fill(v as i32);
        }
        if let Some(v) = self.stencil {
            d.stencil.fill(Block([v; 64]));
        }
    }
}

fn fill_color(tile: &mut ColorTile<'_>, f: Format, v: [u32; 4]) {
    let v = to_stored(f, v);
    match tile {
        ColorTile::B8(b) => b.fill(Block([v[0] as u8; 64])),
        ColorTile::B16(b) => b.fill(Block([v[0] as u16; 64])),
        ColorTile::B32(b) => b.fill(Block([v[0]; 64])),
        ColorTile::B16x4(b) => b.fill(Block4(v.map(|c| [c as u16; 64]))),
        ColorTile::B32x4(b) => b.fill(Block4(v.map(|c| [c; 64]))),
    }
}
