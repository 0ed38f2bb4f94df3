//! The exact penumbra volume of one edge under a convex light.
//!
//! A receiver whose view of the light is cut by the edge lies at
//! `e + s (e - v)`, s >= 0, for a point e of the edge and a point v of the light.
//! All these points together are `conv{e0, e1} + cone{e_i - v}`: a convex set,
//! whose planes touch the light and hold one end of the edge or both. Papers III
//! (§3.1) and IV (§4.1) relocate a vertex to have planes at all; nothing of the
//! kind is needed.
//!
//! * Under a polygon every bounding plane is that of an end and a side of the
//!   light, or of the edge and a corner. A side's plane bounds at that end from
//!   which the other end is on its inner side; one determinant per side decides,
//!   with opposite results for the two ends, so the faces always fit together.
//! * Under discs and spheres the planes at an end are a family with one
//!   parameter. Those that bound make an arc, and at the ends of the arc are
//!   front and back plane, exact. Between them the cone is bounded by
//!   [`ARC_SEGMENTS`] tangent planes to the full turn: a polyhedron that encloses.
//!
//! Where the edge's line pierces the light, one end's cone holds the other's.

use std::f64::consts::TAU;

use glam::DVec3;

use super::polyhedron::{End, Ends};
use crate::geometry::area_light::AreaLight;

/// Tangent planes to a full turn round the cone under a disc or sphere; at the
/// corners between them the polyhedron exceeds the cone by 1/cos(pi/16) - 1 = 2 %.
pub const ARC_SEGMENTS: usize = 16;

/// Ends of the exact volume of an edge that is clear of the light
/// ([`AreaLight::clip`] without touch).
pub fn ends(light: &AreaLight, edge: [DVec3; 2]) -> Ends {
    match light {
        AreaLight::Polygon { corners, .. } => under_polygon(corners, edge),
        AreaLight::Disc {
            centre,
            normal,
            radius,
        } => {
            let families = edge.map(|e| TangentPlanes::to_disc(*centre, *normal, *radius, e));
            under_round_light(families)
        }
        AreaLight::Sphere { centre, radius } => {
            let families = edge.map(|e| TangentPlanes::to_sphere(*centre, *radius, e));
            under_round_light(families)
        }
    }
}

fn under_polygon(corners: &[DVec3], [e0, e1]: [DVec3; 2]) -> Ends {
    let n = corners.len();
    let inner = |j: usize| {
        let [v, w] = [corners[j] - e0, corners[(j + 1) % n] - e0];
        v.cross(w).dot(e1 - e0)
    };
    let first_bounds: Vec<f64> = (0..n).map(inner).collect();
    let ray = |e: DVec3| move |j: usize| e - corners[j % n];
    let cone = |e: DVec3| {
        Ends::One(End {
            apex: e,
            rays: (0..n).map(ray(e)).collect(),
        })
    };
    match longest_run(&first_bounds) {
        Run::All => cone(e0),
        Run::None => cone(e1),
        Run::Some { start, length } => Ends::Two([
            End {
                apex: e0,
                rays: (start..=start + length).map(ray(e0)).collect(),
            },
            End {
                apex: e1,
                rays: (start + length..=start + n).rev().map(ray(e1)).collect(),
            },
        ]),
    }
}

enum Run {
    All,
    None,
    /// Cyclic; `length` is below the number of values.
    Some {
        start: usize,
        length: usize,
    },
}

/// The cyclic run of values that are not negative; of several, which only
/// rounding can make, the one that holds the largest value.
fn longest_run(values: &[f64]) -> Run {
    let n = values.len();
    let holds = |j: usize| values[j % n] >= 0.0;
    if (0..n).all(holds) {
        return Run::All;
    }
    let largest = (0..n).fold(0, |best, j| if values[j] > values[best] { j } else { best });
    if !holds(largest) {
        return Run::None;
    }
    let before = (1..n).take_while(|k| holds(largest + n - k)).count();
    let after = (1..n).take_while(|k| holds(largest + k)).count();
    Run::Some {
        start: (largest + n - before) % n,
        length: before + 1 + after,
    }
}

/// The planes through a point that touch a round light, with normals
/// `k + u cos + v sin` of the angle, pointing away from the light. Rays between
/// planes of rising angle turn as a pyramid's ring must.
struct TangentPlanes {
    apex: DVec3,
    k: DVec3,
    u: DVec3,
    v: DVec3,
    /// Centre and two radii at right angles, for discs.
    disc: Option<[DVec3; 3]>,
}

/// An arc of tangent planes: middle and half width, radians.
#[derive(Clone, Copy)]
struct Arc {
    middle: f64,
    half: f64,
}

impl TangentPlanes {
    fn to_disc(centre: DVec3, normal: DVec3, radius: f64, apex: DVec3) -> Self {
        let (u, v) = right_handed(normal);
        let local = (apex - centre) / radius;
        let [x, y, z] = [u, v, normal].map(|axis| axis.dot(local));
        Self {
            apex,
            k: normal,
            u: u * z - normal * x,
            v: v * z - normal * y,
            disc: Some([centre, u * radius, v * radius]),
        }
    }

    fn to_sphere(centre: DVec3, radius: f64, apex: DVec3) -> Self {
        let away = apex - centre;
        let sine = (radius / away.length()).min(1.0);
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let axis = away.normalize();
        let (u, v) = right_handed(axis);
        Self {
            apex,
            k: axis * sine,
            u: u * cosine,
            v: v * cosine,
            disc: None,
        }
    }

    fn normal(&self, angle: f64) -> DVec3 {
        self.k + self.u * libm::cos(angle) + self.v * libm::sin(angle)
    }

    /// The ray in the planes at both angles, which are less than half a turn apart,
    /// the second not below the first.
    fn ray(&self, from: f64, to: f64) -> DVec3 {
        const HAIR: f64 = 1e-6;
        let middle = 0.5 * (from + to);
        let (sine, cosine) = (libm::sin(middle), libm::cos(middle));
        if let Some([centre, u, v]) = self.disc {
            // Where the tangents of the disc meet; an apex in its plane has rays too.
            let reach = 1.0 / libm::cos(0.5 * (to - from));
            return self.apex - centre - (u * cosine + v * sine) * reach;
        }
        if to - from < HAIR {
            return self.normal(middle).cross(self.v * cosine - self.u * sine);
        }
        self.normal(from).cross(self.normal(to))
    }

    /// Planes that have `direction` on their inner side; `Err` with whether all
    /// have.
    fn bounding(&self, direction: DVec3) -> Result<Arc, bool> {
        let [c, a, b] = [self.k, self.u, self.v].map(|axis| axis.dot(direction));
        let swing = (a * a + b * b).sqrt();
        if c >= swing || c <= -swing {
            return Err(c >= swing);
        }
        Ok(Arc {
            middle: libm::atan2(b, a),
            half: libm::acos(-c / swing),
        })
    }

    fn whole_cone(&self) -> Ends {
        let step = TAU / ARC_SEGMENTS as f64;
        let at = |k: usize| step * k as f64;
        let rays = (0..ARC_SEGMENTS).map(|k| self.ray(at(k), at(k + 1)));
        Ends::One(End {
            apex: self.apex,
            rays: rays.collect(),
        })
    }

    /// The rays between consecutive planes of the arc, those at its ends included.
    fn rays(&self, arc: Arc) -> Vec<DVec3> {
        let steps = (2.0 * arc.half / (TAU / ARC_SEGMENTS as f64))
            .ceil()
            .max(1.0) as usize;
        let at = |k: usize| arc.middle + (2.0 * k as f64 / steps as f64 - 1.0) * arc.half;
        (0..steps).map(|k| self.ray(at(k), at(k + 1))).collect()
    }
}

fn under_round_light([first, second]: [TangentPlanes; 2]) -> Ends {
    let edge = second.apex - first.apex;
    let arc = match first.bounding(edge) {
        Ok(arc) => arc,
        Err(true) => return first.whole_cone(),
        Err(false) => return second.whole_cone(),
    };
    let other = match second.bounding(-edge) {
        Ok(arc) => arc,
        // Only rounding brings the two ends to differ: the line just touches.
        Err(true) => return second.whole_cone(),
        Err(false) => return first.whole_cone(),
    };
    let mut far_rays = second.rays(other);
    far_rays.reverse(); // its planes rise from back to front
    Ends::Two([
        End {
            apex: first.apex,
            rays: first.rays(arc),
        },
        End {
            apex: second.apex,
            rays: far_rays,
        },
    ])
}

/// Unit vectors u, v with `u x v = axis`.
fn right_handed(axis: DVec3) -> (DVec3, DVec3) {
    let u = axis.any_orthonormal_vector();
    (u, axis.cross(u))
}

const _: () = assert!(
    ARC_SEGMENTS >= 4,
    "rays need planes less than half a turn apart"
);
