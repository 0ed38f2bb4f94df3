//! Variance, exponential variance, four-moment and variance soft shadow maps against
//! the closed form and the exact oracle (docs/papers.md, baselines).

use crate::map_support::{SIZE, by, error, figure, plate_error, plates, scene, sized, truth};

const ALL: [&str; 4] = ["vsm", "evsm", "msm", "vssm"];

/// Settings with which kernels are right: blockers are found wherever there are some.
fn exact(name: &str) -> &'static [&'static str] {
    match name {
        "vssm" => &["bias=0", "fit=receivers", "cells=1"],
        _ => &["bias=0", "fit=receivers", "search-samples=1024"],
    }
}

/// T: two depths, the receiver's the farther: all bounds are exact, but for half a texel
/// at each edge and the strip that no point of the search meets.
#[test]
fn light_sized_kernels_are_the_closed_form_within_texels() {
    for name in ALL {
        for d in [3.0, 4.9, 8.0] {
            let set = [exact(name), &["map-size=256"]].concat();
            let (error, kernel) = plate_error(name, d, &set);
            let missed = if name == "vssm" { 0.0 } else { 1.0 / 32.0 };
            let bound = 0.5 / kernel + missed + 5e-3;
            assert!(error.max <= bound, "{name} {d}: {error:?} above {bound}");
            assert!(error.rmse <= 0.25 * bound, "{name} {d}: {error:?}");
        }
    }
}

/// T, negative control: a kernel of one width that is right for one floor fails at the
/// others, by more than kernels as wide as the light are held to.
#[test]
fn one_fixed_kernel_fails_where_another_width_is_needed() {
    for name in ["vsm", "evsm", "msm"] {
        let base = ["kernel=fixed", "bias=0", "map-size=64"];
        let kernel = plate_error(name, 3.0, &base).1;
        let taps = format!("taps={}", (2.0 * kernel).round());
        let tuned = |d| plate_error(name, d, &[&base[..], &[&taps]].concat());
        let (fitting, width) = tuned(3.0);
        assert!(fitting.max <= 1.0 / width + 5e-3, "right here: {fitting:?}");
        for d in [4.9, 8.0] {
            let (error, width) = tuned(d);
            assert!(error.max > 3.0 * (0.5 / width + 5e-3), "{d}: {error:?}");
        }
    }
}

/// Errors on scenes with everything in them, for whoever reads the output; bounds hold
/// what was measured with some room.
#[test]
fn built_in_scenes_against_the_truth() {
    for (name, bounds) in [
        ("parallel-plates", [0.02, 0.01, 0.01, 0.02]),
        ("cylinder", [0.12, 0.09, 0.06, 0.06]),
        ("creature", [0.11, 0.1, 0.065, 0.06]),
        ("spheres", [0.14, 0.13, 0.075, 0.07]),
    ] {
        let scene = scene(name);
        let truth = truth(&scene);
        let none = error("unshadowed", &scene, &truth, &[]).rmse;
        let found = ALL.map(|technique| error(technique, &scene, &truth, &[]).rmse);
        for (technique, (found, bound)) in ALL.into_iter().zip(found.into_iter().zip(bounds)) {
            assert!(found < bound && found < 0.6 * none, "{name} {technique}");
        }
    }
}

/// T: what is fetched, exactly: sixteen entries for each function.
#[test]
fn fetches_are_entries_times_functions() {
    let scene = scene("cylinder");
    for (name, functions) in [("vsm", 2), ("evsm", 4), ("msm", 4)] {
        let picture = by(name, &scene, &["kernel=fixed", "fit=receivers"]);
        let passes = &picture.report.passes;
        let pass = passes.iter().find(|p| p.label == "look-up").unwrap();
        let counted = pass.totals();
        let receivers = picture.visibility.iter().filter(|v| !v.is_nan()).count() as u64;
        let fetches = counted.traffic.tex_fetches;
        let pixels = u64::from(SIZE[0] * SIZE[1]);
        assert_eq!(fetches[..3], [pixels, 0, 16 * functions * receivers]);
    }
}

/// Smaller kernels leave more bits for each value, and these allow larger exponents and
/// less moment bias.
#[test]
fn tables_have_as_many_bits_as_kernels_leave() {
    let scene = scene("cylinder");
    let of =
        |name: &str, set: &[&str], figure_name: &str| figure(&by(name, &scene, set), figure_name);
    let narrow = &["kernel=fixed", "taps=3"][..];
    let wide = &["kernel=fixed", "taps=64"][..];
    assert_eq!(of("vsm", narrow, "table-bits"), 24.0);
    assert_eq!(of("vsm", wide, "table-bits"), 20.0);
    assert!(of("evsm", narrow, "exponent") > of("evsm", wide, "exponent"));
    assert!(of("msm", narrow, "moment-bias") < of("msm", wide, "moment-bias"));
    assert_eq!(of("evsm", &["exponent=3"], "exponent"), 3.0);
}

/// More cells bring variance soft shadow maps nearer to the truth where kernels hold
/// more than two depths.
#[test]
fn cells_help_where_kernels_hold_several_depths() {
    for name in ["cylinder", "creature"] {
        let scene = scene(name);
        let truth = truth(&scene);
        let of = |set: &str| error("vssm", &scene, &truth, &[set]).rmse;
        let [one, many] = ["cells=1", "cells=4"].map(of);
        assert!(many < 0.9 * one, "{name}: {one} {many}");
    }
}

/// Where one bound over the whole kernel fails, since its mean is beyond the receiver or it
/// holds several depths, kernels cut into cells are nearer to the truth; elsewhere they
/// lose nothing.
#[test]
fn cells_mend_what_one_bound_gets_wrong() {
    for name in ["cylinder", "creature", "spheres"] {
        let scene = scene(name);
        let truth = truth(&scene);
        let of = |set: &str| -> Vec<f64> {
            let picture = by("vssm", &scene, &["horizon=on", set]);
            let pairs = picture.visibility.iter().zip(&truth.values);
            pairs.map(|(v, t)| (f64::from(*v) - t).abs()).collect()
        };
        let [one, many] = ["cells=1", "cells=4"].map(of);
        let mean = |wrong: bool| {
            let pairs = one
                .iter()
                .zip(&many)
                .filter(|(a, b)| !a.is_nan() && !b.is_nan());
            let own: Vec<_> = pairs.filter(|(a, _)| (**a > 0.15) == wrong).collect();
            let sum = own
                .iter()
                .fold([0.0, 0.0], |[x, y], (a, b)| [x + **a, y + **b]);
            (sum.map(|s| s / own.len() as f64), own.len())
        };
        let (([a, b], count), ([c, d], _)) = (mean(true), mean(false));
        println!("{name}: {count} pixels {a:.3} to {b:.3}, others {c:.4} to {d:.4}");
        assert!(
            count > 20 && b < 0.9 * a,
            "{name}: {count} pixels, {a} to {b}"
        );
        assert!(d < c + 2e-3, "{name}: {c} to {d}");
    }
}

/// What tables cannot hold is said: exponents beyond their bits, and objects that are in
/// their own mask.
#[test]
fn limits_are_told() {
    let scene = scene("cylinder");
    let told = |name: &str, set: &[&str], code: &str| {
        let warnings = by(name, &scene, set).warnings;
        warnings.iter().any(|w| w.code == code)
    };
    let beyond = "exponent-beyond-tables";
    assert!(!told("evsm", &[], beyond) && !told("evsm", &["exponent=3"], beyond));
    assert!(told("evsm", &["exponent=40"], beyond));
    let huge = by("evsm", &scene, &["exponent=1e300"]);
    assert!(huge.warnings.iter().any(|w| w.code == beyond));
    assert!(huge.warnings.iter().all(|w| w.code != "nan"));
    let casting = "receivers-that-cast";
    let one_mask = &["groups=all"][..];
    assert!(told("soler-sillion", one_mask, casting) && !told("vsm", &[], casting));
    assert!(!told("soler-sillion", &[], casting));
    let mut apart = scene.clone();
    apart
        .objects
        .iter_mut()
        .for_each(|o| o.receives &= !o.casts);
    let warnings = by("soler-sillion", &apart, one_mask).warnings;
    assert!(warnings.iter().all(|w| w.code != casting), "{warnings:?}");
}

#[test]
fn bad_parameters_are_refused() {
    let (scene, _) = plates(3.0);
    for (name, set, told) in [
        ("vsm", "taps=0", "1 to 64"),
        ("evsm", "exponent=0", "auto, or a number above 0"),
        ("msm", "moment-bias=-1", "auto, or a number from 0"),
        ("vssm", "cells=9", "1 to 8"),
        ("vssm", "kernel=fixed", "kernel"),
        ("vsm", "map-size=4096", "16 to 2048"),
    ] {
        let message = sized(name, &scene, &[set], SIZE).unwrap_err();
        assert!(message.contains(told), "{name} {set}: {message}");
    }
}
