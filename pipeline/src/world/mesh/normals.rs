//! Shading normals: area-weighted, in f64, in a fixed order of summation.

use std::collections::BTreeMap;

use glam::DVec3;

use super::normal_tree::NormalTree;
use super::{narrow, widen};

/// How shading normals are formed from triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shading {
    /// One normal per position: the area-weighted mean of all adjacent
    /// triangles, summed as the peers' `normals()` does (all first corners in
    /// triangle order, then all second, then all third).
    Smooth,
    /// Every triangle has its own normal.
    Flat,
    /// Per corner: the area-weighted mean of the triangles round the position
    /// whose plane turns by at most `degrees` from this triangle's.
    Crease {
        /// Largest angle in degrees that still counts as smooth.
        degrees: f64,
    },
}

/// Returns normals and, per triangle and corner, indices into them.
pub(super) fn compute(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    shading: Shading,
) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let areas: Vec<DVec3> = triangles
        .iter()
        .map(|t| area_vector(positions, t))
        .collect();
    match shading {
        Shading::Smooth => (
            smooth(positions.len(), triangles, &areas),
            triangles.to_vec(),
        ),
        Shading::Flat => flat(&areas),
        Shading::Crease { degrees } => {
            let least_cosine = libm::cos(degrees.to_radians());
            creased(positions.len(), triangles, &areas, least_cosine)
        }
    }
}

/// Twice the area times the unit normal.
fn area_vector(positions: &[[f32; 3]], triangle: &[u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| widen(positions[i as usize]));
    (b - a).cross(c - a)
}

/// Unit length, or zero for (nearly) zero: the peers divide by
/// `max(length, 1e-30)`.
fn unit(v: DVec3) -> [f32; 3] {
    narrow(v / v.length().max(1e-30))
}

fn smooth(vertices: usize, triangles: &[[u32; 3]], areas: &[DVec3]) -> Vec<[f32; 3]> {
    let mut sums = vec![DVec3::ZERO; vertices];
    for corner in 0..3 {
        for (triangle, area) in triangles.iter().zip(areas) {
            sums[triangle[corner] as usize] += *area;
        }
    }
    sums.into_iter().map(unit).collect()
}

fn flat(areas: &[DVec3]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let normals = areas.iter().map(|a| unit(*a)).collect();
    let indices = (0..areas.len() as u32).map(|i| [i; 3]).collect();
    (normals, indices)
}

fn creased(
    vertices: usize,
    triangles: &[[u32; 3]],
    areas: &[DVec3],
    least_cosine: f64,
) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let incident = incident_triangles(vertices, triangles);
    let units: Vec<DVec3> = areas.iter().map(|a| *a / a.length().max(1e-30)).collect();
    let trees: Vec<Option<NormalTree<'_>>> = incident
        .iter()
        .map(|t| (t.len() > MANY).then(|| NormalTree::new(t, &units, areas)))
        .collect();
    let mut normals: Vec<[f32; 3]> = Vec::new();
    let mut met: Vec<Met> = vec![Met::new(); vertices];
    let mut corner_normal = |vertex: u32, own: usize| {
        let near = |t: usize| units[t].dot(units[own]) >= least_cosine;
        let sum = match &trees[vertex as usize] {
            Some(tree) if near(own) => tree.sum_near(units[own], least_cosine),
            Some(tree) => tree.sum_near(units[own], least_cosine) + areas[own],
            None => {
                let around = incident[vertex as usize].iter().map(|&t| t as usize);
                let near = around.filter(|&t| t == own || near(t));
                near.fold(DVec3::ZERO, |sum, t| sum + areas[t])
            }
        };
        intern(&mut normals, &mut met[vertex as usize], unit(sum))
    };
    let indices = triangles
        .iter()
        .enumerate()
        .map(|(t, corners)| corners.map(|v| corner_normal(v, t)))
        .collect();
    (normals, indices)
}

/// Triangles round a vertex above which a tree sums them.
const MANY: usize = 512;

/// Normals in use at one position, by their bits.
type Met = BTreeMap<[u32; 3], u32>;

/// Index of `normal` among those in use at one position, added when new.
fn intern(normals: &mut Vec<[f32; 3]>, met: &mut Met, normal: [f32; 3]) -> u32 {
    *met.entry(normal.map(f32::to_bits)).or_insert_with(|| {
        normals.push(normal);
        (normals.len() - 1) as u32
    })
}

fn incident_triangles(vertices: usize, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut incident = vec![Vec::new(); vertices];
    for (t, corners) in triangles.iter().enumerate() {
        for &v in corners {
            incident[v as usize].push(t as u32);
        }
    }
    incident
}

#[cfg(test)]
mod tests {
    use super::super::Mesh;
    use super::*;
    use crate::world::shape;

    fn distinct_normals(shading: Shading) -> usize {
        let mesh = shape::cylinder(32, 0.5, 0.0, 1.5)
            .into_mesh(shading)
            .unwrap();
        mesh.normals().len()
    }

    #[test]
    fn a_creased_cylinder_has_round_sides_and_sharp_rims() {
        // 32 side normals per ring, one cap normal per ring vertex and centre.
        assert_eq!(
            distinct_normals(Shading::Crease { degrees: 40.0 }),
            4 * 32 + 2
        );
        assert_eq!(distinct_normals(Shading::Smooth), 2 * 32 + 2);
        assert_eq!(distinct_normals(Shading::Flat), 4 * 32);
    }

    #[test]
    fn a_creased_cylinder_side_normal_is_horizontal() {
        let mesh = shape::cylinder(32, 0.5, 0.0, 1.5)
            .into_mesh(Shading::Crease { degrees: 40.0 })
            .unwrap();
        let normal = mesh.normals()[mesh.normal_triangles()[0][0] as usize];
        assert!(normal[1].abs() < 1e-6, "{normal:?}");
    }

    #[test]
    fn smooth_sphere_normals_point_outwards() {
        let mesh = shape::icosphere(2, 1.0, DVec3::ZERO)
            .into_mesh(Shading::Smooth)
            .unwrap();
        for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
            assert!(widen(*p).dot(widen(*n)) > 0.99);
        }
    }

    /// The height of the normal at the tip of a cone, in each of its triangles.
    fn heights_at_tip(segments: u32) -> Vec<f32> {
        let (tip, middle) = (segments, segments + 1);
        let mut cone = shape::Shape::default();
        for k in 0..segments {
            let (c, s) = shape::on_circle(shape::step_angle(k, segments));
            cone.positions.push(DVec3::new(c, 0.0, -s));
            let next = (k + 1) % segments;
            cone.triangles.extend([[k, next, tip], [next, k, middle]]);
        }
        cone.positions.extend([DVec3::Y, DVec3::ZERO]);
        let mesh = cone.into_mesh(Shading::Crease { degrees: 60.0 }).unwrap();
        let sides = mesh.normal_triangles().iter().step_by(2);
        sides.map(|n| mesh.normals()[n[2] as usize][1]).collect()
    }

    #[test]
    fn vertices_of_many_triangles_are_shaded_as_others() {
        let (few, many) = (heights_at_tip(MANY as u32), heights_at_tip(MANY as u32 + 1));
        for height in many.iter().chain(&few) {
            assert!((height - few[0]).abs() < 0.01, "{height} {}", few[0]);
        }
        assert!(few[0] > 0.7 && few[0] < 0.99, "{}", few[0]);
    }

    #[test]
    fn degenerate_triangles_give_zero_not_nan() {
        let mesh = Mesh::new(vec![[1.0; 3]; 3], vec![[0, 1, 2]], Shading::Smooth).unwrap();
        assert_eq!(mesh.normals(), [[0.0; 3]; 3]);
    }
}
