//! Traces on the command line: recorded, looked into, cut, compared; and refused.

use std::fs;

use crate::common::Folder;

fn recorded(name: &str, flags: &str) -> Folder {
    let folder = Folder::new(name);
    let command = format!("record parallel-plates --size 48x32 {flags} --out a.gnt");
    folder.gnomon(&command).fine();
    folder
}

#[test]
fn a_frame_is_recorded_told_of_and_replayed() {
    let folder = recorded("traces-replay", "");
    let info = folder.gnomon("info a.gnt --json").fine();
    let info: serde_json::Value = serde_json::from_str(&info.stdout()).unwrap();
    assert_eq!(info["scene"], "parallel-plates");
    let replayed = folder.gnomon("replay a.gnt --deep --out a.png").fine();
    assert!(replayed.stdout().contains("equal"), "{}", replayed.stdout());
    folder
        .gnomon("render parallel-plates --size 48x32 --out b.png")
        .fine();
    let [a, b] = ["a.png", "b.png"].map(|name| folder.pixels(name));
    assert_eq!(a, b, "the picture of a trace is the picture of its scene");
    let lines = folder.gnomon("dump a.gnt").fine().stdout();
    assert!(lines.lines().count() >= 3);
    for line in lines.lines() {
        serde_json::from_str::<serde_json::Value>(line).unwrap();
    }
}

#[test]
fn equal_frames_have_no_difference_and_others_exit_with_1() {
    let folder = recorded("traces-diff", "");
    let again = "record parallel-plates --size 48x32 --threads 1 --tile 16 --simd scalar";
    folder.gnomon(&format!("{again} --out b.gnt")).fine();
    let [a, b] = ["a.gnt", "b.gnt"].map(|name| fs::read(folder.path(name)).unwrap());
    assert_eq!(a, b, "a file does not depend on how it was made");
    folder.gnomon("diff a.gnt b.gnt").fine();
    folder
        .gnomon(&format!("{again} --set method=zfail --out c.gnt"))
        .fine();
    let different = folder.gnomon("diff a.gnt c.gnt --json");
    assert_eq!(different.code(), 1);
    let document: serde_json::Value = serde_json::from_str(&different.stdout()).unwrap();
    assert_eq!(document["equal"], false);
    assert_eq!(document["made"][0]["name"], "method");
    assert!(!document["states"].as_array().unwrap().is_empty());
    // Both ways of counting leave the same stencil, though not by the same blocks.
    assert!(document["first"].is_null());
}

/// The eye is in shadow: z-pass counts wrong, z-fail right.
fn wrong_and_right(name: &str) -> Folder {
    let folder = Folder::new(name);
    for method in ["zpass", "zfail"] {
        let scene = "record adversarial-eye-in-shadow --size 40x25";
        let command = format!("{scene} --set method={method} --out {method}.gnt");
        folder.gnomon(&command).fine();
    }
    folder
}

#[test]
fn the_first_pixel_that_differs_has_a_history_in_both() {
    let folder = wrong_and_right("traces-histories");
    let different = folder.gnomon("diff zpass.gnt zfail.gnt --json");
    assert_eq!(different.code(), 1);
    let document: serde_json::Value = serde_json::from_str(&different.stdout()).unwrap();
    let first = &document["first"]["attachments"][0];
    let histories = document["histories"].as_array().unwrap();
    for history in histories {
        assert_eq!(history["pixel"], first["first"]);
        assert!(!history["events"].as_array().unwrap().is_empty());
    }
    assert_ne!(histories[0]["events"], histories[1]["events"]);
    let text = folder.gnomon("diff zpass.gnt zfail.gnt").stdout();
    for name in ["zpass.gnt", "zfail.gnt"] {
        assert!(text.contains(&format!("in {name}: pixel (")), "{text}");
    }
}

#[test]
fn the_cause_of_a_difference_is_told() {
    let folder = wrong_and_right("traces-bisect");
    let equal = folder.gnomon("bisect zpass.gnt zpass.gnt");
    equal.refused(&["same bits"]);
    let found = folder.gnomon("bisect zpass.gnt zfail.gnt --json").fine();
    let document: serde_json::Value = serde_json::from_str(&found.stdout()).unwrap();
    assert_eq!(document["aspect"], "color");
    assert_ne!(document["shown"][0], document["shown"][1]);
    let causes = document["cause"].as_array().unwrap().len() as u64;
    assert!(causes > 0 && causes < document["of"].as_u64().unwrap());
    assert!(document["replays"].as_u64().unwrap() > 2);
}

/// Numbers of an array of bytes or 32-bit integers, and its shape.
fn array(bytes: &[u8]) -> (String, &[u8]) {
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = String::from_utf8(bytes[10..10 + length].to_vec()).unwrap();
    (header, &bytes[10 + length..])
}

#[test]
fn images_and_buffers_are_written_as_they_are_stored() {
    let folder = recorded("traces-dump", "");
    folder
        .gnomon("dump a.gnt --images images --buffers buffers")
        .fine();
    let read = |name: &str| fs::read(folder.path(name)).unwrap();
    let names = fs::read_dir(folder.path("images")).unwrap();
    let names: Vec<String> = names
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    let depth = names
        .iter()
        .find(|n| n.ends_with("last-depth.npy"))
        .unwrap();
    let before = depth.replace("last", "first");
    let stencil = depth.replace("depth", "stencil");
    let [first, last] = [before.as_str(), depth].map(|n| read(&format!("images/{n}")));
    let (header, numbers) = array(&last);
    assert!(
        header.contains("'<u4'") && header.contains("(32, 48)"),
        "{header}"
    );
    assert_eq!(numbers.len(), 32 * 48 * 4);
    assert_ne!(first, last, "the frame draws");
    let stencil = read(&format!("images/{stencil}"));
    let (header, _) = array(&stencil);
    assert!(header.contains("'|u1'"), "{header}");
    // The picture is that of `render`.
    folder
        .gnomon("render parallel-plates --size 48x32 --out b.png")
        .fine();
    let shown = names.iter().filter(|n| n.ends_with("last.png"));
    let same = shown.filter(|n| folder.pixels(&format!("images/{n}")) == folder.pixels("b.png"));
    assert_eq!(same.count(), 1);
    assert!(folder.path("buffers/pass-0-draw-0-vertices.bin").exists());
}

#[test]
fn a_trimmed_trace_replays() {
    let folder = recorded("traces-trim", "");
    folder.gnomon("trim a.gnt --passes 0..1 --out b.gnt").fine();
    folder.gnomon("replay b.gnt").fine();
    folder
        .gnomon("trim a.gnt --passes 7..9 --out c.gnt")
        .refused(&["7..9"]);
    assert!(!folder.path("c.gnt").exists());
}

#[test]
fn what_is_no_trace_is_refused_by_every_verb() {
    let folder = recorded("traces-bad", "");
    let whole = fs::read(folder.path("a.gnt")).unwrap();
    fs::write(folder.path("text.gnt"), "[scene]\n").unwrap();
    fs::write(folder.path("cut.gnt"), &whole[..400]).unwrap();
    let mut flipped = whole.clone();
    flipped[200] ^= 4;
    fs::write(folder.path("flipped.gnt"), flipped).unwrap();
    for verb in ["replay", "info", "dump", "report"] {
        let out = if verb == "report" { "--out r.html" } else { "" };
        let run = |file: &str| folder.gnomon(&format!("{verb} {file} {out}"));
        run("none.gnt").refused(&["none.gnt"]);
        run("text.gnt").refused(&["text.gnt", "89 47 4E 54"]);
        run("flipped.gnt").refused(&["flipped.gnt", "byte"]);
    }
    folder
        .gnomon("replay cut.gnt")
        .refused(&["FRAM", "byte 400"]);
    // What lies before a cut is there, and what is lost is told.
    fs::write(folder.path("short.gnt"), &whole[..whole.len() - 20]).unwrap();
    let short = folder.gnomon("replay short.gnt").fine();
    assert!(short.stdout().contains("lost"), "{}", short.stdout());
    folder.gnomon("diff a.gnt text.gnt").refused(&["text.gnt"]);
    folder
        .gnomon("replay a.gnt --frame 3")
        .refused(&["frame 3"]);
    folder
        .gnomon("pixel a.gnt 48 0")
        .refused(&["(48, 0)", "0 to 47"]);
    folder
        .gnomon("traffic a.gnt --profile nothing")
        .refused(&["nothing", "imr-2008"]);
}
