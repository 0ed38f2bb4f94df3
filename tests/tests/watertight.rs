//! Triangulations with shared vertices cover each pixel exactly once.

use gnomon_raster::state::{
    DepthStencilState, StencilFaceState, StencilOperation, StencilState, Viewport,
};
use gnomon_raster::{Format, GpuConfig, LoadOp, StoreOp};
use gnomon_tests::check::config_of;
use gnomon_tests::gpu_run::run;
use gnomon_tests::random::{Random, Screen, grid_triangulation};
use gnomon_tests::twin::{DepthImage, DepthUse, TwinCase, TwinDraw, TwinPass, render};

const SIZE: [u32; 2] = [128, 64];

/// Every triangle adds one to the stencil where it covers.
fn counting(triangles: &[[[f32; 2]; 3]]) -> TwinCase {
    let screen = Screen::new(Viewport::full(SIZE[0], SIZE[1]));
    let positions = triangles
        .iter()
        .flatten()
        .map(|p| screen.place(p[0], p[1], 0.5, 1.0))
        .collect();
    let face = StencilFaceState {
        pass_op: StencilOperation::IncrementWrap,
        ..StencilFaceState::IGNORE
    };
    let mut draw = TwinDraw::triangles(positions);
    draw.depth_stencil = DepthStencilState {
        stencil: StencilState {
            front: face,
            back: face,
        },
        ..DepthStencilState::default()
    };
    let n = (SIZE[0] * SIZE[1]) as usize;
    let depth = DepthUse {
        depth_load: LoadOp::Clear(1.0),
        depth_store: StoreOp::Store,
        stencil_load: LoadOp::Clear(0),
        stencil_store: StoreOp::Store,
    };
    TwinCase {
        size: SIZE,
        color: Vec::new(),
        depth: Some(DepthImage {
            format: Format::Depth24Stencil8,
            depth: vec![0.0; n],
            stencil: vec![0; n],
        }),
        textures: Vec::new(),
        passes: vec![TwinPass {
            color: Vec::new(),
            depth: Some(depth),
            draws: vec![draw],
        }],
    }
}

/// Asserts stencil 1 at centres inside the rectangle (left and top edges in), 0 elsewhere.
fn assert_covers_once(triangles: &[[[f32; 2]; 3]], rect: [f32; 4], config: GpuConfig, what: &str) {
    let case = counting(triangles);
    let snap = |v: f32| (256.0 * f64::from(v)).round_ties_even() as i64;
    let [x0, y0, x1, y1] = rect.map(snap);
    let inside = |p: u32, a: i64, b: i64| (a..b).contains(&(256 * i64::from(p) + 128));
    let expected: Vec<_> = (0..SIZE[0] * SIZE[1])
        .map(|i| u8::from(inside(i % SIZE[0], x0, x1) && inside(i / SIZE[0], y0, y1)))
        .collect();
    let gpu = run(&case, config).unwrap_or_else(|e| panic!("{what}: {e}"));
    for (name, stencil) in [("twin", render(&case).stencil), ("GPU", gpu.stencil)] {
        let wrong = (0..stencil.len()).find(|&i| stencil[i] != expected[i]);
        if let Some(i) = wrong {
            let (x, y) = (i % SIZE[0] as usize, i / SIZE[0] as usize);
            panic!(
                "{what}, {name}: pixel ({x}, {y}) is covered {} times, not {}",
                stencil[i], expected[i]
            );
        }
    }
}

/// On pixel centres, between them, or anywhere.
fn corner(r: &mut Random) -> [f32; 2] {
    match r.below(3) {
        0 => [
            r.between(-8, 90) as f32 + 0.5,
            r.between(-8, 40) as f32 + 0.5,
        ],
        1 => [r.between(-8, 90) as f32, r.between(-8, 40) as f32],
        _ => [r.float(-8.0, 90.0), r.float(-8.0, 40.0)],
    }
}

#[test]
fn jittered_grids_cover_each_pixel_once() {
    for seed in 0..150 {
        let mut r = Random::new(seed);
        let (n, at) = (r.between(1, 24) as u32, corner(&mut r));
        // From a sixteenth of a pixel a cell upwards; coarser coordinates hit centres more often.
        let step = [
            r.pick(&[0.0625, 0.5, 1.0, 3.0]),
            r.pick(&[0.125, 1.0, 2.0, 5.25]),
        ];
        let jitter = r.pick(&[0.0, 0.25]);
        let triangles = grid_triangulation(&mut r, n, at, step, jitter);
        let rect = [
            at[0],
            at[1],
            at[0] + n as f32 * step[0],
            at[1] + n as f32 * step[1],
        ];
        assert_covers_once(&triangles, rect, config_of(seed), &format!("grid {seed}"));
    }
}

/// A point inside a rectangle, joined to points all round its border.
fn rectangle_fan(r: &mut Random, [x0, y0, x1, y1]: [f32; 4]) -> Vec<[[f32; 2]; 3]> {
    let side = |r: &mut Random| {
        let mut t: Vec<_> = (0..r.between(0, 12)).map(|_| r.float(0.0, 1.0)).collect();
        t.sort_by(f32::total_cmp);
        t.insert(0, 0.0);
        t
    };
    let mut rim = Vec::new();
    for (a, b) in [
        ([x0, y0], [x1, y0]),
        ([x1, y0], [x1, y1]),
        ([x1, y1], [x0, y1]),
        ([x0, y1], [x0, y0]),
    ] {
        rim.extend(
            side(r)
                .into_iter()
                .map(|t| [0, 1].map(|k| a[k] + (b[k] - a[k]) * t)),
        );
    }
    let hub = [
        x0 + (x1 - x0) * r.float(0.1, 0.9),
        y0 + (y1 - y0) * r.float(0.1, 0.9),
    ];
    (0..rim.len())
        .map(|k| [hub, rim[k], rim[(k + 1) % rim.len()]])
        .collect()
}

#[test]
fn fans_cover_each_pixel_once() {
    for seed in 0..150 {
        let mut r = Random::new(0xfa_0000 + seed);
        let [x, y] = corner(&mut r);
        let rect = [x, y, x + r.float(2.0, 100.0), y + r.float(2.0, 60.0)];
        let triangles = rectangle_fan(&mut r, rect);
        assert_covers_once(&triangles, rect, config_of(seed), &format!("fan {seed}"));
    }
}
