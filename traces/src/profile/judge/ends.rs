//! Ends of passes and of the frame: clears, loads, stores, the display.

use gnomon_raster::TextureId;

use super::Judge;
use super::PENDING;
use crate::profile::attachments::{Attachment, samples};
use crate::profile::cache::LineState;
use crate::profile::charge::{At, Client, Level, Way};
use crate::profile::model::Order;
use crate::profile::surface::Image;
use crate::profile::tiles::Bins;

impl Judge {
    /// Passes that had no accesses begin too.
    pub(super) fn begin_through(&mut self, pass: usize) {
        while self.begun <= pass {
            self.begin(self.begun);
            self.begun += 1;
        }
    }

    fn begin(&mut self, pass: usize) {
        self.flush_sampled(pass);
        let plan = &self.plans[pass];
        let row = plan.first_row + plan.draws.len() as u32;
        self.bins = Bins::new(&self.profile.tile, &plan.images, plan.on_chip.pixel);
        for i in 0..self.plans[pass].attachments.len() {
            let plan = &self.plans[pass];
            if let (Some(a), Some(image)) = (plan.attachments[i], plan.images[i]) {
                let read = plan.on_chip.loads[i];
                self.load(row, client_of(i), &a, &image, read);
            }
        }
    }

    /// Lines of attachments that the pass samples are written back before it, if they were
    /// drawn to since somebody sampled them.
    fn flush_sampled(&mut self, pass: usize) {
        let by = Some(self.plans[pass].first_row);
        for texture in self.drawn_and_sampled(pass) {
            let range = self.images.texture_lines(texture);
            let lines = &mut self.images.lines;
            self.zs.flush(lines, &mut self.ledger, range.clone(), by);
            self.color.flush(lines, &mut self.ledger, range.clone(), by);
            // What was drawn is not what texture caches hold.
            self.texture
                .iter_mut()
                .for_each(|t| t.forget(range.clone()));
            self.drawn[texture.index()] = false;
        }
        for a in self.plans[pass].attachments.iter().flatten() {
            self.drawn[a.texture.index()] = true;
        }
    }

    fn drawn_and_sampled(&self, pass: usize) -> Vec<TextureId> {
        let earlier = self.plans[..pass].iter().flat_map(|p| &p.attachments);
        let textures = earlier.flatten().map(|a| a.texture);
        let sampled = |t: &TextureId| samples(&self.shape.passes[pass], *t);
        let all = textures.filter(|t| self.drawn[t.index()] && sampled(t));
        all.collect()
    }

    /// `read`: tiles read it from memory.
    fn load(&mut self, row: u32, client: Client, a: &Attachment, image: &Image, read: bool) {
        let at = At {
            row,
            client,
            cell: self.images.elsewhere(),
            mask: 1,
        };
        if a.new_depth {
            self.entries_follow(image);
        }
        if a.cleared {
            self.clear(at, image);
        } else if a.cleared_bytes != 0 {
            self.clear_aspect(at, image);
        }
        let cleared = image.pixels() * u64::from(a.cleared_bytes);
        self.ledger.charge(at, Level::Logical, Way::Write, cleared);
        if self.profile.order == Order::Tiled && read {
            self.whole(at, image, Way::Read);
        }
    }

    /// All of an image at once, each block charged where it lies.
    fn whole(&mut self, at: At, image: &Image, way: Way) {
        let [width, height] = image.size;
        for y in 0..height.div_ceil(8) {
            for x in 0..width.div_ceil(8) {
                let block = [x as u16, y as u16];
                let mask = inside(image.size, block);
                let cell = match image.is_picture {
                    true => self.images.cell(block),
                    false => self.images.elsewhere(),
                };
                let bytes = u64::from(mask.count_ones()) * u64::from(image.bytes);
                let at = At { cell, mask, ..at };
                self.ledger.charge(at, Level::Cache, way, bytes);
                self.ledger.charge(at, Level::Dram, way, bytes);
            }
        }
    }

    fn clear(&mut self, at: At, image: &Image) {
        let lines = image.lines();
        if self.profile.order == Order::Tiled {
            return;
        }
        let (cache, port) = match at.client {
            Client::DepthStencil => (&mut self.zs, &self.profile.depth_stencil),
            _ => (&mut self.color, &self.profile.color),
        };
        cache.forget(lines.clone());
        let state = match port.fast_clear {
            true => LineState::Clear,
            false => LineState::Raw,
        };
        for line in lines {
            self.images.lines.state[line as usize] = state;
        }
        if !port.fast_clear {
            self.whole(at, image, Way::Write);
        }
    }

    /// Entries are what the next accesses find.
    fn entries_follow(&mut self, image: &Image) {
        for line in image.lines() {
            self.entries[line as usize] = PENDING;
        }
    }

    /// Half of each word is cleared: words are read and written.
    fn clear_aspect(&mut self, at: At, image: &Image) {
        if self.profile.order == Order::Tiled {
            return;
        }
        let lines = &mut self.images.lines;
        let by = Some(at.row);
        self.zs.flush(lines, &mut self.ledger, image.lines(), by);
        for line in image.lines() {
            lines.state[line as usize] = LineState::Raw;
        }
        self.whole(at, image, Way::Read);
        self.whole(at, image, Way::Write);
    }

    pub(super) fn store(&mut self, pass: usize) {
        let lost = self.plans[pass].attachments[0].is_some_and(|a| a.lost_depth);
        if let Some(image) = self.plans[pass].images[0].filter(|_| lost) {
            self.entries_follow(&image);
        }
        let plan = &self.plans[pass];
        if self.profile.order != Order::Tiled {
            return;
        }
        let row = plan.first_row + plan.draws.len() as u32;
        for i in 0..plan.attachments.len() {
            let plan = &self.plans[pass];
            if let Some(image) = plan.images[i].filter(|_| plan.on_chip.stores[i]) {
                let at = self.at(row, client_of(i), self.images.elsewhere(), 1);
                self.whole(at, &image, Way::Write);
            }
        }
    }

    /// The display reads what the last pass left in its first colour attachment.
    pub(super) fn scan_out(&mut self) {
        let last = self.plans.iter().rev().find_map(|p| *p.images.get(1)?);
        let Some(image) = last.filter(|_| self.profile.scanout) else {
            return;
        };
        let row = self.ledger.rows.len() as u32 - 1;
        let at = self.at(row, Client::Scanout, self.images.elsewhere(), 1);
        if self.profile.order == Order::Tiled {
            return self.whole(at, &image, Way::Read);
        }
        for line in image.lines() {
            let lines = &self.images.lines;
            let (cell, bytes) = (lines.cell[line as usize], lines.stored_bytes(line as usize));
            let at = At { cell, ..at };
            self.ledger.charge(at, Level::Cache, Way::Read, bytes);
            self.ledger.charge(at, Level::Dram, Way::Read, bytes);
        }
    }
}

fn client_of(attachment: usize) -> Client {
    match attachment {
        0 => Client::DepthStencil,
        i => Client::Color(i as u8 - 1),
    }
}

/// Pixels of a block that lie in an image of that size.
fn inside([width, height]: [u32; 2], [x, y]: [u16; 2]) -> u64 {
    let across = width.saturating_sub(8 * u32::from(x)).min(8);
    let down = height.saturating_sub(8 * u32::from(y)).min(8);
    let row = (1_u64 << across) - 1;
    (0..down).fold(0, |mask, k| mask | row << (8 * k))
}
