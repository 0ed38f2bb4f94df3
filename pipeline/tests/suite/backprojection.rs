//! Backprojection and bit fields against the closed form, the exact oracle and each other
//! (docs/papers.md, baselines).

use crate::map_support::{SIZE, by, error, figure, plate_error, plates, scene, sized, truth};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_shaders::backprojection::MORE_THAN_ALL;

const BOTH: [&str; 2] = ["backprojection", "bitmask"];

/// A step of the bit field along one axis.
const STEP: f64 = 1.0 / 16.0;

/// T: the closed form within half a texel at each edge; of the bit field, within half a
/// step at each of four edges as well.
#[test]
fn patches_are_the_closed_form_within_texels() {
    for d in [3.0, 4.9, 8.0] {
        for (name, step) in [("backprojection", 0.0), ("bitmask", STEP)] {
            let set = ["fit=receivers", "map-size=128"];
            let (error, kernel) = plate_error(name, d, &set);
            let bound = 0.5 / kernel + 2.0 * step + 1e-3;
            assert!(error.max <= bound, "{name} {d}: {error:?} above {bound}");
        }
        // Where the plate's edges are between texels no error is left but f32's.
        let (error, _) = plate_error("backprojection", d, &["map-size=64"]);
        assert!(error.max < 1e-4, "{d}: {error:?}");
    }
}

/// T, negative control: with a few bits the field misses what more are held to.
#[test]
fn few_bits_fail_where_many_do_not() {
    let of = |bits: &str| plate_error("bitmask", 4.9, &[bits, "map-size=64"]).0;
    let [few, some, many] = ["bits=2", "bits=4", "bits=16"].map(of);
    assert!(few.max > 4.0 * STEP && some.max > 2.0 * STEP && many.max <= 2.0 * STEP + 1e-3);
    assert!(many.rmse < 0.5 * some.rmse && some.rmse < 0.8 * few.rmse);
}

/// Bits that are in no line along the light's sides tell places of edges along them n
/// times as finely.
#[test]
fn turned_bits_are_finer_along_edges() {
    for bits in ["bits=4", "bits=16"] {
        let of = |set: &[&str]| {
            let set = [&[bits, "map-size=64"], set].concat();
            plate_error("bitmask", 4.9, &set).0
        };
        let (grid, turned) = (of(&["pattern=grid"]), of(&["pattern=rotated-grid"]));
        println!("{bits}: {grid:?} {turned:?}");
        assert!(turned.rmse < 0.6 * grid.rmse, "{bits}: {grid:?} {turned:?}");
    }
}

/// Errors on scenes with everything in them; bounds hold what was measured with some
/// room.
#[test]
fn built_in_scenes_against_the_truth() {
    for (name, bounds) in [
        ("parallel-plates", [0.02, 0.02]),
        ("cylinder", [0.2, 0.2]),
        ("creature", [0.2, 0.2]),
        ("spheres", [0.2, 0.2]),
    ] {
        let scene = scene(name);
        let truth = truth(&scene);
        let none = error("unshadowed", &scene, &truth, &[]).rmse;
        let found = BOTH.map(|technique| error(technique, &scene, &truth, &[]).rmse);
        for (found, bound) in found.into_iter().zip(bounds) {
            assert!(found < bound && found < 0.5 * none, "{name}: {found}");
        }
    }
}

/// What of the light is hidden in each pixel.
fn hidden(name: &str, scene: &str, set: &[&str]) -> Vec<f64> {
    let picture = by(name, &self::scene(scene), set);
    let seen = picture.visibility.iter().filter(|v| !v.is_nan());
    seen.map(|v| 1.0 - f64::from(*v)).collect()
}

/// T: with the same patches bits hide no more than areas do, but for the field's steps:
/// one bit in the mean, and in no pixel more than a row and a column of them.
#[test]
fn bits_hide_no_more_than_areas() {
    for scene in ["parallel-plates", "cylinder", "creature", "spheres"] {
        for (side, pattern) in [(8u32, "grid"), (16, "grid"), (16, "rotated-grid")] {
            let bits = format!("bits={side}");
            let pattern = format!("pattern={pattern}");
            let areas = hidden("backprojection", scene, &[]);
            let bits = hidden("bitmask", scene, &[&bits, &pattern]);
            let excess: Vec<f64> = bits.iter().zip(&areas).map(|(b, a)| b - a).collect();
            let mean = excess.iter().sum::<f64>() / excess.len() as f64;
            let most = excess.iter().fold(0.0f64, |a, b| a.max(*b));
            let n = f64::from(side);
            println!("{scene} {side}: mean {mean:.5}, most {most:.4}");
            assert!(mean <= 1.0 / (n * n), "{scene} {side}: {mean}");
            assert!(most <= 2.0 / n, "{scene} {side}: {most}");
        }
    }
}

/// Filling gaps only hides more, and nearer to the truth.
#[test]
fn filled_gaps_leak_less() {
    for name in ["cylinder", "creature"] {
        let open = hidden("backprojection", name, &["gaps=leave"]);
        let filled = hidden("backprojection", name, &["gaps=fill"]);
        assert!(open.iter().zip(&filled).all(|(a, b)| *b >= a - 1e-6));
        let more = open.iter().zip(&filled).filter(|(a, b)| *b - *a > 0.01);
        assert!(more.count() > 20, "{name}");
    }
    let scene = scene("creature");
    let truth = truth(&scene);
    let of = |set: &str| error("bitmask", &scene, &truth, &[set]).rmse;
    let [open, filled] = ["gaps=leave", "gaps=fill"].map(of);
    assert!(filled < open, "{open} {filled}");
}

fn look_up(picture: &Rendered) -> gnomon_raster::Counters {
    let passes = &picture.report.passes;
    let pass = passes.iter().find(|p| p.label == "look-up").unwrap();
    pass.totals()
}

/// Smaller regions read less and see the same.
#[test]
fn refined_regions_read_less_and_see_the_same() {
    let scene = scene("cylinder");
    let of = |set: &str| by("backprojection", &scene, &[set]);
    let pictures = ["refine=0", "refine=1", "refine=3"].map(of);
    let [all, once, often] = pictures.each_ref().map(|p| look_up(p).traffic.tex_fetches);
    assert!(
        once[1] < all[1] && often[1] <= once[1],
        "{all:?} {once:?} {often:?}"
    );
    // Four fetches of the pyramid for each receiver and time.
    let receivers = pictures[0]
        .visibility
        .iter()
        .filter(|v| !v.is_nan())
        .count() as u64;
    assert_eq!((all[3], once[3]), (0, 4 * receivers));
    for other in &pictures[1..] {
        for (a, b) in pictures[0].visibility.iter().zip(&other.visibility) {
            assert!(a.is_nan() || (a - b).abs() < 1e-5, "{a} {b}");
        }
    }
}

/// Areas hide more than all behind one another, which is counted; bits do not.
#[test]
fn what_is_hidden_twice_is_counted() {
    let scene = scene("spheres");
    let count = |name: &str| figure(&by(name, &scene, &[]), MORE_THAN_ALL);
    assert!(count("backprojection") > 0.0);
    assert_eq!(count("bitmask"), 0.0);
}

#[test]
fn bad_parameters_are_refused() {
    let (scene, _) = plates(3.0);
    for (name, set, told) in [
        ("bitmask", "bits=3", "a power of two, 2 to 16"),
        ("backprojection", "bits=8", "bits"),
        ("backprojection", "refine=5", "0 to 4"),
        ("bitmask", "gaps=some", "fill"),
    ] {
        let message = sized(name, &scene, &[set], SIZE).unwrap_err();
        assert!(message.contains(told), "{name} {set}: {message}");
    }
}
