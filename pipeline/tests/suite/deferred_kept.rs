//! Occlusion maps that stay from frame to frame: the picture is that of the frame by
//! itself, to the bit, and only what moved is drawn again.

use glam::DVec3;
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render, render_next};
use gnomon_pipeline::technique::{KeptPictures, Params, PassRole};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::Scene;

use crate::deferred_shadowing::{MOVING, SIZE, TECHNIQUE, at, figure, two_over_a_floor};

const SET: [&str; 4] = ["groups=each", "lights=8", "map-size=32", "directions=64"];

fn settings() -> RenderSettings {
    RenderSettings {
        size: SIZE,
        ..RenderSettings::default()
    }
}

/// The next frame, which must be the frame by itself; maps kept and drawn.
fn next(scene: &Scene, set: &[&str], kept: &mut KeptPictures) -> (Rendered, [f64; 2]) {
    let technique = find(TECHNIQUE).unwrap();
    let params = Params::parse(technique, set.iter().copied()).unwrap();
    let done = render_next(scene, technique, &params, &settings(), kept).unwrap();
    let alone = render(scene, technique, &params, &settings()).unwrap();
    assert_eq!(done.color_hash(), alone.color_hash());
    assert_eq!(done.visibility_hash(), alone.visibility_hash());
    let [all, found, drawn] = [
        "occlusion maps",
        "occlusion maps kept",
        "occlusion maps drawn",
    ]
    .map(|name| figure(&done, name));
    assert_eq!(found + drawn, all);
    assert_eq!(all, figure(&alone, "occlusion maps"));
    assert_eq!(kept.len() as f64, all);
    (done, [found, drawn])
}

/// Draws of occluders into maps.
fn occluders(done: &Rendered) -> usize {
    let passes = done.report.passes.iter().enumerate();
    let own = passes.filter(|(k, _)| done.roles.of_pass(*k) == PassRole::LightView);
    own.map(|(_, p)| p.draws.len()).sum()
}

fn spinning() -> String {
    MOVING.replace(
        "MOTION",
        "motion.spin = [20.0, 70.0, 0.0]\ntranslate = [0.6, 0.9, 0.2]",
    )
}

/// Of three bodies one turns: the block's shadow on the floor stays, all others are drawn
/// again; where nothing moves all stay, also when the eye does.
#[test]
fn only_maps_of_what_moved_are_drawn_again() {
    let text = spinning();
    let mut kept = KeptPictures::default();
    let (first, [found, drawn]) = next(&at(&text, 0.0), &SET, &mut kept);
    assert!(found == 0.0 && drawn > 16.0, "{found} {drawn}");
    assert_eq!(occluders(&first), drawn as usize);

    let (second, [found, drawn]) = next(&at(&text, 0.25), &SET, &mut kept);
    let still = still_pairs(&at(&text, 0.25));
    assert!(still > 3.0 && drawn > still, "{still} {drawn}");
    assert_eq!(found, still);
    assert_eq!(occluders(&second), drawn as usize);

    let mut moved = at(&text, 0.25);
    moved.camera.eye.x += 0.3;
    let (third, [_, drawn]) = next(&moved, &SET, &mut kept);
    assert_eq!((drawn, occluders(&third)), (0.0, 0));
}

/// Maps of the scene without the body that turns.
fn still_pairs(scene: &Scene) -> f64 {
    let mut still = scene.clone();
    still.objects.remove(1);
    let done = next(&still, &SET, &mut KeptPictures::default()).0;
    figure(&done, "occlusion maps")
}

/// What is kept is what is shown: other texels under the same names make another picture.
#[test]
fn kept_maps_are_looked_up() {
    let scene = at(&spinning(), 0.0);
    let technique = find(TECHNIQUE).unwrap();
    let params = Params::parse(technique, SET).unwrap();
    let mut kept = KeptPictures::default();
    let right = render_next(&scene, technique, &params, &settings(), &mut kept).unwrap();
    let frame = technique.frame_after(&scene, SIZE, &params, &kept).unwrap();
    let mut blank = KeptPictures::default();
    let nothing = |side: u32| vec![0; (side * side * 2) as usize].into();
    (frame.keep.iter()).for_each(|picture| blank.keep(picture.key, nothing(picture.side)));
    assert_eq!(blank.len(), kept.len());
    let wrong = render_next(&scene, technique, &params, &settings(), &mut blank).unwrap();
    assert_ne!(right.color_hash(), wrong.color_hash());
}

/// The same without an environment, with two lights of which one moves.
#[test]
fn maps_of_lights_that_stay_are_kept() {
    let mut scene = two_over_a_floor();
    let other = scene.lights[0].clone();
    scene.lights.push(other);
    let light = |scene: &mut Scene, x: f64| match &mut scene.lights[1].shape {
        LightShape::Rectangle { centre, .. } => centre.x = x,
        other => panic!("{other:?}"),
    };
    light(&mut scene, 1.0);
    let mut kept = KeptPictures::default();
    let set = ["map-size=32", "directions=64"];
    let (_, [found, all]) = next(&scene, &set, &mut kept);
    assert!(found == 0.0 && all >= 6.0, "{found} {all}");
    light(&mut scene, 1.2);
    let (_, [found, drawn]) = next(&scene, &set, &mut kept);
    assert_eq!([found, drawn], [all / 2.0; 2]);
    // Other maps are other pictures.
    let (_, [found, _]) = next(&scene, &["map-size=64", "directions=64"], &mut kept);
    assert_eq!(found, 0.0);
}

/// A map is known by where it is seen from: lights without extent have squares of one width
/// wherever they are, and the occluders stay.
#[test]
fn maps_of_lights_that_turn_are_drawn_again() {
    let mut scene = two_over_a_floor();
    let set = ["map-size=32", "directions=64"];
    let mut kept = KeptPictures::default();
    let mut turned = |x: f64| {
        let towards = DVec3::new(x, 1.0, 0.2);
        scene.lights[0].shape = LightShape::Directional { towards };
        next(&scene, &set, &mut kept)
    };
    let (first, [found, all]) = turned(0.3);
    assert!(found == 0.0 && all >= 3.0, "{found} {all}");
    let (second, [found, drawn]) = turned(-0.4);
    assert!(found == 0.0 && drawn > 0.0, "{found} {drawn}");
    assert_ne!(first.visibility_hash(), second.visibility_hash());
    let (_, [found, again]) = turned(-0.4);
    assert_eq!([found, again], [drawn, 0.0]);
}

/// A map is known by how wide its light is: one that grows where it stands has other maps.
#[test]
fn maps_of_lights_that_grow_are_drawn_again() {
    let mut scene = two_over_a_floor();
    let set = ["map-size=32", "directions=64"];
    let mut kept = KeptPictures::default();
    let (_, [_, all]) = next(&scene, &set, &mut kept);
    if let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape {
        (*edge_u, *edge_v) = (*edge_u * 1.3, *edge_v * 1.3);
    }
    let (_, [found, drawn]) = next(&scene, &set, &mut kept);
    assert_eq!([found, drawn], [0.0, all]);
}

/// A caster that turns about its own middle is drawn again, and the picture is that of the
/// frame by itself (`next` compares).
#[test]
fn maps_of_a_caster_that_turns_are_drawn_again() {
    let mut scene = two_over_a_floor();
    let set = ["map-size=32", "directions=64"];
    let mut kept = KeptPictures::default();
    let (first, [_, all]) = next(&scene, &set, &mut kept);
    // A quarter turn about the upright axis through its middle.
    let plate = &scene.objects[1].mesh;
    let turn = |p: &[f32; 3]| [0.3 + p[2], p[1], 0.3 - p[0]];
    let positions = plate.positions().iter().map(turn).collect();
    let turned = Mesh::new(positions, plate.triangles().to_vec(), Shading::Flat);
    scene.objects[1].mesh = turned.unwrap().into();
    let (second, [found, drawn]) = next(&scene, &set, &mut kept);
    assert!(drawn > 0.0 && found + drawn == all, "{found} {drawn} {all}");
    assert_ne!(first.visibility_hash(), second.visibility_hash());
}

/// A map is known by its occluders' triangles too: of the plate between the same corners
/// one triangle is left.
#[test]
fn maps_of_changed_occluders_are_drawn_again() {
    let mut scene = two_over_a_floor();
    let mut kept = KeptPictures::default();
    let set = ["map-size=32", "directions=64"];
    next(&scene, &set, &mut kept);
    let plate = &scene.objects[1].mesh;
    let (corners, one) = (plate.positions().to_vec(), plate.triangles()[..1].to_vec());
    scene.objects[1].mesh = Mesh::new(corners, one, Shading::Flat).unwrap().into();
    let (_, [_, drawn]) = next(&scene, &set, &mut kept);
    assert!(drawn > 0.0);
}
