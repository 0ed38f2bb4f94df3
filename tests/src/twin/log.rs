//! What the twin writes down of a block's event.

use std::collections::BTreeMap;

use gnomon_raster::shader::ScalarFragmentOutput;
use gnomon_raster::state::StencilOperation;
use gnomon_raster::{FragmentEnd, FragmentRecord, ShadedBlock, TexelAccess};

use super::block::{Block, Fragment};
use super::case::{EventDetails, Log, Look};
use super::image::Images;
use super::look_up::Reads;

/// A hash of a block's pixels: those inside the image, row by row, all attachments' values
/// of each as words.
#[derive(Clone, Copy, Debug)]
pub struct BlockHash(pub u64);

impl Default for BlockHash {
    fn default() -> Self {
        Self(1)
    }
}

impl BlockHash {
    /// Takes a word in.
    pub fn word(&mut self, w: u32) {
        self.0 = (self.0.rotate_left(7) ^ u64::from(w)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

/// The log of one event.
pub(super) struct BlockLog<'a> {
    event: u32,
    to: &'a mut EventDetails,
    /// By slot, level, layer, block row and column: texels and how many reads.
    texels: BTreeMap<[u64; 5], (u64, u32)>,
    shaded: Option<ShadedBlock>,
    /// The bit of the probed pixel and what happens to it.
    record: Option<(u64, FragmentRecord)>,
    operation: Option<StencilOperation>,
}

impl<'a> BlockLog<'a> {
    pub(super) fn new(event: usize, to: &'a mut EventDetails) -> Self {
        Self {
            event: event as u32,
            to,
            texels: BTreeMap::new(),
            shaded: None,
            record: None,
            operation: None,
        }
    }

    pub(super) fn texels(&mut self, reads: &Reads) {
        for (slot, read) in &reads.texels {
            let [x, y] = read.at.map(|v| v as u64);
            let key = [
                *slot as u64,
                read.level as u64,
                read.layer as u64,
                y / 8,
                x / 8,
            ];
            let (texels, taps) = self.texels.entry(key).or_default();
            *texels |= 1 << (8 * (y % 8) + x % 8);
            *taps += 1;
        }
    }

    fn record_of(&mut self, f: &Fragment) -> Option<&mut FragmentRecord> {
        let (bit, record) = self.record.as_mut()?;
        (*bit == f.bit).then_some(record)
    }

    pub(super) fn ended(&mut self, f: &Fragment, end: FragmentEnd) {
        if let Some(r) = self.record_of(f) {
            r.end = end;
        }
    }

    /// A stencil operation is applied to a fragment.
    pub(super) fn operated(&mut self, f: &Fragment, op: StencilOperation) {
        if self.record_of(f).is_some() {
            self.operation = Some(op);
        }
    }

    /// Hands everything over.
    pub(super) fn end(self) {
        if self.record.is_some() {
            self.to.operations.push(self.operation);
        }
        for ([slot, level, layer, y, x], (texels, taps)) in self.texels {
            self.to.texels.push(TexelAccess {
                event: self.event,
                slot: slot as u8,
                mip: level as u8,
                layer: layer as u16,
                block: [x as u16, y as u16],
                texels,
                taps,
            });
        }
        self.to.outputs.extend(self.shaded);
        self.to.fragments.extend(self.record.map(|(_, r)| r));
    }
}

/// Takes down what the probed pixel of images `width` wide holds now.
pub(super) fn look(log: Log, width: u32, images: &Images, to: &mut EventDetails) {
    let Some([x, y]) = log.probe else { return };
    let at = y as usize * width as usize + x as usize;
    to.looks.push(Look {
        color: images.color.iter().map(|i| i.texels[at]).collect(),
        depth: images.depth.as_ref().map(|d| (d.depth[at], d.stencil[at])),
    });
}

fn bits(v: f32) -> u32 {
    if v.is_nan() { 0x7fc0_0000 } else { v.to_bits() }
}

impl Block<'_> {
    /// Begins the record of the probed pixel, if it is among the fragments.
    pub(super) fn begin_record(&mut self, fragments: &[Fragment]) {
        let found = fragments
            .iter()
            .find(|f| self.ctx.log.probe == Some([f.x, f.y]));
        let Some(f) = found else { return };
        let mut record = FragmentRecord {
            event: self.log.event,
            depth: self.ctx.pass.depth.as_ref().map(|_| f.depth),
            ..FragmentRecord::default()
        };
        self.look_at(f.at, &mut record, 0);
        self.log.record = Some((f.bit, record));
    }

    /// Ends it.
    pub(super) fn end_record(&mut self) {
        let Some((bit, mut record)) = self.log.record.take() else {
            return;
        };
        let k = bit.trailing_zeros();
        self.look_at(self.place(self.x + k % 8, self.y + k / 8), &mut record, 1);
        self.log.record = Some((bit, record));
    }

    /// What the attachments hold now.
    fn look_at(&self, at: usize, record: &mut FragmentRecord, when: usize) {
        if let Some(d) = self
            .images
            .depth
            .as_ref()
            .filter(|_| self.ctx.pass.depth.is_some())
        {
            record.stored_depth[when] = d.depth[at];
            record.stencil[when] = d.stencil[at];
        }
        for (k, used) in self.ctx.pass.color.iter().enumerate() {
            record.color[k][when] = self.images.color[used.image].texels[at];
        }
    }

    /// A fragment was shaded.
    pub(super) fn shaded_record(&mut self, f: &Fragment, out: &ScalarFragmentOutput) {
        let attachments = self.ctx.pass.color.len();
        let program = self.ctx.draw.program.as_ref().expect("it was shaded");
        let mut source = [[0; 4]; 4];
        for (k, s) in source.iter_mut().enumerate().take(attachments) {
            *s = out.color[k].map(|v| if out.integer[k] { v.to_bits() } else { bits(v) });
        }
        let first = self.log.to.values.len() as u32;
        let block = self.log.shaded.get_or_insert(ShadedBlock {
            event: self.log.event,
            first,
            ..ShadedBlock::default()
        });
        block.shaded |= f.bit;
        if out.discard {
            block.discarded |= f.bit;
        } else {
            for k in 0..attachments {
                block.integers[k] |= if out.integer[k] { f.bit } else { 0 };
                self.log.to.values.extend(source[k]);
            }
            if program.depth.is_some() {
                self.log.to.values.push(bits(out.depth));
            }
        }
        let varyings = self.tri.varyings.at(f.x, f.y).map(bits);
        let attached = self.ctx.pass.depth.is_some();
        if let Some(r) = self.log.record_of(f) {
            r.varyings = Some(varyings);
            r.source = (!out.discard).then_some(source);
            if program.depth.is_some() {
                r.depth = (attached && !out.discard).then_some(0);
            }
        }
    }

    /// The shader has given the fragment another depth.
    pub(super) fn depth_record(&mut self, f: &Fragment) {
        if let Some(FragmentRecord { depth: Some(d), .. }) = self.log.record_of(f) {
            *d = f.depth;
        }
    }

    /// Hashes the block if it was written.
    pub(super) fn see_block(&mut self) {
        let a = &self.access;
        let colors = a.color_write.iter().any(|c| *c != 0);
        if !self.ctx.log.witness || (a.z_write == 0 && a.stencil_write == 0 && !colors) {
            return;
        }
        let mut hash = BlockHash::default();
        for (x, y) in self.pixels().into_iter().filter(|&p| self.in_image(p)) {
            let at = self.place(x, y);
            if let Some(d) = self
                .images
                .depth
                .as_ref()
                .filter(|_| self.ctx.pass.depth.is_some())
            {
                hash.word(d.depth[at]);
                hash.word(d.stencil[at].into());
            }
            for used in &self.ctx.pass.color {
                let texel = self.images.color[used.image].texels[at];
                texel.into_iter().for_each(|c| hash.word(c));
            }
        }
        self.access.witness = hash.0;
    }
}
