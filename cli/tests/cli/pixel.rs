//! `gnomon pixel` and `gnomon debug` on a small frame of two triangles.

use std::sync::Arc;

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, DepthStencilAttachment, Draw, Format, LoadOp, Recording, RenderPass,
    RenderPipeline, StoreOp, Subresource, TextureDescriptor, VertexBuffer,
};
use gnomon_shaders::surface::Constant;
use gnomon_shaders::transform::{ClipFromWorld, HomogeneousPoints};
use gnomon_traces::{Meta, RecordOptions, record};
use serde_json::json;

use crate::common::Folder;

/// A near triangle over the left half of 16×16 pixels and one behind it over all of them.
fn frame() -> Recording {
    let mut frame = Recording::default();
    let image = TextureDescriptor::d2("image", Format::Rgba8Unorm, 16, 16);
    let image = frame.create(&image).unwrap();
    let depth = TextureDescriptor::d2("depth", Format::Depth24Stencil8, 16, 16);
    let depth = frame.create(&depth).unwrap();
    frame.name_output("color", image).unwrap();
    let identity = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| if i == j { 1.0 } else { 0.0 }));
    let draw = |label: &str, z: f32, x: f32, color: [f32; 4]| {
        let pipeline = RenderPipeline {
            label: label.into(),
            vertex: HomogeneousPoints(ClipFromWorld(identity)).stage(),
            fragment: Some(Constant(color).stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::opaque(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        let corners = [[-1.0, 3.0, z, 1.0], [-1.0, -1.0, z, 1.0], [x, -1.0, z, 1.0]];
        Draw {
            vertices: Some(Arc::new(VertexBuffer {
                data: corners.concat(),
                stride: 4,
            })),
            ..Draw::vertices_only(label, &Arc::new(pipeline), 3)
        }
    };
    frame.list.passes.push(RenderPass {
        label: "main".into(),
        color: vec![ColorAttachment {
            texture: image,
            subresource: Subresource::default(),
            load: LoadOp::Clear([0.0; 4]),
            store: StoreOp::Store,
        }],
        depth_stencil: Some(DepthStencilAttachment {
            texture: depth,
            subresource: Subresource::default(),
            depth_load: LoadOp::Clear(1.0),
            depth_store: StoreOp::Discard,
            stencil_load: LoadOp::Clear(3),
            stencil_store: StoreOp::Store,
        }),
        draws: vec![
            draw("near", 0.25, 3.0, [1.0, 0.0, 0.0, 1.0]),
            draw("far", 0.5, 3.0, [0.0, 1.0, 0.0, 1.0]),
        ],
    });
    frame
}

fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    let trace = record(Meta::new("two"), &frame(), RecordOptions::default()).unwrap();
    trace.write(folder.path("two.gnt")).unwrap();
    folder
}

#[test]
fn json_tells_every_event() {
    let folder = folder("pixel-json");
    let d = folder.gnomon("pixel two.gnt 3 4 --json --no-skip").json();
    assert_eq!(d["pixel"], json!([3, 4]));
    assert_eq!(d["frame"], 0);
    let events = d["events"].as_array().unwrap();
    let ends: Vec<_> = events.iter().map(|e| e["end"].as_str().unwrap()).collect();
    assert_eq!(ends, ["load", "written", "depth", "store"]);
    assert_eq!(events[0]["stencil"]["after"], 3);
    assert_eq!(
        events[0]["color"][0]["operation"],
        json!({"clear": [0.0, 0.0, 0.0, 0.0]})
    );
    let near = &events[1];
    assert_eq!(
        [&near["draw"], &near["primitive"], &near["piece"]],
        [0, 0, 0]
    );
    assert_eq!(near["label"], "near");
    assert_eq!(near["depth"]["fragment"], 4_194_304);
    assert_eq!(near["depth"]["before"], 0xff_ffff);
    assert_eq!(near["depth"]["after"], 4_194_304);
    assert_eq!(near["outputs"], json!([[1.0, 0.0, 0.0, 1.0]]));
    assert_eq!(near["color"][0]["after"], json!([255, 0, 0, 255]));
    let far = &events[2];
    assert_eq!(far["depth"]["after"], 4_194_304);
    assert_eq!(far["stencil"]["op"], "keep");
    assert_eq!(far["outputs"], json!(null));
    assert_eq!(
        d["final"],
        json!([[255, 0, 0, 255], {"depth": 0, "stencil": 3}])
    );
}

/// What zmin/zmax hid is said, with both depths.
#[test]
fn the_table_says_why() {
    let folder = folder("pixel-text");
    let text = folder.gnomon("pixel two.gnt 3 4").fine().stdout();
    let words = [
        "pixel (3, 4) of frame 0: 4 events",
        "depth cleared, stencil cleared, colour cleared",
        "16777215→4194304",
        "0 0 0 0→255 0 0 255",
        "block culled: nearest 8388608 ≥ zmax 4194304",
        "depth discarded",
        "depth (Depth24Stencil8) holds depth 0, stencil 3",
    ];
    for word in words {
        assert!(text.contains(word), "no `{word}` in:\n{text}");
    }
    let text = folder.gnomon("pixel two.gnt 3 4 --no-skip").fine().stdout();
    assert!(text.contains("not 8388608 < 4194304"), "{text}");
}

#[test]
fn debug_shows_shaders_and_a_line_for_the_debugger() {
    let folder = folder("debug");
    let text = folder
        .gnomon("debug two.gnt 3 4 1 --simd scalar")
        .fine()
        .stdout();
    let words = [
        "event 1: pass 0 `main`, draw 0 `near`, primitive 0, ",
        "0: -1 3 0.25 1",
        "gnomon_shaders::transform::HomogeneousPoints",
        "surface.constant version 1, 16 bytes of uniforms",
        "    1 0 0 1\n",
        "rust-gdb -ex 'break reach_probed_fragment' -ex 'ignore 1 0' -ex 'run'",
        "--args gnomon pixel two.gnt 3 4 --frame 0 --threads 1 --tile 64 --simd scalar",
    ];
    for word in words {
        assert!(text.contains(word), "no `{word}` in:\n{text}");
    }
}

#[test]
fn what_is_not_there_is_refused_with_what_is() {
    let folder = folder("pixel-refused");
    let refused = |arguments: &str, parts: &[&str]| folder.gnomon(arguments).refused(parts);
    refused("pixel two.gnt 16 0", &["columns 0 to 15 and rows 0 to 15"]);
    refused("pixel two.gnt 0 0 --frame 1", &["frame 1", "frames 0 to 0"]);
    refused(
        "pixel two.gnt 0 0 --image depth",
        &["no output `depth`; it has color"],
    );
    refused(
        "debug two.gnt 3 4 0",
        &["no fragment 0; fragments are 1, 2"],
    );
    refused(
        "debug two.gnt 3 4 9",
        &["no fragment 9; fragments are 1, 2"],
    );
    refused("pixel none.gnt 3 4", &["none.gnt"]);
}

/// What gdb says when it is given the line of `debug` for the fragment of `event`.
fn debugged(folder: &Folder, place: &str) -> String {
    let text = folder.gnomon(&format!("debug {place}")).fine().stdout();
    let line = text.lines().last().unwrap().trim();
    let gnomon = env!("CARGO_BIN_EXE_gnomon");
    let line = line.replace("rust-gdb", "gdb -nx -batch");
    let line = line.replace("--args gnomon", &format!("-ex 'bt 1' --args '{gnomon}'"));
    let mut shell = std::process::Command::new("sh");
    let output = shell.args(["-c", &line]).current_dir(folder.path("."));
    let output = output.env_remove("DEBUGINFOD_URLS").output().unwrap();
    let [said, complained] = [&output.stdout, &output.stderr].map(|b| String::from_utf8_lossy(b));
    format!("{said}{complained}")
}

#[test]
fn the_line_for_the_debugger_stops_in_the_shader_of_the_fragment() {
    let gdb = std::process::Command::new("gdb").arg("--version").output();
    if gdb.is_err() {
        eprintln!("skipped: there is no gdb");
        return;
    }
    let folder = Folder::new("debugger");
    let record = "record adversarial-eye-in-shadow --size 160x100 --set method=zfail";
    folder.gnomon(&format!("{record} --out a.gnt")).fine();
    // The ball in the light's pass is run; the count of its volume is not.
    let text = debugged(&folder, "a.gnt 57 41 8");
    if ["ptrace", "Operation not permitted"]
        .iter()
        .any(|w| text.contains(w))
    {
        eprintln!("skipped: programs may not be traced here");
        return;
    }
    let stopped = text
        .lines()
        .any(|l| l.starts_with("#0") && l.contains("shade<"));
    assert!(stopped && text.contains("surface.rs"), "{text}");
    let text = debugged(&folder, "a.gnt 57 41 5");
    let stopped = text
        .lines()
        .any(|l| l.contains("#0") && l.contains("reach_probed_fragment"));
    assert!(stopped, "{text}");
}
