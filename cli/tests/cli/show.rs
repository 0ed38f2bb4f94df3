//! `render --show`: what buffers hold at any moment of a frame.

use std::fs;

use crate::common::Folder;

const RENDER: &str = "render parallel-plates --size 48x32 --out a.png";

/// The numbers behind the header of an array.
fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    let file = fs::read(folder.path(name)).unwrap();
    let header = 10 + usize::from(u16::from_le_bytes([file[8], file[9]]));
    file[header..].to_vec()
}

#[test]
fn a_buffer_is_shown_at_any_moment() {
    let folder = Folder::new("show");
    let stencil = "--show depth-stencil.stencil";
    let moments = [
        "@ambient=0.npy",
        "@volumes/plate=1.npy",
        "@volumes=2.npy",
        "=3.npy",
    ];
    let shows = moments.map(|m| format!("{stencil}{m}")).join(" ");
    folder.gnomon(&format!("{RENDER} {shows}")).fine();
    let [before, drawn, counted, end] =
        ["0.npy", "1.npy", "2.npy", "3.npy"].map(|name| bytes(&folder, name));
    assert_eq!(before, [0; 48 * 32]);
    // One caster, so one draw; its shadow is counted once wherever it is counted.
    assert_eq!(drawn, counted);
    assert!(counted.contains(&1) && counted.iter().all(|s| *s <= 1));
    assert_eq!(counted.len(), end.len());
}

#[test]
fn all_kinds_of_files_say_the_same() {
    let folder = Folder::new("show-kinds");
    let show = "--show color=c.npy --show color=c.exr --show color --show 1=d.npy";
    let printed = folder.gnomon(&format!("{RENDER} {show}")).fine().stdout();
    assert!(printed.contains("wrote a-color.png (show)"), "{printed}");
    let halves = bytes(&folder, "c.npy");
    let exr = image::open(folder.path("c.exr")).unwrap().to_rgba32f();
    assert_eq!(exr.dimensions(), (48, 32));
    for (half, float) in halves.chunks_exact(2).zip(exr.as_raw()) {
        let half = u16::from_le_bytes([half[0], half[1]]);
        assert_eq!(gnomon_raster::format::f32_from_f16(half), *float);
    }
    // Above its legend, the picture is that of the render.
    let [render, shown] = ["a.png", "a-color.png"].map(|name| {
        let picture = image::open(folder.path(name)).unwrap();
        picture.to_rgba8()
    });
    let left = (shown.width() - 48) / 2;
    assert!(
        render
            .enumerate_pixels()
            .all(|(x, y, p)| shown.get_pixel(x + left, y) == p)
    );
    assert_eq!(bytes(&folder, "d.npy").len(), 48 * 32 * 4);
}

#[test]
fn what_is_not_there_is_refused_with_what_is() {
    let folder = Folder::new("show-refused");
    let refused = |show: &str, words: &[&str]| {
        folder
            .gnomon(&format!("{RENDER} --show {show}"))
            .refused(words);
    };
    refused("visibility", &["visibility", "0 color, 1 depth-stencil"]);
    refused("color@late", &["color@late", "0 ambient, 1 volumes, 2 lit"]);
    refused(
        "color@volumes/9",
        &["pass 1 `volumes` has the draws 0 plate"],
    );
    refused("color.depth", &["Rgba16Float"]);
    refused("color:1", &[":0:0"]);
    refused("color=c.tiff", &[".exr"]);
    assert!(folder.names().is_empty());
}
