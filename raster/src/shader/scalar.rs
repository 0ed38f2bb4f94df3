//! The simple tier: closures that see one vertex or one fragment.

use super::context::{FragmentContext, Packet};
use super::fragment::{Fragment, FragmentOutputs, FragmentShader};
use super::vertex::{Vertex, VertexShader};
use super::{FragmentStage, Interpolation, VertexStage};
use crate::simd::{F32, LANES, Lanes, Mask};
use crate::{MAX_COLOR_ATTACHMENTS, MAX_SHADER_COUNTS, MAX_VARYINGS};

/// One vertex, for a closure given to [`per_vertex`].
#[derive(Clone, Copy, Debug)]
pub struct ScalarVertex<'a> {
    /// The vertex's floats.
    pub attributes: &'a [f32],
    /// Its number in the vertex buffer.
    pub vertex_index: u32,
    /// The instance's number.
    pub instance_index: u32,
}

/// What a vertex closure returns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScalarVertexOutput {
    /// Clip-space position.
    pub position: [f32; 4],
    /// Varyings; those beyond the declared ones are ignored.
    pub varyings: [f32; MAX_VARYINGS],
}

/// One fragment: what a closure given to [`per_fragment`] sees of it, beside textures and
/// neighbours ([`FragmentContext`]).
#[derive(Clone, Copy, Debug)]
pub struct ScalarFragment {
    /// Interpolated varyings; 0 beyond the declared ones.
    pub varyings: [f32; MAX_VARYINGS],
    /// Pixel column.
    pub x: u32,
    /// Pixel row, 0 on top.
    pub y: u32,
    /// Depth in 0..=1.
    pub depth: f32,
    /// Clip-space w.
    pub w: f32,
    /// Whether the primitive faces the viewer.
    pub front_facing: bool,
    /// Number of the primitive in its draw.
    pub primitive_index: u32,
}

/// What a fragment closure returns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScalarFragmentOutput {
    /// Colour attachments in order. An `R32Uint` one takes the bits of the first
    /// channel, of a NaN the canonical ones; for integers see [`Self::set_uint`].
    pub color: [[f32; 4]; MAX_COLOR_ATTACHMENTS],
    /// The bits of the attachment's first channel are an integer, not to be touched.
    pub integer: [bool; MAX_COLOR_ATTACHMENTS],
    /// Depth, where declared.
    pub depth: f32,
    /// Throw the fragment away, where declared.
    pub discard: bool,
    /// To which of the declared counts it adds.
    pub counted: [bool; MAX_SHADER_COUNTS],
}

impl ScalarFragmentOutput {
    /// Writes `rgba` to attachment 0.
    #[must_use]
    pub fn color(rgba: [f32; 4]) -> Self {
        let mut o = Self::default();
        o.color[0] = rgba;
        o
    }

    /// Sets the value of the `R32Uint` attachment `i`; one beyond the last is ignored.
    pub fn set_uint(&mut self, i: usize, value: u32) {
        if let (Some(color), Some(integer)) = (self.color.get_mut(i), self.integer.get_mut(i)) {
            *color = [f32::from_bits(value); 4];
            *integer = true;
        }
    }
}

/// A vertex shader from a closure that sees one vertex.
pub fn per_vertex<F>(varyings: &[Interpolation], shade: F) -> VertexStage
where
    F: Fn(&ScalarVertex<'_>) -> ScalarVertexOutput + Send + Sync + 'static,
{
    PerVertex {
        varyings: varyings.to_vec(),
        shade,
    }
    .into()
}

/// A fragment shader from a closure that sees one fragment, its quad and textures; what it
/// may do beyond colours is declared in `outputs`.
pub fn per_fragment<F>(outputs: FragmentOutputs, shade: F) -> FragmentStage
where
    F: Fn(&FragmentContext<'_>) -> ScalarFragmentOutput + Send + Sync + 'static,
{
    PerFragment { outputs, shade }.into()
}

struct PerVertex<F> {
    varyings: Vec<Interpolation>,
    shade: F,
}

impl<F> VertexShader for PerVertex<F>
where
    F: Fn(&ScalarVertex<'_>) -> ScalarVertexOutput + Send + Sync,
{
    fn varyings(&self) -> &[Interpolation] {
        &self.varyings
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let mut position = [[0.0; LANES]; 4];
        let ids = v.vertex_index();
        for (lane, id) in ids.into_iter().enumerate() {
            let at = id as usize * v.batch.stride;
            let input = ScalarVertex {
                attributes: &v.batch.data[at..at + v.batch.stride],
                vertex_index: id,
                instance_index: v.batch.instance,
            };
            let out = (self.shade)(&input);
            for (p, o) in position.iter_mut().zip(out.position) {
                p[lane] = o;
            }
            for (slot, o) in v.varyings.iter_mut().zip(out.varyings) {
                slot[lane] = o;
            }
        }
        v.set_position(position.map(|p| F32::from_array(l, &p)));
    }
}

struct PerFragment<F> {
    outputs: FragmentOutputs,
    shade: F,
}

impl<F> FragmentShader for PerFragment<F>
where
    F: Fn(&FragmentContext<'_>) -> ScalarFragmentOutput + Send + Sync,
{
    fn outputs(&self) -> FragmentOutputs {
        self.outputs
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let live = f.live().bits();
        let mut all = [ScalarFragmentOutput::default(); LANES];
        let packet = Packet::new(f);
        for lane in (0..LANES).filter(|lane| live >> lane & 1 != 0) {
            all[lane] = (self.shade)(&packet.at(lane));
        }
        let mut discarded = 0u16;
        f.out.integers = [0; MAX_COLOR_ATTACHMENTS];
        let mut counted = [0u16; MAX_SHADER_COUNTS];
        for (lane, out) in all.iter().enumerate() {
            f.out.depth[lane] = out.depth;
            discarded |= u16::from(out.discard) << lane;
            for (lanes, adds) in counted.iter_mut().zip(out.counted) {
                *lanes |= u16::from(adds) << lane;
            }
            for (lanes, integer) in f.out.integers.iter_mut().zip(out.integer) {
                *lanes |= u16::from(integer) << lane;
            }
            for (target, color) in f.out.color.iter_mut().zip(out.color) {
                for (channel, c) in target.iter_mut().zip(color) {
                    channel[lane] = c;
                }
            }
        }
        f.set = u32::MAX;
        if self.outputs.discards {
            f.discard(Mask::from_bits(l, discarded));
        }
        for (i, lanes) in counted.into_iter().enumerate() {
            f.count(i, Mask::from_bits(l, lanes));
        }
    }
}
