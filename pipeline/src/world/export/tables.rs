//! Tables as scene files have them: of the camera, of lights, of objects.

use glam::DVec3;
use serde_json::{Map, Value, json};

use super::{Exporting, crease};
use crate::world::light::{Light, LightShape};
use crate::world::scene::{Camera, Scene};

fn triple(v: DVec3) -> Value {
    json!(v.to_array())
}

fn color(rgb: [f32; 3]) -> Value {
    json!(rgb.map(f64::from))
}

/// A name without what ends lines.
pub(super) fn word(name: &str) -> String {
    name.replace(char::is_control, " ")
}

pub(super) fn camera(camera: &Camera) -> Value {
    json!({
        "eye": triple(camera.eye),
        "target": triple(camera.target),
        "up": triple(camera.up),
        "fov": camera.fov_y_degrees,
        "near": camera.near,
    })
}

pub(super) fn light(light: &Light) -> Value {
    json!({"shape": shape(&light.shape), "color": color(light.colour)})
}

fn shape(shape: &LightShape) -> Value {
    match shape {
        LightShape::Point { position } => json!({"point": {"position": triple(*position)}}),
        LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        } => json!({"rectangle": {
            "centre": triple(*centre),
            "edge-u": triple(*edge_u),
            "edge-v": triple(*edge_v),
        }}),
        LightShape::Polygon(polygon) => {
            let vertices: Vec<Value> = polygon.vertices().iter().map(|v| triple(*v)).collect();
            json!({"polygon": {"vertices": vertices}})
        }
        LightShape::Disc {
            centre,
            normal,
            radius,
        } => json!({"disc": {
            "centre": triple(*centre),
            "normal": triple(*normal),
            "radius": radius,
        }}),
        LightShape::Sphere { centre, radius } => {
            json!({"sphere": {"centre": triple(*centre), "radius": radius}})
        }
        LightShape::Directional { towards } => {
            json!({"directional": {"towards": triple(*towards)}})
        }
    }
}

pub(super) fn object(object: &Exporting<'_>) -> Value {
    let mut table = json!({
        "name": word(&object.object.name),
        "mesh": {"obj": object.file},
        "crease": crease(&object.object.mesh),
        "casts": object.object.casts,
        "receives": object.object.receives,
    });
    if object.object.open {
        table["open"] = json!(true);
    }
    table
}

/// A scene file that names the OBJ files.
pub(super) fn scene_file(
    scene: &Scene,
    size: [u32; 2],
    name: &str,
    objects: &[Exporting<'_>],
) -> String {
    let mut table = Map::new();
    table.insert("name".to_owned(), json!(name));
    table.insert("size".to_owned(), json!(size));
    table.insert("ambient".to_owned(), color(scene.ambient));
    table.insert("background".to_owned(), color(scene.background));
    table.insert("camera".to_owned(), camera(&scene.camera));
    let lights: Vec<Value> = scene.lights.iter().map(light).collect();
    table.insert("lights".to_owned(), Value::Array(lights));
    let objects: Vec<Value> = objects.iter().map(object).collect();
    table.insert("objects".to_owned(), Value::Array(objects));
    toml::to_string(&Value::Object(table)).expect("tables have strings, numbers and arrays only")
}
