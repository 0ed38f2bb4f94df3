//! Surfaces whose base colour has a texture: what [`crate::surface`] does, with the
//! texel multiplied to the diffuse reflectance.
//!
//! The texture holds linear light. It is read once a fragment, filtered by its sampler,
//! with the level of detail of the quad.

use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, Interpolation, Vertex, VertexShader,
};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, Lanes, uniforms};

use crate::surface::{Lambert, LeaningAmbient, Phong, Reflection};
use crate::transform::{ClipFromWorld, Surfaces};

/// As [`Surfaces`], and two more attributes, the texture coordinates: varyings 6 and 7.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturedSurfaces(pub ClipFromWorld);
uniforms!(TexturedSurfaces(clip_from_world));

impl VertexShader for TexturedSurfaces {
    fn varyings(&self) -> &[Interpolation] {
        &[Interpolation::Perspective; 8]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        Surfaces(self.0).shade(l, v);
        v.set_varying(6, v.attribute(6));
        v.set_varying(7, v.attribute(7));
    }
}

/// The texture in `slot` where a fragment is: red, green and blue.
#[inline(always)]
pub(crate) fn base_color<L: Lanes>(l: L, f: &mut Fragment<'_, L>, slot: u32) -> [F32<L>; 3] {
    let at = [f.varying(6), f.varying(7), F32::splat(l, 0.0)];
    let [r, g, b, _] = f.sample(slot as usize, at);
    [r, g, b]
}

/// Ambient light times the base colour in texture 0, opaque. What is in `light` is
/// multiplied by the base colour's factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturedAmbient {
    /// Ambient light, even or leaning to one side.
    pub light: LeaningAmbient,
}
uniforms!(TexturedAmbient { light });

impl FragmentShader for TexturedAmbient {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let base = base_color(l, f, 0);
        let light = self.light.light(l, f);
        let [r, g, b] = each3(
            #[inline(always)]
            |c| light[c] * base[c],
        );
        f.set_color(0, [r, g, b, F32::splat(l, 1.0)]);
    }
}

/// [`Lambert`] with a base colour from a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturedLambert {
    /// The surface; its diffuse light is multiplied.
    pub lambert: Lambert,
    /// Slot of the texture.
    pub slot: u32,
}
uniforms!(TexturedLambert { lambert, slot });

impl Reflection for TexturedLambert {
    fn textures(&self) -> usize {
        1
    }

    #[inline(always)]
    fn light<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) -> [F32<L>; 3] {
        let base = base_color(l, f, self.slot);
        let diffuse = self.lambert.light(l, f);
        each3(
            #[inline(always)]
            |c| diffuse[c] * base[c],
        )
    }
}

/// [`Phong`] with a base colour from a texture; highlights keep their colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturedPhong {
    /// The surface; its diffuse light is multiplied.
    pub phong: Phong,
    /// Slot of the texture.
    pub slot: u32,
}
uniforms!(TexturedPhong { phong, slot });

impl Reflection for TexturedPhong {
    fn textures(&self) -> usize {
        1
    }

    #[inline(always)]
    fn light<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) -> [F32<L>; 3] {
        let base = base_color(l, f, self.slot);
        let (diffuse, highlight) = self.phong.shares(l, f);
        let (own, specular) = (self.phong.lambert.diffuse, self.phong.specular);
        each3(
            #[inline(always)]
            |c| diffuse * own[c] * base[c] + highlight * specular[c],
        )
    }
}

/// Shaders of reflections alone: the light in attachment 0, alpha 0.
macro_rules! unshadowed {
    ($($shader:ty),+) => {$(
        impl FragmentShader for $shader {
            fn outputs(&self) -> FragmentOutputs {
                FragmentOutputs {
                    textures: 1,
                    ..FragmentOutputs::default()
                }
            }

            #[inline(always)]
            fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
                let [r, g, b] = self.light(l, f);
                f.set_color(0, [r, g, b, F32::splat(l, 0.0)]);
            }
        }
    )+};
}

unshadowed!(TexturedLambert, TexturedPhong);
