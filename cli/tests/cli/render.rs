//! What `render` prints and writes.

use crate::common::Folder;
use serde_json::Value;

const KEYS: [&str; 11] = [
    "scene",
    "technique",
    "params",
    "size",
    "threads",
    "simd",
    "hash",
    "time_ms",
    "passes",
    "totals",
    "warnings",
];

fn assert_keys(value: &Value, keys: &[&str]) {
    for key in keys {
        assert!(value.get(key).is_some(), "no {key} in {value}");
    }
}

fn assert_work(work: &Value) {
    assert_keys(work, &["draws", "fragments", "tiles", "traffic"]);
    let fragments = [
        "generated",
        "hiz_killed",
        "depth_failed",
        "stencil_failed",
        "discarded",
        "written",
    ];
    assert_keys(&work["fragments"], &fragments);
    assert_keys(&work["tiles"], &["tested", "culled", "accepted"]);
    for client in work["traffic"].as_object().unwrap().values() {
        assert_keys(
            client,
            &[
                "read_accesses",
                "read_bytes",
                "write_accesses",
                "write_bytes",
            ],
        );
    }
}

#[test]
fn json_has_the_documented_keys() {
    let folder = Folder::new("json");
    let doc = folder
        .gnomon("render cylinder --size 64x48 --threads 2 --set method=zfail --json")
        .json();
    assert_keys(&doc, &KEYS);
    assert_eq!(
        (&doc["scene"], &doc["technique"]),
        (&"cylinder".into(), &"shadow-volumes".into())
    );
    assert_eq!(
        (&doc["params"]["method"], &doc["threads"]),
        (&"zfail".into(), &2.into())
    );
    assert_eq!(doc["size"], serde_json::json!([64, 48]));
    assert_keys(&doc["hash"], &["color", "visibility"]);
    assert!(doc["time_ms"]["frame"].as_f64().unwrap() > 0.0);
    let passes = doc["passes"].as_array().unwrap();
    assert!(!passes.is_empty());
    for pass in passes {
        assert!(doc["time_ms"]["passes"][pass["name"].as_str().unwrap()].is_number());
        assert_work(pass);
    }
    assert_work(&doc["totals"]);
    let sum: u64 = passes
        .iter()
        .map(|p| p["fragments"]["generated"].as_u64().unwrap())
        .sum();
    assert_eq!(doc["totals"]["fragments"]["generated"].as_u64(), Some(sum));
}

#[test]
fn summaries_go_to_stderr_with_json_and_to_stdout_without() {
    let folder = Folder::new("streams");
    let run = folder.gnomon("render cylinder --size 32x32 --json").fine();
    assert!(run.stdout().starts_with('{') && run.stderr().contains("volumes"));
    let run = folder.gnomon("render cylinder --size 32x32").fine();
    assert!(
        run.stdout().contains("volumes") && run.stderr().is_empty(),
        "{}",
        run.stderr()
    );
    assert!(
        run.stdout()
            .lines()
            .all(|l| l.starts_with("warning: ") || l.chars().count() <= 100),
        "{}",
        run.stdout()
    );
    assert_eq!(folder.names(), ["out"]);
    assert!(folder.path("out/cylinder-shadow-volumes.png").is_file());
}

/// Reads a float32 array of two dimensions as NumPy would.
fn read_npy(bytes: &[u8]) -> ((usize, usize), Vec<f32>) {
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let data = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = std::str::from_utf8(&bytes[10..data]).unwrap();
    assert!(
        header.contains("'descr': '<f4'") && header.contains("'fortran_order': False"),
        "{header}"
    );
    let shape = header
        .split_once("'shape': (")
        .unwrap()
        .1
        .split_once(')')
        .unwrap()
        .0;
    let (height, width) = shape.split_once(", ").unwrap();
    let floats = bytes[data..]
        .chunks_exact(4)
        .map(|c| f32::from_le_bytes(c.try_into().unwrap()));
    (
        (height.parse().unwrap(), width.parse().unwrap()),
        floats.collect(),
    )
}

#[test]
fn visibility_is_a_float_array() {
    let folder = Folder::new("npy");
    folder
        .gnomon("render peer-a --size 64x48 --out a.png --visibility a.npy")
        .fine();
    let (shape, values) = read_npy(&std::fs::read(folder.path("a.npy")).unwrap());
    assert_eq!((shape, values.len()), ((48, 64), 64 * 48));
    assert!(values.iter().all(|v| v.is_nan() || *v == 0.0 || *v == 1.0));
    for wanted in [0.0, 1.0] {
        assert!(values.contains(&wanted), "no pixel of {wanted}");
    }
    assert!(values[0].is_nan(), "the sky has no surface");
}

#[test]
fn pictures_have_the_size_asked_for() {
    let folder = Folder::new("overlays");
    let all = "overdraw,stencil,traffic,silhouette,volumes";
    let doc = folder
        .gnomon(&format!(
            "render cylinder --size 33x17 --out a.png --overlay {all} --json"
        ))
        .json();
    assert_eq!(folder.names().len(), 6);
    assert_eq!(doc["files"].as_array().unwrap().len(), 6);
    let render = image::open(folder.path("a.png")).unwrap();
    assert_eq!((render.width(), render.height()), (33, 17));
    for name in all.split(',') {
        let overlay = image::open(folder.path(&format!("a-{name}.png"))).unwrap();
        assert!(overlay.width() >= 280 && overlay.height() > 17, "{name}");
    }
}

/// Wedges of every construction; a technique without any says so.
#[test]
fn wedges_are_drawn_as_the_technique_builds_them() {
    let folder = Folder::new("wedges");
    let orange = |given: &str| {
        folder
            .gnomon(&format!(
                "render cylinder --size 120x80 --out a.png --overlay wedges --technique {given}"
            ))
            .fine();
        let picture = image::open(folder.path("a-wedges.png"))
            .unwrap()
            .into_rgb8();
        let strong = |p: &&image::Rgb<u8>| p[0] > p[2].saturating_add(25);
        picture.pixels().filter(strong).count()
    };
    let exact = orange("soft-shadow-volumes");
    let sphere = orange("soft-shadow-volumes --set wedge=paper3");
    let linked = orange("penumbra-wedges");
    assert!(exact > 300 && linked > 300, "{exact} {linked}");
    assert!(sphere > exact, "{sphere} {exact}");
    let none = "render cylinder --overlay wedges --size 16x16 --out b.png";
    folder.gnomon(none).refused(&[
        "shadow-volumes builds no penumbra wedges",
        "soft-shadow-volumes",
    ]);
    assert!(!folder.path("b.png").exists());
}

#[test]
fn one_pixel_is_a_picture() {
    let folder = Folder::new("pixel");
    let all = "--overlay overdraw,stencil,traffic,silhouette,volumes";
    folder
        .gnomon(&format!("render cylinder --size 1x1 --out a.png {all}"))
        .fine();
}

#[test]
fn scene_files_and_models_are_rendered() {
    let folder = Folder::new("files");
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    folder.write("cube.obj", cube);
    let doc = folder.gnomon("render cube.obj --size 40x30 --json").json();
    assert_eq!(doc["scene"], "cube");
    let head =
        "name = \"two/../words\"\nsize = [24, 16]\n[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n";
    let rest = "[[lights]]\nshape.point = { position = [1, 4, 1] }\n[[objects]]\nmesh.box = { size = [1, 1, 1] }\n";
    folder.write("box.toml", &format!("{head}{rest}"));
    let doc = folder.gnomon("render box.toml --json").json();
    assert_eq!(doc["size"], serde_json::json!([24, 16]));
    assert!(folder.path("out/two----words-shadow-volumes.png").is_file());
}

/// A cube of two colours.
const CUBE: &str = "mtllib paint.mtl\n\
    v -1 0 -1\nv 1 0 -1\nv 1 2 -1\nv -1 2 -1\nv -1 0 1\nv 1 0 1\nv 1 2 1\nv -1 2 1\n\
    usemtl red\nf 5 6 7 8\nf 1 4 3 2\nf 1 2 6 5\n\
    usemtl blue\nf 4 8 7 3\nf 2 3 7 6\nf 1 5 8 4\n";

/// Pixels of a picture in which red, and in which blue, is far above the other.
fn coloured(folder: &Folder, name: &str) -> [usize; 2] {
    let picture = image::open(folder.path(name)).unwrap().into_rgb8();
    let count = |c: usize| {
        let strong = |p: &&image::Rgb<u8>| p[c] > 100 && p[c] / 2 > p[2 - c];
        picture.pixels().filter(strong).count()
    };
    [count(0), count(2)]
}

#[test]
fn obj_models_have_their_materials() {
    let folder = Folder::new("materials");
    folder.write("cube.obj", CUBE);
    let render = "render cube.obj --size 120x90 --out a.png";
    let run = folder.gnomon(render).fine();
    assert!(run.stderr().contains("missing-mtl") || run.stdout().contains("missing-mtl"));
    assert_eq!(coloured(&folder, "a.png"), [0, 0]);
    folder.write(
        "paint.mtl",
        "newmtl red\nKd 0.9 0.05 0.05\nnewmtl blue\nKd 0.05 0.05 0.9\nKs 0.4 0.4 0.4\nNs 30\n",
    );
    let run = folder.gnomon(&format!("{render} --json")).json();
    assert_eq!(run["warnings"].as_array().unwrap().len(), 0);
    let [red, blue] = coloured(&folder, "a.png");
    assert!(red > 300 && blue > 300, "{red} {blue}");
    folder.write("paint.mtl", "newmtl red\nKd 0.9 oops\nnewmtl blue\n");
    let run = folder.gnomon(&format!("{render} --json")).json();
    let warnings = run["warnings"].as_array().unwrap();
    assert_eq!(warnings[0]["code"], "bad-mtl");
    let message = warnings[0]["message"].as_str().unwrap();
    assert!(message.contains("paint.mtl:2: 'Kd 0.9 oops'"), "{message}");
}

#[test]
fn eyes_and_lights_can_be_given() {
    let folder = Folder::new("view");
    folder.write(
        "cube.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
    );
    let draw = |more: &str| {
        let line = format!("render cube.obj --size 64x48 --json --out a.png {more}");
        let document = folder.gnomon(&line).json();
        (
            document["hash"]["visibility"].clone(),
            image::open(folder.path("a.png")).unwrap().into_rgb8(),
        )
    };
    // Straight down on a framed cube: its top is in the middle, ground all round.
    let (above, top) = draw("--eye 0,9,0 --target 0,0,0 --fov 30 --light directional:0,1,0");
    let [middle, corner] = [top.get_pixel(32, 24), top.get_pixel(1, 1)];
    // The material has a highlight in the middle.
    let near = |a: &image::Rgb<u8>, b: &image::Rgb<u8>| {
        let pairs = a.0.iter().zip(b.0);
        pairs.clone().all(|(a, b)| a.abs_diff(b) < 12)
    };
    assert!(near(top.get_pixel(28, 24), middle), "a square of one color");
    assert!(!near(middle, corner) && top.get_pixel(62, 46) == corner);
    let (lower, _) = draw("--eye 0,2,-6");
    assert_ne!(above, lower);
    // Red light alone.
    let (_, red) = draw(
        "--eye 0,9,0 --target 0,0,0 --fov 30 --light point:0,8,0:1,0,0 --light sphere:0,8,1,0.1:0,0,0",
    );
    let [r, g, b] = red.get_pixel(32, 24).0;
    assert!(r > 2 * g && g.abs_diff(b) < 40, "{r} {g} {b}");
    for (flags, part) in [
        ("--eye 1,2", "0,1.5,4"),
        (
            "--eye 1,2,3 --target 1,2,3",
            "the eye and its target are both",
        ),
        ("--fov 0", "above 0 and below 180"),
        ("--light lamp:1,2,3", "square:X,Y,Z,SIDE"),
        ("--light point:1,2,3 --env sky", "--env"),
    ] {
        folder
            .gnomon(&format!("render cube.obj {flags}"))
            .refused(&[part]);
    }
}

#[test]
fn supersampled_pictures_are_told_apart_and_counted() {
    let folder = Folder::new("supersample");
    let doc = folder
        .gnomon("render cylinder --size 32x24 --supersample 3 --json")
        .json();
    assert_eq!(
        (&doc["size"], &doc["supersample"]),
        (&serde_json::json!([32, 24]), &3.into())
    );
    let passes = doc["passes"].as_array().unwrap();
    assert_eq!(passes.last().unwrap()["name"], "resolve samples");
    let name = "out/cylinder-shadow-volumes-supersample-3.png";
    assert_eq!(doc["files"][0]["path"], name);
    assert_eq!(folder.pixels(name).len(), 32 * 24 * 4);
    let plain = folder.gnomon("render cylinder --size 32x24 --json").json();
    assert!(plain.get("supersample").is_none());
    assert_ne!(plain["hash"]["color"], doc["hash"]["color"]);
    let one = folder
        .gnomon("render cylinder --size 32x24 --supersample 1 --json")
        .json();
    assert_eq!(
        (&one["hash"], &one["totals"]),
        (&plain["hash"], &plain["totals"])
    );
    let run = |flags: &str| folder.gnomon(&format!("render cylinder {flags}"));
    run("--supersample 9").refused(&["--supersample", "1..=8"]);
    run("--supersample 0").refused(&["--supersample"]);
    run("--size 2000x100 --supersample 5").refused(&["--supersample", "5", "1 to 4"]);
    run("--supersample 2 --overlay stencil").refused(&["--supersample", "overlays"]);
}
