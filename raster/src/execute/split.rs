//! Lending attachments to a pass, and cutting them into tiles.

use crate::command::{LoadOp, RenderPass, StoreOp};
use crate::counters::{AccessSizes, ClientTraffic, Traffic, packed_word_bytes};
use crate::format::{Format, encode, encode_depth};
use crate::gpu::Gpu;
use crate::texture::{
    Block, Block4, ColorBlocks, DepthPlane, Layout, Plane, Subresource, TextureId,
};
use crate::tile::{ColorTile, DepthTile, TileTarget};

/// The attachments' storage while a pass runs.
pub(super) struct Lent {
    pub(super) layout: Layout,
    pub(super) sizes: AccessSizes,
    color: Vec<(ColorBlocks, Format)>,
    depth: Option<DepthPlane>,
}

/// Takes the attachments of `pass` out of the GPU's textures.
pub(super) fn lend(gpu: &mut Gpu, pass: &RenderPass) -> Lent {
    let mut sizes = AccessSizes::default();
    let mut layout = Layout::new(1, 1);
    let mut take = |id: TextureId, s: Subresource| {
        let t = &mut gpu.textures[id.0 as usize];
        layout = t.layouts[s.mip as usize];
        let plane =
            core::mem::replace(&mut t.planes[s.mip as usize][s.layer as usize], Plane::Lent);
        (plane, t.desc.format)
    };
    let mut color = Vec::new();
    for (i, a) in pass.color.iter().enumerate() {
        if let (Plane::Color(c), format) = take(a.texture, a.subresource) {
            color.push((c, format));
            sizes.color[i] = Some(format);
        }
    }
    let depth = pass
        .depth_stencil
        .as_ref()
        .and_then(|a| match take(a.texture, a.subresource) {
            (Plane::Depth(d), format) => {
                sizes.depth = Some(format);
                Some(d)
            }
            _ => None,
        });
    Lent {
        layout,
        sizes,
        color,
        depth,
    }
}

/// Puts the attachments back.
pub(super) fn give_back(gpu: &mut Gpu, pass: &RenderPass, lent: Lent) {
    let mut put = |id: TextureId, s: Subresource, plane| {
        gpu.textures[id.0 as usize].planes[s.mip as usize][s.layer as usize] = plane;
    };
    for (a, (blocks, _)) in pass.color.iter().zip(lent.color) {
        put(a.texture, a.subresource, Plane::Color(blocks));
    }
    if let (Some(a), Some(d)) = (&pass.depth_stencil, lent.depth) {
        put(a.texture, a.subresource, Plane::Depth(d));
    }
}

impl Lent {
    /// Cuts the attachments into execution tiles of `side` pixels that touch the image.
    pub(super) fn tiles(&mut self, side: u32) -> Vec<TileTarget<'_>> {
        let n = self.layout.tile_blocks(side);
        let side = self.layout.tile_side(side);
        let (width, height) = (self.layout.width, self.layout.height);
        let count = self.layout.blocks() / n;
        let mut color: Vec<_> = self
            .color
            .iter_mut()
            .map(|(b, _)| cut_color(b, n).into_iter())
            .collect();
        let mut depth = self.depth.as_mut().map(|d| cut_depth(d, n).into_iter());
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

/// What the load operations store.
pub(super) fn loads(pass: &RenderPass, sizes: &AccessSizes) -> Fill {
    let color = pass
        .color
        .iter()
        .zip(sizes.color.iter().flatten())
        .map(|(a, &f)| match a.load {
            LoadOp::Load => None,
            LoadOp::Clear(v) => Some(encode(f, v)),
            LoadOp::DontCare => Some([0; 4]),
        });
    let ds = pass.depth_stencil.as_ref();
    Fill {
        color: color.collect(),
        depth: ds.and_then(|a| match a.depth_load {
            LoadOp::Load => None,
            LoadOp::Clear(v) => Some(encode_depth(
                sizes.depth.unwrap_or(Format::Depth24Stencil8),
                v,
            )),
            LoadOp::DontCare => Some(0),
        }),
        stencil: ds.and_then(|a| match a.stencil_load {
            LoadOp::Load => None,
            LoadOp::Clear(v) => Some(v),
            LoadOp::DontCare => Some(0),
        }),
    }
}

/// What the store operations destroy.
pub(super) fn stores(pass: &RenderPass) -> Fill {
    let gone = |s: StoreOp| s == StoreOp::Discard;
    let ds = pass.depth_stencil.as_ref();
    Fill {
        color: pass
            .color
            .iter()
            .map(|a| gone(a.store).then_some([0; 4]))
            .collect(),
        depth: ds.and_then(|a| gone(a.depth_store).then_some(0)),
        stencil: ds.and_then(|a| gone(a.stencil_store).then_some(0)),
    }
}

/// Traffic of the clears of a pass: one write a pixel and aspect.
pub(super) fn clear_traffic(pass: &RenderPass, lent: &Lent) -> ClientTraffic {
    let pixels = u64::from(lent.layout.width) * u64::from(lent.layout.height);
    let writes = |cleared: bool, bytes: u64| Traffic {
        write_accesses: if cleared { pixels } else { 0 },
        write_bytes: if cleared { pixels * bytes } else { 0 },
        ..Traffic::default()
    };
    let mut t = ClientTraffic::default();
    for ((slot, a), f) in t
        .color
        .iter_mut()
        .zip(&pass.color)
        .zip(lent.sizes.color.iter().flatten())
    {
        *slot = writes(matches!(a.load, LoadOp::Clear(_)), f.bytes());
    }
    if let (Some(a), Some(f)) = (&pass.depth_stencil, lent.sizes.depth) {
        t.z = writes(matches!(a.depth_load, LoadOp::Clear(_)), f.bytes());
        t.stencil = writes(matches!(a.stencil_load, LoadOp::Clear(_)), 1);
        let words = t.z.write_accesses + t.stencil.write_accesses;
        let word = packed_word_bytes(f);
        t.packed_depth_stencil = Traffic {
            write_accesses: words,
            write_bytes: words * word,
            ..Traffic::default()
        };
    }
    t
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
    match tile {
        ColorTile::B8(b) => b.fill(Block([v[0] as u8; 64])),
        ColorTile::B16(b) if f == Format::Rg8Unorm => {
            b.fill(Block([(v[0] | v[1] << 8) as u16; 64]))
        }
        ColorTile::B16(b) => b.fill(Block([v[0] as u16; 64])),
        ColorTile::B32(b) if f == Format::Rgba8Unorm => {
            b.fill(Block([u32::from_le_bytes(v.map(|c| c as u8)); 64]));
        }
        ColorTile::B32(b) => b.fill(Block([v[0]; 64])),
        ColorTile::B16x4(b) => b.fill(Block4(v.map(|c| [c as u16; 64]))),
        ColorTile::B32x4(b) => b.fill(Block4(v.map(|c| [c; 64]))),
    }
}
