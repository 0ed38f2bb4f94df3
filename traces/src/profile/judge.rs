//! A frame's accesses, heard one after the other and charged as a profile has it.

use gnomon_raster::{AccessBatch, AccessObserver, BlockAccess, PassReport, TexelAccess};

use super::ProfileError;
use super::attachments::{Attachment, attachments, mergeable, samples};
use super::cache::{Cache, LineState, Want};
use super::charge::{At, Client, Ledger, Level, Way};
use super::hiz::{Contents, Decision, DrawHiz, entry};
use super::model::{HizRules, Order, Profile};
use super::surface::{Image, Images, morton};
use super::tiles::Bins;
use super::traffic::{HizCounts, Traffic, TrafficRow};
use crate::shape::{FrameShape, PassShape};
use crate::witness::class_of;

/// How to judge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JudgeOptions {
    /// Charge pixels too.
    pub pixels: bool,
    /// Passes that can go on in the tiles of the one before do so.
    pub merged: bool,
}

/// Judges a frame: an observer of its accesses, recorded or live, with skipping off.
#[derive(Debug)]
pub struct Judge {
    profile: Profile,
    shape: FrameShape,
    images: Images,
    ledger: Ledger,
    zs: Cache,
    color: Cache,
    texture: Vec<Cache>,
    /// Of each block of depth, by its first line; see [`Self::entry_of`].
    entries: Vec<u64>,
    plans: Vec<PassPlan>,
    hiz: Vec<HizCounts>,
    texels_recorded: bool,
    begun: usize,
    bins: Bins,
    waiting: Waiting,
}

/// What is known of a pass before its first access.
#[derive(Debug)]
struct PassPlan {
    first_row: u32,
    /// Depth and stencil, then colour.
    attachments: Vec<Option<Attachment>>,
    images: Vec<Option<Image>>,
    draws: Vec<DrawHiz>,
    depth_bits: u32,
    depth_bytes: u64,
    /// It goes on in the tiles of the pass before; the next goes on in its tiles.
    continues: [bool; 2],
}

/// The entry of a block whose depths are those that the next access will report.
const PENDING: u64 = u64::MAX;

/// Whether a shader of the frame looks anything up.
fn reads_textures(shape: &FrameShape) -> bool {
    let mut draws = shape.passes.iter().flat_map(|p| &p.draws);
    draws.any(|d| d.fragment.is_some_and(|f| f.textures > 0))
}

impl Judge {
    /// Ready for the accesses of a frame of this shape.
    ///
    /// # Errors
    /// The hardware cannot do what the frame does.
    pub fn new(profile: &Profile, shape: &FrameShape) -> Result<Self, ProfileError> {
        Self::with_options(profile, shape, JudgeOptions::default())
    }

    /// As [`Judge::new`], with options.
    ///
    /// # Errors
    /// As [`Judge::new`].
    pub fn with_options(
        profile: &Profile,
        shape: &FrameShape,
        options: JudgeOptions,
    ) -> Result<Self, ProfileError> {
        super::support::check(profile, shape)?;
        let images = Images::new(shape);
        let plans = plans(profile, shape, &images, options.merged);
        let rows = plans.iter().map(|p| p.draws.len() + 1).sum::<usize>() + 1;
        let cells = images.elsewhere() as usize + 1;
        let lines = images.lines.state.len();
        Ok(Self {
            ledger: Ledger::new(rows, cells, options.pixels),
            zs: Cache::new(&profile.depth_stencil),
            color: Cache::new(&profile.color),
            texture: (0..profile.texture_units)
                .map(|_| Cache::new(&profile.texture))
                .collect(),
            entries: vec![PENDING; lines],
            hiz: vec![HizCounts::default(); rows],
            texels_recorded: !reads_textures(shape),
            begun: 0,
            bins: Bins::default(),
            waiting: Waiting::default(),
            profile: profile.clone(),
            shape: shape.clone(),
            images,
            plans,
        })
    }

    fn at(&self, row: u32, client: Client, cell: u32, mask: u64) -> At {
        At {
            row,
            client,
            cell,
            mask,
        }
    }

    /// Passes that had no accesses begin too.
    fn begin_through(&mut self, pass: usize) {
        while self.begun <= pass {
            self.begin(self.begun);
            self.begun += 1;
        }
    }

    fn begin(&mut self, pass: usize) {
        self.flush_sampled(pass);
        let plan = &self.plans[pass];
        let row = plan.first_row + plan.draws.len() as u32;
        self.bins = Bins::new(&self.profile.tile, &plan.images);
        for i in 0..self.plans[pass].attachments.len() {
            let plan = &self.plans[pass];
            if let (Some(a), Some(image)) = (plan.attachments[i], plan.images[i]) {
                let continues = plan.continues[0];
                self.load(row, client_of(i), &a, &image, continues);
            }
        }
    }

    /// Lines of attachments that the pass samples are written back before it.
    fn flush_sampled(&mut self, pass: usize) {
        let by = Some(self.plans[pass].first_row);
        for earlier in 0..pass {
            for a in self.plans[earlier].attachments.iter().flatten() {
                if samples(&self.shape.passes[pass], a.texture) {
                    let range = self.images.texture_lines(a.texture);
                    let lines = &mut self.images.lines;
                    self.zs.flush(lines, &mut self.ledger, range.clone(), by);
                    self.color.flush(lines, &mut self.ledger, range.clone(), by);
                    // What was drawn is not what texture caches hold.
                    self.texture
                        .iter_mut()
                        .for_each(|t| t.forget(range.clone()));
                }
            }
        }
    }

    fn load(&mut self, row: u32, client: Client, a: &Attachment, image: &Image, merged: bool) {
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
        if self.profile.order == Order::Tiled && a.loaded && !merged {
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

    fn store(&mut self, pass: usize) {
        let lost = self.plans[pass].attachments[0].is_some_and(|a| a.lost_depth);
        if let Some(image) = self.plans[pass].images[0].filter(|_| lost) {
            self.entries_follow(&image);
        }
        let plan = &self.plans[pass];
        if self.profile.order != Order::Tiled || plan.continues[1] {
            return;
        }
        let row = plan.first_row + plan.draws.len() as u32;
        for i in 0..plan.attachments.len() {
            let plan = &self.plans[pass];
            if let (Some(a), Some(image)) = (plan.attachments[i], plan.images[i])
                && a.stored
            {
                let at = self.at(row, client_of(i), self.images.elsewhere(), 1);
                self.whole(at, &image, Way::Write);
            }
        }
    }

    fn event(&mut self, pass: usize, e: &BlockAccess) -> bool {
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

    /// Whether depth need not be read, and whether nothing needs to be done at all.
    fn consult(&mut self, pass: usize, row: u32, cell: u32, e: &BlockAccess) -> (bool, bool) {
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
            _ => super::codec::RAW,
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

    fn texels(&mut self, pass: usize, e: &BlockAccess, t: &TexelAccess) {
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
                class: super::codec::RAW,
            };
            let cache = &mut self.texture[unit];
            cache.access(&mut self.images.lines, &mut self.ledger, at, want);
        }
    }

    fn vertices(&mut self, pass: usize, report: &PassReport) {
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

    /// The display reads what the last pass left in its first colour attachment.
    fn scan_out(&mut self) {
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

    /// The end of the frame: caches are written back, the picture is displayed.
    #[must_use]
    pub fn finish(mut self) -> Traffic {
        if let Some(last) = self.plans.len().checked_sub(1) {
            self.begin_through(last);
        }
        let all = 0..self.images.lines.state.len() as u32;
        let lines = &mut self.images.lines;
        self.zs.flush(lines, &mut self.ledger, all.clone(), None);
        self.color.flush(lines, &mut self.ledger, all, None);
        self.scan_out();
        Traffic {
            rows: self.rows(),
            profile: self.profile.name,
            grid: self.images.grid(),
            size: self.images.picture,
            caches: [self.zs.counts, self.color.counts],
            texels_recorded: self.texels_recorded,
            ledger: self.ledger,
        }
    }

    fn rows(&self) -> Vec<TrafficRow> {
        let mut rows = Vec::new();
        for (number, (pass, plan)) in self.shape.passes.iter().zip(&self.plans).enumerate() {
            for (i, (draw, hiz)) in pass.draws.iter().zip(&plan.draws).enumerate() {
                rows.push(TrafficRow {
                    disabled: hiz.test.err(),
                    ..self.row(rows.len(), Some(number), Some(i), &draw.label)
                });
            }
            rows.push(self.row(rows.len(), Some(number), None, &pass.label));
        }
        rows.push(self.row(rows.len(), None, None, "end of frame"));
        rows
    }

    fn row(
        &self,
        number: usize,
        pass: Option<usize>,
        draw: Option<usize>,
        label: &str,
    ) -> TrafficRow {
        TrafficRow {
            pass,
            draw,
            label: label.to_owned(),
            hiz: self.hiz[number],
            disabled: None,
            evicted_bytes: self.ledger.evicted[number],
            clients: self.ledger.rows[number],
        }
    }
}

impl Judge {
    fn accesses(&mut self, pass: usize, e: &BlockAccess, texels: &[TexelAccess]) {
        if self.event(pass, e) {
            texels.iter().for_each(|t| self.texels(pass, e, t));
        }
    }

    /// Keeps an access until all primitives that are rasterised with its own are there.
    fn wait(&mut self, pass: usize, e: &BlockAccess, texels: &[TexelAccess]) {
        let together = self.profile.together;
        let last = self.waiting.blocks.last();
        let group = |e: &BlockAccess| (e.draw, e.primitive / together);
        if last.is_some_and(|last| group(last) != group(e)) {
            self.release(pass);
        }
        self.waiting.push(e, texels);
    }

    /// Block by block, in each by primitive.
    fn release(&mut self, pass: usize) {
        let mut waiting = core::mem::take(&mut self.waiting);
        let image = self.plans[pass].images.iter().flatten().next();
        let place = |e: &BlockAccess| image.map_or(0, |i| i.block(e.block));
        let mut order: Vec<(u32, usize)> = waiting.blocks.iter().map(place).zip(0..).collect();
        order.sort_unstable();
        for (_, i) in order {
            let texels = &waiting.texels[waiting.range(i)];
            let e = &waiting.blocks[i];
            self.accesses(pass, e, texels);
        }
        waiting.clear();
        self.waiting = waiting;
    }
}

/// Accesses of primitives that are rasterised together.
#[derive(Debug, Default)]
struct Waiting {
    blocks: Vec<BlockAccess>,
    texels: Vec<TexelAccess>,
    /// Where the texels of each access end.
    ends: Vec<usize>,
}

impl Waiting {
    fn push(&mut self, e: &BlockAccess, texels: &[TexelAccess]) {
        self.blocks.push(*e);
        self.texels.extend_from_slice(texels);
        self.ends.push(self.texels.len());
    }

    fn range(&self, i: usize) -> core::ops::Range<usize> {
        let start = i.checked_sub(1).map_or(0, |before| self.ends[before]);
        start..self.ends[i]
    }

    fn clear(&mut self) {
        self.blocks.clear();
        self.texels.clear();
        self.ends.clear();
    }
}

impl AccessObserver for Judge {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        self.begin_through(pass);
        let mut texels = batch.texels;
        self.texels_recorded |= !texels.is_empty();
        for (i, e) in batch.blocks.iter().enumerate() {
            let mine = texels.iter().take_while(|t| t.event as usize <= i).count();
            let (mine, rest) = texels.split_at(mine);
            texels = rest;
            match self.profile.together {
                1 => self.accesses(pass, e, mine),
                _ => self.wait(pass, e, mine),
            }
        }
    }

    fn end(&mut self, pass: usize, report: &PassReport) {
        self.begin_through(pass);
        self.release(pass);
        self.vertices(pass, report);
        self.store(pass);
    }
}

fn client_of(attachment: usize) -> Client {
    match attachment {
        0 => Client::DepthStencil,
        i => Client::Color(i as u8 - 1),
    }
}

fn pixels(mask: u64) -> u64 {
    u64::from(mask.count_ones())
}

/// Pixels of a line of an image.
fn lines_divisor(image: &Image) -> u32 {
    super::cache::pixels_of(image.bytes)
}

/// Pixels of a block that lie in an image of that size.
fn inside([width, height]: [u32; 2], [x, y]: [u16; 2]) -> u64 {
    let across = width.saturating_sub(8 * u32::from(x)).min(8);
    let down = height.saturating_sub(8 * u32::from(y)).min(8);
    let row = (1_u64 << across) - 1;
    (0..down).fold(0, |mask, k| mask | row << (8 * k))
}

fn plans(profile: &Profile, shape: &FrameShape, images: &Images, merged: bool) -> Vec<PassPlan> {
    let continues = match merged {
        true => mergeable(shape),
        false => vec![false; shape.passes.len()],
    };
    let mut contents = vec![Contents::INVALID; shape.textures.len()];
    let mut first_row = 0;
    let mut plans = Vec::new();
    for (i, pass) in shape.passes.iter().enumerate() {
        let after = continues.get(i + 1).copied().unwrap_or(false);
        let plan = plan(profile, shape, images, pass, &mut contents);
        let next = first_row + plan.draws.len() as u32 + 1;
        plans.push(PassPlan {
            first_row,
            continues: [continues[i], after],
            ..plan
        });
        first_row = next;
    }
    plans
}

fn plan(
    profile: &Profile,
    shape: &FrameShape,
    images: &Images,
    pass: &PassShape,
    contents: &mut [Contents],
) -> PassPlan {
    let attachments = attachments(shape, pass);
    let image = |a: &Attachment| images.get(a.texture, a.subresource);
    let format = attachments[0].map(|a| shape.textures[a.texture.index()].format);
    let is_float = format == Some(gnomon_raster::Format::Depth32FloatStencil8);
    PassPlan {
        first_row: 0,
        images: attachments.iter().map(|a| a.as_ref().map(image)).collect(),
        draws: hiz_of_draws(profile, pass, attachments[0], images, contents),
        attachments,
        depth_bits: if is_float { 30 } else { 24 },
        depth_bytes: format.map_or(0, gnomon_raster::Format::bytes),
        continues: [false; 2],
    }
}

fn hiz_of_draws(
    profile: &Profile,
    pass: &PassShape,
    depth: Option<Attachment>,
    images: &Images,
    contents: &mut [Contents],
) -> Vec<DrawHiz> {
    let mut none = Contents::INVALID;
    let contents = match depth {
        Some(a) => &mut contents[a.texture.index()],
        None => &mut none,
    };
    contents.begin_pass();
    let cleared = pass.depth_stencil.as_ref();
    if cleared.is_some_and(|d| matches!(d.depth_load, gnomon_raster::LoadOp::Clear(_))) {
        contents.clear();
    }
    let room = profile.hiz.entries;
    let blocks = depth.map_or(0, |a| {
        let [w, h] = images.get(a.texture, a.subresource).size;
        w.div_ceil(8) * h.div_ceil(8)
    });
    let fits = room == 0 || blocks <= room;
    let draws = pass
        .draws
        .iter()
        .map(|d| contents.draw(&profile.hiz, pass, d));
    let draws = draws.map(|hiz| super::support::within(hiz, fits));
    draws.collect()
}
