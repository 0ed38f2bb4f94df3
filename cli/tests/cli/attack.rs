//! Odd arguments, places and environments: a picture or a message, never half a file
//! and never a panic.

use std::ffi::OsStr;
use std::process::{Command, Output, Stdio};

use crate::common::Folder;

/// Runs `gnomon` in `folder`, changed by `change` before it starts.
fn run(folder: &Folder, arguments: &str, change: impl Fn(&mut Command)) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gnomon"));
    command
        .args(arguments.split_whitespace())
        .current_dir(folder.path(""));
    change(&mut command);
    command.output().unwrap()
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn assert_refused(output: &Output, parts: &[&str]) {
    let message = message(output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(!message.contains("panicked"), "{message}");
    for part in parts {
        assert!(message.contains(part), "no `{part}` in: {message}");
    }
}

#[test]
fn pictures_of_any_size_are_rendered() {
    let folder = Folder::new("attack-sizes");
    for size in ["1x1", "1x9", "7x5", "65x3"] {
        let render = format!("render cylinder --size {size} --out a.png --visibility a.npy");
        folder.gnomon(&render).fine();
        let picture = image::open(folder.path("a.png")).unwrap();
        assert_eq!(format!("{}x{}", picture.width(), picture.height()), size);
        let compare = format!("compare cylinder --size {size} --techniques pcf --json");
        let document = folder.gnomon(&compare).json();
        assert!(document["results"][0]["flip"].is_number());
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    let folder = Folder::new("attack-numbers");
    for bad in [
        "--time NaN",
        "--time inf",
        "--time 1e999",
        "--frames 2 --fps NaN",
        "--frames 2 --fps -1",
        "--frames 2 --fps 0",
        "--frames 2 --fps inf",
        "--frames 0",
        "--frames -1",
        "--repeat -1",
        "--threads NaN",
        "--tile 0",
        "--env sky --env-threshold NaN",
        "--env sky --env-threshold=-1",
        "--env sky --env-threshold inf",
        "--env sky --env-side 0",
        "--env sky --env-turn NaN",
        "--env sky --env-turn inf",
        "--env sky --env-brightness NaN",
        "--env sky --env-brightness=-1",
        "--env sky --env-brightness inf",
        "--env sky --lights 0",
        "--env sky --lights 99999999999",
        "--lights 3",
        "--size NaNxNaN",
        "--size infx3",
        "--size 3x",
        "--size 3x3x3",
    ] {
        let output = run(&folder, &format!("render cylinder {bad}"), |_| ());
        assert_refused(&output, &["error: "]);
        assert!(folder.names().is_empty(), "{bad}: {:?}", folder.names());
    }
    for bad in [
        "--light -1",
        "--light 18446744073709551616",
        "--directions 0",
        "--env sky --directions 0",
        "--env sky --directions NaN",
        "--env sky --lights 0",
        "--env sky --lights ,",
        "--techniques ,",
        "--reference NaN",
    ] {
        let compare = format!("compare cylinder --techniques pcf {bad}");
        let output = run(&folder, &compare, |_| ());
        assert_refused(&output, &["error: "]);
        assert!(folder.names().is_empty(), "{bad}: {:?}", folder.names());
    }
}

/// Each is finite, and so is the frames' rate; their quotient is not.
#[test]
fn times_of_frames_stay_finite() {
    let folder = Folder::new("attack-times");
    let output = run(
        &folder,
        "render walk --size 4x4 --frames 3 --fps 1e-308",
        |_| (),
    );
    assert_refused(&output, &["--fps", "not finite"]);
    assert!(folder.names().is_empty());
    let output = run(
        &folder,
        "render walk --size 4x4 --time 1e300 --out a.png",
        |_| (),
    );
    assert!(
        !message(&output).contains("panicked"),
        "{}",
        message(&output)
    );
}

#[test]
#[cfg(unix)]
fn names_of_any_bytes_are_written() {
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new("attack-bytes");
    let picture = OsStr::from_bytes(b"caf\xe9.png");
    let output = run(
        &folder,
        "render cylinder --size 16x16 --overlay stencil --out",
        |c| {
            c.arg(picture);
        },
    );
    assert_eq!(output.status.code(), Some(0), "{}", message(&output));
    let mut names: Vec<Vec<u8>> = std::fs::read_dir(folder.path(""))
        .unwrap()
        .map(|e| e.unwrap().file_name().as_bytes().to_vec())
        .collect();
    names.sort();
    assert_eq!(names, [&b"caf\xe9-stencil.png"[..], b"caf\xe9.png"]);
    let output = run(&folder, "render", |c| {
        c.arg(OsStr::from_bytes(b"caf\xe9.toml"));
    });
    assert_refused(&output, &["UTF-8"]);
}

#[test]
fn places_that_cannot_be_written_stay_as_they_are() {
    let folder = Folder::new("attack-places");
    let render = "render cylinder --size 16x16 --out";
    std::fs::create_dir(folder.path("folder.png")).unwrap();
    for (out, part) in [
        ("folder.png", "folder"),
        ("..", ".png"),
        ("/", ".png"),
        ("/dev/null", ".png"),
        ("/dev/full", ".png"),
        (".png", ".png"),
        ("/proc/self/a.png", "/proc/self/a.png"),
        ("folder.png/.", "folder"),
    ] {
        let output = run(&folder, &format!("{render} {out}"), |_| ());
        assert_refused(&output, &[part]);
        assert_eq!(folder.names(), ["folder.png"], "{out}");
    }
    let output = run(&folder, "render cylinder --size 4x4 --out", |c| {
        c.arg("");
    });
    assert_refused(&output, &[".png"]);
}

/// A device or pipe would be replaced by a file.
#[test]
#[cfg(unix)]
fn what_is_no_regular_file_is_not_replaced() {
    let folder = Folder::new("attack-pipe");
    std::os::unix::fs::symlink("/dev/null", folder.path("device.png")).unwrap();
    let output = run(
        &folder,
        "render cylinder --size 16x16 --out device.png",
        |_| (),
    );
    assert_refused(&output, &["device.png", "no regular file"]);
    let kept = std::fs::read_link(folder.path("device.png")).unwrap();
    assert_eq!(kept.to_str(), Some("/dev/null"));
    assert_eq!(folder.names(), ["device.png"]);
}

#[test]
fn missing_folders_are_made_and_removed_where_rendering_fails() {
    let folder = Folder::new("attack-folders");
    let render = "render cylinder --size 16x16 --out a/b/c/d.png";
    folder.gnomon(render).fine();
    assert!(folder.path("a/b/c/d.png").is_file());
    let output = run(
        &folder,
        "render cylinder --set light=9 --out x/y.png",
        |_| (),
    );
    assert_refused(&output, &["light 9"]);
    assert_eq!(folder.names(), ["a"]);
}

/// Two programs that begin at once both find no folder; both make it.
#[test]
fn programs_side_by_side_do_not_disturb_each_other() {
    let folder = Folder::new("attack-side-by-side");
    let start = |name: &str| {
        Command::new(env!("CARGO_BIN_EXE_gnomon"))
            .args(format!("render cylinder --size 16x16 --out new/deep/{name}.png").split(' '))
            .current_dir(folder.path(""))
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    let names = ["a", "b", "c", "d"];
    for mut child in names.map(start) {
        assert!(child.wait().unwrap().success());
    }
    let made = std::fs::read_dir(folder.path("new/deep")).unwrap();
    assert_eq!(made.count(), names.len());
}

/// As `gnomon scenes | head -1` and `gnomon 2>&1 | true`.
#[test]
fn a_reader_that_goes_away_is_no_panic() {
    let folder = Folder::new("attack-pipes");
    let closed = |arguments: &str| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_gnomon"))
            .args(arguments.split(' '))
            .current_dir(folder.path(""))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        drop(child.stderr.take());
        child.wait().unwrap().code()
    };
    for fine in [
        "scenes",
        "scenes --json",
        "techniques",
        "techniques --json",
        "--help",
        "render --help",
        "reproduce --list",
        "render cylinder --size 8x8 --out a.png",
        "render cylinder --size 8x8 --out a.png --json",
    ] {
        assert_eq!(closed(fine), Some(0), "{fine}");
    }
    for wrong in [
        "",
        "rendr",
        "render cilinder",
        "render cylinder --out a.jpg",
    ] {
        assert_eq!(closed(wrong), Some(2), "{wrong}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_device_is_an_error_and_no_panic() {
    let folder = Folder::new("attack-full");
    let full = || {
        std::fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap()
    };
    let output = run(&folder, "scenes", |c| {
        c.stdout(full());
    });
    assert_refused(&output, &["standard output"]);
    let status = |arguments: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gnomon"));
        command.args(arguments.split(' ')).stderr(full());
        command.status().unwrap().code()
    };
    assert_eq!(status("render cilinder"), Some(2));
}

#[test]
fn the_number_of_threads_is_bounded() {
    let folder = Folder::new("attack-threads");
    let compare = "compare cylinder --size 24x18 --techniques pcf --json";
    let with = |threads: &str| {
        run(&folder, compare, |c| {
            c.env("RAYON_NUM_THREADS", threads);
        })
    };
    let output = with("100000");
    assert_refused(&output, &["RAYON_NUM_THREADS", "`100000`", "at most 1024"]);
    assert!(folder.names().is_empty());
    for fine in ["0", "1", "3", "none"] {
        let output = with(fine);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{fine}: {}",
            message(&output)
        );
    }
}
