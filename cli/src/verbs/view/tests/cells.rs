//! What is on the screen.

use ratatui_core::style::Color;

use super::{Bench, step};
use crate::verbs::view::event::Action;

const SCENE: &str = "cylinder --technique shadow-volumes";

#[test]
fn cells_hold_two_pixels_of_the_frame_each() {
    let bench = Bench::started(SCENE, [24, 14]);
    let (cells, drawn) = (bench.cells(), bench.state.shown.as_ref().unwrap());
    assert_eq!(drawn.done.size, [24, 24]);
    let color = |x: usize, y: usize| {
        let [r, g, b, _] = drawn.done.srgb[24 * y + x];
        Color::Rgb(r, g, b)
    };
    for y in 0..12 {
        for x in 0..24 {
            let cell = &cells[(x, y)];
            let [column, row] = [usize::from(x), usize::from(y)];
            assert_eq!(cell.symbol(), "▀");
            assert_eq!(cell.fg, color(column, 2 * row), "{x} {y}");
            assert_eq!(cell.bg, color(column, 2 * row + 1), "{x} {y}");
        }
    }
}

#[test]
fn the_status_says_what_is_shown_and_what_is_being_drawn() {
    let mut bench = Bench::started(SCENE, [100, 12]);
    let status = bench.text()[10].clone();
    for part in ["shadow-volumes  cylinder  100x20  ", " ms", "B"] {
        assert!(status.contains(part), "{status}");
    }
    assert!(!status.contains("drawing"), "{status}");
    bench.ask(Action::Technique(1));
    let next = bench.state.facts.techniques[bench.state.look.technique].name;
    let status = bench.text()[10].clone();
    assert!(status.starts_with("shadow-volumes  cylinder"), "{status}");
    assert!(
        status.contains(&format!("drawing {next}: 1.0 s")),
        "{status}"
    );
}

#[test]
fn every_size_of_terminal_is_drawn_on() {
    let mut bench = Bench::started(SCENE, [1, 1]);
    for cells in [[0, 0], [1, 2], [1, 3], [2, 40], [200, 3], [33, 17], [1, 1]] {
        bench.press(Action::Resize(cells));
        bench.cells();
        for action in [Action::Cursor, Action::Tell, Action::Help, Action::Help] {
            bench.press(action);
            bench.cells();
        }
        bench.press(step(3, 3));
    }
    bench.press(Action::Resize([30, 12]));
    assert_eq!(bench.state.shown.as_ref().unwrap().done.size, [30, 20]);
}

#[test]
fn the_cursor_is_pointed_at_and_its_pixel_stays() {
    let mut bench = Bench::started(SCENE, [40, 22]);
    let before = bench.cells();
    bench.press(Action::Cursor);
    let place = |bench: &Bench| bench.state.cursor;
    assert_eq!(place(&bench), [20, 20]);
    for action in [step(-12, 0), step(0, 9)] {
        bench.press(action);
    }
    assert_eq!(place(&bench), [8, 29]);
    let after = bench.cells();
    // Pixel (8, 29) is the lower half of row 14; (10, 29) is marked, (8, 31) too.
    assert_eq!(after[(8, 14)].bg, before[(8, 14)].bg);
    assert_ne!(after[(10, 14)].bg, before[(10, 14)].bg);
    assert_ne!(after[(8, 15)].bg, before[(8, 15)].bg);
    assert_eq!(after[(10, 15)].bg, before[(10, 15)].bg);
    // The box is where the pixel is not.
    let text = bench.text();
    assert!(text[0].starts_with("▀▀▀▀▀▀pixel 8, 29"), "{}", text[0]);
    bench.press(Action::Press([39, 3]));
    assert_eq!(place(&bench), [39, 6]);
    assert!(bench.text()[0].starts_with("pixel 39, 6"));
    bench.press(step(100, -100));
    assert_eq!(place(&bench), [39, 0]);
}

#[test]
fn errors_are_said_in_place_of_the_picture() {
    // Nothing may say anything by control characters.
    let mut bench = Bench::started("cylinder --technique shadow-volumes:light=7", [60, 12]);
    assert!(bench.state.shown.is_none());
    let text = bench.text().concat();
    assert!(text.contains("light"), "{text}");
    bench.press(Action::Help);
    let text = bench.text().concat();
    assert!(
        text.contains("the next technique, and the one before"),
        "{text}"
    );
}
