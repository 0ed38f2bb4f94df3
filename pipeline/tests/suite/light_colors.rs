//! Colours of a light's image, each channel against the truth, in both techniques on soft
//! shadow volumes.

use crate::drawing::{as_published, drawn};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::{Gpu, GpuConfig, Subresource};

const SIZE: [u32; 2] = [120, 80];
const OPTIMISED: &str = "soft-shadow-volumes-optimised";
const EVEN: [&str; 2] = ["texture-filter=quadlinear", "texture-centred=vertex"];

/// The channels of the visibility that a frame leaves, NaN where nothing is seen.
fn channels(scene: &Scene, technique: &str, set: &[&str]) -> [Vec<f32>; 3] {
    let seen = drawn(scene, technique, set, SIZE).visibility;
    let technique = find(technique).unwrap();
    let params = Params::parse(technique, as_published(technique).iter().chain(set)).unwrap();
    let frame = technique.frame(scene, SIZE, &params).unwrap();
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    gpu.load(&frame.recording).unwrap();
    gpu.submit(&frame.recording.list).unwrap();
    let texture = frame.outputs.visibility.texture().unwrap();
    let texture = gpu.texture(texture).unwrap();
    let texels = texture.read_color(Subresource::default()).unwrap();
    [0, 1, 2].map(|c| {
        let pairs = texels.iter().zip(&seen);
        let value = pairs.map(|(t, v)| {
            if v.is_nan() {
                *v
            } else {
                t.0[c].clamp(0.0, 1.0)
            }
        });
        value.collect()
    })
}

/// The scene under one half of its light, along its first edge.
fn under_half(scene: &Scene, side: f64) -> VisibilityImage {
    let mut half = scene.clone();
    let LightShape::Rectangle { centre, edge_u, .. } = &mut half.lights[0].shape else {
        unreachable!()
    };
    *centre += *edge_u * (side / 4.0);
    *edge_u /= 2.0;
    VisibilityImage::of_scene(&half, 0, SIZE, &|| ()).unwrap()
}

/// Red is one half of the light, green and blue are the other.
#[test]
fn each_color_is_seen_of_its_own_half() {
    let scene = builtin::build("parallel-plates").unwrap();
    let halves = [-1.0, 1.0].map(|side| under_half(&scene, side));
    let set = [&["light-image=halves"], &EVEN[..]].concat();
    // The float's texture, and 8 bits of visibility besides.
    for (technique, limit) in [
        ("soft-shadow-volumes", 2e-3),
        (OPTIMISED, 2e-3 + 0.5 / 255.0),
    ] {
        let colours = channels(&scene, technique, &set);
        for (channel, of) in [(0, 0), (1, 1), (2, 1)] {
            let error = |of: usize| {
                let error = VisibilityError::measure(&halves[of], SIZE, &colours[channel]);
                error.unwrap().all.unwrap()
            };
            let [own, other] = [error(of), error(1 - of)];
            println!("{technique} {channel}: {own:?}, the other half {other:?}");
            assert!(own.p99 < limit + 1e-4, "{technique} {channel}: {own:?}");
            assert!(other.rmse > 5.0 * own.rmse, "{technique} {channel}");
        }
    }
}

/// Colors in bytes are those in half floats, to two steps: the share itself is stored, and
/// not twice the share.
#[test]
fn eight_bits_of_a_color_are_near_to_sixteen() {
    let scene = builtin::build("parallel-plates").unwrap();
    let of = |bits: &str| {
        let set = ["light-image=halves", bits];
        channels(&scene, "soft-shadow-volumes", &set)
    };
    let (eight, sixteen) = (of("texture-bits=8"), of("texture-bits=16"));
    for (channel, (a, b)) in eight.iter().zip(&sixteen).enumerate() {
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        let worst = off.filter(|d| !d.is_nan()).fold(0.0, f32::max);
        assert!(worst < 0.01, "{channel}: {worst}");
        assert!(a.iter().any(|v| *v < 0.1), "{channel}");
    }
}

/// Paper III's texture for a light of one colour, split over bytes: as exact as it is in a
/// float, with the same errors of its own.
#[test]
fn one_colored_textures_are_read_alike_in_both() {
    let scene = builtin::build("cylinder").unwrap();
    for filter in ["texture-filter=nearest", "texture-filter=quadlinear"] {
        let set = ["backend=texture4d", filter];
        let three = drawn(&scene, "soft-shadow-volumes", &set, SIZE);
        for halves in ["halves=off", "halves=on"] {
            let four = drawn(&scene, OPTIMISED, &[&set[..], &[halves]].concat(), SIZE);
            let pairs = three.visibility.iter().zip(&four.visibility);
            let off = pairs
                .filter(|(a, _)| !a.is_nan())
                .map(|(a, b)| (a - b).abs());
            let worst = off.fold(0.0, f32::max);
            println!("{filter} {halves}: {worst}");
            // A few dozen edges, each rounded to 1/4095.
            assert!(worst < 40.0 * 0.5 / 4095.0, "{filter} {halves}: {worst}");
        }
    }
}

/// Images go with every way to combine, and with halves, and not with split lights.
#[test]
fn images_go_with_all_but_split_lights() {
    let scene = builtin::build("overlap").unwrap();
    let technique = find(OPTIMISED).unwrap();
    let image = "light-image=windows";
    let plain = channels(&scene, OPTIMISED, &[image]);
    let by_halves = channels(&scene, OPTIMISED, &[image, "halves=on"]);
    for channel in 0..3 {
        let bits = |v: &[f32]| v.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&plain[channel]), bits(&by_halves[channel]));
    }
    let combined = channels(&scene, OPTIMISED, &[image, "combine=paper"]);
    let lighter = plain[2]
        .iter()
        .zip(&combined[2])
        .filter(|(a, b)| b > a)
        .count();
    assert!(lighter > 20, "{lighter}");
    let params = Params::parse(technique, [image, "split=2"]).unwrap();
    let refused = technique.frame(&scene, SIZE, &params).err().unwrap();
    assert!(refused.to_string().contains("split=2"), "{refused}");
}
