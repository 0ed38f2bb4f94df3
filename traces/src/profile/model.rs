//! What a profile says, ready to be used.

use super::ProfileError;
use super::facts::{Fact, Facts};

/// The order of accesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Primitive by primitive, attachments behind caches.
    Immediate,
    /// Tile by tile, attachments on chip.
    Tiled,
}

/// Whose rules say when HiZ may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HizRules {
    /// There is none.
    None,
    /// This project's GPU.
    Gnomon,
    /// R300 (Mesa's `r300_hyperz.c`).
    R300,
    /// The simulator ATTILA (`_syncHZRegister`).
    Attila,
    /// Low-resolution Z of Adreno 6xx (Mesa's `tu_lrz.cc`).
    Adreno,
}

/// What is kept of a block's depths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeps {
    /// Both ends.
    MinMax,
    /// The largest.
    Max,
    /// The end that the direction of the comparison needs.
    Direction,
}

/// HiZ and its memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hiz {
    /// When it may be used.
    pub rules: HizRules,
    /// What it keeps.
    pub keeps: Keeps,
    /// Bits of an entry's depth.
    pub bits: u32,
    /// An entry follows when its line of depth is written back, not at once.
    pub on_write_back: bool,
    /// Bytes of an entry.
    pub entry_bytes: u32,
    /// Entries for which there is room on chip; 0 for as many as are wanted.
    pub entries: u32,
    /// Entries are in memory.
    pub in_memory: bool,
}

/// The shape of a cache of lines of at most 256 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CacheKind {
    /// Every access goes to memory.
    None,
    /// Lines replaced by LRU.
    Sets {
        /// Sets, those of all units together.
        sets: u32,
        /// Lines of a set.
        ways: u32,
    },
    /// Nothing is ever replaced.
    Infinite,
}

/// The way of a client to memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port {
    /// The cache.
    pub cache: CacheKind,
    /// Bytes that are read at a time.
    pub sector: u32,
    /// Bytes that are written at a time.
    pub grain: u32,
    /// Lines are compressed (HILO).
    pub codec: bool,
    /// Clears cost nothing, nor does reading what was cleared.
    pub fast_clear: bool,
}

/// On-chip tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// Bytes for colour.
    pub color_bytes: u32,
    /// Bytes for depth and stencil; 0 where they share those of colour.
    pub depth_bytes: u32,
    /// Largest side in pixels.
    pub largest: u32,
    /// Sides are multiples of this.
    pub align: u32,
    /// Bytes for each primitive in each tile, written and read.
    pub list_bytes: u32,
    /// How often vertices are read.
    pub vertex_reads: u32,
}

/// The memory of a piece of hardware.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Profile {
    /// What it is called.
    pub name: String,
    /// What it stands for.
    pub summary: String,
    /// The order of accesses.
    pub order: Order,
    /// Primitives of a draw that are rasterised together, block by block; 1 for one after
    /// the other, in rows of blocks.
    pub together: u32,
    /// The display reads the last pass's first colour attachment at the end.
    pub scanout: bool,
    /// Half-float attachments can be blended.
    pub blends_half: bool,
    /// HiZ.
    pub hiz: Hiz,
    /// Depth and stencil.
    pub depth_stencil: Port,
    /// Colour.
    pub color: Port,
    /// Textures, the cache of one unit.
    pub texture: Port,
    /// Units with texture caches of their own; they share out squares of 16 pixels.
    pub texture_units: u32,
    /// On-chip tiles.
    pub tile: Tile,
    /// Everything it says, with sources.
    pub facts: Vec<Fact>,
}

impl Profile {
    /// Reads a profile; `file` is what errors call it.
    ///
    /// # Errors
    /// For text that is no profile.
    pub fn parse(name: &str, file: &str, text: &str) -> Result<Self, ProfileError> {
        let mut f = Facts::read(file, text)?;
        let order = [("immediate", Order::Immediate), ("tiled", Order::Tiled)];
        let mut profile = Self {
            name: name.to_owned(),
            summary: f.text("summary")?,
            order: f.choice("order", &order)?,
            together: f.number("primitives-together", 1..=1024)?,
            scanout: f.switch("scanout")?,
            blends_half: f.switch("blends-half-floats")?,
            hiz: hiz(&mut f)?,
            depth_stencil: port(&mut f, "zs")?,
            color: port(&mut f, "color")?,
            texture: port(&mut f, "texture")?,
            texture_units: f.number("texture.units", 1..=64)?,
            tile: Tile::NONE,
            facts: Vec::new(),
        };
        if profile.order == Order::Tiled {
            profile.tile = tile(&mut f)?;
        }
        profile.facts = f.finish()?;
        Ok(profile)
    }

    /// The least that hardware with this profile's HiZ could move without compression
    /// and fast clears: each word read once and written once.
    #[must_use]
    pub fn compulsory(&self) -> Self {
        let least = Port {
            cache: CacheKind::Infinite,
            sector: 1,
            grain: 1,
            codec: false,
            fast_clear: false,
        };
        Self {
            name: format!("compulsory({})", self.name),
            depth_stencil: least,
            color: least,
            texture: least,
            texture_units: 1,
            ..self.clone()
        }
    }
}

impl Tile {
    const NONE: Self = Self {
        color_bytes: 0,
        depth_bytes: 0,
        largest: 8,
        align: 8,
        list_bytes: 0,
        vertex_reads: 1,
    };
}

fn hiz(f: &mut Facts<'_>) -> Result<Hiz, ProfileError> {
    let rules = [
        ("none", HizRules::None),
        ("gnomon", HizRules::Gnomon),
        ("r300", HizRules::R300),
        ("attila", HizRules::Attila),
        ("adreno", HizRules::Adreno),
    ];
    let rules = f.choice("hiz.rules", &rules)?;
    let mut hiz = Hiz {
        rules,
        keeps: Keeps::MinMax,
        bits: 32,
        on_write_back: false,
        entry_bytes: 0,
        entries: 0,
        in_memory: false,
    };
    if rules == HizRules::None {
        return Ok(hiz);
    }
    let keeps = [
        ("min-max", Keeps::MinMax),
        ("max", Keeps::Max),
        ("direction", Keeps::Direction),
    ];
    hiz.keeps = f.choice("hiz.keeps", &keeps)?;
    hiz.bits = f.number("hiz.bits", 1..=32)?;
    let updates = [("at-once", false), ("write-back", true)];
    hiz.on_write_back = f.choice("hiz.updates", &updates)?;
    hiz.entry_bytes = f.number("hiz.entry-bytes", 1..=64)?;
    hiz.entries = f.number("hiz.entries", 0..=u32::MAX)?;
    hiz.in_memory = f.switch("hiz.in-memory")?;
    Ok(hiz)
}

fn port(f: &mut Facts<'_>, client: &str) -> Result<Port, ProfileError> {
    let key = |name: &str| format!("{client}.{name}");
    #[derive(Clone, Copy, PartialEq)]
    enum Kind {
        None,
        Sets,
        Infinite,
    }
    let kinds = [
        ("none", Kind::None),
        ("sets", Kind::Sets),
        ("infinite", Kind::Infinite),
    ];
    let cache = match f.choice(&key("cache.kind"), &kinds)? {
        Kind::None => CacheKind::None,
        Kind::Infinite => CacheKind::Infinite,
        Kind::Sets => CacheKind::Sets {
            sets: f.number(&key("cache.units"), 1..=1024)?
                * f.number(&key("cache.sets"), 1..=65_536)?,
            ways: f.number(&key("cache.ways"), 1..=1024)?,
        },
    };
    let codecs = [("none", false), ("hilo", true)];
    let drawn_to = client != "texture";
    Ok(Port {
        cache,
        sector: f.number(&key("read-bytes"), 1..=256)?,
        grain: match drawn_to {
            true => f.number(&key("write-bytes"), 1..=256)?,
            false => 1,
        },
        codec: drawn_to && f.choice(&key("codec"), &codecs)?,
        fast_clear: drawn_to && f.switch(&key("fast-clear"))?,
    })
}

fn tile(f: &mut Facts<'_>) -> Result<Tile, ProfileError> {
    Ok(Tile {
        color_bytes: f.number("tile.color-bytes", 256..=1 << 24)?,
        depth_bytes: f.number("tile.zs-bytes", 0..=1 << 24)?,
        largest: f.number("tile.largest", 8..=4096)?,
        align: f.number("tile.align", 8..=256)?,
        list_bytes: f.number("tile.list-bytes", 0..=1024)?,
        vertex_reads: f.number("tile.vertex-reads", 1..=16)?,
    })
}
