//! Paper IV's technique has 8-bit buffers alone, reads two of them at the end, and moves
//! fewer bytes than paper III's.

use crate::drawing::drawn;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{Frame, Params, PassRole};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::{Counters, Format};

const SIZE: [u32; 2] = [120, 80];
const OPTIMISED: &str = "soft-shadow-volumes-optimised";

fn frame(scene: &Scene, set: &[&str]) -> Frame {
    let technique = find(OPTIMISED).unwrap();
    let params = Params::parse(technique, ["horizon=off"].iter().chain(set)).unwrap();
    technique.frame(scene, SIZE, &params).unwrap()
}

/// Formats of what the passes of the shadows draw to and look up, with their labels.
fn formats(frame: &Frame) -> Vec<(String, Format)> {
    let textures = frame.recording.textures();
    let passes = frame.recording.list.passes.iter().zip(frame.roles.passes());
    let mut all = Vec::new();
    for (pass, _) in passes.filter(|(_, role)| !role.is_shading()) {
        let targets = pass.color.iter().map(|a| a.texture);
        let read = pass.draws.iter().flat_map(|d| &d.textures);
        for id in targets.chain(read.map(|b| b.texture)) {
            let desc = textures[id.index()].descriptor();
            all.push((desc.label.clone(), desc.format));
        }
    }
    all.sort();
    all.dedup();
    all
}

fn several_lights() -> Scene {
    let mut scene = builtin::build("columns").unwrap();
    let mut second = scene.lights[0].clone();
    second.colour = [0.2, 0.3, 0.1];
    scene.lights.push(second);
    scene
}

/// Of the default form, of each way to combine silhouettes, of split lights and of several
/// lights: what is drawn to has 8-bit channels, and of floats only positions are read.
#[test]
fn no_target_of_the_shadows_is_a_float() {
    let scene = builtin::build("overlap").unwrap();
    let cases: [(&Scene, &[&str]); 6] = [
        (&scene, &[]),
        (&scene, &["combine=paper"]),
        (&scene, &["combine=bounded", "split=2"]),
        (&scene, &["split=3", "halves=off"]),
        (&several_lights(), &[]),
        (&builtin::build("adversarial-nested-300").unwrap(), &[]),
    ];
    for (scene, set) in cases {
        let formats = formats(&frame(scene, set));
        println!("{} {set:?}: {formats:?}", scene.name);
        assert!(formats.iter().any(|(label, _)| label == "coverage taken"));
        for (label, format) in formats {
            let in_bytes = matches!(
                format,
                Format::Rgba8Unorm | Format::Rg8Unorm | Format::Depth24Stencil8
            );
            assert!(in_bytes || label == "positions", "{label}: {format:?}");
        }
    }
}

fn of_role(picture: &Rendered, role: PassRole) -> Counters {
    let mut sum = Counters::default();
    let passes = picture.report.passes.iter().zip(picture.roles.passes());
    let passes = passes.filter(|(_, r)| **r == role);
    passes.for_each(|(p, _)| sum.add(&p.totals()));
    sum
}

#[test]
fn the_resolve_reads_two_buffers_of_four_bytes_and_the_stencil() {
    let scene = builtin::build("columns").unwrap();
    let picture = drawn(&scene, OPTIMISED, &[], SIZE);
    let pixels = u64::from(SIZE[0] * SIZE[1]);
    let resolve = of_role(&picture, PassRole::Resolve).traffic;
    let read = resolve.tex.map(|t| t.bytes());
    // The stencil is fetched as texels of a depth texture of three bytes.
    assert_eq!(read[..4], [4 * pixels, 4 * pixels, 3 * pixels, 0]);
    assert_eq!(resolve.color[0].bytes(), 2 * pixels);
    assert_eq!(
        of_role(&picture, PassRole::Combine).traffic.total_bytes(),
        0
    );
}

/// Bytes of a frame.
fn bytes(scene: &Scene, technique: &str, set: &[&str]) -> u64 {
    let picture = drawn(scene, technique, set, SIZE);
    let passes = picture.report.passes.iter();
    passes.map(|p| p.totals().traffic.total_bytes()).sum()
}

/// Paper III as published, with wedges round spheres and visibility that is copied back
/// for want of float blending, moves more on every scene that comes with the program. A
/// float that is blended, with wedges as tight as they can be, is beyond both papers: it
/// is beaten where quads and wedges outweigh what two buffers cost at every pixel.
#[test]
fn fewer_bytes_are_moved_than_by_paper_three() {
    let three = "soft-shadow-volumes";
    let (mut scenes, mut fewer) = (0, 0);
    for entry in builtin::SCENES {
        let scene = entry.build();
        let four = bytes(&scene, OPTIMISED, &[]);
        let published = bytes(&scene, three, &["wedge=paper3", "copy-back=on"]);
        let blended = bytes(&scene, three, &[]);
        println!("| {} | {published} | {blended} | {four} |", entry.name);
        assert!(four < published, "{}: {four} {published}", entry.name);
        // 13 bytes a pixel to clear, resolve and light by; and looser wedges.
        let pixels = u64::from(SIZE[0] * SIZE[1]);
        assert!(four < blended * 11 / 10 + 13 * pixels, "{}", entry.name);
        scenes += 1;
        fewer += u32::from(four < blended);
    }
    assert!(2 * fewer > scenes, "{fewer} of {scenes}");
}
