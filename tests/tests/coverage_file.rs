//! Coverage against a rasteriser whose pixels are in a TRICOV1 file.
//!
//! `GNOMON_TRICOV` names one or more files, separated by colons. Triangles inside
//! the viewport must agree on every pixel; of the others, which peers clip where
//! we have a guard band, the differences are printed.

use gnomon_raster::state::{
    DepthStencilState, StencilFaceState, StencilOperation, StencilState, Viewport,
};
use gnomon_raster::{Format, GpuConfig, LoadOp, StoreOp};
use gnomon_tests::gpu_run::run;
use gnomon_tests::lcg::CLASSES;
use gnomon_tests::parallel;
use gnomon_tests::random::Screen;
use gnomon_tests::tricov::{CoveredTriangle, Tricov};
use gnomon_tests::twin::{DepthImage, DepthUse, TwinCase, TwinDraw, TwinPass};

/// Pixels of the file's window that the GPU covers.
fn covered(file: &Tricov, t: &CoveredTriangle) -> Vec<bool> {
    let size = [file.origin + file.width, file.origin + file.height];
    let n = (size[0] * size[1]) as usize;
    let screen = Screen::new(Viewport::full(size[0], size[1]));
    let at = |v: f32| v + file.origin as f32;
    let positions = t
        .corners
        .iter()
        .map(|&[x, y]| screen.place(at(x), at(y), 0.5, 1.0))
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
    let depth = DepthUse {
        depth_load: LoadOp::Load,
        depth_store: StoreOp::Store,
        stencil_load: LoadOp::Load,
        stencil_store: StoreOp::Store,
    };
    let case = TwinCase {
        size,
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
    };
    let config = GpuConfig {
        threads: 1,
        ..GpuConfig::default()
    };
    let stencil = run(&case, config)
        .unwrap_or_else(|e| panic!("{t:?}: {e}"))
        .stencil;
    let column = |i: usize| i % size[0] as usize >= file.origin as usize;
    let row = |i: usize| i / size[0] as usize >= file.origin as usize;
    (0..n)
        .filter(|&i| column(i) && row(i))
        .map(|i| stencil[i] != 0)
        .collect()
}

/// Whether all corners lie in the viewport.
fn is_inside(file: &Tricov, t: &CoveredTriangle) -> bool {
    let within = |v: f32, size: u32| (-(file.origin as f32)..=size as f32).contains(&v);
    t.corners
        .iter()
        .all(|&[x, y]| within(x, file.width) && within(y, file.height))
}

fn compare(path: &str) {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let file = Tricov::parse(&bytes).unwrap_or_else(|e| panic!("{path}: {e}"));
    let ours = parallel::map(0..file.triangles.len() as u64, |k| {
        covered(&file, &file.triangles[k as usize])
    });
    println!("{path}: {}, {} triangles", file.name, file.triangles.len());
    let mut wrong = 0;
    for (class, name) in CLASSES.iter().enumerate() {
        let mut counts = [[0; 3]; 2];
        for (t, ours) in file
            .triangles
            .iter()
            .zip(&ours)
            .filter(|(t, _)| usize::from(t.class) == class)
        {
            let different = t.covered.iter().zip(ours).filter(|(a, b)| a != b).count();
            let c = &mut counts[usize::from(!is_inside(&file, t))];
            *c = [
                c[0] + 1,
                c[1] + usize::from(different > 0),
                c[2] + different,
            ];
        }
        let [[inside, bad, pixels], [outside, differ, others]] = counts;
        println!(
            "  {name:10} inside: {bad} of {inside} differ ({pixels} pixels); leaving: {differ} of {outside} ({others})"
        );
        wrong += bad;
    }
    assert_eq!(
        wrong, 0,
        "{path}: triangles inside the viewport cover other pixels"
    );
}

#[test]
fn coverage_equals_the_files() {
    match std::env::var("GNOMON_TRICOV") {
        Ok(paths) => paths.split(':').for_each(compare),
        Err(_) => println!("GNOMON_TRICOV is not set: no file to compare with"),
    }
}
