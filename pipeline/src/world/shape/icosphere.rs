//! Subdivided icosahedra.

use std::collections::BTreeMap;

use glam::DVec3;

use super::Shape;

const FACES: [[u32; 3]; 20] = [
    [0, 11, 5],
    [0, 5, 1],
    [0, 1, 7],
    [0, 7, 10],
    [0, 10, 11],
    [1, 5, 9],
    [5, 11, 4],
    [11, 10, 2],
    [10, 7, 6],
    [7, 1, 8],
    [3, 9, 4],
    [3, 4, 2],
    [3, 2, 6],
    [3, 6, 8],
    [3, 8, 9],
    [4, 9, 5],
    [2, 4, 11],
    [6, 2, 10],
    [8, 6, 7],
    [9, 8, 1],
];

/// A sphere of `20 * 4^subdivisions` triangles: midpoints of edges in the order
/// ab, bc, ca, pushed out to the sphere, shared by neighbouring faces.
pub fn icosphere(subdivisions: u32, radius: f64, centre: DVec3) -> Shape {
    let mut shape = Shape {
        positions: golden_vertices().map(unit).collect(),
        triangles: FACES.to_vec(),
    };
    for _ in 0..subdivisions {
        subdivide(&mut shape);
    }
    shape
        .positions
        .iter_mut()
        .for_each(|p| *p = *p * radius + centre);
    shape
}

fn golden_vertices() -> impl Iterator<Item = DVec3> {
    let g = (1.0 + 5.0f64.sqrt()) / 2.0;
    [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ]
    .into_iter()
    .map(DVec3::from)
}

/// Divided by its length (not multiplied by the reciprocal, which rounds twice).
fn unit(p: DVec3) -> DVec3 {
    p / p.length()
}

fn subdivide(shape: &mut Shape) {
    let mut midpoints = BTreeMap::new();
    let positions = &mut shape.positions;
    let mut midpoint = |a: u32, b: u32| {
        *midpoints.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let sum = positions[a.min(b) as usize] + positions[a.max(b) as usize];
            positions.push(unit(sum));
            (positions.len() - 1) as u32
        })
    };
    shape.triangles = shape
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| {
            let ab = midpoint(a, b);
            let bc = midpoint(b, c);
            let ca = midpoint(c, a);
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        })
        .collect();
}
