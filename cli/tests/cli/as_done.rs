//! Files appear as they are done, and not all at the end.

use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::common::Folder;

#[test]
fn the_frame_is_there_before_what_explains_it() {
    let folder = Folder::new("as-done-render");
    let overlays = "stencil,silhouette,overdraw,traffic,saturation,artefacts,overlap";
    let mut render = Command::new(env!("CARGO_BIN_EXE_gnomon"))
        .args(["render", "demo", "--size", "320x240", "-o", "a.png"])
        .args(["--overlay", overlays])
        .current_dir(folder.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while !folder.path("a.png").exists() {
        assert!(start.elapsed() < Duration::from_secs(120), "no picture");
        sleep(Duration::from_millis(1));
    }
    // Whole, while others are not even begun.
    let last = folder.path("a-overlap.png");
    let early = image::open(folder.path("a.png")).unwrap().to_rgba8();
    assert!(!last.exists() && render.try_wait().unwrap().is_none());
    assert!(render.wait().unwrap().success());
    assert!(
        last.exists() && folder.names().len() == 8,
        "{:?}",
        folder.names()
    );
    let late = image::open(folder.path("a.png")).unwrap().to_rgba8();
    assert!(early == late);
}

/// What cannot be drawn is refused before the first file, wherever it was asked for.
#[test]
fn nothing_is_written_where_the_last_thing_is_refused() {
    let folder = Folder::new("as-done-refused");
    let render = "render cylinder --technique shadow-volumes --size 16x12 -o a.png";
    for (last, told) in [
        ("--overlay stencil,carries", "adds no coverage up"),
        ("--overlay stencil,wedges", "builds no penumbra wedges"),
        ("--overlay stencil --show color --show none", "0 color"),
        ("--show color=a.png", "two files would have this name"),
    ] {
        folder.gnomon(&format!("{render} {last}")).refused(&[told]);
        assert!(folder.names().is_empty(), "{last}: {:?}", folder.names());
    }
}

/// A technique that refuses the light comes last: what has been compared is to be seen.
#[test]
fn the_picture_of_a_comparison_grows_with_the_techniques() {
    let folder = Folder::new("as-done-compare");
    folder.write(
        "sun.toml",
        "[camera]\neye = [0, 2, 5]\ntarget = [0, 0.5, 0]\n\
         [[lights]]\nshape.directional = { towards = [1, 4, 2] }\n\
         [[objects]]\nmesh.box = { size = [1, 1, 1] }\n",
    );
    let compare = "compare sun.toml --size 32x24 --out-dir o --techniques";
    let one = format!("{compare} shadow-volumes");
    folder.gnomon(&one).fine();
    let of_one = std::fs::read(folder.path("o/sun-compare.png")).unwrap();
    std::fs::remove_file(folder.path("o/sun-compare.png")).unwrap();
    let stopped = format!("{compare} shadow-volumes,smoothies");
    folder.gnomon(&stopped).refused(&["smoothies"]);
    let of_two = std::fs::read(folder.path("o/sun-compare.png")).unwrap();
    assert!(of_one == of_two, "the picture of the one that was compared");
}
