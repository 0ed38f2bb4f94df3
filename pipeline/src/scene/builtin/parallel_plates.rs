//! Light, plate and floor parallel and square: the soft shadow in closed form.

use glam::DVec3;

use super::palette::{STEEL, floor, solid};
use crate::light::Light;
use crate::oracle::plates::ParallelPlates;
use crate::scene::{Camera, Scene};
use crate::shape;

/// The scene's dimensions (IMPLEMENTING §5, PP): the floor is y = 0, centred.
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
