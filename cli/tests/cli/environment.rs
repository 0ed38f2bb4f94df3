//! Environment lighting and animations on the command line.

use crate::common::Folder;
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

/// Saves a latitude-longitude map of `texel`.
fn map(folder: &Folder, name: &str, [w, h]: [u32; 2], texel: impl Fn(u32, u32) -> [f32; 3]) {
    let picture = image::ImageBuffer::from_fn(w, h, |x, y| image::Rgb(texel(x, y)));
    picture.save(folder.path(name)).unwrap();
}

/// Broken files: a message and exit code 2, whatever they claim to be.
#[test]
fn broken_maps_are_refused() {
    let folder = Folder::new("env-broken");
    let refused = |name: &str, parts: &[&str]| {
        folder
            .gnomon(&format!("render creature --size 16x16 --env {name}"))
            .refused(parts);
    };
    for name in ["whole.hdr", "whole.exr"] {
        map(&folder, name, [64, 32], |x, y| [(x * y) as f32; 3]);
        let bytes = std::fs::read(folder.path(name)).unwrap();
        for (k, share) in [1, 3, 6].into_iter().enumerate() {
            let cut = format!("cut{k}-{name}");
            std::fs::write(folder.path(&cut), &bytes[..bytes.len() * share / 8]).unwrap();
            refused(&cut, &[&cut]);
        }
        map(&folder, name, [8, 4], |_, _| [0.0; 3]);
        refused(name, &[name, "no light"]);
        map(&folder, name, [7, 4], |_, _| [1.0; 3]);
        refused(name, &["7x4", "2:1"]);
    }
    folder.write("empty.hdr", "");
    refused("empty.hdr", &["empty.hdr"]);
    // Far more texels than there are bytes.
    let header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 200000\n";
    folder.write("huge.hdr", header);
    refused("huge.hdr", &["huge.hdr"]);
    map(&folder, "dark.exr", [8, 4], |_, _| [f32::NAN, -1.0, 0.0]);
    refused("dark.exr", &["no light"]);
}

/// Maps with texels that are no radiance, and one of a single texel, give pictures:
/// finite, lit, and with a warning where something was mended.
#[test]
fn odd_maps_give_sensible_pictures() {
    let folder = Folder::new("env-odd");
    map(&folder, "odd.exr", [32, 16], |x, y| match (x, y) {
        (3, 4) => [f32::INFINITY, 1.0, 1.0],
        (4, 4) => [f32::NAN, 1.0, 1.0],
        (5, 4) => [-5.0, 1.0, 1.0],
        (20, 5) => [40.0; 3],
        _ => [0.5; 3],
    });
    map(&folder, "one.hdr", [1, 1], |_, _| [0.5; 3]);
    map(&folder, "strip.exr", [6, 1], |x, _| [x as f32 * 0.2; 3]);
    for (name, warnings) in [("odd.exr", 3), ("one.hdr", 0), ("strip.exr", 0)] {
        for technique in ["convolution-soft-shadows", "soft-shadow-volumes"] {
            let flags = format!("--env {name} --lights 8 --technique {technique} --size 40x30");
            let doc = folder
                .gnomon(&format!("render creature {flags} --out a.png --json"))
                .json();
            let of_map = |w: &&Value| {
                let code = w["code"].as_str().unwrap();
                assert_ne!(code, "nan", "{name} {technique}");
                let of_fit = ["environment-uncovered", "environment-ambient-limited"];
                code.starts_with("environment-") && !of_fit.contains(&code)
            };
            let found = doc["warnings"].as_array().unwrap().iter().filter(of_map);
            assert_eq!(found.count(), warnings, "{name} {technique}");
            let picture = image::open(folder.path("a.png")).unwrap().into_rgb8();
            let mean = picture.pixels().map(|p| u64::from(p[1])).sum::<u64>() / (40 * 30);
            assert!((20..250).contains(&mean), "{name} {technique}: {mean}");
        }
    }
}

/// Each frame is the single picture of its time, to the bit, with an environment
/// and without; and frames differ.
#[test]
fn frames_are_pictures_of_their_times() {
    let folder = Folder::new("frames");
    let soft = "--technique soft-shadow-volumes";
    let sky = format!("{SKY} --lights 6");
    for flags in [
        soft.to_owned(),
        format!("{soft} {sky}"),
        format!("--technique convolution-soft-shadows --set map-size=64 {sky}"),
    ] {
        let flags = format!("--size 56x42 {flags} --json");
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
            let frame = folder.pixels(&format!("f/frame-000{k}.png"));
            assert!(folder.pixels("single.png") == frame);
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
