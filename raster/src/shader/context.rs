//! What a closure for one fragment sees beside the fragment: textures, and the other
//! fragments of its 2×2 quad.

use core::cell::RefCell;
use core::fmt;
use core::ops::Deref;

use super::{Fragment, ScalarFragment};
use crate::simd::{F32, I32, LANES, Lanes, outlined};
use crate::{MAX_VARYINGS, U32};

/// One fragment with its surroundings, for a closure given to
/// [`per_fragment`](super::per_fragment): what it is itself is a [`ScalarFragment`], to
/// which this dereferences.
///
/// Look-ups take the draw's slots, as those of [`Fragment`] do, with the same bits: the
/// arithmetic is in `docs/texture-rules.md`. They are counted for fragments, and not where
/// a closure is asked about a neighbour for the sake of a derivative.
///
/// ```
/// use gnomon_raster::shader::{FragmentOutputs, ScalarFragmentOutput, per_fragment};
///
/// // The texture of slot 0 at varyings 0 and 1, at the level of detail of the quad.
/// let outputs = FragmentOutputs { textures: 1, ..FragmentOutputs::default() };
/// let textured = per_fragment(outputs, |f| {
///     ScalarFragmentOutput::color(f.sample(0, |f| [f.varyings[0], f.varyings[1], 0.0]))
/// });
/// # drop(textured);
/// ```
pub struct FragmentContext<'a> {
    fragment: ScalarFragment,
    lane: usize,
    /// Its look-ups are those of a fragment.
    counted: bool,
    packet: &'a dyn Surroundings,
}

impl Deref for FragmentContext<'_> {
    type Target = ScalarFragment;

    fn deref(&self) -> &ScalarFragment {
        &self.fragment
    }
}

impl fmt::Debug for FragmentContext<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.fragment.fmt(f)
    }
}

impl FragmentContext<'_> {
    /// How `of` changes to the right inside the quad (fine derivative): right minus left,
    /// in the fragment's row. A neighbour may lie outside the primitive.
    pub fn ddx(&self, of: impl Fn(&FragmentContext<'_>) -> f32) -> f32 {
        self.change(1, of)
    }

    /// How `of` changes downwards inside the quad: lower minus upper, in the fragment's
    /// column.
    pub fn ddy(&self, of: impl Fn(&FragmentContext<'_>) -> f32) -> f32 {
        self.change(ROW, of)
    }

    /// The texture of `slot` filtered by its sampler at `coord`, the level of detail from
    /// the change of `coord` over the quad; see [`Fragment::sample`].
    pub fn sample(
        &self,
        slot: usize,
        coord: impl Fn(&FragmentContext<'_>) -> [f32; 3],
    ) -> [f32; 4] {
        let change = |bit| {
            let [low, high] = self.pair(bit);
            let (low, high) = (coord(&low), coord(&high));
            [0, 1, 2].map(|k| high[k] - low[k])
        };
        self.sample_grad(slot, coord(self), change(1), change(ROW))
    }

    /// The same with the change of `coord` to the next pixel in x and y given.
    #[must_use]
    pub fn sample_grad(
        &self,
        slot: usize,
        coord: [f32; 3],
        dx: [f32; 3],
        dy: [f32; 3],
    ) -> [f32; 4] {
        self.look_up(slot, LookUp::Gradients(coord, dx, dy))
    }

    /// Filtered at the level of detail given; see [`Fragment::sample_level`].
    #[must_use]
    pub fn sample_level(&self, slot: usize, coord: [f32; 3], lod: f32) -> [f32; 4] {
        self.look_up(slot, LookUp::Level(coord, lod))
    }

    /// The texel at column, row, and slice or cube face of level `mip`, unfiltered; zero
    /// outside.
    #[must_use]
    pub fn fetch_texel(&self, slot: usize, at: [i32; 3], mip: u32) -> [f32; 4] {
        self.look_up(slot, LookUp::Texel(at, mip))
    }

    /// The stored bits of a texel; see [`Fragment::fetch_texel_bits`].
    #[must_use]
    pub fn fetch_texel_bits(&self, slot: usize, at: [i32; 3], mip: u32) -> u32 {
        self.look_up(slot, LookUp::Bits(at, mip))[0].to_bits()
    }

    /// The stencil value of a texel; zero outside and for colour.
    #[must_use]
    pub fn fetch_stencil(&self, slot: usize, at: [i32; 3], mip: u32) -> u32 {
        self.look_up(slot, LookUp::Stencil(at, mip))[0].to_bits()
    }

    /// Width, height and depth of level `mip` in texels; zeros without one.
    #[must_use]
    pub fn texture_size(&self, slot: usize, mip: u32) -> [u32; 3] {
        self.packet.size(slot, mip)
    }

    fn change(&self, bit: usize, of: impl Fn(&FragmentContext<'_>) -> f32) -> f32 {
        let [low, high] = self.pair(bit);
        of(&high) - of(&low)
    }

    /// The fragment and its neighbour in the quad, that without `bit` in its lane first.
    fn pair(&self, bit: usize) -> [FragmentContext<'_>; 2] {
        [self.lane & !bit, self.lane | bit].map(|lane| FragmentContext {
            fragment: self.packet.inputs().fragment(lane),
            lane,
            counted: false,
            packet: self.packet,
        })
    }

    fn look_up(&self, slot: usize, what: LookUp) -> [f32; 4] {
        self.packet.look_up(self.lane, self.counted, slot, what)
    }
}

/// The lane below another.
const ROW: usize = LANES / 2;

/// A packet whose fragments are given to a closure one after the other.
pub(super) struct Packet<'a, 'f, L: Lanes> {
    inputs: Inputs,
    fragments: RefCell<&'a mut Fragment<'f, L>>,
}

impl<'a, 'f, L: Lanes> Packet<'a, 'f, L> {
    #[inline(always)]
    pub(super) fn new(fragments: &'a mut Fragment<'f, L>) -> Self {
        Self {
            inputs: Inputs::new(fragments),
            fragments: RefCell::new(fragments),
        }
    }

    /// The fragment of `lane`.
    pub(super) fn at(&self, lane: usize) -> FragmentContext<'_> {
        FragmentContext {
            fragment: self.inputs.fragment(lane),
            lane,
            counted: true,
            packet: self,
        }
    }
}

/// What the fragments of a packet are, helpers too.
struct Inputs {
    varyings: [[f32; LANES]; MAX_VARYINGS],
    depth: [f32; LANES],
    w: [f32; LANES],
    columns: [i32; LANES],
    rows: [i32; LANES],
    front_facing: bool,
    primitive_index: u32,
}

impl Inputs {
    #[inline(always)]
    fn new<L: Lanes>(f: &Fragment<'_, L>) -> Self {
        let mut varyings = [[0.0; LANES]; MAX_VARYINGS];
        for (i, v) in varyings.iter_mut().enumerate() {
            f.varying(i).store(v);
        }
        Self {
            varyings,
            depth: f.depth().to_array(),
            w: f.w().to_array(),
            columns: f.column().to_array(),
            rows: f.row().to_array(),
            front_facing: f.front_facing(),
            primitive_index: f.primitive_index(),
        }
    }

    fn fragment(&self, lane: usize) -> ScalarFragment {
        ScalarFragment {
            varyings: core::array::from_fn(|i| self.varyings[i][lane]),
            x: self.columns[lane] as u32,
            y: self.rows[lane] as u32,
            depth: self.depth[lane],
            w: self.w[lane],
            front_facing: self.front_facing,
            primitive_index: self.primitive_index,
        }
    }
}

/// One look-up of one fragment.
#[derive(Clone, Copy)]
enum LookUp {
    Gradients([f32; 3], [f32; 3], [f32; 3]),
    Level([f32; 3], f32),
    Texel([i32; 3], u32),
    /// Of these two the first channel is the bits of an integer.
    Bits([i32; 3], u32),
    Stencil([i32; 3], u32),
}

/// A packet, whatever the level that it is shaded at.
trait Surroundings {
    fn inputs(&self) -> &Inputs;

    /// For one lane, and in its name where that is `counted`.
    fn look_up(&self, lane: usize, counted: bool, slot: usize, what: LookUp) -> [f32; 4];

    fn size(&self, slot: usize, mip: u32) -> [u32; 3];
}

impl<L: Lanes> Surroundings for Packet<'_, '_, L> {
    fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    fn look_up(&self, lane: usize, counted: bool, slot: usize, what: LookUp) -> [f32; 4] {
        let f = &mut **self.fragments.borrow_mut();
        let live = f.live;
        f.live = u16::from(counted) << lane;
        // Closures are no lane code: this is where the level begins again.
        let value = outlined(
            f.lanes(),
            #[inline(always)]
            || look_up_everywhere(f, slot, what),
        );
        f.live = live;
        value.map(|channel| channel[lane])
    }

    fn size(&self, slot: usize, mip: u32) -> [u32; 3] {
        self.fragments.borrow().texture_size(slot, mip)
    }
}

/// The same look-up in all lanes.
#[inline(always)]
fn look_up_everywhere<L: Lanes>(
    f: &mut Fragment<'_, L>,
    slot: usize,
    what: LookUp,
) -> [[f32; LANES]; 4] {
    let l = f.lanes();
    let value = match what {
        LookUp::Gradients(at, dx, dy) => {
            f.sample_grad(slot, floats(l, at), floats(l, dx), floats(l, dy))
        }
        LookUp::Level(at, lod) => f.sample_level(slot, floats(l, at), F32::splat(l, lod)),
        LookUp::Texel(at, mip) => f.fetch_texel(slot, integers(l, at), mip),
        LookUp::Bits(at, mip) => bits(l, f.fetch_texel_bits(slot, integers(l, at), mip)),
        LookUp::Stencil(at, mip) => bits(l, f.fetch_stencil(slot, integers(l, at), mip)),
    };
    [
        value[0].to_array(),
        value[1].to_array(),
        value[2].to_array(),
        value[3].to_array(),
    ]
}

#[inline(always)]
fn floats<L: Lanes>(l: L, v: [f32; 3]) -> [F32<L>; 3] {
    [
        F32::splat(l, v[0]),
        F32::splat(l, v[1]),
        F32::splat(l, v[2]),
    ]
}

#[inline(always)]
fn integers<L: Lanes>(l: L, v: [i32; 3]) -> [I32<L>; 3] {
    [
        I32::splat(l, v[0]),
        I32::splat(l, v[1]),
        I32::splat(l, v[2]),
    ]
}

#[inline(always)]
fn bits<L: Lanes>(l: L, v: U32<L>) -> [F32<L>; 4] {
    let zero = F32::splat(l, 0.0);
    [v.to_f32_bits(), zero, zero, zero]
}

#[cfg(test)]
mod tests {
    use crate::shader::ScalarFragmentOutput;
    use crate::{FrameBuilder, GpuConfig, TriangleDraw};

    /// Look-ups only need the size of changes, so none of them tells the sign.
    #[test]
    fn derivatives_are_to_the_right_and_downwards() {
        let everywhere = [[-1.0, -1.0, 0.5], [3.0, -1.0, 0.5], [-1.0, 3.0, 0.5]];
        let draw = TriangleDraw::new("everywhere", &everywhere).shade(|f| {
            let right = f.ddx(|f| f.x as f32 * 0.25);
            let down = f.ddy(|f| f.y as f32 * 0.5);
            let across = f.ddx(|f| f.y as f32) + f.ddy(|f| f.x as f32);
            ScalarFragmentOutput::color([right, down, across, 1.0])
        });
        let mut frame = FrameBuilder::new(12, 8).expect("a size");
        let frame = frame.draw(draw).build();
        let config = GpuConfig {
            threads: 1,
            ..GpuConfig::default()
        };
        let drawn = frame.draw(config).expect("a frame");
        let pixels = drawn.read_rgba8("color").expect("colour");
        assert!(pixels.iter().all(|p| *p == [64, 128, 0, 255]), "{pixels:?}");
    }
}
