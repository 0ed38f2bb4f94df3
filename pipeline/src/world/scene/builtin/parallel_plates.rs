//! Light, plate and floor parallel and square: the soft shadow in closed form.

use glam::DVec3;

use super::palette::{STEEL, floor, solid};
use crate::world::light::Light;
use crate::world::plates::ParallelPlates;
use crate::world::scene::{Camera, Scene};
use crate::world::shape;

/// The scene's dimensions (docs/papers.md, scenes, PP): the floor is y = 0, centred.
pub const PLATES: ParallelPlates = ParallelPlates {
    light_half: 0.5,
    plate_half: 0.3,
    plate_distance: 2.0,
    floor_distance: 3.0,
};

/// The plate is bevelled, so that its lower side adds no shadow; the form holds
/// on the floor for |x|, |z| <= 4.
pub(super) fn scene() -> Scene {
    let light = Light::horizontal_square(DVec3::Y * PLATES.floor_distance, 2.0 * PLATES.light_half);
    let height = PLATES.floor_distance - PLATES.plate_distance;
    let plate = shape::bevelled_plate(PLATES.plate_half, height, 0.01, 1.6);
    Scene::new(
        Camera::look_at([0.9, 1.5, 2.1], [0.0, 0.3, 0.0]),
        vec![light],
        vec![floor(4.0), solid("plate", plate, STEEL)],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::oracle::hard::HardOracle;
    use crate::world::light::HardLight;

    /// From every point of the light, the closed plate of the scene blocks what
    /// the flat square of the closed form blocks.
    #[test]
    fn the_bevelled_plate_blocks_like_a_flat_square() {
        let scene = scene();
        let on_light = |k: i32| (f64::from(k) + 0.5) / 4.0 * PLATES.light_half; // k in -4..4
        let on_floor = |k: i32| 0.097 * f64::from(k);
        for (s, t) in (-4..4).flat_map(|s| (-4..4).map(move |t| (s, t))) {
            let from = DVec3::new(on_light(s), PLATES.floor_distance, on_light(t));
            let oracle = HardOracle::new(&scene, HardLight::Point(from));
            for (i, k) in (-12..12).flat_map(|i| (-12..12).map(move |k| (i, k))) {
                let at = DVec3::new(on_floor(i), 0.0, on_floor(k));
                let share = PLATES.plate_distance / PLATES.floor_distance;
                let on_plate = (from + (at - from) * share).abs();
                let blocked = on_plate.x < PLATES.plate_half && on_plate.z < PLATES.plate_half;
                assert_eq!(
                    oracle.shadow_count_at(at),
                    u32::from(blocked),
                    "{from} {at}"
                );
            }
        }
    }
}
