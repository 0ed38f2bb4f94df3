//! Whole images.

use super::*;

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
    let crate::world::light::HardLight::Point(centre) = scene.lights[0].hard() else {
        panic!("a point");
    };
    scene.lights[0].shape = square_light(centre, 1e-6);
    let soft = VisibilityImage::of_scene(&scene, 0, [96, 64], &|| {}).unwrap();
    scene.lights[0].shape = LightShape::Point { position: centre };
    let hard = VisibilityImage::of_scene(&scene, 0, [96, 64], &|| {}).unwrap();
    let oracle = crate::truth::oracle::hard::HardOracle::new(&scene, scene.lights[0].hard());
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

/// Every built-in scene: visibility is a number in 0..=1 wherever a surface is
/// seen, the light's centre is hidden in the umbra and seen in full light. The
/// second opinion counts blockers along one ray, by other rules for the surface
/// itself.
#[test]
fn umbra_and_light_agree_with_hard_shadows_in_every_scene() {
    for entry in builtin::SCENES {
        let scene = entry.build();
        let (width, height) = (48, 36);
        let image = VisibilityImage::of_scene(&scene, 0, [width, height], &|| {}).unwrap();
        let hard = crate::truth::oracle::hard::HardTruth::of_scene(
            &scene,
            0,
            [width, height],
            crate::truth::oracle::hard::EdgeTolerance::HALF_PIXEL,
        );
        let (mut checked, mut off) = (0, 0);
        for (value, pixel) in image.values.iter().zip(&hard.pixels) {
            assert_eq!(value.is_nan(), pixel.centre.hit.is_none(), "{}", entry.name);
            assert!(value.is_nan() || (0.0..=1.0).contains(value));
            let hidden = pixel.centre.shadow_count > 0;
            let expected = match LightRegion::of(*value) {
                Some(LightRegion::Umbra) => true,
                Some(LightRegion::Lit) => false,
                _ => continue,
            };
            checked += 1;
            off += u32::from(hidden != expected);
        }
        println!("{}: {off} of {checked}", entry.name);
        assert!(
            checked > 300 && off == 0,
            "{}: {off} of {checked}",
            entry.name
        );
    }
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
