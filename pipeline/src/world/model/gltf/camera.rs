//! Eyes of a file.

use glam::DVec3;

use super::error::{Checked, GltfProblem, element};
use super::nodes::Placed;
use super::notes::Notes;
use super::schema::Root;
use crate::world::model::piece::ModelCamera;

/// Largest coordinate of an eye: one unit from there is another place to nine digits.
const FARTHEST: f64 = 1e9;

/// The eye at a node, if it is one in perspective and the `first`.
pub(super) fn at(
    root: &Root,
    placed: &Placed<'_>,
    first: Option<ModelCamera>,
    notes: &mut Notes,
) -> Checked<Option<ModelCamera>> {
    let Some(number) = placed.node.camera else {
        return Ok(first);
    };
    let camera = element(
        &root.cameras,
        number,
        "cameras",
        &format!("nodes[{}]", placed.number),
    )?;
    let place = format!("cameras[{number}]");
    let (None, Some(lens)) = (first, &camera.perspective) else {
        notes.cameras.add(|| place);
        return Ok(first);
    };
    let fov_y_degrees = lens.yfov.to_degrees();
    let bad = |what, value: String, valid| GltfProblem::Bad { what, value, valid }.at(&place);
    if !(fov_y_degrees > 0.0 && fov_y_degrees < 180.0) {
        let valid = "above 0 and below π (radians, vertical)";
        return Err(bad("perspective.yfov", lens.yfov.to_string(), valid));
    }
    if !(lens.znear > 0.0 && lens.znear.is_finite()) {
        let valid = "a finite number above 0";
        return Err(bad("perspective.znear", lens.znear.to_string(), valid));
    }
    let axis = |v| placed.model_from_node.transform_vector3(v);
    let [forward, up] = [axis(-DVec3::Z), axis(DVec3::Y)].map(|v| v / v.length());
    let eye = placed.model_from_node.transform_point3(DVec3::ZERO);
    // Their sine is NaN for axes without a length.
    let upright = forward.cross(up).length() > 1e-9;
    if eye.abs().max_element() > FARTHEST {
        let valid = "up to 1e9 from 0, where a direction has its digits";
        return Err(bad("the camera's place", eye.to_string(), valid));
    }
    if !eye.is_finite() || !upright {
        let valid = "a finite place, and axes that are not parallel";
        let value = format!("at {eye}, forward {forward}, up {up}");
        return Err(bad("the camera's node", value, valid));
    }
    Ok(Some(ModelCamera {
        eye,
        target: eye + forward,
        up,
        fov_y_degrees,
        near: lens.znear,
    }))
}
