//! What is left of an object's light after other objects took theirs.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, Lanes, uniforms};

use crate::soft_volumes::own_texels;
use crate::textured::base_color;

/// Luminance of linear Rec. 709 RGB.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// `albedo · max(L_s - L_o, 0)` in attachment 0, of the images in textures 0 and 1, and
/// where the surface is glossy `specular · max(L'_s - L'_o, 0)` of textures 2 and 3
/// added. In attachment 1 the share of the environment's light that arrives: its
/// luminance over that of an open surface, which the first image has as alpha.
///
/// L_s is band-limited and L_o is not, so their difference can be below 0; pixels where
/// it was are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LessObscured {
    /// Diffuse reflectance.
    pub albedo: [f32; 3],
    /// Specular reflectance of a glossy surface.
    pub specular: Option<[f32; 3]>,
}
uniforms!(LessObscured { albedo, specular });

impl FragmentShader for LessObscured {
    fn outputs(&self) -> FragmentOutputs {
        outputs(self.images())
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let albedo = each3(
            #[inline(always)]
            |c| F32::splat(l, self.albedo[c]),
        );
        self.shade_with(l, f, albedo);
    }
}

/// [`LessObscured`] with a base colour from the texture behind the images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturedLessObscured {
    /// The surface; its albedo is multiplied.
    pub surface: LessObscured,
}
uniforms!(TexturedLessObscured { surface });

impl FragmentShader for TexturedLessObscured {
    fn outputs(&self) -> FragmentOutputs {
        outputs(self.surface.images() + 1)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let base = base_color(l, f, self.surface.images() as u32);
        let albedo = each3(
            #[inline(always)]
            |c| base[c] * self.surface.albedo[c],
        );
        self.surface.shade_with(l, f, albedo);
    }
}

fn outputs(textures: usize) -> FragmentOutputs {
    FragmentOutputs {
        textures,
        counts: &["negative-radiance"],
        ..FragmentOutputs::default()
    }
}

impl LessObscured {
    #[inline(always)]
    fn images(&self) -> usize {
        if self.specular.is_some() { 4 } else { 2 }
    }

    #[inline(always)]
    fn shade_with<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>, albedo: [F32<L>; 3]) {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let images: [_; 4] = own_texels(l, f, self.images());
        let diffuse = difference(&images, 0);
        let glossy = difference(&images, 2);
        let mut below = diffuse[0].lt(zero) | diffuse[1].lt(zero) | diffuse[2].lt(zero);
        let mut light = each3(
            #[inline(always)]
            |c| diffuse[c].max(zero) * albedo[c],
        );
        if let Some(specular) = self.specular {
            below = below | glossy[0].lt(zero) | glossy[1].lt(zero) | glossy[2].lt(zero);
            light = each3(
                #[inline(always)]
                |c| light[c] + glossy[c].max(zero) * specular[c],
            );
        }
        f.count(0, below);
        f.set_color(0, [light[0], light[1], light[2], zero]);
        let weigh = each3(
            #[inline(always)]
            |c| diffuse[c].max(zero) * LUMINANCE[c],
        );
        let open = images[0][3];
        let lit = open.gt(zero);
        let share = (weigh[0] + weigh[1] + weigh[2]) / lit.select_f32(open, one);
        let share = lit.select_f32(share.clamp(0.0, 1.0), one);
        f.set_color(1, [share, zero, zero, zero]);
    }
}

/// Red, green and blue of image `first` less those of the next.
#[inline(always)]
fn difference<L: Lanes>(images: &[[F32<L>; 4]; 4], first: usize) -> [F32<L>; 3] {
    each3(
        #[inline(always)]
        |c| images[first][c] - images[first + 1][c],
    )
}
