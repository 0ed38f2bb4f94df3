//! Silhouettes loop by loop, as paper IV combines them (§5.1).
//!
//! A loop round a hole hides less than nothing on its own, and visibility between 0 and
//! 1 has no room for that: as the paper writes it, what several loops enclose is combined
//! as if holes were filled. Outlines ([`SoftCasters::outlines`]) keep them.

use glam::DVec3;

use super::edges::{Silhouettes, SoftCasters, SoftEdge, beside_eye};
use crate::geometry::outlines::pieces;
use crate::geometry::silhouette::{Orientation, Silhouette};
use crate::geometry::silhouette_loops::SilhouetteLoops;
use crate::geometry::slivers::{Slivers, facing};
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::HardLight;
use crate::world::mesh::Mesh;

/// Loops, each for itself.
#[derive(Default)]
pub(crate) struct Loops {
    /// In the order of casters, their outlines and the outlines' edges.
    pub(crate) silhouettes: Vec<Silhouettes>,
    /// How many of them run round holes.
    pub(crate) holes: u64,
}

impl SoftCasters<'_> {
    /// Silhouettes seen from `centre`, loop by loop, caster after caster.
    pub(crate) fn loops(&self, centre: DVec3) -> Loops {
        let light = HardLight::Point(centre);
        let mut all = Loops::default();
        for examined in &self.examined {
            let orientation = examined.orientation(light);
            let adjacency = examined.caster.adjacency();
            for piece in pieces(&examined.object.mesh, adjacency, &orientation) {
                self.add_loops(&piece, centre, &mut all);
            }
        }
        all
    }

    fn add_loops(&self, piece: &Mesh, centre: DVec3, all: &mut Loops) {
        let loops = loops_of(piece, centre);
        if loops.len() < 2 {
            let parts = self.parts_of_piece(piece, centre).into_iter();
            let parts = parts.map(|(silhouettes, _)| silhouettes);
            all.silhouettes
                .extend(parts.filter(Silhouettes::hides_anything));
            return;
        }
        let eye = beside_eye(self.camera);
        // What the near plane cuts away belongs to the loop that encloses the most.
        let mut near_caps = self.of_piece(piece, centre).near_caps;
        let turns: Vec<f64> = loops.iter().map(|l| enclosed(l, centre)).collect();
        let widest = (0..turns.len()).reduce(|a, b| if turns[b] > turns[a] { b } else { a });
        for (number, corners) in loops.iter().enumerate() {
            all.holes += u64::from(turns[number] < 0.0);
            let next = |k: usize| corners[(k + 1) % corners.len()];
            let edges = (0..corners.len()).map(|k| [corners[k], next(k)]);
            all.silhouettes.push(Silhouettes {
                edges: edges.map(|e| SoftEdge::new(e, centre, eye)).collect(),
                eye_count: count_behind(corners, centre, eye),
                near_caps: if Some(number) == widest {
                    std::mem::take(&mut near_caps)
                } else {
                    Vec::new()
                },
            });
        }
    }
}

/// Corners of each loop of a surface all of which casts.
fn loops_of(piece: &Mesh, centre: DVec3) -> Vec<Vec<DVec3>> {
    let light = HardLight::Point(centre);
    let adjacency = EdgeAdjacency::new(piece.triangles());
    let facing = facing(piece, &adjacency, light, Slivers::WithoutArea);
    let orientation = Orientation::generalised(&facing);
    let silhouette = Silhouette::new(piece, &adjacency, &orientation);
    let Ok(loops) = SilhouetteLoops::new(&silhouette) else {
        return Vec::new(); // its edges balance by construction
    };
    let corners = loops.vertices(&silhouette);
    corners
        .map(|l| l.iter().map(|i| piece.position(*i)).collect())
        .collect()
}

/// Twice the area that a loop encloses across the direction to its middle, at distance
/// 1 from `centre`; negative round a hole.
fn enclosed(corners: &[DVec3], centre: DVec3) -> f64 {
    let seen: Vec<DVec3> = corners
        .iter()
        .map(|c| (*c - centre).normalize_or_zero())
        .collect();
    let middle = seen.iter().sum::<DVec3>().normalize_or_zero();
    let pairs = (0..seen.len()).map(|k| [seen[k], seen[(k + 1) % seen.len()]]);
    // The occluder is on the left seen from the light: the turn is against the direction.
    -pairs.map(|[a, b]| a.cross(b).dot(middle)).sum::<f64>()
}

/// How often a loop runs round the line from `centre` to `eye`, if that lies behind the
/// loop, which has no surface to tell by: farther than its corners are on the average.
fn count_behind(corners: &[DVec3], centre: DVec3, eye: DVec3) -> i32 {
    let distance = |p: DVec3| (p - centre).length();
    let mean = corners.iter().map(|c| distance(*c)).sum::<f64>() / corners.len() as f64;
    if distance(eye) < mean {
        return 0;
    }
    let axis = (eye - centre).normalize_or_zero();
    let (u, v) = axis.any_orthonormal_pair();
    let angle = |c: DVec3| libm::atan2(v.dot(c - centre), u.dot(c - centre));
    let turn = |k: usize| {
        let [a, b] = [k, (k + 1) % corners.len()].map(|k| angle(corners[k]));
        let d = b - a;
        d - std::f64::consts::TAU * (d / std::f64::consts::TAU).round()
    };
    let turns: f64 = (0..corners.len()).map(turn).sum();
    // As for `enclosed`; in front of the light alone.
    let before = corners.iter().any(|c| (*c - centre).dot(axis) > 0.0);
    if before {
        -(turns / std::f64::consts::TAU).round() as i32
    } else {
        0
    }
}
