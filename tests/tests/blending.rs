//! 8-bit blending: every pair of operands, against formulas of their own.

use gnomon_raster::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
    Viewport,
};
use gnomon_raster::{Format, GpuConfig, LoadOp, StoreOp};
use gnomon_tests::gpu_run::run;
use gnomon_tests::random::{Random, Screen};
use gnomon_tests::twin::{
    ColorImage, ColorSource, ColorUse, Outcome, Program, TwinCase, TwinDraw, TwinPass, render,
};

const N: u32 = 256;

/// Triangles over all of a square image, blended onto it, in turn.
fn layers(size: u32, texels: Vec<[u32; 4]>, programs: &[Program], blend: BlendState) -> TwinCase {
    let s = Screen::new(Viewport::full(size, size));
    let far = 3.0 * size as f32;
    let positions = vec![
        s.place(0.0, 0.0, 0.5, 1.0),
        s.place(far, 0.0, 0.5, 1.0),
        s.place(0.0, far, 0.5, 1.0),
    ];
    let draws = programs.iter().map(|p| TwinDraw {
        targets: vec![ColorTargetState {
            blend: Some(blend),
            write_mask: ColorWrites::ALL,
        }],
        program: Some(p.clone()),
        ..TwinDraw::triangles(positions.clone())
    });
    TwinCase {
        size: [size, size],
        color: vec![ColorImage {
            format: Format::Rgba8Unorm,
            texels,
        }],
        depth: None,
        textures: Vec::new(),
        passes: vec![TwinPass {
            color: vec![ColorUse {
                image: 0,
                load: LoadOp::Load,
                store: StoreOp::Store,
            }],
            depth: None,
            draws: draws.collect(),
        }],
    }
}

/// Source = column, destination = row, with the given source alpha in both or the source.
fn all_pairs(component: BlendComponent, alpha: Option<u32>) -> TwinCase {
    let texels = (0..N * N).map(|i| [i / N; 4]).collect();
    let program = Program::plain(ColorSource::Columns(alpha.map(|a| a as f32 / 255.0)));
    layers(
        N,
        texels,
        &[program],
        BlendState {
            color: component,
            alpha: component,
        },
    )
}

/// Checks the channels of `expected` on twin and GPU: f(source, destination).
fn assert_pairs(case: &TwinCase, channels: usize, what: &str, f: impl Fn(i64, i64) -> i64) {
    let gpu = run(case, GpuConfig::default()).unwrap_or_else(|e| panic!("{what}: {e}"));
    for (name, outcome) in [("twin", render(case)), ("GPU", gpu)] {
        for (i, texel) in outcome.color[0].iter().enumerate() {
            let (s, d) = (i as i64 % 256, i as i64 / 256);
            for c in texel.iter().take(channels) {
                assert_eq!(
                    i64::from(*c),
                    f(s, d),
                    "{what}, {name}: source {s}, destination {d}"
                );
            }
        }
    }
}

fn component(
    src_factor: BlendFactor,
    dst_factor: BlendFactor,
    operation: BlendOperation,
) -> BlendComponent {
    BlendComponent {
        src_factor,
        dst_factor,
        operation,
    }
}

#[test]
fn all_operand_pairs_of_every_operation() {
    let one = |op| component(BlendFactor::One, BlendFactor::One, op);
    let all = |op, f: fn(i64, i64) -> i64| {
        assert_pairs(&all_pairs(one(op), None), 4, &format!("{op:?}"), f)
    };
    all(BlendOperation::Add, |s, d| (s + d).min(255));
    all(BlendOperation::Subtract, |s, d| (s - d).max(0));
    all(BlendOperation::ReverseSubtract, |s, d| (d - s).max(0));
    all(BlendOperation::Min, |s, d| s.min(d));
    all(BlendOperation::Max, |s, d| s.max(d));
}

/// Nearest integer to t / 255; no halves occur.
fn nearest(t: i64) -> i64 {
    (t.clamp(0, 65025) * 2 + 255) / 510
}

#[test]
fn source_alpha_is_rounded_once() {
    let over = component(
        BlendFactor::SrcAlpha,
        BlendFactor::OneMinusSrcAlpha,
        BlendOperation::Add,
    );
    let scaled = component(BlendFactor::SrcAlpha, BlendFactor::One, BlendOperation::Add);
    let less = component(
        BlendFactor::SrcAlpha,
        BlendFactor::One,
        BlendOperation::ReverseSubtract,
    );
    for a in [0, 1, 2, 63, 127, 128, 129, 200, 254, 255] {
        let (case, b) = (|c| all_pairs(c, Some(a)), i64::from(a));
        assert_pairs(&case(over), 3, &format!("over, alpha {a}"), |s, d| {
            nearest(s * b + d * (255 - b))
        });
        assert_pairs(
            &case(scaled),
            3,
            &format!("scaled add, alpha {a}"),
            |s, d| nearest(s * b + d * 255),
        );
        assert_pairs(
            &case(less),
            3,
            &format!("scaled subtract, alpha {a}"),
            |s, d| nearest(d * 255 - s * b),
        );
    }
}

#[test]
fn products_of_operands_are_rounded_once() {
    let f = |s, d| component(s, d, BlendOperation::Add);
    let multiply = all_pairs(f(BlendFactor::Dst, BlendFactor::Zero), None);
    assert_pairs(&multiply, 4, "multiply", |s, d| nearest(s * d));
    let screen = all_pairs(f(BlendFactor::One, BlendFactor::OneMinusSrc), None);
    assert_pairs(&screen, 4, "screen", |s, d| {
        nearest(s * 255 + d * (255 - s))
    });
}

/// The 12-bit value as four digits of three bits, one a channel.
fn digits(v: u32) -> [u32; 4] {
    [v & 7, v >> 3 & 7, v >> 6 & 7, v >> 9 & 7]
}

fn value(texel: [u32; 4]) -> u32 {
    texel[0] + 8 * texel[1] + 64 * texel[2] + 512 * texel[3]
}

/// Adds values one after the other to a black image.
fn accumulate(values: &[u32]) -> [Outcome; 2] {
    let programs: Vec<_> = values
        .iter()
        .map(|&v| Program::constant(digits(v).map(|d| d as f32 / 255.0)))
        .collect();
    let case = layers(8, vec![[0; 4]; 64], &programs, BlendState::ADDITIVE);
    [
        render(&case),
        run(&case, GpuConfig::default()).expect("a valid case"),
    ]
}

fn saturated(o: &Outcome) -> u64 {
    o.passes[0]
        .draws
        .iter()
        .map(|c| c.events.blend_saturated[0])
        .sum()
}

#[test]
fn twelve_bits_split_over_four_channels_add_exactly_until_one_saturates() {
    for o in accumulate(&[4095; 36]) {
        assert!(o.color[0].iter().all(|&t| value(t) == 36 * 4095));
        assert_eq!(saturated(&o), 0);
    }
    for o in accumulate(&[4095; 37]) {
        assert!(o.color[0].iter().all(|&t| t == [255; 4]));
        assert_eq!(saturated(&o), 4 * 64, "all four channels of the 37th layer");
    }
    let mut r = Random::new(12);
    let values: Vec<_> = (0..36).map(|_| r.below(4096)).collect();
    for o in accumulate(&values) {
        assert!(
            o.color[0]
                .iter()
                .all(|&t| value(t) == values.iter().sum::<u32>())
        );
        assert_eq!(saturated(&o), 0);
    }
}
