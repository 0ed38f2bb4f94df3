//! Which texels an event reads, for whoever asks.

use super::BoundTexture;
use super::fetch::Texels;
use crate::observer::TexelAccess;
use crate::simd::LANES;
use crate::texture::BLOCK;

/// Texels of a block.
const TEXELS: u32 = BLOCK * BLOCK;

/// Texels that fragments read and that are counted, and before them those of earlier
/// events, folded; those of an event in no order that others could rely on.
pub(crate) struct TexelLog {
    /// Of earlier events.
    folded: Vec<TexelAccess>,
    /// Of the event that is on its way: those of one block nearly always together.
    reads: Vec<Read>,
    /// Where blocks are among `reads`, by a few bits of where they are stored: an event
    /// reads the same few again and again.
    known: [u32; KNOWN],
}

/// Blocks of an event that are found at once.
const KNOWN: usize = 64;

impl Default for TexelLog {
    fn default() -> Self {
        Self {
            folded: Vec::new(),
            reads: Vec::new(),
            known: [0; KNOWN],
        }
    }
}

/// Reads of one block of a texture; ordered by where it is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Read {
    slot: u8,
    mip: u8,
    layer: u16,
    /// Where the block is stored.
    index: u32,
    texels: u64,
    taps: u32,
}

impl Read {
    fn is_beside(&self, other: &Self) -> bool {
        let place = |r: &Self| (r.slot, r.mip, r.layer, r.index);
        place(self) == place(other)
    }

    /// A number below [`KNOWN`].
    fn spread(&self) -> usize {
        let image =
            (u32::from(self.slot) << 4) ^ (u32::from(self.mip) << 3) ^ u32::from(self.layer);
        (self.index ^ image.wrapping_mul(7)) as usize % KNOWN
    }

    /// Takes the reads of the same block in.
    fn join(&mut self, other: &Self) {
        self.texels |= other.texels;
        self.taps += other.taps;
    }
}

/// The log of reads of one texture slot.
pub(crate) struct SlotLog<'a> {
    log: &'a mut TexelLog,
    slot: u8,
    /// Lanes whose reads are counted.
    counted: u16,
}

impl TexelLog {
    /// For reads of `slot`, of which those of the lanes `counted` are.
    #[inline(always)]
    pub(crate) fn of_slot(&mut self, slot: usize, counted: u16) -> SlotLog<'_> {
        SlotLog {
            log: self,
            slot: slot as u8,
            counted,
        }
    }

    fn add(&mut self, read: &Read) {
        // What is known of earlier events points anywhere, and is seen to be another block.
        let known = &mut self.known[read.spread()];
        match self.reads.get_mut(*known as usize) {
            Some(same) if same.is_beside(read) => same.join(read),
            _ => {
                *known = self.reads.len() as u32;
                self.reads.push(*read);
            }
        }
    }

    /// Accesses of events that have ended.
    pub(crate) fn folded(&mut self) -> &mut Vec<TexelAccess> {
        &mut self.folded
    }

    /// Makes accesses of event number `event` from the reads since the last one.
    pub(crate) fn end_event(&mut self, event: u32, textures: &[BoundTexture<'_>]) {
        if self.reads.is_empty() {
            return;
        }
        self.reads.sort_unstable();
        for same in self.reads.chunk_by(Read::is_beside) {
            let mut all = same[0];
            same[1..].iter().for_each(|r| all.join(r));
            let layout = &textures[usize::from(all.slot)].texture.layouts[usize::from(all.mip)];
            let (x, y) = layout.tile_origin(all.index as usize);
            self.folded.push(TexelAccess {
                event,
                slot: all.slot,
                mip: all.mip,
                layer: all.layer,
                block: [(x / BLOCK) as u16, (y / BLOCK) as u16],
                texels: all.texels,
                taps: all.taps,
            });
        }
        self.reads.clear();
    }
}

impl SlotLog<'_> {
    /// Adds those of `texels` that are counted.
    #[cold]
    #[inline(never)]
    pub(super) fn add(&mut self, texels: &Texels<'_>) {
        let lanes = texels.lanes & self.counted;
        for lane in (0..LANES).filter(|lane| lanes >> lane & 1 != 0) {
            let at = texels.at[lane];
            let read = Read {
                slot: self.slot,
                mip: texels.mip as u8,
                layer: texels.layer[lane] as u16,
                index: at / TEXELS,
                texels: 1 << (at % TEXELS),
                taps: 1,
            };
            self.log.add(&read);
        }
    }
}
