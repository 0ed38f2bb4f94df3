//! The same bits and counters for every way to execute.

use crate::common::Folder;
use serde_json::Value;

fn render(folder: &Folder, flags: &str) -> Value {
    folder
        .gnomon(&format!(
            "render demo --size 96x64 --out a.png --json {flags}"
        ))
        .json()
}

#[test]
fn hashes_and_counters_do_not_depend_on_execution() {
    let folder = Folder::new("execution");
    let reference = render(&folder, "--threads 1 --tile 64 --simd scalar");
    for flags in [
        "--threads 3",
        "--tile 16",
        "--tile 128 --threads 2",
        "--simd auto --tile 32",
        "--repeat 2",
    ] {
        let other = render(&folder, flags);
        for key in ["hash", "passes", "totals", "casters", "warnings"] {
            assert_eq!(other[key], reference[key], "{flags}: {key}");
        }
    }
}

#[test]
fn skipping_changes_counters_but_no_bit() {
    let folder = Folder::new("skipping");
    for method in ["zpass", "zfail", "auto"] {
        let set = format!("--set method={method}");
        let (with, without) = (
            render(&folder, &set),
            render(&folder, &format!("{set} --no-skip")),
        );
        assert_eq!(with["hash"], without["hash"], "{method}");
        assert_eq!(without["totals"]["fragments"]["hiz_killed"], 0);
        assert_eq!(
            (&without["skip"], &without["params"]["skip"]),
            (&false.into(), &"off".into())
        );
        assert_ne!(
            with["totals"]["traffic"]["z"], without["totals"]["traffic"]["z"],
            "{method}"
        );
    }
}

#[test]
fn techniques_differ() {
    let folder = Folder::new("techniques");
    let shadowed = render(&folder, "");
    let unshadowed = render(&folder, "--technique unshadowed");
    assert_ne!(shadowed["hash"]["color"], unshadowed["hash"]["color"]);
    assert_ne!(
        shadowed["hash"]["visibility"],
        unshadowed["hash"]["visibility"]
    );
}

/// Every technique that there is, so that a new one is covered when it is listed.
#[test]
fn no_technique_depends_on_execution() {
    let folder = Folder::new("all-techniques");
    let listed = folder.gnomon("techniques --json").json();
    for technique in listed["techniques"].as_array().unwrap() {
        let name = technique["name"].as_str().unwrap();
        let run = |flags: &str| {
            let size = "render creature --size 72x40 --out a.png --json";
            folder
                .gnomon(&format!("{size} --technique {name} {flags}"))
                .json()
        };
        let reference = run("--threads 1 --tile 64 --simd scalar");
        for flags in [
            "--threads 3 --tile 16",
            "--tile 128 --threads 2",
            "--simd auto",
        ] {
            let other = run(flags);
            for key in ["hash", "passes", "totals", "casters", "warnings"] {
                assert_eq!(other[key], reference[key], "{name} {flags}: {key}");
            }
        }
        assert_eq!(run("--no-skip")["hash"], reference["hash"], "{name}");
    }
}
