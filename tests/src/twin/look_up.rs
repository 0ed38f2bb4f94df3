//! The texture look-ups of a program, at the four pixels of a quad at once.

use gnomon_raster::shader::ScalarFragment;
use gnomon_raster::{Counters, MAX_TEXTURES};

use super::texture::{Bound, Detail, Looked, TexelRead};

/// Most look-ups of a program.
pub const MAX_LOOK_UPS: usize = 3;

/// Values of a program's look-ups, in order.
pub(super) type Values = [[f32; 4]; MAX_LOOK_UPS];

/// What a coordinate is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Three varyings from this one on.
    Varyings(usize),
    /// The pixel centre and depth.
    Position,
    /// The first channels of an earlier look-up.
    LookUp(usize),
}

/// Three floats: an origin times a scale plus an offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// What it is made of.
    pub of: Origin,
    /// Factor by component.
    pub scale: [f32; 3],
    /// Summand by component.
    pub offset: [f32; 3],
}

/// Integer coordinates: the pixel's column and row shifted right, and 0, plus an offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelAt {
    /// Bits.
    pub shift: u32,
    /// Column, row, slice or face.
    pub offset: [i32; 3],
    /// Mip level.
    pub mip: u32,
}

/// How a texture is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LookUpKind {
    /// Level of detail from the quad.
    Sample(Coordinate),
    /// Level of detail from the changes given.
    Gradients(Coordinate, [Coordinate; 2]),
    /// Level of detail from a coordinate's first component.
    Level(Coordinate, Coordinate),
    /// Unfiltered.
    Fetch(TexelAt),
    /// Stored bits: the low and high 16 as floats, 0 and 1.
    Bits(TexelAt),
    /// The stencil aspect, as above.
    Stencil(TexelAt),
}

/// One look-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookUp {
    /// Texture slot; one without texture gives zeros.
    pub slot: usize,
    /// How.
    pub kind: LookUpKind,
}

/// Texture traffic of one fragment, by slot.
#[derive(Clone, Debug, Default)]
pub(super) struct Reads {
    fetches: [u64; MAX_TEXTURES],
    /// With their slots.
    pub(super) texels: Vec<(usize, TexelRead)>,
}

impl Reads {
    pub(super) fn count(&self, textures: &[Bound], c: &mut Counters) {
        for (slot, texture) in textures.iter().enumerate() {
            let t = &mut c.traffic.tex[slot];
            let texels = self.texels.iter().filter(|(s, _)| *s == slot).count() as u64;
            t.read_accesses += texels;
            t.read_bytes += texels * texture.bytes();
            c.traffic.tex_fetches[slot] += self.fetches[slot];
        }
    }
}

/// Values at the fragment `own` of a quad given row by row, and what was read for them.
pub(super) fn look_up_all(
    list: &[LookUp],
    textures: &[Bound],
    quad: &[ScalarFragment; 4],
    own: usize,
) -> (Values, Reads) {
    let mut values = [Values::default(); 4];
    let mut reads = Reads::default();
    for (k, look_up) in list.iter().enumerate() {
        let Some(texture) = textures.get(look_up.slot) else {
            continue;
        };
        let looked = look(texture, look_up, quad, &values);
        for (v, l) in values.iter_mut().zip(&looked) {
            v[k] = l.0;
        }
        reads.fetches[look_up.slot] += 1;
        let read = looked[own].1.iter().map(|read| (look_up.slot, *read));
        reads.texels.extend(read);
    }
    (values[own], reads)
}

fn look(t: &Bound, l: &LookUp, quad: &[ScalarFragment; 4], values: &[Values; 4]) -> [Looked; 4] {
    let all = |c: &Coordinate| std::array::from_fn(|i| at(c, &quad[i], &values[i]));
    let words = |(bits, read): (u32, Vec<TexelRead>)| (halves(bits), read);
    let integers = |t: &TexelAt| quad.each_ref().map(|f| integer(t, f));
    match &l.kind {
        LookUpKind::Sample(c) => {
            let at = all(c);
            [0, 1, 2, 3].map(|i| t.sample(at[i], Detail::Changes(changes(&at, i))))
        }
        LookUpKind::Gradients(c, d) => {
            let (at, d) = (all(c), d.map(|d| all(&d)));
            [0, 1, 2, 3].map(|i| t.sample(at[i], Detail::Changes(d.map(|d| d[i]))))
        }
        LookUpKind::Level(c, level) => {
            let (at, level) = (all(c), all(level));
            [0, 1, 2, 3].map(|i| t.sample(at[i], Detail::Level(level[i][0])))
        }
        LookUpKind::Fetch(at) => integers(at).map(|i| t.fetch_texel(i, at.mip)),
        LookUpKind::Bits(at) => integers(at).map(|i| words(t.fetch_bits(i, at.mip))),
        LookUpKind::Stencil(at) => integers(at).map(|i| words(t.fetch_stencil(i, at.mip))),
    }
}

pub(super) fn at(c: &Coordinate, f: &ScalarFragment, values: &Values) -> [f32; 3] {
    let origin = match c.of {
        Origin::Varyings(first) => [0, 1, 2].map(|k| f.varyings[first + k]),
        Origin::Position => [f.x as f32 + 0.5, f.y as f32 + 0.5, f.depth],
        Origin::LookUp(k) => [0, 1, 2].map(|c| values[k][c]),
    };
    [0, 1, 2].map(|k| origin[k] * c.scale[k] + c.offset[k])
}

/// Right minus left in the pixel's row, lower minus upper in its column.
fn changes(at: &[[f32; 3]; 4], i: usize) -> [[f32; 3]; 2] {
    let minus = |a: usize, b: usize| [0, 1, 2].map(|k| at[a][k] - at[b][k]);
    let (row, column) = (i / 2, i % 2);
    [minus(2 * row + 1, 2 * row), minus(2 + column, column)]
}

pub(super) fn integer(t: &TexelAt, f: &ScalarFragment) -> [i32; 3] {
    let [x, y] = [f.x, f.y].map(|v| (v >> t.shift) as i32);
    [x + t.offset[0], y + t.offset[1], t.offset[2]]
}

pub(super) fn halves(bits: u32) -> [f32; 4] {
    [(bits & 0xffff) as f32, (bits >> 16) as f32, 0.0, 1.0]
}
