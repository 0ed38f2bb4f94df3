//! A cache of lines of pixels with write-back and LRU, and the states of the blocks
//! behind it.

use super::charge::{At, Client, Ledger, Level, Way, shares};
use super::codec::RAW;
use super::model::{CacheKind, Port};

/// What memory holds of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineState {
    /// The clear value, known on chip.
    Clear,
    /// Compressed, in `64 · (class + 1)` bytes.
    Compressed(u8),
    /// As it is, until the next clear.
    Raw,
}

/// Every line that any attachment has.
#[derive(Debug, Default)]
pub(super) struct Lines {
    pub(super) state: Vec<LineState>,
    /// Where it is charged.
    pub(super) cell: Vec<u32>,
    /// How far the line's pixels lie behind the first of their block.
    pub(super) shift: Vec<u8>,
    /// Lines that have been written back since somebody looked.
    pub(super) written: Vec<bool>,
    /// Bytes of a pixel.
    pub(super) bytes: Vec<u8>,
}

impl Lines {
    pub(super) fn push(&mut self, cell: u32, shift: u8, bytes: u8) {
        self.state.push(LineState::Raw);
        self.cell.push(cell);
        self.shift.push(shift);
        self.written.push(false);
        self.bytes.push(bytes);
    }

    /// Pixels of a line.
    pub(super) fn pixels(&self, line: usize) -> u32 {
        pixels_of(self.bytes[line])
    }

    /// All pixels of a line.
    fn whole(&self, line: usize) -> u64 {
        u64::MAX >> (64 - self.pixels(line))
    }

    /// Bytes of a line in memory.
    pub(super) fn stored_bytes(&self, line: usize) -> u64 {
        match self.state[line] {
            LineState::Clear => 0,
            LineState::Compressed(class) => 64 * (u64::from(class) + 1),
            LineState::Raw => u64::from(self.pixels(line)) * u64::from(self.bytes[line]),
        }
    }
}

/// A line holds at most 256 bytes, and at most the 64 pixels of a block.
pub(super) fn pixels_of(bytes: u8) -> u32 {
    (256 / u32::from(bytes.max(1))).min(64)
}

/// What an event wants of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Want {
    pub(super) line: u32,
    /// Pixels of the line.
    pub(super) read: u64,
    pub(super) write: u64,
    /// What the codec makes of it after the write.
    pub(super) class: u8,
}

/// Sums in bytes of words, whatever was moved for them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DirtyBytes {
    /// Words that became dirty.
    pub dirtied: u64,
    /// Dirty words that were written back before the end of the frame.
    pub written_back: u64,
    /// Dirty words that were left at the end.
    pub flushed: u64,
}

/// What a cache counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CacheCounts {
    /// Line accesses that found their line.
    pub hits: u64,
    /// Line accesses that did not.
    pub misses: u64,
    /// Dirty words.
    pub dirty: DirtyBytes,
    /// Lines that were dirty at the end of the frame.
    pub flushed_lines: u64,
}

#[derive(Clone, Debug, Default)]
struct Slot {
    line: u32,
    used: u64,
    valid: u64,
    dirty: u64,
    class: u8,
    client: u8,
    /// Who made how many bytes dirty.
    by: Vec<(u32, u64)>,
}

const NOBODY: u32 = u32::MAX;

/// The cache of one kind of client.
#[derive(Debug)]
pub(super) struct Cache {
    port: Port,
    slots: Vec<Slot>,
    /// Slot of each line, where every line has one.
    place: Vec<u32>,
    clock: u64,
    pub(super) counts: CacheCounts,
}

impl Cache {
    pub(super) fn new(port: &Port) -> Self {
        let slots = match port.cache {
            CacheKind::Sets { sets, ways } => sets as usize * ways as usize,
            CacheKind::None | CacheKind::Infinite => 0,
        };
        let empty = Slot {
            line: NOBODY,
            ..Slot::default()
        };
        Self {
            port: *port,
            slots: vec![empty; slots],
            place: Vec::new(),
            clock: 0,
            counts: CacheCounts::default(),
        }
    }

    /// Reads and writes pixels of a line.
    pub(super) fn access(&mut self, lines: &mut Lines, ledger: &mut Ledger, at: At, want: Want) {
        let line = want.line as usize;
        if self.port.cache == CacheKind::None {
            let bytes = lines.bytes[line];
            let moved = |mask, part| expanded(mask, part, bytes);
            let read = moved(want.read, self.port.sector);
            ledger.charge(at, Level::Dram, Way::Read, read.1);
            let write = moved(want.write, self.port.grain);
            ledger.charge(at, Level::Dram, Way::Write, write.1);
            return;
        }
        let slot = self.slot(lines, ledger, at, want.line);
        self.clock += 1;
        self.slots[slot].used = self.clock;
        self.fetch(lines, ledger, at, slot, want.read);
        self.dirty(lines, at, slot, want);
    }

    /// The slot of `line`, made free for it where it has none.
    fn slot(&mut self, lines: &mut Lines, ledger: &mut Ledger, at: At, line: u32) -> usize {
        let (found, slot) = match self.port.cache {
            CacheKind::Sets { sets, ways } => self.search(line, sets, ways),
            _ => self.own_slot(line),
        };
        if found {
            self.counts.hits += 1;
            return slot;
        }
        self.counts.misses += 1;
        self.write_back(lines, ledger, slot, Some(at.row));
        let s = &mut self.slots[slot];
        (s.line, s.valid, s.dirty, s.class) = (line, 0, 0, RAW);
        s.client = at.client.index() as u8;
        slot
    }

    fn search(&self, line: u32, sets: u32, ways: u32) -> (bool, usize) {
        let first = ((line % sets) * ways) as usize;
        let set = &self.slots[first..first + ways as usize];
        if let Some(way) = set.iter().position(|s| s.line == line) {
            return (true, first + way);
        }
        let oldest = set.iter().enumerate().min_by_key(|(_, s)| s.used);
        (false, first + oldest.map_or(0, |(way, _)| way))
    }

    fn own_slot(&mut self, line: u32) -> (bool, usize) {
        let i = line as usize;
        if self.place.len() <= i {
            self.place.resize(i + 1, NOBODY);
        }
        if self.place[i] != NOBODY {
            let slot = self.place[i] as usize;
            return (self.slots[slot].line == line, slot);
        }
        self.place[i] = self.slots.len() as u32;
        self.slots.push(Slot {
            line: NOBODY,
            ..Slot::default()
        });
        (false, self.slots.len() - 1)
    }

    fn fetch(&mut self, lines: &Lines, ledger: &mut Ledger, at: At, slot: usize, read: u64) {
        let s = &mut self.slots[slot];
        let missing = read & !s.valid;
        if missing == 0 {
            return;
        }
        let line = s.line as usize;
        let bytes = if lines.state[line] == LineState::Raw {
            let (mask, bytes) = expanded(missing, self.port.sector, lines.bytes[line]);
            s.valid |= mask;
            bytes
        } else {
            s.valid = u64::MAX;
            lines.stored_bytes(line)
        };
        ledger.charge(at, Level::Dram, Way::Read, bytes);
    }

    fn dirty(&mut self, lines: &Lines, at: At, slot: usize, want: Want) {
        if want.write == 0 {
            return;
        }
        let s = &mut self.slots[slot];
        let new = want.write & !s.dirty;
        s.dirty |= want.write;
        s.valid |= want.write;
        s.class = want.class;
        let bytes = u64::from(new.count_ones()) * u64::from(lines.bytes[s.line as usize]);
        self.counts.dirty.dirtied += bytes;
        match s.by.last_mut() {
            Some((row, sum)) if *row == at.row => *sum += bytes,
            _ if bytes != 0 => s.by.push((at.row, bytes)),
            _ => {}
        }
    }

    /// Writes a slot back if it is dirty; `by` whom, unless it is the end of the frame.
    fn write_back(&mut self, lines: &mut Lines, ledger: &mut Ledger, slot: usize, by: Option<u32>) {
        let port = self.port;
        let s = &mut self.slots[slot];
        if s.dirty == 0 || s.line == NOBODY {
            return;
        }
        let line = s.line as usize;
        let completed = completion(lines, line, s.valid);
        let written = stored(lines, &port, line, s.dirty, s.class);
        lines.written[line] = true;
        let client = Client::all().nth(usize::from(s.client));
        let at = At {
            row: 0,
            client: client.unwrap_or(Client::DepthStencil),
            cell: lines.cell[line],
            mask: s.dirty << lines.shift[line],
        };
        pay(ledger, at, &s.by, Way::Read, completed);
        pay(ledger, at, &s.by, Way::Write, written);
        let words = u64::from(s.dirty.count_ones()) * u64::from(lines.bytes[line]);
        if let Some(row) = by {
            ledger.evicted[row as usize] += written;
            self.counts.dirty.written_back += words;
        } else {
            ledger.flushed[usize::from(s.client)] += written;
            self.counts.dirty.flushed += words;
            self.counts.flushed_lines += 1;
        }
        s.dirty = 0;
        s.by.clear();
    }

    /// Writes back and forgets the lines of a range; `by` whom, unless it is the end of
    /// the frame.
    pub(super) fn flush(
        &mut self,
        lines: &mut Lines,
        ledger: &mut Ledger,
        range: core::ops::Range<u32>,
        by: Option<u32>,
    ) {
        for slot in 0..self.slots.len() {
            if range.contains(&self.slots[slot].line) {
                self.write_back(lines, ledger, slot, by);
            }
        }
        self.forget(range);
    }

    /// Forgets the lines of a range, dirty or not: they are cleared.
    pub(super) fn forget(&mut self, range: core::ops::Range<u32>) {
        for s in &mut self.slots {
            if range.contains(&s.line) {
                let words = s.by.iter().map(|(_, bytes)| bytes).sum::<u64>();
                self.counts.dirty.dirtied -= words;
                (s.line, s.valid, s.dirty, s.used) = (NOBODY, 0, 0, 0);
                s.by.clear();
            }
        }
    }
}

/// Bytes to be read before a line can be written whole: what compressed it has to be
/// known where not all of it is in the cache.
fn completion(lines: &Lines, line: usize, valid: u64) -> u64 {
    let whole = lines.whole(line);
    match lines.state[line] {
        LineState::Compressed(_) if valid & whole != whole => lines.stored_bytes(line),
        _ => 0,
    }
}

/// Bytes that are written, and the line's state afterwards. Compression is tried only
/// where the line was cleared or compressed; of a raw line, parts without a dirty word
/// are not written.
fn stored(lines: &mut Lines, port: &Port, line: usize, dirty: u64, class: u8) -> u64 {
    if lines.state[line] == LineState::Raw {
        return expanded(dirty, port.grain, lines.bytes[line]).1;
    }
    let compresses = port.codec && class != RAW;
    lines.state[line] = match compresses {
        true => LineState::Compressed(class),
        false => LineState::Raw,
    };
    lines.stored_bytes(line)
}

fn pay(ledger: &mut Ledger, at: At, by: &[(u32, u64)], way: Way, bytes: u64) {
    if bytes == 0 {
        return;
    }
    if let [(row, _)] = by {
        ledger.charge_row(At { row: *row, ..at }, Level::Dram, way, bytes);
    } else {
        let weights: Vec<u64> = by.iter().map(|(_, dirtied)| *dirtied).collect();
        for ((row, _), bytes) in by.iter().zip(shares(bytes, &weights)) {
            ledger.charge_row(At { row: *row, ..at }, Level::Dram, way, bytes);
        }
    }
    ledger.charge_place(at, Level::Dram, way, bytes);
}

/// The pixels of the parts of `part` bytes that `mask` touches, and their bytes.
fn expanded(mask: u64, part: u32, bytes: u8) -> (u64, u64) {
    let bytes = u32::from(bytes.max(1));
    let pixels = (part / bytes).clamp(1, pixels_of(bytes as u8));
    if pixels == 1 {
        return (mask, u64::from(mask.count_ones() * bytes));
    }
    let one = u64::MAX >> (64 - pixels);
    let (mut all, mut left) = (0, mask);
    while left != 0 {
        let part = left.trailing_zeros() / pixels * pixels;
        all |= one << part;
        left &= !(one << part);
    }
    (all, u64::from(all.count_ones() * bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port(cache: CacheKind) -> Port {
        Port {
            cache,
            sector: 256,
            grain: 64,
            codec: false,
            fast_clear: false,
        }
    }

    fn lines(count: u32) -> Lines {
        let mut lines = Lines::default();
        (0..count).for_each(|_| lines.push(0, 0, 4));
        lines
    }

    const AT: At = At {
        row: 0,
        client: Client::DepthStencil,
        cell: 0,
        mask: 1,
    };

    /// Runs of reads and writes of 32 lines from a fixed generator.
    fn wants(count: u32) -> impl Iterator<Item = Want> {
        let mut state = 12_345_u32;
        let mut next = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 8
        };
        (0..count).map(move |_| Want {
            line: next() % 32,
            read: u64::from(next()),
            write: u64::from(next() & next()) << 20,
            class: (next() % 4) as u8,
        })
    }

    fn run(port: &Port, count: u32) -> (CacheCounts, Ledger) {
        let (mut lines, mut ledger) = (lines(32), Ledger::new(1, 1, false));
        let mut cache = Cache::new(port);
        for want in wants(count) {
            cache.access(&mut lines, &mut ledger, AT, want);
        }
        cache.flush(&mut lines, &mut ledger, 0..32, None);
        (cache.counts, ledger)
    }

    #[test]
    fn more_ways_never_miss_more() {
        let misses = |ways| run(&port(CacheKind::Sets { sets: 4, ways }), 4000).0.misses;
        let all: Vec<u64> = [1, 2, 4, 8].map(misses).into();
        assert!(all.is_sorted_by(|a, b| a >= b), "{all:?}");
        assert!(all[0] > all[3]);
        assert_eq!(all[3], run(&port(CacheKind::Infinite), 4000).0.misses);
    }

    #[test]
    fn what_became_dirty_is_written_back_or_flushed() {
        let (counts, ledger) = run(&port(CacheKind::Sets { sets: 2, ways: 2 }), 4000);
        let d = counts.dirty;
        assert_eq!(d.dirtied, d.written_back + d.flushed);
        assert!(d.written_back > 0 && d.flushed > 0 && counts.flushed_lines == 4);
        let total = ledger.rows[0][0].dram.write_bytes;
        assert_eq!(total, ledger.evicted[0] + ledger.flushed[0]);
    }

    #[test]
    fn no_cache_moves_every_access() {
        let (_, ledger) = run(
            &Port {
                sector: 4,
                grain: 4,
                ..port(CacheKind::None)
            },
            100,
        );
        let read: u64 = wants(100).map(|w| 4 * u64::from(w.read.count_ones())).sum();
        assert_eq!(ledger.rows[0][0].dram.read_bytes, read);
    }

    #[test]
    fn once_raw_a_line_stays_so() {
        let codec = Port {
            codec: true,
            fast_clear: true,
            ..port(CacheKind::Infinite)
        };
        let mut lines = lines(1);
        lines.state[0] = LineState::Clear;
        let mut write = |class, dirty| stored(&mut lines, &codec, 0, dirty, class);
        assert_eq!(write(1, 1), 128);
        assert_eq!(write(0, 1), 64);
        assert_eq!(write(RAW, 1), 256);
        assert_eq!(write(0, 1), 64, "one part of a raw line");
        assert_eq!(write(0, u64::MAX), 256);
    }

    #[test]
    fn parts_are_those_that_are_touched() {
        assert_eq!(expanded(1 << 17, 64, 4), (0xffff << 16, 64));
        assert_eq!(expanded(1 << 17 | 1, 4, 4), (1 << 17 | 1, 8));
        assert_eq!(expanded(1, 256, 8), (0xffff_ffff, 256));
        assert_eq!(expanded(1 << 63, 256, 4), (u64::MAX, 256));
    }
}
