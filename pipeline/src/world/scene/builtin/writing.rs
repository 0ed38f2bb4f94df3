//! Letters that cast shadows, after the pictures of papers I and II: a logo of two letters
//! and "2002" over pots, an @ over a landscape. Outlines, pots and places are ours.

use glam::{DMat4, DVec3};

use super::letters;
use super::palette::{BRASS, CLAY, MOSS, STEEL, STONE, floor, solid};
use crate::world::light::{Light, LightShape};
use crate::world::mesh::Shading;
use crate::world::scene::{Camera, Object, Scene};
use crate::world::shape::{self, Outline, Shape};

/// Thickness of letters.
const DEPTH: f64 = 0.22;

/// A word in the plane z = 0, its middle at the origin.
fn word(letters: &[Outline], apart: f64) -> Shape {
    let middle = 0.5 * (letters.len() as f64 - 1.0);
    let place = |(k, outline): (usize, &Outline)| {
        let x = (k as f64 - middle) * apart;
        shape::prism(outline, DEPTH).translated(DVec3::new(x, 0.0, 0.5 * DEPTH))
    };
    Shape::merged(letters.iter().enumerate().map(place))
}

fn placed(shape: Shape, scale: f64, lean: f64, at: DVec3) -> Shape {
    let turned = DMat4::from_rotation_x(lean) * DMat4::from_scale(DVec3::splat(scale));
    shape.transformed(DMat4::from_translation(at) * turned)
}

/// A pot with lid, handle and spout, which takes shadows and casts none.
fn pot(name: &str, at: DVec3, turned: f64) -> Vec<Object> {
    const SIDES: u32 = 28;
    let profile = [
        [0.02, 0.0],
        [0.24, 0.0],
        [0.36, 0.10],
        [0.42, 0.24],
        [0.38, 0.40],
        [0.27, 0.52],
        [0.25, 0.56],
        [0.12, 0.62],
        [0.04, 0.64],
        [0.07, 0.71],
        [0.01, 0.76],
    ];
    let ring = |[radius, y]: [f64; 2]| {
        let corner = |k: u32| {
            let angle = -2.0 * std::f64::consts::PI * f64::from(k) / f64::from(SIDES);
            DVec3::new(radius * libm::cos(angle), y, radius * libm::sin(angle))
        };
        (0..SIDES).map(corner).collect::<Vec<_>>()
    };
    let body = shape::tube(&profile.map(ring));
    let bend = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let spout = shape::capsule(bend(0.30, 0.18), bend(0.66, 0.50), 0.09, 0.045, 16, 3);
    let grip = shape::torus_knot(1, 0, 0.17, 0.0, 0.035, 32, 10, DVec3::ZERO);
    let upright = DMat4::from_translation(bend(-0.42, 0.30));
    let upright = upright * DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let place = DMat4::from_translation(at) * DMat4::from_rotation_y(turned);
    let parts = [
        ("body", body),
        ("spout", spout),
        ("handle", grip.transformed(upright)),
    ];
    let part = |(what, shape): (&str, Shape)| {
        let shape = shape.transformed(place);
        let mesh = shape.into_mesh(Shading::Smooth).expect("pots are finite");
        Object::new(format!("{name} {what}"), mesh, STONE).receiver_only()
    };
    parts.into_iter().map(part).collect()
}

fn lamp(centre: DVec3, radius: f64) -> Vec<Light> {
    vec![Light {
        shape: LightShape::Sphere { centre, radius },
        colour: [1.0; 3],
    }]
}

/// E and G and two balls over three pots (paper I, figure 12).
pub(super) fn eg() -> Scene {
    let logo = placed(
        word(&[letters::e(), letters::g()], 0.92),
        0.9,
        -0.5,
        DVec3::new(0.0, 1.75, 0.1),
    );
    let ball = |x: f64, z: f64| shape::icosphere(3, 0.2, DVec3::new(x, 1.5, z));
    let mut objects = vec![
        floor(7.0),
        solid("letters", logo, BRASS),
        solid("left ball", ball(-1.35, 0.3), STEEL),
        solid("right ball", ball(1.35, 0.2), STEEL),
    ];
    objects.extend(pot("left pot", DVec3::new(-0.95, 0.0, -0.2), 0.6));
    objects.extend(pot("middle pot", DVec3::new(0.1, 0.0, -0.5), 2.4));
    objects.extend(pot("right pot", DVec3::new(1.1, 0.0, -0.1), -0.5));
    Scene::new(
        Camera::look_at([0.3, 2.5, 4.6], [0.0, 0.75, -0.2]),
        lamp(DVec3::new(0.5, 5.2, 2.2), 0.3),
        objects,
    )
}

/// @ over the fractal landscape (paper I, figure 14).
pub(super) fn at_sign() -> Scene {
    let land = shape::diamond_square(8, 224, 6.0, 1.6, 2005);
    let land = land.into_mesh(Shading::Smooth).expect("heights are finite");
    let sign = shape::prism(&letters::at_sign(), 0.12);
    let sign = placed(sign, 2.6, -1.0, DVec3::new(0.0, 2.7, 0.5));
    Scene::new(
        Camera::look_at([0.0, 4.6, 7.2], [0.0, 0.8, 0.0]),
        lamp(DVec3::new(1.2, 8.0, 2.4), 0.35),
        vec![
            Object::new("landscape", land, MOSS).receiver_only(),
            solid("at sign", sign, CLAY),
        ],
    )
}

/// 2002 over pots and a floor (paper II, figure 11).
pub(super) fn year() -> Scene {
    use letters::{two, zero};
    let text = placed(
        word(&[two(), zero(), zero(), two()], 0.8),
        0.85,
        -0.45,
        DVec3::new(0.0, 1.7, 0.2),
    );
    let mut objects = vec![floor(7.0), solid("2002", text, CLAY)];
    let places = [[-1.5, -0.2], [-0.5, -0.6], [0.6, -0.4], [1.6, -0.3]];
    for (k, [x, z]) in places.into_iter().enumerate() {
        let turned = 0.7 + 1.9 * k as f64;
        objects.extend(pot(
            &format!("pot {}", k + 1),
            DVec3::new(x, 0.0, z),
            turned,
        ));
    }
    Scene::new(
        Camera::look_at([-0.4, 2.6, 4.9], [0.0, 0.7, -0.2]),
        lamp(DVec3::new(-0.6, 5.4, 2.3), 0.3),
        objects,
    )
}
