//! Techniques against the truth, end to end, where the errors are known beforehand.

use glam::DVec3;
use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind, Score, shaded};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use gnomon_pipeline::truth::oracle::area::LightRegion;
use gnomon_pipeline::world::light::{ConvexPolygon, LightShape};
use gnomon_pipeline::world::scene::Scene;
use gnomon_pipeline::world::scene::builtin::{self, PLATES};

const SIZE: [u32; 2] = [160, 120];

/// A scene with the truth about its first light.
struct Bench {
    scene: Scene,
    truth: Reference,
    settings: RenderSettings,
}

impl Bench {
    fn new(scene: Scene) -> Self {
        let truth = Reference::new(&scene, 0, SIZE, ReferenceKind::Exact, None, &|| {});
        Self {
            truth: truth.unwrap(),
            scene,
            settings: RenderSettings {
                size: SIZE,
                ..RenderSettings::default()
            },
        }
    }

    fn plates() -> Self {
        Self::new(builtin::build("parallel-plates").unwrap())
    }

    fn measure(&self, technique: &str, given: &[&str]) -> (Rendered, Score) {
        let technique = find(technique).unwrap();
        let params = Params::parse(technique, given).unwrap();
        let done = render(&self.scene, technique, &params, &self.settings).unwrap();
        let under = self.truth.under(&done.depth).unwrap();
        let picture = shaded(&self.scene, &self.truth, &under, &params, &self.settings).unwrap();
        let score = Score::measure(&under, &done, &picture).unwrap();
        (done, score)
    }

    fn sampled(&self, samples: u32, pattern: &str) -> Score {
        let given = [format!("samples={samples}"), format!("pattern={pattern}")];
        let given = given.each_ref().map(String::as_str);
        self.measure("sampled-shadow-volumes", &given).1
    }
}

fn all(score: &Score) -> ErrorSummary {
    score.visibility.all.unwrap()
}

fn penumbra(score: &Score) -> ErrorSummary {
    score.visibility.of_region(LightRegion::Penumbra).unwrap()
}

/// Where each pixel's ray meets the floor, if the floor is what the picture
/// shows: from the camera and the depth buffer, without any oracle.
fn floor_points(scene: &Scene, done: &Rendered) -> Vec<Option<[f64; 2]>> {
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    let point = |i: usize| {
        let (x, y) = (i % SIZE[0] as usize, i / SIZE[0] as usize);
        let direction = rays.direction(x as f64 + 0.5, y as f64 + 0.5);
        let along = -rays.origin.y / direction.y;
        let depth = 1.0 - scene.camera.near / along;
        let is_floor = along > 0.0 && (f64::from(done.depth[i]) - depth).abs() < 1e-6;
        let at = rays.origin + direction * along;
        is_floor.then_some([at.x, at.z])
    };
    (0..done.depth.len()).map(point).collect()
}

/// On the plates, a hard shadow is the square under the plate, and the truth a
/// product of two ramps: their distance needs neither oracle nor rasteriser.
#[test]
fn a_hard_mask_has_the_rmse_of_the_closed_form() {
    let bench = Bench::plates();
    let (done, score) = bench.measure("shadow-volumes", &[]);
    let half = PLATES.plate_half * PLATES.floor_distance / PLATES.plate_distance;
    let (mut squares, mut signed, mut largest) = (0.0, 0.0, 0.0f64);
    let floor = floor_points(&bench.scene, &done);
    for [x, z] in floor.iter().flatten() {
        let hard = if x.abs() < half && z.abs() < half {
            0.0
        } else {
            1.0
        };
        let error = hard - PLATES.visibility(*x, *z);
        squares += error * error;
        signed += error;
        largest = largest.max(error.abs());
    }
    let pixels = done.depth.iter().filter(|d| **d < 1.0).count() as f64;
    let found = all(&score);
    println!(
        "closed form {}, measured {found:?}",
        (squares / pixels).sqrt()
    );
    assert!(floor.iter().flatten().count() > 15_000 && squares / pixels > 0.005);
    // The rasteriser may decide some pixels of the mask's edge otherwise.
    assert!((found.rmse / (squares / pixels).sqrt() - 1.0).abs() < 5e-3);
    assert!((found.mean - signed / pixels).abs() < 1e-3);
    assert!((found.max - largest).abs() < 0.03 && found.max > 0.4);
    let umbra = score.visibility.of_region(LightRegion::Umbra).unwrap();
    let lit = score.visibility.of_region(LightRegion::Lit).unwrap();
    assert_eq!((umbra.max, lit.max), (0.0, 0.0));
    let other = score.pixels.left_out.other_surface();
    assert!(other < 20, "{other}");
}

/// A grid of k by k points sees an edge along its rows in steps of 1/k, so it is
/// off by up to 1/2k, evenly spread, at one edge and up to 1/k at two
/// (docs/papers.md, baselines). Turned, its steps are k times finer.
#[test]
fn sampled_errors_fall_with_the_side_of_the_grid() {
    let bench = Bench::plates();
    let mut before: Option<f64> = None;
    for side in [4u32, 8, 16] {
        let k = f64::from(side);
        let score = bench.sampled(side * side, "grid");
        let found = penumbra(&score);
        println!("{side}: {found:?} {:?}", score.banding);
        assert!(found.max <= 1.0 / k + 1e-3 && found.max > 0.4 / k, "{side}");
        let uniform = 1.0 / (k * 12f64.sqrt());
        assert!(
            (0.7..1.5).contains(&(found.rmse / uniform)),
            "{side}: {found:?}"
        );
        if let Some(before) = before {
            assert!(
                (1.6..2.5).contains(&(before / found.rmse)),
                "{side}: {found:?}"
            );
        }
        before = Some(found.rmse);
        assert!(score.banding.levels <= (side * side + 1) as usize);
        assert!(score.banding.max > 0.8 / k, "{side}: {:?}", score.banding);
        let turned = bench.sampled(side * side, "rotated-grid");
        let jittered = bench.sampled(side * side, "stratified");
        println!(
            "{side}: turned {:?} jittered {:?}",
            penumbra(&turned),
            penumbra(&jittered)
        );
        assert!(penumbra(&turned).rmse < 0.5 * found.rmse, "{side}");
        assert!(turned.banding.p99 < score.banding.p99, "{side}");
        assert!(penumbra(&jittered).rmse < 0.8 * found.rmse, "{side}");
    }
}

/// What has no shadows is far worse than what has the wrong ones.
#[test]
fn negative_control_no_shadows_are_far_worse() {
    let bench = Bench::plates();
    let (_, none) = bench.measure("unshadowed", &[]);
    let (_, hard) = bench.measure("shadow-volumes", &[]);
    let soft = bench.sampled(64, "rotated-grid");
    assert!(all(&none).rmse > 1.5 * all(&hard).rmse && all(&none).max == 1.0);
    assert!(all(&hard).rmse > 10.0 * all(&soft).rmse);
    assert!(all(&none).mean > 10.0 * all(&hard).mean.abs());
    assert!(hard.flip > 3.0 * soft.flip && hard.ssim < soft.ssim);
    for (worse, better) in [(&none, &hard), (&hard, &soft)] {
        assert!(
            worse.psnr + 3.0 < better.psnr,
            "{} {}",
            worse.psnr,
            better.psnr
        );
    }
}

/// Samples fill every shape of light as the oracle understands it; a light of
/// another size is found out.
#[test]
fn every_shape_of_light_is_sampled_as_the_oracle_sees_it() {
    let scene = builtin::build("cylinder").unwrap();
    let centre = DVec3::new(1.4, 4.0, 1.1);
    let normal = DVec3::new(-0.2, -1.0, -0.1).normalize();
    let corner = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 5.0;
        centre + DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)) * 0.6
    };
    let pentagon = ConvexPolygon::new((0..5).map(corner).collect::<Vec<_>>()).unwrap();
    let shapes = |scale: f64| {
        let radius = 0.5 * scale;
        [
            LightShape::Rectangle {
                centre,
                edge_u: DVec3::new(0.9, 0.1, 0.2) * scale,
                edge_v: DVec3::new(-0.1, 0.0, 0.7) * scale,
            },
            LightShape::Disc {
                centre,
                normal,
                radius,
            },
            LightShape::Sphere { centre, radius },
        ]
    };
    let with = |shape: LightShape| {
        let mut changed = scene.clone();
        changed.lights[0].shape = shape;
        changed
    };
    for (right, wrong) in shapes(1.0).into_iter().zip(shapes(1.25)) {
        let bench = Bench::new(with(right.clone()));
        let near = penumbra(&bench.sampled(256, "rotated-grid")).rmse;
        let truth_of_another = Bench {
            scene: bench.scene.clone(),
            ..Bench::new(with(wrong))
        };
        let off = penumbra(&truth_of_another.sampled(256, "rotated-grid")).rmse;
        println!("{right:?}: {near} {off}");
        assert!(near < 0.012 && off > 3.0 * near, "{right:?}: {near} {off}");
    }
    let bench = Bench::new(with(LightShape::Polygon(pentagon)));
    let near = penumbra(&bench.sampled(256, "rotated-grid")).rmse;
    assert!(near < 0.012, "{near}");
}

/// Without an area there is a hard truth, and shadow volumes have it.
#[test]
fn hard_lights_are_held_against_the_hard_truth() {
    let mut scene = builtin::build("creature").unwrap();
    for shape in [
        LightShape::Point {
            position: DVec3::new(2.0, 5.0, 3.0),
        },
        LightShape::Directional {
            towards: DVec3::new(0.5, 1.0, 0.4),
        },
    ] {
        scene.lights[0].shape = shape;
        let bench = Bench::new(scene.clone());
        let (_, score) = bench.measure("shadow-volumes", &[]);
        println!("{:?} {}", all(&score), score.psnr);
        // But for pixels at the shadow's edge.
        assert!(all(&score).rmse < 0.02 && all(&score).p99 == 0.0);
        assert_eq!(score.visibility.of_region(LightRegion::Penumbra), None);
        assert!(score.psnr > 35.0, "{}", score.psnr);
        let (_, none) = bench.measure("unshadowed", &[]);
        assert!(all(&none).rmse > 4.0 * all(&score).rmse);
    }
}

/// The truth's picture differs from a technique's in visibility only.
#[test]
fn the_picture_of_the_truth_is_shaded_as_the_techniques_are() {
    let mut scene = builtin::build("creature").unwrap();
    scene.objects.iter_mut().for_each(|o| o.receives = false);
    let bench = Bench::new(scene);
    for given in [
        ["shading=phong", "color-format=rgba16f", "depth-format=d24"],
        ["shading=lambert", "color-format=rgba8", "depth-format=d32f"],
    ] {
        let (_, score) = bench.measure("unshadowed", &given);
        assert_eq!(
            (score.psnr, score.ssim),
            (f64::INFINITY, Some(1.0)),
            "{given:?}"
        );
        assert_eq!((all(&score).max, score.flip), (0.0, 0.0));
    }
}
