//! What a renderer needs besides meshes: camera, lights, matrices.

use serde_json::{Value, json};

use super::{Exporting, tables};
use crate::world::scene::Scene;

/// Lights and camera as scene files have them; matrices as rows, for column vectors.
/// Objects name their OBJ files if those are `with_obj`.
pub(super) fn describe(
    scene: &Scene,
    size: [u32; 2],
    objects: &[Exporting<'_>],
    with_obj: bool,
) -> Value {
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let camera = &scene.camera;
    let lights: Vec<Value> = scene.lights.iter().map(tables::light).collect();
    let described: Vec<Value> = objects.iter().map(|o| object(o, with_obj)).collect();
    json!({
        "scene": scene.name,
        "size": size,
        "conventions": {
            "axes": "right-handed, y up; the eye looks along -z of the view",
            "matrices": "rows, for column vectors",
            "depth": "0 at the near plane, 1 at infinity",
            "triangles": "counter-clockwise from outside",
            "color": "linear RGB",
            "lights": "no falloff with distance; color is what a facing white surface is shaded with",
        },
        "camera": tables::camera(camera),
        "view_from_world": camera.view_from_world(),
        "clip_from_view": camera.clip_from_view(aspect),
        "clip_from_world": camera.clip_from_world(aspect).map(|r| r.map(f64::from)),
        "lights": lights,
        "ambient": scene.ambient.map(f64::from),
        "background": scene.background.map(f64::from),
        "objects": described,
    })
}

fn object(exporting: &Exporting<'_>, with_obj: bool) -> Value {
    let mesh = &exporting.object.mesh;
    let mut table = tables::object(exporting);
    if let (false, Some(table)) = (with_obj, table.as_object_mut()) {
        table.remove("mesh");
    }
    table["vertices"] = json!(mesh.positions().len());
    table["triangles"] = json!(mesh.triangles().len());
    table
}
