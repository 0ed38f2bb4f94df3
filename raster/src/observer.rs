//! Block-level access events, for consumers that model caches, replay or explain.
//!
//! Events stream: a pass hands them over in batches while it runs, so that no more
//! than a batch of them is ever in memory, and the batches one after the other are the
//! same on every machine, however they are cut.

use crate::format::Format;
use crate::gpu::PassReport;
use crate::simd::SimdLevel;
use crate::{MAX_COLOR_ATTACHMENTS, MAX_VARYINGS};

/// What one primitive did to one 8×8 block. Bit `8·row + column` is a pixel.
///
/// Every covered pixel ends once: [`Ended`] and what was written partition `covered`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockAccess {
    /// Number of the draw in its render pass.
    pub draw: u32,
    /// Number of the primitive in its draw, instances in turn.
    pub primitive: u32,
    /// Number of the triangle in its primitive (clipping and lines make several).
    pub piece: u32,
    /// Block column and row; pixel = 8 × block.
    pub block: [u16; 2],
    /// Fragments generated.
    pub covered: u64,
    /// Pixels whose depth was read.
    pub z_read: u64,
    /// Pixels whose depth was written.
    pub z_write: u64,
    /// Pixels whose stencil was read.
    pub stencil_read: u64,
    /// Pixels whose stencil was written.
    pub stencil_write: u64,
    /// Pixels whose colour was read, by attachment.
    pub color_read: [u64; MAX_COLOR_ATTACHMENTS],
    /// Pixels whose colour was written, by attachment.
    pub color_write: [u64; MAX_COLOR_ATTACHMENTS],
    /// Where the fragments ended that were not written.
    pub ended: Ended,
    /// Smallest and largest depth of the primitive's plane over all 64 pixels of the
    /// block, as it is stored (the D24 integer, or the bits of a float), bias and the
    /// viewport's limits included. A shader may have written other depths. `[0; 2]`
    /// without depth attachment, or where [`Wants::depth_ranges`] is not set.
    pub span: [u32; 2],
    /// Smallest and largest depth that the block held before, over its pixels inside
    /// the image; `[0; 2]` where [`Self::span`] is.
    pub stored: [u32; 2],
    /// What [`Wants::witness`] made of the block after the event; 0 without one, and where
    /// the event wrote nothing.
    pub witness: u64,
    /// The primitive faces the viewer.
    pub front: bool,
    /// The zmin/zmax entry was read.
    pub hiz_read: bool,
    /// The zmin/zmax entry was written.
    pub hiz_write: bool,
}

/// Events wait in memory by the hundred thousand.
const _: () = assert!(size_of::<BlockAccess>() == 192);

/// Where fragments ended that were not written: disjoint parts of
/// [`BlockAccess::covered`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ended {
    /// All of them, by zmin/zmax.
    pub hiz: bool,
    /// At the depth bounds test.
    pub bounds: u64,
    /// At the stencil test.
    pub stencil: u64,
    /// At the depth test.
    pub depth: u64,
    /// Discarded by the shader.
    pub discarded: u64,
}

impl BlockAccess {
    /// Fragments that passed all tests and were not discarded.
    #[must_use]
    pub fn written(&self) -> u64 {
        let e = &self.ended;
        match e.hiz {
            true => 0,
            false => self.covered & !(e.bounds | e.stencil | e.depth | e.discarded),
        }
    }
}

/// What an observer wants to be told beside what costs nothing.
#[derive(Clone, Copy, Default)]
pub struct Wants<'a> {
    /// [`BlockAccess::span`] and [`BlockAccess::stored`], for which blocks are looked at
    /// that no test needs.
    pub depth_ranges: bool,
    /// [`AccessBatch::texels`].
    pub texels: bool,
    /// [`AccessBatch::outputs`] and [`AccessBatch::values`].
    pub outputs: bool,
    /// [`AccessBatch::fragments`] of this pixel (column, row).
    pub probe: Option<[u32; 2]>,
    /// [`BlockAccess::witness`].
    pub witness: Option<&'a dyn BlockWitness>,
    /// [`AccessBatch::left`]: a witness that is called once for all that a draw did to a
    /// block, and not for each of its events.
    pub left: Option<&'a dyn BlockWitness>,
}

/// Looks at a block that was written to, and says something of it in 64 bits: a hash, or
/// what a codec would make of it. Called by workers.
pub trait BlockWitness: Sync {
    /// What is to be said.
    fn after(&self, block: &BlockView<'_>) -> u64;
}

/// The stored bits of an 8×8 block of all attachments, pixels in the order of masks.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct BlockView<'a> {
    /// Block column and row.
    pub block: [u16; 2],
    /// Pixels inside the image.
    pub inside: u64,
    /// Encoded depth and stencil.
    pub depth_stencil: Option<(&'a [u32; 64], &'a [u8; 64])>,
    /// The blocks of the colour attachments, in order.
    pub color: &'a [ColorBlock<'a>],
    /// Their formats.
    pub formats: &'a [Format],
    /// What the GPU runs on, for witnesses that are lane code.
    pub level: SimdLevel,
}

impl<'a> BlockView<'a> {
    /// A block wholly inside an image, to ask a witness by hand.
    #[must_use]
    pub fn new(
        depth_stencil: Option<(&'a [u32; 64], &'a [u8; 64])>,
        color: &'a [ColorBlock<'a>],
        formats: &'a [Format],
    ) -> Self {
        Self {
            block: [0; 2],
            inside: u64::MAX,
            depth_stencil,
            color,
            formats,
            level: SimdLevel::detect(),
        }
    }
}

/// The bits of a block of a colour attachment as they are stored, pixels in the order of
/// masks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorBlock<'a> {
    /// R8Unorm.
    B8(&'a [u8; 64]),
    /// Rg8Unorm (red low), R16Sint, R16Float.
    B16(&'a [u16; 64]),
    /// Rgba8Unorm (red low), R32Float, R32Uint.
    B32(&'a [u32; 64]),
    /// Rgba16Float, one channel after the other.
    B16x4(&'a [[u16; 64]; 4]),
    /// Rgba32Float, one channel after the other.
    B32x4(&'a [[u32; 64]; 4]),
}

/// What a draw left in a block that it wrote to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockLeft {
    /// Number of the draw in its render pass.
    pub draw: u32,
    /// Block column and row.
    pub block: [u16; 2],
    /// What [`Wants::left`] made of the block behind the draw's last event.
    pub seen: u64,
}

/// Texels of one 8×8 block of a texture that the fragments of one event read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexelAccess {
    /// Index of the event in [`AccessBatch::blocks`].
    pub event: u32,
    /// Slot of the draw.
    pub slot: u8,
    /// Mip level.
    pub mip: u8,
    /// Slice or cube face.
    pub layer: u16,
    /// Block column and row in the image of that level.
    pub block: [u16; 2],
    /// Texels that were read; bit `8·row + column`.
    pub texels: u64,
    /// How many reads that were; their sum over a draw's slot is
    /// [`crate::Traffic::read_accesses`].
    pub taps: u32,
}

/// Where a fragment ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FragmentEnd {
    /// Its block was thrown away by zmin/zmax.
    Hiz,
    /// At the depth bounds test.
    Bounds,
    /// At the stencil test.
    Stencil,
    /// At the depth test.
    Depth,
    /// Discarded by the shader.
    Discarded,
    /// Passed everything.
    #[default]
    Written,
}

/// What became of one fragment of the probed pixel. Each covered fragment is one, those
/// that zmin/zmax threw away too, and several primitives of a draw are several.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FragmentRecord {
    /// Index of its event in [`AccessBatch::blocks`], which tells draw, primitive, piece
    /// and facing.
    pub event: u32,
    /// Where it ended.
    pub end: FragmentEnd,
    /// Its depth as it would be stored; `None` without depth attachment, and where a
    /// shader that writes depth discarded it.
    pub depth: Option<u32>,
    /// Stored depth before and after; zeros without depth attachment.
    pub stored_depth: [u32; 2],
    /// Stored stencil before and after; zeros without depth attachment.
    pub stencil: [u8; 2],
    /// Its varyings, the bits of floats; `None` where the shader was not run, and zeros
    /// for those that the draw lacks.
    pub varyings: Option<[u32; MAX_VARYINGS]>,
    /// What the shader gave each attachment, the bits of floats (of a NaN the canonical
    /// ones) or integers; `None` where there is no shader, or the fragment did not get to
    /// it, or was discarded.
    pub source: Option<[[u32; 4]; MAX_COLOR_ATTACHMENTS]>,
    /// Raw channels of each attachment before and after; zeros where there is none.
    pub color: [[[u32; 4]; 2]; MAX_COLOR_ATTACHMENTS],
}

/// What the shader gave the fragments of an event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadedBlock {
    /// Index of the event in [`AccessBatch::blocks`].
    pub event: u32,
    /// Fragments that it was run for.
    pub shaded: u64,
    /// Those that it discarded.
    pub discarded: u64,
    /// Those whose colour is an integer, by attachment.
    pub integers: [u64; MAX_COLOR_ATTACHMENTS],
    /// Where their values begin in [`AccessBatch::values`]: for each fragment that was
    /// shaded and not discarded, in the order of masks, four channels of each attachment,
    /// then the depth where the shader writes it, as bits: of a NaN the canonical ones.
    pub first: u32,
}

/// Some accesses of a render pass.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct AccessBatch<'a> {
    /// Ordered by draw, primitive, piece, block row, block column; all of them after
    /// those of the batch before.
    pub blocks: &'a [BlockAccess],
    /// Ordered by event, slot, level, layer, block row, block column; empty where
    /// [`Wants::texels`] is not set.
    pub texels: &'a [TexelAccess],
    /// Ordered by event; empty where [`Wants::probe`] is not set.
    pub fragments: &'a [FragmentRecord],
    /// Ordered by event; empty where [`Wants::outputs`] is not set. Shaders of one colour
    /// are not run and have none.
    pub outputs: &'a [ShadedBlock],
    /// What `outputs` refer to.
    pub values: &'a [u32],
    /// Ordered by draw, block row, block column; empty where [`Wants::left`] is not set.
    /// Each draw and block to which it wrote once in a pass, with the draw's last event in
    /// the block or later.
    pub left: &'a [BlockLeft],
}

impl<'a> AccessBatch<'a> {
    /// A batch of `blocks`, to feed an observer by hand.
    #[must_use]
    pub fn new(blocks: &'a [BlockAccess]) -> Self {
        Self {
            blocks,
            texels: &[],
            fragments: &[],
            outputs: &[],
            values: &[],
            left: &[],
        }
    }

    /// The same with texels.
    #[must_use]
    pub fn with_texels(self, texels: &'a [TexelAccess]) -> Self {
        Self { texels, ..self }
    }
}

/// Receives the accesses of render passes; it may be called on any thread, by one at a
/// time.
pub trait AccessObserver: Send {
    /// The next accesses of pass number `pass` in the command list. The batches of a
    /// pass, one after the other, are the same on every machine; where one ends and the
    /// next begins is not to be relied on. A pass without accesses has none.
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>);

    /// The pass is over, accesses or none; `report` is what it counted.
    fn end(&mut self, pass: usize, report: &PassReport) {
        let _ = (pass, report);
    }
}
