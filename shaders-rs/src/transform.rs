//! Vertex shaders: from world to clip space.
//!
//! Scene geometry and shadow volumes go through the *same* expression tree,
//! [`ClipFromWorld`], with the same operands: a scene vertex is `(p, 1)` and so
//! is the volume's copy of it. Equal operands give equal bits, so a volume's
//! light cap lies exactly on the surface that cast it.

use gnomon_raster::shader::{Interpolation, Vertex, VertexShader};
use gnomon_raster::simd::{each3, each4};
use gnomon_raster::{F32, LANES, Lanes, uniforms};

/// Rows of the matrix; row r of the product is
/// `((m[r][0]·x + m[r][1]·y) + m[r][2]·z) + m[r][3]·w`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipFromWorld(pub [[f32; 4]; 4]);
uniforms!(ClipFromWorld(rows));

impl ClipFromWorld {
    /// Clip-space position of 16 vertices.
    #[inline(always)]
    pub fn apply<L: Lanes>(&self, [x, y, z, w]: [F32<L>; 4]) -> [F32<L>; 4] {
        each4(
            #[inline(always)]
            |r| {
                let m = self.0[r];
                ((x * m[0] + y * m[1]) + z * m[2]) + w * m[3]
            },
        )
    }
}

/// Attributes x, y, z; w is 1. No varyings. Further attributes are ignored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points(pub ClipFromWorld);
uniforms!(Points(clip_from_world));

impl VertexShader for Points {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let [x, y, z] = [v.attribute(0), v.attribute(1), v.attribute(2)];
        v.set_position(self.0.apply([x, y, z, F32::splat(l, 1.0)]));
    }
}

/// Attributes x, y, z, w: points and directions. No varyings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomogeneousPoints(pub ClipFromWorld);
uniforms!(HomogeneousPoints(clip_from_world));

impl VertexShader for HomogeneousPoints {
    #[inline(always)]
    fn shade<L: Lanes>(&self, _: L, v: &mut Vertex<'_, L>) {
        let position = each4(
            #[inline(always)]
            |i| v.attribute(i),
        );
        v.set_position(self.0.apply(position));
    }
}

/// Attributes x, y, z and a normal. Varyings for [`crate::surface`]: the normal
/// in 0..3, the world-space position in 3..6.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surfaces(pub ClipFromWorld);
uniforms!(Surfaces(clip_from_world));

impl VertexShader for Surfaces {
    fn varyings(&self) -> &[Interpolation] {
        &[Interpolation::Perspective; 6]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let position = each3(
            #[inline(always)]
            |i| v.attribute(i),
        );
        for i in 0..3 {
            v.set_varying(i, v.attribute(3 + i));
            v.set_varying(3 + i, position[i]);
        }
        let [x, y, z] = position;
        v.set_position(self.0.apply([x, y, z, F32::splat(l, 1.0)]));
    }
}

/// Attributes x, y, z and a facet's plane: unit normal and distance from the eye.
/// Varyings: position in 0..3, the plane in 3..7, flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets(pub ClipFromWorld);
uniforms!(Facets(clip_from_world));

impl VertexShader for Facets {
    fn varyings(&self) -> &[Interpolation] {
        const P: Interpolation = Interpolation::Perspective;
        const F: Interpolation = Interpolation::Flat;
        &[P, P, P, F, F, F, F]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        for i in 0..7 {
            let attribute = v.attribute(i);
            v.set_varying(i, attribute);
        }
        let [x, y, z] = [v.attribute(0), v.attribute(1), v.attribute(2)];
        v.set_position(self.0.apply([x, y, z, F32::splat(l, 1.0)]));
    }
}

/// As [`Facets`], and a number of the facet: attribute 7, varying 7, flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberedFacets(pub ClipFromWorld);
uniforms!(NumberedFacets(clip_from_world));

impl VertexShader for NumberedFacets {
    fn varyings(&self) -> &[Interpolation] {
        const P: Interpolation = Interpolation::Perspective;
        const F: Interpolation = Interpolation::Flat;
        &[P, P, P, F, F, F, F, F]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        Facets(self.0).shade(l, v);
        v.set_varying(7, v.attribute(7));
    }
}

/// Three vertices without data that cover the whole viewport at depth 0; no
/// varyings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullScreen;
uniforms!(FullScreen);

impl VertexShader for FullScreen {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let ids = v.vertex_index();
        let (mut x, mut y) = ([-1.0; LANES], [-1.0; LANES]);
        for (lane, id) in ids.into_iter().enumerate() {
            x[lane] = if id == 1 { 3.0 } else { -1.0 };
            y[lane] = if id == 2 { 3.0 } else { -1.0 };
        }
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        v.set_position([F32::from_array(l, &x), F32::from_array(l, &y), zero, one]);
    }
}
