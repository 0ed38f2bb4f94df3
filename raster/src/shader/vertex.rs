//! The vertex stage over lanes.

use super::Interpolation;
use crate::simd::{F32, LANES, Lanes};

/// Computes clip-space positions and varyings, 16 vertices at a time.
pub trait VertexShader: Send + Sync {
    /// How each varying is interpolated; the length is their number, at most
    /// [`crate::MAX_VARYINGS`].
    fn varyings(&self) -> &[Interpolation] {
        &[]
    }

    /// Shades a packet of vertices. Mark it `#[inline(always)]`, and everything
    /// it calls.
    fn shade<L: Lanes>(&self, l: L, vertex: &mut Vertex<'_, L>);
}

/// Where a batch of vertices comes from.
pub(crate) struct VertexBatch<'a> {
    /// Interleaved vertex data.
    pub(crate) data: &'a [f32],
    /// Floats from one vertex to the next.
    pub(crate) stride: usize,
    /// Vertex numbers to shade.
    pub(crate) vertices: &'a [u32],
    pub(crate) instance: u32,
}

/// Where shaded vertices go: one array a component, as long as the batch
/// rounded up to whole packets.
pub(crate) struct VertexOutput<'a, 'b> {
    pub(crate) position: [&'a mut [f32]; 4],
    /// One array a varying.
    pub(crate) varyings: &'a mut [&'b mut [f32]],
}

/// Input and output of 16 vertices.
pub struct Vertex<'a, L: Lanes> {
    pub(super) l: L,
    pub(super) batch: &'a VertexBatch<'a>,
    /// Vertex number of each lane.
    pub(super) ids: [u32; LANES],
    pub(super) position: [F32<L>; 4],
    pub(super) varyings: &'a mut [[f32; LANES]],
}

impl<L: Lanes> Vertex<'_, L> {
    /// Float `offset` of each vertex's data; 0 beyond the vertex's stride.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn attribute(&self, offset: usize) -> F32<L> {
        let mut a = [0.0; LANES];
        if offset < self.batch.stride {
            for (a, id) in a.iter_mut().zip(self.ids) {
                *a = self.batch.data[id as usize * self.batch.stride + offset];
            }
        }
        F32::from_array(self.l, &a)
    }

    /// Vertex number of each lane.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn vertex_index(&self) -> [u32; LANES] {
        self.ids
    }

    /// Instance number.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn instance_index(&self) -> u32 {
        self.batch.instance
    }

    /// Sets the clip-space position (x, y, z, w); depth 0..w, y up.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn set_position(&mut self, position: [F32<L>; 4]) {
        self.position = position;
    }

    /// Sets varying `i`; one that was not declared is ignored.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn set_varying(&mut self, i: usize, v: F32<L>) {
        if let Some(slot) = self.varyings.get_mut(i) {
            v.store(slot);
        }
    }
}
