//! Solids that touch along edges and at corners.

use std::fmt::Write as _;

use super::{codes, folder_of, hashes, render};
use crate::common::Folder;

/// Unit cubes at these places, corners shared.
fn cubes(places: &[[i32; 3]]) -> String {
    let mut text = String::new();
    for (k, [x, y, z]) in places.iter().enumerate() {
        for corner in 0..8 {
            let [dx, dy, dz] = [0, 1, 2].map(|axis| corner >> axis & 1);
            writeln!(text, "v {} {} {}", x + dx, y + dy, z + dz).unwrap();
        }
        for face in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            let [a, b, c, d] = face.map(|i| 8 * k + i + 1);
            writeln!(text, "f {a} {b} {c} {d}").unwrap();
        }
    }
    text
}

/// Hard shadows are those of the silhouette that is right for any mesh; soft ones are
/// as near the truth as for other solids.
#[track_caller]
fn check(folder: &Folder, file: &str) {
    let document = render(folder, file);
    assert_eq!(codes(&document), [""; 0], "{file}");
    let any = render(folder, &format!("{file} --set open-casters=generalised"));
    assert_eq!(hashes(&document)[0], hashes(&any)[0], "{file}");
    let compared = folder
        .gnomon(&format!(
            "compare {file} --techniques soft-shadow-volumes,soft-shadow-volumes-optimised,\
             penumbra-wedges,penumbra-wedges-restructured --size 80x60 --json"
        ))
        .json();
    for result in compared["results"].as_array().unwrap() {
        let technique = result["technique"].as_str().unwrap();
        let most = if technique.starts_with("soft") {
            0.01
        } else {
            0.05 // spheres round square lights
        };
        let rmse = result["rmse"].as_f64().unwrap();
        assert!(rmse < most, "{file} {technique}: {rmse}");
    }
}

#[test]
fn solids_that_share_an_edge_cast() {
    let folder = folder_of("edge4", &["edge4.obj"]);
    check(&folder, "edge4.obj");
    for (name, places) in [
        ("corner", &[[0, 0, 0], [1, 1, 1]][..]),
        ("edge", &[[0, 0, 0], [1, 1, 0]]),
        ("face", &[[0, 0, 0], [1, 0, 0]]),
        ("board", &[[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]]),
    ] {
        let file = format!("{name}.obj");
        folder.write(&file, &cubes(places));
        check(&folder, &file);
    }
}
