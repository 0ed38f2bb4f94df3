//! What a near plane through a shadow volume does to z-pass and z-fail, with
//! depth clamp and without (scene `adversarial-near-plane`).
//!
//! Without depth clamp the near plane cuts away the part of the volume's side
//! between the eye and the near rectangle; z-pass then misses an entry. Depth
//! clamp keeps that part, so z-pass stays right as long as the eye itself is
//! outside the volume.

use std::sync::Arc;

use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques;
use gnomon_pipeline::truth::oracle::hard::{EdgeTolerance, HardTruth};
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::state::PrimitiveState;
use gnomon_raster::{CommandList, Gpu, GpuConfig, RenderPipeline, Subresource};

const SIZE: [u32; 2] = [160, 128];

/// Draws volumes with depth clamp or, as hardware without it has to, with the near plane.
fn set_clamp(list: &mut CommandList, depth_clamp: bool) {
    let volumes = list.passes.iter_mut().filter(|p| p.label == "volumes");
    for draw in volumes.flat_map(|p| &mut p.draws) {
        draw.pipeline = Arc::new(RenderPipeline {
            primitive: PrimitiveState {
                depth_clamp,
                ..draw.pipeline.primitive.clone()
            },
            ..(*draw.pipeline).clone()
        });
    }
}

fn stencil(scene: &Scene, method: &str, depth_clamp: bool) -> Vec<u8> {
    let technique = techniques::find("shadow-volumes").unwrap();
    let params = Params::parse(technique, [method, "skip=off"]).unwrap();
    let mut gpu = Gpu::new(GpuConfig {
        threads: 1,
        ..GpuConfig::default()
    })
    .unwrap();
    let mut frame = technique.frame(scene, SIZE, &params).unwrap();
    set_clamp(&mut frame.recording.list, depth_clamp);
    gpu.load(&frame.recording).unwrap();
    gpu.submit(&frame.recording.list).unwrap();
    let image = gpu.texture(frame.outputs.depth_stencil).unwrap();
    image.read_stencil(Subresource::default()).unwrap()
}

/// Interior pixels, and those whose count differs from the truth's.
fn wrong(scene: &Scene, stencil: &[u8]) -> [usize; 2] {
    let truth = HardTruth::of_scene(scene, 0, SIZE, EdgeTolerance::HALF_PIXEL_AND_DEPTH);
    let pixels = truth.pixels.iter().zip(stencil);
    let interior: Vec<_> = pixels
        .filter(|(p, _)| p.interior && p.centre.hit.is_some())
        .collect();
    let differ = interior
        .iter()
        .filter(|(p, s)| p.centre.shadow_count != u32::from(**s));
    [interior.len(), differ.count()]
}

#[test]
fn the_near_plane_breaks_z_pass_without_depth_clamp_only() {
    let scene = builtin::build("adversarial-near-plane").unwrap();
    for (method, depth_clamp, is_right) in [
        ("method=zpass", true, true),
        ("method=zpass", false, false),
        ("method=zfail", true, true),
        ("method=zfail", false, true),
    ] {
        let [interior, differ] = wrong(&scene, &stencil(&scene, method, depth_clamp));
        eprintln!("{method}, depth clamp {depth_clamp}: {differ} of {interior} differ");
        assert!(interior > 10_000);
        if is_right {
            assert_eq!(differ, 0, "{method}, depth clamp {depth_clamp}");
        } else {
            assert!(
                differ > interior / 5,
                "{method}: only {differ} of {interior} differ"
            );
        }
    }
}

/// Where no volume reaches the near rectangle, depth clamp changes nothing.
#[test]
fn away_from_the_near_plane_depth_clamp_changes_nothing() {
    let scene = builtin::build("cylinder").unwrap();
    for method in ["method=zpass", "method=zfail"] {
        let [with, without] = [true, false].map(|clamp| stencil(&scene, method, clamp));
        assert!(with == without && with.iter().any(|s| *s != 0), "{method}");
    }
}
