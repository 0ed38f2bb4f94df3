//! Hard shadows by f64 rays: for every pixel, what is seen and how many
//! blockers lie between it and the light.
//!
//! The shadow count is what an ideal stencil holds after z-fail: the winding
//! number of the shadow volumes at the visible point. Each volume is the sum of
//! the volumes of its counted triangles (light-facing ones of closed casters,
//! all of others; [`Counting`]), so the count is the number of counted
//! triangles that the open segment from the point to the light crosses. The
//! point is seen from the eye's side of its own triangle: that one, and others
//! with the same corners, count where eye and light are on opposite sides of
//! it, as on the unlit side of an open sheet. Facing is the same f64 expression as in
//! [`crate::geometry::silhouette`]; everything else is independent of it.
//!
//! # Pixels near an edge
//!
//! A rasteriser snaps vertices and rounds depth, so next to an edge it may
//! rightly differ. [`HardTruth`] therefore samples a lattice of half-pixel
//! spacing (pixel centres, and the corners and edge midpoints that neighbouring
//! pixels share) and calls a pixel *interior* only where object and count agree
//! at all samples within reach of its centre. Where a volume's side leaves the
//! surface at a grazing angle, depth rounding matters further out than any
//! number of pixels; so the count must also survive moving the surface point by
//! some steps of the depth buffer. [`EdgeTolerance`] sets both.
//!
//! Measured against Mesa's llvmpipe (2026-11) on peer scenes A, B and C at
//! 512x512: half a pixel alone leaves 0, 2 and 4 interior pixels that differ, all
//! on grazing sides; half a pixel and 4 depth steps leave none among 178,978,
//! 172,579 and 199,252.

use glam::DVec3;
use rayon::prelude::*;

use super::bvh::{Bvh, Ray};
pub use super::surfaces::SurfaceHit;
use super::surfaces::Surfaces;
use crate::geometry::caster::{Caster, Counting};
use crate::geometry::silhouette::light_facing;
use crate::world::light::HardLight;
use crate::world::scene::{EyeRays, Scene};

/// Distance from the surface, in units of the distance to the eye, within which
/// a crossing is taken for the surface itself.
const SELF_DISTANCE: f64 = 1e-10;

/// One step of a 24-bit depth buffer.
const DEPTH_STEP: f64 = 1.0 / 16_777_216.0;

/// What one image point shows: nothing, or a surface under a number of blockers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// The surface seen; `None` for background.
    pub hit: Option<SurfaceHit>,
    /// Blockers between it and the light, 0 when lit or background.
    pub shadow_count: u32,
}

impl Sample {
    /// Whether two samples show the same object under the same count.
    fn agrees_with(&self, other: &Self) -> bool {
        let object = |s: &Self| s.hit.map(|h| h.object);
        object(self) == object(other) && self.shadow_count == other.shadow_count
    }
}

/// How near to an edge a pixel must be for a rasteriser to be excused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeTolerance {
    /// Half pixels round the centre within which all samples must agree.
    pub half_pixels: u32,
    /// Steps of 2^-24 of the depth buffer (1 - near / depth) by which the
    /// surface may move along the eye ray without changing the count.
    pub depth_steps: f64,
}

impl EdgeTolerance {
    /// Half a pixel, depth taken as exact.
    pub const HALF_PIXEL: Self = Self {
        half_pixels: 1,
        depth_steps: 0.0,
    };

    /// Half a pixel and four steps of a 24-bit depth buffer.
    pub const HALF_PIXEL_AND_DEPTH: Self = Self {
        half_pixels: 1,
        depth_steps: 4.0,
    };
}

/// Truth for one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelTruth {
    /// What the pixel's centre shows.
    pub centre: Sample,
    /// Whether everything within reach shows the same object and count, so that
    /// a rasteriser has no excuse to differ.
    pub interior: bool,
}

impl PixelTruth {
    /// Whether a surface is seen and light reaches it.
    pub fn is_lit(&self) -> bool {
        self.centre.hit.is_some() && self.centre.shadow_count == 0
    }
}

/// Ray-casting structures of one scene and light; build once, query often.
#[derive(Clone, Debug)]
pub struct HardOracle {
    light: HardLight,
    near: f64,
    surfaces: Surfaces,
    /// Counted triangles of the casters.
    blockers: Bvh,
    /// Surface index of each blocker.
    blocker_surface: Vec<u32>,
    /// The first surface that has the same three corners as each surface.
    place: Vec<u32>,
    /// Number of blockers at each place.
    blockers_at: Vec<u32>,
}

impl HardOracle {
    /// Prepares `scene` for the hard light at the centre of `light`.
    pub fn new(scene: &Scene, light: HardLight) -> Self {
        let objects = scene.objects.iter();
        let counted = objects.map(|o| o.casts.then(|| counted_triangles(&o.mesh, light)));
        let counted: Vec<_> = counted.collect();
        let surfaces = Surfaces::new(scene);
        let counts = |surface: u32| {
            let (object, triangle) = surfaces.name(surface);
            counted[object as usize]
                .as_ref()
                .is_some_and(|c| c[triangle as usize])
        };
        let (blocker_surface, blockers): (Vec<_>, Vec<_>) =
            surfaces.casters().filter(|(i, _)| counts(*i)).unzip();
        let place = places(surfaces.corners());
        let mut blockers_at = vec![0; place.len()];
        for &surface in &blocker_surface {
            blockers_at[place[surface as usize] as usize] += 1;
        }
        Self {
            light,
            near: scene.camera.near,
            surfaces,
            place,
            blockers_at,
            blockers: Bvh::new(&blockers),
            blocker_surface,
        }
    }

    /// What image point `(x, y)` shows, in pixels, y down from the top.
    pub fn sample(&self, rays: &EyeRays, x: f64, y: f64) -> Sample {
        let Some(hit) = self.surfaces.hit(rays, x, y) else {
            return Sample::default();
        };
        let ray = Ray::new(rays.origin, rays.direction(x, y));
        let surface = self.surfaces.index_of(&hit);
        Sample {
            hit: Some(hit),
            shadow_count: self.blockers_above(surface, &ray, hit.depth),
        }
    }

    /// Whether the count at image point `(x, y)` stays when the surface seen
    /// there moves by `steps` of 2^-24 of the depth buffer, either way.
    fn is_stable(&self, rays: &EyeRays, x: f64, y: f64, sample: &Sample, steps: f64) -> bool {
        let Some(hit) = sample.hit.filter(|_| steps > 0.0) else {
            return true;
        };
        let ray = Ray::new(rays.origin, rays.direction(x, y));
        let surface = self.surfaces.index_of(&hit);
        // The depth buffer holds 1 - near / depth: its slope is near / depth^2.
        let offset = steps * DEPTH_STEP * hit.depth * hit.depth / self.near;
        [-offset, offset]
            .iter()
            .all(|o| self.blockers_above(surface, &ray, hit.depth + o) == sample.shadow_count)
    }

    /// Counted triangles between the eye's side of the point at `depth` of the
    /// eye ray, on `surface`, and the light.
    fn blockers_above(&self, surface: u32, eye_ray: &Ray, depth: f64) -> u32 {
        let place = |surface: u32| self.place[surface as usize];
        let own = place(surface);
        let other = |blocker: u32| place(self.blocker_surface[blocker as usize]) != own;
        let point = eye_ray.at(depth);
        let between = self.blockers_towards_light(point, SELF_DISTANCE * depth, other);
        let [a, b, c] = self.surfaces.corners()[surface as usize];
        let normal = (b - a).cross(c - a);
        let eye_side = normal.dot(eye_ray.at(0.0) - a);
        let light_side = normal.dot(self.light.towards_from(a));
        let own_side = (eye_side > 0.0) != (light_side > 0.0);
        between + u32::from(own_side) * self.blockers_at[own as usize]
    }

    /// Counted triangles between any point of space and the light: the winding
    /// number of the shadow volumes there.
    pub fn shadow_count_at(&self, point: DVec3) -> u32 {
        self.blockers_towards_light(point, 0.0, |_| true)
    }

    /// Counted triangles at least `distance` from `origin` on the way to the light.
    fn blockers_towards_light(
        &self,
        origin: DVec3,
        distance: f64,
        wanted: impl Fn(u32) -> bool,
    ) -> u32 {
        let towards = self.light.towards_from(origin);
        let start = distance / towards.length();
        let shadow_ray = Ray::new(origin, towards);
        self.blockers
            .count(&shadow_ray, start..self.light_at(), wanted)
    }

    /// The `t` at which a ray along [`HardLight::towards_from`] meets the light.
    fn light_at(&self) -> f64 {
        if self.light.is_directional() {
            f64::INFINITY
        } else {
            1.0
        }
    }
}

/// For each triangle, the first one with the same corners in any order.
fn places(triangles: &[[DVec3; 3]]) -> Vec<u32> {
    let key = |t: &[DVec3; 3]| {
        let mut corners = t.map(|p| p.to_array().map(|c| (c + 0.0).to_bits()));
        corners.sort_unstable();
        corners
    };
    let mut first = std::collections::BTreeMap::new();
    let of = |(i, t)| *first.entry(key(t)).or_insert(i as u32);
    triangles.iter().enumerate().map(of).collect()
}

/// Which triangles of a caster block, by the rule of its volume.
fn counted_triangles(mesh: &crate::world::mesh::Mesh, light: HardLight) -> Vec<bool> {
    match Caster::new(mesh).counting(mesh, light) {
        Counting::LightFacing => light_facing(mesh, light),
        Counting::AllTriangles => vec![true; mesh.triangles().len()],
    }
}

/// Truth for every pixel of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct HardTruth {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Row by row, row 0 on top.
    pub pixels: Vec<PixelTruth>,
}

impl HardTruth {
    /// Evaluates `scene` for light `light` (index) at `width` by `height`.
    /// Runs in parallel; the result does not depend on the thread count.
    pub fn of_scene(
        scene: &Scene,
        light: usize,
        [width, height]: [u32; 2],
        tolerance: EdgeTolerance,
    ) -> Self {
        let oracle = HardOracle::new(scene, scene.lights[light].hard());
        let rays = scene.camera.eye_rays(width, height);
        let lattice = Lattice::sample(&oracle, &rays, [width, height], tolerance.half_pixels);
        let pixel = |i: u32| {
            let (x, y) = (i % width, i / width);
            let mut truth = lattice.pixel(x, y);
            let (cx, cy) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let steps = tolerance.depth_steps;
            truth.interior &= oracle.is_stable(&rays, cx, cy, &truth.centre, steps);
            truth
        };
        Self {
            width,
            height,
            pixels: (0..width * height).into_par_iter().map(pixel).collect(),
        }
    }

    /// Pixel in column `x`, row `y` from the top.
    pub fn pixel(&self, x: u32, y: u32) -> &PixelTruth {
        &self.pixels[(y * self.width + x) as usize]
    }
}

/// Samples at half-pixel spacing, `reach` of them beyond the outermost centres.
struct Lattice {
    reach: u32,
    columns: u32,
    samples: Vec<Sample>,
}

impl Lattice {
    fn sample(oracle: &HardOracle, rays: &EyeRays, [width, height]: [u32; 2], reach: u32) -> Self {
        // Lattice index `reach` is the first pixel's centre, at 0.5.
        let place = |k: u32| 0.5 + 0.5 * (f64::from(k) - f64::from(reach));
        let columns = 2 * width - 1 + 2 * reach;
        let rows = 2 * height - 1 + 2 * reach;
        let row = |r: u32| (0..columns).map(move |c| (place(c), place(r)));
        let samples = (0..rows)
            .into_par_iter()
            .flat_map_iter(row)
            .map(|(x, y)| oracle.sample(rays, x, y))
            .collect();
        Self {
            reach,
            columns,
            samples,
        }
    }

    fn pixel(&self, x: u32, y: u32) -> PixelTruth {
        let around = |k: u32| 2 * k..=2 * k + 2 * self.reach;
        let at = |c: u32, r: u32| &self.samples[(r * self.columns + c) as usize];
        let centre = at(2 * x + self.reach, 2 * y + self.reach);
        let interior = around(y).all(|r| around(x).all(|c| at(c, r).agrees_with(centre)));
        PixelTruth {
            centre: *centre,
            interior,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::winding::volume_winding;
    use crate::world::scene::builtin;

    /// At interior pixels the count equals the summed winding numbers of the
    /// shadow volumes at the visible point: rays against solid angles.
    fn check_against_winding(name: &str, size: u32) -> usize {
        let scene = builtin::build(name).unwrap();
        let light = scene.lights[0].hard();
        let truth = HardTruth::of_scene(&scene, 0, [size; 2], EdgeTolerance::HALF_PIXEL);
        let casters = scene.casters().map(|o| (o, Caster::new(&o.mesh)));
        let volumes: Vec<_> = casters.map(|(o, c)| c.volume(&o.mesh, light)).collect();
        let rays = scene.camera.eye_rays(size, size);
        let mut checked = 0;
        for y in 0..size {
            for x in 0..size {
                let pixel = truth.pixel(x, y);
                let Some(hit) = pixel.centre.hit.filter(|_| pixel.interior) else {
                    continue;
                };
                // A little towards the eye, off the surface.
                let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                let p = rays.origin + rays.direction(px, py) * (hit.depth * (1.0 - 1e-5));
                let winding: i32 = volumes.iter().map(|v| volume_winding(v, p)).sum();
                assert_eq!(
                    pixel.centre.shadow_count as i32, winding,
                    "{name} ({x},{y})"
                );
                checked += 1;
            }
        }
        checked
    }

    #[test]
    fn counts_are_winding_numbers() {
        for name in [
            "cylinder",
            "columns",
            "creature",
            "adversarial-eye-in-shadow",
        ] {
            assert!(
                check_against_winding(name, 32) > 300,
                "{name}: too few interior pixels"
            );
        }
    }

    #[test]
    fn nested_volumes_count_to_three_hundred() {
        let scene = builtin::build("adversarial-nested-300").unwrap();
        let truth = HardTruth::of_scene(&scene, 0, [64; 2], EdgeTolerance::HALF_PIXEL);
        let most = truth.pixels.iter().map(|p| p.centre.shadow_count).max();
        assert_eq!(most, Some(300));
    }

    #[test]
    fn interior_pixels_stay_away_from_edges() {
        let scene = builtin::build("peer-a").unwrap();
        let truth = HardTruth::of_scene(&scene, 0, [96; 2], EdgeTolerance::HALF_PIXEL);
        let interior = truth.pixels.iter().filter(|p| p.interior).count();
        assert!(
            interior > 96 * 96 * 8 / 10 && interior < 96 * 96,
            "{interior}"
        );
        // Wherever two neighbours differ, both must be marked as near an edge.
        for y in 0..96 {
            for x in 0..95 {
                let (a, b) = (truth.pixel(x, y), truth.pixel(x + 1, y));
                if !a.centre.agrees_with(&b.centre) {
                    assert!(!(a.interior && b.interior), "({x},{y})");
                }
            }
        }
        let shadowed = |p: &&PixelTruth| p.centre.shadow_count > 0 && p.interior;
        assert!(truth.pixels.iter().filter(shadowed).count() > 300);
        assert!(truth.pixels.iter().any(PixelTruth::is_lit));
    }

    /// A lit surface moved into its own caster by the depth tolerance must not
    /// be taken for shadowed by itself.
    #[test]
    fn lit_surfaces_are_interior_under_depth_tolerance() {
        let scene = builtin::build("peer-a").unwrap();
        let tolerance = EdgeTolerance::HALF_PIXEL_AND_DEPTH;
        let truth = HardTruth::of_scene(&scene, 0, [96; 2], tolerance);
        let lit_caster = |p: &&PixelTruth| p.is_lit() && p.centre.hit.unwrap().object == 1;
        let interior = |p: &&PixelTruth| p.interior && lit_caster(p);
        let lit = truth.pixels.iter().filter(lit_caster).count();
        assert!(truth.pixels.iter().filter(interior).count() > lit / 2 && lit > 200);
    }

    #[test]
    fn a_larger_reach_keeps_fewer_pixels() {
        let scene = builtin::build("cylinder").unwrap();
        let interior = |half_pixels| {
            let tolerance = EdgeTolerance {
                half_pixels,
                depth_steps: 0.0,
            };
            let truth = HardTruth::of_scene(&scene, 0, [48, 32], tolerance);
            truth.pixels.iter().map(|p| p.interior).collect::<Vec<_>>()
        };
        let (near, far) = (interior(1), interior(3));
        assert!(near.iter().zip(&far).all(|(n, f)| *n || !*f));
        assert!(near != far);
    }

    /// Pixel (381, 257) of peer scene B at 512x512 lies on a sphere just past
    /// the line where it turns from the light. llvmpipe sees it lit, the truth
    /// is shadow, and every pixel round it agrees with the truth.
    #[test]
    fn grazing_sides_are_not_interior() {
        let scene = builtin::build("peer-b").unwrap();
        let oracle = HardOracle::new(&scene, scene.lights[0].hard());
        let rays = scene.camera.eye_rays(512, 512);
        let stable = |x: u32, y: u32| {
            let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let sample = oracle.sample(&rays, x, y);
            assert_eq!(sample.shadow_count, 1);
            oracle.is_stable(&rays, x, y, &sample, 4.0)
        };
        assert!(!stable(381, 257));
        assert!(stable(381, 262));
    }

    #[test]
    fn thread_count_does_not_matter() {
        let scene = builtin::build("columns").unwrap();
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                HardTruth::of_scene(&scene, 0, [40, 30], EdgeTolerance::HALF_PIXEL_AND_DEPTH)
            })
        };
        assert!(on(1) == on(3));
    }

    /// The same with an open caster, whose triangles all count.
    #[test]
    fn open_casters_count_every_triangle() {
        let mut scene = builtin::build("cylinder").unwrap();
        let mut tin = crate::world::shape::cylinder(32, 0.5, 0.3, 1.5);
        tin.triangles.drain(64..96); // the bottom
        let mesh = tin.into_mesh(crate::world::mesh::Shading::Flat).unwrap();
        scene.objects[1].mesh = std::sync::Arc::new(mesh);
        let oracle = HardOracle::new(&scene, HardLight::Directional(DVec3::new(0.5, 1.0, 0.0)));
        let counts = |x: f64, z: f64| oracle.shadow_count_at(DVec3::new(x, 0.0, z));
        // Up into the bottomless tin: the lid alone, or wall and lid.
        assert_eq!(counts(-0.3, 0.013), 1);
        assert_eq!(counts(-0.8, 0.013), 2);
        assert_eq!(counts(1.5, 0.013), 0);
    }

    /// A directional light and the same direction from very far agree.
    #[test]
    fn directional_light_is_a_point_far_away() {
        let scene = builtin::build("cylinder").unwrap();
        let towards = DVec3::new(0.4, 1.0, 0.3);
        let far = HardOracle::new(&scene, HardLight::Point(towards * 1e9));
        let directional = HardOracle::new(&scene, HardLight::Directional(towards));
        let rays = scene.camera.eye_rays(32, 32);
        for i in 0..32 * 32 {
            let (x, y) = (f64::from(i % 32) + 0.5, f64::from(i / 32) + 0.5);
            assert_eq!(far.sample(&rays, x, y), directional.sample(&rays, x, y));
        }
    }
}
