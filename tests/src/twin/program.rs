//! The closed family of fragment shader programs, one fragment at a time.

use gnomon_raster::MAX_COLOR_ATTACHMENTS;
use gnomon_raster::shader::{FragmentOutputs, ScalarFragment, ScalarFragmentOutput};

use super::look_up::{LookUp, Values};

/// Where colours come from.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorSource {
    /// The same everywhere, by attachment.
    Constant([[f32; 4]; MAX_COLOR_ATTACHMENTS]),
    /// Varyings, in turn.
    Varyings,
    /// Position, depth, facing, primitive number and w.
    Geometry,
    /// NaN, infinities and values out of every range, by position, and varyings.
    Wild,
    /// Column / 255 in red, green and blue, and in alpha unless it is given.
    Columns(Option<f32>),
    /// What was looked up, in turn.
    LookUps,
}

/// Which fragments are thrown away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Discard {
    /// Declared, but none.
    Never,
    /// All.
    Always,
    /// Every other square of 2ⁿ pixels.
    Checker(u32),
    /// Where a varying is below a threshold.
    Below(usize, f32),
    /// Where the first channel of a look-up is below a threshold.
    LookUpBelow(usize, f32),
}

/// What depth is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DepthSource {
    /// The interpolated one.
    Same,
    /// A varying times a factor.
    Varying(usize, f32),
    /// NaN, infinities, out of range, by position, and a varying.
    Wild(usize),
    /// The first channel of a look-up.
    LookUp(usize),
}

/// A fragment shader.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Colour of each output.
    pub color: ColorSource,
    /// Number of outputs.
    pub outputs: usize,
    /// Outputs that are integers: hashes of the position, or the bits of the first
    /// channel of what was looked up.
    pub uint: [bool; MAX_COLOR_ATTACHMENTS],
    /// Discards.
    pub discard: Option<Discard>,
    /// Depth.
    pub depth: Option<DepthSource>,
    /// Texture look-ups; only shaders over lanes have any.
    pub look_ups: Vec<LookUp>,
    /// Texture slots declared.
    pub textures: usize,
    /// It discards before it looks up.
    pub discards_first: bool,
}

/// Every eighth pixel has one of these, or keeps its varying (index 4).
pub(super) const WILD_COLORS: [u32; 8] = [
    0x7fc1_2345, // a NaN that is not the canonical one
    0x7f80_0000, // ∞
    0xff80_0000, // −∞
    0x8000_0000, // −0
    0,           // the varying
    0x7149_f2ca, // 1e30
    0xbe80_0000, // −¼
    0x4788_b840, // 70000.5
];

/// As above, for depth.
pub(super) const WILD_DEPTHS: [u32; 8] = [
    0xffc0_0001, // NaN
    0x7f80_0000, // ∞
    0xff80_0000, // −∞
    0x8000_0000, // −0
    0,           // the varying
    0x3f80_0001, // just above 1
    0xb300_0000, // just below 0
    0x3f7f_ffff, // just below 1
];

/// Factors of the hash that fills integer outputs.
pub(super) const HASH: [u32; 3] = [0x9e37_79b1, 0x85eb_ca77, 0xc2b2_ae3d];

impl Program {
    /// One colour everywhere, to one output.
    #[must_use]
    pub fn constant(rgba: [f32; 4]) -> Self {
        Self::plain(ColorSource::Constant([rgba; MAX_COLOR_ATTACHMENTS]))
    }

    /// One output, nothing declared.
    #[must_use]
    pub fn plain(color: ColorSource) -> Self {
        Self {
            color,
            outputs: 1,
            uint: [false; MAX_COLOR_ATTACHMENTS],
            discard: None,
            depth: None,
            look_ups: Vec::new(),
            textures: 0,
            discards_first: false,
        }
    }

    /// What the shader declares.
    #[must_use]
    pub fn declared(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: self.discard.is_some(),
            depth: self.depth.is_some(),
            textures: self.textures,
            counts: &["odd columns", "discarded"],
        }
    }

    /// Shades one fragment.
    #[must_use]
    pub fn shade(&self, f: &ScalarFragment, looked_up: &Values) -> ScalarFragmentOutput {
        let mut out = ScalarFragmentOutput {
            depth: self.depth.map_or(0.0, |d| shade_depth(d, f, looked_up)),
            discard: self.discard.is_some_and(|d| discards(d, f, looked_up)),
            ..ScalarFragmentOutput::default()
        };
        (out.counted[0], out.counted[1]) = (f.x % 2 == 1, out.discard);
        for o in 0..self.outputs {
            if self.uint[o] {
                out.set_uint(o, self.integer(o, f, looked_up));
            } else {
                out.color[o] = self.color(o, f, looked_up);
            }
        }
        out
    }

    /// The look-up that output `o` shows.
    pub(super) fn look_up_of(&self, o: usize) -> usize {
        o % self.look_ups.len().max(1)
    }

    fn integer(&self, o: usize, f: &ScalarFragment, looked_up: &Values) -> u32 {
        if self.color == ColorSource::LookUps {
            looked_up[self.look_up_of(o)][0].to_bits()
        } else {
            hash(f)
        }
    }

    fn color(&self, o: usize, f: &ScalarFragment, looked_up: &Values) -> [f32; 4] {
        match &self.color {
            ColorSource::Constant(c) => c[o],
            ColorSource::Varyings => std::array::from_fn(|c| f.varyings[(4 * o + c) % 6]),
            ColorSource::Geometry => geometry(o, f),
            ColorSource::LookUps => looked_up[self.look_up_of(o)],
            ColorSource::Columns(alpha) => {
                let v = f.x as f32 / 255.0;
                [v, v, v, alpha.unwrap_or(v)]
            }
            ColorSource::Wild => {
                std::array::from_fn(|c| wild(&WILD_COLORS, (o + c) as u32, f.varyings[c], f))
            }
        }
    }
}

fn geometry(o: usize, f: &ScalarFragment) -> [f32; 4] {
    let (x, y) = (f.x as f32 + 0.5, f.y as f32 + 0.5);
    if o == 0 {
        [
            x * 0.015625,
            y / (y + 3.0),
            f.depth,
            if f.front_facing { 0.75 } else { 0.25 },
        ]
    } else {
        [
            f.depth * f.depth,
            f.primitive_index as f32 * 0.125,
            x.sqrt(),
            f.w,
        ]
    }
}

/// One of eight values by position.
fn wild(table: &[u32; 8], shift: u32, varying: f32, f: &ScalarFragment) -> f32 {
    let k = (f.x + 3 * f.y + shift) % 8;
    if k == 4 {
        varying
    } else {
        f32::from_bits(table[k as usize])
    }
}

fn hash(f: &ScalarFragment) -> u32 {
    let [a, b, c] = HASH;
    f.x.wrapping_mul(a) ^ f.y.wrapping_mul(b) ^ f.primitive_index.wrapping_mul(c)
}

fn shade_depth(d: DepthSource, f: &ScalarFragment, looked_up: &Values) -> f32 {
    match d {
        DepthSource::Same => f.depth,
        DepthSource::Varying(i, scale) => f.varyings[i] * scale,
        DepthSource::Wild(i) => wild(&WILD_DEPTHS, 0, f.varyings[i], f),
        DepthSource::LookUp(k) => looked_up[k][0],
    }
}

fn discards(d: Discard, f: &ScalarFragment, looked_up: &Values) -> bool {
    match d {
        Discard::Never => false,
        Discard::Always => true,
        Discard::Checker(n) => ((f.x >> n) + (f.y >> n)) % 2 == 1,
        Discard::Below(i, threshold) => f.varyings[i] < threshold,
        Discard::LookUpBelow(k, threshold) => looked_up[k][0] < threshold,
    }
}
