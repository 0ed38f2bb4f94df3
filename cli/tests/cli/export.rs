//! Scenes written for other programs, and renders held against earlier ones.

use std::path::Path;

use serde_json::Value;

use crate::common::Folder;

fn render(folder: &Folder, scene: &str, more: &str) -> Value {
    let size = "--size 96x72 --json --technique soft-shadow-volumes";
    folder
        .gnomon(&format!("render {scene} {size} {more}"))
        .json()
}

/// Largest and mean difference of two pictures' channels, of 255.
fn difference(folder: &Folder, a: &str, b: &str) -> (u8, f64) {
    let [a, b] = [a, b].map(|name| image::open(folder.path(name)).unwrap().into_rgb8());
    let pairs = a.as_raw().iter().zip(b.as_raw());
    let each: Vec<u8> = pairs.map(|(a, b)| a.abs_diff(*b)).collect();
    let sum: f64 = each.iter().map(|d| f64::from(*d)).sum();
    (each.iter().copied().max().unwrap(), sum / each.len() as f64)
}

/// The files of `scene` in the folder `e`, named in the document.
fn export(folder: &Folder, scene: &str) -> Value {
    folder
        .gnomon(&format!("export {scene} --out-dir e --size 96x72 --json"))
        .json()
}

#[test]
fn a_scene_file_is_read_back_with_the_same_visibility_to_the_bit() {
    let folder = Folder::new("export-toml");
    for scene in ["cylinder", "demo", "spheres", "peer-a"] {
        export(&folder, scene);
        let [own, read] = [scene.to_owned(), format!("e/{scene}.toml")];
        let [own, read] = [(own, "a.png"), (read, "b.png")]
            .map(|(s, out)| render(&folder, &s, &format!("--out {out}")));
        assert_eq!(
            own["hash"]["visibility"], read["hash"]["visibility"],
            "{scene}"
        );
        // Normals may be formed in another order.
        let (largest, _) = difference(&folder, "a.png", "b.png");
        assert!(largest <= 1, "{scene}: {largest}");
    }
}

#[test]
fn gltf_is_read_back_as_nearly_the_same_picture() {
    let folder = Folder::new("export-glb");
    for scene in ["cylinder", "peer-a"] {
        export(&folder, scene);
        render(&folder, scene, "--out a.png --visibility a.npy");
        render(
            &folder,
            &format!("e/{scene}.glb"),
            "--out b.png --visibility b.npy",
        );
        let [a, b] = ["a.npy", "b.npy"].map(|f| visibility(&folder.path(f)));
        // Geometry has the same bits; camera and light the same but for rounding.
        let far = a
            .iter()
            .zip(&b)
            .filter(|(a, b)| (**a - **b).abs() > 0.01)
            .count();
        assert!(far * 500 < a.len(), "{scene}: {far} of {}", a.len());
        assert!(
            a.iter().any(|v| *v > 0.0 && *v < 1.0),
            "a penumbra is compared"
        );
    }
}

/// The values of an array of float32; NaN as -1.
fn visibility(path: &Path) -> Vec<f32> {
    let bytes = std::fs::read(path).unwrap();
    let data = &bytes[bytes.len() - 96 * 72 * 4..];
    let value = |b: &[u8; 4]| f32::from_le_bytes(*b);
    let values = data.as_chunks::<4>().0.iter().map(value);
    values.map(|v| if v.is_nan() { -1.0 } else { v }).collect()
}

#[test]
fn the_description_has_camera_lights_and_matrices() {
    let folder = Folder::new("export-json");
    let document = export(&folder, "cylinder");
    let names: Vec<&str> = document["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["path"].as_str().unwrap())
        .collect();
    assert_eq!(names[0], "e/cylinder.json");
    assert!(names.contains(&"e/cylinder.glb") && names.contains(&"e/cylinder-1.obj"));
    let text = std::fs::read_to_string(folder.path("e/cylinder.json")).unwrap();
    let described: Value = serde_json::from_str(&text).unwrap();
    assert!(described["lights"][0]["shape"]["rectangle"]["centre"].is_array());
    let matrix = &described["clip_from_world"];
    let row = |r: usize| [0, 1, 2, 3].map(|c: usize| matrix[r][c].as_f64().unwrap());
    let triple = |v: &Value| [0, 1, 2].map(|k: usize| v[k].as_f64().unwrap());
    let target = triple(&described["camera"]["target"]);
    let at = |r: usize| {
        row(r)[..3]
            .iter()
            .zip(target)
            .map(|(m, p)| m * p)
            .sum::<f64>()
            + row(r)[3]
    };
    // The target is in the middle of the picture, before the eye.
    assert!(at(0).abs() < 1e-5 && at(1).abs() < 1e-5 && at(3) > 0.0);
    let only = folder
        .gnomon("export cylinder --out-dir g --format gltf --json")
        .json();
    assert_eq!(only["files"].as_array().unwrap().len(), 2);
    folder.write("file", "x");
    folder
        .gnomon("export cylinder --out-dir file")
        .refused(&["--out-dir"]);
    folder
        .gnomon("export nowhere --out-dir h")
        .refused(&["nowhere"]);
    let sphere = "[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n[[lights]]\n\
        shape.sphere = { centre = [0, 5, 0], radius = 1 }\n[[objects]]\nmesh.plane = { half = 1 }\n";
    folder.write("s.toml", sphere);
    let told = folder.gnomon("export s.toml --out-dir s --json").json();
    assert_eq!(told["warnings"][0]["code"], "lights-as-points");
}

#[test]
fn renders_are_held_against_earlier_ones() {
    let folder = Folder::new("expect");
    let line = "render cylinder --size 48x36";
    let baseline = folder
        .gnomon(&format!("{line} --json --threads 1 --tile 32"))
        .fine()
        .stdout();
    folder.write("b.json", &baseline);
    // However it is executed.
    let same = folder
        .gnomon(&format!(
            "{line} --threads 2 --tile 64 --repeat 2 --expect b.json"
        ))
        .fine();
    assert!(
        same.stdout().contains("as b.json has it"),
        "{}",
        same.stdout()
    );
    let quiet = folder.gnomon(&format!("{line} --set method=zfail --expect b.json -q"));
    assert!(quiet.code() == 1 && quiet.stdout().contains("method"));
    let other = folder.gnomon(&format!("{line} --set method=zfail --expect b.json"));
    assert_eq!(other.code(), 1);
    let text = other.stdout();
    assert!(
        text.contains("differs from b.json")
            && text.contains("params.method: \"auto\", now \"zfail\""),
        "{text}"
    );
    assert!(text.contains("totals.fragments.generated: "), "{text}");
    let changed = baseline.replacen("\"color\": \"", "\"color\": \"0", 1);
    folder.write("c.json", &changed);
    let run = folder.gnomon(&format!("{line} --json --expect c.json"));
    assert_eq!(run.code(), 1);
    assert!(
        run.stderr().contains("hash.color: ") && run.stderr().contains("in 1 values"),
        "{}",
        run.stderr()
    );
    assert!(run.stdout().starts_with('{'));
    folder.write("bad.json", "{\"hash\": {}}");
    for (file, part) in [
        ("bad.json", "no hashes"),
        ("none.json", "cannot be read"),
        (".", "regular files"),
    ] {
        folder
            .gnomon(&format!("{line} --expect {file}"))
            .refused(&[part]);
    }
}
