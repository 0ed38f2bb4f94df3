//! Vertex shading and projection, 16 vertices at a time.

use super::{GeometryState, clip};
use crate::error::Error;
use crate::memory::reserve;
use crate::shader::{ErasedVertexShader, VertexBatch, VertexOutput};
use crate::simd::{F32, F64, LANES, Lanes, SimdLevel, each4, with_lanes};

/// A projected vertex: snapped 24.8 coordinates as exact integers in floats.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(16))]
pub(crate) struct ScreenVertex {
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    pub(crate) inv_w: f32,
}

/// Bits of a vertex's clip code beyond the [`clip::PLANES`] distances.
pub(super) const VIEW_SHIFT: u32 = clip::PLANES as u32;
/// x > w, x < −w, y > w, y < −w.
pub(super) const VIEW_MASK: u16 = 0xf << VIEW_SHIFT;
pub(super) const W_NOT_POSITIVE: u16 = 1 << 11;
pub(super) const NON_FINITE: u16 = 1 << 12;
/// z > w.
pub(super) const BEYOND_FAR: u16 = 1 << 13;
pub(super) const PLANE_MASK: u16 = (1 << clip::PLANES) - 1;

/// Shaded vertices of one draw and instance, or a part of them.
#[derive(Debug, Default)]
pub(crate) struct ShadedVertices {
    /// Clip-space position, one array a component.
    pub(super) clip: [Vec<f32>; 4],
    /// Varying-major, `padded` values each.
    pub(super) varyings: Vec<f32>,
    pub(super) screen: Vec<ScreenVertex>,
    pub(super) codes: Vec<u16>,
    pub(super) padded: usize,
}

impl ShadedVertices {
    pub(crate) fn varying(&self, i: usize, vertex: u32) -> f32 {
        self.varyings[i * self.padded + vertex as usize]
    }

    pub(crate) fn screen(&self, vertex: u32) -> ScreenVertex {
        self.screen[vertex as usize]
    }

    pub(crate) fn clip_position(&self, vertex: u32) -> [f32; 4] {
        core::array::from_fn(|c| self.clip[c][vertex as usize])
    }

    /// Empties it and keeps its memory.
    pub(crate) fn clear(&mut self) {
        self.clip.iter_mut().for_each(Vec::clear);
        self.varyings.clear();
        self.screen.clear();
        self.codes.clear();
        self.padded = 0;
    }

    /// Room for `n` vertices of draw `draw`, rounded up to whole packets.
    pub(crate) fn resize(&mut self, n: usize, varyings: usize, draw: &str) -> Result<(), Error> {
        let padded = n.next_multiple_of(LANES);
        let what = || format!("draw `{draw}`: its {n} shaded vertices");
        for c in &mut self.clip {
            resize(c, padded, 0.0, what)?;
        }
        resize(&mut self.varyings, padded * varyings, 0.0, what)?;
        resize(&mut self.screen, padded, ScreenVertex::default(), what)?;
        resize(&mut self.codes, padded, 0, what)?;
        self.padded = padded;
        Ok(())
    }

    /// Appends a vertex that clipping or widening made.
    pub(super) fn push(
        &mut self,
        position: [f32; 4],
        varyings: &[f32],
        screen: ScreenVertex,
    ) -> u32 {
        for (c, p) in self.clip.iter_mut().zip(position) {
            c.push(p);
        }
        // Made vertices are few: each keeps its varyings together (`padded` is 1 then).
        self.varyings.extend_from_slice(varyings);
        self.screen.push(screen);
        self.screen.len() as u32 - 1
    }
}

fn resize<T: Clone>(
    v: &mut Vec<T>,
    n: usize,
    value: T,
    what: impl FnOnce() -> String,
) -> Result<(), Error> {
    reserve(v, n.saturating_sub(v.len()), what)?;
    v.resize(n, value);
    Ok(())
}

/// A run of vertices of a [`ShadedVertices`], for one worker to fill.
pub(crate) struct ShadedPart<'a> {
    clip: [&'a mut [f32]; 4],
    varyings: Vec<&'a mut [f32]>,
    screen: &'a mut [ScreenVertex],
    codes: &'a mut [u16],
}

impl ShadedVertices {
    /// Splits into runs of `n` vertices (whole packets).
    pub(crate) fn parts(&mut self, n: usize) -> Vec<ShadedPart<'_>> {
        let [x, y, z, w] = &mut self.clip;
        let mut columns: Vec<_> = self
            .varyings
            .chunks_mut(self.padded.max(1))
            .map(|v| v.chunks_mut(n))
            .collect();
        let clip = x
            .chunks_mut(n)
            .zip(y.chunks_mut(n))
            .zip(z.chunks_mut(n).zip(w.chunks_mut(n)));
        clip.zip(self.screen.chunks_mut(n).zip(self.codes.chunks_mut(n)))
            .map(|(((x, y), (z, w)), (screen, codes))| ShadedPart {
                clip: [x, y, z, w],
                varyings: columns.iter_mut().filter_map(Iterator::next).collect(),
                screen,
                codes,
            })
            .collect()
    }
}

/// Shades `batch` into `out`, which has room for it.
pub(crate) fn shade_part(
    level: SimdLevel,
    shader: &dyn ErasedVertexShader,
    state: &GeometryState,
    batch: &VertexBatch<'_>,
    out: &mut ShadedPart<'_>,
) {
    let mut slots = VertexOutput {
        position: out.clip.each_mut().map(|c| &mut **c),
        varyings: &mut out.varyings,
    };
    shader.shade_batch(level, batch, &mut slots);
    with_lanes!(level, l => project(l, state, out));
}

#[inline(always)]
fn project<L: Lanes>(l: L, state: &GeometryState, out: &mut ShadedPart<'_>) {
    for at in (0..out.codes.len()).step_by(LANES) {
        let p: [F32<L>; 4] = each4(
            #[inline(always)]
            |c| {
                F32::from_array(
                    l,
                    out.clip[c][at..at + LANES]
                        .try_into()
                        .expect("whole packet"),
                )
            },
        );
        let codes = clip_codes(l, state, &p);
        out.codes[at..at + LANES].copy_from_slice(&codes);
        let screen = &mut out.screen[at..at + LANES];
        to_screen(l, state, &p, screen.try_into().expect("whole packet"));
    }
}

/// Rules §2: which distances are negative, which sides of the view volume a
/// vertex lies beyond, and whether it is usable at all.
#[inline(always)]
fn clip_codes<L: Lanes>(l: L, state: &GeometryState, p: &[F32<L>; 4]) -> [u16; LANES] {
    let [x, y, z, w] = *p;
    let zero = F32::splat(l, 0.0);
    // Infinity and NaN times 0 are NaN.
    let all_finite =
        (x * 0.0).eq(zero) & (y * 0.0).eq(zero) & (z * 0.0).eq(zero) & (w * 0.0).eq(zero);
    let outside = [x.gt(w), x.lt(-w), y.gt(w), y.lt(-w)];
    let w_bad = w.le(zero);

    let guard = state.viewport.guard.map(f64::from);
    let [xd, yd, zd, wd] = each4(
        #[inline(always)]
        |c| F64::from_f32(p[c]),
    );
    let near = if state.depth_clamp {
        zd + wd * clip::DEPTH_GUARD
    } else {
        zd
    };
    let distances = [
        wd - f64::from(clip::W_MIN),
        near,
        wd * clip::DEPTH_GUARD - zd,
        wd * guard[0] - xd,
        wd * guard[1] + xd,
        wd * guard[2] + yd,
        wd * guard[3] - yd,
    ];
    let zero = F64::splat(l, 0.0);
    let mut bits = [0u16; 14];
    for (b, d) in bits.iter_mut().zip(distances) {
        *b = d.lt(zero).bits();
    }
    for (b, o) in bits[clip::PLANES..].iter_mut().zip(outside) {
        *b = o.bits();
    }
    bits[11] = w_bad.bits();
    bits[12] = !all_finite.bits();
    bits[13] = z.gt(w).bits();
    transpose(&bits)
}

/// Bit `k` of `codes[lane]` = bit `lane` of `bits[k]`.
#[inline(always)]
fn transpose(bits: &[u16; 14]) -> [u16; LANES] {
    if bits.iter().all(|&b| b == 0) {
        return [0; LANES];
    }
    core::array::from_fn(|lane| {
        bits.iter()
            .enumerate()
            .fold(0, |c, (k, b)| c | (b >> lane & 1) << k)
    })
}

/// Rules §3.1, §3.2.
#[inline(always)]
fn to_screen<L: Lanes>(
    l: L,
    state: &GeometryState,
    p: &[F32<L>; 4],
    out: &mut [ScreenVertex; LANES],
) {
    let v = &state.viewport;
    let [x, y, z, w] = *p;
    let sx = F32::splat(l, v.center[0]) + (x / w) * v.half[0];
    let sy = F32::splat(l, v.center[1]) - (y / w) * v.half[1];
    let sz = (z / w) * v.depth_scale + v.depth_offset;
    let (sx, sy) = (
        (sx * 256.0).round_ties_even().to_array(),
        (sy * 256.0).round_ties_even().to_array(),
    );
    let (sz, iw) = (sz.to_array(), w.recip().to_array());
    for i in 0..LANES {
        out[i] = ScreenVertex {
            x: sx[i],
            y: sy[i],
            z: sz[i],
            inv_w: iw[i],
        };
    }
}

/// The same for one vertex that clipping made.
pub(super) fn project_one(state: &GeometryState, p: &[f32; 4]) -> ScreenVertex {
    let v = &state.viewport;
    let [x, y, z, w] = *p;
    ScreenVertex {
        x: ((v.center[0] + (x / w) * v.half[0]) * 256.0).round_ties_even(),
        y: ((v.center[1] - (y / w) * v.half[1]) * 256.0).round_ties_even(),
        z: (z / w) * v.depth_scale + v.depth_offset,
        inv_w: 1.0 / w,
    }
}
