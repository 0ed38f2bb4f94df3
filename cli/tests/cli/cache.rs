//! What is computed ahead of frames and kept in a folder.

use std::fs;

use crate::common::Folder;

const RENDER: &str = "render creature --technique deferred-shadowing --size 48x36 --out a.png \
                      --visibility v.npy --json";

fn hashes(folder: &Folder, command: &str) -> (String, String) {
    let document = folder.gnomon(command).fine().json();
    (
        document["hash"]["visibility"].to_string(),
        document["warnings"].to_string(),
    )
}

/// Transport is written once, found again, and computed anew where a file is broken:
/// always with the same picture.
#[test]
fn transport_is_kept_and_found_again() {
    let folder = Folder::new("cache-transport");
    let (plain, _) = hashes(&folder, RENDER);
    let cached = format!("{RENDER} --cache kept");
    assert_eq!(hashes(&folder, &cached).0, plain);
    let kept = || -> Vec<(String, Vec<u8>)> {
        let entries = fs::read_dir(folder.path("kept")).unwrap();
        let mut all: Vec<_> = entries
            .map(|e| e.unwrap().path())
            .map(|p| (p.display().to_string(), fs::read(&p).unwrap()))
            .collect();
        all.sort();
        all
    };
    let first = kept();
    assert!(!first.is_empty());
    let (name, bytes) = &first[0];
    let mut broken = bytes.clone();
    *broken.last_mut().unwrap() ^= 1;
    fs::write(name, &broken).unwrap();
    let (again, warnings) = hashes(&folder, &cached);
    assert_eq!(again, plain);
    assert!(warnings.contains("computed anew"), "{warnings}");
    assert_eq!(kept(), first, "the broken file was replaced");
    let (again, warnings) = hashes(&folder, &cached);
    assert_eq!(again, plain);
    assert!(!warnings.contains("computed anew"), "{warnings}");
}
