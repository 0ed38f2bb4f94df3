//! The same tetrahedron in the forms that exporters choose; damaged files.

use glam::DVec3;
use proptest::prelude::*;
use serde_json::{Value, json};

use super::*;
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::LightShape;
use crate::world::mesh::Shading;

const POINTS: [[f32; 3]; 4] = [[0.0; 3], [1.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const TRIANGLES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// Twelve floats of points, then twelve indices of 32, 16 and 8 bits.
fn buffer() -> Vec<u8> {
    let indices = TRIANGLES.concat();
    let mut bytes: Vec<u8> = POINTS
        .concat()
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    bytes.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    bytes.extend(indices.iter().flat_map(|i| (*i as u16).to_le_bytes()));
    bytes.extend(indices.iter().map(|i| *i as u8));
    bytes
}

/// The file, whose only buffer is that of a `.glb`.
fn file() -> Value {
    let view =
        |at: usize, length: usize| json!({"buffer": 0, "byteOffset": at, "byteLength": length});
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [view(0, 48), view(48, 48), view(96, 24), view(120, 12)],
        "buffers": [{"byteLength": buffer().len()}],
    })
}

/// The file with values in other places.
fn with(changes: &[(&str, Value)]) -> Value {
    let mut file = file();
    for (pointer, value) in changes {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match file
            .pointer_mut(parent)
            .unwrap_or_else(|| panic!("{parent}"))
        {
            Value::Array(list) if key == "-" => list.push(value.clone()),
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value.clone(),
            Value::Object(table) => {
                table.insert(key.to_owned(), value.clone());
            }
            other => panic!("{other}"),
        }
    }
    file
}

fn glb(json: &Value, buffer: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut padded = buffer.to_vec();
    padded.resize(padded.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    let length = 12 + 8 + text.len() + 8 + padded.len();
    [
        b"glTF",
        &word(2)[..],
        &word(length),
        &word(text.len()),
        b"JSON",
        &text,
        &word(padded.len()),
        b"BIN\0",
        &padded,
    ]
    .concat()
}

fn read(json: &Value) -> Result<Model, GltfError> {
    parse(&glb(json, &buffer()), "t.glb")
}

fn message(json: &Value) -> String {
    read(json).unwrap_err().to_string()
}

fn codes(model: &Model) -> Vec<&'static str> {
    model.warnings.iter().map(|w| w.code).collect()
}

/// The tetrahedron, to the bit, and nothing to say.
#[track_caller]
fn same(json: &Value) {
    let model = read(json).unwrap();
    assert_eq!(model.pieces, read(&file()).unwrap().pieces);
    assert_eq!(model.warnings, []);
}

fn volume_if_closed(piece: &Piece) -> f64 {
    let mesh = piece.shape.clone().into_mesh(Shading::Flat).unwrap();
    assert!(
        EdgeAdjacency::new(mesh.triangles())
            .closedness(&mesh)
            .is_closed()
    );
    mesh.signed_volume()
}

#[test]
fn a_tetrahedron_is_closed_and_right_way_round() {
    let model = read(&file()).unwrap();
    assert_eq!(model.pieces.len(), 1);
    assert_eq!(model.pieces[0].name, "node 0");
    assert!((volume_if_closed(&model.pieces[0]) - 0.25).abs() < 1e-12);
    assert!(model.camera.is_none() && model.lights.is_empty() && model.warnings.is_empty());
}

#[test]
fn indices_of_all_types_are_read() {
    for (view, code) in [(2, 5123), (3, 5121)] {
        same(&with(&[
            ("/accessors/1/bufferView", json!(view)),
            ("/accessors/1/componentType", json!(code)),
        ]));
    }
    same(&with(&[
        ("/accessors/1/byteOffset", json!(0)),
        ("/meshes/0/primitives/0/mode", json!(4)),
    ]));
}

#[test]
fn positions_may_be_strided_normalized_and_sparse() {
    // Every point twice: a stride of 24 takes the first of each.
    let doubled: Vec<u8> = buffer()[..48]
        .chunks(12)
        .flat_map(|p| [p, &[0xff; 12]].concat())
        .collect();
    let bytes = [&doubled[..], &buffer()[48..96]].concat();
    let strided = with(&[
        (
            "/bufferViews/0",
            json!({"buffer": 0, "byteLength": 96, "byteStride": 24}),
        ),
        (
            "/bufferViews/1",
            json!({"buffer": 0, "byteOffset": 96, "byteLength": 48}),
        ),
        ("/buffers/0/byteLength", json!(144)),
    ]);
    let strided = parse(&glb(&strided, &bytes), "t").unwrap();
    assert_eq!(strided.pieces, read(&file()).unwrap().pieces);
    // Signed bytes, of which 127 is 1 and -128 no less than -1.
    let bytes: Vec<u8> = [[0_i8, 0, 0], [127, 0, 0], [0, -127, 0], [0, 0, -128]]
        .concat()
        .into_iter()
        .map(|v| v as u8)
        .chain(buffer()[120..].to_vec())
        .collect();
    let quantized = with(&[
        ("/accessors/0/componentType", json!(5120)),
        ("/accessors/0/normalized", json!(true)),
        ("/accessors/1/componentType", json!(5121)),
        ("/bufferViews/0", json!({"buffer": 0, "byteLength": 12})),
        (
            "/bufferViews/1",
            json!({"buffer": 0, "byteOffset": 12, "byteLength": 12}),
        ),
        ("/buffers/0/byteLength", json!(24)),
        ("/extensionsRequired", json!(["KHR_mesh_quantization"])),
    ]);
    let model = parse(&glb(&quantized, &bytes), "t").unwrap();
    let bounds = model.bounds().unwrap();
    assert_eq!(bounds, (DVec3::new(0.0, -1.0, -1.0), DVec3::X));
    // Zeros but for point 1, which is that of the last three floats.
    let sparse = json!({
        "count": 1,
        "indices": {"bufferView": 3, "byteOffset": 2, "componentType": 5121},
        "values": {"bufferView": 0, "byteOffset": 36},
    });
    let changed = with(&[("/accessors/0/sparse", sparse.clone())]);
    let changed = read(&changed).unwrap().bounds().unwrap().1;
    assert_eq!(changed, DVec3::new(0.0, 1.0, 1.0));
    let mut zeros = with(&[("/accessors/0/sparse", sparse)]);
    zeros["accessors"][0]
        .as_object_mut()
        .unwrap()
        .remove("bufferView");
    assert!(message(&zeros).contains("no triangles"));
}

#[test]
fn strips_fans_and_no_indices_are_triangles() {
    let mut plain = file();
    plain["meshes"][0]["primitives"][0]
        .as_object_mut()
        .unwrap()
        .remove("indices");
    for (mode, triangles) in [(4, 1), (5, 2), (6, 2)] {
        plain["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        let model = read(&plain).unwrap();
        assert_eq!(model.pieces[0].shape.triangles.len(), triangles, "{mode}");
        // Of four points a list uses three.
        let cut: &[&str] = if mode == 4 { &["skipped-faces"] } else { &[] };
        assert_eq!(codes(&model), cut);
    }
    for mode in 0..4 {
        plain["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        assert!(message(&plain).contains("no triangles"));
    }
}

#[test]
fn vertices_of_seams_are_welded_and_primitives_are_one_solid() {
    // Each primitive has half of the faces, and all points again.
    let part = |at: usize, material: usize| json!({"attributes": {"POSITION": 0}, "indices": 2 + at, "material": material});
    let accessor = |at: usize| json!({"bufferView": 1, "byteOffset": 24 * at, "componentType": 5125, "count": 6, "type": "SCALAR"});
    let paint = |c: f64| json!({"pbrMetallicRoughness": {"baseColorFactor": [c, 0.5, 2.0, 1.0]}});
    let model = read(&with(&[
        (
            "/meshes/0",
            json!({"name": "solid", "primitives": [part(0, 1), part(1, 0)]}),
        ),
        ("/accessors/-", accessor(0)),
        ("/accessors/-", accessor(1)),
        ("/materials", json!([paint(0.25), paint(0.75)])),
    ]))
    .unwrap();
    let [piece] = &model.pieces[..] else { panic!() };
    assert_eq!(
        (piece.name.as_str(), piece.shape.positions.len()),
        ("solid", 4)
    );
    assert!(volume_if_closed(piece) > 0.0);
    let albedos: Vec<_> = piece.parts.iter().map(|p| p.material.albedo).collect();
    assert_eq!(albedos, [[0.75, 0.5, 1.0], [0.25, 0.5, 1.0]]);
    assert_eq!(
        [0, 1].map(|p| piece.parts[p].triangles.clone()),
        [[0, 1], [2, 3]]
    );
    assert_eq!(codes(&model), ["limited-colours"]);
}

#[test]
fn nodes_are_placed_by_their_parents_and_mirrors_turn_triangles() {
    let model = read(&with(&[(
        "/nodes",
        json!([
            {"translation": [10, 0, 0], "children": [1, 2], "name": "parent"},
            {"mesh": 0, "scale": [-2, 1, 1], "name": "mirrored"},
            {"mesh": 0, "matrix": [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 5, 1]},
        ]),
    )]))
    .unwrap();
    let [mirrored, turned] = &model.pieces[..] else {
        panic!()
    };
    assert_eq!(mirrored.name, "mirrored");
    let bounds = mirrored.shape.bounds().unwrap();
    assert_eq!(
        bounds,
        (DVec3::new(7.0, 0.0, 0.0), DVec3::new(10.0, 1.0, 1.0))
    );
    assert!((volume_if_closed(mirrored) - 0.5).abs() < 1e-6);
    // A quarter about +y: +x to -z, +z to +x.
    let bounds = turned.shape.bounds().unwrap();
    assert_eq!(
        bounds,
        (DVec3::new(10.0, 0.0, 3.5), DVec3::new(11.0, 1.0, 5.0))
    );
    assert!((volume_if_closed(turned) - 0.25).abs() < 1e-6);
}

#[test]
fn files_without_scenes_have_the_nodes_that_are_nobodys() {
    let nodes = json!([{"mesh": 0}, {"children": [0], "translation": [0, 7, 0]}]);
    let mut file = with(&[("/nodes", nodes)]);
    let table = file.as_object_mut().unwrap();
    table.remove("scene");
    table.remove("scenes");
    let model = read(&file).unwrap();
    assert_eq!(model.pieces.len(), 1);
    assert_eq!(model.bounds().unwrap().0.y, 7.0);
}

#[test]
fn cameras_and_lights_stand_at_their_nodes() {
    let turned = json!([0, 0.5_f64.sqrt(), 0, 0.5_f64.sqrt()]);
    let model = read(&with(&[
        ("/nodes", json!([
            {"mesh": 0},
            {"camera": 0, "translation": [5, 1, 0], "rotation": turned},
            {"camera": 1},
            {"translation": [0, 3, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"rotation": turned, "extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"translation": [0, 9, 0], "scale": [2, 2, 2], "extensions": {"EXT_lights_area": {"light": 0}}},
            {"extensions": {"EXT_lights_area": {"light": 1}}},
        ])),
        ("/scenes/0/nodes", json!([0, 1, 2, 3, 4, 5, 6])),
        ("/cameras", json!([
            {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25}},
            {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 1, "znear": 0}},
        ])),
        ("/extensions", json!({
            "KHR_lights_punctual": {"lights": [
                {"type": "spot", "intensity": 40.0, "spot": {}},
                {"type": "directional", "color": [1, 0.5, 0]},
            ]},
            "EXT_lights_area": {"lights": [
                {"type": "rect", "size": 0.5, "rect": {"aspect": 3}},
                {"type": "disk", "intensity": 0},
            ]},
        })),
        ("/extensionsUsed", json!(["KHR_lights_punctual", "EXT_lights_area"])),
    ]))
    .unwrap();
    let camera = model.camera.unwrap();
    assert_eq!((camera.eye, camera.near), (DVec3::new(5.0, 1.0, 0.0), 0.25));
    assert!((camera.target - DVec3::new(4.0, 1.0, 0.0)).length() < 1e-12);
    assert!((camera.fov_y_degrees - 28.6479).abs() < 1e-4);
    let shapes: Vec<&LightShape> = model.lights.iter().map(|l| &l.shape).collect();
    let [
        LightShape::Point { position },
        LightShape::Directional { towards },
        rectangle,
        disc,
    ] = shapes[..]
    else {
        panic!("{shapes:?}");
    };
    assert_eq!(*position, DVec3::Y * 3.0);
    assert!((*towards - DVec3::X).length() < 1e-12);
    let LightShape::Rectangle {
        centre,
        edge_u,
        edge_v,
    } = rectangle
    else {
        panic!()
    };
    assert_eq!(
        (*centre, *edge_u, *edge_v),
        (DVec3::Y * 9.0, DVec3::X * 3.0, DVec3::Y)
    );
    let LightShape::Disc { normal, radius, .. } = disc else {
        panic!()
    };
    assert_eq!((*normal, *radius), (DVec3::Z, 0.5));
    let brightest = model
        .lights
        .iter()
        .flat_map(|l| l.colour)
        .fold(0.0, f32::max);
    assert_eq!(brightest, 1.0);
    assert_eq!(model.lights[3].colour, [0.0; 3]);
    assert_eq!(
        codes(&model),
        ["ignored-cameras", "spot-lights", "light-units"]
    );
}

#[test]
fn what_is_not_drawn_is_told_once() {
    let model = read(&with(&[
        ("/nodes/0", json!({"mesh": 0, "skin": 0, "translation": [0, 5, 0]})),
        ("/meshes/0/primitives/0/targets", json!([{"POSITION": 0}])),
        ("/meshes/0/primitives/0/attributes/COLOR_0", json!(0)),
        ("/animations", json!([{}, {}])),
        ("/materials", json!([{"emissiveFactor": [1, 1, 1], "alphaMode": "BLEND", "normalTexture": {"index": 0}}])),
        ("/extensionsUsed", json!(["KHR_materials_clearcoat", "KHR_texture_transform"])),
        ("/unheardOf", json!({"a": [1, 2]})),
    ]))
    .unwrap();
    assert_eq!(
        codes(&model),
        [
            "ignored-skins",
            "ignored-morphs",
            "ignored-animations",
            "ignored-colours",
            "ignored-maps",
            "ignored-emission",
            "ignored-transparency",
            "ignored-extensions",
        ]
    );
    assert_eq!(model.warnings[2].count, 1, "the first one is played");
    assert_eq!(
        model.bounds().unwrap().0.y,
        0.0,
        "bones place it, not its node"
    );
}

#[test]
fn errors_name_place_value_and_what_is_valid() {
    let cases = [
        (
            "/asset/version",
            json!("1.0"),
            &["t.glb", "asset", "'1.0'", "version 2"][..],
        ),
        ("/asset/minVersion", json!("2.1"), &["'2.1'"]),
        (
            "/extensionsRequired",
            json!(["KHR_draco_mesh_compression"]),
            &["KHR_draco_mesh_compression", "KHR_lights_punctual"],
        ),
        ("/scene", json!(3), &["scene: 3 is none of the 1 scenes"]),
        (
            "/scenes/0/nodes",
            json!([7]),
            &["scenes[0].nodes: 7 is none of the 1 nodes"],
        ),
        ("/scenes/0/nodes", json!([0, 0]), &["nodes[0]", "met twice"]),
        ("/nodes/0/children", json!([0]), &["nodes[0]", "met twice"]),
        (
            "/nodes/0/mesh",
            json!(1),
            &["nodes[0]: 1 is none of the 1 meshes"],
        ),
        (
            "/nodes/0/rotation",
            json!([0, 0, 0, 0]),
            &["nodes[0]", "rotation", "quaternion"],
        ),
        (
            "/nodes/0/matrix",
            json!([1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
            &["nodes[0]", "matrix", "last row"],
        ),
        (
            "/nodes/0/scale",
            json!([1e300, 1, 1]),
            &["nodes[0]", "too large"],
        ),
        (
            "/meshes/0/primitives/0/mode",
            json!(7),
            &["meshes[0].primitives[0]", "mode is 7"],
        ),
        (
            "/meshes/0/primitives/0/attributes",
            json!({}),
            &["primitives[0]", "attributes.POSITION is missing"],
        ),
        (
            "/meshes/0/primitives/0/indices",
            json!(9),
            &["primitives[0].indices: 9 is none of the 2 accessors"],
        ),
        (
            "/meshes/0/primitives/0/material",
            json!(0),
            &["0 is none of the 0 materials"],
        ),
        (
            "/accessors/0/type",
            json!("VEC4"),
            &["accessors[0]", "'VEC4'", "VEC3"],
        ),
        (
            "/accessors/0/componentType",
            json!(5124),
            &["accessors[0]", "5124", "5126"],
        ),
        (
            "/accessors/0/count",
            json!(5),
            &["accessors[0]", "bytes up to 60", "48"],
        ),
        (
            "/accessors/0/count",
            json!(18446744073709551615_u64),
            &["accessors[0]", "more than 8388608"],
        ),
        (
            "/accessors/0/byteOffset",
            json!(18446744073709551615_u64),
            &["accessors[0]", "48"],
        ),
        (
            "/accessors/0/count",
            json!(3),
            &["primitives[0].indices", "an index is 3"],
        ),
        (
            "/accessors/1/componentType",
            json!(5126),
            &["indices", "an index is"],
        ),
        (
            "/accessors/0/sparse",
            json!({"count": 5, "indices": {"bufferView": 3, "componentType": 5121}, "values": {"bufferView": 0}}),
            &["accessors[0].sparse", "count is 5"],
        ),
        (
            "/accessors/0/sparse",
            json!({"count": 1, "indices": {"bufferView": 0, "byteOffset": 15, "componentType": 5121}, "values": {"bufferView": 0}}),
            &["accessors[0].sparse", "63 is none of the 4 values"],
        ),
        (
            "/bufferViews/0/byteLength",
            json!(500),
            &["bufferViews[0]", "bytes up to 500"],
        ),
        (
            "/bufferViews/0/buffer",
            json!(1),
            &["bufferViews[0]: 1 is none of the 1 buffers"],
        ),
        (
            "/buffers/0/byteLength",
            json!(999),
            &["buffers[0]", "bytes up to 999"],
        ),
        (
            "/buffers/0/uri",
            json!("http://a/b.bin"),
            &["buffers[0].uri", "http://a/b.bin", "nothing is fetched"],
        ),
        (
            "/buffers/0/uri",
            json!("data:;base64,AAAA"),
            &["buffers[0]", "which has 3"],
        ),
        (
            "/buffers/0/uri",
            json!("b.bin"),
            &["buffers[0].uri", "folder"],
        ),
        ("/nodes", json!({}), &["JSON", "line 1"]),
    ];
    for (pointer, value, parts) in cases {
        let message = message(&with(&[(pointer, value)]));
        assert!(
            parts.iter().all(|p| message.contains(p)),
            "{pointer}: {message}"
        );
    }
    let nan = [&f32::NAN.to_le_bytes()[..], &buffer()[4..]].concat();
    let message = parse(&glb(&file(), &nan), "t").unwrap_err().to_string();
    assert!(
        message.contains("POSITION[0]") && message.contains("NaN"),
        "{message}"
    );
}

#[test]
fn eyes_and_lights_have_places_and_axes_that_are_numbers() {
    let eye = json!({"camera": 0});
    let [point, sun, rect] =
        [("punctual", 0), ("punctual", 1), ("area", 0)].map(|(kind, light)| {
            let extension = match kind {
                "area" => "EXT_lights_area",
                _ => "KHR_lights_punctual",
            };
            json!({"extensions": {extension: {"light": light}}})
        });
    let with_node = |node: &Value, key: &str, value: Value| {
        let mut node = node.clone();
        node[key] = value;
        with(&[
            ("/nodes", json!([{"mesh": 0}, node])),
            ("/scenes/0/nodes", json!([0, 1])),
            (
                "/cameras",
                json!([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25}}]),
            ),
            (
                "/extensions",
                json!({
                    "KHR_lights_punctual": {"lights": [{"type": "point"}, {"type": "directional"}]},
                    "EXT_lights_area": {"lights": [{"type": "rect"}]},
                }),
            ),
        ])
    };
    let place = |x: f64| json!([x, 0.0, 0.0]);
    for (node, key, value, part) in [
        (&eye, "translation", place(1e17), "the camera's place"),
        (&eye, "scale", json!([1.0, 1.0, 1e200]), "the camera's node"),
        (&point, "translation", place(1e39), "its place"),
        (&rect, "translation", place(-1e200), "its place"),
        (&sun, "scale", json!([1.0, 1.0, 1e200]), "an axis"),
        (&rect, "scale", json!([1e200, 1.0, 1.0]), "size where"),
        (&rect, "scale", json!([1.0, 1.0, 1e39]), "size where"),
    ] {
        let message = message(&with_node(node, key, value));
        assert!(message.contains(part), "{part}: {message}");
    }
    for node in [&eye, &point, &sun, &rect] {
        assert!(read(&with_node(node, "translation", place(1e6))).is_ok());
    }
}

#[test]
fn nodes_are_marked_before_anything_is_kept_of_them() {
    // The second mention is found before the first is placed.
    let bad = json!({"rotation": [0, 0, 0, 0]});
    let file = with(&[("/nodes", json!([{"children": vec![1; 1000]}, bad]))]);
    let message = message(&file);
    assert!(
        message.contains("nodes[1]") && message.contains("met twice"),
        "{message}"
    );
}

#[test]
fn json_of_too_many_values_is_refused_before_it_is_read() {
    assert!(check_json(b"{\"a\":[{},{}]}", 4).is_ok());
    let refused = check_json(b"{\"a\":[{},{}]}", 3).unwrap_err().to_string();
    assert!(
        refused.contains("has 4 bytes") && refused.contains("at most 3"),
        "{refused}"
    );
    let empty = [
        b"{\"nodes\":[".to_vec(),
        b"{},".repeat(MAX_JSON / 2),
        b"{}]}".to_vec(),
    ];
    let message = parse(&empty.concat(), "t.gltf").unwrap_err().to_string();
    assert!(message.contains("at most 2097152"), "{message}");
}

#[test]
fn containers_are_checked() {
    let whole = glb(&file(), &buffer());
    let message = |bytes: &[u8]| parse(bytes, "t").unwrap_err().to_string();
    for cut in [5, 11, 14, 40, whole.len() - 40] {
        let message = message(&whole[..cut]);
        assert!(
            message.contains("cut short") || message.contains("the file has"),
            "{message}"
        );
    }
    let version = [&whole[..4], &[1], &whole[5..]].concat();
    assert!(message(&version).contains("the version is 1"));
    let more = [&whole[..], b"more"].concat();
    assert!(
        parse(&more, "t").is_ok(),
        "bytes behind the end are others'"
    );
    let other = [&whole[..16], b"XXXX", &whole[20..]].concat();
    assert!(message(&other).contains("no chunk 'JSON'"));
    assert!(message(b"").contains("JSON"));
}

#[test]
fn instances_cannot_grow_without_end() {
    // 4000 triangles a node.
    let primitive = json!({"attributes": {"POSITION": 0}, "indices": 1});
    let nodes = vec![json!({"mesh": 0}); 2098];
    let all: Vec<usize> = (0..nodes.len()).collect();
    let file = with(&[
        ("/meshes/0/primitives", json!(vec![primitive; 1000])),
        ("/nodes", json!(nodes)),
        ("/scenes/0/nodes", json!(all)),
    ]);
    assert!(message(&file).contains("more than 8388608 triangles"));
}

proptest! {
    /// Whatever is changed, the file is read or refused.
    #[test]
    fn damaged_files_are_no_panic(
        changes in prop::collection::vec((0.0..1.0_f64, any::<u8>()), 1..8),
        keep in 0.5..1.1_f64,
    ) {
        let mut bytes = glb(&file(), &buffer());
        for (at, byte) in changes {
            let at = (at * bytes.len() as f64) as usize;
            bytes[at] = byte;
        }
        bytes.truncate((keep * bytes.len() as f64) as usize);
        if let Ok(model) = parse(&bytes, "t") {
            for piece in model.pieces {
                prop_assert!(piece.shape.into_mesh(Shading::Flat).is_ok());
            }
        }
    }

    /// Numbers in the JSON may be any.
    #[test]
    fn any_number_is_read_or_refused(which in 0..1000_usize, value in prop_oneof![
        any::<f64>().prop_filter("JSON has no others", |v| v.is_finite()).prop_map(|v| json!(v)),
        any::<u64>().prop_map(|v| json!(v)),
        (-2..300_i64).prop_map(|v| json!(v)),
    ]) {
        let mut file = file();
        let mut places = Vec::new();
        numbers(&file, String::new(), &mut places);
        *file.pointer_mut(&places[which % places.len()]).unwrap() = value;
        let _ = read(&file);
    }
}

fn numbers(value: &Value, at: String, places: &mut Vec<String>) {
    match value {
        Value::Number(_) => places.push(at),
        Value::Array(list) => {
            for (k, v) in list.iter().enumerate() {
                numbers(v, format!("{at}/{k}"), places);
            }
        }
        Value::Object(table) => {
            for (k, v) in table {
                numbers(v, format!("{at}/{k}"), places);
            }
        }
        _ => {}
    }
}

/// A picture of two texels: red, blue.
fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_raw(2, 1, vec![255, 0, 0, 0, 0, 255]).unwrap();
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

const TEXELS: [[f32; 2]; 4] = [[0.25, 0.5], [1.0, 0.0], [0.0, 2.0], [-1.0, 1.0]];

/// The file with coordinates and a picture in its buffer, whose material is `material`.
fn textured(material: Value, changes: &[(&str, Value)]) -> Result<Model, GltfError> {
    let mut data = buffer();
    let at = data.len();
    data.extend(TEXELS.concat().iter().flat_map(|v| v.to_le_bytes()));
    let picture = png();
    data.extend(&picture);
    let view =
        |at: usize, length: usize| json!({"buffer": 0, "byteOffset": at, "byteLength": length});
    let mut all = vec![
        ("/bufferViews/-", view(at, 32)),
        ("/bufferViews/-", view(at + 32, picture.len())),
        ("/buffers/0/byteLength", json!(data.len())),
        (
            "/accessors/-",
            json!({"bufferView": 4, "componentType": 5126, "count": 4, "type": "VEC2"}),
        ),
        ("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(2)),
        ("/meshes/0/primitives/0/material", json!(0)),
        ("/materials", json!([material])),
        ("/textures", json!([{"source": 0, "sampler": 0}])),
        (
            "/images",
            json!([{"bufferView": 5, "mimeType": "image/png"}]),
        ),
        ("/samplers", json!([{"wrapS": 33071, "magFilter": 9728}])),
    ];
    all.extend(changes.iter().cloned());
    parse(&glb(&with(&all), &data), "t.glb")
}

fn base_color(texture: Value) -> Value {
    json!({"pbrMetallicRoughness": {"baseColorTexture": texture}})
}

#[test]
fn base_colours_have_their_pictures_where_coordinates_say() {
    let model = textured(base_color(json!({"index": 0})), &[]).unwrap();
    assert_eq!(codes(&model), [""; 0]);
    let piece = &model.pieces[0];
    let texture = piece.parts[0].texture.as_ref().unwrap();
    assert_eq!(texture.picture.encoded(), png());
    assert_eq!(
        texture.sampler.address[0],
        gnomon_raster::AddressMode::ClampToEdge
    );
    assert_eq!(texture.sampler.mag, gnomon_raster::FilterMode::Nearest);
    let expected = TRIANGLES.map(|t| t.map(|v| TEXELS[v as usize]));
    assert_eq!(piece.coordinates, expected);
    // A mirrored node turns triangles round, and their coordinates with them.
    let node = json!({"mesh": 0, "scale": [-1, 1, 1]});
    let mirrored = textured(base_color(json!({"index": 0})), &[("/nodes/0", node)]).unwrap();
    let turned = TRIANGLES.map(|[a, b, c]| [a, c, b].map(|v| TEXELS[v as usize]));
    assert_eq!(mirrored.pieces[0].coordinates, turned);
    // KHR_texture_transform, and coordinates of another set that there is none of.
    let moved = json!({"index": 0, "extensions": {"KHR_texture_transform": {"offset": [1, 0], "scale": [2, 1]}}});
    let moved = textured(base_color(moved), &[]).unwrap();
    let expected = expected.map(|t| t.map(|[u, v]| [2.0 * u + 1.0, v]));
    assert_eq!(moved.pieces[0].coordinates, expected);
    let other = textured(base_color(json!({"index": 0, "texCoord": 1})), &[]).unwrap();
    assert_eq!(other.pieces[0].coordinates, [[[0.0; 2]; 3]; 0]);
}

#[test]
fn pictures_that_cannot_be_had_are_told_and_wrong_numbers_are_errors() {
    let plain = || base_color(json!({"index": 0}));
    for (images, what) in [
        (
            json!([{"uri": "data:image/png;base64,AAAA"}]),
            "images[0]: is no PNG or JPEG",
        ),
        (json!([{"uri": "wood.png"}]), "'wood.png'"),
        (json!([{"bufferView": 0}]), "is no PNG"),
    ] {
        let model = textured(plain(), &[("/images", images)]).unwrap();
        assert!(model.pieces[0].parts[0].texture.is_none());
        assert_eq!(codes(&model), ["missing-maps"]);
        let message = &model.warnings[0].message;
        assert!(message.contains(what), "{message}");
    }
    let data = {
        const WORDS: &[u8; 64] =
            b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let encode = |c: &[u8]| {
            let word = c.iter().fold(0_u32, |w, b| w << 8 | u32::from(*b)) << (8 * (3 - c.len()));
            let letters = (0..=c.len()).map(|k| WORDS[(word >> (18 - 6 * k) & 63) as usize]);
            letters.map(char::from).collect::<String>()
        };
        png().chunks(3).map(encode).collect::<String>()
    };
    let inside = json!([{"uri": format!("data:image/png;base64,{data}")}]);
    let model = textured(plain(), &[("/images", inside)]).unwrap();
    assert!(model.pieces[0].parts[0].texture.is_some());
    for (pointer, value, what) in [
        (
            "/textures",
            json!([]),
            "materials[0]: 0 is none of the 0 textures",
        ),
        (
            "/textures",
            json!([{"source": 3}]),
            "textures[0]: 3 is none of the 1 images",
        ),
        (
            "/textures",
            json!([{"source": 0, "sampler": 1}]),
            "none of the 1 samplers",
        ),
        (
            "/images",
            json!([{}]),
            "images[0]: uri or bufferView is missing",
        ),
    ] {
        let error = textured(plain(), &[(pointer, value)])
            .unwrap_err()
            .to_string();
        assert!(error.contains(what), "{error}");
    }
}

/// What lies on nothing must not cost the model, nor what lies wrongly.
#[test]
fn coordinates_that_cannot_be_used_are_told() {
    let plain = || base_color(json!({"index": 0}));
    for material in [plain(), json!({})] {
        for (pointer, value, what) in [
            ("/accessors/2/type", json!("VEC3"), "'VEC3'"),
            ("/accessors/2/count", json!(5), "accessors[2]"),
            (
                "/accessors/2/bufferView",
                json!(9),
                "none of the 6 bufferViews",
            ),
        ] {
            let model = textured(material.clone(), &[(pointer, value)]).unwrap();
            assert_eq!(codes(&model), ["bad-coordinates"], "{pointer}");
            let message = &model.warnings[0].message;
            assert!(message.contains(what), "{message}");
            assert!(model.pieces[0].coordinates.is_empty());
            assert_eq!(model.pieces[0].shape.triangles.len(), TRIANGLES.len());
        }
    }
}

/// A hundred images in one view are one picture.
#[test]
fn pictures_that_repeat_are_one() {
    let images = vec![json!({"bufferView": 5}); 2];
    let model = textured(
        base_color(json!({"index": 0})),
        &[
            ("/images", json!(images)),
            ("/textures", json!([{"source": 0}, {"source": 1}])),
            ("/materials/-", base_color(json!({"index": 1}))),
            (
                "/meshes/0/primitives/-",
                json!({"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "material": 1}),
            ),
        ],
    );
    let model = model.unwrap();
    let pictures: Vec<_> = (model.pieces[0].parts.iter())
        .map(|p| &p.texture.as_ref().unwrap().picture)
        .collect();
    assert_eq!(pictures.len(), 2);
    assert!(std::sync::Arc::ptr_eq(pictures[0], pictures[1]));
}

/// The file with keys at 0, 1 and 3 seconds, whose node goes along x and turns about y.
fn moving(changes: &[(&str, Value)]) -> Value {
    let mut all = vec![
        (
            "/bufferViews/-",
            json!({"buffer": 0, "byteOffset": 132, "byteLength": 12}),
        ),
        (
            "/bufferViews/-",
            json!({"buffer": 0, "byteOffset": 144, "byteLength": 36}),
        ),
        ("/buffers/0/byteLength", json!(180)),
        (
            "/accessors/-",
            json!({"bufferView": 4, "componentType": 5126, "count": 3, "type": "SCALAR"}),
        ),
        (
            "/accessors/-",
            json!({"bufferView": 5, "componentType": 5126, "count": 3, "type": "VEC3"}),
        ),
        (
            "/animations",
            json!([{
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                "samplers": [{"input": 2, "output": 3}],
            }]),
        ),
    ];
    all.extend(changes.iter().cloned());
    with(&all)
}

fn moving_at(changes: &[(&str, Value)], time: f64) -> Result<Model, GltfError> {
    let mut data = buffer();
    let keys = [0.0_f32, 1.0, 3.0];
    let places = [[0.0_f32; 3], [2.0, 0.0, 0.0], [2.0, 8.0, 0.0]];
    data.extend(
        keys.iter()
            .chain(places.as_flattened())
            .flat_map(|v| v.to_le_bytes()),
    );
    parse_at(&glb(&moving(changes), &data), "t.glb", time)
}

#[test]
fn nodes_move_with_the_first_animation() {
    let low = |time: f64, changes: &[(&str, Value)]| {
        let model = moving_at(changes, time).unwrap();
        assert!(model.moves);
        model.bounds().unwrap().0
    };
    assert_eq!(low(0.0, &[]), DVec3::ZERO);
    assert_eq!(low(0.5, &[]), DVec3::X);
    assert_eq!(low(1.5, &[]), DVec3::new(2.0, 2.0, 0.0));
    assert_eq!(low(99.0, &[]), DVec3::new(2.0, 8.0, 0.0), "held at the end");
    let step = [("/animations/0/samplers/0/interpolation", json!("STEP"))];
    assert_eq!(low(0.999, &step), DVec3::ZERO);
    // A parent takes its children with it, and what is not animated stays the node's own.
    let child = json!([{"children": [1]}, {"mesh": 0, "translation": [0, 0, 5]}]);
    assert_eq!(low(0.5, &[("/nodes", child)]), DVec3::new(1.0, 0.0, 5.0));
    let scaled = [("/animations/0/channels/0/target/path", json!("scale"))];
    assert_eq!(moving_at(&scaled, 1.5).unwrap().bounds().unwrap().1.x, 3.0);
    // A node of no size is still there.
    let point = moving_at(&scaled, 0.0).unwrap();
    assert_eq!(point.bounds().unwrap(), (DVec3::ZERO, DVec3::ZERO));
    let still = read(&file()).unwrap();
    assert!(!still.moves);
}

#[test]
fn animations_that_cannot_be_are_told() {
    let weights = [
        (
            "/animations/0/channels/-",
            json!({"sampler": 0, "target": {"node": 0, "path": "weights"}}),
        ),
        (
            "/animations/0/channels/-",
            json!({"sampler": 0, "target": {"path": "pointer"}}),
        ),
    ];
    let model = moving_at(&weights, 0.5).unwrap();
    assert_eq!(
        (codes(&model), model.warnings[0].count),
        (vec!["ignored-channels"], 2)
    );
    for (pointer, value, what) in [
        (
            "/animations/0/samplers/0/interpolation",
            json!("SMOOTH"),
            "'SMOOTH'",
        ),
        (
            "/animations/0/channels/0/sampler",
            json!(4),
            "none of the 1 samplers",
        ),
        (
            "/animations/0/channels/0/target/node",
            json!(9),
            "none of the 1 nodes",
        ),
        (
            "/animations/0/channels/0/target/path",
            json!("rotation"),
            "VEC4",
        ),
        (
            "/animations/0/samplers/0/interpolation",
            json!("CUBICSPLINE"),
            "three",
        ),
        ("/accessors/2/count", json!(2), "each time"),
        (
            "/accessors/2/bufferView",
            json!(5),
            "later than the one before",
        ),
    ] {
        let error = moving_at(&[(pointer, value)], 0.5).unwrap_err().to_string();
        assert!(error.contains(what), "{error}");
    }
}

#[test]
fn files_of_version_1_are_named_so() {
    let first = br#"{"asset": {"version": "1.0"}, "meshes": {"a": {}}, "scene": "s"}"#;
    let error = parse(first, "t.gltf").unwrap_err().to_string();
    assert_eq!(error, "t.gltf: asset: version is '1.0'; version 2 is read");
}
