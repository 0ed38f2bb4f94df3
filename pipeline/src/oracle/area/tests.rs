//! The exact oracle against closed forms, against itself, and at its limits.

use super::*;
use crate::light::{ConvexPolygon, Light};
use crate::oracle::plates::ParallelPlates;
use crate::scene::{Camera, Object, builtin};
use crate::shape::{self, on_circle};

type Triangle = [DVec3; 3];

fn square_light(centre: DVec3, side: f64) -> LightShape {
    Light::horizontal_square(centre, side).shape
}

fn polygon(points: &[[f64; 2]], y: f64) -> LightShape {
    let lift = |p: &[f64; 2]| DVec3::new(p[0], y, p[1]);
    let vertices: Vec<_> = points.iter().map(lift).collect();
    LightShape::Polygon(ConvexPolygon::new(vertices).unwrap())
}

fn hexagon(radius: f64, y: f64) -> LightShape {
    let corner = |k: u32| on_circle(f64::from(k) * std::f64::consts::TAU / 6.0);
    let points: Vec<_> = (0..6)
        .map(corner)
        .map(|(x, z)| [radius * x, radius * z])
        .collect();
    polygon(&points, y)
}

/// A horizontal rectangle as two triangles.
fn plate(low: [f64; 2], high: [f64; 2], y: f64) -> Vec<Triangle> {
    let at = |x: f64, z: f64| DVec3::new(x, y, z);
    let [a, b] = [at(low[0], low[1]), at(high[0], low[1])];
    let [c, d] = [at(high[0], high[1]), at(low[0], high[1])];
    vec![[a, b, c], [a, c, d]]
}

/// Every light shape about (0, 4, 0).
fn lights() -> Vec<(&'static str, LightShape)> {
    let centre = DVec3::Y * 4.0;
    vec![
        ("square", square_light(centre, 1.0)),
        (
            "skew rectangle",
            LightShape::Rectangle {
                centre,
                edge_u: DVec3::new(1.0, 0.2, 0.1),
                edge_v: DVec3::new(-0.3, 0.1, 0.8),
            },
        ),
        ("hexagon", hexagon(0.6, 4.0)),
        (
            "disc",
            LightShape::Disc {
                centre,
                normal: DVec3::new(0.1, -1.0, 0.3).normalize(),
                radius: 0.5,
            },
        ),
        (
            "sphere",
            LightShape::Sphere {
                centre,
                radius: 0.5,
            },
        ),
        ("point", LightShape::Point { position: centre }),
        (
            "direction",
            LightShape::Directional {
                towards: DVec3::new(0.2, 1.0, 0.1),
            },
        ),
    ]
}

/// Pseudo-random numbers in 0..1.
struct Lcg(u64);

impl Lcg {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn point(&mut self, reach: f64, low: f64, high: f64) -> DVec3 {
        let [x, z] = [0; 2].map(|_| self.within(-reach, reach));
        DVec3::new(x, self.within(low, high), z)
    }

    /// Triangles between floor and light, of all sizes.
    fn triangles(&mut self, count: usize) -> Vec<Triangle> {
        let mut one = |_| {
            let (centre, size) = (self.point(1.2, 0.6, 3.4), self.within(0.05, 0.9));
            [0; 3].map(|_| centre + self.point(1.0, -1.0, 1.0) * size)
        };
        (0..count).map(&mut one).collect()
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, (self.next() * (i + 1) as f64) as usize);
        }
    }
}

fn at(triangles: &[Triangle], light: &LightShape, p: DVec3) -> f64 {
    let oracle = AreaOracle::of_triangles(triangles, light).unwrap();
    oracle.visibility(&Receiver::free(p))
}

// --- closed forms ---

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
        let mesh = s.into_mesh(crate::mesh::Shading::Flat).unwrap();
        Object::new(name, mesh, crate::scene::Material::matt([0.5; 3]))
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

/// IMPLEMENTING §5 PP, at every pixel that shows the floor. The mesh holds the
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

// --- invariances ---

#[test]
fn the_order_of_triangles_does_not_matter() {
    let mut rng = Lcg(7);
    let (mut worst, mut partial) = (0.0f64, 0);
    for _ in 0..12 {
        let triangles = rng.triangles(30);
        for (_, light) in lights() {
            let p = rng.point(1.0, -0.2, 0.2);
            let first = at(&triangles, &light, p);
            partial += u32::from(first > 0.0 && first < 1.0);
            let mut shuffled = triangles.clone();
            for _ in 0..4 {
                rng.shuffle(&mut shuffled);
                shuffled.iter_mut().for_each(|t| t.rotate_left(1));
                worst = worst.max((at(&shuffled, &light, p) - first).abs());
            }
        }
    }
    println!("permuted: worst {worst:e}, {partial} partial");
    assert!(worst < 1e-12 && partial > 30, "{worst:e} {partial}");
}

/// Cutting every triangle into four, and flipping some, changes nothing.
#[test]
fn splitting_triangles_does_not_matter() {
    let mut rng = Lcg(99);
    let mut worst = 0.0f64;
    for _ in 0..10 {
        let triangles = rng.triangles(12);
        let finer: Vec<Triangle> = triangles
            .iter()
            .flat_map(|t| quarters(t))
            .flat_map(|t| quarters(&t))
            .collect();
        for (_, light) in lights() {
            let p = rng.point(1.0, -0.2, 0.2);
            worst = worst.max((at(&finer, &light, p) - at(&triangles, &light, p)).abs());
        }
    }
    println!("split: worst {worst:e}");
    assert!(worst < 1e-12, "{worst:e}");
}

fn quarters(&[a, b, c]: &Triangle) -> [Triangle; 4] {
    let [p, q, r] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
    [[a, p, r], [p, b, q], [r, q, c], [q, p, r]] // the last one turned
}

#[test]
fn degenerate_duplicate_and_coplanar_triangles_add_nothing() {
    let mut rng = Lcg(3);
    for _ in 0..6 {
        let triangles = rng.triangles(10);
        let mut more = triangles.clone();
        more.extend(triangles.iter().map(|&[a, b, c]| [c, b, a])); // duplicates, turned
        more.extend(triangles.iter().map(|&[a, b, _]| [a, b, a])); // needles
        more.extend(
            triangles
                .iter()
                .map(|&[a, b, _]| [a, b, a + (b - a) * 0.37]),
        );
        more.extend(triangles.iter().map(|&[a, ..]| [a; 3])); // dots
        more.extend(
            triangles
                .iter()
                .map(|&[a, b, c]| [a, (a + b) / 2.0, (a + c) / 2.0]),
        ); // coplanar parts
        for (name, light) in lights() {
            let p = rng.point(1.0, -0.2, 0.2);
            let [plain, doubled] = [&triangles, &more].map(|t| at(t, &light, p));
            assert!((plain - doubled).abs() < 1e-12, "{name}: {plain} {doubled}");
        }
    }
}

#[test]
fn a_convex_polygon_light_is_the_sum_of_its_parts() {
    let mut rng = Lcg(21);
    let whole = polygon(&[[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]], 4.0);
    let left = polygon(&[[-0.5, -0.5], [0.1, -0.5], [-0.2, 0.5], [-0.5, 0.5]], 4.0);
    let right = polygon(&[[0.1, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.2, 0.5]], 4.0);
    let triangles = rng.triangles(15);
    for _ in 0..30 {
        let p = rng.point(1.5, -0.2, 0.2);
        let sum = 0.45 * at(&triangles, &left, p) + 0.55 * at(&triangles, &right, p);
        assert!((at(&triangles, &whole, p) - sum).abs() < 1e-12);
        let square = at(&triangles, &square_light(DVec3::Y * 4.0, 1.0), p);
        assert!((at(&triangles, &whole, p) - square).abs() < 1e-12);
    }
}

// --- limits ---

/// What is behind the receiver or behind the light hides nothing; a triangle
/// through either plane hides what its part in between hides.
#[test]
fn only_what_is_between_counts() {
    let light = square_light(DVec3::Y * 4.0, 1.0);
    let p = DVec3::ZERO;
    assert_eq!(
        at(&plate([-9.0; 2], [9.0; 2], 4.5), &light, p),
        1.0,
        "behind the light"
    );
    assert_eq!(
        at(&plate([-9.0; 2], [9.0; 2], -0.5), &light, p),
        1.0,
        "behind the receiver"
    );
    assert_eq!(at(&plate([-9.0; 2], [9.0; 2], 3.9), &light, p), 0.0);
    // A vertical wall through the light's plane at x = 0.1, seen from the left.
    let wall = |low: f64, high: f64| {
        let at = |y: f64, z: f64| DVec3::new(0.1, y, z);
        [
            [at(low, -9.0), at(low, 9.0), at(high, 9.0)],
            [at(low, -9.0), at(high, 9.0), at(high, -9.0)],
        ]
    };
    let left = DVec3::new(-2.0, 0.0, 0.0);
    assert!((at(&wall(-8.0, 8.0), &light, left) - 0.6).abs() < 1e-13);
    assert!((at(&wall(3.9, 8.0), &light, left) - at(&wall(3.9, 4.0), &light, left)).abs() < 1e-13);
    // A wall ending below: shadow of its top edge y = 2 falls at x = 2.2 only.
    assert_eq!(at(&wall(-8.0, 2.0), &light, left), 1.0);
}

/// A sheet that slants through the light hides the part beyond the line where
/// they meet.
#[test]
fn a_light_that_meets_geometry_is_cut_where_they_meet() {
    let light = square_light(DVec3::Y * 4.0, 1.0);
    let at_height = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    // Through (0.2, 4, z), rising to the left: nearer to p on the right.
    let slant = [
        [
            at_height(-8.8, 8.5, -50.0),
            at_height(9.2, -0.5, -50.0),
            at_height(9.2, -0.5, 50.0),
        ],
        [
            at_height(-8.8, 8.5, -50.0),
            at_height(9.2, -0.5, 50.0),
            at_height(-8.8, 8.5, 50.0),
        ],
    ];
    let found = at(&slant, &light, DVec3::new(0.0, 0.0, 0.0));
    assert!((found - 0.7).abs() < 1e-13, "{found}");
}

/// Visibility is continuous across the plane through the light's edge and an
/// occluder's edge, across an occluder's own plane, and where the receiver is
/// in line with an edge: one ulp either way is worth nothing.
#[test]
fn an_ulp_is_worth_nothing() {
    let mut rng = Lcg(1234);
    let blocker = plate([-0.3, -0.4], [0.25, 0.5], 2.0);
    let light = square_light(DVec3::Y * 4.0, 1.0);
    // In the planes (light centre, blocker edge), (light edge, blocker edge).
    for x in [-0.6, 0.5, 0.0, 1.0, -0.1, -1.1] {
        let around = |d: f64| at(&blocker, &light, DVec3::new(x + d, 0.0, 0.07));
        for ulps in [-2.0, -1.0, 1.0, 2.0] {
            let step = ulps * f64::EPSILON * x.abs().max(0.5);
            assert!(
                (around(step) - around(0.0)).abs() < 1e-13,
                "x={x} {ulps} ulp"
            );
        }
    }
    // In the plane of a triangle, or on the line of its edge: it is edge-on.
    for _ in 0..200 {
        let [a, b, c] = rng.triangles(1)[0];
        let light = &lights()[(rng.next() * 5.0) as usize].1;
        for p in [a + (a - b) * 1.3 + (a - c) * 0.4, a + (a - b) * 0.9] {
            for step in [-1e-15, 0.0, 1e-15] {
                let seen = at(&[[a, b, c]], light, p + DVec3::Y * step);
                assert!(seen > 1.0 - 1e-9, "{seen}");
            }
        }
    }
}

/// A receiver on a caster sees nothing behind its facet and is not shadowed by
/// it, by its neighbours in one plane or by a duplicate.
#[test]
fn surfaces_do_not_shadow_themselves() {
    let square = plate([-2.0; 2], [2.0; 2], 0.0);
    let fine: Vec<Triangle> = square
        .iter()
        .flat_map(quarters)
        .flat_map(|t| quarters(&t))
        .collect();
    let mut rng = Lcg(5);
    for (name, light) in lights() {
        let oracle = AreaOracle::of_triangles(&fine, &light).unwrap();
        for (own, corners) in fine.iter().enumerate() {
            let [a, b, c] = *corners;
            // The inside, a corner, an edge, and just beyond them by rounding.
            for p in [
                (a + b + c) / 3.0,
                a,
                (b + c) / 2.0,
                a + (b - a) * rng.next(),
            ] {
                let jitter = DVec3::new(rng.within(-1e-15, 1e-15), 0.0, 0.0);
                let facing = |direction: DVec3| {
                    let receiver = Receiver::on_facet(corners, p + jitter, direction);
                    oracle.visibility(&receiver.with_caster(Some(own as u32)))
                };
                assert_eq!(facing(DVec3::NEG_Y), 1.0, "{name}: from above");
                assert_eq!(facing(DVec3::Y), 0.0, "{name}: from below");
            }
        }
    }
}

/// The horizon of a tilted facet cuts the light: exactly, and as its neighbours
/// on a closed solid would.
#[test]
fn a_facet_cuts_the_light_at_its_horizon() {
    let facet = [
        DVec3::ZERO,
        DVec3::new(0.0, 2.0, 1.0),
        DVec3::new(1.0, 0.0, 0.0),
    ];
    // Plane z = y / 2: at y = 4 the horizon is z = 2; light about (0, 4, 2.1).
    let light = square_light(DVec3::new(0.0, 4.0, 2.1), 1.0);
    let receiver = Receiver::on_facet(&facet, DVec3::new(0.1, 0.2, 0.1), DVec3::NEG_Z);
    let oracle = AreaOracle::of_triangles(&[facet], &light).unwrap();
    let found = oracle.visibility(&receiver.with_caster(Some(0)));
    assert!((found - 0.6).abs() < 1e-11, "{found}");
    // Sheets that cast nothing let light through.
    let none = AreaOracle::of_triangles(&[], &light).unwrap();
    assert_eq!(none.visibility(&receiver), 1.0);
}

#[test]
fn nothing_and_everything() {
    for (name, light) in lights() {
        assert_eq!(at(&[], &light, DVec3::ZERO), 1.0, "{name}");
        let roof = plate([-9.0; 2], [9.0; 2], 2.0);
        assert_eq!(at(&roof, &light, DVec3::new(0.1, 0.0, 0.3)), 0.0, "{name}");
        let fine: Vec<Triangle> = roof
            .iter()
            .flat_map(quarters)
            .flat_map(|t| quarters(&t))
            .collect();
        let fine: Vec<Triangle> = fine
            .iter()
            .flat_map(quarters)
            .flat_map(|t| quarters(&t))
            .collect();
        let dust = at(&fine, &light, DVec3::new(0.1, 0.0, 0.3));
        assert!(dust < 1e-14, "{name}: {dust:e}");
    }
    let bulb = LightShape::Sphere {
        centre: DVec3::ZERO,
        radius: 1.0,
    };
    assert_eq!(
        at(&plate([-9.0; 2], [9.0; 2], 0.2), &bulb, DVec3::Y * 0.1),
        1.0,
        "inside"
    );
}

/// In the plane of a flat light its area is still seen along that plane.
#[test]
fn receivers_in_the_lights_plane_see_along_it() {
    let light = square_light(DVec3::ZERO, 1.0);
    let p = DVec3::new(-2.5, 0.0, 0.0);
    assert_eq!(at(&[], &light, p), 1.0);
    // A post from below to above hides the wedge behind z in 0..0.1 at x = -1.5.
    let post = [
        DVec3::new(-1.5, -9.0, 0.05),
        DVec3::new(-1.5, 9.0, 0.1),
        DVec3::new(-1.5, 9.0, 0.0),
    ];
    let found = at(&[post], &light, p);
    // At y = 0 the post spans z 0.025..0.075; on the light (x + 2.5) times that.
    let hidden = 0.05 * (3.0 * 3.0 - 2.0 * 2.0) / 2.0;
    assert!((found - (1.0 - hidden)).abs() < 1e-12, "{found}");
}

// --- images ---

#[test]
fn images_do_not_depend_on_threads_and_call_back_once_a_row() {
    let scene = builtin::build("peer-a").unwrap();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let rows = std::sync::atomic::AtomicU32::new(0);
        let done = || {
            rows.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        };
        let image = pool
            .install(|| VisibilityImage::of_scene(&scene, 0, [48, 30], &done))
            .unwrap();
        assert_eq!(rows.into_inner(), 30);
        image
    };
    let image = on(1);
    assert!(image == on(3));
    let regions = image.regions();
    let count = |r| regions.iter().filter(|x| **x == r).count();
    assert!(
        LightRegion::ALL.iter().all(|r| count(Some(*r)) > 20),
        "all regions are seen"
    );
    assert_eq!(
        count(None),
        image.values.iter().filter(|v| v.is_nan()).count()
    );
}

/// The hard shadow of the light's centre is inside umbra and penumbra, and a
/// tiny light's exact shadow is the hard one but for its rim.
#[test]
fn a_tiny_light_casts_the_hard_shadow() {
    let mut scene = builtin::build("columns").unwrap();
    let crate::light::HardLight::Point(centre) = scene.lights[0].hard() else {
        panic!("a point");
    };
    scene.lights[0].shape = square_light(centre, 1e-6);
    let soft = VisibilityImage::of_scene(&scene, 0, [96, 64], &|| {}).unwrap();
    scene.lights[0].shape = LightShape::Point { position: centre };
    let hard = VisibilityImage::of_scene(&scene, 0, [96, 64], &|| {}).unwrap();
    let oracle = crate::oracle::hard::HardOracle::new(&scene, scene.lights[0].hard());
    let rays = scene.camera.eye_rays(96, 64);
    let (mut partial, mut shadowed) = (0, 0);
    for (i, (s, h)) in soft.values.iter().zip(&hard.values).enumerate() {
        let (x, y) = (i as f64 % 96.0, (i / 96) as f64);
        let sample = oracle.sample(&rays, x.floor() + 0.5, y + 0.5);
        assert_eq!(h.is_nan(), sample.hit.is_none());
        if *s > 0.0 && *s < 1.0 {
            partial += 1;
        } else if !h.is_nan() {
            assert_eq!(s, h, "pixel {i}");
            assert_eq!(*h == 0.0, sample.shadow_count > 0, "pixel {i}");
            shadowed += u32::from(*h == 0.0);
        }
    }
    assert!(partial < 8 && shadowed > 500, "{partial} {shadowed}");
}

/// Times of exact images; run with `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn time_of_the_peers_scenes() {
    for name in ["peer-a", "peer-b", "peer-c"] {
        let scene = builtin::build(name).unwrap();
        let start = std::time::Instant::now();
        let (surfaces, oracle) = AreaOracle::of_scene(&scene, 0).unwrap();
        let built = start.elapsed();
        let image = VisibilityImage::of_scene(&scene, 0, [256; 2], &|| {}).unwrap();
        let total = start.elapsed();
        let rays = scene.camera.eye_rays(256, 256);
        let (mut work, mut most) = (Workspace::default(), [0u32; 2]);
        for i in (0..256 * 256u32).step_by(7) {
            let (x, y) = (f64::from(i % 256) + 0.5, f64::from(i / 256) + 0.5);
            let Some(r) = surfaces.receiver(&rays, x, y) else {
                continue;
            };
            let v = oracle.visibility_with(&r, &mut work);
            most = [most[0].max(v.triangles), most[1].max(v.fragments)];
        }
        let count = |r| image.regions().iter().filter(|x| **x == Some(r)).count();
        println!(
            "{name}: built {built:.2?}, built twice and image {total:.2?}; umbra, penumbra, lit {:?}; most triangles, fragments {most:?}",
            LightRegion::ALL.map(count)
        );
    }
}
