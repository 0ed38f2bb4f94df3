//! The forest of nodes: where each one is.

use glam::{DMat4, DVec3, DVec4};

use super::error::{Checked, GltfProblem, element};
use super::pose::{Moved, Pose};
use super::schema::{Node, Root};

/// A node, and the model's coordinates from its own.
pub(super) struct Placed<'a> {
    pub(super) number: usize,
    pub(super) node: &'a Node,
    pub(super) model_from_node: DMat4,
}

/// The nodes of the file's scene in a pose, parents before their children, in the file's order.
pub(super) fn placed<'a>(root: &'a Root, pose: &Pose) -> Checked<Vec<Placed<'a>>> {
    let (roots, place) = roots(root)?;
    let mut met = vec![false; root.nodes.len()];
    let mut stack = Vec::new();
    meet(&mut met, &roots, || place)?;
    stack.extend(roots.iter().rev().map(|n| (*n, DMat4::IDENTITY)));
    let mut placed = Vec::new();
    while let Some((number, parent)) = stack.pop() {
        let node = &root.nodes[number];
        let place = || format!("nodes[{number}]");
        let model_from_node = parent * local(node, pose.get(&number), &place())?;
        meet(&mut met, &node.children, place)?;
        let children = node.children.iter().rev();
        stack.extend(children.map(|n| (*n, model_from_node)));
        placed.push(Placed {
            number,
            node,
            model_from_node,
        });
    }
    Ok(placed)
}

/// Marks the nodes that `place` lists before anything is kept of them, so that as many are
/// kept as there are, however often they are listed.
fn meet(met: &mut [bool], nodes: &[usize], place: impl FnOnce() -> String) -> Checked<()> {
    let count = met.len();
    for &index in nodes {
        let what = "nodes";
        let Some(met) = met.get_mut(index) else {
            return Err(GltfProblem::NoSuch { what, index, count }.at(place()));
        };
        if std::mem::replace(met, true) {
            return Err(GltfProblem::NotATree.at(format!("nodes[{index}]")));
        }
    }
    Ok(())
}

/// The scene's nodes; of a file without scenes those that are nobody's children.
fn roots(root: &Root) -> Checked<(Vec<usize>, String)> {
    if root.scenes.is_empty() {
        let mut child = vec![false; root.nodes.len()];
        for &c in root.nodes.iter().flat_map(|n| &n.children) {
            if let Some(child) = child.get_mut(c) {
                *child = true;
            }
        }
        let own = (0..child.len()).filter(|n| !child[*n]).collect();
        return Ok((own, "nodes".to_owned()));
    }
    let number = root.scene.unwrap_or(0);
    let scene = element(&root.scenes, number, "scenes", "scene")?;
    Ok((scene.nodes.clone(), format!("scenes[{number}].nodes")))
}

/// A node's own matrix, or translation, rotation and scale, as an animation has `moved` them.
fn local(node: &Node, moved: Option<&Moved>, place: &str) -> Checked<DMat4> {
    let moved = moved.copied();
    if let (Some(matrix), None) = (node.matrix, moved) {
        let columns = DMat4::from_cols_array(&matrix);
        if columns.row(3) != DVec4::W || !columns.is_finite() {
            let (what, value) = ("matrix", format!("{matrix:?}"));
            let valid = "finite numbers with the last row 0, 0, 0, 1 (columns come first)";
            return Err(GltfProblem::Bad { what, value, valid }.at(place));
        }
        return Ok(columns);
    }
    let moved = moved.unwrap_or_default();
    let offset = moved.translation.or(node.translation);
    let offset = DVec3::from(offset.unwrap_or([0.0; 3]));
    let scale = moved.scale.or(node.scale);
    let scale = DVec3::from(scale.unwrap_or([1.0; 3]));
    let turn = match moved.rotation.or(node.rotation) {
        Some(q) => rotation(q).ok_or_else(|| {
            let (what, value) = ("rotation", format!("{q:?}"));
            let valid = "a quaternion x, y, z, w that is not 0";
            GltfProblem::Bad { what, value, valid }.at(place)
        })?,
        None => DMat4::IDENTITY,
    };
    Ok(DMat4::from_translation(offset) * turn * DMat4::from_scale(scale))
}

/// The rotation of a quaternion of any length but 0.
fn rotation([x, y, z, w]: [f64; 4]) -> Option<DMat4> {
    let s = 2.0 / (x * x + y * y + z * z + w * w);
    if !(s.is_finite() && s > 0.0) {
        return None;
    }
    let column = |a, b, c| DVec4::new(a, b, c, 0.0);
    Some(DMat4::from_cols(
        column(
            1.0 - s * (y * y + z * z),
            s * (x * y + w * z),
            s * (x * z - w * y),
        ),
        column(
            s * (x * y - w * z),
            1.0 - s * (x * x + z * z),
            s * (y * z + w * x),
        ),
        column(
            s * (x * z + w * y),
            s * (y * z - w * x),
            1.0 - s * (x * x + y * y),
        ),
        DVec4::W,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quaternions_turn_the_right_way_at_any_length() {
        // A quarter about +y takes +z to +x.
        for length in [1.0, 0.25, 1e3] {
            let half = length * 0.5_f64.sqrt();
            let turned = rotation([0.0, half, 0.0, half]).unwrap();
            let x = turned.transform_vector3(DVec3::Z);
            assert!((x - DVec3::X).length() < 1e-12, "{x}");
        }
        assert!(rotation([0.0; 4]).is_none());
        assert!(rotation([f64::NAN; 4]).is_none());
    }
}
