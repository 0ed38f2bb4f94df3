//! PLY and glTF: the same model as OBJ has it.

use super::{codes, folder_of, hashes, render};
use crate::common::Folder;
use serde_json::{Value, json};

/// Points and faces of `base.obj`.
fn base() -> (Vec<Vec<String>>, Vec<Vec<usize>>) {
    let text = std::fs::read_to_string(super::fixture("base.obj")).unwrap();
    let rest = |line: &str| line.split_whitespace().skip(1).map(str::to_owned).collect();
    let of = |k: &'static str| text.lines().filter(move |l| l.starts_with(k));
    let index = |w: String| w.parse::<usize>().unwrap() - 1;
    let faces = of("f ")
        .map(rest)
        .map(|f: Vec<String>| f.into_iter().map(index).collect());
    (of("v ").map(rest).collect(), faces.collect())
}

fn ply(scalar: &str) -> String {
    let (points, faces) = base();
    let line = |words: &[String]| words.join(" ") + "\n";
    let face = |f: &Vec<usize>| {
        format!(
            "{} {}",
            f.len(),
            line(&f.iter().map(usize::to_string).collect::<Vec<_>>())
        )
    };
    let points: String = points.iter().map(|p| line(p)).collect();
    let faces: String = faces.iter().map(face).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty {scalar} x\nproperty {scalar} y\n\
         property {scalar} z\nelement face 6\nproperty list uchar int vertex_indices\n\
         end_header\n{points}{faces}"
    )
}

/// The file and its buffer.
fn gltf() -> (Value, Vec<u8>) {
    let (points, faces) = base();
    let floats = points
        .concat()
        .into_iter()
        .map(|w| w.parse::<f32>().unwrap());
    let mut buffer: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
    let fan = |f: &Vec<usize>| [f[0], f[1], f[2], f[0], f[2], f[3]];
    buffer.extend(faces.iter().flat_map(fan).map(|i| i as u8));
    let file = json!({
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5121, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 96},
            {"buffer": 0, "byteOffset": 96, "byteLength": 36},
        ],
        "buffers": [{"byteLength": 132, "uri": "part/my%20buffer.bin"}],
    });
    (file, buffer)
}

fn write_gltf(folder: &Folder, name: &str, file: &Value, buffer: &[u8]) {
    folder.write(name, &file.to_string());
    std::fs::create_dir_all(folder.path("part")).unwrap();
    std::fs::write(folder.path("part/my buffer.bin"), buffer).unwrap();
}

#[test]
fn all_formats_draw_the_same_to_the_bit() {
    let folder = folder_of("formats", &["base.obj"]);
    folder.write("d.ply", &ply("double"));
    folder.write("f.PLY", &ply("float"));
    let (file, buffer) = gltf();
    write_gltf(&folder, "g.gltf", &file, &buffer);
    let drawn = ["base.obj", "d.ply", "f.PLY", "g.gltf"].map(|f| render(&folder, f));
    // Decimals of OBJ are f64; f32 has other last bits.
    assert_eq!(hashes(&drawn[0]), hashes(&drawn[1]));
    assert_eq!(hashes(&drawn[2]), hashes(&drawn[3]));
    assert!(drawn.iter().all(|d| codes(d).is_empty()));
}

#[test]
fn scene_files_name_models_of_all_formats() {
    let folder = folder_of("formats-scene", &["base.obj"]);
    folder.write("d.ply", &ply("double"));
    let (mut file, buffer) = gltf();
    file["cameras"] = json!([{"perspective": {"yfov": 0.6, "znear": 0.1}}]);
    file["nodes"] = json!([{"mesh": 0}, {"camera": 0}]);
    write_gltf(&folder, "g.glTF", &file, &buffer);
    let scene = |mesh: &str| {
        format!(
            "[camera]\neye = [0, 3, 6]\ntarget = [0, 1, 0]\n[[lights]]\n\
             color = [1, 0.9, 0.8]\nshape.point = {{ position = [2, 6, 1] }}\n\
             [[objects]]\nmesh.plane = {{ half = 5 }}\n[[objects]]\n{mesh}\n"
        )
    };
    let draw = |name: &str, mesh: &str| {
        folder.write(name, &scene(mesh));
        render(&folder, name)
    };
    let obj = draw("a.toml", "mesh.obj = \"base.obj\"");
    let model = draw("b.toml", "mesh.model = \"base.obj\"");
    let ply = draw("c.toml", "mesh.model = \"d.ply\"");
    assert_eq!(hashes(&obj), hashes(&model));
    assert_eq!(hashes(&obj), hashes(&ply));
    let gltf = draw("d.toml", "mesh.model = \"g.glTF\"");
    assert_eq!(codes(&gltf), ["ignored-lights"]);
    folder.write("e.toml", &scene("mesh.model = \"x.stl\""));
    folder
        .gnomon("render e.toml")
        .refused(&["e.toml:10:14", "x.stl", ".gltf"]);
    let both = scene("mesh.obj = \"base.obj\"").replace("color = ", "colour = [1, 1, 1]\ncolor = ");
    folder.write("f.toml", &both);
    folder
        .gnomon("render f.toml")
        .refused(&["f.toml:4:", "duplicate"]);
}

#[test]
fn a_file_with_a_camera_is_drawn_from_there() {
    let folder = folder_of("formats-camera", &[]);
    let (mut file, buffer) = gltf();
    file["cameras"] = json!([{"perspective": {"yfov": 0.6, "znear": 0.1}}]);
    file["nodes"] = json!([
        {"mesh": 0, "name": "block"},
        {"camera": 0, "translation": [0, 1.2, 7]},
        {"translation": [2, 5, 4], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"children": [0, 1, 2]},
    ]);
    file["extensions"] =
        json!({"KHR_lights_punctual": {"lights": [{"type": "point", "color": [1, 0, 0]}]}});
    write_gltf(&folder, "own.gltf", &file, &buffer);
    let own = render(&folder, "own.gltf --out own.png");
    assert_eq!(codes(&own), ["light-units"]);
    let picture = image::open(folder.path("own.png")).unwrap().into_rgb8();
    // The block is in the middle, red where the light is; nothing is beside it.
    let [r, g, _] = picture.get_pixel(80, 60).0;
    assert!(r > 2 * g, "{r} {g}");
    assert_eq!(
        picture.get_pixel(3, 3),
        picture.get_pixel(3, 116),
        "no ground"
    );
}

#[test]
fn buffers_lie_in_the_models_folder() {
    let folder = folder_of("formats-outside", &[]);
    let (mut file, buffer) = gltf();
    std::fs::create_dir_all(folder.path("in")).unwrap();
    std::fs::write(folder.path("secret.bin"), &buffer).unwrap();
    file["buffers"][0]["uri"] = json!("../secret.bin");
    folder.write("in/m.gltf", &file.to_string());
    folder.gnomon("render in/m.gltf").refused(&[
        "m.gltf: buffers[0].uri",
        "outside the folder",
        "--allow-outside",
    ]);
    render(&folder, "in/m.gltf --allow-outside");
    file["buffers"][0]["uri"] = json!("none.bin");
    folder.write("in/m.gltf", &file.to_string());
    folder
        .gnomon("render in/m.gltf")
        .refused(&["buffers[0].uri", "cannot be read"]);
    folder.write("x.ply", "ply\nformat ascii 1.0\nend_header\n");
    folder
        .gnomon("render x.ply")
        .refused(&["x.ply: no faces", "vertex_indices"]);
}
