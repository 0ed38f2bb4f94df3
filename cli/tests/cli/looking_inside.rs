//! `light`, `wedge`, and the overlays of what soft shadow volumes add up.

use crate::common::Folder;

/// What is listed adds up to what is told, and for one loop that is the truth.
#[test]
fn contributions_of_a_pixel_add_up_to_its_visibility() {
    let folder = Folder::new("light-sum");
    let mut penumbra = 0;
    for x in (0..64).step_by(5) {
        let document = folder
            .gnomon(&format!(
                "light parallel-plates --pixel {x} 24 --size 64x48 --json"
            ))
            .json();
        let edges = document["edges"].as_array().unwrap();
        let added: f64 = edges
            .iter()
            .map(|e| e["contribution"].as_f64().unwrap())
            .sum();
        let hidden = document["centre_hidden"].as_f64().unwrap();
        let sum = document["sum"].as_f64().unwrap();
        assert!((1.0 - hidden + added - sum).abs() < 1e-12, "{document}");
        if document["receiver"]["object"] != "occluder" {
            let exact = document["exact"].as_f64().unwrap();
            assert!((sum - exact).abs() < 1e-9, "{document}");
            penumbra += usize::from(exact > 0.0 && exact < 1.0);
        }
        for edge in edges {
            let sign = if edge["side"] == "umbra" { 1.0 } else { -1.0 };
            let coverage = edge["coverage"].as_f64().unwrap();
            assert_eq!(edge["contribution"].as_f64(), Some(sign * coverage));
        }
    }
    assert!(penumbra > 0);
}

#[test]
fn a_wedge_adds_at_its_pixels_what_the_light_says() {
    let folder = Folder::new("wedge-map");
    let list = folder.gnomon("wedge parallel-plates --json").json();
    assert_eq!(list["edges"].as_array().unwrap().len(), 4);
    let document = folder
        .gnomon("wedge parallel-plates --edge 2 --size 64x48 --out w.png --coverage c.npy --json")
        .json();
    assert_eq!(document["wedges"].as_array().unwrap().len(), 1);
    let planes = document["wedges"][0]["planes"].as_array().unwrap();
    assert!(planes.len() >= 4, "{planes:?}");
    let bytes = std::fs::read(folder.path("c.npy")).unwrap();
    let data = &bytes[bytes.len() - 64 * 48 * 8..];
    let values: Vec<f64> = data
        .as_chunks()
        .0
        .iter()
        .map(|b| f64::from_le_bytes(*b))
        .collect();
    let strongest = (0..values.len())
        .filter(|i| !values[*i].is_nan())
        .max_by(|a, b| values[*a].abs().total_cmp(&values[*b].abs()))
        .unwrap();
    assert!(values[strongest].abs() > 0.1);
    let light = folder
        .gnomon(&format!(
            "light parallel-plates --pixel {} {} --size 64x48 --json",
            strongest % 64,
            strongest / 64
        ))
        .json();
    let edges = light["edges"].as_array().unwrap();
    let edge = edges.iter().find(|e| e["edge"] == 2).unwrap();
    assert_eq!(edge["contribution"].as_f64(), Some(values[strongest]));
    let picture = image::open(folder.path("w.png")).unwrap();
    assert_eq!(picture.width(), 280);
}

#[test]
fn a_light_is_drawn_with_its_edges() {
    let folder = Folder::new("light-picture");
    folder
        .gnomon("light spheres --pixel 30 40 --size 64x48 --out l.png")
        .fine();
    let picture = image::open(folder.path("l.png")).unwrap().to_rgb8();
    let count = |colour: [u8; 3]| picture.pixels().filter(|p| p.0 == colour).count();
    assert!(count([255, 244, 214]) > 1000, "the light");
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let folder = Folder::new("light-refused");
    let refused = |command: &str, said: &[&str]| folder.gnomon(command).refused(said);
    refused(
        "light spheres --pixel 64 0 --size 64x48",
        &["--pixel", "64 0", "columns 0 to 63"],
    );
    refused(
        "light spheres --pixel 1 2 --light 7",
        &["light 7", "0 to 0"],
    );
    refused("light columns --pixel 1", &["--pixel"]);
    refused("wedge spheres --edge 99999", &["--edge", "99999", "0 to"]);
    refused("wedge spheres --out a.png", &["--edge"]);
    refused("wedge spheres --edge 1 --out a.gif", &["--out", "png"]);
}

/// Plates overlap nowhere and their sum is the truth; `overlap` and `single-silhouette`
/// are what their names say.
#[test]
fn artefacts_have_the_causes_that_scenes_are_made_for() {
    let folder = Folder::new("artefacts");
    let painted = |scene: &str, colour: [u8; 3]| {
        folder
            .gnomon(&format!(
                "render {scene} --size 120x80 --technique soft-shadow-volumes \
                 --overlay overlap,saturation,artefacts --out a.png"
            ))
            .fine();
        let picture = image::open(folder.path("a-artefacts.png"))
            .unwrap()
            .to_rgb8();
        let near = |p: &image::Rgb<u8>| {
            let strength = |c: usize| f32::from(p.0[c]) / f32::from(colour[c].max(1));
            // Mixed with a dimmed picture: hues stay apart.
            (0..3).all(|c| colour[c] == 0 || (0.4..1.4).contains(&strength(c)))
                && p.0[0].abs_diff(p.0[1]) > 40
        };
        let rows = picture.rows().take(80);
        rows.flatten().filter(|p| near(p)).count()
    };
    assert_eq!(painted("parallel-plates", [0, 114, 178]), 0);
    assert!(painted("overlap", [0, 114, 178]) > 20);
    assert!(painted("single-silhouette", [230, 159, 0]) > 20);
}
