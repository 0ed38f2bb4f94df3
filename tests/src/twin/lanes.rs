//! The same vertex shader and fragment programs as shaders of the GPU.

use std::sync::Arc;

use gnomon_raster::shader::{
    Fragment, FragmentContext, FragmentOutputs, FragmentShader, FragmentStage, Interpolation,
    ScalarFragmentOutput, ScalarVertexOutput, Vertex, VertexShader, VertexStage, per_fragment,
    per_vertex,
};
use gnomon_raster::{F32, I32, Lanes, MAX_VARYINGS, Mask, U32};

use super::case::{Tier, TwinDraw, VertexSource};
use super::context_look_up;
use super::lane_look_up::{LaneValues, look_up_all};
use super::look_up::{MAX_LOOK_UPS, Values};
use super::program::{ColorSource, DepthSource, Discard, HASH, Program, WILD_COLORS, WILD_DEPTHS};
use super::vertex;

impl TwinDraw {
    /// The draw's vertex shader for the GPU.
    #[must_use]
    pub fn vertex_stage(&self) -> VertexStage {
        match (self.vertex_source, self.vertex_tier) {
            (VertexSource::Table, _) => self.table_stage(),
            (VertexSource::Buffer, Tier::Closure) => self.closure_stage(),
            (VertexSource::Buffer, Tier::Lanes) => PassThrough {
                offset: self.instance_offset,
                interpolation: self.interpolation.clone(),
            }
            .into(),
        }
    }

    fn table_stage(&self) -> VertexStage {
        let table = Arc::new(self.clone());
        per_vertex(&self.interpolation, move |v| {
            let v = vertex::shade(&table, v.vertex_index, v.instance_index);
            ScalarVertexOutput {
                position: v.position,
                varyings: v.varyings,
            }
        })
    }

    fn closure_stage(&self) -> VertexStage {
        let offset = self.instance_offset;
        per_vertex(&self.interpolation, move |v| {
            let mut varyings = [0.0; MAX_VARYINGS];
            varyings
                .iter_mut()
                .zip(&v.attributes[4..])
                .for_each(|(slot, a)| *slot = *a);
            let shift = offset.map(|o| o * v.instance_index as f32);
            ScalarVertexOutput {
                position: std::array::from_fn(|c| v.attributes[c] + shift[c]),
                varyings,
            }
        })
    }

    /// The draw's fragment shader for the GPU.
    #[must_use]
    pub fn fragment_stage(&self) -> Option<FragmentStage> {
        let program = self.program.clone()?;
        Some(match self.fragment_tier {
            Tier::Lanes => LaneProgram(program).into(),
            Tier::Closure => per_fragment(program.declared(), move |f| closure(&program, f)),
        })
    }
}

/// The program as a closure: it is over where it discards first, before look-ups.
fn closure(program: &Program, f: &FragmentContext<'_>) -> ScalarFragmentOutput {
    if program.discards_first {
        let out = program.shade(f, &Values::default());
        if out.discard {
            return out;
        }
    }
    program.shade(f, &context_look_up::look_up_all(&program.look_ups, f))
}

/// Attributes 0..4 are the position, the others the varyings.
struct PassThrough {
    offset: [f32; 4],
    interpolation: Vec<Interpolation>,
}

impl VertexShader for PassThrough {
    fn varyings(&self) -> &[Interpolation] {
        &self.interpolation
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let instance = v.instance_index() as f32;
        let mut position = [F32::splat(l, 0.0); 4];
        for (c, p) in position.iter_mut().enumerate() {
            *p = v.attribute(c) + self.offset[c] * instance;
        }
        v.set_position(position);
        for i in 0..self.interpolation.len() {
            let a = v.attribute(4 + i);
            v.set_varying(i, a);
        }
    }
}

struct LaneProgram(Program);

impl FragmentShader for LaneProgram {
    fn outputs(&self) -> FragmentOutputs {
        self.0.declared()
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let one = I32::splat(l, 1);
        f.count(0, (f.column() & one).eq(one));
        let mut values = [[F32::splat(l, 0.0); 4]; MAX_LOOK_UPS];
        if self.0.discards_first {
            self.discard(l, f, &values);
        }
        if !self.0.look_ups.is_empty() {
            values = look_up_all(l, &self.0.look_ups, f);
        }
        for o in 0..self.0.outputs {
            self.output(l, o, f, &values);
        }
        if let Some(d) = self.0.depth {
            let z = depth(d, l, f, &values);
            f.set_depth(z);
        }
        if !self.0.discards_first {
            self.discard(l, f, &values);
        }
    }
}

impl LaneProgram {
    #[inline(always)]
    fn discard<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>, values: &LaneValues<L>) {
        if let Some(d) = self.0.discard {
            let mask = discards(d, l, f, values);
            f.discard(mask);
            f.count(1, mask);
        }
    }

    #[inline(always)]
    fn output<L: Lanes>(&self, l: L, o: usize, f: &mut Fragment<'_, L>, values: &LaneValues<L>) {
        let looked_up = values[self.0.look_up_of(o)];
        match (self.0.uint[o], self.0.color == ColorSource::LookUps) {
            (true, true) => f.set_color_uint(o, looked_up[0].to_bits()),
            (true, false) => {
                let bits = hash(l, f);
                f.set_color_uint(o, bits);
            }
            (false, true) => f.set_color(o, looked_up),
            (false, false) => {
                let rgba = color(&self.0.color, l, o, f);
                f.set_color(o, rgba);
            }
        }
    }
}

#[inline(always)]
fn color<L: Lanes>(source: &ColorSource, l: L, o: usize, f: &Fragment<'_, L>) -> [F32<L>; 4] {
    let mut rgba = [F32::splat(l, 0.0); 4];
    if let ColorSource::Geometry = source {
        return geometry(l, o, f);
    }
    for (c, v) in rgba.iter_mut().enumerate() {
        *v = match source {
            ColorSource::Constant(k) => F32::splat(l, k[o][c]),
            ColorSource::Varyings => f.varying((4 * o + c) % 6),
            ColorSource::Columns(Some(alpha)) if c == 3 => F32::splat(l, *alpha),
            ColorSource::Columns(_) => f.column().to_f32() / 255.0,
            _ => wild(&WILD_COLORS, l, (o + c) as i32, f.varying(c), f),
        };
    }
    rgba
}

#[inline(always)]
fn geometry<L: Lanes>(l: L, o: usize, f: &Fragment<'_, L>) -> [F32<L>; 4] {
    let (x, y, depth) = (f.x(), f.y(), f.depth());
    if o == 0 {
        let facing = if f.front_facing() { 0.75 } else { 0.25 };
        [x * 0.015625, y / (y + 3.0), depth, F32::splat(l, facing)]
    } else {
        [
            depth * depth,
            F32::splat(l, f.primitive_index() as f32 * 0.125),
            x.sqrt(),
            f.w(),
        ]
    }
}

#[inline(always)]
fn wild<L: Lanes>(
    table: &[u32; 8],
    l: L,
    shift: i32,
    varying: F32<L>,
    f: &Fragment<'_, L>,
) -> F32<L> {
    let k = (f.column() + f.row() * I32::splat(l, 3) + I32::splat(l, shift)) & I32::splat(l, 7);
    let mut v = varying;
    for (i, bits) in table.iter().enumerate() {
        if i != 4 {
            let value = U32::splat(l, *bits).to_f32_bits();
            v = k.eq(I32::splat(l, i as i32)).select_f32(value, v);
        }
    }
    v
}

#[inline(always)]
fn hash<L: Lanes>(l: L, f: &Fragment<'_, L>) -> U32<L> {
    let [a, b, c] = HASH;
    let x = f.column().to_u32() * U32::splat(l, a);
    let y = f.row().to_u32() * U32::splat(l, b);
    x ^ y ^ U32::splat(l, f.primitive_index().wrapping_mul(c))
}

#[inline(always)]
fn depth<L: Lanes>(d: DepthSource, l: L, f: &Fragment<'_, L>, values: &LaneValues<L>) -> F32<L> {
    match d {
        DepthSource::Same => f.depth(),
        DepthSource::Varying(i, scale) => f.varying(i) * scale,
        DepthSource::Wild(i) => wild(&WILD_DEPTHS, l, 0, f.varying(i), f),
        DepthSource::LookUp(k) => values[k][0],
    }
}

#[inline(always)]
fn discards<L: Lanes>(d: Discard, l: L, f: &Fragment<'_, L>, values: &LaneValues<L>) -> Mask<L> {
    match d {
        Discard::Never => Mask::splat(l, false),
        Discard::Always => Mask::splat(l, true),
        Discard::Checker(n) => {
            let cells = (f.column() >> n) + (f.row() >> n);
            (cells & I32::splat(l, 1)).eq(I32::splat(l, 1))
        }
        Discard::Below(i, threshold) => f.varying(i).lt(F32::splat(l, threshold)),
        Discard::LookUpBelow(k, threshold) => values[k][0].lt(F32::splat(l, threshold)),
    }
}
