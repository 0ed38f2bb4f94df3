//! Vertices and primitive assembly (rules, §1).

use gnomon_raster::MAX_VARYINGS;

use super::case::TwinDraw;

/// A shaded vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) position: [f32; 4],
    pub(super) varyings: [f32; MAX_VARYINGS],
}

impl Vertex {
    pub(super) fn is_finite(&self) -> bool {
        self.position.iter().all(|c| c.is_finite())
    }
}

/// The vertex shader.
pub(super) fn shade(draw: &TwinDraw, index: u32, instance: u32) -> Vertex {
    let at = index as usize;
    let shift = draw.instance_offset.map(|o| o * instance as f32);
    let position = std::array::from_fn(|c| draw.positions[at][c] + shift[c]);
    let mut varyings = [0.0; MAX_VARYINGS];
    for (slot, v) in varyings
        .iter_mut()
        .zip(&draw.varyings[at])
        .take(draw.interpolation.len())
    {
        *slot = *v;
    }
    Vertex { position, varyings }
}

/// Vertex numbers that one instance of the draw refers to, in order.
pub(super) fn sequence(draw: &TwinDraw) -> Vec<u32> {
    let range = draw.first..draw.first + draw.count;
    match &draw.indices {
        Some(indices) => range.map(|i| indices[i as usize]).collect(),
        None => range.collect(),
    }
}

/// How many different vertices a sequence has.
pub(super) fn distinct(sequence: &[u32]) -> u64 {
    let mut sorted = sequence.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    sorted.len() as u64
}
