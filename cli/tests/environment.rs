//! Environment lighting and animations on the command line.

mod common;

use common::Folder;
use serde_json::Value;

const SKY: &str = "--env sky --env-side 48";

#[test]
fn a_fresh_machine_has_a_sky() {
    let folder = Folder::new("env-sky");
    let doc = folder
        .gnomon(&format!(
            "render creature {SKY} --lights 12 --technique unshadowed --size 48x36 --out a.png --overlay env-lights --json"
        ))
        .json();
    let lit = |p: &&Value| p["name"].as_str().unwrap().starts_with("lit ");
    let passes = doc["passes"].as_array().unwrap();
    assert!((9..=12).contains(&passes.iter().filter(lit).count()));
    assert_eq!(folder.names(), ["a-env-lights.png", "a.png"]);
    let overlay = image::open(folder.path("a-env-lights.png"))
        .unwrap()
        .into_rgb8();
    assert!(overlay.width() >= 4 * 192);
    let green = overlay
        .pixels()
        .filter(|p| p[1] > 150 && p[0] < 120 && p[2] < 140);
    assert!(green.count() > 500, "no light is outlined");
    let summary = folder
        .gnomon(&format!(
            "render creature {SKY} --lights 30 --technique unshadowed --size 32x24 --out b.png"
        ))
        .fine();
    assert!(summary.stdout().contains("lit x"), "{}", summary.stdout());
}

#[test]
fn bad_environments_are_refused() {
    let folder = Folder::new("env-bad");
    let refused = |flags: &str, parts: &[&str]| {
        folder
            .gnomon(&format!("render creature --size 16x16 {flags}"))
            .refused(parts);
    };
    refused("--env nowhere.hdr", &["nowhere.hdr"]);
    refused("--env sky --lights 0", &["1 to 1024"]);
    refused(
        "--env sky --env-threshold 2",
        &["threshold is 2", "above 0 and below 1"],
    );
    refused("--env sky --env-form round", &["square", "rectangle"]);
    refused("--env sky --env-brightness 0", &["brightness is 0"]);
    refused("--lights 30", &["--env"]);
    refused("--overlay env-lights", &["env-lights", "--env MAP"]);
    folder.write("text.hdr", "not a map");
    refused("--env text.hdr", &["text.hdr"]);
    refused("--frames 2 --out a.png", &["a.png", "folder"]);
    refused("--frames 2 --visibility a.npy", &["a.npy", "--time"]);
    refused("--frames 0", &["--frames"]);
    refused("--time inf", &["finite"]);
    refused("--frames 2 --fps 0", &["above 0"]);
    assert_eq!(folder.names(), ["text.hdr"]);
}

/// Each frame is the single picture of its time, to the bit, with an environment
/// and without; and frames differ.
#[test]
fn frames_are_pictures_of_their_times() {
    let folder = Folder::new("frames");
    for flags in [String::new(), format!("{SKY} --lights 6")] {
        let flags = format!("--technique soft-shadow-volumes --size 56x42 {flags} --json");
        let run = |more: &str| folder.gnomon(&format!("render walk {flags} {more}")).json();
        let all = run("--frames 3 --fps 4 --time 0.5 --out f");
        let frames = all["frames"].as_array().unwrap();
        assert_eq!(frames.len(), 3);
        let mut hashes = Vec::new();
        for (k, frame) in frames.iter().enumerate() {
            assert_eq!(
                (&frame["frame"], &frame["time"]),
                (&k.into(), &(0.5 + 0.25 * k as f64).into())
            );
            let single = run(&format!("--time {} --out single.png", frame["time"]));
            for key in ["hash", "passes", "warnings"] {
                assert_eq!(frame["render"][key], single[key], "{k}: {key}");
            }
            let [a, b] = [
                folder.path("single.png"),
                folder.path(&format!("f/frame-000{k}.png")),
            ];
            assert!(std::fs::read(a).unwrap() == std::fs::read(b).unwrap());
            hashes.push(single["hash"]["color"].to_string());
        }
        hashes.dedup();
        assert_eq!(hashes.len(), 3);
    }
}

#[test]
fn environments_are_compared_with_sampled_directions() {
    let folder = Folder::new("env-compare");
    let flags =
        "--size 48x36 --directions 256 --techniques unshadowed,soft-shadow-volumes --lights 6,20";
    let run = || {
        folder
            .gnomon(&format!("compare creature {SKY} {flags} --json"))
            .json()
    };
    let doc = run();
    assert_eq!(
        (&doc["reference"], &doc["directions"]),
        (&"directions".into(), &256.into())
    );
    let results = doc["results"].as_array().unwrap();
    assert_eq!(results.len(), 4);
    let keys = [
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
        "shaded_fragments",
        "lights",
        "residual_share",
    ];
    for result in results {
        for key in keys {
            assert!(result.get(key).is_some(), "no {key}");
        }
    }
    let rmse = |k: usize| results[k]["rmse"].as_f64().unwrap();
    assert!(
        rmse(3) < rmse(2) && rmse(3) < rmse(1),
        "{} {} {}",
        rmse(1),
        rmse(2),
        rmse(3)
    );
    assert!(
        folder
            .path("out/creature-compare-environment.png")
            .is_file()
    );
    let again = run();
    for (a, b) in results.iter().zip(again["results"].as_array().unwrap()) {
        assert_eq!((&a["rmse"], &a["hash"]), (&b["rmse"], &b["hash"]));
    }
    let table = folder
        .gnomon(&format!("compare creature {SKY} {flags}"))
        .fine();
    let wide = |l: &str| !l.starts_with("warning") && l.chars().count() > 100;
    assert!(!table.stdout().lines().any(wide), "{}", table.stdout());
    folder
        .gnomon("compare creature --techniques unshadowed --lights 30")
        .refused(&["--env"]);
}
