//! The near plane of a camera that was given none.
//!
//! It follows from the scene, so that the same scene in other units gives the same
//! picture: half as far as the nearest surface in view, so that nothing is cut, and
//! no nearer than that, for a depth buffer's steps are inversely proportional to it.
//! It is rounded down to a power of two, so that a scene in units of another power
//! of two has the same depths to the bit, and one that moves has few near planes.

use super::{Pyramid, Scene};

/// Of the distance of the nearest surface.
const SHARE: f64 = 0.5;
/// Least near distance over that of the point that is looked at. There a buffer of
/// 24 bits still has steps of 1/1024 of its distance.
const LEAST: f64 = 1.0 / 16_384.0;
/// The same where nothing is seen.
const NOTHING_SEEN: f64 = 1.0 / 64.0;
/// Width over height of the widest picture in which nothing is cut.
const WIDEST: [u32; 2] = [4, 1];

/// The near distance for the scene's camera, whose own is not looked at.
pub(super) fn derived(scene: &Scene) -> f64 {
    let camera = &scene.camera;
    let sight = (camera.target - camera.eye).length();
    let near = match nearest(scene) {
        Some(nearest) => (nearest * SHARE).max(sight * LEAST),
        None => sight * NOTHING_SEEN,
    };
    power_of_two_up_to(near)
}

/// Least planar distance of a surface in view.
fn nearest(scene: &Scene) -> Option<f64> {
    let pyramid = Pyramid::new(&scene.camera, WIDEST).up_to_eye();
    let depths = scene.objects.iter().filter_map(|o| pyramid.depths(&o.mesh));
    depths.map(|[nearest, _]| nearest).reduce(f64::min)
}

/// The largest power of two that is not above a normal positive number.
fn power_of_two_up_to(x: f64) -> f64 {
    const SIGN_AND_EXPONENT: u64 = 0xfff0_0000_0000_0000;
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & SIGN_AND_EXPONENT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;
    use glam::DVec3;

    #[test]
    fn powers_of_two_are_not_above() {
        for (x, power) in [
            (1.0, 1.0),
            (1.99, 1.0),
            (0.3, 0.25),
            (5e-324, f64::MIN_POSITIVE),
        ] {
            assert_eq!(power_of_two_up_to(x), power);
        }
    }

    #[test]
    fn nothing_in_view_is_cut_and_depth_is_not_wasted() {
        for entry in builtin::SCENES {
            let scene = entry.build();
            let nearest = nearest(&scene).unwrap();
            let near = derived(&scene);
            assert!(near <= nearest && near >= nearest / 4.0, "{}", entry.name);
        }
    }

    #[test]
    fn it_scales_with_the_scene() {
        let scene = builtin::build("cylinder").unwrap();
        for exponent in [-20, -3, 1, 20] {
            let scale = libm::exp2(f64::from(exponent));
            let placed = scene.placed(scale, DVec3::ZERO).unwrap();
            assert_eq!(derived(&placed), derived(&scene) * scale);
        }
        for scale in [1e-6, 1e-3, 1e7] {
            let placed = scene.placed(scale, DVec3::ZERO).unwrap();
            let ratio = derived(&placed) / (derived(&scene) * scale);
            assert!((0.5..=2.0).contains(&ratio), "{ratio}");
        }
    }

    #[test]
    fn a_surface_at_the_eye_leaves_a_near_plane() {
        let mut scene = builtin::build("cylinder").unwrap();
        scene.camera.eye = scene.objects[1].mesh.position(0);
        assert!(derived(&scene) > 0.0);
        scene.objects.clear();
        assert!(derived(&scene) > 0.0);
    }
}
