//! What is asked for, and what becomes of it.

use std::sync::Barrier;
use std::thread::scope;

use super::{Bench, step};
use crate::overlay::OverlayKind;
use crate::verbs::view::event::{Action, Effect, Event, Saved};
use crate::verbs::view::look::Look;
use crate::verbs::view::save::save;
use crate::verbs::view::state::Mode;

const SCENE: &str = "cylinder --technique shadow-volumes";

/// The frame that is asked for.
fn wanted(effects: &[Effect]) -> Look {
    match effects {
        [Effect::Draw(look)] => look.clone(),
        other => panic!("{other:?}"),
    }
}

/// The name of what is shown.
fn shown(bench: &Bench) -> &'static str {
    let drawn = bench.state.shown.as_ref().unwrap();
    assert_eq!(drawn.params.technique(), {
        bench.state.facts.techniques[drawn.look.technique].name
    });
    drawn.params.technique()
}

#[test]
fn the_eye_goes_where_the_arrows_and_the_mouse_say() {
    let mut bench = Bench::started(SCENE, [20, 12]);
    let home = bench.state.facts.home;
    let right = (home.target - home.eye).cross(home.up);
    let eye = |effects: Vec<Effect>| wanted(&effects).pose.unwrap().eye - home.eye;
    let to_the_right = eye(bench.ask(step(1, 0)));
    assert!(to_the_right.dot(right) > 0.0);
    bench.press(Action::Home);
    assert_eq!(bench.state.look.pose, None);
    let upwards = eye(bench.ask(step(0, -1)));
    assert!(upwards.dot(home.up) > 0.0);
    bench.press(Action::Home);
    // The scene follows the mouse: the eye goes the other way.
    let drag = Action::Drag {
        by: [3, 0],
        to: [5, 5],
    };
    assert!(eye(bench.ask(drag)).dot(right) < 0.0);
    bench.press(Action::Home);
    let closer = wanted(&bench.ask(Action::Zoom(1))).pose.unwrap();
    assert!((closer.eye - closer.target).length() < (home.eye - home.target).length());
}

#[test]
fn a_frame_of_another_technique_comes_too_late() {
    let mut bench = Bench::started(SCENE, [20, 12]);
    assert_eq!(shown(&bench), "shadow-volumes");
    let moved = bench.ask(step(1, 0));
    let switched = bench.ask(Action::Technique(1));
    let next = bench.state.facts.techniques[wanted(&switched).technique].name;
    assert_ne!(next, "shadow-volumes");
    let before = bench.state.shown.as_ref().unwrap().look.clone();
    bench.answer(moved);
    let after = &bench.state.shown.as_ref().unwrap().look;
    assert_eq!(*after, before, "the old technique's frame is not shown");
    bench.answer(switched);
    assert_eq!(shown(&bench), next);
    assert!(bench.state.is_settled());
    bench.press(Action::Technique(-1));
    assert_eq!(shown(&bench), "shadow-volumes");
}

#[test]
fn techniques_that_do_not_take_the_light_are_passed_over() {
    let line = "cylinder --technique shadow-volumes --light directional:1,4,2";
    let mut bench = Bench::new(line, [20, 12]);
    let count = bench.state.facts.techniques.len();
    let mut seen = Vec::new();
    for _ in 0..count {
        let facts = &bench.state.facts.techniques[bench.state.look.technique];
        assert_eq!(facts.takes, [true], "{}", facts.name);
        seen.push(facts.name);
        bench.ask(Action::Technique(1));
    }
    let known = bench.state.facts.techniques.iter().filter(|t| t.takes[0]);
    assert!(known.clone().count() < count, "some do not take it");
    assert!(known.into_iter().all(|t| seen.contains(&t.name)));
}

#[test]
fn lights_shine_alone_one_after_the_other() {
    let lights = "--light point:1,4,2 --light point:-1,4,2";
    let line = format!("cylinder --technique shadow-volumes {lights}");
    let mut bench = Bench::started(&line, [20, 12]);
    let hash = |bench: &Bench| bench.state.shown.as_ref().unwrap().done.color_hash();
    let mut hashes = vec![hash(&bench)];
    for light in [Some(0), Some(1)] {
        bench.press(Action::Light);
        assert_eq!(bench.state.look.light, light);
        hashes.push(hash(&bench));
    }
    bench.press(Action::Light);
    assert_eq!(
        (bench.state.look.light, hash(&bench)),
        (None, hashes[0].clone())
    );
    hashes.dedup();
    assert_eq!(hashes.len(), 3);
    let mut single = Bench::started(SCENE, [50, 12]);
    assert_eq!(single.ask(Action::Light), []);
    assert!(single.text().concat().contains("no other light"));
}

#[test]
fn overlays_follow_one_another_where_there_are_any() {
    let mut bench = Bench::started("cylinder --technique soft-shadow-volumes", [20, 12]);
    let plain = bench.state.shown.as_ref().unwrap().picture.clone();
    let mut seen = Vec::new();
    loop {
        bench.press(Action::Overlay(1));
        let Some(kind) = bench.state.look.overlay else {
            break;
        };
        let drawn = bench.state.shown.as_ref().unwrap();
        assert_eq!(drawn.look.overlay, Some(kind));
        assert_eq!(
            drawn.picture.size, plain.size,
            "{kind:?}: without its legend"
        );
        seen.push(kind);
    }
    assert!(seen.contains(&OverlayKind::Wedges) && !seen.contains(&OverlayKind::EnvLights));
    assert!(seen.len() > 6, "{seen:?}");
    assert_eq!(bench.state.shown.as_ref().unwrap().picture, plain);
    bench.press(Action::Overlay(-1));
    assert_eq!(bench.state.look.overlay, seen.last().copied());
    // What a technique does not have goes with it.
    bench.state.look.overlay = Some(OverlayKind::Wedges);
    let wedges = |b: &Bench| b.state.facts.techniques[b.state.look.technique].has_wedges;
    while wedges(&bench) {
        bench.ask(Action::Technique(1));
    }
    assert_eq!(bench.state.look.overlay, None);
}

#[test]
fn drafts_stand_for_frames_that_take_long_until_nobody_moves() {
    let mut bench = Bench::started(SCENE, [60, 12]);
    bench.state.shown.as_mut().unwrap().ms = 100.0;
    let effects = bench.ask(step(1, 0));
    assert_eq!(wanted(&effects).size, [30, 10]);
    bench.answer(effects);
    assert!(!bench.state.is_settled());
    assert!(
        bench.text()[10].contains("30x10 draft"),
        "{:?}",
        bench.text()[10]
    );
    let rest = bench.state.update(Event::Rest);
    assert_eq!(wanted(&rest), bench.state.look);
    bench.answer(rest);
    assert!(bench.state.is_settled());
    assert_eq!(bench.state.update(Event::Rest), []);
    // Quick frames are drawn whole at once.
    bench.state.shown.as_mut().unwrap().ms = 1.0;
    assert_eq!(wanted(&bench.ask(step(1, 0))).size, [60, 20]);
}

#[test]
fn what_is_written_is_the_whole_frame_that_is_looked_at() {
    let mut bench = Bench::started(SCENE, [20, 12]);
    let home = bench.state.look.clone();
    assert_eq!(bench.ask(Action::Save), [Effect::Save(home)]);
    bench.state.shown.as_mut().unwrap().ms = 100.0;
    let draft = bench.ask(step(1, 0));
    assert_ne!(wanted(&draft).size, bench.state.look.size);
    let there = bench.state.look.clone();
    assert_eq!(bench.ask(Action::Save), [Effect::Save(there)]);
    assert!(bench.state.notice[0].contains("drawing"));
    // Whoever goes on keeps what was looked at, and is awaited.
    bench.press(step(1, 0));
    assert_eq!(bench.state.saving, 2);
    let saved = |bench: &mut Bench, result| bench.state.update(Event::Saved(result));
    let written = Saved {
        path: "a.png".into(),
        command: "gnomon".into(),
    };
    assert_eq!(saved(&mut bench, Ok(written.clone())), []);
    assert_eq!(saved(&mut bench, Err("full".into())), []);
    assert_eq!(
        (bench.state.saving, &bench.state.saved[..]),
        (0, &[written][..])
    );
    assert_eq!(bench.state.notice, ["full"]);
}

/// A frame that a thread draws is written though the viewer has gone on, under names of
/// which none is taken.
#[test]
fn nothing_that_is_there_is_written_over() {
    let mut bench = Bench::started("cylinder --technique soft-shadow-volumes", [20, 12]);
    bench.press(Action::Overlay(1));
    let kind = bench.state.look.overlay.unwrap().name();
    let drawn = bench.state.shown.take().unwrap();
    let folder = std::env::temp_dir().join(format!("gnomon-view-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let name = |n: u32| format!("cylinder-soft-shadow-volumes-view-{n}");
    let theirs = folder.join(format!("{}-{kind}.png", name(1)));
    std::fs::write(&theirs, b"theirs").unwrap();
    let path = save(&bench.studio, &drawn, &folder).unwrap().path;
    assert_eq!(path, folder.join(format!("{}.png", name(2))));
    assert!(folder.join(format!("{}-{kind}.png", name(2))).exists());
    assert_eq!(std::fs::read(&theirs).unwrap(), b"theirs");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// The viewer and the thread that draws may write at once.
#[test]
fn pictures_that_are_written_at_once_have_names_of_their_own() {
    const WRITERS: usize = 4;
    let bench = Bench::started(SCENE, [20, 12]);
    let (studio, look) = (&bench.studio, &bench.state.look);
    let name = format!("gnomon-view-at-once-{}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let together = Barrier::new(WRITERS);
    let write = || {
        let drawn = studio.draw(look).unwrap();
        together.wait();
        save(studio, &drawn, &folder).unwrap().path
    };
    let mut paths: Vec<_> = scope(|s| {
        let writers: Vec<_> = (0..WRITERS).map(|_| s.spawn(write)).collect();
        writers.into_iter().map(|w| w.join().unwrap()).collect()
    });
    paths.sort();
    paths.dedup();
    assert_eq!(paths.len(), WRITERS);
    assert!(paths.iter().all(|p| p.exists()));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn modes_are_left_one_after_the_other() {
    let mut bench = Bench::started(SCENE, [90, 12]);
    assert_eq!(
        bench.ask(Action::Tell),
        [],
        "without a pixel there is no history"
    );
    bench.press(Action::Cursor);
    bench.press(Action::Tell);
    let Mode::History(page) = &bench.state.mode else {
        panic!("{:?}", bench.state.mode);
    };
    assert!(
        page.lines[0].starts_with("pixel (45, 10) of frame 0"),
        "{page:?}"
    );
    let first = bench.text();
    bench.press(step(2, 1));
    assert_ne!(bench.text(), first);
    bench.press(Action::Back);
    assert_eq!(bench.state.mode, Mode::Cursor);
    bench.press(Action::Back);
    assert_eq!(bench.state.mode, Mode::Orbit);
    assert_eq!(bench.ask(Action::Back), [Effect::Quit]);
    assert_eq!(bench.ask(Action::Quit), [Effect::Quit]);
}
