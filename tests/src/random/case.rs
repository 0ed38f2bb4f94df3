//! Random images and passes.

use gnomon_raster::{Format, LoadOp, StoreOp};

use super::Random;
use super::draw::random_draw;
use super::texture;
use crate::twin::{ColorImage, ColorUse, DepthImage, DepthUse, TwinCase, TwinPass};

const COLOR: [Format; 9] = [
    Format::R8Unorm,
    Format::Rg8Unorm,
    Format::Rgba8Unorm,
    Format::R16Sint,
    Format::R16Float,
    Format::Rgba16Float,
    Format::R32Float,
    Format::Rgba32Float,
    Format::R32Uint,
];

/// The case of a seed.
#[must_use]
pub fn random_case(seed: u64) -> TwinCase {
    let mut case = without_textures(&mut Random::new(seed));
    // Numbers of their own, so that cases are what they were before there were textures.
    texture::add(&mut Random::new(seed ^ 0x7e87_07e5), &mut case);
    case
}

/// The case of random numbers.
#[must_use]
pub fn case_of(mut r: Random) -> TwinCase {
    let mut case = without_textures(&mut r);
    texture::add(&mut r, &mut case);
    case
}

fn without_textures(r: &mut Random) -> TwinCase {
    let size = random_size(r);
    let pixels = size[0] as usize * size[1] as usize;
    let depth = (!r.one_in(5)).then(|| depth_image(r, pixels));
    let images = if depth.is_none() {
        r.between(1, 4)
    } else {
        r.pick(&[0, 1, 1, 1, 2, 3, 4])
    };
    let color = (0..images).map(|_| color_image(r, pixels)).collect();
    let mut case = TwinCase {
        size,
        color,
        depth,
        textures: Vec::new(),
        passes: Vec::new(),
    };
    for _ in 0..r.pick(&[1, 1, 2, 3]) {
        let pass = random_pass(r, &case);
        case.passes.push(pass);
    }
    case
}

fn random_size(r: &mut Random) -> [u32; 2] {
    match r.below(8) {
        0 => r.pick(&[[1, 1], [1, 9], [8, 8], [16, 16], [7, 3]]),
        1 => r.pick(&[[64, 64], [64, 32], [128, 16], [128, 64]]),
        2 => [r.between(1, 150) as u32, r.between(1, 90) as u32],
        _ => [r.between(1, 48) as u32, r.between(1, 48) as u32],
    }
}

fn depth_image(r: &mut Random, pixels: usize) -> DepthImage {
    let format = r.pick(&[Format::Depth24Stencil8, Format::Depth32FloatStencil8]);
    let (level, noise) = (r.pick(&[0.0, 0.25, 0.5, 1.0]), r.one_in(3));
    let depth = (0..pixels)
        .map(|_| if noise { r.float(0.0, 1.0) } else { level })
        .collect();
    let stencil = (0..pixels)
        .map(|_| if noise { r.next() as u8 } else { 0 })
        .collect();
    DepthImage {
        format,
        depth,
        stencil,
    }
}

fn color_image(r: &mut Random, pixels: usize) -> ColorImage {
    let format = r.pick(&COLOR);
    let noise = r.one_in(2);
    let mut texel = || {
        if noise {
            noise_texel(r, format)
        } else {
            [0; 4]
        }
    };
    let texels = (0..pixels).map(|_| texel()).collect();
    ColorImage { format, texels }
}

/// Raw channels; no NaN among them.
pub(super) fn noise_texel(r: &mut Random, f: Format) -> [u32; 4] {
    let half = |r: &mut Random| r.below(0x3d00) | r.below(2) << 15;
    let single = |r: &mut Random| r.float(-0.5, 2.0).to_bits();
    let byte = |r: &mut Random| r.below(256);
    match f {
        Format::R8Unorm => [byte(r), 0, 0, 0],
        Format::Rg8Unorm => [byte(r), byte(r), 0, 0],
        Format::Rgba8Unorm => r.array(byte),
        Format::R16Sint => [r.below(65536), 0, 0, 0],
        Format::R16Float => [half(r), 0, 0, 0],
        Format::Rgba16Float => r.array(half),
        Format::R32Float => [single(r), 0, 0, 0],
        Format::Rgba32Float => r.array(single),
        _ => [r.next(), 0, 0, 0],
    }
}

fn random_pass(r: &mut Random, case: &TwinCase) -> TwinPass {
    let first = case.passes.is_empty();
    let mut color = Vec::new();
    for image in 0..case.color.len() {
        if first || !r.one_in(3) {
            color.push(ColorUse {
                image,
                load: color_load(r),
                store: store(r),
            });
        }
    }
    let depth =
        (case.depth.is_some() && (color.is_empty() || first || !r.one_in(4))).then(|| depth_use(r));
    if color.is_empty() && depth.is_none() {
        color.push(ColorUse {
            image: 0,
            load: LoadOp::Load,
            store: StoreOp::Store,
        });
    }
    let formats: Vec<_> = color.iter().map(|c| case.color[c.image].format).collect();
    let mut pass = TwinPass {
        color,
        depth,
        draws: Vec::new(),
    };
    for _ in 0..r.between(1, 5) {
        let earlier = case
            .passes
            .iter()
            .flat_map(|p| &p.draws)
            .chain(&pass.draws)
            .last();
        let draw = random_draw(r, case.size, &formats, pass.depth.is_some(), earlier);
        pass.draws.push(draw);
    }
    pass
}

fn store(r: &mut Random) -> StoreOp {
    if r.one_in(12) {
        StoreOp::Discard
    } else {
        StoreOp::Store
    }
}

fn color_load(r: &mut Random) -> LoadOp<[f32; 4]> {
    match r.below(6) {
        0 | 1 => LoadOp::Clear(r.array(|r| r.float(-0.2, 1.2))),
        2 => LoadOp::Clear([f32::NAN, 2.0, f32::NEG_INFINITY, -0.0]),
        3 => LoadOp::DontCare,
        _ => LoadOp::Load,
    }
}

fn depth_use(r: &mut Random) -> DepthUse {
    let depth_load = match r.below(4) {
        0 => LoadOp::Clear(r.pick(&[0.0, 0.5, 1.0, 1.0, f32::NAN, 2.0, -0.0])),
        1 => LoadOp::Clear(r.float(0.0, 1.0)),
        2 if r.one_in(3) => LoadOp::DontCare,
        _ => LoadOp::Load,
    };
    let stencil_load = match r.below(4) {
        0 | 1 => LoadOp::Clear(r.pick(&[0, 1, 254, 255])),
        2 if r.one_in(3) => LoadOp::DontCare,
        _ => LoadOp::Load,
    };
    DepthUse {
        depth_load,
        depth_store: store(r),
        stencil_load,
        stencil_store: store(r),
    }
}
