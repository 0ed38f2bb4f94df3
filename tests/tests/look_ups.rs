//! Texture look-ups at coordinates of every kind, absurd ones too, at every SIMD level
//! against the twin: values and texels read, to the bit; and some whose value is known.

use gnomon_raster::state::ColorTargetState;
use gnomon_raster::state::Viewport;
use gnomon_raster::{
    AddressMode, Format, GpuConfig, LoadOp, Sampler, SimdLevel, StoreOp, TextureDimension,
};
use gnomon_tests::compare::difference;
use gnomon_tests::gpu_run::run;
use gnomon_tests::parallel;
use gnomon_tests::random::{Random, Screen, random_sampler, random_texture};
use gnomon_tests::twin::{
    ColorImage, ColorSource, ColorUse, Coordinate, LookUp, LookUpKind, Origin, Outcome, Program,
    TexelAt, TextureSource, TextureUse, TwinCase, TwinDraw, TwinPass, TwinTexture, render,
};

const SIZE: u32 = 16;
const PIXELS: usize = (SIZE * SIZE) as usize;

/// The number of look-ups of a case: one a pixel.
const PER_CASE: u64 = PIXELS as u64;

/// Every pixel looks `texture` up at its own coordinate: the first image shows the
/// coordinates, the second what was found.
fn case(
    texture: TwinTexture,
    sampler: Sampler,
    coordinates: Vec<[f32; 3]>,
    kind: LookUpKind,
) -> TwinCase {
    let s = Screen::new(Viewport::full(SIZE, SIZE));
    let far = 3.0 * SIZE as f32;
    let table = TwinTexture {
        format: Format::Rgba32Float,
        dimension: TextureDimension::D2,
        size: [SIZE, SIZE, 1],
        images: vec![vec![
            coordinates
                .iter()
                .map(|c| [c[0].to_bits(), c[1].to_bits(), c[2].to_bits(), 0])
                .collect(),
        ]],
    };
    let own = LookUpKind::Fetch(TexelAt {
        shift: 0,
        offset: [0; 3],
        mip: 0,
    });
    let mut program = Program::plain(ColorSource::LookUps);
    program.outputs = 2;
    program.textures = 2;
    program.look_ups = vec![LookUp { slot: 0, kind: own }, LookUp { slot: 1, kind }];
    let image = ColorImage {
        format: Format::Rgba32Float,
        texels: vec![[0; 4]; PIXELS],
    };
    let slot = |texture, sampler| TextureUse {
        source: TextureSource::Texture(texture),
        sampler,
    };
    let draw = TwinDraw {
        targets: vec![ColorTargetState::OPAQUE; 2],
        program: Some(program),
        textures: vec![slot(0, Sampler::default()), slot(1, sampler)],
        ..TwinDraw::triangles(vec![
            s.place(0.0, 0.0, 0.5, 1.0),
            s.place(far, 0.0, 0.5, 1.0),
            s.place(0.0, far, 0.5, 1.0),
        ])
    };
    let whole = |image| ColorUse {
        image,
        load: LoadOp::Load,
        store: StoreOp::Store,
    };
    TwinCase {
        size: [SIZE, SIZE],
        color: vec![image.clone(), image],
        depth: None,
        textures: vec![table, texture],
        passes: vec![TwinPass {
            color: vec![whole(0), whole(1)],
            depth: None,
            draws: vec![draw],
        }],
    }
}

/// The coordinate that was fetched.
const FETCHED: Coordinate = Coordinate {
    of: Origin::LookUp(0),
    scale: [1.0; 3],
    offset: [0.0; 3],
};

fn level(lod: f32) -> LookUpKind {
    let level = Coordinate {
        of: Origin::Position,
        scale: [0.0; 3],
        offset: [lod; 3],
    };
    LookUpKind::Level(FETCHED, level)
}

/// Mostly near the image, sometimes absurd.
fn coordinate(r: &mut Random) -> f32 {
    let hard = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        -0.0,
        1.0,
        -1e-10,
        f32::MAX,
        0.5,
    ];
    match r.below(12) {
        0 => f32::from_bits(r.next()),
        1 => r.pick(&hard),
        2 => r.float(-5e5, 5e5),
        3 | 4 => r.below(9) as f32 * 0.25 - 0.5,
        _ => r.float(-1.0, 2.0),
    }
}

/// A coordinate a pixel: scattered, or a smooth field as a surface gives.
fn coordinates(r: &mut Random) -> Vec<[f32; 3]> {
    if r.one_in(2) {
        return (0..PIXELS).map(|_| r.array(coordinate)).collect();
    }
    let scale = r.pick(&[0.01, 0.1, 0.5]);
    let base: [f32; 3] = r.array(|r| r.float(-0.5, 1.5));
    let (gx, gy): ([f32; 3], [f32; 3]) = (
        r.array(|r| r.float(0.0, scale)),
        r.array(|r| r.float(0.0, scale)),
    );
    let at = |i: usize, k: usize| {
        base[k] + gx[k] * (i as u32 % SIZE) as f32 + gy[k] * (i as u32 / SIZE) as f32
    };
    (0..PIXELS)
        .map(|i| std::array::from_fn(|k| at(i, k)))
        .collect()
}

fn kind(r: &mut Random) -> LookUpKind {
    match r.below(8) {
        0..2 => level(r.pick(&[0.0, 1.0, 1.5, 0.25, -4.0, 99.0, f32::NAN])),
        2 => {
            let change = |r: &mut Random| Coordinate {
                scale: r.array(|r| r.pick(&[0.0, 0.25, 1.0, -2.0])),
                ..FETCHED
            };
            LookUpKind::Gradients(FETCHED, [change(r), change(r)])
        }
        3 => LookUpKind::Fetch(TexelAt {
            shift: r.below(4),
            offset: r.array(|r| r.pick(&[-3, -1, 0, 1, 5, 20, i32::MIN, i32::MAX - 15])),
            mip: r.below(6),
        }),
        _ => LookUpKind::Sample(FETCHED),
    }
}

fn gpu(case: &TwinCase, simd: SimdLevel) -> Outcome {
    let config = GpuConfig {
        threads: 1,
        simd,
        ..GpuConfig::default()
    };
    run(case, config).expect("a valid case")
}

/// As the twin at every level.
fn check(what: &str, case: &TwinCase) {
    let expected = render(case);
    for simd in SimdLevel::available() {
        if let Some(difference) = difference(&expected, &gpu(case, simd), SIZE) {
            let draw = &case.passes[0].draws[0];
            panic!(
                "{what}, {simd}: {difference}\n{:?}\n{:?} {:?} {:?}",
                draw.program.as_ref().map(|p| &p.look_ups),
                case.textures[1].format,
                case.textures[1].size,
                draw.textures[1].sampler
            );
        }
    }
}

fn check_seed(seed: u64) {
    let mut r = Random::new(seed ^ 0x100c_0a75);
    let (texture, sampler) = (random_texture(&mut r), random_sampler(&mut r));
    let at = coordinates(&mut r);
    let kind = kind(&mut r);
    check(&format!("seed {seed}"), &case(texture, sampler, at, kind));
}

#[test]
fn look_ups_equal_the_twin() {
    parallel::map(0..200_000 / PER_CASE, check_seed);
}

#[test]
#[ignore = "a hundred million look-ups: minutes in a release build"]
fn look_ups_equal_the_twin_at_length() {
    parallel::map(1_000..1_000 + 100_000_000 / PER_CASE, check_seed);
}

/// What the second image holds, after a check against the twin.
fn found(case: &TwinCase) -> Vec<[f32; 4]> {
    check("known values", case);
    let outcome = gpu(case, SimdLevel::detect());
    let floats = |t: &[u32; 4]| t.map(f32::from_bits);
    outcome.color[1].iter().map(floats).collect()
}

/// Texels read from slot 1.
fn texels(case: &TwinCase) -> u64 {
    let outcome = gpu(case, SimdLevel::detect());
    outcome.passes[0].draws[0].traffic.tex[1].read_accesses
}

fn single(size: u32, f: impl Fn(u32, u32) -> f32) -> TwinTexture {
    let texel = |i: u32| [f(i % size, i / size).to_bits(), 0, 0, 0];
    TwinTexture {
        format: Format::R32Float,
        dimension: TextureDimension::D2,
        size: [size, size, 1],
        images: vec![vec![(0..size * size).map(texel).collect()]],
    }
}

/// A chain of which level k holds `f(k)` everywhere.
fn chain(size: u32, f: impl Fn(u32) -> f32) -> TwinTexture {
    let mut texture = single(size, |_, _| f(0));
    for k in 1..=size.ilog2() {
        let n = (size >> k).pow(2) as usize;
        texture
            .images
            .push(vec![vec![[f(k).to_bits(), 0, 0, 0]; n]]);
    }
    texture
}

#[test]
fn a_linear_ramp_is_reproduced_exactly() {
    let ramp = single(16, |x, y| x as f32 + 4.0 * y as f32);
    let inner = |i: usize| [(i % 16).min(14) as f32, (i / 16).min(14) as f32];
    let at = (0..PIXELS)
        .map(|i| {
            let [x, y] = inner(i).map(|v| (0.5 + 0.875 * v) / 16.0);
            [x, y, 0.0]
        })
        .collect();
    let case = case(ramp, Sampler::bilinear(), at, level(0.0));
    for (i, got) in found(&case).into_iter().enumerate() {
        let [x, y] = inner(i).map(|v| 0.875 * v);
        assert_eq!(got, [x + 4.0 * y, 0.0, 0.0, 1.0]);
    }
    assert_eq!(texels(&case), 4 * PER_CASE);
}

#[test]
fn trilinear_at_whole_levels_is_bilinear_and_reads_as_much() {
    let mut r = Random::new(7);
    let mut texture = chain(16, |k| k as f32);
    for image in texture.images.iter_mut().flatten().flatten() {
        image[0] = r.float(0.0, 1.0).to_bits();
    }
    let at = coordinates(&mut r);
    for (lod, taps) in [(0.0, 4), (1.0, 4), (3.0, 4), (4.0, 4), (9.0, 4), (2.5, 8)] {
        let with = |sampler| case(texture.clone(), sampler, at.clone(), level(lod));
        let (tri, bi) = (with(Sampler::trilinear()), with(Sampler::bilinear()));
        assert_eq!(texels(&tri), taps * PER_CASE, "level {lod}");
        if lod.fract() == 0.0 {
            let bits = |case| -> Vec<_> {
                let all = found(case).into_iter();
                all.map(|t| t.map(f32::to_bits)).collect()
            };
            assert_eq!(bits(&tri), bits(&bi), "level {lod}");
        }
    }
}

#[test]
fn the_level_follows_the_texels_per_pixel() {
    for (texels_per_pixel, want) in [
        (0.5, 0.0),
        (1.0, 0.0),
        (2.0, 1.0),
        (4.0, 2.0),
        (64.0, 6.0),
        (1e6, 6.0),
    ] {
        let step = texels_per_pixel / 64.0;
        let at = (0..PIXELS)
            .map(|i| [(i % 16) as f32 * step, (i / 16) as f32 * step * 0.5, 0.0])
            .collect();
        let levels = chain(64, |k| k as f32);
        let case = case(
            levels,
            Sampler::trilinear(),
            at,
            LookUpKind::Sample(FETCHED),
        );
        assert_eq!(found(&case)[3][0], want, "{texels_per_pixel}");
    }
}

#[test]
fn cube_faces_and_their_seams() {
    let face = |k: u32| vec![[(k as f32).to_bits(), 0, 0, 0]; 16];
    let cube = TwinTexture {
        format: Format::R32Float,
        dimension: TextureDimension::Cube,
        size: [4, 4, 1],
        images: vec![(0..6).map(face).collect()],
    };
    let axes: [[f32; 3]; 6] = [
        [2., 0., 0.],
        [-1., 0., 0.],
        [0., 3., 0.],
        [0., -1., 0.],
        [0., 0., 1.],
        [0., 0., -9.],
    ];
    let at: Vec<_> = (0..PIXELS).map(|i| axes[i % 6]).collect();
    for sampler in [Sampler::default(), Sampler::bilinear()] {
        let case = case(cube.clone(), sampler, at.clone(), level(0.0));
        for (i, got) in found(&case).into_iter().enumerate() {
            assert_eq!(got[0], (i % 6) as f32);
        }
    }
    // On the edge of +x and +z both weigh the same, from either side.
    for d in [[1.0, 0.1, 0.999_999_9], [0.999_999_9, 0.1, 1.0]] {
        let case = case(
            cube.clone(),
            Sampler::bilinear(),
            vec![d; PIXELS],
            level(0.0),
        );
        assert!((found(&case)[0][0] - 2.0).abs() < 1e-5);
        assert_eq!(texels(&case), 4 * PER_CASE);
    }
}

#[test]
fn borders_show_outside_only() {
    let sampler = Sampler {
        address: [AddressMode::ClampToBorder; 3],
        border: [7.0, 0.0, 0.0, 0.0],
        ..Sampler::default()
    };
    let at = (0..PIXELS)
        .map(|i| [(i % 16) as f32 / 8.0 - 0.45, 0.5, 0.0])
        .collect();
    let case = case(single(4, |x, _| x as f32), sampler, at, level(0.0));
    for (i, got) in found(&case).into_iter().enumerate() {
        let u = (i % 16) as f32 / 8.0 - 0.45;
        let want = if (0.0..1.0).contains(&u) {
            (u * 4.0).floor()
        } else {
            7.0
        };
        assert_eq!(got[0], want, "{u}");
    }
}

#[test]
fn stencil_is_fetched_as_integers() {
    let texel = |i: u32| [1 << 23, 250 - i, 0, 0];
    let texture = TwinTexture {
        format: Format::Depth24Stencil8,
        dimension: TextureDimension::D2,
        size: [4, 4, 1],
        images: vec![vec![(0..16).map(texel).collect()]],
    };
    let at = TexelAt {
        shift: 0,
        offset: [0, 0, 9],
        mip: 0,
    };
    let case = case(
        texture,
        Sampler::default(),
        vec![[0.0; 3]; PIXELS],
        LookUpKind::Stencil(at),
    );
    let got = found(&case);
    let row = |y: usize| [0, 1, 2, 3, 4].map(|x| got[16 * y + x][0]);
    assert_eq!(row(0), [250.0, 249.0, 248.0, 247.0, 0.0]);
    assert_eq!(row(1), [246.0, 245.0, 244.0, 243.0, 0.0]);
    assert_eq!(row(4), [0.0; 5]);
}
