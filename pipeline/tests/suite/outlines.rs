//! Silhouettes combined outline by outline instead of caster by caster.

use crate::drawing::drawn;
use glam::DVec3;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::{Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape;

const SIZE: [u32; 2] = [120, 80];

fn optimised(scene: &Scene, set: &[&str]) -> Rendered {
    drawn(scene, "soft-shadow-volumes-optimised", set, SIZE)
}

fn rmse(scene: &Scene, set: &[&str]) -> f64 {
    let truth = VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap();
    let picture = optimised(scene, set);
    let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
    println!("{} {set:?}: {:?}", scene.name, error.all);
    error.all.unwrap().rmse
}

/// All casters as one mesh.
fn merged(scene: &Scene) -> Scene {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for object in scene.casters() {
        let first = positions.len() as u32;
        positions.extend(object.mesh.positions());
        let own = object.mesh.triangles().iter();
        triangles.extend(own.map(|t| t.map(|i| first + i)));
    }
    let mesh = Mesh::new(positions, triangles, Shading::Flat).unwrap();
    let mut merged = scene.clone();
    merged.objects.retain(|o| !o.casts);
    let material = Material::matt([0.6; 3]);
    merged
        .objects
        .push(Object::new("all casters", mesh, material));
    merged
}

/// Bars that cross are two outlines, be they two casters or one.
#[test]
fn outlines_of_one_caster_are_combined_as_those_of_two() {
    let apart = builtin::build("overlap").unwrap();
    let together = merged(&apart);
    for rule in ["paper", "bounded"] {
        let set = [&*format!("combine={rule}")];
        let [a, b] = [&apart, &together].map(|s| optimised(s, &set));
        assert_eq!(a.visibility_hash(), b.visibility_hash(), "{rule}");
    }
    // By casters there is nothing to combine, and the overlap is summed.
    let by_caster = ["combine=paper", "combine-over=caster"];
    let by_outline = ["combine=paper"];
    let summed = rmse(&together, &["combine=sum"]);
    assert!((rmse(&together, &by_caster) - summed).abs() < 1e-9);
    assert!(rmse(&together, &by_outline) < 0.7 * summed);
}

fn ring_over_a_floor() -> Scene {
    let mut scene = builtin::build("cylinder").unwrap();
    scene.objects.retain(|o| !o.casts);
    let ring = shape::torus_knot(1, 0, 0.8, 0.0, 0.12, 32, 8, DVec3::Y);
    let mesh = ring.into_mesh(Shading::Smooth).unwrap();
    scene
        .objects
        .push(Object::new("ring", mesh, Material::matt([0.6; 3])));
    scene
}

/// A ring's hole is no outline of its own: it would hide less than nothing.
#[test]
fn a_hole_stays_with_its_outline() {
    let scene = ring_over_a_floor();
    let one = optimised(&scene, &["combine=sum"]);
    for rule in ["paper", "bounded"] {
        let other = optimised(&scene, &[&*format!("combine={rule}")]);
        assert_eq!(other.visibility_hash(), one.visibility_hash(), "{rule}");
    }
    assert!(rmse(&scene, &["combine=paper"]) < 0.05);
}

/// Half way from the largest to the sum depends on no order; the paper's rule does
/// where three outlines meet.
#[test]
fn the_bounded_rule_depends_on_no_order() {
    let scene = merged(&builtin::build("spheres").unwrap());
    let mut reversed = scene.clone();
    let mesh = &scene.objects.last().unwrap().mesh;
    let triangles = mesh.triangles().iter().rev().copied().collect();
    let mesh = Mesh::new(mesh.positions().to_vec(), triangles, Shading::Flat).unwrap();
    reversed.objects.last_mut().unwrap().mesh = mesh.into();
    let differ = |rule: &str| {
        let set = [&*format!("combine={rule}")];
        let [a, b] = [&scene, &reversed].map(|s| optimised(s, &set));
        let pairs = a.visibility.iter().zip(&b.visibility);
        pairs.filter(|(a, b)| (**a - **b).abs() > 1e-5).count()
    };
    assert_eq!(differ("bounded"), 0);
    assert!(
        differ("paper") > 20,
        "three spheres in a row hide a part each"
    );
}

/// Loops as the paper writes them: where an outline has one loop nothing changes, and a
/// ring's hole is filled, which is said.
#[test]
fn loops_fill_holes_as_the_paper_writes_it() {
    let by = |over: &'static str| ["combine=paper", over];
    let two = builtin::build("overlap").unwrap();
    let [outlines, loops] =
        ["combine-over=outline", "combine-over=loop"].map(|over| optimised(&two, &by(over)));
    assert_eq!(outlines.visibility_hash(), loops.visibility_hash());
    let ring = ring_over_a_floor();
    let [outlines, loops] =
        ["combine-over=outline", "combine-over=loop"].map(|over| optimised(&ring, &by(over)));
    let told = |picture: &Rendered| {
        picture
            .warnings
            .iter()
            .any(|w| w.code == "loops-round-holes")
    };
    assert!(told(&loops) && !told(&outlines));
    let pairs = outlines.visibility.iter().zip(&loops.visibility);
    let darker = pairs.clone().filter(|(o, l)| *o - *l > 0.5).count();
    let lighter = pairs.filter(|(o, l)| *l - *o > 1e-3).count();
    println!("{darker} darker, {lighter} lighter");
    assert!(darker > 20 && lighter == 0, "{darker} {lighter}");
}
