//! Fragment shaders of surfaces, in the passes of the papers: ambient light
//! once, then diffuse and specular light added per light source.
//!
//! Output is linear light in attachment 0. [`Lambert`] and [`Phong`] read the
//! varyings of [`crate::transform::Surfaces`]. A surface seen from behind is
//! shaded with its normal turned round. [`Shadowed`] dims either by a visibility
//! that an earlier pass left in a texture; [`AmbientWithPosition`] leaves the
//! positions that such a pass works with.

use gnomon_raster::math::{dot3, length};
use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::{each3, each4};
use gnomon_raster::{F32, I32, Lanes, uniforms};

use crate::vector::V3;

/// One colour everywhere: the ambient pass, or unlit geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub [f32; 4]);
uniforms!(Constant(color));

impl FragmentShader for Constant {
    fn constant(&self) -> Option<[f32; 4]> {
        Some(self.0)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let color = each4(
            #[inline(always)]
            |c| F32::splat(l, self.0[c]),
        );
        f.set_color(0, color);
    }
}

/// Directions of rays through pixels: `first + x · right + y · down` at (x, y)
/// pixels from the top left corner; not normalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelRays {
    /// Where rays start, relative to the origin of positions.
    pub eye: [f32; 3],
    /// Direction through the top left corner of the image.
    pub first: [f32; 3],
    /// Change to the next column.
    pub right: [f32; 3],
    /// Change to the next row.
    pub down: [f32; 3],
}
uniforms!(PixelRays {
    eye,
    first,
    right,
    down
});

/// Ambient light in attachment 0, and in attachment 1 the world-space position,
/// with w 1 where shadow may fall and 0 where it may not. Varyings are those of
/// [`crate::transform::Facets`].
///
/// Vertices are snapped to 1/256 pixel, and interpolated positions with them; at
/// penumbrae of a few pixels that is visible in the last digits. So the position
/// is where the pixel's ray meets the facet's plane, and the interpolated one only
/// where the facet is seen edge on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientWithPosition {
    /// The colour.
    pub ambient: [f32; 4],
    /// Whether shadow falls on the surface.
    pub receives: bool,
    /// Whether the facet's plane, unit normal and distance from the eye, is written to
    /// attachment 2.
    pub plane: bool,
    /// The camera.
    pub rays: PixelRays,
}
uniforms!(AmbientWithPosition {
    ambient,
    receives,
    plane,
    rays
});

/// Cosine between ray and facet, below which positions are interpolated.
const EDGE_ON: f32 = 1e-3;

impl FragmentShader for AmbientWithPosition {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        Constant(self.ambient).shade(l, f);
        let (normal, [px, py, pz]) = seen_position(&self.rays, f);
        let w = if self.receives { 1.0 } else { 0.0 };
        f.set_color(1, [px, py, pz, F32::splat(l, w)]);
        if self.plane {
            let [x, y, z] = normal;
            let distance = f.varying(6);
            f.set_color(2, [x, y, z, distance]);
        }
    }
}

/// Ambient light that leans to one side: `max(even + slope · n, 0)` for each colour, n
/// the unit normal towards the eye's side, alpha 0. Varyings are those of
/// [`crate::transform::Surfaces`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeaningAmbient {
    /// Light on a surface that faces neither to nor from where it comes.
    pub even: [f32; 3],
    /// What is added to red per unit of the normal.
    pub red: [f32; 3],
    /// Likewise to green.
    pub green: [f32; 3],
    /// Likewise to blue.
    pub blue: [f32; 3],
}
uniforms!(LeaningAmbient {
    even,
    red,
    green,
    blue
});

impl LeaningAmbient {
    #[inline(always)]
    pub(crate) fn light<L: Lanes>(&self, l: L, f: &Fragment<'_, L>) -> [F32<L>; 3] {
        let (normal, _) = inputs(f);
        let least = F32::splat(l, f32::MIN_POSITIVE);
        let scale = F32::splat(l, facing(f)) / normal.dot(normal).max(least).sqrt();
        let slopes = [self.red, self.green, self.blue];
        each3(
            #[inline(always)]
            |c| {
                let [x, y, z] = slopes[c];
                let [nx, ny, nz] = normal.0;
                let lean = (nx * x + ny * y + nz * z) * scale;
                (lean + F32::splat(l, self.even[c])).max(F32::splat(l, 0.0))
            },
        )
    }
}

impl FragmentShader for LeaningAmbient {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [r, g, b] = self.light(l, f);
        f.set_color(0, [r, g, b, F32::splat(l, 0.0)]);
    }
}

/// The facet's normal, and where the pixel's ray meets it.
#[inline(always)]
fn seen_position<L: Lanes>(rays: &PixelRays, f: &Fragment<'_, L>) -> ([F32<L>; 3], [F32<L>; 3]) {
    let (x, y) = (f.x(), f.y());
    let direction = each3(
        #[inline(always)]
        |i| (x * rays.right[i] + y * rays.down[i]) + rays.first[i],
    );
    let normal = each3(
        #[inline(always)]
        |i| f.varying(3 + i),
    );
    let slope = dot3(normal, direction);
    let steep = slope.abs().gt(length(direction) * EDGE_ON);
    let distance = f.varying(6) / slope;
    let position = each3(
        #[inline(always)]
        |i| steep.select_f32(direction[i] * distance + rays.eye[i], f.varying(i)),
    );
    (normal, position)
}

/// As [`AmbientWithPosition`], with the number of the facet, the last varying of
/// [`crate::transform::NumberedFacets`], for w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientWithNumber {
    /// The colour.
    pub ambient: [f32; 4],
    /// The camera.
    pub rays: PixelRays,
}
uniforms!(AmbientWithNumber { ambient, rays });

impl FragmentShader for AmbientWithNumber {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        Constant(self.ambient).shade(l, f);
        let (_, [x, y, z]) = seen_position(&self.rays, f);
        f.set_color(1, [x, y, z, f.varying(7)]);
    }
}

/// The first flat varying of [`crate::transform::Facets`] in all channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetValue;
uniforms!(FacetValue);

impl FragmentShader for FacetValue {
    #[inline(always)]
    fn shade<L: Lanes>(&self, _: L, f: &mut Fragment<'_, L>) {
        let value = f.varying(3);
        f.set_color(0, [value; 4]);
    }
}

/// Diffuse and specular light of a surface, linear RGB.
pub trait Reflection: Send + Sync {
    /// How many textures it reads, behind those of whoever dims it.
    fn textures(&self) -> usize {
        0
    }

    /// The light towards the eye, all of the light source being visible.
    fn light<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) -> [F32<L>; 3];
}

/// A surface dimmed by the visibility of the light: texture 0 at the fragment's
/// own pixel, `texel · scale + offset` limited to 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadowed<S> {
    /// The surface.
    pub surface: S,
    /// Factor of the texel.
    pub scale: f32,
    /// Added to the product.
    pub offset: f32,
    /// Visibility of each colour by itself; else red's for all.
    pub coloured: bool,
}
uniforms!(Shadowed<S> { surface, scale, offset, coloured });

impl<S: Reflection> FragmentShader for Shadowed<S> {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1 + self.surface.textures(),
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let at = [f.column(), f.row(), I32::splat(l, 0)];
        let texel = f.fetch_texel(0, at, 0);
        let light = self.surface.light(l, f);
        let [r, g, b] = each3(
            #[inline(always)]
            |i| {
                let visible = texel[if self.coloured { i } else { 0 }];
                light[i] * (visible * self.scale + self.offset).clamp(0.0, 1.0)
            },
        );
        f.set_color(0, [r, g, b, F32::splat(l, 0.0)]);
    }
}

/// The same by a visibility in two bytes: red the high one, green the low one, which
/// together are a whole number, times `scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowedByBytes<S> {
    /// The surface.
    pub surface: S,
    /// Visibility of one step.
    pub scale: f32,
}
uniforms!(ShadowedByBytes<S> { surface, scale });

impl<S: Reflection> FragmentShader for ShadowedByBytes<S> {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1 + self.surface.textures(),
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let at = [f.column(), f.row(), I32::splat(l, 0)];
        let [high, low, _, _] = f.fetch_texel(0, at, 0);
        let visible = (two_bytes(high, low) * self.scale).clamp(0.0, 1.0);
        let light = self.surface.light(l, f);
        let [r, g, b] = each3(
            #[inline(always)]
            |i| light[i] * visible,
        );
        f.set_color(0, [r, g, b, F32::splat(l, 0.0)]);
    }
}

/// The whole number of two 8-bit unorm channels.
#[inline(always)]
pub(crate) fn two_bytes<L: Lanes>(high: F32<L>, low: F32<L>) -> F32<L> {
    (high * 255.0).round_ties_even() * 256.0 + (low * 255.0).round_ties_even()
}

/// Diffuse light: `diffuse · max(n·l, 0)`, alpha 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    /// Albedo times the light's colour.
    pub diffuse: [f32; 3],
    /// The light: `(position, 1)` or `(direction towards it, 0)`, world space.
    pub light: [f32; 4],
}
uniforms!(Lambert { diffuse, light });

impl Reflection for Lambert {
    #[inline(always)]
    fn light<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) -> [F32<L>; 3] {
        let (normal, position) = inputs(f);
        let to_light = position.towards(self.light);
        let cosine = cosine(normal, to_light, facing(f)).max(F32::splat(l, 0.0));
        each3(
            #[inline(always)]
            |i| cosine * self.diffuse[i],
        )
    }
}

impl FragmentShader for Lambert {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [r, g, b] = self.light(l, f);
        f.set_color(0, [r, g, b, F32::splat(l, 0.0)]);
    }
}

/// Diffuse and specular light after Phong:
/// `diffuse · n·l + specular · max(r·v, 0)^shininess` where `n·l > 0`, r being l
/// mirrored at n; alpha 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// The diffuse part.
    pub lambert: Lambert,
    /// Specular reflectance times the light's colour.
    pub specular: [f32; 3],
    /// The exponent, limited to 0..=[`MAX_SHININESS`].
    pub shininess: f32,
    /// The eye in world space.
    pub eye: [f32; 3],
}
uniforms!(Phong {
    lambert,
    specular,
    shininess,
    eye
});

impl Phong {
    /// Factors of diffuse and of specular light.
    #[inline(always)]
    pub(crate) fn shares<L: Lanes>(&self, l: L, f: &Fragment<'_, L>) -> (F32<L>, F32<L>) {
        let (normal, position) = inputs(f);
        let [x, y, z] = self.eye;
        let (to_light, to_eye) = (
            position.towards(self.lambert.light),
            position.towards([x, y, z, 1.0]),
        );
        let n_l = cosine(normal, to_light, facing(f));
        let n_v = cosine(normal, to_eye, facing(f));
        let l_v = cosine(to_light, to_eye, 1.0);
        let zero = F32::splat(l, 0.0);
        let diffuse = n_l.max(zero);
        let mirrored = (n_l * 2.0 * n_v - l_v).clamp(0.0, 1.0);
        let highlight = n_l
            .gt(zero)
            .select_f32(power(mirrored, self.shininess), zero);
        (diffuse, highlight)
    }
}

impl Reflection for Phong {
    #[inline(always)]
    fn light<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) -> [F32<L>; 3] {
        let (diffuse, highlight) = self.shares(l, f);
        each3(
            #[inline(always)]
            |i| diffuse * self.lambert.diffuse[i] + highlight * self.specular[i],
        )
    }
}

impl FragmentShader for Phong {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [r, g, b] = self.light(l, f);
        f.set_color(0, [r, g, b, F32::splat(l, 0.0)]);
    }
}

/// Largest exponent of [`power`].
pub const MAX_SHININESS: f32 = 4096.0;

/// Normal and world-space position.
#[inline(always)]
fn inputs<L: Lanes>(f: &Fragment<'_, L>) -> (V3<L>, V3<L>) {
    let normal = V3([f.varying(0), f.varying(1), f.varying(2)]);
    (normal, V3([f.varying(3), f.varying(4), f.varying(5)]))
}

#[inline(always)]
fn facing<L: Lanes>(f: &Fragment<'_, L>) -> f32 {
    if f.front_facing() { 1.0 } else { -1.0 }
}

/// `sign` times the cosine of the angle between two vectors of any length; 0
/// where one of them has none.
#[inline(always)]
fn cosine<L: Lanes>(a: V3<L>, b: V3<L>, sign: f32) -> F32<L> {
    let squared = a.dot(a) * b.dot(b);
    let length = squared
        .max(F32::splat(squared.lanes(), f32::MIN_POSITIVE))
        .sqrt();
    a.dot(b) * sign / length
}

/// `x^exponent` for x in 0..=1 by repeated squaring, linear between whole
/// exponents: only products, so the same bits everywhere.
#[inline(always)]
pub fn power<L: Lanes>(x: F32<L>, exponent: f32) -> F32<L> {
    let limited = if exponent > 0.0 { exponent } else { 0.0 };
    let limited = if limited < MAX_SHININESS {
        limited
    } else {
        MAX_SHININESS
    };
    let whole = limited as u32;
    let mut result = F32::splat(x.lanes(), 1.0);
    let mut square = x;
    let mut left = whole;
    while left != 0 {
        if left & 1 != 0 {
            result = result * square;
        }
        square = square * square;
        left >>= 1;
    }
    let part = limited - whole as f32;
    if part == 0.0 {
        return result;
    }
    result * (x * part + (1.0 - part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gnomon_raster::shader::{ScalarVertexOutput, per_vertex};
    use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
    use gnomon_raster::{
        ColorAttachment, CommandList, Draw, Format, Gpu, GpuConfig, LoadOp, RenderPass,
        RenderPipeline, StoreOp, Subresource, TextureDescriptor,
    };
    use std::sync::Arc;

    /// Exponents in the four channels.
    struct Powers(f32, [f32; 4]);

    impl FragmentShader for Powers {
        #[inline(always)]
        fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
            let color = each4(
                #[inline(always)]
                |c| power(F32::splat(l, self.0), self.1[c]),
            );
            f.set_color(0, color);
        }
    }

    fn powers(x: f32, exponents: [f32; 4]) -> [f32; 4] {
        let corners = [[-1.0, 3.0], [-1.0, -1.0], [3.0, -1.0]];
        let pipeline = Arc::new(RenderPipeline {
            label: "powers".into(),
            vertex: per_vertex(&[], move |v| {
                let [x, y] = corners[v.vertex_index as usize];
                ScalarVertexOutput {
                    position: [x, y, 0.5, 1.0],
                    ..Default::default()
                }
            }),
            fragment: Some(Powers(x, exponents).into()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        });
        let mut gpu = Gpu::new(GpuConfig {
            threads: 1,
            ..GpuConfig::default()
        })
        .unwrap();
        let texture = gpu
            .create_texture(&TextureDescriptor::d2("out", Format::Rgba32Float, 1, 1))
            .unwrap();
        let subresource = Subresource::default();
        let color = vec![ColorAttachment {
            texture,
            subresource,
            load: LoadOp::DontCare,
            store: StoreOp::Store,
        }];
        let draws = vec![Draw::vertices_only("powers", &pipeline, 3)];
        let pass = RenderPass {
            label: "powers".into(),
            color,
            depth_stencil: None,
            draws,
        };
        gpu.submit(&CommandList { passes: vec![pass] }).unwrap();
        gpu.texture(texture)
            .unwrap()
            .read_color(subresource)
            .unwrap()[0]
            .0
    }

    #[test]
    fn power_follows_the_exponent() {
        assert_eq!(
            powers(0.5, [3.0, 0.0, f32::NAN, 10.0]),
            [0.125, 1.0, 1.0, 1.0 / 1024.0]
        );
        assert_eq!(powers(1.0, [77.5, 1e9, -3.0, 1.0]), [1.0; 4]);
        let [a, b, c, _] = powers(0.9, [30.0, 30.5, 31.0, 0.0]);
        assert!(a > b && b > c);
    }
}
