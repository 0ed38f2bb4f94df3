//! Polygons cut into triangles.
//!
//! A fan from the first corner is right for every convex polygon, and kept for
//! those. Others are cut by `earcut` in the plane of two coordinates that shows
//! them largest: leaving out the third one rounds nothing, and turns no convex
//! corner into a reflex one. earcut leaves out corners that lie on a straight
//! line, which would tear a solid open where its neighbour has them, so that they
//! are put back (`boundary`).

use earcut::Earcut;
use glam::{DVec2, DVec3};

use super::boundary;

/// How far a cut may be off the polygon's area, as a share of its extent squared:
/// more than files of six decimals round by, less than can be seen.
const ROUNDING: f64 = 1e-6;

/// Cuts polygons; keeps its buffers.
#[derive(Default)]
pub(super) struct Cutter {
    earcut: Earcut<f64>,
    plane: Vec<[f64; 2]>,
    ears: Vec<u32>,
}

/// How a polygon was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// The triangles cover the polygon once.
    Right,
    /// No cut does, since the outline crosses itself; a fan was made.
    Crossing,
}

impl Cutter {
    /// Appends the triangles of `corners`, at least three of them, of which
    /// `points` are the places. The edges of the triangles that are not shared are
    /// those of the outline.
    pub(super) fn cut(
        &mut self,
        corners: &[u32],
        points: &[DVec3],
        out: &mut Vec<[u32; 3]>,
    ) -> Cut {
        // Near the origin differences of coordinates lose no digits.
        let near: Vec<DVec3> = points.iter().map(|p| *p - points[0]).collect();
        let fan = || {
            let triangles = (1..corners.len() - 1).map(|k| [0, k, k + 1].map(|i| corners[i]));
            // A corner twice makes no triangle, and has no boundary.
            triangles.filter(|[a, b, c]| a != b && a != c)
        };
        let fan_normals = || near[1..].windows(2).map(|w| w[0].cross(w[1]));
        let normal: DVec3 = fan_normals().sum();
        if corners.len() == 3 || fan_normals().all(|n| n.dot(normal) >= 0.0) {
            out.extend(fan());
            let turned: f64 = fan_normals().map(|n| n.length()).sum();
            // Without a normal nothing tells which way round a triangle is.
            return judge(normal != DVec3::ZERO || turned <= tolerance(&near));
        }
        let ears = self.ears(corners, &near, normal);
        let right = ears.is_some();
        match ears {
            Some(triangles) => out.extend(triangles),
            None => out.extend(fan()),
        }
        judge(right)
    }

    /// The cut by earcut, unless the outline crosses itself.
    fn ears(&mut self, corners: &[u32], near: &[DVec3], normal: DVec3) -> Option<Vec<[u32; 3]>> {
        let axes = plane_of(normal);
        self.plane.clear();
        self.plane.extend(near.iter().map(|p| axes.map(|a| p[a])));
        let plane = std::mem::take(&mut self.plane);
        self.earcut.earcut_slice(&plane, &[], &mut self.ears);
        let at = |i: u32| DVec2::from(plane[i as usize]);
        let ears = self.ears.as_chunks::<3>().0;
        let mut cut = Planar {
            triangles: ears
                .iter()
                .map(|t| t.map(|i| (corners[i as usize], at(i))))
                .collect(),
        };
        let outline = (0..corners.len() as u32).map(|i| (corners[i as usize], at(i)));
        boundary::mend(&mut cut.triangles, &outline.collect::<Vec<_>>());
        let area = normal[3 - axes[0] - axes[1]].abs();
        let covers = cut.covers_once(area, tolerance(near));
        self.plane = plane;
        covers.then(|| {
            cut.triangles
                .iter()
                .map(|t| t.map(|(corner, _)| corner))
                .collect()
        })
    }
}

fn judge(right: bool) -> Cut {
    if right { Cut::Right } else { Cut::Crossing }
}

/// Twice the area that may be missing or too much; the first of `near` is 0.
fn tolerance(near: &[DVec3]) -> f64 {
    let lengths = near.iter().map(|p| p.length_squared());
    ROUNDING * lengths.fold(0.0, f64::max)
}

/// The two axes that show a polygon of that normal largest and counter-clockwise.
fn plane_of(normal: DVec3) -> [usize; 2] {
    let size = normal.abs();
    let left_out = (1..3).fold(0, |most, k| if size[k] > size[most] { k } else { most });
    let [next, after] = [(left_out + 1) % 3, (left_out + 2) % 3];
    if normal[left_out] > 0.0 {
        [next, after]
    } else {
        [after, next]
    }
}

/// Triangles in a plane, each corner with its place.
struct Planar {
    triangles: Vec<boundary::Triangle>,
}

impl Planar {
    /// Whether no triangle is turned round and all together have twice the `area`.
    fn covers_once(&self, area: f64, tolerance: f64) -> bool {
        let twice = |[a, b, c]: &boundary::Triangle| (b.1 - a.1).perp_dot(c.1 - a.1);
        let least = self.triangles.iter().map(twice).fold(0.0, f64::min);
        let sum: f64 = self.triangles.iter().map(twice).sum();
        least >= -tolerance && (sum - area).abs() <= tolerance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn cut(points: &[[f64; 3]]) -> (Vec<[u32; 3]>, Cut) {
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        cut_corners(&corners, points)
    }

    fn cut_corners(corners: &[u32], points: &[[f64; 3]]) -> (Vec<[u32; 3]>, Cut) {
        let places: Vec<DVec3> = corners.iter().map(|&i| points[i as usize].into()).collect();
        let mut out = Vec::new();
        let cut = Cutter::default().cut(corners, &places, &mut out);
        assert_boundary(corners, &out);
        (out, cut)
    }

    /// Every edge of the outline is walked by the triangles as often as by it.
    fn assert_boundary(corners: &[u32], triangles: &[[u32; 3]]) {
        let mut net: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        let mut walk = |a: u32, b: u32, by: i32| {
            *net.entry([a.min(b), a.max(b)]).or_default() += if a < b { by } else { -by };
        };
        for t in triangles {
            (0..3).for_each(|k| walk(t[k], t[(k + 1) % 3], 1));
        }
        (0..corners.len()).for_each(|k| walk(corners[k], corners[(k + 1) % corners.len()], -1));
        net.retain(|_, n| *n != 0);
        assert!(net.is_empty(), "{net:?} of {triangles:?}");
    }

    fn normals(triangles: &[[u32; 3]], points: &[[f64; 3]]) -> Vec<DVec3> {
        let at = |i: u32| DVec3::from(points[i as usize]);
        let normal = |t: &[u32; 3]| (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
        triangles.iter().map(normal).collect()
    }

    #[test]
    fn convex_polygons_are_fans() {
        let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&square), (vec![[0, 1, 2], [0, 2, 3]], Cut::Right));
    }

    #[test]
    fn the_notch_of_an_l_stays_open_in_all_planes() {
        let l = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        for axis in 0..3 {
            for reversed in [false, true] {
                for start in 0..6 {
                    let place = |[x, y]: [f64; 2]| {
                        let mut p = [0.0; 3];
                        (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (x, y);
                        p[axis] = 0.25 * x;
                        p
                    };
                    let mut points: Vec<_> = l.iter().map(|p| place(*p)).collect();
                    points.rotate_left(start);
                    if reversed {
                        points.reverse();
                    }
                    let (triangles, how) = cut(&points);
                    assert_eq!((triangles.len(), how), (4, Cut::Right));
                    let normals = normals(&triangles, &points);
                    let whole: DVec3 = normals.iter().sum();
                    assert!(normals.iter().all(|n| n.dot(whole) > 0.0), "{triangles:?}");
                    assert!((whole[axis].abs() - 6.0).abs() < 1e-12, "{whole}");
                }
            }
        }
    }

    /// A comb with points on its straight sides, which a neighbour may share.
    #[test]
    fn points_on_straight_sides_stay_corners() {
        let comb = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
            [0.0, 1.0],
        ];
        let points = comb.map(|[x, y]| [x, y, 0.0]);
        let (triangles, how) = cut(&points);
        assert_eq!(how, Cut::Right);
        let areas = normals(&triangles, &points).into_iter().map(|n| n.z);
        let areas: Vec<f64> = areas.collect();
        assert!(areas.iter().all(|a| *a > 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), 10.0);
        assert_eq!(triangles.len(), 10);
    }

    #[test]
    fn a_hole_by_way_of_a_bridge_is_left_out() {
        let points = [
            [0.0, 0.0, 0.0],
            [3.0, 0.0, 0.0],
            [3.0, 3.0, 0.0],
            [0.0, 3.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 2.0, 0.0],
            [2.0, 2.0, 0.0],
            [2.0, 1.0, 0.0],
        ];
        let (triangles, how) = cut_corners(&[0, 1, 2, 3, 0, 4, 5, 6, 7, 4], &points);
        assert_eq!(how, Cut::Right);
        let areas = normals(&triangles, &points).into_iter().map(|n| n.z);
        assert_eq!(areas.sum::<f64>(), 16.0);
    }

    #[test]
    fn outlines_that_cross_are_told() {
        let bow_tie = [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&bow_tie).1, Cut::Crossing);
        let lopsided = [[0.0; 3], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&lopsided).1, Cut::Crossing);
        // On one line nothing can be wrong.
        let line = [[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert_eq!(cut(&line).1, Cut::Right);
    }

    #[test]
    fn rounding_is_no_crossing() {
        for far in [0.0, 5.4e6] {
            let corner = |k: u32| {
                let (side, part) = (k / 3, f64::from(k % 3) / 3.0);
                let at = |s: u32| {
                    crate::world::shape::on_circle(f64::from(s) * std::f64::consts::PI / 3.0)
                };
                let ((ax, ay), (bx, by)) = (at(side), at(side + 1));
                let round = |v: f64| (v * 1e6).round() / 1e6 + far;
                [
                    round(ax + (bx - ax) * part),
                    0.5,
                    round(ay + (by - ay) * part),
                ]
            };
            let polygon: Vec<_> = (0..18).map(corner).collect();
            assert_eq!(cut(&polygon).1, Cut::Right);
        }
    }

    proptest! {
        /// Any star round a centre is simple: it is covered exactly, and its
        /// outline is the boundary. Coarse radii make many points collinear.
        #[test]
        fn stars_are_cut_right(radii in prop::collection::vec(1u32..5, 3..40)) {
            let n = radii.len() as f64;
            let points: Vec<[f64; 3]> = radii.iter().enumerate().map(|(k, r)| {
                let (c, s) = crate::world::shape::on_circle(k as f64 * 2.0 * std::f64::consts::PI / n);
                let snap = |v: f64| (v * f64::from(*r) * 8.0).round() / 8.0;
                [snap(c), snap(s), 1.0]
            }).collect();
            let mut corners: Vec<u32> = (0..points.len() as u32).collect();
            corners.dedup_by_key(|i| points[*i as usize].map(f64::to_bits));
            prop_assume!(corners.len() > 3);
            let (triangles, how) = cut_corners(&corners, &points);
            if how == Cut::Right {
                let areas = normals(&triangles, &points);
                let tolerance = 32.0 * ROUNDING;
                prop_assert!(areas.iter().all(|n| n.z >= -tolerance), "{areas:?}");
            }
        }

        /// Whatever the corners, the boundary is the outline, so that no cut opens a solid.
        #[test]
        fn no_cut_opens_a_solid(corners in prop::collection::vec(0u32..12, 3..24)) {
            let points: Vec<[f64; 3]> = (0..12u32)
                .map(|i| [f64::from(i * 5 % 4), f64::from(i * 7 % 5), f64::from(i % 2) * 0.125])
                .collect();
            let mut corners = corners;
            super::super::corners::drop_repeated(&mut corners);
            prop_assume!(corners.len() > 2);
            cut_corners(&corners, &points);
        }
    }
}
