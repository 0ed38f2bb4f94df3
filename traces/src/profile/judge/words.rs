//! Accesses: words of attachments, texels, vertices, and what lies behind caches.

use gnomon_raster::{BlockAccess, PassReport, TexelAccess};

use super::Judge;
use crate::profile::cache::Want;
use crate::profile::charge::{At, Client, Level, Way};
use crate::profile::codec;
use crate::profile::model::Order;
use crate::profile::surface::{Image, morton};
use crate::witness::class_of;

impl Judge {
    pub(super) fn event(&mut self, pass: usize, e: &BlockAccess) -> bool {
        let row = self.plans[pass].first_row + e.draw;
        let cell = self.cell_of(pass, e.block);
        self.list(e, row, cell);
        let (decided, culled) = self.consult(pass, row, cell, e);
        if culled {
            return false;
        }
        let z_read = if decided { 0 } else { e.z_read };
        self.hiz[row as usize].z_reads += u64::from(z_read.count_ones());
        self.depth_stencil(pass, row, cell, e, z_read);
        for i in 0..self.plans[pass].images.len() - 1 {
            self.color(pass, row, cell, e, i);
        }
        true
    }

    fn cell_of(&self, pass: usize, block: [u16; 2]) -> u32 {
        let images = &self.plans[pass].images;
        match images.iter().flatten().next() {
            Some(image) if image.is_picture => self.images.cell(block),
            _ => self.images.elsewhere(),
        }
    }

    /// A primitive enters a tile.
    fn list(&mut self, e: &BlockAccess, row: u32, cell: u32) {
        let bytes = u64::from(self.profile.tile.list_bytes);
        if bytes != 0 && self.bins.enters(e) {
            let at = self.at(row, Client::PolygonList, cell, e.covered);
            for level in [Level::Cache, Level::Dram] {
                for way in [Way::Write, Way::Read] {
                    self.ledger.charge(at, level, way, bytes);
                }
            }
        }
    }

    fn depth_stencil(&mut self, pass: usize, row: u32, cell: u32, e: &BlockAccess, z_read: u64) {
        let masks = [z_read | e.stencil_read, e.z_write | e.stencil_write];
        let Some(image) = self.plans[pass].images[0] else {
            return;
        };
        if masks == [0; 2] {
            return;
        }
        let at = self.at(row, Client::DepthStencil, cell, masks[0] | masks[1]);
        let depth = self.plans[pass].depth_bytes;
        let bytes = |z: u64, s: u64| depth * pixels(z) + pixels(s);
        let read = bytes(z_read, e.stencil_read);
        self.ledger.charge(at, Level::Logical, Way::Read, read);
        let written = bytes(e.z_write, e.stencil_write);
        self.ledger.charge(at, Level::Logical, Way::Write, written);
        self.words(at, &image, e, masks, class_of(e.witness, 0));
    }

    fn color(&mut self, pass: usize, row: u32, cell: u32, e: &BlockAccess, i: usize) {
        let masks = [e.color_read[i], e.color_write[i]];
        let Some(image) = self.plans[pass].images[i + 1] else {
            return;
        };
        if masks == [0; 2] {
            return;
        }
        let at = self.at(row, Client::Color(i as u8), cell, masks[0] | masks[1]);
        for (mask, way) in masks.into_iter().zip([Way::Read, Way::Write]) {
            let bytes = pixels(mask) * u64::from(image.bytes);
            self.ledger.charge(at, Level::Logical, way, bytes);
        }
        self.words(at, &image, e, masks, class_of(e.witness, i + 1));
    }

    /// Words of an attachment, and behind the cache lines of it.
    fn words(&mut self, at: At, image: &Image, e: &BlockAccess, masks: [u64; 2], class: u8) {
        for (mask, way) in masks.into_iter().zip([Way::Read, Way::Write]) {
            let bytes = pixels(mask) * u64::from(image.bytes);
            let at = At { mask, ..at };
            self.ledger.charge(at, Level::Cache, way, bytes);
        }
        if self.profile.order == Order::Tiled {
            return;
        }
        // A block that several lines hold is none for the codec.
        let class = match image.bytes {
            4 => class,
            _ => codec::RAW,
        };
        let cache = match at.client {
            Client::DepthStencil => &mut self.zs,
            _ => &mut self.color,
        };
        for (line, [read, write]) in image.touched(image.block(e.block), masks) {
            let want = Want {
                line,
                read,
                write,
                class,
            };
            cache.access(&mut self.images.lines, &mut self.ledger, at, want);
        }
    }

    pub(super) fn texels(&mut self, pass: usize, e: &BlockAccess, t: &TexelAccess) {
        let draw = &self.shape.passes[pass].draws[e.draw as usize];
        let Some(binding) = draw.textures.get(usize::from(t.slot)) else {
            return;
        };
        let s = gnomon_raster::Subresource {
            mip: u32::from(t.mip),
            layer: u32::from(t.layer),
        };
        let image = self.images.get(binding.texture, s);
        let texture = &self.shape.textures[binding.texture.index()];
        let row = self.plans[pass].first_row + e.draw;
        let cell = self.cell_of(pass, e.block);
        let at = self.at(row, Client::Texture(t.slot), cell, e.covered);
        let logical = u64::from(t.taps) * texture.format.bytes();
        self.ledger.charge(at, Level::Logical, Way::Read, logical);
        let words = u64::from(t.taps) * u64::from(image.bytes);
        self.ledger.charge(at, Level::Cache, Way::Read, words);
        let unit = morton(
            u32::from(e.block[0] / 2) % 64,
            u32::from(e.block[1] / 2) % 64,
        );
        let unit = unit as usize % self.texture.len();
        for (line, [read, write]) in image.touched(image.block(t.block), [t.texels, 0]) {
            let want = Want {
                line,
                read,
                write,
                class: codec::RAW,
            };
            let cache = &mut self.texture[unit];
            cache.access(&mut self.images.lines, &mut self.ledger, at, want);
        }
    }

    pub(super) fn vertices(&mut self, pass: usize, report: &PassReport) {
        let reads = match self.profile.order {
            Order::Immediate => 1,
            Order::Tiled => u64::from(self.profile.tile.vertex_reads),
        };
        for (i, draw) in report.draws.iter().enumerate() {
            let row = self.plans[pass].first_row + i as u32;
            let t = &draw.counters.traffic;
            let fetched = [(Client::Vertex, t.vertex), (Client::Index, t.index)];
            for (client, traffic) in fetched {
                let at = self.at(row, client, self.images.elsewhere(), 1);
                let bytes = traffic.read_bytes;
                self.ledger.charge(at, Level::Logical, Way::Read, bytes);
                self.ledger
                    .charge(at, Level::Cache, Way::Read, reads * bytes);
                self.ledger
                    .charge(at, Level::Dram, Way::Read, reads * bytes);
            }
        }
    }
}

fn pixels(mask: u64) -> u64 {
    u64::from(mask.count_ones())
}
