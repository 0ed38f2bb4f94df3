//! What must not matter: order, splitting, duplicates.

use super::*;

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
            .flat_map(quarters)
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
