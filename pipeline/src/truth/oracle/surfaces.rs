//! What the eye sees: the closest surface under an image point, in f64.

use glam::DVec3;

use super::bvh::{Bvh, Ray};
use crate::world::scene::{EyeRays, Scene};

/// How far a receiver is lifted off its facet, as a share of the largest
/// coordinate nearby: some hundred times the rounding of a point in f64.
const LIFT: f64 = 1e-13;

/// A point of a visible surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Index into [`Scene::objects`].
    pub object: u32,
    /// Triangle of that object's mesh.
    pub triangle: u32,
    /// Distance along the line of sight (planar, not radial), scene units.
    pub depth: f64,
}

/// All triangles of a scene under eye rays.
#[derive(Clone, Debug)]
pub struct Surfaces {
    near: f64,
    bvh: Bvh,
    /// Corners of each surface, in drawing order.
    corners: Vec<[DVec3; 3]>,
    /// Object and triangle of each surface.
    names: Vec<(u32, u32)>,
    /// Index of each object's first surface.
    first: Vec<u32>,
    /// Per object: whether it casts shadow.
    casts: Vec<bool>,
}

impl Surfaces {
    /// Collects the triangles of `scene` in drawing order.
    pub fn new(scene: &Scene) -> Self {
        let (mut corners, mut names, mut first) = (Vec::new(), Vec::new(), Vec::new());
        for (o, object) in scene.objects.iter().enumerate() {
            first.push(corners.len() as u32);
            for t in 0..object.mesh.triangles().len() {
                corners.push(object.mesh.corners(t));
                names.push((o as u32, t as u32));
            }
        }
        Self {
            near: scene.camera.near,
            bvh: Bvh::new(&corners),
            corners,
            names,
            first,
            casts: scene.objects.iter().map(|o| o.casts).collect(),
        }
    }

    /// The closest surface beyond the near plane under image point `(x, y)`, in
    /// pixels, y down from the top.
    pub fn hit(&self, rays: &EyeRays, x: f64, y: f64) -> Option<SurfaceHit> {
        let ray = Ray::new(rays.origin, rays.direction(x, y));
        let (surface, depth) = self.bvh.closest(&ray, self.near..f64::INFINITY)?;
        let (object, triangle) = self.names[surface as usize];
        Some(SurfaceHit {
            object,
            triangle,
            depth,
        })
    }

    /// Index over all surfaces of the triangle that was hit.
    pub fn index_of(&self, hit: &SurfaceHit) -> u32 {
        self.first[hit.object as usize] + hit.triangle
    }

    /// Corners of every surface, in drawing order.
    pub fn corners(&self) -> &[[DVec3; 3]] {
        &self.corners
    }

    /// Object and triangle of a surface index.
    pub fn name(&self, surface: u32) -> (u32, u32) {
        self.names[surface as usize]
    }

    /// Indices and corners of the triangles that cast shadow, in drawing order.
    pub fn casters(&self) -> impl Iterator<Item = (u32, [DVec3; 3])> + '_ {
        let casts = |i: &usize| self.casts[self.names[*i].0 as usize];
        (0..self.corners.len())
            .filter(casts)
            .map(|i| (i as u32, self.corners[i]))
    }

    /// The receiver under image point `(x, y)`: see [`Receiver`].
    pub fn receiver(&self, rays: &EyeRays, x: f64, y: f64) -> Option<Receiver> {
        let hit = self.hit(rays, x, y)?;
        Some(self.receiver_of(&hit, rays, x, y))
    }

    /// The receiver at `hit`, which is what the eye sees under image point `(x, y)`.
    pub fn receiver_of(&self, hit: &SurfaceHit, rays: &EyeRays, x: f64, y: f64) -> Receiver {
        let direction = rays.direction(x, y);
        let seen = rays.origin + direction * hit.depth;
        let surface = self.index_of(hit);
        let corners = &self.corners[surface as usize];
        let casts = self.casts[hit.object as usize];
        Receiver::on_facet(corners, seen, direction).with_caster(casts.then_some(surface))
    }
}

/// The point at which light is gathered: just off a facet, on the side that is
/// seen.
///
/// The visible point is put back onto the plane of its triangle (a grazing ray
/// misses it by more than rounding) and lifted along the facet normal towards
/// the eye by 1e-13 of the largest coordinate nearby. So it stands for the limit
/// from the seen side: a triangle in the same plane, a duplicate of the own
/// one, or an edge that two facets share, covers nothing in front of the facet
/// and all that is behind it. The peers' reference does the same with 1e-4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// World space.
    pub point: DVec3,
    /// Facet normal towards the seen side, of length 1; `None` for a free point.
    pub normal: Option<DVec3>,
    /// Surface index of the own triangle, if its object casts shadow.
    pub caster: Option<u32>,
}

impl Receiver {
    /// A point of space that lies on no surface.
    pub fn free(point: DVec3) -> Self {
        Self {
            point,
            normal: None,
            caster: None,
        }
    }

    /// A point of a facet, seen along `direction`; the facet casts nothing.
    pub fn on_facet(corners: &[DVec3; 3], seen: DVec3, direction: DVec3) -> Self {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a);
        let length = normal.length();
        if length == 0.0 {
            return Self::free(seen); // no plane to be put onto
        }
        let towards_eye = if normal.dot(direction) > 0.0 {
            -1.0
        } else {
            1.0
        };
        let normal = normal * (towards_eye / length);
        let largest = [a, b, c, seen].into_iter().map(|v| v.abs().max_element());
        let lift = LIFT * largest.fold(0.0, f64::max);
        Self {
            point: seen - normal * (normal.dot(seen - a) - lift),
            normal: Some(normal),
            caster: None,
        }
    }

    /// The same, its own triangle being the caster `surface`, which hides what
    /// is behind it.
    pub fn with_caster(mut self, surface: Option<u32>) -> Self {
        self.caster = surface;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    #[test]
    fn receivers_lie_just_off_their_facet_on_the_seen_side() {
        for name in ["peer-b", "adversarial-offset", "adversarial-tiny"] {
            let scene = builtin::build(name).unwrap();
            let surfaces = Surfaces::new(&scene);
            let rays = scene.camera.eye_rays(24, 24);
            let mut seen = 0;
            for i in 0..24 * 24 {
                let (x, y) = (f64::from(i % 24) + 0.5, f64::from(i / 24) + 0.5);
                let (Some(hit), Some(r)) =
                    (surfaces.hit(&rays, x, y), surfaces.receiver(&rays, x, y))
                else {
                    continue;
                };
                let corners = surfaces.corners[surfaces.index_of(&hit) as usize];
                let normal = r.normal.unwrap();
                let height = normal.dot(r.point - corners[0]);
                let scale = corners[0].abs().max(r.point.abs()).max_element();
                assert!(
                    height > 0.5e-13 * scale && height < 1e-12 * scale,
                    "{height:e}"
                );
                assert!(normal.dot(rays.direction(x, y)) < 0.0);
                seen += 1;
            }
            assert!(seen > 100, "{name}: {seen}");
        }
    }

    #[test]
    fn only_casters_are_listed() {
        let scene = builtin::build("peer-a").unwrap();
        let casters: Vec<_> = Surfaces::new(&scene).casters().map(|(i, _)| i).collect();
        assert_eq!(casters, (2..258).collect::<Vec<u32>>());
    }
}
