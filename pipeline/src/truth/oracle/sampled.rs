//! Area lights by stratified shadow rays: a second opinion on [`super::area`].
//!
//! Rays run from the receiver to points of the light through the same BVH, but
//! by its ray queries; nothing is clipped, and no triangle is left out: the
//! receiver's own one is missed because the receiver is lifted off it. Sample k
//! of a pixel lies in cell k of a square grid, jittered by a hash of seed, pixel
//! and k. So an image depends on the seed alone.

use glam::DVec3;

use super::area::VisibilityImage;
use super::area::emitter::{Emitter, FlatLight};
use super::bvh::{Bvh, Ray};
use super::surfaces::{Receiver, Surfaces};
use crate::world::error::LightError;
use crate::world::light::{HardLight, LightShape};
use crate::world::scene::Scene;

/// Raised with every change of the values that this module finds, as
/// [`super::area::ORACLE_VERSION`].
pub const SAMPLED_VERSION: u32 = 1;

/// Where shadow rays end, as a share of the way to the light: what lies in the
/// light, such as the lamp's own mesh, is not in between.
const RAY_END: f64 = 1.0 - 1e-12;

/// What the samples of one receiver say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// Samples that reached the light.
    pub seen: u32,
    /// All samples.
    pub samples: u32,
}

impl Estimate {
    /// Estimated share of the light that is seen.
    pub fn share(&self) -> f64 {
        f64::from(self.seen) / f64::from(self.samples)
    }

    /// Whether `truth` survives a test at level `risk`: were it the share, an
    /// estimate as far off as this one would come up with at most that
    /// probability. See [`half_width`].
    pub fn is_consistent_with(&self, truth: f64, risk: f64) -> bool {
        (self.share() - truth).abs() <= half_width(truth, f64::from(self.samples), risk)
    }
}

/// Half width of an interval about `truth` that `samples` independent samples'
/// mean leaves with probability at most `risk`: Bernstein's inequality, with the
/// variance of a plain coin, which strata only lower. It holds for any count,
/// not just for large ones.
pub fn half_width(truth: f64, samples: f64, risk: f64) -> f64 {
    of_variance((truth * (1.0 - truth)).max(0.0), samples, risk)
}

/// Bernstein's half width for samples of a mean variance.
fn of_variance(variance: f64, samples: f64, risk: f64) -> f64 {
    let log = libm::log(2.0 / risk);
    let linear = log / (3.0 * samples);
    linear + (linear * linear + 2.0 * log * variance / samples).sqrt()
}

/// Shadow rays to one light; build once, query often.
#[derive(Clone, Debug)]
pub struct SampledOracle {
    emitter: Emitter,
    casters: Bvh,
    side: u32,
    seed: u64,
}

impl SampledOracle {
    /// Prepares `side * side` rays per receiver.
    ///
    /// # Errors
    /// The light should have an extent and has none.
    pub fn new(
        surfaces: &Surfaces,
        light: &LightShape,
        side: u32,
        seed: u64,
    ) -> Result<Self, LightError> {
        let triangles: Vec<_> = surfaces.casters().map(|(_, t)| t).collect();
        Self::of_triangles(&triangles, light, side, seed)
    }

    /// The same with any triangles as casters.
    ///
    /// # Errors
    /// As [`SampledOracle::new`].
    pub fn of_triangles(
        triangles: &[[DVec3; 3]],
        light: &LightShape,
        side: u32,
        seed: u64,
    ) -> Result<Self, LightError> {
        Ok(Self {
            emitter: Emitter::new(light)?,
            casters: Bvh::new(triangles),
            side: side.max(1),
            seed,
        })
    }

    /// Casts the rays of one receiver; `pixel` chooses their jitter.
    pub fn estimate(&self, receiver: &Receiver, pixel: u32) -> Estimate {
        let samples = self.side * self.side;
        let seen = match self.emitter.seen_from(receiver.point) {
            Some(light) => {
                let seen = |k: &u32| self.reaches(&light, receiver.point, pixel, *k);
                (0..samples).filter(seen).count() as u32
            }
            None if self.hard_reaches(receiver.point) => samples,
            None => 0,
        };
        Estimate { seen, samples }
    }

    /// Whether sample `k` reaches the light.
    fn reaches(&self, light: &FlatLight<'_>, p: DVec3, pixel: u32, k: u32) -> bool {
        let place = |cell: u32, axis: u64| {
            let key = (u64::from(pixel) << 32 | u64::from(k)) ^ (axis << 63);
            (f64::from(cell) + jitter(self.seed, key)) / f64::from(self.side)
        };
        let unit = [place(k % self.side, 0), place(k / self.side, 1)];
        let target = light.frame.at(on_light(light, unit));
        !self.casters.any(&Ray::new(p, target - p), 0.0..RAY_END)
    }

    fn hard_reaches(&self, p: DVec3) -> bool {
        let Emitter::Hard(light) = self.emitter else {
            return true; // in a spherical light
        };
        let end = match light {
            HardLight::Point(_) => RAY_END,
            HardLight::Directional(_) => f64::INFINITY,
        };
        !self
            .casters
            .any(&Ray::new(p, light.towards_from(p)), 0.0..end)
    }

    /// Estimates every pixel of an image; see [`VisibilityImage::of_scene`].
    pub fn image(
        &self,
        surfaces: &Surfaces,
        scene: &Scene,
        size: [u32; 2],
        row_done: &(dyn Fn() + Sync),
    ) -> VisibilityImage {
        let per_row = || |receiver: &Receiver, pixel| self.estimate(receiver, pixel).share();
        VisibilityImage::of_pixels(surfaces, scene, size, row_done, per_row)
    }
}

/// Carries the unit square onto the light; equal areas stay equal.
pub(crate) fn on_light(light: &FlatLight<'_>, [a, b]: [f64; 2]) -> [f64; 2] {
    if light.is_disc() {
        let (radius, angle) = (a.sqrt(), std::f64::consts::TAU * b);
        return [radius * libm::cos(angle), radius * libm::sin(angle)];
    }
    let apex = light.outline[0];
    let twice = |e: &[[f64; 2]]| {
        let [p, q] = [e[0], e[1]].map(|p| [p[0] - apex[0], p[1] - apex[1]]);
        (p[0] * q[1] - p[1] * q[0], p, q)
    };
    let fan: Vec<_> = light.outline[1..].windows(2).map(twice).collect();
    let mut left = a * fan.iter().map(|(area, ..)| area).sum::<f64>();
    let mut at = 0; // the last triangle takes what rounding leaves
    while at + 1 < fan.len() && left > fan[at].0 {
        left -= fan[at].0;
        at += 1;
    }
    let (area, p, q) = fan[at];
    let along = (left / area).clamp(0.0, 1.0).sqrt();
    [0, 1].map(|k| apex[k] + along * (p[k] * (1.0 - b) + q[k] * b))
}

/// A number in 0..1 from a hash (splitmix64's finaliser, twice).
pub(crate) fn jitter(seed: u64, key: u64) -> f64 {
    let mixed = mix(mix(seed.wrapping_add(0x9e37_79b9_7f4a_7c15)) ^ key);
    (mixed >> 11) as f64 / (1u64 << 53) as f64
}

fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::oracle::area::{AreaOracle, LightRegion};
    use crate::world::light::ConvexPolygon;
    use crate::world::scene::builtin;
    use crate::world::shape::on_circle;
    use rayon::prelude::*;

    const SIDE: u32 = 32;

    /// All light shapes at the scene's light, about as large as `size`.
    fn lights(scene: &Scene, size: f64) -> Vec<(&'static str, LightShape)> {
        let HardLight::Point(centre) = scene.lights[0].hard() else {
            panic!("the scene's light is somewhere");
        };
        let corner = |k: u32| {
            let (x, z) = on_circle(f64::from(k) * std::f64::consts::TAU / 5.0);
            centre + DVec3::new(x, 0.2 * z, z) * (0.5 * size)
        };
        let pentagon = ConvexPolygon::new((0..5).map(corner).collect::<Vec<_>>()).unwrap();
        let radius = 0.5 * size;
        let rectangle = LightShape::Rectangle {
            centre,
            edge_u: DVec3::new(1.6, 0.3, 0.0) * size,
            edge_v: DVec3::new(0.1, -0.2, 0.6) * size,
        };
        let normal = DVec3::new(0.3, -1.0, 0.1).normalize();
        let disc = LightShape::Disc {
            centre,
            normal,
            radius,
        };
        vec![
            ("square", scene.lights[0].shape.clone()),
            ("rectangle", rectangle),
            ("pentagon", LightShape::Polygon(pentagon)),
            ("disc", disc),
            ("sphere", LightShape::Sphere { centre, radius }),
            ("point", LightShape::Point { position: centre }),
            ("direction", LightShape::Directional { towards: centre }),
        ]
    }

    /// Seeds of independent estimates, of `SIDE * SIDE` rays each.
    const SEEDS: [u64; 4] = [17, 18, 19, 20];

    /// Exact share and four estimates of a receiver.
    type Pair = (f64, [Estimate; 4]);

    /// Exact shares and estimates of a small image.
    fn pairs(scene: &Scene, exact: &LightShape, sampled: &LightShape) -> Vec<Pair> {
        let (width, height) = (48u32, 32u32);
        let surfaces = Surfaces::new(scene);
        let oracle = AreaOracle::new(&surfaces, exact).unwrap();
        let rays = SEEDS.map(|s| SampledOracle::new(&surfaces, sampled, SIDE, s).unwrap());
        let eye = scene.camera.eye_rays(width, height);
        let pair = |i: u32| {
            let (x, y) = (f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
            let receiver = surfaces.receiver(&eye, x, y)?;
            let estimates = [0, 1, 2, 3].map(|k: usize| rays[k].estimate(&receiver, i));
            Some((oracle.visibility(&receiver), estimates))
        };
        let all: Vec<_> = (0..width * height).into_par_iter().map(pair).collect();
        all.into_iter().flatten().collect()
    }

    /// How far rays and oracle are apart.
    #[derive(Clone, Copy, Debug)]
    struct Distance {
        /// Worst error of the 4096 rays of a receiver over its half width.
        worst: f64,
        /// The same for the mean over all receivers.
        mean: f64,
        /// Mean squared error of penumbra receivers over what the spread of the
        /// four estimates predicts. Strata make this far sharper: 1 is expected.
        spread: f64,
        penumbra: usize,
    }

    impl Distance {
        /// `worst` and `mean` exceed 1 with a probability of at most `risk`.
        fn of(pairs: &[Pair], risk: f64) -> Self {
            let (count, samples) = (pairs.len() as f64, f64::from(4 * SIDE * SIDE));
            let share = |e: &[Estimate; 4]| e.iter().map(Estimate::share).sum::<f64>() / 4.0;
            let ratio = |(truth, e): &Pair| {
                (share(e) - truth).abs() / half_width(*truth, samples, 0.5 * risk / count)
            };
            let mean = |of: &dyn Fn(&Pair) -> f64| pairs.iter().map(of).sum::<f64>() / count;
            let error = mean(&|(truth, e)| share(e) - truth).abs();
            let variance = mean(&|(truth, _)| truth * (1.0 - truth));
            let (mut squares, mut predicted, mut penumbra) = (0.0, 0.0, 0);
            for (truth, e) in pairs {
                if LightRegion::of(*truth) == Some(LightRegion::Penumbra) {
                    let m = share(e);
                    let off = e.map(|e| (e.share() - m) * (e.share() - m));
                    squares += (m - truth) * (m - truth);
                    predicted += off.iter().sum::<f64>() / 3.0 / 4.0;
                    penumbra += 1;
                }
            }
            Self {
                worst: pairs.iter().map(ratio).fold(0.0, f64::max),
                mean: error / of_variance(variance, samples * count, 0.5 * risk),
                spread: squares / predicted,
                penumbra,
            }
        }
    }

    /// Every estimate, and the mean of all, within an interval that all scenes
    /// and shapes together leave with probability 1e-6; and the spread of
    /// estimates explains the errors (4 standard deviations of the ratio of
    /// two such variances, from 100 receivers on, are within 0.5..2).
    #[test]
    fn the_exact_oracle_is_within_the_interval_of_the_rays() {
        let scenes = [
            ("peer-a", 1.0),
            ("creature", 1.2),
            ("columns", 1.5),
            ("spheres", 1.5),
            ("adversarial-offset", 1.0),
            ("adversarial-slivers", 1.0),
        ];
        for (name, size) in scenes {
            let scene = builtin::build(name).unwrap();
            for (shape, light) in lights(&scene, size) {
                let found = Distance::of(&pairs(&scene, &light, &light), 1e-6 / 42.0);
                println!("{name} {shape}: {found:.3?}");
                assert!(
                    found.worst < 1.0 && found.mean < 1.0,
                    "{name} {shape}: {found:?}"
                );
                if matches!(shape, "point" | "direction") {
                    assert_eq!((found.worst, found.penumbra), (0.0, 0), "{name} {shape}");
                } else {
                    assert!(found.penumbra > 40, "{name} {shape}: {found:?}");
                    assert!(
                        (0.5..2.0).contains(&found.spread),
                        "{name} {shape}: {found:?}"
                    );
                }
            }
        }
    }

    /// The test above can fail: a light moved by 1%, or a sphere taken for a
    /// disc of its own radius, is found out.
    #[test]
    fn a_wrong_light_is_found_out() {
        let scene = builtin::build("peer-a").unwrap();
        let all = lights(&scene, 1.0);
        let LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        } = all[0].1
        else {
            panic!("the first is a square");
        };
        let moved = LightShape::Rectangle {
            centre: centre + DVec3::X * 0.01,
            edge_u,
            edge_v,
        };
        let found = Distance::of(&pairs(&scene, &moved, &all[0].1), 1e-6);
        assert!(found.spread > 4.0, "moved: {found:?}");
        let sphere = |radius| LightShape::Sphere { centre, radius };
        // From 4.2 away, radius 1.41 is seen as 1.5.
        let found = Distance::of(&pairs(&scene, &sphere(1.41), &sphere(1.5)), 1e-6);
        assert!(found.spread > 4.0, "radius: {found:?}");
    }

    /// Samples keep to the light and fill it evenly.
    #[test]
    fn samples_are_uniform_on_every_shape() {
        let scene = builtin::build("peer-a").unwrap();
        for (name, light) in lights(&scene, 1.0) {
            let oracle = SampledOracle::of_triangles(&[], &light, SIDE, 3).unwrap();
            let Some(flat) = oracle.emitter.seen_from(DVec3::ZERO) else {
                continue;
            };
            let n = 200;
            let cell = |k: u32| (f64::from(k) + 0.5) / f64::from(n);
            let points: Vec<_> = (0..n * n)
                .map(|i| on_light(&flat, [cell(i % n), cell(i / n)]))
                .collect();
            // Mean and second moments against those of the shape.
            let mean =
                |f: &dyn Fn(&[f64; 2]) -> f64| points.iter().map(f).sum::<f64>() / f64::from(n * n);
            let centre = [mean(&|p| p[0]), mean(&|p| p[1])];
            assert!(centre.iter().all(|c| c.abs() < 3e-3), "{name}: {centre:?}");
            let second = mean(&|p| p[0] * p[0] + p[1] * p[1]);
            let expected = if flat.is_disc() {
                0.5
            } else {
                polygon_moment(flat.outline)
            };
            assert!(
                (second - expected).abs() < 3e-3,
                "{name}: {second} {expected}"
            );
        }
    }

    /// Mean squared distance from the origin over a convex polygon about it.
    fn polygon_moment(outline: &[[f64; 2]]) -> f64 {
        let next = outline.iter().cycle().skip(1);
        let (mut moment, mut area) = (0.0, 0.0);
        for (a, b) in outline.iter().zip(next) {
            let twice = a[0] * b[1] - a[1] * b[0];
            let dot = |p: &[f64; 2], q: &[f64; 2]| p[0] * q[0] + p[1] * q[1];
            moment += twice * (dot(a, a) + dot(a, b) + dot(b, b)) / 12.0;
            area += twice / 2.0;
        }
        moment / area
    }

    #[test]
    fn the_same_seed_gives_the_same_image_and_another_one_does_not() {
        let scene = builtin::build("cylinder").unwrap();
        let surfaces = Surfaces::new(&scene);
        let image = |seed, threads| {
            let oracle = SampledOracle::new(&surfaces, &scene.lights[0].shape, 8, seed).unwrap();
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap()
                .install(|| oracle.image(&surfaces, &scene, [32, 24], &|| {}))
        };
        let first = image(1, 1);
        assert!(first == image(1, 3));
        assert!(first != image(2, 1));
    }

    /// Coverage of the interval, on coins whose side is known.
    #[test]
    fn intervals_cover_as_promised() {
        for truth in [0.0, 0.003, 0.2, 0.5, 1.0] {
            let toss = |t: u64, k: u64| jitter(9, t << 32 | k) < truth;
            let outside = (0..2000u64).filter(|t| {
                let seen = (0..256).filter(|k| toss(*t, *k)).count() as u32;
                !Estimate { seen, samples: 256 }.is_consistent_with(truth, 0.05)
            });
            assert!(outside.count() <= 100, "{truth}");
        }
        let off = Estimate {
            seen: 90,
            samples: 256,
        };
        assert!(!off.is_consistent_with(0.5, 0.05));
    }
}
