//! The GPU's visibility against a slow twin in f64, and the twin with an exact step
//! against a closed form.

use glam::DVec3;
use gnomon_raster::{Gpu, GpuConfig, Subresource, TextureId};

use super::*;
use crate::geometry::convolution::{Series, Suppression};
use crate::parts::maps::light_view::{FitTo, Fitting, Views};
use crate::techniques::find;
use crate::world::scene::builtin;
use crate::world::scene::builtin::PLATES;

const PICTURE: [u32; 2] = [96, 64];

/// A GPU after a frame, with the frame's textures by label.
struct Finished {
    gpu: Gpu,
    textures: Vec<(String, TextureId)>,
}

impl Finished {
    /// All that a technique left behind, of a scene with one light view.
    fn run(scene: &Scene, set: &[&str]) -> Self {
        let technique = find("convolution-soft-shadows").unwrap();
        let published = [
            "horizon=off",
            "plane-offset=0",
            "map-size=512",
            "mip-sharper=0.8",
        ];
        let params = Params::parse(technique, published.iter().chain(set)).unwrap();
        let recording = technique.frame(scene, PICTURE, &params).unwrap().recording;
        let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
        gpu.load(&recording).unwrap();
        gpu.submit(&recording.list).unwrap();
        let ids = gpu.texture_ids().zip(recording.textures());
        let textures = ids.map(|(id, t)| (t.descriptor().label.clone(), id));
        Self {
            textures: textures.collect(),
            gpu,
        }
    }

    fn read(&self, label: &str) -> Vec<[f32; 4]> {
        let (_, id) = self.textures.iter().find(|(l, _)| l == label).unwrap();
        let texels = self.gpu.texture(*id).unwrap();
        let texels = texels.read_color(Subresource::default()).unwrap();
        texels.iter().map(|t| t.0).collect()
    }
}

/// What decides that a blocker is nearer.
#[derive(Clone, Copy)]
enum Test {
    Exact,
    Series(Series),
}

impl Test {
    /// 1 − s for scaled depths 0..1.
    fn blocked(&self, d: f64, z: f64) -> f64 {
        match self {
            Self::Exact if z < d => 1.0,
            Self::Exact => 0.0,
            Self::Series(series) => series.blocked(d * series.reach(), z * series.reach()),
        }
    }
}

/// The technique, texel by texel in f64.
struct Twin {
    fitted: Fitted,
    half: [f64; 2],
    depths: Vec<f64>,
    side: usize,
    test: Test,
    threshold: f64,
}

/// Visibility, and 1 − s of the first kernel.
#[derive(Debug)]
struct Found {
    visible: f64,
    blocked: f64,
}

impl Twin {
    fn new(scene: &Scene, ran: &Finished, test: Test) -> Self {
        let around = Surroundings::new(scene, PICTURE);
        let light = ViewedLight::new("test", &scene.lights[0], 0).unwrap();
        let depths = ran.read("light view");
        let side = depths.len().isqrt();
        let fitting = Fitting {
            size: side as u32,
            near: None,
            to: FitTo::Casters,
            margin: 0.0,
        };
        let mut views = views_of(&light, &around, Views::Auto, &fitting).views;
        assert_eq!(views.len(), 1, "one view for one picture");
        let fitted = views.remove(0);
        Self {
            half: [0, 1].map(|k| light.extent.half_along(fitted.frame.axes[k])),
            fitted,
            depths: depths.iter().map(|t| f64::from(t[0])).collect(),
            side,
            test,
            threshold: 0.02,
        }
    }

    /// Width of a texel at a distance, world units.
    fn texel(&self, distance: f64) -> f64 {
        2.0 * self.fitted.half / self.side as f64 * distance
    }

    /// Means over the kernel of a blocker at distance `z`, those outside of the
    /// picture and in the tables' last texels being empty: 1 − s inside, the same
    /// times depth, and the share inside.
    fn means(&self, tangents: [f64; 2], z: f64, d: f64) -> [f64; 3] {
        let n = self.side as f64;
        let scale = 0.5 / self.fitted.half;
        let edges = [0, 1].map(|k| {
            let at = (0.5 + (tangents[k] - self.fitted.middle[k]) * scale) * n;
            let half = (self.half[k] * scale * (1.0 / z - 1.0 / d) * n).max(0.5);
            [at - half, at + half]
        });
        let inside = edges.map(|[a, b]| ((b.min(n - 1.0) - a.max(0.0)) / (b - a)).clamp(0.0, 1.0));
        let limited = edges.map(|[a, b]| {
            let low = a.clamp(0.0, n - 2.0);
            [low, b.clamp(0.0, n - 1.0).max(low + 1.0)]
        });
        let scaled = self.scaled(d);
        let mut sum = [0.0; 3];
        for j in 0..self.side {
            let high = overlap(limited[1], j);
            for i in 0..self.side {
                let weight = high * overlap(limited[0], i);
                if weight > 0.0 {
                    let depth = self.depths[j * self.side + i];
                    let blocked = self.test.blocked(scaled, depth);
                    sum[0] += weight * blocked;
                    sum[1] += weight * blocked * depth;
                    sum[2] += weight;
                }
            }
        }
        [sum[0] / sum[2], sum[1] / sum[2], inside[0] * inside[1]]
    }

    fn scaled(&self, distance: f64) -> f64 {
        let [near, far] = self.fitted.range;
        ((distance - near) / (far - near)).clamp(0.0, 1.0)
    }

    /// Of a world-space position.
    fn visibility(&self, p: DVec3) -> Found {
        let p = self.fitted.frame.local(p);
        let [near, far] = self.fitted.range;
        if p.z <= near {
            return Found {
                visible: 1.0,
                blocked: 0.0,
            };
        }
        let tangents = [p.x / p.z, p.y / p.z];
        let [blocked, weighted, share] = self.means(tangents, near, p.z);
        let first = blocked * share;
        if first < self.threshold {
            return Found {
                visible: 1.0,
                blocked: first,
            };
        }
        let average = (weighted / blocked).clamp(0.0, self.scaled(p.z));
        let [blocked, _, share] = self.means(tangents, near + average * (far - near), p.z);
        Found {
            visible: 1.0 - blocked.clamp(0.0, 1.0) * share,
            blocked: first,
        }
    }
}

/// Length of texel `i` within an interval.
fn overlap([low, high]: [f64; 2], i: usize) -> f64 {
    let i = i as f64;
    (high.min(i + 1.0) - low.max(i)).max(0.0)
}

#[test]
fn an_exact_step_is_the_closed_form_to_a_texel() {
    let scene = builtin::build("parallel-plates").unwrap();
    for side in ["128", "256"] {
        let set = format!("map-size={side}");
        let ran = Finished::run(&scene, &[&set]);
        let twin = Twin::new(&scene, &ran, Test::Exact);
        let texel = twin.texel(PLATES.plate_distance);
        let plate = |by: f64| crate::world::plates::ParallelPlates {
            plate_half: PLATES.plate_half + by,
            ..PLATES
        };
        let mut penumbra = 0;
        for k in -20..=20 {
            for j in [0.0, 0.13, 0.41, 0.66] {
                let p = DVec3::new(f64::from(k) * 0.05 + 0.003, 0.0, j);
                let found = twin.visibility(p).visible;
                let bounds = [texel, -texel].map(|t| plate(t).visibility(p.x, p.z));
                // Below the threshold is lit.
                let slack = if bounds[0] > 1.0 - 2.0 * twin.threshold {
                    twin.threshold
                } else {
                    1e-6
                };
                assert!(
                    found >= bounds[0] - slack && found <= bounds[1] + slack,
                    "{side}: {p}: {found} is not in {bounds:?}"
                );
                penumbra += usize::from(found > 0.05 && found < 0.95);
            }
        }
        assert!(penumbra > 40);
    }
}

/// Every look-up path gives what naive sums give.
#[test]
fn the_shaders_find_what_the_twin_finds() {
    for name in ["cylinder", "spheres"] {
        let scene = builtin::build(name).unwrap();
        let bits = &["filter=sat-u32", "a=0", "map-size=64", "m=5"][..];
        let floats = &["filter=sat", "a=0", "map-size=64", "m=5"];
        let centred = &["filter=sat-mean", "a=0", "map-size=64", "m=5"];
        // Integers have 20 bits here; sums of 64 x 64 floats lose some 1e-4 of a texel.
        for (set, allowed) in [(bits, 2e-5), (floats, 3e-4), (centred, 1e-4)] {
            let ran = Finished::run(&scene, set);
            let series = Series::new(5, Suppression::Scale, 1.0);
            let twin = Twin::new(&scene, &ran, Test::Series(series));
            let (positions, visible) = (ran.read("positions"), ran.read("visibility"));
            let (mut worst, mut judged) = (0.0f64, 0);
            for (i, [x, y, z, w]) in positions.into_iter().enumerate().step_by(31) {
                let found = twin.visibility(DVec3::from([x, y, z].map(f64::from)));
                if w == 0.0 || (found.blocked - twin.threshold).abs() < 0.05 * twin.threshold {
                    continue;
                }
                let error = (f64::from(visible[i][0]) - found.visible).abs();
                assert!(
                    error < allowed,
                    "{name} {set:?} pixel {i}: {found:?} {error}"
                );
                worst = worst.max(error);
                judged += usize::from(found.visible < 1.0);
            }
            println!("{name} {set:?}: {worst:.2e} over {judged}");
            assert!(judged > 10, "{name}");
        }
    }
}
