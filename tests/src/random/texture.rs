//! Random textures, and draws that read them.
//!
//! From a generator of their own, so that the rest of a case does not depend on
//! them.

use gnomon_raster::{AddressMode, FilterMode, Format, MAX_TEXTURES, Sampler, TextureDimension};

use super::Random;
use super::case::noise_texel;
use super::look_up;
use crate::twin::{TextureSource, TextureUse, TwinCase, TwinPass, TwinTexture};

/// Makes half of the cases read textures, in half of their draws.
pub(super) fn add(r: &mut Random, case: &mut TwinCase) {
    if r.one_in(2) {
        return;
    }
    case.textures = (0..r.between(1, 3)).map(|_| texture(r)).collect();
    for k in 0..case.passes.len() {
        let sources = sources(case, &case.passes[k]);
        for d in 0..case.passes[k].draws.len() {
            if r.one_in(2) {
                let draw = &mut case.passes[k].draws[d];
                let Some(program) = &mut draw.program else {
                    continue;
                };
                let slots = r.pick(&[1, 1, 2, 3, MAX_TEXTURES as i32]) as usize;
                draw.textures = (0..slots)
                    .map(|_| TextureUse {
                        source: r.pick(&sources),
                        sampler: sampler(r),
                    })
                    .collect();
                look_up::add(r, program, slots);
            }
        }
    }
}

/// What the draws of a pass may read: textures, and images that are not attached.
fn sources(case: &TwinCase, pass: &TwinPass) -> Vec<TextureSource> {
    let mut list: Vec<_> = (0..case.textures.len())
        .map(TextureSource::Texture)
        .collect();
    let attached = |i: &usize| pass.color.iter().any(|c| c.image == *i);
    list.extend(
        (0..case.color.len())
            .filter(|i| !attached(i))
            .map(TextureSource::Color),
    );
    if case.depth.is_some() && pass.depth.is_none() {
        list.push(TextureSource::Depth);
    }
    list
}

/// A sampler of any kind.
pub fn sampler(r: &mut Random) -> Sampler {
    const ADDRESS: [AddressMode; 4] = [
        AddressMode::ClampToEdge,
        AddressMode::ClampToBorder,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ];
    const FILTER: [FilterMode; 2] = [FilterMode::Nearest, FilterMode::Linear];
    let border = r.one_in(4);
    Sampler {
        address: r.array(|r| r.pick(&ADDRESS)),
        mag: r.pick(&FILTER),
        min: r.pick(&FILTER),
        mip: r.pick(&FILTER),
        lod: r.pick(&[[0.0, 1000.0], [0.0, 1000.0], [-3.0, 1.5], [0.75, 0.75]]),
        lod_bias: r.pick(&[0.0, 0.0, 0.7, -1.5]),
        border: if border {
            [f32::NAN, f32::INFINITY, -0.0, f32::NEG_INFINITY]
        } else {
            r.array(|r| r.float(-1.0, 2.0))
        },
    }
}

/// A texture of any format, shape and size up to 16, with any number of levels.
pub fn texture(r: &mut Random) -> TwinTexture {
    use TextureDimension::{Cube, D1, D2, D3};
    let format = r.pick(&Format::ALL);
    let dimension = if format.is_depth_stencil() {
        r.pick(&[D1, D2, D2, Cube])
    } else {
        r.pick(&[D1, D2, D2, D2, D3, Cube, Cube])
    };
    let mut size = r.array(|r| r.pick(&[1, 2, 3, 4, 7, 8, 13, 16]));
    match dimension {
        D1 => (size[1], size[2]) = (1, 1),
        D2 => size[2] = 1,
        Cube => size = [size[0], size[0], 1],
        D3 => size[2] = r.pick(&[1, 2, 3, 5]),
    }
    let mut texture = TwinTexture {
        format,
        dimension,
        size,
        images: Vec::new(),
    };
    let most = size.into_iter().max().unwrap_or(1).ilog2() as i32 + 1;
    let levels = if r.one_in(3) { 1 } else { r.between(1, most) };
    for level in 0..levels as usize {
        let [w, h, d] = texture.level_size(level);
        let layers = if dimension == Cube { 6 } else { d };
        let pixels = (w * h) as usize;
        let images = (0..layers).map(|_| texels(r, format, pixels)).collect();
        texture.images.push(images);
    }
    texture
}

/// Stored texels; sometimes any bits, NaN and infinities among them.
fn texels(r: &mut Random, format: Format, count: usize) -> Vec<[u32; 4]> {
    let wild = r.one_in(6);
    let mut one = || match format {
        Format::Depth24Stencil8 => [r.below(1 << 24), r.below(256), 0, 0],
        Format::Depth32FloatStencil8 => [r.float(0.0, 1.0).to_bits(), r.below(256), 0, 0],
        Format::R16Float if wild => [r.below(65536), 0, 0, 0],
        Format::Rgba16Float if wild => r.array(|r| r.below(65536)),
        Format::R32Float if wild => [r.next(), 0, 0, 0],
        Format::Rgba32Float if wild => r.array(Random::next),
        f => noise_texel(r, f),
    };
    (0..count).map(|_| one()).collect()
}
