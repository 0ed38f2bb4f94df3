//! Conversion and blending of every colour format at every SIMD level against the twin:
//! all operations and factors on hard operands, NaN, infinities, subnormals, ties and
//! values out of range among them. (`shader_outputs.rs` has colours that are not shaded.)

use gnomon_raster::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
    Viewport,
};
use gnomon_raster::{Format, GpuConfig, LoadOp, Sampler, SimdLevel, StoreOp, TextureDimension};
use gnomon_tests::compare::difference;
use gnomon_tests::gpu_run::run;
use gnomon_tests::parallel;
use gnomon_tests::random::{Random, Screen};
use gnomon_tests::twin::{
    ColorImage, ColorSource, ColorUse, LookUp, LookUpKind, Program, TexelAt, TextureSource,
    TextureUse, TwinCase, TwinDraw, TwinPass, TwinTexture, render,
};

const SIZE: u32 = 16;
const PIXELS: usize = (SIZE * SIZE) as usize;

/// Floats at which some conversion turns.
const HARD: [u32; 24] = [
    0x7fc0_0000, // NaN
    0x7f80_0000, // ∞
    0xff80_0000, // −∞
    0x8000_0000, // −0
    0x0000_0001, // smallest subnormal
    0x8040_0000, // subnormal
    0x3300_0000, // 2⁻²⁵, half of the smallest half: a tie to 0
    0x3300_0001,
    0xb380_0000, // −2⁻²⁴, the smallest half
    0x387f_c000, // largest subnormal half
    0x387f_e000, // a tie at the border to normal halves
    0x3880_0000, // 2⁻¹⁴, the smallest normal half
    0x3f80_1000, // a tie to even down
    0x3f80_3000, // a tie to even up
    0x477f_e000, // 65504, the largest half
    0x477f_efff, // just below 65520
    0x477f_f000, // 65520, a tie to infinity
    0xc780_0000, // −65536
    0x46ff_fe00, // 32767
    0x46ff_ff00, // 32767.5, a tie out of range
    0xc700_0080, // −32768.5, a tie into range
    0x3f80_0001, // just above 1
    0x3b00_8081, // near ½ of 1/255
    0x7f7f_ffff, // largest float
];

fn operand(r: &mut Random) -> f32 {
    match r.below(8) {
        0..3 => f32::from_bits(r.pick(&HARD)),
        3 => (r.below(511) as f32 * 0.5) / 255.0,
        4 => r.between(-66_000, 66_000) as f32 * 0.5,
        5 => f32::from_bits(r.next()),
        _ => r.float(-0.25, 1.25),
    }
}

/// Any bits of the format.
fn stored(r: &mut Random, format: Format) -> [u32; 4] {
    let bits = 8 * format.bytes() as u32 / format.channels() as u32;
    let limit = u32::MAX >> (32 - bits);
    let mut texel = [0; 4];
    for channel in texel.iter_mut().take(format.channels()) {
        *channel = match (format, r.below(4)) {
            (Format::R32Float | Format::Rgba32Float, 0..3) => operand(r).to_bits(),
            (Format::R16Float | Format::Rgba16Float, 0..2) => r.pick(&[
                0, 0x8000, 1, 0x83ff, 0x400, 0x3c00, 0x7bff, 0x7c00, 0xfc00, 0x7e00,
            ]),
            _ => r.next() & limit,
        };
    }
    texel
}

/// One draw over a part of an image of `format` that holds anything.
fn case(r: &mut Random, format: Format, blend: Option<BlendState>, one_color: bool) -> TwinCase {
    let s = Screen::new(Viewport::full(SIZE, SIZE));
    let reach = r.float(1.0, 3.0) * SIZE as f32;
    let mut program = Program::constant(r.array(operand));
    let mut textures = Vec::new();
    if !one_color {
        textures.push(sources(r));
        program = Program::plain(ColorSource::LookUps);
        program.textures = 1;
        program.look_ups.push(LookUp {
            slot: 0,
            kind: LookUpKind::Fetch(TexelAt {
                shift: 0,
                offset: [0; 3],
                mip: 0,
            }),
        });
    }
    let write_mask = if r.one_in(3) {
        ColorWrites(r.below(16) as u8)
    } else {
        ColorWrites::ALL
    };
    let draw = TwinDraw {
        targets: vec![ColorTargetState { blend, write_mask }],
        blend_constant: r.array(operand),
        program: Some(program),
        textures: vec![
            TextureUse {
                source: TextureSource::Texture(0),
                sampler: Sampler::default(),
            };
            textures.len()
        ],
        ..TwinDraw::triangles(vec![
            s.place(0.0, 0.0, 0.5, 1.0),
            s.place(reach, 0.0, 0.5, 1.0),
            s.place(0.0, reach, 0.5, 1.0),
        ])
    };
    TwinCase {
        size: [SIZE, SIZE],
        color: vec![ColorImage {
            format,
            texels: (0..PIXELS).map(|_| stored(r, format)).collect(),
        }],
        depth: None,
        textures,
        passes: vec![TwinPass {
            color: vec![ColorUse {
                image: 0,
                load: LoadOp::Load,
                store: StoreOp::Store,
            }],
            depth: None,
            draws: vec![draw],
        }],
    }
}

/// What the shader gives, pixel by pixel.
fn sources(r: &mut Random) -> TwinTexture {
    let texels = (0..PIXELS).map(|_| r.array(|r| operand(r).to_bits()));
    TwinTexture {
        format: Format::Rgba32Float,
        dimension: TextureDimension::D2,
        size: [SIZE, SIZE, 1],
        images: vec![vec![texels.collect()]],
    }
}

fn check(what: &str, case: &TwinCase) {
    let expected = render(case);
    for simd in SimdLevel::available() {
        let config = GpuConfig {
            threads: 1,
            simd,
            ..GpuConfig::default()
        };
        let gpu = run(case, config).unwrap_or_else(|e| panic!("{what}: {e}"));
        if let Some(difference) = difference(&expected, &gpu, SIZE) {
            panic!("{what}, {simd}: {difference}");
        }
    }
}

fn color_formats() -> impl Iterator<Item = Format> {
    Format::ALL.into_iter().filter(|f| !f.is_depth_stencil())
}

fn factors(format: Format) -> &'static [BlendFactor] {
    match format {
        Format::R16Sint => &[BlendFactor::Zero, BlendFactor::One],
        _ => &BlendFactor::ALL,
    }
}

#[test]
fn every_format_stores_what_shaders_give() {
    for (n, format) in color_formats().enumerate() {
        for k in 0..40 {
            let mut r = Random::new(1000 * n as u64 + k);
            let case = case(&mut r, format, None, k % 2 == 0);
            check(&format!("{format:?} opaque, {k}"), &case);
        }
    }
}

#[test]
fn one_color_in_range_is_stored_like_any_other() {
    for (n, format) in color_formats().enumerate() {
        for k in 0..20 {
            let mut r = Random::new(77_000 + 1000 * n as u64 + k);
            let mut case = case(&mut r, format, None, true);
            let unit = r.float(0.0, 1.0);
            let color = r.array(|r| r.pick(&[0.0, -0.0, 1.0, 0.3, 1.5 / 255.0, unit]));
            case.passes[0].draws[0].program = Some(Program::constant(color));
            check(&format!("{format:?} of {color:?}"), &case);
        }
    }
}

/// Every pair of factors under every operation, in colour and, in another order, alpha.
#[test]
fn every_format_blends_with_all_factors_and_operations() {
    let formats: Vec<_> = color_formats().filter(|f| f.is_blendable()).collect();
    let jobs = (formats.len() * BlendOperation::ALL.len()) as u64;
    parallel::map(0..jobs, |job| {
        let format = formats[job as usize % formats.len()];
        let operation = BlendOperation::ALL[job as usize / formats.len()];
        let mut r = Random::new(job + 5_000);
        for &src_factor in factors(format) {
            for &dst_factor in factors(format) {
                let color = BlendComponent {
                    src_factor,
                    dst_factor,
                    operation,
                };
                let alpha = BlendComponent {
                    src_factor: r.pick(factors(format)),
                    dst_factor: r.pick(factors(format)),
                    operation: r.pick(&BlendOperation::ALL),
                };
                let alpha = if r.one_in(3) { color } else { alpha };
                let blend = Some(BlendState { color, alpha });
                let one_color = r.one_in(3);
                let case = case(&mut r, format, blend, one_color);
                check(&format!("{format:?} {blend:?}"), &case);
            }
        }
    });
}
