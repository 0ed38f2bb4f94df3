//! Kept clip positions.

use gnomon_raster::shader::{Named, Vertex, VertexShader};
use gnomon_raster::{Draw, Error, F32, LANES, Lanes, uniforms};

/// Looks vertices up by number and instance.
pub(super) struct FrozenVertex {
    /// Name and version of the shader that computed them; empty for a closure.
    of: Vec<u8>,
    /// Numbers of the vertices, ascending.
    numbers: Vec<u32>,
    /// Their positions in the first instance, then in the next.
    positions: Vec<[f32; 4]>,
}

uniforms!(FrozenVertex {
    of,
    numbers,
    positions
});

impl Named for FrozenVertex {
    const NAME: &'static str = "frozen.vertex";
    const VERSION: u32 = 1;
}

impl FrozenVertex {
    /// The vertices of `draw`.
    pub(super) fn of(draw: &Draw) -> Result<Self, Error> {
        let vertex = &draw.pipeline.vertex;
        let each = draw.pipeline.primitive.topology.vertices();
        let range = draw.first..draw.first + draw.count / each * each;
        let mut numbers: Vec<u32> = match &draw.indices {
            None => range.collect(),
            Some(i) => i.indices()[range.start as usize..range.end as usize].to_vec(),
        };
        numbers.sort_unstable();
        numbers.dedup();
        let mut positions = Vec::new();
        for instance in 0..draw.instances {
            positions.extend(vertex.positions(draw.vertices.as_deref(), &numbers, instance)?);
        }
        Ok(Self {
            of: super::fragment::origin(vertex.identity()),
            numbers,
            positions,
        })
    }

    /// The position of a vertex; zeros for one that was not kept.
    fn position(&self, number: u32, instance: u32) -> [f32; 4] {
        let Ok(rank) = self.numbers.binary_search(&number) else {
            return [0.0; 4];
        };
        let at = instance as usize * self.numbers.len() + rank;
        self.positions.get(at).copied().unwrap_or_default()
    }
}

impl VertexShader for FrozenVertex {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let instance = v.instance_index();
        let mut columns = [[0.0; LANES]; 4];
        for (lane, number) in v.vertex_index().into_iter().enumerate() {
            for (c, p) in self.position(number, instance).into_iter().enumerate() {
                columns[c][lane] = p;
            }
        }
        let [x, y, z, w] = &columns;
        v.set_position([
            F32::from_array(l, x),
            F32::from_array(l, y),
            F32::from_array(l, z),
            F32::from_array(l, w),
        ]);
    }
}
