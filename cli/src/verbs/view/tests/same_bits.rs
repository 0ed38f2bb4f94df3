//! Frames are those of `render`, and what is said of pixels is what `pixel` says.

use std::ffi::OsString;
use std::fs;
use std::path::PathBuf;

use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::{Registry, find};
use gnomon_raster::{Format, GpuConfig, format};
use gnomon_traces::history::{self, HistoryOptions, Value};

use super::{Bench, step};
use crate::verbs::view::event::{Action, Event};
use crate::verbs::view::panel;
use crate::verbs::view::save::save;

/// A folder that is gone at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let name = format!("gnomon-view-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Writes what is shown twice: by the viewer, and by the line that it prints.
fn written(bench: &Bench, name: &str) -> [Vec<u8>; 2] {
    let folder = Scratch::new(name);
    let drawn = bench.state.shown.as_ref().unwrap();
    let saved = save(&bench.studio, drawn, &folder.0).unwrap();
    let ours = fs::read(&saved.path).unwrap();
    fs::remove_file(&saved.path).unwrap();
    let words: Vec<&str> = saved.command.split(' ').collect();
    assert!(!saved.command.contains('\''), "{}", saved.command);
    let words = words.into_iter().chain(["--quiet"]).map(OsString::from);
    crate::run_with(&Registry::built_in(), words);
    let theirs = fs::read(&saved.path);
    [
        ours,
        theirs.unwrap_or_else(|e| panic!("{e}: {}", saved.command)),
    ]
}

#[test]
fn the_line_that_is_printed_makes_the_same_file() {
    let moves = || vec![step(1, 0), step(2, -1), Action::Zoom(3)];
    let lit = vec![
        Action::Light,
        Action::Light,
        Action::Technique(1),
        step(0, -2),
    ];
    let overlaid = vec![Action::Overlay(2), step(1, 1)];
    let pcss = "cylinder --technique pcss:samples=16 --set map-size=64";
    let lights = "cylinder --light square:0.5,4,1,0.7:1,0.5,0.25 --light point:1,3,-2";
    let sky = "cylinder --env sky --lights 2 --env-turn -30.5 --env-ambient even";
    for (name, line, actions) in [
        ("plain", "cylinder", Vec::new()),
        ("moved", pcss, moves()),
        (
            "aimed",
            "demo --eye 3,2.5,4 --fov 30 --technique shadow-map",
            moves(),
        ),
        ("light", lights, lit),
        ("sky", sky, moves()),
        ("time", "walk --time 0.75 --no-skip --size 31x20", moves()),
        ("overlay", "cylinder --technique shadow-volumes", overlaid),
    ] {
        let mut bench = Bench::started(line, [32, 18]);
        for action in actions {
            bench.press(action);
        }
        let rest = bench.state.update(Event::Rest);
        bench.answer(rest);
        assert!(bench.state.is_settled(), "{name}: {:?}", bench.state.notice);
        let [ours, theirs] = written(&bench, name);
        assert!(ours == theirs, "{name}");
    }
}

#[test]
fn names_are_not_taken_twice() {
    let folder = Scratch::new("names");
    let bench = Bench::started("cylinder --technique shadow-volumes", [8, 6]);
    let drawn = bench.state.shown.as_ref().unwrap();
    let names = [1, 2].map(|n| {
        folder
            .0
            .join(format!("cylinder-shadow-volumes-view-{n}.png"))
    });
    for name in &names {
        assert_eq!(save(&bench.studio, drawn, &folder.0).unwrap().path, *name);
    }
    assert_eq!(fs::read(&names[0]).unwrap(), fs::read(&names[1]).unwrap());
}

#[test]
fn the_panel_says_what_the_pixels_history_ends_with() {
    let mut bench = Bench::started("cylinder --technique shadow-volumes", [40, 14]);
    bench.press(step(3, -1));
    bench.press(Action::Cursor);
    let drawn = bench.state.shown.as_ref().unwrap();
    let technique = find("shadow-volumes").unwrap();
    let params = Params::defaults(technique);
    let frame = technique.frame(&drawn.scene, [40, 24], &params).unwrap();
    let options = HistoryOptions {
        config: GpuConfig::default(),
        image: None,
    };
    let mut different = 0;
    for pixel in [
        [5, 3],
        [3, 5],
        [20, 12],
        [12, 20],
        [25, 9],
        [9, 22],
        [39, 23],
    ] {
        let told = history::pixel(&frame.recording, &options, pixel).unwrap();
        let mut wanted = Vec::new();
        for (attachment, value) in told.attachments.iter().zip(&told.last) {
            match value {
                Value::Color(raw) => {
                    assert_eq!(attachment.format, Format::Rgba16Float);
                    let channel = |c: usize| format::f32_from_f16(raw[c] as u16).to_string();
                    wanted.extend([0, 1, 2].map(|c| format!("           {}", channel(c))));
                    wanted[0] = format!("  linear   {}", channel(0));
                }
                Value::DepthStencil(depth, stencil) => {
                    wanted.push(format!("depth      {}", format::f32_from_d24(*depth)));
                    wanted.push(format!("stencil    {stencil}"));
                }
            }
        }
        let lines = panel::lines(drawn, pixel);
        assert_eq!(lines[0], format!("pixel {}, {}", pixel[0], pixel[1]));
        for line in &wanted {
            assert!(lines.contains(line), "{pixel:?}: no `{line}` in {lines:?}");
        }
        assert_eq!(wanted.len(), 5, "{told:?}");
        different += usize::from(lines[1..] != panel::lines(drawn, [pixel[1], pixel[0]])[1..]);
    }
    assert!(different >= 3, "columns and rows are told apart");
    // What is shown under Enter is the text of `pixel`.
    let [x, y] = bench.state.cursor;
    let told = history::pixel(&frame.recording, &options, [x, y]).unwrap();
    let text = crate::verbs::pixel::text(&told, 0);
    let lines = bench.studio.history(&bench.state.look, [x, y]).unwrap();
    assert_eq!(lines.join("\n"), text.trim_end());
}
