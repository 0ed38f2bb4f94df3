//! Frames of the simulator ATTILA (attila-sim a64b572, `test/`), drawn here and judged by
//! the profile that follows it; what it measured, to the byte.

mod anchor_support;

use anchor_support::sums::unequal_sum;
use anchor_support::{Case, Vertex, draw_layers};
use gnomon_raster::Format;
use gnomon_traces::profile::{CacheKind, Client, Judge, JudgeOptions, Profile, Traffic, profile};

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
const BLUE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];

fn vertex(position: [f32; 2], color: [f32; 4]) -> Vertex {
    Vertex { position, color }
}

/// `ogl/triangle`.
fn gl_triangle() -> Case {
    Case {
        depth: None,
        clear: [0.0; 4],
        vertices: vec![
            vertex([62.5, 62.5], RED),
            vertex([187.5, 62.5], GREEN),
            vertex([187.5, 187.5], BLUE),
        ],
        ..Case::new(250, 250)
    }
}

/// Where Direct3D 9 puts a point of the unit square.
fn d3d(x: f32, y: f32) -> [f32; 2] {
    [(x + 1.0) * 316.0 + 0.5, (1.0 - y) * 223.0 + 0.5]
}

/// `d3d/triangle`.
fn d3d_triangle() -> Case {
    Case {
        clear: [0.0, 0.0, 1.0, 1.0],
        vertices: vec![
            vertex(d3d(-0.8, -0.8), GREEN),
            vertex(d3d(-0.8, 0.8), BLUE),
            vertex(d3d(0.8, 0.8), RED),
        ],
        ..Case::new(632, 446)
    }
}

/// `d3d/texture_X8R8G8B8_square`.
fn d3d_square() -> Case {
    let corner = |x: f32, y: f32| {
        let at = [x / 1.6 + 0.5, 0.5 - y / 1.6, 0.0, 1.0];
        vertex(d3d(x, y), at)
    };
    let [a, b, c, d] = [
        corner(-0.8, -0.8),
        corner(-0.8, 0.8),
        corner(0.8, 0.8),
        corner(0.8, -0.8),
    ];
    Case {
        clear: [0.0, 0.0, 1.0, 1.0],
        textured: true,
        vertices: vec![a, b, c, a, c, d],
        ..Case::new(632, 446)
    }
}

fn judged(case: &Case, profile: &Profile) -> Traffic {
    case.judge(profile, JudgeOptions::default())
}

fn attila() -> Profile {
    profile("imr-2008").unwrap()
}

fn read(traffic: &Traffic, client: Client) -> u64 {
    traffic.client(client).dram.read_bytes
}

fn written(traffic: &Traffic, client: Client) -> u64 {
    traffic.client(client).dram.write_bytes
}

fn written_before_the_end(traffic: &Traffic, client: Client) -> u64 {
    written(traffic, client) - traffic.flushed(client)
}

const ZS: Client = Client::DepthStencil;
const COLOR: Client = Client::Color(0);

#[test]
fn the_triangle_of_opengl() {
    let case = gl_triangle();
    assert_eq!(case.fragments(), 7_875);
    let traffic = judged(&case, &attila());
    assert_eq!(written(&traffic, COLOR), 39_168);
    assert_eq!(read(&traffic, COLOR), 0);
    assert_eq!(read(&traffic, Client::Scanout), 39_168);
    assert_eq!(traffic.client(ZS).dram.bytes(), 0);
}

/// ATTILA truncates colours and gets 10, 3 and 1,482 blocks of 64, 128 and 256 bytes; they
/// are rounded here, which leaves 5, 0 and 1,490.
#[test]
fn the_triangle_of_direct3d() {
    let case = d3d_triangle();
    assert_eq!(case.fragments(), 90_142);
    let traffic = judged(&case, &attila());
    assert_eq!(written(&traffic, ZS), 95_680);
    assert_eq!(written_before_the_end(&traffic, ZS), 91_584);
    assert_eq!(traffic.caches[0].flushed_lines, 64);
    assert_eq!(read(&traffic, ZS), 0);
    assert_eq!(written(&traffic, COLOR), 381_760);
    assert_eq!(read(&traffic, Client::Scanout), 381_760);
}

/// With colours truncated the codec's blocks are those of ATTILA.
#[test]
fn the_codec_on_truncated_colors() {
    let case = Case {
        truncated: true,
        ..d3d_triangle()
    };
    assert_eq!(case.color_classes(), [10, 3, 0, 1_482]);
    assert_eq!(d3d_triangle().color_classes(), [5, 0, 0, 1_490]);
}

#[test]
fn the_textured_square_of_direct3d() {
    let case = d3d_square();
    assert_eq!(case.fragments(), 180_285);
    let traffic = judged(&case, &attila());
    assert_eq!(written(&traffic, COLOR), 753_664);
    assert_eq!(written(&traffic, ZS), 188_416);
    assert_eq!(written_before_the_end(&traffic, ZS), 184_320);
    assert_eq!(read(&traffic, ZS), 0);
    let texture = read(&traffic, Client::Texture(0));
    assert!((262_144..=4 * 262_144).contains(&texture), "{texture}");
    let least = judged(&case, &profile("compulsory").unwrap());
    assert_eq!(read(&least, Client::Texture(0)), 262_144);
}

/// N layers in random order write depth H_N = 1 + 1/2 + … + 1/N times a pixel.
#[test]
fn harmonic_depth_writes() {
    let naive = profile("naive").unwrap();
    let pixels = 64 * 64;
    let seeds = 400;
    let writes: u64 = (0..seeds)
        .map(|seed| {
            let traffic = judged(&draw_layers(10, seed), &naive);
            let frame = traffic.rows.iter().filter(|r| r.draw.is_some());
            frame
                .map(|r| r.client(ZS).logical.write_bytes / 3)
                .sum::<u64>()
        })
        .sum();
    let mean = writes as f64 / (pixels * seeds) as f64;
    // The variance of a count is H_10 minus the sum of 1/k², 1.38.
    assert!(
        (mean - 2.929).abs() < 4.0 * (1.38 / seeds as f64).sqrt(),
        "{mean}"
    );
}

fn everything() -> [Case; 4] {
    [
        gl_triangle(),
        d3d_triangle(),
        d3d_square(),
        draw_layers(10, 3),
    ]
}

const PROFILES: [&str; 7] = [
    "naive",
    "compulsory",
    "gnomon",
    "imr-2003",
    "imr-2008",
    "tbr-mali",
    "tbr-adreno",
];

/// Draws, places and pixels add up to the same at every level, under every profile.
#[test]
fn sums_are_equal_each_way() {
    let options = JudgeOptions {
        pixels: true,
        ..JudgeOptions::default()
    };
    for case in everything() {
        for name in PROFILES {
            let traffic = case.judge(&profile(name).unwrap(), options);
            let total = traffic.total();
            assert!(total.dram.bytes() > 0 && total.logical.bytes() > 0);
            assert_eq!(unequal_sum(&traffic), None, "{name}");
        }
    }
}

/// `profile` without compression and fast clears.
fn plain(profile: &Profile) -> Profile {
    let mut plain = profile.clone();
    for port in [&mut plain.depth_stencil, &mut plain.color] {
        (port.codec, port.fast_clear) = (false, false);
    }
    plain
}

#[test]
fn nothing_moves_less_than_what_is_compulsory() {
    for case in everything() {
        for name in ["naive", "gnomon", "imr-2003", "imr-2008"] {
            let given = plain(&profile(name).unwrap());
            let (most, least) = (judged(&case, &given), judged(&case, &given.compulsory()));
            for client in Client::all() {
                let [most, least] = [&most, &least].map(|t| t.client(client).dram);
                assert!(least.read_bytes <= most.read_bytes, "{name} {client}");
                assert!(least.write_bytes <= most.write_bytes, "{name} {client}");
            }
        }
    }
}

/// A cache that nothing ever leaves, in words, is the profile `compulsory`; none at all is
/// `naive`.
#[test]
fn the_ends_of_cache_sizes() {
    for case in everything() {
        let mut given = plain(&attila());
        given.hiz = profile("naive").unwrap().hiz;
        given.scanout = false;
        let with = |cache| {
            let mut sized = given.clone();
            for port in [
                &mut sized.depth_stencil,
                &mut sized.color,
                &mut sized.texture,
            ] {
                (port.cache, port.sector, port.grain) = (cache, 1, 1);
            }
            sized.texture_units = 1;
            judged(&case, &sized).total().dram
        };
        let named = |name| judged(&case, &profile(name).unwrap()).total().dram;
        assert_eq!(with(CacheKind::None), named("naive"));
        assert_eq!(with(CacheKind::Infinite), named("compulsory"));
        let all = CacheKind::Sets {
            sets: 1 << 14,
            ways: 8,
        };
        assert_eq!(with(all), named("compulsory"));
    }
}

#[test]
fn more_ways_never_move_more_lines() {
    for case in everything() {
        let misses = |ways| {
            let mut sized = attila();
            sized.depth_stencil.cache = CacheKind::Sets { sets: 4, ways };
            judged(&case, &sized).caches[0].misses
        };
        let all: Vec<u64> = [1, 2, 4, 8, 16].map(misses).into();
        assert!(all.is_sorted_by(|a, b| a >= b), "{all:?}");
    }
}

/// Half floats are not blended in 2003, and the error says what to do.
#[test]
fn old_hardware_refuses_to_blend_half_floats() {
    let case = Case {
        format: Format::Rgba16Float,
        blended: true,
        ..gl_triangle()
    };
    let error = Judge::new(&profile("imr-2003").unwrap(), &case.shape()).unwrap_err();
    assert!(
        error.to_string().contains("--set color-format=rgba8"),
        "{error}"
    );
    assert!(Judge::new(&attila(), &case.shape()).is_ok());
}
