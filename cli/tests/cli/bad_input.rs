//! Bad input: exit code 2, a message that says what and what instead, no file.

use crate::common::Folder;

/// Runs with arguments that must be refused and leave the folder as it was.
fn refused(folder: &Folder, arguments: &str, parts: &[&str]) {
    let before = folder.names();
    folder.gnomon(arguments).refused(parts);
    assert_eq!(folder.names(), before, "{arguments}");
}

#[test]
fn unknown_names_get_suggestions() {
    let folder = Folder::new("names");
    refused(
        &folder,
        "render cilinder",
        &["cilinder", "did you mean 'cylinder'"],
    );
    refused(
        &folder,
        "render cylinder --technique shadow-volume",
        &["did you mean 'shadow-volumes'"],
    );
    refused(
        &folder,
        "render cylinder --set methd=auto",
        &["methd", "did you mean 'method'"],
    );
    refused(
        &folder,
        "render cylinder --set method=fast",
        &["fast", "auto|zpass|zfail"],
    );
    refused(
        &folder,
        "render cylinder --set method",
        &["method", "KEY=VALUE"],
    );
    refused(
        &folder,
        "render cylinder --set light=7",
        &["light 7", "has 1"],
    );
    refused(
        &folder,
        "render cylinder --overlay heat",
        &["heat", "overdraw"],
    );
    refused(&folder, "rendr cylinder", &["rendr", "render"]);
    refused(&folder, "render", &["<SCENE>"]);
}

#[test]
fn the_environments_threads_are_limited() {
    let folder = Folder::new("environment-threads");
    for threads in ["100000", "1025"] {
        folder
            .gnomon_with(
                "render demo --size 64x48",
                &[("RAYON_NUM_THREADS", threads)],
            )
            .refused(&["RAYON_NUM_THREADS", threads, "1024"]);
    }
    assert!(folder.names().is_empty());
    let run = folder.gnomon_with(
        "render demo --size 64x48 --json",
        &[("RAYON_NUM_THREADS", "3")],
    );
    assert_eq!(run.fine().json()["threads"], 3);
}

/// The colour attachment does not fit, or the depth beside it.
#[cfg(target_os = "linux")]
#[test]
fn memory_that_is_short_is_an_error() {
    let folder = Folder::new("memory");
    for kib in [300_000, 700_000] {
        folder
            .gnomon_within("render demo --size 8192x8192 --threads 1", kib)
            .refused(&["bytes, which the system does not give", "8192"]);
    }
    assert!(folder.names().is_empty());
}

#[test]
fn sizes_and_execution_settings_are_checked() {
    let folder = Folder::new("settings");
    for size in [
        "0x0",
        "0x5",
        "5",
        "9000x1",
        "-1x1",
        "1e3x5",
        "99999999999999999999x1",
    ] {
        refused(
            &folder,
            &format!("render cylinder --size={size}"),
            &["WIDTHxHEIGHT", "8192"],
        );
        refused(&folder, &format!("demo --size={size}"), &["WIDTHxHEIGHT"]);
    }
    refused(
        &folder,
        "render cylinder --tile 48",
        &["48", "16, 32, 64 or 128"],
    );
    refused(&folder, "render cylinder --simd mmx", &["mmx", "scalar"]);
    refused(&folder, "render cylinder --threads -1", &["-1"]);
    refused(&folder, "render cylinder --threads 99999", &["1024"]);
    refused(&folder, "render cylinder --repeat 0", &["0"]);
}

#[test]
fn unreadable_scenes_name_file_and_place() {
    let folder = Folder::new("scenes");
    folder.write("garbage.obj", "v 1 2\nf zebra\n\u{1}\u{2}");
    folder.write("empty.obj", "");
    folder.write("cut.toml", "[camera]\neye = [0, 2");
    folder.write("empty.toml", "");
    std::fs::write(folder.path("binary.obj"), [0xff, 0xfe, 0, 1, 2]).unwrap();
    refused(&folder, "render missing.obj", &["missing.obj"]);
    refused(
        &folder,
        "render missing.toml",
        &["missing.toml", "cannot be read"],
    );
    refused(&folder, "render garbage.obj", &["garbage.obj"]);
    refused(&folder, "render empty.obj", &["empty.obj"]);
    refused(&folder, "render binary.obj", &["binary.obj"]);
    refused(&folder, "render cut.toml", &["cut.toml:2:"]);
    refused(&folder, "render empty.toml", &["empty.toml", "camera"]);
}

#[test]
fn open_casters_of_scenes_are_refused_with_the_remedy() {
    let folder = Folder::new("open");
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write(
        "s.toml",
        "[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n[[lights]]\n\
         shape.point.position = [0, 5, 0]\n[[objects]]\nmesh.obj = \"open.obj\"\n",
    );
    for scene in ["s.toml", "open.obj --set open-casters=refuse"] {
        refused(
            &folder,
            &format!("render {scene} --size 32x32"),
            &["not closed", "--set open-casters=generalised"],
        );
    }
    folder
        .gnomon("render s.toml --size 32x32 --set open-casters=generalised")
        .fine();
}

/// A model named on the command line casts by its generalised silhouette, and says so.
#[test]
fn open_models_are_drawn_with_a_warning() {
    let folder = Folder::new("open-model");
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0.2\nf 1 2 3\n");
    for technique in ["shadow-volumes", "soft-shadow-volumes", "penumbra-wedges"] {
        let draw = |more: &str| {
            let line =
                format!("render open.obj --technique {technique} --size 64x48 --json {more}");
            folder.gnomon(&line).json()
        };
        let [plain, asked] = ["", "--set open-casters=generalised"].map(draw);
        assert_eq!(plain["hash"], asked["hash"], "{technique}");
        let warning = &plain["warnings"][0];
        assert_eq!(warning["code"], "open-mesh");
        let message = warning["message"].as_str().unwrap();
        assert!(message.contains("generalised silhouette"), "{message}");
    }
    let compare = "compare open.obj --techniques shadow-volumes,unshadowed --size 64x48 --json";
    let document = folder.gnomon(compare).json();
    let umbra = |k: usize| document["results"][k]["rmse_umbra"].as_f64().unwrap();
    assert_eq!(
        [umbra(0), umbra(1)],
        [0.0, 1.0],
        "it has a shadow, all of it"
    );
}

#[test]
fn targets_that_cannot_be_written_leave_nothing() {
    let folder = Folder::new("targets");
    folder.write("file", "x");
    std::fs::create_dir(folder.path("folder.png")).unwrap();
    let render = "render cylinder --size 16x16";
    refused(
        &folder,
        &format!("{render} --out picture.jpg"),
        &["picture.jpg", ".png"],
    );
    refused(
        &folder,
        &format!("{render} --out picture"),
        &["--out", ".png"],
    );
    refused(
        &folder,
        &format!("{render} --visibility v.png"),
        &["--visibility", ".npy"],
    );
    refused(
        &folder,
        &format!("{render} --out folder.png"),
        &["folder.png", "folder"],
    );
    refused(
        &folder,
        &format!("{render} --out file/a.png"),
        &["file/a.png", "not a folder"],
    );
    refused(
        &folder,
        &format!("{render} --out /proc/nowhere/a.png"),
        &["/proc/nowhere/a.png"],
    );
    // The picture could be written, the visibility cannot: neither is.
    refused(
        &folder,
        &format!("{render} --out new/a.png --visibility file/v.npy"),
        &["v.npy"],
    );
    refused(
        &folder,
        "demo --size 16x16 --out-dir file",
        &["not a folder"],
    );
}
