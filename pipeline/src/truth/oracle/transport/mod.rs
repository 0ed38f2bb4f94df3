//! Precomputed transport: for each vertex of an object, how much of the light from
//! everywhere its own surface lets through, in spherical harmonics (Tamura et al. 2006,
//! equations 1 and 11).
//!
//! ```text
//! T = 1/π v_s max(ω·n, 0)        for diffuse reflection
//! V = v_s [ω·n > 0]              for what glossy reflection is convolved from
//! ```
//!
//! v_s is 0 where the object's own triangles are in the way. Without any, both are lobes
//! whose coefficients are known; so rays find only what is to be taken off them: the
//! directions of a spherical Fibonacci lattice, the same for all vertices, that meet a
//! triangle. What hides nothing of itself has exact coefficients and casts no ray.
//!
//! A vertex inside its own object (meshes of parts that overlap have such) sees nothing,
//! and would darken what lies between it and vertices that are seen. It takes the mean
//! of its neighbours outside, or is open where there are none; such vertices are
//! counted.
//!
//! The cosine that equation 9 leaves out is the half space of V, in which the reflection
//! of light from below the surface has no part.

mod buried;
mod key;
mod sampled;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

pub use key::TransportKey;
use sampled::Lattice;

use crate::geometry::harmonics::{Basis, about_axis, cosine_power, terms};
use crate::truth::oracle::bvh::{Bvh, Ray};
use crate::world::memo::Memo;
use crate::world::mesh::widen;

/// Changes with what is computed.
pub const TRANSPORT_VERSION: u32 = 1;

/// How transport is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransportSettings {
    /// Bands of T; the paper has 6.
    pub bands: usize,
    /// Bands of V; the paper has 4.
    pub glossy_bands: usize,
    /// Directions over the whole sphere that rays are cast in.
    pub directions: usize,
}

impl Default for TransportSettings {
    fn default() -> Self {
        Self {
            bands: 6,
            glossy_bands: 4,
            directions: 512,
        }
    }
}

/// Vertices of an object, in a place in which it does not turn, and the triangles that
/// can hide them.
#[derive(Clone, Copy, Debug)]
pub struct TransportObject<'a> {
    /// Positions of the vertices.
    pub positions: &'a [[f32; 3]],
    /// Their unit normals; zero where there is none, and then nothing arrives.
    pub normals: &'a [[f32; 3]],
    /// Triangles over the positions.
    pub triangles: &'a [[u32; 3]],
    /// Whether they hide anything.
    pub casts: bool,
}

/// Coefficients of all vertices, one vertex after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Transport {
    /// How they were computed.
    pub settings: TransportSettings,
    /// Of T.
    pub diffuse: Vec<f32>,
    /// Of V.
    pub glossy: Vec<f32>,
    /// Rays that were cast.
    pub rays: u64,
    /// Vertices inside the object.
    pub buried: u64,
}

impl Transport {
    /// Computes them; `done` is called with a number of vertices whenever those are
    /// done, from any thread.
    pub fn new(
        object: &TransportObject<'_>,
        settings: TransportSettings,
        done: &(dyn Fn(usize) + Sync),
    ) -> Self {
        let caster = Caster::new(object, settings);
        let vertex = |i: usize| {
            let found = caster.vertex(widen(object.positions[i]), widen(object.normals[i]));
            done(1);
            found
        };
        let count = object.positions.len();
        let mut all: Vec<Vertex> = (0..count).into_par_iter().map(vertex).collect();
        let buried = buried::replace(&mut all, object.triangles);
        let row = |values: &[f64]| values.iter().map(|v| *v as f32).collect::<Vec<_>>();
        Self {
            settings,
            diffuse: all.iter().flat_map(|v| row(&v.diffuse)).collect(),
            glossy: all.iter().flat_map(|v| row(&v.glossy)).collect(),
            rays: all.iter().map(|v| v.rays).sum(),
            buried,
        }
    }

    /// The same, unless it was computed before: it is kept by content while the program
    /// runs, so that an object that moves is computed once.
    pub fn kept(object: &TransportObject<'_>, settings: TransportSettings) -> Arc<Self> {
        let key = TransportKey::of(object, settings);
        KEPT.get(key.0, Self::bytes, || Self::new(object, settings, &|_| {}))
    }

    /// Keeps what came from elsewhere for [`Self::kept`].
    pub(super) fn keep(self: Arc<Self>, key: TransportKey) {
        let bytes = self.bytes();
        KEPT.keep(key.0, self, bytes);
    }

    /// What is kept under `key`.
    pub(super) fn find(key: &TransportKey) -> Option<Arc<Self>> {
        KEPT.find(&key.0)
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.diffuse.len() / terms(self.settings.bands)
    }

    /// Coefficients of T of a vertex.
    pub fn diffuse_of(&self, vertex: usize) -> &[f32] {
        let width = terms(self.settings.bands);
        &self.diffuse[vertex * width..(vertex + 1) * width]
    }

    /// Coefficients of V of a vertex.
    pub fn glossy_of(&self, vertex: usize) -> &[f32] {
        let width = terms(self.settings.glossy_bands);
        &self.glossy[vertex * width..(vertex + 1) * width]
    }

    /// Bytes of T: four a coefficient (the paper's "precomputation data").
    pub fn diffuse_bytes(&self) -> usize {
        self.diffuse.len() * size_of::<f32>()
    }

    /// Bytes of all.
    pub fn bytes(&self) -> usize {
        self.diffuse_bytes() + self.glossy.len() * size_of::<f32>()
    }
}

/// Objects of a few hundred thousand vertices together.
static KEPT: Memo<Transport> = Memo::new(128 << 20);

/// What is found at a vertex.
struct Vertex {
    diffuse: Vec<f64>,
    glossy: Vec<f64>,
    rays: u64,
    /// Inside the object; the coefficients are then those of an open surface.
    buried: bool,
}

/// What all vertices of an object share.
struct Caster {
    bases: [Basis; 2],
    lobes: [Vec<f64>; 2],
    lattice: Lattice,
    triangles: Bvh,
    corners: Vec<[DVec3; 3]>,
    /// How far rays start above a vertex, and how far along them nothing is met: some
    /// ten times the rounding of its coordinates.
    lift: f64,
    casts: bool,
}

/// [`Caster::lift`] as a share of the object's largest extent or coordinate.
const LIFT: f64 = 1e-6;

impl Caster {
    fn new(object: &TransportObject<'_>, settings: TransportSettings) -> Self {
        let counts = [settings.bands, settings.glossy_bands];
        let bases = counts.map(Basis::new);
        let corners = |t: &[u32; 3]| t.map(|i| widen(object.positions[i as usize]));
        let corners: Vec<_> = object.triangles.iter().map(corners).collect();
        Self {
            lobes: [1.0, 0.0].map(|n| cosine_power(n, counts[usize::from(n == 0.0)])),
            lattice: Lattice::new(settings.directions, &bases),
            triangles: Bvh::new(&corners),
            corners,
            lift: LIFT * extent(object.positions),
            casts: object.casts && !object.triangles.is_empty(),
            bases,
        }
    }

    fn vertex(&self, position: DVec3, normal: DVec3) -> Vertex {
        let normal = normal.normalize_or_zero();
        let open = [0, 1].map(|k| self.open(k, normal));
        let [mut diffuse, mut glossy] = open.clone();
        let (mut rays, mut buried) = (0, false);
        if self.casts && normal != DVec3::ZERO {
            let origin = position + normal * self.lift;
            let hides = |d| {
                let ray = Ray::new(origin, d);
                self.triangles.any(&ray, self.lift..f64::INFINITY)
            };
            let off = [&mut diffuse[..], &mut glossy[..]];
            let hidden = self.lattice.take_off(normal, hides, off);
            rays = hidden.asked;
            buried = hidden.met == rays && self.is_inside(origin, normal);
        }
        if buried {
            [diffuse, glossy] = open;
        }
        diffuse.iter_mut().for_each(|c| *c /= std::f64::consts::PI);
        Vertex {
            diffuse,
            glossy,
            rays,
            buried,
        }
    }

    /// Coefficients where nothing is hidden; none arrives where there is no normal.
    fn open(&self, basis: usize, normal: DVec3) -> Vec<f64> {
        if normal == DVec3::ZERO {
            return vec![0.0; terms(self.bases[basis].bands())];
        }
        about_axis(&self.bases[basis], normal, &self.lobes[basis])
    }

    /// Whether most directions before `normal` first meet a triangle from behind.
    fn is_inside(&self, origin: DVec3, normal: DVec3) -> bool {
        let (mut behind, mut all) = (0, 0);
        for d in self.lattice.before(normal) {
            let ray = Ray::new(origin, d);
            let Some((triangle, _)) = self.triangles.closest(&ray, self.lift..f64::INFINITY) else {
                continue;
            };
            let [a, b, c] = self.corners[triangle as usize];
            all += 1;
            behind += usize::from((b - a).cross(c - a).dot(d) > 0.0);
        }
        2 * behind > all
    }
}

/// Largest extent of points along an axis; 1 where there is none.
fn extent(positions: &[[f32; 3]]) -> f64 {
    let points = positions.iter().map(|p| widen(*p));
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.fold(none, |(low, high), p| (low.min(p), high.max(p)));
    let most = (high - low).max_element();
    if most > 0.0 && most.is_finite() {
        most
    } else {
        1.0
    }
}
