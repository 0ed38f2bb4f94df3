//! A frame, drawn, as hashes and counters, and its results as pictures.

use std::collections::BTreeMap;

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockView, BlockWitness, ColorBlock, Error, Gpu, GpuConfig,
    PassReport, Recording, RenderPass, Subresource, Texture, TextureId, Wants,
};
use xxhash_rust::xxh3::xxh3_64;

use crate::counters;
use crate::picture::{Picture, picture_of};

/// What a golden holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Frame {
    /// Textures before the frame: a line each.
    pub(crate) initial: Vec<String>,
    /// Attached images after the frame.
    pub(crate) images: Vec<Image>,
    pub(crate) passes: Vec<Pass>,
}

/// An image: what it is, and the hash of its bytes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Image {
    pub(crate) what: String,
    pub(crate) hash: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Pass {
    pub(crate) label: String,
    /// What it loads and stores.
    pub(crate) targets: String,
    pub(crate) draws: Vec<Draw>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Draw {
    pub(crate) label: String,
    pub(crate) counters: Vec<(String, u64)>,
    /// Column and row of 64×64 tiles that were written, and a hash of what was.
    pub(crate) tiles: Tiles,
}

/// By row, then column.
pub(crate) type Tiles = BTreeMap<[u32; 2], u32>;

/// A frame that was drawn.
pub(crate) struct Measured {
    pub(crate) frame: Frame,
    /// Results for people.
    pub(crate) shown: Vec<Shown>,
}

/// A result as a picture.
pub(crate) struct Shown {
    pub(crate) name: String,
    pub(crate) picture: Picture,
}

impl Measured {
    /// Draws `recording` as every machine does.
    pub(crate) fn of(recording: &Recording) -> Result<Self, Error> {
        let mut gpu = Gpu::new(GpuConfig::default())?;
        gpu.load(recording)?;
        let mut tiles = TileHashes::default();
        let wants = Wants {
            witness: Some(&BlockHash),
            ..Wants::default()
        };
        let report = gpu.submit_observed(&recording.list, wants, &mut tiles)?;
        let passes = recording
            .list
            .passes
            .iter()
            .zip(&report.passes)
            .zip(tiles.passes);
        let frame = Frame {
            initial: initial(recording),
            images: images(&gpu, recording)?,
            passes: passes.map(|((p, r), t)| pass(p, r, t)).collect(),
        };
        Ok(Self {
            frame,
            shown: shown(&gpu, recording)?,
        })
    }
}

fn pass(pass: &RenderPass, report: &PassReport, mut tiles: BTreeMap<u32, Tiles>) -> Pass {
    let color = pass
        .color
        .iter()
        .map(|a| format!("{:?} {:?}", a.load, a.store));
    let depth = pass.depth_stencil.iter().map(|a| {
        let ops = (a.depth_load, a.depth_store, a.stencil_load, a.stencil_store);
        format!("{:?} {:?} {:?} {:?}", ops.0, ops.1, ops.2, ops.3)
    });
    let mut draw = |(i, d): (usize, &gnomon_raster::DrawReport)| Draw {
        label: d.label.clone(),
        counters: counters::named(d),
        tiles: tiles.remove(&(i as u32)).unwrap_or_default(),
    };
    Pass {
        label: pass.label.clone(),
        targets: color.chain(depth).collect::<Vec<_>>().join("; "),
        draws: report.draws.iter().enumerate().map(&mut draw).collect(),
    }
}

fn initial(recording: &Recording) -> Vec<String> {
    let line = |(i, t): (usize, &gnomon_raster::RecordedTexture)| {
        let d = t.descriptor();
        let mut hasher = blake3::Hasher::new();
        for (image, bytes) in t.contents() {
            hasher.update(&image.mip.to_le_bytes());
            hasher.update(&image.layer.to_le_bytes());
            hasher.update(bytes);
        }
        let [w, h, depth] = d.size;
        let kind = format!(
            "{:?} {:?} {w}x{h}x{depth} mips {}",
            d.format, d.dimension, d.mip_levels
        );
        format!("{i} {:?} {kind} {}", d.label, hasher.finalize().to_hex())
    };
    recording.textures().iter().enumerate().map(line).collect()
}

/// Every image that a pass is attached to, in the order of ids.
fn images(gpu: &Gpu, recording: &Recording) -> Result<Vec<Image>, Error> {
    let mut ids: Vec<(TextureId, Subresource)> = Vec::new();
    for pass in &recording.list.passes {
        ids.extend(pass.color.iter().map(|a| (a.texture, a.subresource)));
        let depth = pass.depth_stencil.iter();
        ids.extend(depth.map(|a| (a.texture, a.subresource)));
    }
    ids.sort_unstable();
    ids.dedup();
    ids.into_iter().map(|(id, at)| image(gpu, id, at)).collect()
}

fn image(gpu: &Gpu, id: TextureId, at: Subresource) -> Result<Image, Error> {
    let texture = gpu.texture(id)?;
    let d = texture.descriptor();
    let [w, h, _] = texture.mip_size(at.mip);
    Ok(Image {
        what: format!(
            "{} {:?} mip {} layer {} {:?} {w}x{h}",
            id.index(),
            d.label,
            at.mip,
            at.layer,
            d.format
        ),
        hash: content_hash(texture, at)?,
    })
}

/// BLAKE3 of an image's bytes as they are stored, rows from the top, depth and stencil
/// too: equal where every bit is, on every machine. As text of 64 hexadecimal digits.
///
/// # Errors
/// There is no such image, or memory is short.
pub fn content_hash(texture: &Texture, image: Subresource) -> Result<String, Error> {
    let bytes = texture.read_packed(image)?;
    Ok(blake3::hash(&bytes).to_hex().to_string())
}

/// The named results, or else what the last pass draws to.
fn shown(gpu: &Gpu, recording: &Recording) -> Result<Vec<Shown>, Error> {
    let mut wanted: Vec<(String, TextureId, Subresource)> = recording
        .outputs()
        .map(|(name, id)| (name.to_owned(), id, Subresource::default()))
        .collect();
    if wanted.is_empty() {
        let last = recording.list.passes.last();
        let color = last.iter().flat_map(|p| p.color.iter().enumerate());
        wanted.extend(color.map(|(i, a)| (format!("color{i}"), a.texture, a.subresource)));
    }
    let show = |(name, id, at): (String, TextureId, Subresource)| {
        let picture = picture_of(gpu.texture(id)?, at)?;
        Ok(Shown { name, picture })
    };
    wanted.into_iter().map(show).collect()
}

/// What an event left in a block.
struct BlockHash;

impl BlockWitness for BlockHash {
    fn after(&self, view: &BlockView<'_>) -> u64 {
        let mut bytes = Vec::with_capacity(64 * 16);
        let inside = |i: &usize| view.inside >> i & 1 == 1;
        for i in (0..64).filter(inside) {
            if let Some((depth, stencil)) = view.depth_stencil {
                bytes.extend(depth[i].to_le_bytes());
                bytes.push(stencil[i]);
            }
            for color in view.color {
                push_texel(color, i, &mut bytes);
            }
        }
        xxh3_64(&bytes)
    }
}

fn push_texel(color: &ColorBlock<'_>, i: usize, bytes: &mut Vec<u8>) {
    match color {
        ColorBlock::B8(b) => bytes.push(b[i]),
        ColorBlock::B16(b) => bytes.extend(b[i].to_le_bytes()),
        ColorBlock::B32(b) => bytes.extend(b[i].to_le_bytes()),
        ColorBlock::B16x4(b) => b.iter().for_each(|c| bytes.extend(c[i].to_le_bytes())),
        ColorBlock::B32x4(b) => b.iter().for_each(|c| bytes.extend(c[i].to_le_bytes())),
    }
}

/// Hashes of what draws left in tiles, by draw, for each pass.
#[derive(Default)]
struct TileHashes {
    passes: Vec<BTreeMap<u32, Tiles>>,
    now: BTreeMap<u32, Tiles>,
}

impl AccessObserver for TileHashes {
    fn batch(&mut self, _: usize, batch: &AccessBatch<'_>) {
        for b in batch.blocks.iter().filter(|b| b.witness != 0) {
            let [column, row] = b.block.map(|c| u32::from(c) / 8);
            let tiles = self.now.entry(b.draw).or_default();
            let hash = tiles.entry([row, column]).or_default();
            let [x, y] = b.block.map(u16::to_le_bytes);
            let mut bytes = [&hash.to_le_bytes()[..], &x, &y].concat();
            bytes.extend(b.witness.to_le_bytes());
            *hash = xxh3_64(&bytes) as u32;
        }
    }

    fn end(&mut self, _: usize, _: &PassReport) {
        self.passes.push(std::mem::take(&mut self.now));
    }
}
