//! The look-up against sums in f64 over the same patches, and the size of its disc.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use glam::DVec3;
use gnomon_raster::{Gpu, GpuConfig, Subresource};

use super::*;
use crate::parts::passes::View;
use crate::technique::VisibilityOutput;
use crate::world::light::LightShape;
use crate::world::scene::builtin;

const SIZE: [u32; 2] = [40, 28];
const CENTRE: DVec3 = DVec3::new(1.2, 3.4, 0.9);
const RADIUS: f64 = 0.5;

/// A frame's textures, as they are in the end.
struct Drawn {
    positions: Vec<[f32; 4]>,
    patches: Vec<[f32; 4]>,
    visibility: Vec<f32>,
}

fn scene() -> Scene {
    let mut scene = builtin::build("cylinder").unwrap();
    scene.lights[0].shape = LightShape::Sphere {
        centre: CENTRE,
        radius: RADIUS,
    };
    scene
}

fn drawn(set: &[&str]) -> Drawn {
    let params = Params::parse(
        &ConeCulling,
        [set, &["map-size=32", "horizon=off"]].concat(),
    )
    .unwrap();
    let frame = ConeCulling.frame(&scene(), SIZE, &params).unwrap();
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    gpu.load(&frame.recording).unwrap();
    gpu.submit(&frame.recording.list).unwrap();
    let all = |label: &str| {
        let mut found = gpu.texture_ids().map(|id| gpu.texture(id).unwrap());
        let texture = found.find(|t| t.descriptor().label == label).unwrap();
        let texels = texture.read_color(Subresource::default()).unwrap();
        texels.iter().map(|t| t.0).collect::<Vec<_>>()
    };
    assert!(matches!(
        frame.outputs.visibility,
        VisibilityOutput::Red { .. }
    ));
    Drawn {
        positions: all("positions"),
        patches: all("patches"),
        visibility: all("visibility").iter().map(|t| t[0]).collect(),
    }
}

/// Solid angle of the sphere round a patch, or of its rectangle, by the sum of its
/// corners' arctangents.
fn solid_angle(rectangle: Option<[DVec3; 3]>, v: DVec3, radius: f64) -> f64 {
    let Some(axes) = rectangle else {
        let sine = (radius / v.length()).min(1.0);
        return TAU * (1.0 - (1.0 - sine * sine).sqrt());
    };
    let [x, y, z] = axes.map(|a| a.dot(v));
    let half = radius * FRAC_1_SQRT_2;
    let corner = |s: f64, t: f64| {
        let (x, y) = (x + s * half, y + t * half);
        s * t * libm::atan2(x * y, z.abs() * (x * x + y * y + z * z).sqrt())
    };
    corner(1.0, 1.0) + corner(1.0, -1.0) + corner(-1.0, 1.0) + corner(-1.0, -1.0)
}

/// Least and most of what patches hide of the light at `p`: those at the border of the
/// cone may be in it or not.
fn hidden(patches: &[[f32; 4]], p: DVec3, light: DVec3, axes: Option<[DVec3; 3]>) -> [f64; 2] {
    let to = light - p;
    let sine = RADIUS / to.length();
    let whole = TAU * (1.0 - (1.0 - sine * sine).sqrt());
    let half_angle = libm::asin(sine);
    let mut sums = [0.0; 2];
    for patch in patches.iter().filter(|q| q[3] > 0.0) {
        let [x, y, z, radius] = patch.map(f64::from);
        let v = DVec3::new(x, y, z) - p;
        let angle = libm::acos(v.normalize().dot(to.normalize()));
        let share = solid_angle(axes, v, radius) / whole;
        for (sum, more) in sums.iter_mut().zip([-1e-4, 1e-4]) {
            let beyond = v.dot(to) > to.length_squared();
            if angle < half_angle + more && !beyond {
                *sum += share;
            }
        }
    }
    sums.map(|s| s.min(1.0))
}

/// Sums of the shader are those of f64, for spheres and rectangles, found either way.
#[test]
fn shaders_sum_what_f64_sums() {
    let view = View::new(&scene().camera, SIZE);
    let light = view.relative(CENTRE);
    // As views towards receivers have them; any axes across would do for spheres.
    let axes = {
        use crate::parts::maps::light_view::{Surroundings, ViewedLight, views_of};
        use crate::parts::maps::mapped::ViewSettings;
        let params = Params::defaults(&ConeCulling);
        let settings = ViewSettings::read(&params, 32).unwrap();
        let scene = scene();
        let around = Surroundings::new(&scene, SIZE);
        let viewed = ViewedLight::new("test", &scene.lights[0], 0).unwrap();
        let found = views_of(&viewed, &around, settings.views, &settings.fitting);
        assert_eq!(found.views.len(), 1);
        found.views[0].frame.axes
    };
    for method in ["method=octree", "method=all"] {
        for (form, axes) in [("spheres", None), ("rectangles", Some(axes))] {
            let found = drawn(&[method, &format!("patches={form}")]);
            let (mut shadowed, mut penumbra, mut off) = (0, 0, 0.0f64);
            for (at, seen) in found.positions.iter().zip(&found.visibility) {
                let [x, y, z, receives] = at.map(f64::from);
                if receives == 0.0 {
                    continue;
                }
                let [low, high] = hidden(&found.patches, DVec3::new(x, y, z), light, axes);
                let dark = 1.0 - f64::from(*seen);
                off = off.max(low - dark).max(dark - high);
                shadowed += usize::from(dark > 0.0);
                penumbra += usize::from(dark > 0.0 && dark < 1.0);
            }
            println!("{method} {form}: {shadowed} {penumbra} off {off}");
            assert!(off < 2e-4, "{method} {form}: {off}");
            assert!(shadowed > 60 && penumbra > 25, "{method} {form}");
        }
    }
}

/// What a cone cuts out of the near plane is no farther from the receiver's place there
/// than the disc reaches, and somewhere as far.
#[test]
fn discs_hold_what_cones_cut_out_of_the_near_plane() {
    let jitter = crate::truth::oracle::sampled::jitter;
    let mut tight = 0;
    for case in 0..400u64 {
        let random = |k: u64| jitter(3, case * 8 + k);
        let (near, depth) = (0.5 + random(0), 2.0 + 4.0 * random(1));
        let apex = DVec3::new(4.0 * random(2) - 2.0, 4.0 * random(3) - 2.0, depth);
        let radius = 0.05 + 0.4 * random(4);
        let sine = radius / apex.length();
        let axis = -apex.normalize();
        let off_axis = libm::acos(-axis.z) + libm::asin(sine);
        let bound = radius * (1.0 / near - 1.0 / depth) / libm::cos(off_axis);
        let (u, v) = axis.any_orthonormal_pair();
        let mut reached = 0.0f64;
        for step in 0..720 {
            let angle = f64::from(step) * PI / 360.0;
            let (s, c) = (libm::sin(angle), libm::cos(angle));
            let ray = axis * (1.0 - sine * sine).sqrt() + (u * c + v * s) * sine;
            let at = apex + ray * ((near - depth) / ray.z);
            let place = (at / near - apex / depth).truncate();
            reached = reached.max(place.length());
        }
        assert!(reached <= bound * (1.0 + 1e-9), "{case}: {reached} {bound}");
        tight += usize::from(reached > bound * 0.9999);
        // Similar triangles alone are too small.
        let plain = radius * (1.0 / near - 1.0 / depth);
        assert!(reached > plain, "{case}");
    }
    assert_eq!(tight, 400);
}
