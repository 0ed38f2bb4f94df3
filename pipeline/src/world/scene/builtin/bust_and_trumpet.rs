//! Two objects with as many vertices as those of Tamura et al. 2006, table 1: a bust of
//! 5,776, where the paper has Venus, and a trumpet of 8,557.

use glam::{DMat4, DVec3};

use super::palette::{BRASS, STONE, floor};
use crate::world::light::Light;
use crate::world::mesh::Shading;
use crate::world::scene::{Camera, Material, Object, Scene};
use crate::world::shape::{self, Shape, on_circle, step_angle};

/// Rings of the bust, and points of each.
const BUST: [u32; 2] = [76, 76];
/// Rings of the trumpet, outside and then inside the bell, and points of each.
const TRUMPET: [u32; 2] = [199, 43];
/// Of these are inside the bell.
const INSIDE: u32 = 49;

/// The bust stands on the floor, the trumpet leans on nothing before it.
pub(super) fn scene() -> Scene {
    let light = Light::horizontal_square(DVec3::new(-2.6, 5.0, 2.2), 0.9);
    let camera = Camera::look_at([0.5, 2.0, 4.6], [0.1, 0.75, 0.0]);
    let lean = DMat4::from_translation(DVec3::new(0.35, 0.5, 0.75))
        * DMat4::from_rotation_y(0.45)
        * DMat4::from_rotation_z(0.28);
    Scene::new(
        camera,
        vec![light],
        vec![
            floor(6.0),
            smooth(
                "bust",
                bust().translated(DVec3::new(-0.5, 0.0, -0.3)),
                STONE,
            ),
            smooth("trumpet", trumpet().transformed(lean), BRASS),
        ],
    )
}

/// Round everywhere, so that a vertex is one of the mesh.
fn smooth(name: &str, shape: Shape, material: Material) -> Object {
    let mesh = shape.into_mesh(Shading::Smooth);
    Object::new(name, mesh.expect("built-in shapes are finite"), material)
}

/// Height, half the width and half the depth, from the foot to the crown.
const OUTLINE: [[f64; 3]; 14] = [
    [0.0, 0.34, 0.30],
    [0.06, 0.34, 0.30],
    [0.12, 0.20, 0.18],
    [0.22, 0.19, 0.16],
    [0.34, 0.36, 0.22],
    [0.62, 0.45, 0.27],
    [0.84, 0.52, 0.25],
    [0.95, 0.40, 0.20],
    [1.03, 0.16, 0.15],
    [1.14, 0.13, 0.14],
    [1.24, 0.19, 0.22],
    [1.40, 0.23, 0.27],
    [1.54, 0.19, 0.23],
    [1.63, 0.06, 0.07],
];

fn bust() -> Shape {
    let [along, around] = BUST;
    let ring = |i: u32| {
        let [y, width, depth] = on_outline(f64::from(i) / f64::from(along - 1));
        let point = |j: u32| {
            let (cos, sin) = on_circle(step_angle(j, around));
            DVec3::new(width * cos, y, -depth * sin)
        };
        (0..around).map(point).collect::<Vec<_>>()
    };
    shape::tube(&(0..along).map(ring).collect::<Vec<_>>())
}

/// A place along the outline, smooth through its points (Catmull and Rom).
fn on_outline(share: f64) -> [f64; 3] {
    let last = OUTLINE.len() - 1;
    let along = share * last as f64;
    let k = (along as usize).min(last - 1);
    let t = along - k as f64;
    let at = |i: usize| OUTLINE[i.min(last)];
    let (p0, p1, p2, p3) = (at(k.saturating_sub(1)), at(k), at(k + 1), at(k + 2));
    core::array::from_fn(|c| {
        let slope = [(p2[c] - p0[c]) / 2.0, (p3[c] - p1[c]) / 2.0];
        let (square, cube) = (t * t, t * t * t);
        (2.0 * cube - 3.0 * square + 1.0) * p1[c]
            + (cube - 2.0 * square + t) * slope[0]
            + (3.0 * square - 2.0 * cube) * p2[c]
            + (cube - square) * slope[1]
    })
}

/// Length of the horn, and where inside the bell its wall ends.
const LENGTH: f64 = 1.7;
const BOTTOM: f64 = 1.15;
/// Thickness of the wall.
const WALL: f64 = 0.012;

fn trumpet() -> Shape {
    let [along, around] = TRUMPET;
    let outside = along - INSIDE;
    let ring = |i: u32| {
        let (x, radius) = if i < outside {
            let x = LENGTH * f64::from(i) / f64::from(outside - 1);
            (x, radius(x))
        } else {
            let back = f64::from(i - outside) / f64::from(INSIDE - 1);
            let x = LENGTH + (BOTTOM - LENGTH) * back;
            (x, radius(x) - WALL)
        };
        let point = |j: u32| {
            let (cos, sin) = on_circle(step_angle(j, around));
            DVec3::new(x, radius * cos, radius * sin)
        };
        (0..around).map(point).collect::<Vec<_>>()
    };
    shape::tube(&(0..along).map(ring).collect::<Vec<_>>())
}

/// A stem with a mouthpiece that opens into a bell.
fn radius(x: f64) -> f64 {
    let bell = x / LENGTH;
    let mouth = (1.0 - x / 0.08).max(0.0);
    0.035 + 0.03 * mouth + 0.33 * bell * bell * bell * bell * bell * bell * bell * bell
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;

    #[test]
    fn objects_are_closed_and_have_the_papers_vertices() {
        let scene = scene();
        let counts = [("bust", 5_776), ("trumpet", 8_557)];
        for ((name, count), object) in counts.into_iter().zip(&scene.objects[1..]) {
            let mesh = &object.mesh;
            assert_eq!(object.name, name);
            assert_eq!(mesh.positions().len(), count);
            assert_eq!(mesh.shading_vertices().positions.len(), count);
            let adjacency = EdgeAdjacency::new(mesh.triangles());
            assert!(adjacency.closedness(mesh).is_closed(), "{name}");
            let (low, _) = mesh.bounds().unwrap();
            assert!(low.y >= 0.0, "{name}: {low}");
        }
    }
}
