//! Radiance textures: each pixel is a vertex of an object, drawn as a point, and holds
//! the light that it reflects at albedo 1.
//!
//! The paper takes inner products in the pixel shader, with the coefficients of transport
//! as attributes of the point. A point has room for 16 varyings here and 36 attributes,
//! so [`VertexRadiance`] takes them in the vertex shader: one invocation a vertex too.

use gnomon_raster::math::dot3;
use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, Interpolation, Vertex, VertexShader,
};
use gnomon_raster::simd::{each3, each4};
use gnomon_raster::{F32, I32, Lanes, uniforms};

use crate::bounded::bounded_uniforms;
use crate::soft_volumes::texel_of;
use crate::transform::ClipFromWorld;
use crate::vector::V3;

/// Attributes: place in the texture (x, y), a number to be passed on, then coefficients.
/// Varyings, flat: the inner product of the coefficients with `light`, by colour, and
/// the number.
///
/// With transport as coefficients and light's as `light` it is a vertex's radiance
/// (equation 2); with visibility and a row of light's matrix a coefficient of glossy
/// transport (equation 12).
#[derive(Clone, Debug, PartialEq)]
pub struct VertexRadiance {
    /// Red, green and blue of each coefficient.
    pub light: Vec<[f32; 3]>,
}
uniforms!(VertexRadiance { light });

/// Attributes before the coefficients.
const BEFORE: usize = 3;

impl VertexShader for VertexRadiance {
    fn varyings(&self) -> &[Interpolation] {
        &[Interpolation::Flat; 4]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let mut sum = [F32::splat(l, 0.0); 3];
        for (k, light) in self.light.iter().enumerate() {
            let coefficient = v.attribute(BEFORE + k);
            sum = each3(
                #[inline(always)]
                |c| sum[c] + coefficient * light[c],
            );
        }
        for (c, sum) in sum.into_iter().enumerate() {
            v.set_varying(c, sum);
        }
        v.set_varying(3, v.attribute(2));
        place(l, v);
    }
}

/// At the first two attributes.
#[inline(always)]
fn place<L: Lanes>(l: L, v: &mut Vertex<'_, L>) {
    let (x, y) = (v.attribute(0), v.attribute(1));
    v.set_position([x, y, F32::splat(l, 0.0), F32::splat(l, 1.0)]);
}

/// The first four varyings as a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried;
uniforms!(Carried);

impl FragmentShader for Carried {
    #[inline(always)]
    fn shade<L: Lanes>(&self, _: L, f: &mut Fragment<'_, L>) {
        let color = each4(
            #[inline(always)]
            |c| f.varying(c),
        );
        f.set_color(0, color);
    }
}

/// Attributes: place in the texture, position and normal. Varyings, flat: the unit vector
/// from the eye mirrored at the normal, in the axes of `turn`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflections {
    /// Relative to the origin of positions.
    pub eye: [f32; 3],
    /// Rows of the rotation to the object's own axes.
    pub turn: [[f32; 3]; 3],
}
uniforms!(Reflections { eye, turn });

impl VertexShader for Reflections {
    fn varyings(&self) -> &[Interpolation] {
        &[Interpolation::Flat; 3]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let position = V3(each3(
            #[inline(always)]
            |i| v.attribute(2 + i),
        ));
        let normal = V3(each3(
            #[inline(always)]
            |i| v.attribute(5 + i),
        ));
        let [x, y, z] = self.eye;
        let to_eye = position.towards([x, y, z, 1.0]);
        let twice = normal.dot(to_eye) * 2.0;
        let mirrored = V3(each3(
            #[inline(always)]
            |i| normal.0[i] * twice - to_eye.0[i],
        ));
        let squared = mirrored.dot(mirrored);
        let length = squared.max(F32::splat(l, f32::MIN_POSITIVE)).sqrt();
        for (i, row) in self.turn.iter().enumerate() {
            let row = each3(
                #[inline(always)]
                |k| F32::splat(l, row[k]),
            );
            v.set_varying(i, dot3(row, mirrored.0) / length);
        }
        place(l, v);
    }
}

/// Bands of which [`GlossyRadiance`] knows the harmonics.
pub const GLOSSY_BANDS: u32 = 4;

/// Light towards the eye of a glossy vertex (equation 13): the harmonics at the vector
/// in varyings 0..3 times the coefficients in texture 0, where coefficient k of the
/// fragment's vertex is `k · rows` below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlossyRadiance {
    /// At most [`GLOSSY_BANDS`].
    pub bands: u32,
    /// Rows of the target.
    pub rows: u32,
}
bounded_uniforms!(GlossyRadiance { bands, rows }: |it| [
    ("bands", it.bands.into(), GLOSSY_BANDS.into()),
    ("rows", it.rows.into(), 8192),
]);

impl FragmentShader for GlossyRadiance {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let direction = each3(
            #[inline(always)]
            |i| f.varying(i),
        );
        let harmonics = harmonics(l, direction);
        let count = (self.bands * self.bands) as usize;
        let mut sum = [F32::splat(l, 0.0); 4];
        for (k, y) in harmonics.into_iter().enumerate().take(count) {
            let row = f.row() + I32::splat(l, (k as u32 * self.rows) as i32);
            let texel = texel_of(l, f, 0, [f.column(), row, I32::splat(l, 0)]);
            sum = each4(
                #[inline(always)]
                |c| sum[c] + texel[c] * y,
            );
        }
        f.set_color(0, sum);
    }
}

/// The real spherical harmonics of four bands at a unit vector.
#[inline(always)]
fn harmonics<L: Lanes>(l: L, [x, y, z]: [F32<L>; 3]) -> [F32<L>; 16] {
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let around = (zz * 5.0 - 1.0) * 0.457_045_8;
    [
        F32::splat(l, 0.282_094_8),
        y * 0.488_602_52,
        z * 0.488_602_52,
        x * 0.488_602_52,
        x * y * 1.092_548_5,
        y * z * 1.092_548_5,
        (zz * 3.0 - 1.0) * 0.315_391_57,
        x * z * 1.092_548_5,
        (xx - yy) * 0.546_274_24,
        y * (xx * 3.0 - yy) * 0.590_043_6,
        x * y * z * 2.890_611_4,
        y * around,
        z * (zz * 5.0 - 3.0) * 0.373_176_34,
        x * around,
        z * (xx - yy) * 1.445_305_7,
        x * (xx - yy * 3.0) * 0.590_043_6,
    ]
}

/// Attributes: position, share of the first and of the second corner, numbers of the
/// triangle's vertices. Varyings: the shares, and the numbers, flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corners(pub ClipFromWorld);
uniforms!(Corners(clip_from_world));

impl VertexShader for Corners {
    fn varyings(&self) -> &[Interpolation] {
        const P: Interpolation = Interpolation::Perspective;
        const F: Interpolation = Interpolation::Flat;
        &[P, P, F, F, F]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        for i in 0..5 {
            v.set_varying(i, v.attribute(3 + i));
        }
        let [x, y, z] = [v.attribute(0), v.attribute(1), v.attribute(2)];
        v.set_position(self.0.apply([x, y, z, F32::splat(l, 1.0)]));
    }
}

/// Radiance of surfaces from that of vertices: texture 0, and where `glossy` texture 1,
/// interpolated over the triangle into attachments 0 and 1. Varyings are those of
/// [`Corners`].
///
/// The paper reads radiance textures in the vertex shader. Vertex shaders read no
/// textures here, so a fragment reads the three texels that it lies between: the same
/// values, three fetches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceRadiance {
    /// Texels along a row of the textures, a power of two.
    pub width: u32,
    /// Whether there is a second texture.
    pub glossy: bool,
}
uniforms!(SurfaceRadiance { width, glossy });

impl FragmentShader for SurfaceRadiance {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: if self.glossy { 2 } else { 1 },
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (a, b) = (f.varying(0), f.varying(1));
        let shares = [a, b, F32::splat(l, 1.0) - a - b];
        for slot in 0..if self.glossy { 2 } else { 1 } {
            let mut sum = [F32::splat(l, 0.0); 4];
            for (corner, share) in shares.into_iter().enumerate() {
                let number = f.varying(2 + corner);
                let row = (number * (1.0 / self.width as f32)).floor();
                let column = number - row * self.width as f32;
                let at = [column.to_i32(), row.to_i32(), I32::splat(l, 0)];
                let texel = texel_of(l, f, slot, at);
                sum = each4(
                    #[inline(always)]
                    |c| sum[c] + texel[c] * share,
                );
            }
            f.set_color(slot, sum);
        }
    }
}
