//! Kept outputs of fragments.

use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, FragmentStage, Named, ShaderIdentity, UniformError,
    UniformReader, UniformWriter, Uniforms,
};
use gnomon_raster::{F32, Format, LANES, Lanes, MAX_COLOR_ATTACHMENTS, Mask, U32};

/// What the shader gave the fragments of a primitive, or of a piece of it, in a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) primitive: u32,
    /// Column and row.
    pub(super) block: [u16; 2],
    /// Fragments that were discarded.
    pub(super) discarded: u64,
    /// Fragments that have values.
    pub(super) kept: u64,
    /// Those whose colour is an integer, by attachment.
    pub(super) integers: [u64; MAX_COLOR_ATTACHMENTS],
    /// Where their values begin.
    pub(super) first: usize,
}

/// What the shader gave in a draw.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Outputs {
    pub(super) entries: Vec<Entry>,
    /// Of each fragment that was kept, four channels of each attachment, and depth if the
    /// shader writes it.
    pub(super) values: Vec<u32>,
}

/// Looks fragments up by primitive and pixel.
#[derive(Debug, PartialEq)]
pub(super) struct FrozenFragment {
    /// Name and version of the shader that computed them; empty for a closure.
    of: Vec<u8>,
    discards: bool,
    depth: bool,
    textures: usize,
    constant: Option<[f32; 4]>,
    /// Whether an attachment holds integers of 32 bits; one entry for each.
    words: Vec<bool>,
    /// Ordered by primitive, block row and column; of pieces of a primitive, which share
    /// no pixel, there are several.
    outputs: Outputs,
}

/// Name and version, for people.
pub(super) fn origin(identity: Option<ShaderIdentity>) -> Vec<u8> {
    let text = identity.map(|i| format!("{} {}", i.name, i.version));
    text.unwrap_or_default().into_bytes()
}

impl Named for FrozenFragment {
    const NAME: &'static str = "frozen.fragment";
    const VERSION: u32 = 1;
}

type Place = (u32, u16, u16);

impl Entry {
    fn place(&self) -> Place {
        (self.primitive, self.block[1], self.block[0])
    }
}

impl FrozenFragment {
    /// In the place of `stage`, which gave `outputs` to attachments of `formats`.
    pub(super) fn new(stage: &FragmentStage, formats: &[Format], mut outputs: Outputs) -> Self {
        let live = stage.outputs();
        outputs.entries.sort_by_key(Entry::place);
        Self {
            of: origin(stage.identity()),
            discards: live.discards,
            depth: live.depth,
            textures: live.textures,
            constant: stage.constant(),
            words: formats.iter().map(|f| *f == Format::R32Uint).collect(),
            outputs,
        }
    }

    /// Values of a fragment.
    fn width(&self) -> usize {
        4 * self.words.len() + usize::from(self.depth)
    }

    /// What the packet with its top-left pixel at (x, y) was given.
    fn packet(&self, primitive: u32, [x, y]: [u32; 2]) -> Packet {
        let mut packet = Packet::default();
        let place = (primitive, (y / 8) as u16, (x / 8) as u16);
        let entries = &self.outputs.entries;
        let start = entries.partition_point(|e| e.place() < place);
        let shift = 8 * (y % 8);
        for e in entries[start..].iter().take_while(|e| e.place() == place) {
            packet.discarded |= (e.discarded >> shift) as u16;
            for (i, integers) in e.integers.iter().enumerate() {
                packet.integers[i] |= (integers >> shift) as u16 != 0;
            }
            let lanes = (0..LANES as u32).filter(|lane| e.kept >> (shift + lane) & 1 != 0);
            for lane in lanes {
                let below = e.kept & ((1 << (shift + lane)) - 1);
                let first = e.first + below.count_ones() as usize * self.width();
                packet.set(
                    lane as usize,
                    &self.outputs.values[first..],
                    self.words.len(),
                );
            }
        }
        packet
    }
}

/// Of 16 fragments.
#[derive(Default)]
struct Packet {
    discarded: u16,
    /// Whether there are integers, by attachment.
    integers: [bool; MAX_COLOR_ATTACHMENTS],
    color: [[[u32; LANES]; 4]; MAX_COLOR_ATTACHMENTS],
    depth: [u32; LANES],
}

impl Packet {
    fn set(&mut self, lane: usize, values: &[u32], attachments: usize) {
        let (color, rest) = values.split_at(4 * attachments);
        let channels = self.color.iter_mut().flatten();
        for (channel, v) in channels.zip(color) {
            channel[lane] = *v;
        }
        self.depth[lane] = rest.first().copied().unwrap_or_default();
    }
}

impl FragmentShader for FrozenFragment {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: self.discards,
            depth: self.depth,
            textures: self.textures,
            counts: &[],
        }
    }

    fn constant(&self) -> Option<[f32; 4]> {
        self.constant
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let at = [
            f.column().to_array()[0] as u32,
            f.row().to_array()[0] as u32,
        ];
        let packet = self.packet(f.primitive_index(), at);
        for (i, word) in self.words.iter().enumerate() {
            let [r, g, b, a] = &packet.color[i];
            if *word && packet.integers[i] {
                f.set_color_uint(i, U32::from_array(l, r));
            } else {
                f.set_color(i, [float(l, r), float(l, g), float(l, b), float(l, a)]);
            }
        }
        if self.depth {
            f.set_depth(float(l, &packet.depth));
        }
        if self.discards {
            f.discard(Mask::from_bits(l, packet.discarded));
        }
    }
}

#[inline(always)]
fn float<L: Lanes>(l: L, bits: &[u32; LANES]) -> F32<L> {
    U32::from_array(l, bits).to_f32_bits()
}

impl Uniforms for FrozenFragment {
    fn put(&self, to: &mut UniformWriter) {
        self.of.put(to);
        self.discards.put(to);
        self.depth.put(to);
        self.textures.put(to);
        self.constant.put(to);
        self.words.put(to);
        // Column by column, which packs better.
        let entries = &self.outputs.entries;
        entries.len().put(to);
        entries.iter().for_each(|e| e.primitive.put(to));
        for k in 0..2 {
            entries
                .iter()
                .for_each(|e| to.bytes(&e.block[k].to_le_bytes()));
        }
        entries.iter().for_each(|e| e.discarded.put(to));
        entries.iter().for_each(|e| e.kept.put(to));
        for i in 0..self.words.len() {
            entries.iter().for_each(|e| e.integers[i].put(to));
        }
        for k in 0..self.width() {
            for e in entries {
                let end = e.first + e.kept.count_ones() as usize * self.width();
                let values = &self.outputs.values[e.first..end];
                let column = values.iter().skip(k).step_by(self.width());
                column.for_each(|v| v.put(to));
            }
        }
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        let mut shader = Self {
            of: Uniforms::take(from)?,
            discards: Uniforms::take(from)?,
            depth: Uniforms::take(from)?,
            textures: Uniforms::take(from)?,
            constant: Uniforms::take(from)?,
            words: Uniforms::take(from)?,
            outputs: Outputs::default(),
        };
        if shader.words.len() > MAX_COLOR_ATTACHMENTS {
            let given = shader.words.len() as u64;
            let valid = format!("at most {MAX_COLOR_ATTACHMENTS}");
            return Err(from.invalid(0, "the number of attachments", given, valid));
        }
        shader.outputs = take_outputs(from, shader.words.len(), shader.width())?;
        Ok(shader)
    }
}

/// Bytes of an entry without attachments.
const ENTRY: usize = 4 + 2 * 2 + 2 * 8;

fn take_outputs(
    from: &mut UniformReader<'_>,
    attachments: usize,
    width: usize,
) -> Result<Outputs, UniformError> {
    let mut entries = take_entries(from, attachments)?;
    let mut fragments = 0;
    for e in &mut entries {
        e.first = fragments * width;
        fragments += e.kept.count_ones() as usize;
    }
    // No memory before it is known that there are as many bytes.
    let wanted = fragments.saturating_mul(4 * width);
    if from.left() < wanted {
        let (given, valid) = (fragments as u64, format!("what {} bytes hold", from.left()));
        return Err(from.invalid(0, "the number of fragments", given, valid));
    }
    let mut values = vec![0; fragments * width];
    for k in 0..width {
        for i in 0..fragments {
            values[i * width + k] = u32::take(from)?;
        }
    }
    Ok(Outputs { entries, values })
}

fn take_entries(
    from: &mut UniformReader<'_>,
    attachments: usize,
) -> Result<Vec<Entry>, UniformError> {
    let count = usize::take(from)?;
    if count > from.left() / ENTRY {
        let valid = format!("at most {}", from.left() / ENTRY);
        return Err(from.invalid(8, "the number of entries", count as u64, valid));
    }
    let empty = Entry {
        primitive: 0,
        block: [0; 2],
        discarded: 0,
        kept: 0,
        integers: [0; MAX_COLOR_ATTACHMENTS],
        first: 0,
    };
    let mut entries = vec![empty; count];
    for e in &mut entries {
        e.primitive = u32::take(from)?;
    }
    for k in 0..2 {
        for e in &mut entries {
            e.block[k] = from.bytes().map(u16::from_le_bytes)?;
        }
    }
    for e in &mut entries {
        e.discarded = u64::take(from)?;
    }
    for e in &mut entries {
        e.kept = u64::take(from)?;
    }
    for i in 0..attachments {
        for e in &mut entries {
            e.integers[i] = u64::take(from)?;
        }
    }
    Ok(entries)
}
