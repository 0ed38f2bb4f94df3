//! `TRAF` and `TEXL`: block accesses of a pass, and the texels that they read.
//!
//! Of `TRAF`, column 0 is the draw's difference from the record before, 1 the primitive's
//! (from 0 where the draw is another), 2 the piece, 3 and 4 the block's differences, 5 to
//! 9 the code, 10 masks that the code does not tell, 11 to 14 depths (`span`, `stored`:
//! the least as a difference from the one before, the greatest from the least), 15 the
//! witness's low byte where the code says that there is one.
//!
//! The code has 2 bits for each mask (0 none, 1 all covered, 2 in column 10, 3 all that
//! was written), then a bit each: the whole block is covered, thrown away by zmin/zmax,
//! front-facing, zmin/zmax read, written, witness.

use gnomon_raster::{BlockAccess, MAX_COLOR_ATTACHMENTS, TexelAccess};

use super::columns::{Reader, Writer};

const COLUMNS: usize = 16;
const CODE: usize = 5;
const CODE_BYTES: usize = 5;
const OTHERS: usize = 10;
const DEPTHS: usize = 11;
const WITNESS: usize = 15;
/// The code's two bits of a mask that it does not tell.
const OTHER: u64 = 2;
/// Masks that have two bits of the code.
const MASKS: usize = 8 + 2 * MAX_COLOR_ATTACHMENTS;
/// The first bit behind them.
const FLAGS: usize = 2 * MASKS;

const FULL: u64 = 1 << FLAGS;
const HIZ: u64 = 1 << (FLAGS + 1);
const FRONT: u64 = 1 << (FLAGS + 2);
const HIZ_READ: u64 = 1 << (FLAGS + 3);
const HIZ_WRITE: u64 = 1 << (FLAGS + 4);
const WITNESSED: u64 = 1 << (FLAGS + 5);
const _: () = assert!(FLAGS + 6 <= 8 * CODE_BYTES);

/// All masks but `covered`, those of ends first, from which follows what was written.
fn masks(b: &mut BlockAccess) -> [&mut u64; MASKS] {
    let [r0, r1, r2, r3] = &mut b.color_read;
    let [w0, w1, w2, w3] = &mut b.color_write;
    [
        &mut b.ended.bounds,
        &mut b.ended.stencil,
        &mut b.ended.depth,
        &mut b.ended.discarded,
        &mut b.z_read,
        &mut b.z_write,
        &mut b.stencil_read,
        &mut b.stencil_write,
        r0,
        r1,
        r2,
        r3,
        w0,
        w1,
        w2,
        w3,
    ]
}

/// Masks of ends: what was written is not known before them.
const ENDS: usize = 4;

/// Writes the accesses of a pass.
pub(crate) struct EventWriter {
    columns: Writer,
    last: Place,
}

/// Of an access, what the next one is told apart from.
#[derive(Clone, Copy, Default)]
struct Place {
    draw: u32,
    primitive: u32,
    block: [u16; 2],
    depths: [u32; 2],
}

impl EventWriter {
    pub(crate) fn new() -> Self {
        Self {
            columns: Writer::new(COLUMNS),
            last: Place::default(),
        }
    }

    pub(crate) fn push(&mut self, block: &BlockAccess) {
        let (c, last) = (&mut self.columns, &self.last);
        c.begin();
        c.number(0, u64::from(block.draw - last.draw));
        let primitive = if block.draw == last.draw {
            last.primitive
        } else {
            0
        };
        c.number(1, u64::from(block.primitive - primitive));
        c.number(2, block.piece.into());
        for k in 0..2 {
            c.difference(3 + k, last.block[k].into(), block.block[k].into());
        }
        let depths = [block.span, block.stored];
        for k in 0..2 {
            let (least, greatest) = (u64::from(depths[k][0]), u64::from(depths[k][1]));
            c.difference(DEPTHS + 2 * k, last.depths[k].into(), least);
            c.difference(DEPTHS + 2 * k + 1, least, greatest);
        }
        self.last = Place {
            draw: block.draw,
            primitive: block.primitive,
            block: block.block,
            depths: [block.span[0], block.stored[0]],
        };
        self.code(block);
    }

    /// The code, and the masks that it does not tell. Plain loops: what iterators call
    /// would be called for each mask.
    fn code(&mut self, b: &BlockAccess) {
        let c = &mut self.columns;
        let (covered, written) = (b.covered, b.written());
        let flags = [
            (covered == u64::MAX, FULL),
            (b.ended.hiz, HIZ),
            (b.front, FRONT),
            (b.hiz_read, HIZ_READ),
            (b.hiz_write, HIZ_WRITE),
            (b.witness != 0, WITNESSED),
        ];
        let mut code = 0;
        for i in 0..flags.len() {
            code |= u64::from(flags[i].0) * flags[i].1;
        }
        if covered != u64::MAX {
            c.mask(OTHERS, covered);
        }
        let masks = masks_of(b);
        for i in 0..MASKS {
            let kind = kind(masks[i], covered, written, i >= ENDS);
            if kind == OTHER {
                c.mask(OTHERS, masks[i]);
            }
            code |= kind << (2 * i);
        }
        for k in 0..CODE_BYTES {
            c.byte(CODE + k, (code >> (8 * k)) as u8);
        }
        if b.witness != 0 {
            c.byte(WITNESS, b.witness as u8);
        }
    }

    pub(crate) fn finish(self) -> Vec<u8> {
        self.columns.finish()
    }
}

/// The masks as [`masks`] orders them.
#[inline]
fn masks_of(b: &BlockAccess) -> [u64; MASKS] {
    let [r0, r1, r2, r3] = b.color_read;
    let [w0, w1, w2, w3] = b.color_write;
    let e = &b.ended;
    [
        e.bounds,
        e.stencil,
        e.depth,
        e.discarded,
        b.z_read,
        b.z_write,
        b.stencil_read,
        b.stencil_write,
        r0,
        r1,
        r2,
        r3,
        w0,
        w1,
        w2,
        w3,
    ]
}

/// A mask's two bits of the code.
#[inline]
fn kind(mask: u64, covered: u64, written: u64, may_be_written: bool) -> u64 {
    match mask {
        0 => 0,
        m if m == covered => 1,
        m if m == written && may_be_written => 3,
        _ => OTHER,
    }
}

/// Reads the accesses of a pass again.
pub(crate) struct EventReader<'a> {
    columns: Reader<'a>,
    left: u64,
    last: BlockAccess,
}

impl<'a> EventReader<'a> {
    pub(crate) fn new(data: &'a [u8]) -> Result<Self, String> {
        let columns = Reader::new(data, COLUMNS)?;
        Ok(Self {
            left: columns.records(),
            columns,
            last: BlockAccess::default(),
        })
    }

    /// The next access; `None` behind the last.
    pub(crate) fn next(&mut self) -> Result<Option<BlockAccess>, String> {
        if self.left == 0 {
            self.columns.finish()?;
            return Ok(None);
        }
        self.left -= 1;
        let mut b = BlockAccess::default();
        self.place(&mut b)?;
        self.masks(&mut b)?;
        self.depths(&mut b)?;
        self.last = b;
        Ok(Some(b))
    }

    fn place(&mut self, b: &mut BlockAccess) -> Result<(), String> {
        let (c, last) = (&mut self.columns, &self.last);
        let sum = |a: u32, d: u32| a.checked_add(d).ok_or("a number exceeds 32 bits");
        b.draw = sum(last.draw, c.small(0)?)?;
        let primitive = if b.draw == last.draw {
            last.primitive
        } else {
            0
        };
        b.primitive = sum(primitive, c.small(1)?)?;
        b.piece = c.small(2)?;
        for k in 0..2 {
            b.block[k] = c.difference(3 + k, last.block[k].into())?;
        }
        Ok(())
    }

    fn masks(&mut self, b: &mut BlockAccess) -> Result<(), String> {
        let c = &mut self.columns;
        let mut code = 0;
        for k in 0..CODE_BYTES {
            code |= u64::from(c.byte(CODE + k)?) << (8 * k);
        }
        if code >> (FLAGS + 6) != 0 {
            return Err(format!("code {code:#x} has bits that are not known"));
        }
        b.ended.hiz = code & HIZ != 0;
        b.front = code & FRONT != 0;
        b.hiz_read = code & HIZ_READ != 0;
        b.hiz_write = code & HIZ_WRITE != 0;
        b.covered = match code & FULL {
            0 => c.mask(OTHERS)?,
            _ => u64::MAX,
        };
        for i in 0..MASKS {
            let mask = match code >> (2 * i) & 3 {
                0 => 0,
                1 => b.covered,
                2 => c.mask(OTHERS)?,
                _ if i < ENDS => return Err(format!("code {code:#x} has an end that was written")),
                _ => b.written(),
            };
            *masks(b)[i] = mask;
        }
        if code & WITNESSED != 0 {
            b.witness = c.byte(WITNESS)?.into();
        }
        Ok(())
    }

    fn depths(&mut self, b: &mut BlockAccess) -> Result<(), String> {
        let (c, last) = (&mut self.columns, &self.last);
        for (k, (to, before)) in [(&mut b.span, last.span), (&mut b.stored, last.stored)]
            .into_iter()
            .enumerate()
        {
            to[0] = c.difference(DEPTHS + 2 * k, before[0].into())?;
            to[1] = c.difference(DEPTHS + 2 * k + 1, to[0].into())?;
        }
        Ok(())
    }
}

const TEXEL_COLUMNS: usize = 8;

/// Writes the texels of a pass: their events are counted over the pass.
pub(crate) struct TexelWriter {
    columns: Writer,
    last: (u64, TexelAccess),
}

impl TexelWriter {
    pub(crate) fn new() -> Self {
        Self {
            columns: Writer::new(TEXEL_COLUMNS),
            last: (0, TexelAccess::default()),
        }
    }

    /// Adds `texel` of event number `event` of the pass.
    pub(crate) fn push(&mut self, event: u64, texel: &TexelAccess) {
        let (c, last) = (&mut self.columns, &self.last);
        c.begin();
        c.number(0, event - last.0);
        c.byte(1, texel.slot);
        c.byte(2, texel.mip);
        c.number(3, texel.layer.into());
        for k in 0..2 {
            c.difference(4 + k, last.1.block[k].into(), texel.block[k].into());
        }
        c.mask(6, texel.texels);
        c.number(7, texel.taps.into());
        self.last = (event, *texel);
    }

    pub(crate) fn finish(self) -> Vec<u8> {
        self.columns.finish()
    }
}

/// Reads the texels of a pass again.
pub(crate) struct TexelReader<'a> {
    columns: Reader<'a>,
    left: u64,
    last: (u64, TexelAccess),
    /// Read already, of an event to come.
    waiting: Option<(u64, TexelAccess)>,
}

impl<'a> TexelReader<'a> {
    pub(crate) fn new(data: &'a [u8]) -> Result<Self, String> {
        let columns = Reader::new(data, TEXEL_COLUMNS)?;
        Ok(Self {
            left: columns.records(),
            columns,
            last: (0, TexelAccess::default()),
            waiting: None,
        })
    }

    /// The next texels of an event before number `end`, and the event's number.
    pub(crate) fn next_before(&mut self, end: u64) -> Result<Option<(u64, TexelAccess)>, String> {
        if self.waiting.is_none() && self.left > 0 {
            self.waiting = Some(self.read()?);
        }
        Ok(self.waiting.take_if(|(event, _)| *event < end))
    }

    /// Nothing is left.
    pub(crate) fn finish(&self) -> Result<(), String> {
        match (&self.waiting, self.left) {
            (None, 0) => self.columns.finish(),
            _ => Err("texels are of events that are not there".to_owned()),
        }
    }

    fn read(&mut self) -> Result<(u64, TexelAccess), String> {
        self.left -= 1;
        let (c, (event, last)) = (&mut self.columns, &self.last);
        let event = event
            .checked_add(c.number(0)?)
            .ok_or("a number exceeds 64 bits")?;
        let mut t = TexelAccess {
            slot: c.byte(1)?,
            mip: c.byte(2)?,
            layer: c.small(3)?,
            ..TexelAccess::default()
        };
        for k in 0..2 {
            t.block[k] = c.difference(4 + k, last.block[k].into())?;
        }
        t.texels = c.mask(6)?;
        t.taps = c.small(7)?;
        self.last = (event, t);
        Ok((event, t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gnomon_raster::Ended;

    /// xorshift: masks of all kinds.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> u64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            self.0
        }

        fn mask(&mut self, covered: u64) -> u64 {
            match self.next() % 4 {
                0 => 0,
                1 => covered,
                _ => covered & self.next(),
            }
        }

        fn block(&mut self, draw: u32, primitive: u32) -> BlockAccess {
            let covered = if self.next() & 1 == 0 {
                u64::MAX
            } else {
                self.next()
            };
            let mut ends = [0; 4];
            let mut left = covered;
            for end in &mut ends {
                *end = self.mask(left);
                left &= !*end;
            }
            let [bounds, stencil, depth, discarded] = ends;
            let mut b = BlockAccess {
                draw,
                primitive,
                piece: (self.next() % 3) as u32,
                block: [self.next() as u16, self.next() as u16],
                covered,
                ended: Ended {
                    hiz: self.next() & 7 == 0,
                    bounds,
                    stencil,
                    depth,
                    discarded,
                },
                span: [self.next() as u32, self.next() as u32],
                stored: [self.next() as u32, self.next() as u32],
                witness: self.next() & self.next() & 0xff,
                front: self.next() & 1 == 0,
                hiz_read: self.next() & 1 == 0,
                hiz_write: self.next() & 1 == 0,
                ..BlockAccess::default()
            };
            let written = b.written();
            for i in ENDS..MASKS {
                let mask = if self.next() & 3 == 0 {
                    written
                } else {
                    self.mask(covered)
                };
                *masks(&mut b)[i] = mask;
            }
            b
        }
    }

    fn events() -> Vec<BlockAccess> {
        let mut r = Random(0x9e37_79b9_7f4a_7c15);
        let at = |i: u32| (i / 300, i % 300 / 2);
        (0..2000).map(|i| r.block(at(i).0, at(i).1)).collect()
    }

    #[test]
    fn events_come_back() {
        let all = events();
        let mut w = EventWriter::new();
        all.iter().for_each(|b| w.push(b));
        let data = w.finish();
        let mut r = EventReader::new(&data).unwrap();
        assert_eq!(r.left, 2000);
        for b in &all {
            assert_eq!(r.next().unwrap().as_ref(), Some(b));
        }
        assert_eq!(r.next(), Ok(None));
    }

    #[test]
    fn texels_come_back_with_their_events() {
        let mut r = Random(1);
        let texels: Vec<(u64, TexelAccess)> = (0..500)
            .map(|i| {
                let texel = TexelAccess {
                    event: 0,
                    slot: (i % 8) as u8,
                    mip: (r.next() % 12) as u8,
                    layer: r.next() as u16,
                    block: [r.next() as u16, r.next() as u16],
                    texels: r.next(),
                    taps: r.next() as u32,
                };
                (i / 3 * 5, texel)
            })
            .collect();
        let mut w = TexelWriter::new();
        texels.iter().for_each(|(event, t)| w.push(*event, t));
        let data = w.finish();
        let mut r = TexelReader::new(&data).unwrap();
        let (mut found, mut end) = (Vec::new(), 0);
        while found.len() < texels.len() {
            end += 7;
            while let Some(texel) = r.next_before(end).unwrap() {
                assert!(texel.0 < end && texel.0 + 7 >= end);
                found.push(texel);
            }
        }
        assert_eq!(found, texels);
        r.finish().unwrap();
    }

    #[test]
    fn codes_that_are_not_known_are_refused() {
        let mut w = EventWriter::new();
        w.push(&BlockAccess::default());
        let data = w.finish();
        // Behind the head, a byte in each column before the last byte of the code.
        let last = 12 + 8 * COLUMNS + CODE + CODE_BYTES - 1;
        let read = |bits: u8| {
            let mut data = data.clone();
            data[last] |= bits;
            EventReader::new(&data).unwrap().next().map(|b| b.unwrap())
        };
        assert!(read(HIZ_READ.to_le_bytes()[4]).unwrap().hiz_read);
        for bits in [0x40, 0x80] {
            assert!(read(bits).unwrap_err().contains("not known"), "{bits:#x}");
        }
    }
}
