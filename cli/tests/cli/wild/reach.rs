//! Files that are no files, or not the scene's.

use super::{codes, folder_of, hashes, render};
use crate::common::Folder;

fn message(document: &serde_json::Value) -> &str {
    document["warnings"][0]["message"].as_str().unwrap()
}

/// A model whose library is `name`.
fn model_with(folder: &Folder, name: &str) {
    let text = std::fs::read_to_string(super::fixture("zero.obj")).unwrap();
    folder.write("m.obj", &text.replace("/dev/zero", name));
}

#[test]
fn what_lies_outside_is_not_opened() {
    let folder = folder_of("outside", &["base.obj", "red.mtl"]);
    std::fs::create_dir_all(folder.path("scene")).unwrap();
    folder.write("secret.mtl", "the secret\nnewmtl x\nKd 1 0 0\n");
    let secret = folder.path("secret.mtl").display().to_string();
    for name in [
        "/dev/zero",
        "/etc/passwd",
        "../secret.mtl",
        "none/../../secret.mtl",
        secret.as_str(),
    ] {
        let text = std::fs::read_to_string(super::fixture("zero.obj")).unwrap();
        folder.write("scene/m.obj", &text.replace("/dev/zero", name));
        let document = render(&folder, "scene/m.obj");
        assert_eq!(codes(&document), ["missing-mtl"], "{name}");
        let message = message(&document);
        assert!(message.contains("--allow-outside"), "{message}");
        assert!(
            !message.contains("the secret") && !message.contains("root:"),
            "{message}"
        );
    }
    let allowed = render(&folder, "scene/m.obj --allow-outside");
    assert_eq!(codes(&allowed), ["bad-mtl"]);
    let scene = std::fs::read_to_string(super::fixture("seam.toml")).unwrap();
    folder.write("scene/s.toml", &scene.replace("seam.obj", "../base.obj"));
    folder.gnomon("render scene/s.toml").refused(&[
        "s.toml:",
        "base.obj",
        "outside",
        "--allow-outside",
    ]);
    render(&folder, "scene/s.toml --allow-outside");
    let lit = scene.split("[[lights]]").next().unwrap();
    let object = scene
        .split("[[objects]]")
        .last()
        .unwrap()
        .replace("seam.obj", "m.obj");
    let lit = format!("{lit}[environment]\nmap = \"../sky.hdr\"\n[[objects]]{object}");
    folder.write("scene/e.toml", &lit);
    folder
        .gnomon("render scene/e.toml")
        .refused(&["e.toml:", "sky.hdr", "--allow-outside"]);
}

/// A scene may have its parts in folders of its own.
#[test]
fn what_lies_in_the_scenes_folder_is_read() {
    let folder = folder_of("inside", &["base-red.obj", "red.mtl"]);
    for part in ["models", "paint"] {
        std::fs::create_dir_all(folder.path(part)).unwrap();
    }
    let text = std::fs::read_to_string(folder.path("base-red.obj")).unwrap();
    folder.write("models/m.obj", &text.replace("red.mtl", "../paint/red.mtl"));
    std::fs::copy(folder.path("red.mtl"), folder.path("paint/red.mtl")).unwrap();
    let scene = std::fs::read_to_string(super::fixture("seam.toml")).unwrap();
    folder.write("a.toml", &scene.replace("seam.obj", "models/m.obj"));
    folder.write("b.toml", &scene.replace("seam.obj", "base-red.obj"));
    let [a, b] = ["a.toml", "b.toml"].map(|s| render(&folder, s));
    assert_eq!(hashes(&a), hashes(&b));
    assert_eq!(codes(&a), codes(&b));
}

#[test]
fn files_that_are_too_long_are_refused_with_the_limit() {
    let folder = folder_of("long", &["base.obj"]);
    for (file, run, limit) in [
        ("big.obj", "render big.obj", "268435456 bytes"),
        ("big.toml", "render big.toml", "16777216 bytes"),
        (
            "big.hdr",
            "render creature --env big.hdr",
            "536870912 bytes",
        ),
    ] {
        let sparse = std::fs::File::create(folder.path(file)).unwrap();
        sparse.set_len(1 << 34).unwrap();
        folder.gnomon(run).refused(&[file, limit]);
    }
}

#[cfg(unix)]
mod pipes {
    use super::*;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    fn pipe(folder: &Folder, name: &str) {
        let made = Command::new("mkfifo").arg(folder.path(name)).status();
        assert!(made.unwrap().success());
    }

    /// Exit code and messages; a run that waits for a pipe is ended.
    fn gnomon(folder: &Folder, arguments: &str) -> (Option<i32>, String) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_gnomon"))
            .args(arguments.split_whitespace())
            .current_dir(folder.path("."))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while child.try_wait().unwrap().is_none() {
            if start.elapsed() > Duration::from_secs(60) {
                child.kill().unwrap();
                panic!("{arguments} waits");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let output = child.wait_with_output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stderr).unwrap(),
        )
    }

    #[test]
    fn no_reader_waits_for_a_pipe() {
        let folder = folder_of("pipes", &["f.obj", "seam.toml"]);
        for name in ["fifo", "p.obj", "p.toml", "seam.obj", "p.hdr", "p.mtl"] {
            pipe(&folder, name);
        }
        for arguments in [
            "render p.obj",
            "render p.toml",
            "render seam.toml",
            "render creature --env fifo",
            "render creature --env p.hdr",
            "render creature --env /dev/zero",
        ] {
            let (code, message) = gnomon(&folder, arguments);
            assert_eq!(code, Some(2), "{arguments}: {message}");
            assert!(
                message.contains("only regular files"),
                "{arguments}: {message}"
            );
        }
        for library in ["fifo", "p.mtl"] {
            model_with(&folder, library);
            let (code, message) = gnomon(&folder, "render m.obj --size 64x48 --json");
            assert_eq!(code, Some(0), "{message}");
            assert!(message.contains("is a pipe"), "{message}");
        }
    }

    #[test]
    fn a_cache_of_pipes_costs_time_only() {
        let folder = folder_of("cache", &[]);
        let compare = "compare cylinder --techniques shadow-volumes --size 16x12 --json";
        assert_eq!(gnomon(&folder, compare).0, Some(0));
        let cache = folder.path("out/oracle-cache");
        for entry in std::fs::read_dir(&cache).unwrap() {
            let path = entry.unwrap().path();
            std::fs::remove_file(&path).unwrap();
            assert!(
                Command::new("mkfifo")
                    .arg(&path)
                    .status()
                    .unwrap()
                    .success()
            );
        }
        let (code, message) = gnomon(&folder, compare);
        assert_eq!(code, Some(0), "{message}");
        assert!(message.contains("is a pipe"), "{message}");
    }
}
