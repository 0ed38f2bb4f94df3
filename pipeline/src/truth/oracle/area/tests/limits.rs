//! Planes, edges, self-shadowing, nothing and everything.

use super::*;

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
    assert!((found - 0.7).abs() < 1e-11, "{found}");
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

/// The lamp's own mesh, in the plane of the light to rounding, hides nothing; a
/// sheet a billionth in front of it hides all.
#[test]
fn a_lamp_does_not_hide_its_light() {
    let mut rng = Lcg(77);
    for _ in 0..40 {
        let centre = rng.point(1.0, 3.0, 5.0);
        let [edge_u, edge_v] = [0; 2].map(|_| rng.point(1.0, -0.9, 0.9));
        let light = LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        };
        let at_corner = |s: f64, t: f64| centre + edge_u * s + edge_v * t;
        let [a, b] = [at_corner(-0.7, -0.6), at_corner(0.6, -0.55)];
        let [c, d] = [at_corner(0.5, 0.7), at_corner(-0.6, 0.6)];
        let lamp = [[a, b, c], [a, c, d]];
        let fine = lamp.iter().flat_map(quarters).flat_map(|t| quarters(&t));
        let fine: Vec<Triangle> = fine.collect();
        for _ in 0..10 {
            let p = rng.point(2.0, -0.5, 0.5);
            assert_eq!(at(&lamp, &light, p), 1.0);
            assert_eq!(at(&fine, &light, p), 1.0);
            let nearer = |t: &Triangle| t.map(|v| v + (p - v) * 1e-9);
            let front: Vec<Triangle> = fine.iter().map(nearer).collect();
            assert!(at(&front, &light, p) < 1e-12);
        }
    }
}
