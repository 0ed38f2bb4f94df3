//! Which surface the oracle's eye rays meet, as a depth buffer would tell it.

use glam::DVec3;
use rayon::prelude::*;

use crate::truth::oracle::area::VisibilityImage;
use crate::truth::oracle::surfaces::{SurfaceHit, Surfaces};
use crate::world::scene::{EyeRays, Scene};

/// How far from a pixel's centre an edge may be for the rasteriser, which snaps
/// vertices to 1/256 pixel, to take the other side of it: some times what two
/// vertices can move.
const REACH: f64 = 1.0 / 128.0;
/// Depth that rounding may add: some steps of a 24-bit buffer.
const STEPS: f64 = 8.0 / 16_777_216.0;
/// Cosine of the angle of normals, 3 degrees, below which an edge is sharp: the
/// visible share of a light may differ on its two sides.
const SHARP: f64 = 0.9986;

/// What one pixel's centre shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// In 0..1, as in a depth buffer: `1 - near / planar depth`.
    pub(super) depth: f64,
    /// How much a depth buffer may differ and still show this surface.
    tolerance: f64,
    /// Whether shadow falls on the surface.
    receives: bool,
}

/// How a pixel of a depth buffer compares with what is seen there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Match {
    /// Both show the same surface.
    Surface,
    /// Both show none.
    Background,
    /// An outline or sharp edge is within [`REACH`].
    Outline,
    /// Surfaces at different depths.
    OtherDepth,
    /// A surface is seen, the buffer shows none.
    MissingSurface,
    /// The buffer shows a surface, none is seen.
    ExtraSurface,
}

impl Match {
    /// Whether both show the same.
    pub(super) fn agrees(self) -> bool {
        matches!(self, Self::Surface | Self::Background)
    }
}

/// A facet under an image point.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Facet {
    hit: SurfaceHit,
    /// Of the area of a parallelogram of two sides.
    normal: DVec3,
}

/// What every pixel's centre shows; nothing where no surface is seen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sight {
    seen: Vec<Option<Seen>>,
    /// Whether a sharp edge or an outline is within [`REACH`] of the centre.
    near_edge: Vec<bool>,
}

impl Sight {
    pub(super) fn new(scene: &Scene, surfaces: &Surfaces, size: [u32; 2]) -> Self {
        let eye = Eye {
            scene,
            surfaces,
            rays: scene.camera.eye_rays(size[0], size[1]),
        };
        let [width, height] = size.map(|s| s as usize);
        let pixels = width * height;
        let centre = |i: usize| [(i % width) as f64 + 0.5, (i / width) as f64 + 0.5];
        let facets: Vec<Option<Facet>> = (0..pixels)
            .into_par_iter()
            .map(|i| eye.facet(centre(i)))
            .collect();
        // Where pixels all round show one facet, no edge is near.
        let inside = |i: usize| {
            let (x, y) = (i % width, i / width);
            let rim = x == 0 || y == 0 || x + 1 == width || y + 1 == height;
            !rim && [i - 1, i + 1, i - width, i + width]
                .iter()
                .all(|k| same(&facets[i], &facets[*k]))
        };
        let seen = |i: usize| {
            let at = centre(i);
            let near_edge = !inside(i) && eye.has_edge_near(&facets[i], at);
            (eye.seen(&facets[i], at), near_edge)
        };
        let (seen, near_edge) = (0..pixels).into_par_iter().map(seen).unzip();
        Self { seen, near_edge }
    }

    /// Where shadow falls on nothing, all of the light arrives.
    pub(super) fn light_what_takes_no_shadow(&self, image: &mut VisibilityImage) {
        for (value, seen) in image.values.iter_mut().zip(&self.seen) {
            if seen.is_some_and(|s| !s.receives) {
                *value = 1.0;
            }
        }
    }

    /// Whether `depth` of a depth buffer shows what is seen at `pixel`, no sharp edge
    /// or outline being so near that this might be chance.
    pub(super) fn match_depth(&self, pixel: usize, depth: f32) -> Match {
        if self.near_edge[pixel] {
            return Match::Outline;
        }
        match self.seen[pixel] {
            None if depth >= 1.0 => Match::Background,
            None => Match::ExtraSurface,
            Some(_) if depth >= 1.0 => Match::MissingSurface,
            Some(seen) if (f64::from(depth) - seen.depth).abs() <= seen.tolerance => Match::Surface,
            Some(_) => Match::OtherDepth,
        }
    }
}

/// The eye before a scene.
struct Eye<'a> {
    scene: &'a Scene,
    surfaces: &'a Surfaces,
    rays: EyeRays,
}

impl Eye<'_> {
    fn facet(&self, [x, y]: [f64; 2]) -> Option<Facet> {
        let hit = self.surfaces.hit(&self.rays, x, y)?;
        let [a, b, c] = self.corners(&hit);
        Some(Facet {
            hit,
            normal: (b - a).cross(c - a),
        })
    }

    fn corners(&self, hit: &SurfaceHit) -> [DVec3; 3] {
        self.scene.objects[hit.object as usize]
            .mesh
            .corners(hit.triangle as usize)
    }

    /// Whether another surface, or another side of a sharp edge, is seen within
    /// [`REACH`] of an image point.
    fn has_edge_near(&self, facet: &Option<Facet>, [x, y]: [f64; 2]) -> bool {
        let around = [
            [-REACH, -REACH],
            [REACH, -REACH],
            [-REACH, REACH],
            [REACH, REACH],
        ];
        let other = |[dx, dy]: [f64; 2]| !smooth(facet, &self.facet([x + dx, y + dy]));
        around.into_iter().any(other)
    }

    fn seen(&self, facet: &Option<Facet>, [x, y]: [f64; 2]) -> Option<Seen> {
        let Facet { hit, normal } = facet.as_ref()?;
        let near = self.scene.camera.near;
        // The reciprocal of planar depth is linear over a facet's image.
        let off = normal.dot(self.corners(hit)[0] - self.rays.origin);
        let centre = self.rays.direction(x, y);
        let steps = [[x + 1.0, y], [x, y + 1.0]].map(|[x, y]| self.rays.direction(x, y) - centre);
        let slope: f64 = steps.iter().map(|d| (normal.dot(*d) / off).abs()).sum();
        let slope = if slope.is_finite() { near * slope } else { 0.0 };
        Some(Seen {
            depth: 1.0 - near / hit.depth,
            tolerance: STEPS + REACH * slope,
            receives: self.scene.objects[hit.object as usize].receives,
        })
    }
}

/// Whether two image points show the same facet, or both show none.
fn same(a: &Option<Facet>, b: &Option<Facet>) -> bool {
    let name = |f: &Option<Facet>| f.map(|f| (f.hit.object, f.hit.triangle));
    name(a) == name(b)
}

/// Whether two image points show one surface without a sharp edge between them.
fn smooth(a: &Option<Facet>, b: &Option<Facet>) -> bool {
    let (Some(p), Some(q)) = (a, b) else {
        return a.is_none() && b.is_none();
    };
    let flat = || p.normal.dot(q.normal) >= SHARP * p.normal.length() * q.normal.length();
    same(a, b) || (p.hit.object == q.hit.object && flat())
}
