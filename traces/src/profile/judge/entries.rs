//! Entries of HiZ: what they decide, and when they follow.

use gnomon_raster::BlockAccess;

use super::{Judge, PENDING};
use crate::profile::charge::{Client, Level, Way};
use crate::profile::hiz::{Decision, entry};
use crate::profile::model::HizRules;
use crate::profile::surface::Image;

impl Judge {
    /// Whether depth need not be read, and whether nothing needs to be done at all.
    pub(super) fn consult(
        &mut self,
        pass: usize,
        row: u32,
        cell: u32,
        e: &BlockAccess,
    ) -> (bool, bool) {
        let hiz = &self.profile.hiz;
        let plan = &self.plans[pass];
        let Some(image) = plan.images[0] else {
            return (false, false);
        };
        if hiz.rules == HizRules::None {
            return (false, false);
        }
        let line = image.lines().start + image.block(e.block) * (64 / lines_divisor(&image));
        let draw = plan.draws[e.draw as usize];
        let stored = self.entry_of(line, plan.depth_bits, e.stored);
        let decision = match draw.test {
            Ok(test) => test.decide(e.span, stored, e.front),
            Err(_) => Decision::Unknown,
        };
        let counts = &mut self.hiz[row as usize];
        if draw.test.is_ok() {
            counts.tested += 1;
            counts.accepted += u64::from(decision == Decision::Decided);
            counts.culled += u64::from(decision == Decision::Culled);
        }
        let culled = decision == Decision::Culled;
        if culled {
            counts.killed += u64::from(e.covered.count_ones());
        }
        let writes = !culled && e.z_write != 0 && draw.updates;
        self.charge_entry(row, cell, e.covered, [draw.test.is_ok(), writes]);
        if writes && !self.profile.hiz.on_write_back {
            self.entries[line as usize] = PENDING;
        }
        (decision == Decision::Decided, culled)
    }

    /// The entry of a block. What an access finds stored is exact, and nothing has been
    /// written since the entry was to follow: so it is known now at the latest.
    fn entry_of(&mut self, line: u32, depth_bits: u32, stored: [u32; 2]) -> [u32; 2] {
        let line = line as usize;
        let follows = core::mem::take(&mut self.images.lines.written[line]);
        if self.entries[line] == PENDING || (follows && self.profile.hiz.on_write_back) {
            let [min, max] = entry(&self.profile.hiz, depth_bits, stored);
            self.entries[line] = u64::from(min) << 32 | u64::from(max);
        }
        let entry = self.entries[line];
        [(entry >> 32) as u32, entry as u32]
    }

    fn charge_entry(&mut self, row: u32, cell: u32, mask: u64, [read, write]: [bool; 2]) {
        let at = self.at(row, Client::Hiz, cell, mask);
        let bytes = u64::from(self.profile.hiz.entry_bytes);
        for (happens, way) in [(read, Way::Read), (write, Way::Write)] {
            if happens {
                self.ledger.charge(at, Level::Logical, way, bytes);
                self.ledger.charge(at, Level::Cache, way, bytes);
                if self.profile.hiz.in_memory {
                    self.ledger.charge(at, Level::Dram, way, bytes);
                }
            }
        }
    }
}

/// Pixels of a line of an image.
fn lines_divisor(image: &Image) -> u32 {
    crate::profile::cache::pixels_of(image.bytes)
}
