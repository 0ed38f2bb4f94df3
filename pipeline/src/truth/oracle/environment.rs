//! The reference of environment lighting: directions sampled from the map, and
//! shadow rays (Annen et al. 2008, §6: 1000 samples and ray tracing).
//!
//! Directions are chosen once for all pixels, in proportion to the energy of the map as
//! its file has it, not of the cube that lights are fitted to: number k of n looks up the running sum of luminance at `(k + s) / n`, which
//! stratifies energy, and lies in its texel at a point of the R2 sequence
//! (Roberts: multiples of powers of the plastic number's inverse); `s` and the
//! start of the sequence come from the seed. Light is at infinity, unlike that of
//! fitted lights. A receiver is shaded with the renderer's own model: albedo times
//! cosine, and Phong's highlight, for each direction; normals are those that
//! shading interpolates.
//!
//! The error falls about as 1/n where shadows are soft; a small sun is one
//! direction whatever n, as near as its texels tell.

use glam::DVec3;
use rayon::prelude::*;

use super::bvh::{Bvh, Ray};
use super::sampled::jitter;
use super::surfaces::{Receiver, SurfaceHit, Surfaces};
use crate::world::environment::MapSource;
use crate::world::mesh::widen;
use crate::world::scene::{EyeRays, MaterialPart, Object, Scene};

/// Directions where no number is given.
pub const DIRECTIONS: usize = 1024;

/// Inverse of the plastic number, and its square.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// Light from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Towards the light, of length 1.
    pub towards: DVec3,
    /// Radiance times the solid angle that the sample stands for.
    pub energy: [f64; 3],
}

/// Luminance of linear Rec. 709 RGB.
fn luminance(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

/// `count` directions in proportion to the luminance of `map`.
pub fn samples(map: &MapSource, count: usize, seed: u64) -> Vec<Sample> {
    let energies: Vec<[f64; 3]> = (0..map.len()).map(|i| map.energy(i)).collect();
    let total: f64 = energies.iter().map(|e| luminance(*e)).sum();
    let start = [1, 2].map(|k| jitter(seed, k));
    let shift = jitter(seed, 0);
    let (mut texel, mut before) = (0, 0.0);
    let mut out = Vec::with_capacity(count);
    for k in 0..count {
        let wanted = (k as f64 + shift) / count as f64 * total;
        while texel + 1 < energies.len() && before + luminance(energies[texel]) <= wanted {
            before += luminance(energies[texel]);
            texel += 1;
        }
        let inside = [0, 1].map(|a| {
            let t = start[a] + k as f64 * R2[a];
            t - t.floor()
        });
        let (towards, density) = map.direction(texel, inside);
        let share = total / count as f64 / luminance(energies[texel]) * density;
        out.push(Sample {
            towards,
            energy: energies[texel].map(|e| e * share),
        });
    }
    out
}

/// Shadow rays into an environment; build once, query often.
#[derive(Clone, Debug)]
pub struct EnvironmentOracle {
    samples: Vec<Sample>,
    casters: Bvh,
}

impl EnvironmentOracle {
    /// Prepares `samples` for the casters of a scene.
    pub fn new(surfaces: &Surfaces, samples: Vec<Sample>) -> Self {
        let triangles: Vec<_> = surfaces.casters().map(|(_, t)| t).collect();
        Self {
            samples,
            casters: Bvh::new(&triangles),
        }
    }

    /// Light that a surface at `receiver` sends to the eye.
    fn radiance(&self, receiver: DVec3, surface: &Shading) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for sample in &self.samples {
            let cosine = surface.normal.dot(sample.towards);
            if cosine <= 0.0 {
                continue;
            }
            let ray = Ray::new(receiver, sample.towards);
            if surface.receives && self.casters.any(&ray, 0.0..f64::INFINITY) {
                continue;
            }
            let reflected = surface.reflected(sample.towards, cosine);
            (0..3).for_each(|c| sum[c] += reflected[c] * sample.energy[c]);
        }
        sum.map(|v| v / std::f64::consts::PI)
    }

    /// Linear RGB of every pixel, rows from the top; `None` where no surface is
    /// seen. `highlights` as in the parameter `shading=phong`. `row_done` is
    /// called for every row, from any thread.
    pub fn image(
        &self,
        surfaces: &Surfaces,
        scene: &Scene,
        [width, height]: [u32; 2],
        highlights: bool,
        row_done: &(dyn Fn() + Sync),
    ) -> Vec<Option<[f64; 3]>> {
        let rays = scene.camera.eye_rays(width, height);
        let pixel = |x: u32, y: u32| {
            let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let hit = surfaces.hit(&rays, x, y)?;
            let sight = rays.direction(x, y);
            let seen = rays.origin + sight * hit.depth;
            let surface = Shading::new(scene, &hit, seen, sight, highlights);
            let surface = surface.textured(scene, &hit, &rays, [x, y]);
            let corners = &surfaces.corners()[surfaces.index_of(&hit) as usize];
            let receiver = Receiver::on_facet(corners, seen, sight);
            Some(self.radiance(receiver.point, &surface))
        };
        let row = |y: u32| {
            let row: Vec<_> = (0..width).map(|x| pixel(x, y)).collect();
            row_done();
            row
        };
        let rows: Vec<_> = (0..height).into_par_iter().map(row).collect();
        rows.concat()
    }
}

/// A surface point as the renderer shades it.
struct Shading {
    /// Interpolated, turned towards the eye's side of the facet, of length 1.
    normal: DVec3,
    /// Towards the eye, of length 1.
    to_eye: DVec3,
    albedo: [f64; 3],
    specular: [f64; 3],
    shininess: f32,
    receives: bool,
}

impl Shading {
    fn new(scene: &Scene, hit: &SurfaceHit, seen: DVec3, sight: DVec3, highlights: bool) -> Self {
        let object = &scene.objects[hit.object as usize];
        let triangle = hit.triangle as usize;
        let [a, b, c] = object.mesh.corners(triangle);
        let facet = (b - a).cross(c - a);
        let weights = barycentric([a, b, c], facet, seen);
        let normals = object.mesh.normal_triangles()[triangle];
        let normals = normals.map(|n| widen(object.mesh.normals()[n as usize]));
        let normal: DVec3 = (0..3).map(|k| normals[k] * weights[k]).sum();
        let facing = if facet.dot(sight) > 0.0 { -1.0 } else { 1.0 };
        let material = part(object, hit.triangle).map_or(object.material, |p| p.material);
        let strength = if highlights { 1.0 } else { 0.0 };
        Self {
            normal: normal.normalize_or_zero() * facing,
            to_eye: -sight.normalize_or_zero(),
            albedo: material.albedo.map(f64::from),
            specular: material.specular.map(|v| strength * f64::from(v)),
            shininess: material.shininess,
            receives: object.receives,
        }
    }

    /// The same with the texture of what is seen, filtered over the pixel around `at`.
    fn textured(mut self, scene: &Scene, hit: &SurfaceHit, rays: &EyeRays, at: [f64; 2]) -> Self {
        let object = &scene.objects[hit.object as usize];
        let part = part(object, hit.triangle);
        if let Some(texture) = part.and_then(|p| p.texture.as_ref()) {
            let place = |x, y| texture_place(object, hit.triangle, rays, [x, y]);
            let [x, y] = at;
            let change = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], b[1] - a[1]];
            let gradients = [
                change(place(x - 0.5, y), place(x + 0.5, y)),
                change(place(x, y - 0.5), place(x, y + 0.5)),
            ];
            let base = texture.sample(place(x, y), gradients);
            self.albedo = [0, 1, 2].map(|c| self.albedo[c] * base[c]);
        }
        self
    }

    /// Share of light from a direction that goes to the eye, times the cosine and
    /// times π.
    fn reflected(&self, towards: DVec3, cosine: f64) -> [f64; 3] {
        let highlight = if self.specular == [0.0; 3] {
            0.0
        } else {
            let mirrored = 2.0 * cosine * self.normal.dot(self.to_eye) - towards.dot(self.to_eye);
            power(mirrored.clamp(0.0, 1.0), self.shininess)
        };
        [0, 1, 2].map(|c| self.albedo[c] * cosine + self.specular[c] * highlight)
    }
}

fn part(object: &Object, triangle: u32) -> Option<&MaterialPart> {
    let own = |part: &&MaterialPart| part.triangles.binary_search(&triangle).is_ok();
    object.parts.iter().find(own)
}

/// Where the ray through a point of the image meets the plane of a triangle, as texture
/// coordinates.
fn texture_place(object: &Object, triangle: u32, rays: &EyeRays, [x, y]: [f64; 2]) -> [f64; 2] {
    let [a, b, c] = object.mesh.corners(triangle as usize);
    let facet = (b - a).cross(c - a);
    let sight = rays.direction(x, y);
    let seen = rays.origin + sight * (facet.dot(a - rays.origin) / facet.dot(sight));
    let weights = barycentric([a, b, c], facet, seen);
    let corners = object.coordinates_of(triangle);
    [0, 1].map(|axis| {
        let of = |k: usize| weights[k] * f64::from(corners[k][axis]);
        of(0) + of(1) + of(2)
    })
}

fn barycentric([a, b, c]: [DVec3; 3], facet: DVec3, p: DVec3) -> [f64; 3] {
    let area = facet.dot(facet);
    if area == 0.0 {
        return [1.0 / 3.0; 3];
    }
    let of = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).dot(facet) / area;
    [of(p, b, c), of(a, p, c), of(a, b, p)]
}

/// The shaders' own power ([`gnomon_shaders::surface::power`]) in f64: linear
/// between whole exponents.
fn power(x: f64, exponent: f32) -> f64 {
    let limited = exponent.clamp(0.0, gnomon_shaders::surface::MAX_SHININESS);
    let whole = limited.floor();
    let part = f64::from(limited - whole);
    libm::pow(x, f64::from(whole)) * (x * part + (1.0 - part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::environment::cube::direction;
    use crate::world::environment::{Environment, MapSettings, SKY};
    use crate::world::scene::builtin;
    use std::f64::consts::PI;

    fn sky() -> Environment {
        Environment::open(SKY, MapSettings::default()).unwrap()
    }

    fn uniform(radiance: f32) -> Environment {
        let map =
            Environment::of_radiance("white", [1, 1], vec![[radiance; 3]], MapSettings::default());
        map.unwrap()
    }

    /// Sums over the sphere and its upper half are those of the map.
    #[test]
    fn samples_carry_the_energy_of_the_map() {
        let map = sky();
        let cube = &map.cube;
        let side = cube.side();
        let all = cube.energy(cube.total());
        let above: f64 = (0..cube.texels().len())
            .filter(|i| {
                let middle = |k: usize| (2.0 * k as f64 + 1.0) / side as f64 - 1.0;
                let at = [i % side, i / side % side].map(middle);
                direction(i / (side * side), at).y > 0.0
            })
            .map(|i| cube.energy(cube.texels()[i])[1])
            .sum();
        for seed in [1, 2] {
            let found = samples(&map.source, 1024, seed);
            assert_eq!(found.len(), 1024);
            assert_eq!(found, samples(&map.source, 1024, seed));
            for c in 0..3 {
                let sum: f64 = found.iter().map(|s| s.energy[c]).sum();
                assert!((sum / all[c] - 1.0).abs() < 0.02, "{c}: {sum} {all:?}");
            }
            let up = found.iter().filter(|s| s.towards.y > 0.0);
            let up: f64 = up.map(|s| s.energy[1]).sum();
            assert!((up / above - 1.0).abs() < 0.02, "{up} {above}");
        }
        assert!(samples(&map.source, 64, 1) != samples(&map.source, 64, 2));
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let scene = builtin::build("creature").unwrap();
        let surfaces = Surfaces::new(&scene);
        let oracle = EnvironmentOracle::new(&surfaces, samples(&sky().source, 100, 1));
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let image = || oracle.image(&surfaces, &scene, [40, 30], true, &|| {});
            pool.unwrap().install(image)
        };
        let one = with(1);
        assert!(one == with(4) && one.iter().flatten().count() > 500);
    }

    /// Under a white sky an open matt floor is as bright as its albedo, and what
    /// casters hide is missing: the errors of estimates fall with their number.
    #[test]
    fn a_white_sky_makes_open_surfaces_white() {
        let scene = builtin::build("cylinder").unwrap();
        let surfaces = Surfaces::new(&scene);
        let image = |count: usize| {
            let oracle = EnvironmentOracle::new(&surfaces, samples(&uniform(1.0).source, count, 3));
            oracle.image(&surfaces, &scene, [32, 24], false, &|| {})
        };
        let (few, many) = (image(256), image(2048));
        let floor = f64::from(scene.objects[0].material.albedo[0]);
        let brightest = many.iter().flatten().fold(0.0, |m: f64, rgb| rgb[0].max(m));
        assert!(
            (brightest / floor - 1.0).abs() < 0.01,
            "{brightest} {floor}"
        );
        let darkest = many.iter().flatten().fold(9.0, |m: f64, rgb| rgb[0].min(m));
        assert!(darkest < 0.8 * floor);
        let finest = image(8192);
        let rms = |image: &[Option<[f64; 3]>]| {
            let pairs = image.iter().flatten().zip(finest.iter().flatten());
            let squares: f64 = pairs.map(|(a, b)| (a[0] - b[0]) * (a[0] - b[0])).sum();
            squares.sqrt()
        };
        assert!(rms(&many) < 0.5 * rms(&few), "{} {}", rms(&many), rms(&few));
    }

    /// One direction is the renderer's own picture under a directional light.
    #[test]
    fn one_direction_is_a_directional_light() {
        use crate::measure::render::{RenderSettings, render};
        use crate::technique::Params;
        use crate::techniques::find;
        use crate::world::light::{Light, LightShape};
        let mut scene = builtin::build("creature").unwrap();
        scene.ambient = [0.0; 3];
        let towards = DVec3::new(0.48, 0.8, 0.36);
        let colour = [0.9f32, 0.6, 0.3];
        scene.lights = vec![Light {
            shape: LightShape::Directional { towards },
            colour,
        }];
        let technique = find("shadow-volumes").unwrap();
        let settings = RenderSettings {
            size: [96, 72],
            ..RenderSettings::default()
        };
        let params = Params::defaults(technique);
        let done = render(&scene, technique, &params, &settings).unwrap();
        let surfaces = Surfaces::new(&scene);
        let sample = Sample {
            towards,
            energy: colour.map(|c| f64::from(c) * PI),
        };
        let oracle = EnvironmentOracle::new(&surfaces, vec![sample]);
        let truth = oracle.image(&surfaces, &scene, [96, 72], true, &|| {});
        let (mut seen, mut off) = (0, 0);
        for (pixel, truth) in done.color.iter().zip(&truth) {
            let Some(truth) = truth else { continue };
            seen += 1;
            let close = |c: usize| (f64::from(pixel[c]) - truth[c]).abs() < 4e-3;
            off += usize::from(!(0..3).all(close));
        }
        // At outlines and shadow edges pixels may fall on either side.
        assert!(seen > 3000 && off * 200 < seen, "{off} of {seen}");
    }
}
