//! Pictures of several samples a pixel: the mean of a larger one, by a pass that is counted.

use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render, render_supersampled};
use gnomon_pipeline::technique::{Params, PassRole};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::format::{f16_from_f32, f32_from_f16};

const SIZE: [u32; 2] = [20, 15];

fn drawn(name: &str, factor: u32, side: u32) -> Rendered {
    let technique = find(name).unwrap();
    let settings = RenderSettings {
        size: SIZE.map(|s| s * factor),
        ..RenderSettings::default()
    };
    let params = Params::defaults(technique);
    let scene = builtin::build("cylinder").unwrap();
    match side {
        0 => render(&scene, technique, &params, &settings).unwrap(),
        side => render_supersampled(&scene, technique, &params, &settings, side).unwrap(),
    }
}

/// Samples of a pixel in a picture that is `side` times as large.
fn samples(x: u32, y: u32, side: u32) -> impl Iterator<Item = usize> {
    let columns = SIZE[0] * side;
    let all = (0..side).flat_map(move |row| (0..side).map(move |column| [column, row]));
    all.map(move |[dx, dy]| ((y * side + dy) * columns + x * side + dx) as usize)
}

#[test]
fn one_sample_is_the_plain_picture() {
    for name in ["unshadowed", "shadow-volumes"] {
        let (plain, one) = (drawn(name, 1, 0), drawn(name, 1, 1));
        assert_eq!(plain.color_hash(), one.color_hash());
        assert_eq!(plain.visibility_hash(), one.visibility_hash());
        let totals = |r: &Rendered| {
            r.report
                .passes
                .iter()
                .map(|p| p.totals())
                .collect::<Vec<_>>()
        };
        assert_eq!(totals(&plain), totals(&one));
    }
}

#[test]
fn pixels_are_means_of_their_samples_in_linear_light() {
    for (name, side) in [
        ("shadow-volumes", 2),
        ("soft-shadow-volumes", 3),
        ("pcf", 4),
    ] {
        let (large, resolved) = (drawn(name, side, 0), drawn(name, 1, side));
        assert_eq!(resolved.size, SIZE);
        let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
        let mut edges = 0;
        for (k, [x, y]) in pixels.enumerate() {
            for c in 0..3 {
                let sum = samples(x, y, side).fold(0.0, |sum, s| sum + large.color[s][c]);
                let mean = f32_from_f16(f16_from_f32(sum / (side * side) as f32));
                assert_eq!(resolved.color[k][c], mean, "{name} at {x}, {y}");
            }
            let seen: Vec<f32> = samples(x, y, side)
                .map(|s| large.visibility[s])
                .filter(|v| !v.is_nan())
                .collect();
            let mean = seen.iter().sum::<f32>() / seen.len() as f32;
            let own = resolved.visibility[k];
            assert!((own - mean).abs() < 1e-6 || (own.is_nan() && mean.is_nan()));
            edges += usize::from(own > 0.0 && own < 1.0);
            let nearest = samples(x, y, side).fold(1.0_f32, |d, s| d.min(large.depth[s]));
            assert_eq!(resolved.depth[k], nearest);
        }
        assert!(edges > 0, "{name}: nothing of the shadow's edge");
    }
}

/// All that a larger picture costs, and a pass that reads every sample once.
#[test]
fn the_pass_that_resolves_is_counted() {
    let side = 3;
    let (large, resolved) = (
        drawn("shadow-volumes", side, 0),
        drawn("shadow-volumes", 1, side),
    );
    let (last, before) = resolved.report.passes.split_last().unwrap();
    assert_eq!(last.label, "resolve samples");
    assert_eq!(
        resolved.roles.passes().last(),
        Some(&PassRole::ResolveSamples)
    );
    assert_eq!(before.len(), large.report.passes.len());
    for (a, b) in before.iter().zip(&large.report.passes) {
        assert_eq!(a.totals(), b.totals());
    }
    let pixels = u64::from(SIZE[0] * SIZE[1]);
    let traffic = last.totals().traffic;
    assert_eq!(
        traffic.tex[0].read_bytes,
        pixels * u64::from(side * side) * 8
    );
    assert_eq!(traffic.color[0].write_bytes, pixels * 8);
    assert_eq!(last.totals().fragment_shader_invocations, pixels);
}
