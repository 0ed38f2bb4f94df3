//! Models with pictures on them, from the command line.

use crate::common::Folder;

const SQUARE: &str = "mtllib a.mtl\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv 0 1 0\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl wood\nf 1/1 4/4 3/3 2/2\nf 1/1 2/2 5/3\n\
    f 2/1 3/2 5/3\nf 3/1 4/2 5/3\nf 4/1 1/2 5/3\n";

fn folder(name: &str, library: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("a.obj", SQUARE);
    folder.write("a.mtl", library);
    let texel = |x: u32, y: u32| image::Rgb([(x * 60) as u8, (y * 60) as u8, 200]);
    let picture = image::RgbImage::from_fn(4, 4, texel);
    picture.save(folder.path("wood.png")).unwrap();
    folder
}

#[test]
fn textures_are_drawn_and_counted_and_survive_an_export() {
    let folder = folder("textured", "newmtl wood\nmap_Kd wood.png\n");
    let draw = |scene: &str| {
        let line = format!("render {scene} --technique unshadowed --size 48x36 --out a.png --json");
        folder.gnomon(&line).json()
    };
    let textured = draw("a.obj");
    let read = |doc: &serde_json::Value| {
        let clients = doc["totals"]["traffic"].as_object().unwrap();
        let of = |(name, t): (&String, &serde_json::Value)| {
            let texture = name.starts_with("tex");
            texture.then(|| t["read_bytes"].as_u64().unwrap())
        };
        clients.iter().filter_map(of).sum::<u64>()
    };
    assert!(read(&textured) > 0, "{}", textured["totals"]["traffic"]);
    assert_eq!(textured["warnings"], serde_json::json!([]));
    folder.write("a.mtl", "newmtl wood\nKd 1 1 1\n");
    let plain = draw("a.obj");
    assert_eq!(read(&plain), 0);
    assert_ne!(plain["hash"]["color"], textured["hash"]["color"]);
    folder.write("a.mtl", "newmtl wood\nmap_Kd wood.png\n");
    folder
        .gnomon("export a.obj --size 48x36 --out-dir e")
        .fine();
    assert_eq!(
        draw("e/a.toml")["hash"]["visibility"],
        textured["hash"]["visibility"]
    );
    assert!(read(&draw("e/a.glb")) > 0);
}

#[test]
fn pictures_elsewhere_are_not_opened_unless_they_may_be() {
    let folder = folder("textured-outside", "newmtl wood\nmap_Kd ../wood.png\n");
    std::fs::create_dir(folder.path("in")).unwrap();
    for name in ["a.obj", "a.mtl"] {
        std::fs::rename(folder.path(name), folder.path(&format!("in/{name}"))).unwrap();
    }
    let warnings = |flags: &str| {
        let line = format!("render in/a.obj --size 32x24 --out a.png --json {flags}");
        folder.gnomon(&line).json()["warnings"].clone()
    };
    let refused = warnings("");
    assert_eq!(refused[0]["code"], "missing-maps");
    let message = refused[0]["message"].as_str().unwrap();
    assert!(
        message.contains("../wood.png") && message.contains("--allow-outside"),
        "{message}"
    );
    assert_eq!(warnings("--allow-outside"), serde_json::json!([]));
}

#[test]
fn textures_of_scene_files_are_errors_where_they_cannot_be() {
    let folder = folder("textured-scene", "newmtl wood\n");
    let scene = |object: &str| {
        let text = format!(
            "[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n[[lights]]\n\
             shape.point = {{ position = [1, 4, 1] }}\n[[objects]]\n{object}\n"
        );
        folder.write("s.toml", &text);
        folder.gnomon("render s.toml --size 32x24 --out a.png")
    };
    scene(
        "mesh.plane = { half = 2.0 }\nmaterial = { texture = \"wood.png\", texture-repeat = 3.0 }",
    )
    .fine();
    scene("mesh.model = \"a.obj\"\nopen = true\nmaterial.texture = \"wood.png\"").fine();
    scene("mesh.box = { size = [1, 1, 1] }\nmaterial.texture = \"none.png\"").refused(&[
        "s.toml:8:",
        "none.png",
        "cannot be read",
    ]);
    scene("mesh.box = { size = [1, 1, 1] }\nmaterial.texture = \"a.obj\"")
        .refused(&["a.obj", "is no PNG or JPEG"]);
    scene("mesh.sphere = { subdivisions = 2, radius = 1.0 }\nmaterial.texture = \"wood.png\"")
        .refused(&[
            "mesh.sphere has no texture coordinates",
            "plane, terrain, box",
        ]);
    scene("mesh.box = { size = [1, 1, 1] }\nmaterial.texture-repeat = 2.0")
        .refused(&["texture-repeat without texture"]);
    scene("mesh.box = { size = [1, 1, 1] }\nmaterial.texture = \"../etc/hostname\"")
        .refused(&["lies outside"]);
}

/// A traced frame is the frame, textures and all.
#[test]
fn traces_hold_textures() {
    let folder = folder("textured-trace", "newmtl wood\nmap_Kd wood.png\n");
    folder
        .gnomon("record a.obj --technique soft-shadow-volumes --size 48x36 --out t.gnt")
        .fine();
    let replayed = folder.gnomon("replay t.gnt --deep --out b.png").fine();
    assert!(replayed.stdout().contains("equal"), "{}", replayed.stdout());
}
