//! A ball of wires, for silhouettes that are as good as everywhere.

use std::collections::BTreeSet;

use glam::DVec3;

use super::palette::{STEEL, floor, solid};
use crate::world::light::{Light, LightShape};
use crate::world::scene::{Camera, Scene};
use crate::world::shape::{self, Shape};

/// Half the thickness of a wire.
const WIRE: f64 = 0.012;

/// A tube of four sides along each of an icosphere's 1,920 edges, over a floor and under
/// a sphere: more than 10,000 silhouette edges.
pub(super) fn scene() -> Scene {
    let ball = shape::icosphere(3, 1.0, DVec3::new(0.0, 1.25, 0.0));
    let edge = |a: u32, b: u32| (a.min(b), a.max(b));
    let edges: BTreeSet<(u32, u32)> = ball
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [edge(a, b), edge(b, c), edge(c, a)])
        .collect();
    let tube = |(a, b): (u32, u32)| {
        let [from, to] = [a, b].map(|i| ball.positions[i as usize]);
        shape::capsule(from, to, WIRE, WIRE, 4, 1)
    };
    let wires = Shape::merged(edges.into_iter().map(tube));
    let light = Light {
        shape: LightShape::Sphere {
            centre: DVec3::new(2.2, 5.2, 1.6),
            radius: 0.25,
        },
        colour: [1.0; 3],
    };
    let camera = Camera::look_at([1.2, 2.9, 4.9], [-0.4, 0.75, -0.1]);
    Scene::new(
        camera,
        vec![light],
        vec![floor(6.0), solid("wires", wires, STEEL)],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::silhouette::{Orientation, Silhouette, light_facing};
    use crate::world::adjacency::EdgeAdjacency;

    #[test]
    fn there_are_more_than_ten_thousand_silhouette_edges() {
        let scene = scene();
        let mesh = &scene.objects[1].mesh;
        let facing = light_facing(mesh, scene.lights[0].hard());
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        let silhouette = Silhouette::new(mesh, &adjacency, &Orientation::closed(&facing));
        assert!(
            silhouette.edges.len() >= 10_000,
            "{}",
            silhouette.edges.len()
        );
        assert_eq!(mesh.triangles().len(), 1920 * 16);
    }
}
