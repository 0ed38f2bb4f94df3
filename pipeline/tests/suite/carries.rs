//! What wedges add up to in 8-bit channels, against the buffers themselves.

use gnomon_pipeline::measure::carries::{CHANNEL, Carries, record};
use gnomon_pipeline::measure::render::RenderSettings;
use gnomon_pipeline::technique::{Params, PassRole};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::{CommandList, Gpu, GpuConfig, Subresource};

const SIZE: [u32; 2] = [96, 64];

fn recorded(scene: &Scene, technique: &str, set: &[&str]) -> Option<Carries> {
    let technique = find(technique).unwrap();
    let params = Params::parse(technique, set).unwrap();
    let settings = RenderSettings {
        size: SIZE,
        ..RenderSettings::default()
    };
    record(scene, technique, &params, &settings).unwrap()
}

/// Of each pixel the most that a channel of coverage holds after a pass of wedges, and
/// writes that saturated: the frame drawn once more up to each such pass.
fn stored(scene: &Scene, technique: &str, set: &[&str], channels: usize) -> (Vec<u32>, u64) {
    let technique = find(technique).unwrap();
    let params = Params::parse(technique, set).unwrap();
    let frame = technique.frame(scene, SIZE, &params).unwrap();
    let passes = &frame.recording.list.passes;
    let mut most = vec![0; (SIZE[0] * SIZE[1]) as usize];
    let mut saturated = 0;
    for (number, pass) in passes.iter().enumerate() {
        if frame.roles.of_pass(number) != PassRole::Wedges {
            continue;
        }
        let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
        gpu.load(&frame.recording).unwrap();
        let passes = passes[..=number].to_vec();
        let report = gpu.submit(&CommandList { passes }).unwrap();
        let events = report.passes[number].totals().events;
        saturated += events.blend_saturated.iter().sum::<u64>();
        for attachment in &pass.color {
            let texture = gpu.texture(attachment.texture).unwrap();
            let texels = texture.read_color(Subresource::default()).unwrap();
            for (most, texel) in most.iter_mut().zip(texels) {
                let bytes = texel.0.map(|c| (c * 255.0).round() as u32);
                *most = bytes[..channels].iter().fold(*most, |m, b| m.max(*b));
            }
        }
    }
    (most, saturated)
}

fn assert_is_what_buffers_hold(scene: &str, technique: &str, set: &[&str], channels: usize) -> u64 {
    let scene = builtin::build(scene).unwrap();
    let found = recorded(&scene, technique, set).unwrap();
    let (most, saturated) = stored(&scene, technique, set, channels);
    let limited: Vec<u32> = found.most.iter().map(|s| (*s).min(CHANNEL)).collect();
    assert!(
        limited == most,
        "{} {technique} {set:?}: sums differ",
        scene.name
    );
    assert_eq!(
        found.saturated, saturated,
        "{} {technique} {set:?}",
        scene.name
    );
    assert!(most.iter().any(|m| *m > 0), "{}", scene.name);
    saturated
}

#[test]
fn recorded_sums_are_what_the_buffers_hold_and_count_what_saturates() {
    let four = "soft-shadow-volumes-optimised";
    let three = "soft-shadow-volumes";
    assert_is_what_buffers_hold("columns", four, &[], 4);
    assert_is_what_buffers_hold("overlap", four, &["combine=paper", "split=2"], 4);
    assert_is_what_buffers_hold("columns", four, &["halves=on"], 4);
    assert_is_what_buffers_hold("columns", three, &["buffer=rgba8"], 2);
    assert_is_what_buffers_hold("columns", three, &["buffer=rgba8x2"], 3);
    // Six bits leave room for four, and more lie over one another there.
    let saturated = assert_is_what_buffers_hold("peer-c", three, &["buffer=rgba8"], 2);
    assert!(saturated > 0);
}

/// As many wedges as fit for certain never saturate.
#[test]
fn channels_that_saturate_have_more_wedges_than_fit() {
    let scene = builtin::build("peer-c").unwrap();
    let found = recorded(&scene, "soft-shadow-volumes-optimised", &[]).unwrap();
    assert!(found.saturated > 0);
    let capacity = found.channels.capacity();
    assert_eq!(capacity, gnomon_shaders::split_volumes::CAPACITY);
    for (sum, wedges) in found.most.iter().zip(&found.wedges) {
        assert!(
            *sum <= CHANNEL || *wedges > capacity,
            "{sum} of {wedges} wedges"
        );
    }
}

#[test]
fn floats_carry_nothing() {
    let scene = builtin::build("columns").unwrap();
    assert_eq!(recorded(&scene, "soft-shadow-volumes", &[]), None);
    assert_eq!(recorded(&scene, "penumbra-wedges", &[]), None);
}
