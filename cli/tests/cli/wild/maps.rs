//! Environment maps.

use std::path::Path;
use std::time::{Duration, Instant};

use super::{codes, fixture, folder_of};
use serde_json::Value;

const RENDER: &str = "render creature --lights 6 --size 96x72 --json --env";

fn lit_by(folder: &crate::common::Folder, map: &str) -> Value {
    folder.gnomon(&format!("{RENDER} {map}")).json()
}

#[test]
fn the_same_radiance_gives_the_same_picture() {
    let same = [
        "hdr-rgbe-magic.hdr",
        "hdr-exposure2.hdr",
        "hdr-colorcorr.hdr",
    ];
    let folder = folder_of("hdr", &[&["hdr-base.hdr"], &same[..]].concat());
    let base = lit_by(&folder, "hdr-base.hdr");
    for map in same {
        let other = lit_by(&folder, map);
        assert_eq!(base["hash"]["color"], other["hash"]["color"], "{map}");
        assert_eq!(codes(&base), codes(&other), "{map}");
    }
    let bytes = std::fs::read(fixture("hdr-base.hdr")).unwrap();
    let header_end = bytes.windows(2).position(|w| w == b"\n\n").unwrap();
    let rest = &bytes[header_end..];
    let header = |text: &str| [text.as_bytes(), rest].concat();
    for (name, text) in [
        ("mark.hdr", "\u{feff}#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r"),
        ("bare.hdr", "#?RGBE"),
        (
            "more.hdr",
            "#?RADIANCE\n# EXPOSURE=7\nEXPOSURE=0.5\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2",
        ),
    ] {
        std::fs::write(folder.path(name), header(text)).unwrap();
        let other = lit_by(&folder, name);
        assert_eq!(base["hash"]["color"], other["hash"]["color"], "{name}");
    }
    std::fs::write(
        folder.path("p.hdr"),
        header("#?RGBE\nPRIMARIES=0 0 1 0 0 1 1 1"),
    )
    .unwrap();
    assert!(codes(&lit_by(&folder, "p.hdr")).contains(&"ignored-header"));
}

/// Files that asked for 26 and 184 GB, or took seconds, where they are at hand.
#[test]
fn small_files_neither_exhaust_memory_nor_take_long() {
    let folder = folder_of("exr", &[]);
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/wild/attack");
    let Ok(files) = std::fs::read_dir(&shared) else {
        eprintln!("no shared files: nothing checked");
        return;
    };
    let mut checked = 0;
    for file in files.map(|f| f.unwrap().path()) {
        if file.extension().is_none_or(|e| e != "exr") {
            continue;
        }
        let start = Instant::now();
        folder
            .gnomon(&format!("render creature --env {}", file.display()))
            .refused(&["environment map"]);
        let took = start.elapsed();
        assert!(
            took < Duration::from_millis(1500),
            "{}: {took:?}",
            file.display()
        );
        checked += 1;
    }
    assert!(checked > 0, "no .exr in {}", shared.display());
}
