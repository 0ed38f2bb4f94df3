//! Against closed forms and brute force.

use super::*;

/// The scene of the closed form with the floor at another distance.
fn plates_scene(floor_distance: f64) -> (ParallelPlates, Scene) {
    let form = ParallelPlates {
        floor_distance,
        ..builtin::PLATES
    };
    let plate = shape::bevelled_plate(
        form.plate_half,
        floor_distance - form.plate_distance,
        0.01,
        4.5,
    );
    let solid = |name, s: shape::Shape| {
        let mesh = s.into_mesh(crate::world::mesh::Shading::Flat).unwrap();
        Object::new(name, mesh, crate::world::scene::Material::matt([0.5; 3]))
    };
    let floor = solid("floor", shape::plane(4.0, 0.0)).receiver_only();
    let light = Light::horizontal_square(DVec3::Y * floor_distance, 2.0 * form.light_half);
    let camera = Camera {
        fov_y_degrees: 60.0,
        ..Camera::look_at([0.8, 0.7, 1.0], [0.0, 0.0, -0.1])
    };
    (
        form,
        Scene::new(camera, vec![light], vec![floor, solid("plate", plate)]),
    )
}

/// docs/papers.md, scenes PP, at every pixel that shows the floor. The mesh holds the
/// plate's half side in f32; the form is asked with that number.
#[test]
fn parallel_plates_equal_the_closed_form() {
    for distance in [3.0, 4.9, 5.1, 8.0] {
        let (mut form, scene) = plates_scene(distance);
        let corner = scene.objects[1].mesh.corners(0)[0];
        form.plate_half = corner.x.abs();
        form.plate_distance = distance - corner.y;
        let (surfaces, oracle) = AreaOracle::of_scene(&scene, 0).unwrap();
        let rays = scene.camera.eye_rays(160, 120);
        let (mut worst, mut counts) = (0.0f64, [0; 3]);
        for i in 0..160 * 120 {
            let (x, y) = (f64::from(i % 160) + 0.5, f64::from(i / 160) + 0.5);
            let floor = surfaces.hit(&rays, x, y).is_some_and(|h| h.object == 0);
            let Some(receiver) = surfaces.receiver(&rays, x, y).filter(|_| floor) else {
                continue;
            };
            let p = receiver.point;
            let exact = form.visibility(p.x, p.z);
            let found = oracle.visibility(&receiver);
            worst = worst.max((exact - found).abs());
            counts[LightRegion::of(exact).unwrap() as usize] += 1;
        }
        println!("d={distance}: worst {worst:e} over {counts:?} umbra, penumbra, lit");
        assert!(worst < 1e-9, "d={distance}: {worst:e}");
        assert!(counts[1] > 800 && counts[2] > 200, "{counts:?}");
        assert_eq!(
            counts[0] > 0,
            distance < 5.0,
            "the umbra ends at 5: {counts:?}"
        );
    }
}

/// A half-plane over a disc leaves a circular segment.
#[test]
fn a_straight_edge_over_a_disc_leaves_a_segment() {
    let light = LightShape::Disc {
        centre: DVec3::Y * 4.0,
        normal: DVec3::Y,
        radius: 0.5,
    };
    let edge = plate([-50.0, -50.0], [0.0, 50.0], 2.0);
    let segment = |d: f64| libm::acos(d) - d * (1.0 - d * d).sqrt(); // right of d, unit disc
    let mut worst = 0.0f64;
    for k in -60..=60 {
        let x = 0.01 * f64::from(k);
        // The edge, seen from (x, 0), cuts the light's plane at 2 * 0 - x.
        let cut = (-x / 0.5).clamp(-1.0, 1.0);
        let expected = segment(cut) / std::f64::consts::PI;
        worst = worst.max((at(&edge, &light, DVec3::new(x, 0.0, 0.3)) - expected).abs());
    }
    assert!(worst < 1e-13, "{worst:e}");
}

/// An occluding disc (4096-gon) over a disc light: two circles' common area.
#[test]
fn a_disc_over_a_disc_leaves_a_lens() {
    const N: u32 = 4096;
    let light = LightShape::Disc {
        centre: DVec3::Y * 4.0,
        normal: DVec3::Y,
        radius: 0.5,
    };
    // Outline of the same area as the circle.
    let step = std::f64::consts::TAU / f64::from(N);
    let radius = 0.2 * (step / libm::sin(step)).sqrt();
    let rim = |k: u32| {
        let (x, z) = on_circle(f64::from(k % N) * step);
        DVec3::new(radius * x, 2.0, radius * z)
    };
    let disc: Vec<Triangle> = (0..N)
        .map(|k| [DVec3::Y * 2.0, rim(k), rim(k + 1)])
        .collect();
    for x in [0.0, 0.05, 0.1, 0.3, 0.45, 0.89, 0.91] {
        // From (x, 0), the occluder lands on the light at -x, twice as large.
        let hidden = lens(0.5, 0.4, x) / (std::f64::consts::PI * 0.25);
        let found = at(&disc, &light, DVec3::new(x, 0.0, 0.0));
        assert!(
            (found - (1.0 - hidden)).abs() < 2e-6,
            "{x}: {found} {hidden}"
        );
    }
}

/// Common area of circles of radius `a` and `b` at distance `d`.
fn lens(a: f64, b: f64, d: f64) -> f64 {
    if d >= a + b {
        return 0.0;
    }
    if d <= (a - b).abs() {
        return std::f64::consts::PI * a.min(b) * a.min(b);
    }
    let [u, v] = [
        (d * d + a * a - b * b) / (2.0 * d),
        (d * d + b * b - a * a) / (2.0 * d),
    ];
    let cap = |r: f64, h: f64| r * r * libm::acos(h / r) - h * (r * r - h * h).sqrt();
    cap(a, u) + cap(b, v)
}

/// A straight edge before a sphere, against the angle at which it cuts the
/// cone; with the radius of the sphere itself instead, the result is far off.
#[test]
fn a_sphere_is_larger_than_a_disc_of_its_radius() {
    let light = LightShape::Sphere {
        centre: DVec3::Y * 2.0,
        radius: 1.0,
    };
    let edge = plate([-90.0, -90.0], [0.3, 90.0], 0.5);
    // Seen radius on the plane through the centre, and where the edge cuts it.
    let seen = 1.0 / (1.0f64 - 0.25).sqrt();
    let segment = |d: f64| libm::acos(d) - d * (1.0 - d * d).sqrt();
    let expected = |radius: f64| segment(0.3 * 4.0 / radius) / std::f64::consts::PI;
    let edge_clear = [edge[0], edge[1]];
    let found = at(&edge_clear, &light, DVec3::new(0.0, 0.0, 0.0));
    let share = if 1.2 < seen { expected(seen) } else { 0.0 };
    assert!((found - share).abs() < 1e-12, "{found} {share}");
    let nearer = plate([-90.0, -90.0], [0.1, 90.0], 0.5);
    let found = at(&nearer, &light, DVec3::ZERO);
    let of = |radius: f64| segment(0.4 / radius) / std::f64::consts::PI;
    assert!((found - of(seen)).abs() < 1e-12, "{found} {}", of(seen));
    assert!((found - of(1.0)).abs() > 0.02, "negative control");
}

/// A square plate under a hexagon, against cells of the light by brute force.
#[test]
fn a_polygon_light_agrees_with_counting_cells() {
    let light = hexagon(0.6, 4.0);
    let blocker = plate([-0.1, -0.4], [0.5, 0.2], 1.7);
    let p = DVec3::new(-0.2, 0.0, 0.13);
    let (mut seen, mut all) = (0u32, 0u32);
    let n = 1500;
    let cell = |k: i32| (f64::from(k) + 0.5) / f64::from(n) * 1.2 - 0.6;
    for (i, k) in (0..n).flat_map(|i| (0..n).map(move |k| (i, k))) {
        let (x, z) = (cell(i), cell(k));
        let root3 = 3.0f64.sqrt();
        if z.abs() > 0.3 * root3 || root3 * x.abs() + z.abs() > 0.6 * root3 {
            continue;
        }
        all += 1;
        let on_plate = p + (DVec3::new(x, 4.0, z) - p) * (1.7 / 4.0);
        let hit = (-0.1..0.5).contains(&on_plate.x) && (-0.4..0.2).contains(&on_plate.z);
        seen += u32::from(!hit);
    }
    let counted = f64::from(seen) / f64::from(all);
    let exact = at(&blocker, &light, p);
    assert!(
        (0.1..0.9).contains(&exact) && (exact - counted).abs() < 3e-4,
        "{exact} {counted}"
    );
}
