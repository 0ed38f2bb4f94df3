//! What is said of scene files elsewhere is what is read: `docs/scene-files.md`, and the
//! JSON Schema for editors.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::parse;
use crate::world::scene::SceneWarning;
use crate::world::scratch::Scratch;

const EYE: &str = "[camera]\neye = [0, 2, 5]\ntarget = [0, 0.5, 0]\n";
const LAMP: &str = "[[lights]]\nshape.point = { position = [1, 4, 1] }\n";
const BOX: &str = "[[objects]]\nmesh.box = { size = [1, 1, 1] }\n";

const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn docs(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../docs")
        .join(file)
}

fn schema() -> Value {
    let text = std::fs::read_to_string(docs("scene.schema.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// The TOML of a document, each with the tables that it lacks.
fn snippets() -> Vec<String> {
    let text = std::fs::read_to_string(docs("scene-files.md")).unwrap();
    let blocks = text.split("```toml\n").skip(1);
    let bare = blocks.map(|b| b.split("```").next().unwrap().to_owned());
    bare.map(complete).collect()
}

fn complete(mut text: String) -> String {
    let lit = text.contains("[[lights]]") || text.contains("[environment]");
    for (there, table) in [
        (text.contains("[camera]"), EYE),
        (lit, LAMP),
        (text.contains("[[objects]]"), BOX),
    ] {
        if !there {
            text += table;
        }
    }
    text
}

/// As JSON has it.
fn as_json(text: &str) -> Value {
    toml::from_str(text).unwrap()
}

/// A tetrahedron as a glTF file without a file beside it.
fn glb_of_a_tetrahedron() -> Vec<u8> {
    let points = [
        0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
    ];
    let mut data: Vec<u8> = points.iter().flat_map(|p| p.to_le_bytes()).collect();
    data.extend([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
    let json = serde_json::json!({
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 60}],
    });
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let word = |n: usize| (n as u32).to_le_bytes().to_vec();
    let length = 12 + 8 + json.len() + 8 + data.len();
    let head = [b"glTF".to_vec(), word(2), word(length)].concat();
    let first = [word(json.len()), b"JSON".to_vec(), json].concat();
    [head, first, word(data.len()), b"BIN\0".to_vec(), data].concat()
}

#[test]
fn each_snippet_of_the_document_is_a_scene() {
    let folder = Scratch::made("scene-snippets");
    std::fs::write(folder.join("bunny.obj"), TETRAHEDRON).unwrap();
    std::fs::write(folder.join("statue.glb"), glb_of_a_tetrahedron()).unwrap();
    image::RgbImage::new(2, 2)
        .save(folder.join("wood.png"))
        .unwrap();
    let snippets = snippets();
    assert!(snippets.len() >= 8, "{}", snippets.len());
    for text in &snippets {
        let scene = parse(text, "docs/scene-files.md", &folder);
        let scene = scene.unwrap_or_else(|e| panic!("{e}\n{text}"));
        // Of a map in few lights.
        let mut warnings = scene.warnings.iter();
        let known = |w: &_| {
            matches!(
                w,
                SceneWarning {
                    code: "environment-uncovered",
                    ..
                }
            )
        };
        assert!(warnings.all(known), "{:?}\n{text}", scene.warnings);
        check(&schema(), &schema(), &as_json(text), "").unwrap_or_else(|e| panic!("{e}\n{text}"));
    }
}

#[test]
fn every_key_is_in_a_snippet_of_the_document() {
    let mut used = BTreeSet::new();
    snippets()
        .iter()
        .for_each(|text| keys_of(&as_json(text), &mut used));
    let mut known = BTreeSet::new();
    properties(&schema(), &mut known);
    let missing: Vec<_> = known.difference(&used).collect();
    assert!(
        missing.is_empty(),
        "{missing:?} are in no snippet of docs/scene-files.md"
    );
}

fn keys_of(value: &Value, keys: &mut BTreeSet<String>) {
    match value {
        Value::Object(table) => {
            for (key, value) in table {
                keys.insert(key.clone());
                keys_of(value, keys);
            }
        }
        Value::Array(list) => list.iter().for_each(|v| keys_of(v, keys)),
        _ => {}
    }
}

/// All keys that a schema has properties for.
fn properties(schema: &Value, keys: &mut BTreeSet<String>) {
    if let Some(own) = schema["properties"].as_object() {
        keys.extend(own.keys().cloned());
        own.values().for_each(|s| properties(s, keys));
    }
    if schema["items"].is_object() {
        properties(&schema["items"], keys);
    }
    for other in schema["oneOf"].as_array().into_iter().flatten() {
        properties(other, keys);
    }
}

#[test]
fn the_scene_files_of_the_project_are_valid_by_the_schema() {
    let schema = schema();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let value = as_json(&std::fs::read_to_string(&path).unwrap());
            check(&schema, &schema, &value, "").unwrap_or_else(|e| panic!("{path:?}: {e}"));
            count += 1;
        }
    }
    assert!(count >= 5);
}

#[test]
fn what_the_reader_refuses_the_schema_refuses() {
    let schema = schema();
    let good = format!("{EYE}{LAMP}{BOX}");
    assert_eq!(check(&schema, &schema, &as_json(&good), ""), Ok(()));
    for (from, to) in [
        ("eye = [0, 2, 5]", "eye = [0, 2]"),
        ("eye = [0, 2, 5]", ""),
        ("target", "targte"),
        ("eye", "fov = 180\neye"),
        ("eye", "near = 0\neye"),
        ("shape.point = { position = [1, 4, 1] }", "shape.point = {}"),
        ("shape.point", "shape.lamp"),
        ("point = { position = [1, 4, 1] }", "square = { side = 1 }"),
        ("shape.point", "color = [-1, 0, 0]\nshape.point"),
        (
            "mesh.box = { size = [1, 1, 1] }",
            "mesh.sphere = { subdivisions = 8, radius = 1 }",
        ),
        ("mesh.box = { size = [1, 1, 1] }", "mesh.obj = 3"),
        ("mesh.box", "crease = 181\nmesh.box"),
        ("mesh.box", "casts = 1\nmesh.box"),
        ("mesh.box", "material.texture = 1\nmesh.box"),
        (
            "mesh.box",
            "material = { texture = \"a.png\", texture-repeat = 0 }\nmesh.box",
        ),
        ("mesh.box", "open = 1\nmesh.box"),
        ("[camera]", "size = [0, 5]\n[camera]"),
    ] {
        let text = good.replacen(from, to, 1);
        assert!(parse(&text, "s", Path::new(".")).is_err(), "{text}");
        assert!(
            check(&schema, &schema, &as_json(&text), "").is_err(),
            "{text}"
        );
    }
}

/// The names that the reader expects where `text` has the key `zzz`.
fn expected(text: &str) -> BTreeSet<String> {
    let message = parse(text, "s", Path::new(".")).unwrap_err().to_string();
    assert!(message.contains("zzz"), "{message}");
    // Of structs and of variants.
    if let Some((_, list)) = message.split_once("available keys: ") {
        return list.split(", ").map(|key| key.trim().to_owned()).collect();
    }
    let (_, list) = message
        .split_once("expected ")
        .unwrap_or_else(|| panic!("{message}"));
    list.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

fn names(schema: &Value, pointer: &str) -> BTreeSet<String> {
    let own = schema
        .pointer(&format!("{pointer}/properties"))
        .and_then(Value::as_object);
    own.unwrap_or_else(|| panic!("{pointer}"))
        .keys()
        .cloned()
        .collect()
}

/// For each variant of a `oneOf` its name, and where its schema is.
fn variants(schema: &Value, pointer: &str) -> Vec<(String, String)> {
    let all = schema
        .pointer(&format!("{pointer}/oneOf"))
        .unwrap()
        .as_array()
        .unwrap();
    let name = |v: &Value| v["required"][0].as_str().unwrap().to_owned();
    let places = all.iter().map(name).enumerate();
    places
        .map(|(k, n)| (n.clone(), format!("{pointer}/oneOf/{k}/properties/{n}")))
        .collect()
}

#[test]
fn the_schema_has_the_keys_that_the_reader_knows() {
    let schema = schema();
    let object = "/properties/objects/items";
    let light = "/properties/lights/items";
    for (pointer, text) in [
        ("", "zzz = 1".to_owned()),
        ("/properties/camera", "[camera]\nzzz = 1".to_owned()),
        (
            "/properties/environment",
            "[environment]\nzzz = 1".to_owned(),
        ),
        (light, "[[lights]]\nzzz = 1".to_owned()),
        (object, "[[objects]]\nzzz = 1".to_owned()),
        (
            &format!("{object}/properties/material"),
            "[[objects]]\nmaterial.zzz = 1".to_owned(),
        ),
        (
            &format!("{object}/properties/motion"),
            "[[objects]]\nmotion.zzz = 1".to_owned(),
        ),
        (
            &format!("{object}/properties/motion/properties/keys/items"),
            "[[objects]]\nmotion.keys = [{ zzz = 1 }]".to_owned(),
        ),
    ] {
        assert_eq!(names(&schema, pointer), expected(&text), "{pointer}");
    }
    for (pointer, table, key) in [
        (format!("{light}/properties/shape"), "lights", "shape"),
        (format!("{object}/properties/mesh"), "objects", "mesh"),
    ] {
        let variants = variants(&schema, &pointer);
        let own: BTreeSet<String> = variants.iter().map(|(name, _)| name.clone()).collect();
        assert_eq!(own, expected(&format!("[[{table}]]\n{key}.zzz = 1")));
        for (name, place) in variants {
            if schema.pointer(&place).unwrap()["type"] == "string" {
                continue;
            }
            let text = format!("[[{table}]]\n{key}.{name} = {{ zzz = 1 }}");
            assert_eq!(names(&schema, &place), expected(&text), "{name}");
        }
    }
    for key in ["form", "residual", "place", "ambient"] {
        let own = &schema["properties"]["environment"]["properties"][key]["enum"];
        let own = own
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_str().unwrap().to_owned());
        let text = format!("[environment]\n{key} = \"zzz\"");
        assert_eq!(own.collect::<BTreeSet<_>>(), expected(&text), "{key}");
    }
}

/// JSON Schema, as much of it as `scene.schema.json` uses; a word that is not known here is
/// a failure.
fn check(root: &Value, schema: &Value, value: &Value, at: &str) -> Result<(), String> {
    for (word, rule) in schema.as_object().unwrap() {
        let number = || value.as_f64().unwrap_or_default();
        let limit = rule.as_f64().unwrap_or_default();
        let length = value.as_array().map_or(0, Vec::len) as f64;
        let holds = match word.as_str() {
            "$schema" | "title" | "description" | "$defs" => true,
            "type" => is_of(value, rule.as_str().unwrap()),
            "enum" => rule.as_array().unwrap().contains(value),
            "minimum" => number() >= limit,
            "maximum" => number() <= limit,
            "exclusiveMinimum" => number() > limit,
            "exclusiveMaximum" => number() < limit,
            "minItems" => length >= limit,
            "maxItems" => length <= limit,
            "required" => has_all(value, rule),
            "anyOf" => rule
                .as_array()
                .unwrap()
                .iter()
                .any(|s| check(root, s, value, at).is_ok()),
            "oneOf" => {
                let fits = |s: &&Value| check(root, s, value, at).is_ok();
                rule.as_array().unwrap().iter().filter(fits).count() == 1
            }
            "$ref" => {
                let named = root.pointer(rule.as_str().unwrap().trim_start_matches('#'));
                check(root, named.unwrap(), value, at)?;
                true
            }
            "items" => {
                for (k, item) in value.as_array().into_iter().flatten().enumerate() {
                    check(root, rule, item, &format!("{at}[{k}]"))?;
                }
                true
            }
            "properties" => {
                for (key, schema) in rule.as_object().unwrap() {
                    if let Some(own) = value.get(key) {
                        check(root, schema, own, &format!("{at}.{key}"))?;
                    }
                }
                true
            }
            "additionalProperties" => {
                assert_eq!(rule, false);
                let known = &schema["properties"];
                let mut keys = value.as_object().into_iter().flatten();
                keys.all(|(key, _)| known.get(key).is_some())
            }
            other => panic!("'{other}' is not checked here"),
        };
        if !holds {
            return Err(format!("{at}: {word} {rule} does not hold for {value}"));
        }
    }
    Ok(())
}

fn is_of(value: &Value, kind: &str) -> bool {
    match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        other => panic!("type '{other}'"),
    }
}

fn has_all(value: &Value, keys: &Value) -> bool {
    let keys = keys.as_array().unwrap().iter();
    keys.map(|k| k.as_str().unwrap())
        .all(|k| value.get(k).is_some())
}
