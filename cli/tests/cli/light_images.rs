//! Images and videos on lights, from the command line.

use std::fs;

use crate::common::Folder;

const TECHNIQUE: &str = "--technique soft-shadow-volumes --set texture-size=8 --size 48x32";

/// Three images of a light, and files that are none.
fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    for k in 0..3u32 {
        let bright = |x, _| image::Luma([if x == k { 255u8 } else { 20 }]);
        let picture = image::GrayImage::from_fn(4, 4, bright);
        picture.save(folder.path(&format!("{k}.png"))).unwrap();
    }
    image::GrayImage::new(40, 40)
        .save(folder.path("large.png"))
        .unwrap();
    folder.write("text.png", "no picture");
    folder
}

#[test]
fn an_animation_goes_through_the_images() {
    let folder = folder("video");
    let set = format!("{TECHNIQUE} --set light-image=0.png,1.png,2.png");
    folder
        .gnomon(&format!(
            "render parallel-plates {set} --frames 4 --out video"
        ))
        .fine();
    let picture = |name: &str| folder.pixels(name);
    let frames: Vec<_> = (0..4)
        .map(|k| picture(&format!("video/frame-000{k}.png")))
        .collect();
    assert!(frames[0] != frames[1] && frames[1] != frames[2]);
    assert_eq!(frames[3], frames[0], "from the first again");
    let one = format!("render parallel-plates {TECHNIQUE} --set light-image=1.png --out one.png");
    folder.gnomon(&one).fine();
    assert_eq!(picture("one.png"), frames[1]);
    // Half as fast, every other frame is a blend.
    let slow = "--frames 3 --fps 24 --light-fps 12 --out slow";
    folder
        .gnomon(&format!("render parallel-plates {set} {slow}"))
        .fine();
    let slow: Vec<_> = (0..3)
        .map(|k| picture(&format!("slow/frame-000{k}.png")))
        .collect();
    assert_eq!((&slow[0], &slow[2]), (&frames[0], &frames[1]));
    assert!(slow[1] != frames[0] && slow[1] != frames[1]);
}

#[test]
fn a_video_is_recorded_and_replayed() {
    let folder = folder("video-trace");
    let set = format!("{TECHNIQUE} --set light-image=0.png,1.png");
    let rate = "--frames 3 --light-fps 12";
    folder
        .gnomon(&format!("record parallel-plates {set} {rate} --out v.gnt"))
        .fine();
    for k in 0..3 {
        fs::remove_file(folder.path(&format!("{k}.png"))).unwrap();
    }
    folder.gnomon("replay v.gnt").fine();
}

#[test]
fn a_comparison_is_under_one_image() {
    let folder = folder("video-compare");
    let image = "soft-shadow-volumes.light-image=0.png";
    let small = "--size 48x32 --out-dir .";
    let compare = format!("compare parallel-plates --techniques soft-shadow-volumes {small}");
    folder.gnomon(&format!("{compare} --set {image}")).fine();
    let both = "--techniques soft-shadow-volumes,shadow-volumes";
    folder
        .gnomon(&format!(
            "compare parallel-plates {both} {small} --set {image}"
        ))
        .refused(&["light-image", "same image"]);
}

#[test]
fn what_is_no_image_is_refused() {
    let folder = folder("video-bad");
    let before = folder.names();
    for (value, part) in [
        ("large.png", "40x40"),
        ("text.png", "no PNG"),
        ("none.png", "cannot be read"),
        ("0.png,none.png", "none.png"),
        (".", "folder"),
        ("/dev/zero", "device"),
        ("0.png,,1.png", "image files"),
    ] {
        let line = format!("render parallel-plates {TECHNIQUE} --set light-image={value}");
        folder.gnomon(&line).refused(&["light-image", part]);
    }
    let line = "render parallel-plates --technique pcf --frames 2 --light-fps 3";
    folder.gnomon(line).refused(&["--light-fps", "pcf"]);
    let line = format!("render parallel-plates {TECHNIQUE} --light-fps 3");
    folder.gnomon(&line).refused(&["--frames"]);
    assert_eq!(folder.names(), before);
}
