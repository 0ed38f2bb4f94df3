//! Deferred shadowing under coloured environments: how much of the light arrives is
//! asked of its luminance.

use glam::DVec3;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::world::environment::{Environment, MapSettings};
use gnomon_pipeline::world::scene::{Camera, Scene};
use gnomon_pipeline::world::shape;

use crate::deferred_shadowing::{SIZE, flat, lit_by, shown, two_over_a_floor};

/// Columns and rows of the maps.
const MAP: [usize; 2] = [64, 32];

/// A map with light from -x and from +x, 10 to 45 degrees up, each of a colour. The
/// middle column is -z.
fn from_two_sides([left, right]: [[f32; 3]; 2]) -> Environment {
    let [width, height] = MAP;
    let mut texels = vec![[0.0; 3]; width * height];
    for row in height / 4..height / 2 - 2 {
        for column in 0..4 {
            texels[row * width + width / 4 - 2 + column] = left;
            texels[row * width + 3 * width / 4 - 2 + column] = right;
        }
    }
    let settings = MapSettings {
        side: 16,
        ..MapSettings::default()
    };
    Environment::of_radiance("two sides", MAP, texels, settings).unwrap()
}

/// A floor, and on it a wall along z through the middle.
fn wall_on_a_floor() -> Scene {
    let wall = shape::cuboid(DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.1, 4.0, 12.0));
    Scene::new(
        Camera::look_at([0.0, 9.0, 5.0], [0.0, 0.0, 0.0]),
        Vec::new(),
        vec![
            flat("floor", shape::plane(4.0, 0.0)).receiver_only(),
            flat("wall", wall),
        ],
    )
}

/// Mean visibility of the floor near the wall, on its left and on its right.
fn beside_the_wall(scene: &Scene, done: &Rendered) -> [f64; 2] {
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    let [_, _, forward] = scene.camera.basis();
    let mut sums = [[0.0; 2]; 2];
    for (i, visible) in done.visibility.iter().enumerate() {
        let at = [i as u32 % SIZE[0], i as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
        let direction = rays.direction(at[0], at[1]);
        let p = rays.origin - direction * (rays.origin.y / direction.y);
        let depth = 1.0 - scene.camera.near / (p - rays.origin).dot(forward);
        let seen = (f64::from(done.depth[i]) - depth).abs() < 1e-5;
        if seen && (0.4..1.2).contains(&p.x.abs()) && p.z.abs() < 2.0 {
            let sum = &mut sums[usize::from(p.x > 0.0)];
            *sum = [sum[0] + f64::from(*visible), sum[1] + 1.0];
        }
    }
    sums.map(|[sum, count]| {
        assert!(count > 30.0, "{count}");
        sum / count
    })
}

/// Where a wall hides all blue light, as much is left as red has of both luminances, and
/// the other way round.
#[test]
fn what_is_hidden_weighs_as_much_as_its_luminance() {
    let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let of = |colors| {
        let scene = lit_by(wall_on_a_floor(), &from_two_sides(colors));
        beside_the_wall(&scene, &shown(&scene, &["format=f32"]))
    };
    let share = 0.2126 / (0.2126 + 0.0722);
    for (colors, expected) in [
        ([blue, red], [1.0 - share, share]),
        ([red, blue], [share, 1.0 - share]),
        ([red, red], [0.5; 2]),
    ] {
        let found = of(colors);
        for side in 0..2 {
            let off = (found[side] - expected[side]).abs();
            assert!(off < 0.05, "{colors:?}: {found:?}, not {expected:?}");
        }
    }
}

/// Light of one colour hides and shows what white light does, also in a colour of which
/// luminance has little.
#[test]
fn one_color_of_light_is_as_visible_as_another() {
    let of = |color: [f32; 3]| {
        let map = from_two_sides([color; 2]);
        shown(&lit_by(two_over_a_floor(), &map), &["format=f32"]).visibility
    };
    let white = of([1.0; 3]);
    let shadowed = white.iter().filter(|v| **v < 0.6).count();
    let lit = white.iter().filter(|v| **v > 0.9).count();
    assert!(shadowed > 50 && lit > 1000, "{shadowed} {lit}");
    for color in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        let pairs = of(color).into_iter().zip(&white);
        let seen = pairs.filter(|(_, white)| !white.is_nan());
        let worst = seen.map(|(v, white)| (v - white).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-3, "{color:?}: {worst}");
    }
}
