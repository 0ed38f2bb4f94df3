//! The animated scene: a creature walks in a circle, a ball bounces and is
//! squashed where it lands, a knot turns, a beam swings. Everything is made anew
//! for each moment; it repeats after [`PERIOD`] seconds.

use std::f64::consts::{PI, TAU};

use glam::{DMat4, DVec3};

use super::palette::{BRASS, CLAY, MOSS, STEEL, STONE, floor, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Object, Scene};
use crate::world::shape::{self, Shape, on_circle};

/// Seconds until everything is as it was.
const PERIOD: f64 = 8.0;
/// Steps of the creature, bounces of the ball and turns of the knot in a period.
const STEPS: f64 = 7.0;
const BOUNCES: f64 = 8.0;
const TURNS: f64 = 2.0;
/// Radius of the creature's way, and of the ball.
const WAY: f64 = 1.25;
const BALL: f64 = 0.3;

/// The scene at `time`, seconds.
pub(super) fn scene(time: f64) -> Scene {
    let turn = TAU * (time / PERIOD - (time / PERIOD).floor());
    let light = Light::horizontal_square(DVec3::new(2.6, 5.6, 2.8), 1.0);
    let camera = Camera {
        fov_y_degrees: 38.0,
        ..Camera::look_at([1.4, 3.1, 6.6], [0.05, 0.75, 0.0])
    };
    let objects = vec![
        floor(12.0),
        creature(turn),
        solid("ball", ball(turn), CLAY),
        solid("knot", knot(turn), BRASS),
        solid("beam", beam(turn), STEEL),
        solid(
            "post",
            shape::cuboid(DVec3::new(0.0, 0.35, 0.0), DVec3::new(0.5, 0.7, 0.5)),
            STONE,
        ),
    ];
    Scene::new(camera, vec![light], objects)
}

/// Walks along its way, facing ahead.
fn creature(turn: f64) -> Object {
    let (cos, sin) = on_circle(turn);
    // It faces +z unturned; along a circle from +x towards +z it faces (-sin, cos).
    let place = DVec3::new(WAY * cos, 0.0, WAY * sin);
    let body = shape::placed_creature(STEPS * turn, -turn, place);
    solid("creature", body, MOSS)
}

/// Bounces; below its own height it is squashed, its volume kept.
fn ball(turn: f64) -> Shape {
    let hop = BOUNCES * turn / TAU;
    let hop = hop - hop.floor();
    let height = 4.0 * hop * (1.0 - hop);
    let flat = 1.0 - 0.35 * (1.0 - height) * (1.0 - height) * (1.0 - height);
    let wide = 1.0 / flat.sqrt();
    let centre = DVec3::new(-2.0, BALL * flat + 0.9 * height + 1e-3, 0.9);
    let place = DMat4::from_translation(centre) * DMat4::from_scale(DVec3::new(wide, flat, wide));
    shape::icosphere(3, BALL, DVec3::ZERO).transformed(place)
}

/// Turns above the post.
fn knot(turn: f64) -> Shape {
    let (cos, sin) = on_circle(TURNS * turn);
    let turned = DMat4::from_cols_array(&[
        cos, 0.0, -sin, 0.0, 0.0, 1.0, 0.0, 0.0, sin, 0.0, cos, 0.0, 0.0, 1.32, 0.0, 1.0,
    ]);
    shape::torus_knot(2, 3, 0.42, 0.12, 0.07, 192, 16, DVec3::ZERO).transformed(turned)
}

/// Swings about its upper end.
fn beam(turn: f64) -> Shape {
    let (cos, sin) = on_circle(0.5 * libm::sin(2.0 * turn) + PI);
    let swung = DMat4::from_cols_array(&[
        cos, sin, 0.0, 0.0, -sin, cos, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -0.2, 2.5, -1.7, 1.0,
    ]);
    let bar = shape::cuboid(DVec3::new(0.0, 0.95, 0.0), DVec3::new(0.14, 1.9, 0.5));
    bar.transformed(swung)
}
