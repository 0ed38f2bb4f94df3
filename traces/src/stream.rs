//! The accesses of a recorded frame, as the observer of the run without skipping was told
//! of them.

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, TexelAccess, TextureDescriptor, TextureDimension,
};

use crate::error::TraceError;
use crate::format::events::{EventReader, TexelReader};
use crate::format::section::Entry;
use crate::shape::{FrameShape, PassShape};
use crate::trace::{TEXL, TRAF, Trace};

/// Accesses of a batch.
const BATCH: usize = 1 << 15;

impl Trace {
    /// Tells `observer` of all accesses of a frame drawn without skipping, pass by pass,
    /// as [`Gpu::submit_observed`](gnomon_raster::Gpu::submit_observed) does: with depth
    /// ranges, texels and the low byte of [`Witness`](crate::Witness), and at the end of
    /// each pass what it counted. No shader is needed.
    ///
    /// # Errors
    /// There is no such frame, no traffic was recorded, or it is damaged: what was told
    /// until then is right.
    pub fn events(
        &self,
        frame: usize,
        observer: &mut dyn AccessObserver,
    ) -> Result<(), TraceError> {
        let shape = self.shape(frame)?;
        let Some(counters) = self.counters(frame)?.unskipped else {
            return Err(self.missing(TRAF, frame));
        };
        for (number, report) in counters.passes.iter().enumerate() {
            self.pass_events(frame, &shape, number, observer)?;
            observer.end(number, report);
        }
        Ok(())
    }

    fn pass_events(
        &self,
        frame: usize,
        shape: &FrameShape,
        pass: usize,
        observer: &mut dyn AccessObserver,
    ) -> Result<(), TraceError> {
        let sections = self.pass_sections(frame, pass)?;
        let mut stream = sections.stream(shape, pass)?;
        while let Some(batch) = stream.next()? {
            observer.batch(pass, &batch);
        }
        Ok(())
    }

    /// What is written of a pass's accesses.
    pub(crate) fn pass_sections(
        &self,
        frame: usize,
        pass: usize,
    ) -> Result<PassSections, TraceError> {
        let of = |tag| self.section(tag, frame as u32, pass as u32);
        Ok(PassSections {
            events: of(TRAF)?.ok_or_else(|| self.missing(TRAF, frame))?,
            texels: of(TEXL)?,
        })
    }
}

/// Sections of a pass, unpacked.
pub(crate) struct PassSections {
    events: (Entry, Vec<u8>),
    texels: Option<(Entry, Vec<u8>)>,
}

impl PassSections {
    /// Their accesses; the sections are of pass number `pass` of the frame `shape`.
    pub(crate) fn stream<'a>(
        &'a self,
        shape: &'a FrameShape,
        pass: usize,
    ) -> Result<PassStream<'a>, TraceError> {
        let (entry, data) = &self.events;
        let events = EventReader::new(data).map_err(|e| entry.wrong(&e))?;
        let texels = match &self.texels {
            None => None,
            Some((entry, data)) => {
                let reader = TexelReader::new(data).map_err(|e| entry.wrong(&e))?;
                Some((entry, reader))
            }
        };
        Ok(PassStream {
            valid: Valid::new(shape, &shape.passes[pass]),
            entry,
            events,
            texels,
            batch: Batch::default(),
        })
    }
}

/// The accesses of a pass, batch after batch.
pub(crate) struct PassStream<'a> {
    valid: Valid<'a>,
    entry: &'a Entry,
    events: EventReader<'a>,
    texels: Option<(&'a Entry, TexelReader<'a>)>,
    batch: Batch,
}

impl PassStream<'_> {
    /// The next ones; `None` behind the last.
    pub(crate) fn next(&mut self) -> Result<Option<AccessBatch<'_>>, TraceError> {
        let batch = &mut self.batch;
        let taken = batch.take(&mut self.events, &self.valid);
        let any = taken.map_err(|e| self.entry.wrong(&e))?;
        if let Some((entry, reader)) = &mut self.texels {
            let taken = match any {
                true => batch.take_texels(reader, &self.valid),
                false => reader.finish(),
            };
            taken.map_err(|e| entry.wrong(&e))?;
        }
        let told = AccessBatch::new(&batch.blocks).with_texels(&batch.texels);
        Ok(any.then_some(told))
    }
}

/// The next accesses of a pass.
#[derive(Default)]
struct Batch {
    blocks: Vec<BlockAccess>,
    texels: Vec<TexelAccess>,
    /// Number of the first in the pass.
    first: u64,
}

impl Batch {
    /// Reads the next accesses; false where there are none.
    fn take(&mut self, events: &mut EventReader<'_>, valid: &Valid<'_>) -> Result<bool, String> {
        self.first += self.blocks.len() as u64;
        self.blocks.clear();
        while self.blocks.len() < BATCH
            && let Some(block) = events.next()?
        {
            valid.check(&block)?;
            self.blocks.push(block);
        }
        Ok(!self.blocks.is_empty())
    }

    fn take_texels(
        &mut self,
        reader: &mut TexelReader<'_>,
        valid: &Valid<'_>,
    ) -> Result<(), String> {
        self.texels.clear();
        let end = self.first + self.blocks.len() as u64;
        while let Some((event, mut texel)) = reader.next_before(end)? {
            texel.event = (event - self.first) as u32;
            valid.check_texel(&self.blocks[texel.event as usize], &texel)?;
            self.texels.push(texel);
        }
        Ok(())
    }
}

/// What accesses of a pass can be of.
struct Valid<'a> {
    shape: &'a FrameShape,
    pass: &'a PassShape,
    /// Columns and rows of blocks.
    blocks: [u32; 2],
}

impl<'a> Valid<'a> {
    fn new(shape: &'a FrameShape, pass: &'a PassShape) -> Self {
        let color = pass.color.first().map(|a| (a.texture, a.subresource));
        let depth = pass.depth_stencil.as_ref();
        let depth = depth.map(|a| (a.texture, a.subresource));
        let size = color.or(depth).map_or([0; 2], |(id, s)| {
            let d = &shape.textures[id.index()];
            [0, 1].map(|k| level(d.size[k], s.mip))
        });
        Self {
            shape,
            pass,
            blocks: size.map(|s| s.div_ceil(8)),
        }
    }

    fn check(&self, b: &BlockAccess) -> Result<(), String> {
        let draws = self.pass.draws.len();
        if b.draw as usize >= draws {
            return Err(format!(
                "an access is of draw {}, there are {draws}",
                b.draw
            ));
        }
        let [columns, rows] = self.blocks;
        if u32::from(b.block[0]) >= columns || u32::from(b.block[1]) >= rows {
            let [x, y] = b.block;
            return Err(format!("block ({x}, {y}) is none of {columns}×{rows}"));
        }
        let ends = b.ended.bounds | b.ended.stencil | b.ended.depth | b.ended.discarded;
        match ends & !b.covered {
            0 => Ok(()),
            _ => Err("fragments ended that were none".to_owned()),
        }
    }

    fn check_texel(&self, block: &BlockAccess, t: &TexelAccess) -> Result<(), String> {
        let draw = &self.pass.draws[block.draw as usize];
        let bound = draw.textures.get(usize::from(t.slot));
        let d = bound.map(|b| &self.shape.textures[b.texture.index()]);
        match d {
            Some(d) if has_block(d, t) => Ok(()),
            _ => Err(format!(
                "draw {} reads block {:?} of mip {}, layer {} in slot {}, which is not there",
                block.draw, t.block, t.mip, t.layer, t.slot
            )),
        }
    }
}

fn level(size: u32, mip: u32) -> u32 {
    (size >> mip.min(31)).max(1)
}

fn has_block(d: &TextureDescriptor, t: &TexelAccess) -> bool {
    let mip = u32::from(t.mip);
    let layers = match d.dimension {
        TextureDimension::Cube => 6,
        _ => level(d.size[2], mip),
    };
    let inside = |k: usize| 8 * u32::from(t.block[k]) < level(d.size[k], mip);
    mip < d.mip_levels && u32::from(t.layer) < layers && inside(0) && inside(1)
}
