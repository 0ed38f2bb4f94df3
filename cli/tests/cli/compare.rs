//! What `compare` prints, writes and refuses.

use crate::common::Folder;
use serde_json::Value;

const RESULT_KEYS: [&str; 12] = [
    "technique",
    "params",
    "rmse",
    "max",
    "p99",
    "mean",
    "rmse_penumbra",
    "psnr",
    "ssim",
    "flip",
    "time_ms",
    "bytes",
];

const PLATES: &str = "compare parallel-plates --size 64x48 --techniques";

/// The documents of two runs, but for times and where the truth came from.
fn without_times(mut doc: Value) -> Value {
    let top = doc.as_object_mut().unwrap();
    for key in ["cached", "reference_ms"] {
        assert!(top.remove(key).is_some());
    }
    for result in doc["results"].as_array_mut().unwrap() {
        assert!(result["time_ms"].as_f64().unwrap() > 0.0);
        result.as_object_mut().unwrap().remove("time_ms");
    }
    doc
}

#[test]
fn json_has_the_documented_keys() {
    let folder = Folder::new("compare-json");
    let doc = folder
        .gnomon(&format!(
            "{PLATES} unshadowed,shadow-volumes,sampled-shadow-volumes:samples=16 --json"
        ))
        .json();
    assert_eq!(
        (&doc["scene"], &doc["reference"]),
        (&"parallel-plates".into(), &"exact".into())
    );
    assert_eq!(
        (&doc["soft"], &doc["cached"]),
        (&true.into(), &false.into())
    );
    let results = doc["results"].as_array().unwrap();
    assert_eq!(results.len(), 3);
    for result in results {
        for key in RESULT_KEYS.iter().chain(&["shaded_fragments"]) {
            assert!(
                result.get(*key).is_some_and(|v| !v.is_null()),
                "no {key} in {result}"
            );
        }
        assert_eq!(result["params"]["light"], "0");
        let pixels = &result["pixels"];
        let count = |key: &str| pixels[key].as_u64().unwrap();
        assert_eq!(
            count("compared"),
            count("umbra") + count("penumbra") + count("lit")
        );
        assert!(count("penumbra") > 100);
    }
    assert_eq!(results[2]["params"]["samples"], "16");
    let rmse: Vec<f64> = results
        .iter()
        .map(|r| r["rmse"].as_f64().unwrap())
        .collect();
    assert!(
        rmse[0] > 1.5 * rmse[1] && rmse[1] > 2.0 * rmse[2],
        "{rmse:?}"
    );
    assert!(results[2]["bytes"].as_u64() > results[1]["bytes"].as_u64());
}

/// Every pixel is compared, or left out for one reason.
fn assert_pixels_add_up(result: &Value, size: [u64; 2]) {
    let pixels = &result["pixels"];
    let left_out = pixels["left_out"].as_object().unwrap();
    let count = |value: &Value| value.as_u64().unwrap();
    let sum: u64 = left_out.values().map(count).sum();
    assert_eq!(
        count(&pixels["compared"]) + sum,
        size[0] * size[1],
        "{pixels}"
    );
    let other = ["outline", "other_depth", "missing_surface", "extra_surface"];
    let other: u64 = other.iter().map(|key| count(&left_out[*key])).sum();
    assert_eq!(count(&pixels["other_surface"]), other, "{pixels}");
}

#[test]
fn pixels_add_up_with_every_reference() {
    let folder = Folder::new("compare-pixels");
    for size in [[64, 48], [7, 5], [1, 1]] {
        let compare = format!("compare cylinder --size {}x{} --json", size[0], size[1]);
        for rest in [
            "--techniques unshadowed,shadow-map,soft-shadow-volumes",
            "--techniques pcf --reference rays",
            "--techniques mixed-lights --env sky --lights 2,3 --directions 16",
        ] {
            let doc = folder.gnomon(&format!("{compare} {rest}")).json();
            for result in doc["results"].as_array().unwrap() {
                assert_pixels_add_up(result, size);
                let told = result["warnings"].to_string().contains("few-pixels");
                assert!(!told || size == [1, 1], "{result}");
            }
        }
    }
    let text = folder
        .gnomon("compare cylinder --size 64x48 --techniques pcf,shadow-map")
        .fine()
        .stdout();
    for row in [
        "pixels compared",
        "pixels left out",
        "  no surface",
        "  edge too near",
    ] {
        assert!(text.contains(row), "no {row} in {text}");
    }
}

/// Facets smaller than pixels: edges are near nearly everywhere, and errors of what is
/// left say little of the picture.
#[test]
fn a_comparison_of_few_pixels_is_warned_of() {
    let folder = Folder::new("compare-few");
    let compare = "compare fractal --size 8x6 --techniques pcf";
    let doc = folder.gnomon(&format!("{compare} --json")).json();
    let result = &doc["results"][0];
    let warnings = result["warnings"].as_array().unwrap();
    let few = warnings.iter().find(|w| w["code"] == "few-pixels-compared");
    let few = few.unwrap_or_else(|| panic!("{warnings:?}"));
    let pixels = &result["pixels"];
    assert!(pixels["left_out"]["outline"].as_u64() > pixels["compared"].as_u64());
    assert_eq!(few["count"], pixels["other_surface"]);
    assert!(few["message"].as_str().unwrap().contains("edge too near ("));
    let text = folder.gnomon(compare).fine().stdout();
    let line = "warning: pcf: few-pixels-compared: ";
    assert!(text.contains(line), "{text}");
}

/// The same figure as `render` has, and none where there are no wedges.
#[test]
fn work_of_wedges_is_told() {
    let folder = Folder::new("compare-wedges");
    let both = format!("{PLATES} shadow-volumes,soft-shadow-volumes");
    let doc = folder.gnomon(&format!("{both} --json")).json();
    assert!(doc["results"][0]["wedge_work"].is_null());
    let work = &doc["results"][1]["wedge_work"];
    assert!(
        (1.0..1.3).contains(&work["ratio"].as_f64().unwrap()),
        "{work}"
    );
    assert!(work["shaded"].as_u64() > work["covering"].as_u64());
    let render = "render parallel-plates --size 64x48 --technique soft-shadow-volumes --json";
    assert_eq!(folder.gnomon(render).json()["wedge_work"], *work);
    assert!(
        folder
            .gnomon(&both)
            .stdout()
            .contains("over penumbra pairs")
    );
}

#[test]
fn the_second_time_the_truth_is_read_and_the_same() {
    let folder = Folder::new("compare-cache");
    let run = || {
        folder
            .gnomon(&format!("{PLATES} shadow-volumes --json"))
            .json()
    };
    let cache = folder.path("out/oracle-cache");
    let first = run();
    let files = || -> Vec<_> {
        let entries = std::fs::read_dir(&cache).unwrap().map(|e| e.unwrap());
        let read = |e: std::fs::DirEntry| {
            let changed = e.metadata().unwrap().modified().unwrap();
            (e.path(), std::fs::read(e.path()).unwrap(), changed)
        };
        entries.map(read).collect()
    };
    let kept = files();
    let picture = std::fs::read(folder.path("out/parallel-plates-compare.png")).unwrap();
    let second = run();
    assert_eq!(
        (&first["cached"], &second["cached"]),
        (&false.into(), &true.into())
    );
    assert!(first["reference_ms"].as_f64().unwrap() > 0.0 && second["reference_ms"].is_null());
    assert_eq!(kept.len(), 1);
    assert!(files() == kept, "the cache was written again");
    assert_eq!(without_times(first), without_times(second));
    let again = std::fs::read(folder.path("out/parallel-plates-compare.png")).unwrap();
    assert!(again == picture);
}

#[test]
fn the_table_fits_a_terminal_and_the_picture_shows_all() {
    let folder = Folder::new("compare-table");
    let all = "unshadowed,shadow-volumes,sampled-shadow-volumes:samples=16:pattern=rotated-grid,\
        sampled-shadow-volumes:samples=16:accumulation=r16f,sampled-shadow-volumes:samples=4";
    let run = folder
        .gnomon(&format!("{PLATES} {all} --set shadow-volumes.method=zfail"))
        .fine();
    let text = run.stdout();
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    for part in [
        "RMSE",
        "PSNR",
        "rotated-grid",
        "method=zfail",
        "computed in",
        "wrote ",
    ] {
        assert!(text.contains(part), "no {part} in {text}");
    }
    assert!(run.stderr().is_empty());
    let picture = image::open(folder.path("out/parallel-plates-compare.png")).unwrap();
    // Two rows of three columns, each with two pictures.
    assert!(picture.width() >= 3 * 64 && picture.height() > 4 * 48);
}

#[test]
fn one_light_shines_at_a_time() {
    let folder = Folder::new("compare-lights");
    let lights = "[[lights]]\nshape.square = { centre = [2, 4, 1], side = 1.0 }\n\
        [[lights]]\nshape.point = { position = [-2, 4, 1] }\n";
    let rest = "[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n\
        [[objects]]\nmesh.plane = { half = 4.0 }\n\
        [[objects]]\nmesh.box = { size = [1, 1, 1] }\n";
    folder.write("two.toml", &format!("{lights}{rest}"));
    let compare = "compare two.toml --size 48x36 --techniques shadow-volumes --json";
    let soft = folder.gnomon(compare).json();
    let hard = folder.gnomon(&format!("{compare} --light 1")).json();
    assert_eq!(
        (&soft["soft"], &hard["soft"]),
        (&true.into(), &false.into())
    );
    assert_eq!(
        (&hard["light"], &hard["results"][0]["params"]["light"]),
        (&1.into(), &"1".into())
    );
    assert!(hard["results"][0]["rmse_penumbra"].is_null());
    assert_ne!(soft["results"][0]["hash"], hard["results"][0]["hash"]);
}

#[test]
fn rays_are_a_second_opinion() {
    let folder = Folder::new("compare-rays");
    let compare = "compare cylinder --size 24x18 --techniques sampled-shadow-volumes --json";
    let exact = folder.gnomon(compare).json();
    let rays = folder.gnomon(&format!("{compare} --reference rays")).json();
    assert_eq!(rays["reference"], "rays");
    let rmse = |doc: &Value| doc["results"][0]["rmse"].as_f64().unwrap();
    assert!((rmse(&exact) - rmse(&rays)).abs() < 0.003 && rmse(&exact) != rmse(&rays));
}

#[test]
fn bad_input_is_refused_and_leaves_nothing() {
    let folder = Folder::new("compare-bad");
    let refused = |arguments: &str, parts: &[&str]| {
        folder.gnomon(arguments).refused(parts);
        assert!(folder.names().is_empty(), "{arguments}");
    };
    let t = "--techniques shadow-volumes";
    refused(
        "compare cylinder --techniques shadow-volume",
        &["did you mean 'shadow-volumes'"],
    );
    refused("compare cylinder --techniques unshadowed,,", &["NAME"]);
    refused(
        "compare cylinder --techniques unshadowed:shading",
        &["KEY=VALUE"],
    );
    refused(
        "compare cylinder --techniques unshadowed:shading=flat",
        &["flat", "phong|lambert"],
    );
    refused(
        "compare cylinder --techniques unshadowed --size 8x8 --out-dir /proc",
        &["/proc"],
    );
    refused(
        &format!("compare cilinder {t}"),
        &["did you mean 'cylinder'"],
    );
    refused(
        &format!("compare cylinder {t} --light 3"),
        &["light 3", "has 1"],
    );
    refused(&format!("compare cylinder {t}:light=0"), &["--light N"]);
    refused(
        &format!("compare cylinder {t} --set method=zfail"),
        &["TECHNIQUE.KEY=VALUE"],
    );
    refused(
        &format!("compare cylinder {t} --set shadow-volumes.methd=zfail"),
        &["'method'"],
    );
    refused(
        &format!("compare cylinder {t} --set unshadowed.shading=phong"),
        &["unshadowed", "not among --techniques"],
    );
    refused(
        &format!("compare cylinder {t} --reference truth"),
        &["truth", "exact, rays"],
    );
    refused(
        &format!("compare cylinder {t} --size 0x4"),
        &["WIDTHxHEIGHT"],
    );
}

#[test]
fn sample_counts_that_are_no_squares_are_refused() {
    let folder = Folder::new("compare-squares");
    let run =
        folder.gnomon("compare cylinder --size 8x8 --techniques sampled-shadow-volumes:samples=17");
    run.refused(&["samples", "17", "square numbers"]);
}
