//! The state as cells.

use std::time::Duration;

use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;

use super::blocks::{self, Palette};
use super::fit::{Fit, scaled};
use super::keys::KEYS;
use super::panel;
use super::state::{Mode, STATUS, State};
use super::studio::Drawn;
use super::text::{draw_box, wrapped};
use crate::output::{numbers, tables};

/// Columns of the box about a pixel.
const PANEL: u16 = 34;
/// Time after which it is said that a frame is being drawn.
const PATIENCE: Duration = Duration::from_millis(150);

/// Draws everything; `waited` is how long the frame that is asked for has been.
pub(super) fn draw(state: &State, waited: Duration, palette: Palette, buffer: &mut Buffer) {
    let [width, height] = state.room();
    let room = Rect::new(0, 0, width, height);
    if let Some(drawn) = &state.shown {
        draw_picture(state, drawn, palette, room, buffer);
    }
    match &state.mode {
        Mode::Help => draw_box(buffer, room, &help()),
        Mode::History(page) => {
            let lines = page.lines.iter().skip(page.at[1]);
            let lines = lines.map(|l| l.chars().skip(page.at[0]).collect());
            draw_box(buffer, room, &lines.collect::<Vec<String>>());
        }
        Mode::Cursor => draw_panel(state, room, buffer),
        Mode::Orbit => {}
    }
    draw_notice(&state.notice, room, buffer);
    let status = Rect::new(0, height, width, STATUS.min(state.cells[1]));
    draw_box(
        buffer,
        status,
        &[told(state, waited), hint(state).to_owned()],
    );
}

fn draw_picture(state: &State, drawn: &Drawn, palette: Palette, room: Rect, buffer: &mut Buffer) {
    let Some(fit) = Fit::new(drawn.picture.size, [room.width, room.height]) else {
        return;
    };
    let mut points = scaled(&drawn.picture, fit.points);
    // A map has pixels of its own, which the cursor is not about.
    if state.mode == Mode::Cursor && drawn.picture.size == drawn.look.size {
        let of_look = Fit::new(state.look.size, [room.width, room.height]);
        if let Some(of_look) = of_look {
            mark(&mut points, fit.points, of_look.point(state.cursor));
        }
    }
    blocks::draw(buffer, room, fit.corner, (fit.points, &points), palette);
}

/// Four strokes that point at a pixel and leave it as it is.
fn mark(points: &mut [[u8; 3]], size: [u32; 2], [x, y]: [u32; 2]) {
    let strokes = (2..=4i64).flat_map(|d| [[d, 0], [-d, 0], [0, d], [0, -d]]);
    for [right, down] in strokes {
        let place = [i64::from(x) + right, i64::from(y) + down];
        let inside = |a: usize| (0..i64::from(size[a])).contains(&place[a]);
        if inside(0) && inside(1) {
            let at = (place[1] * i64::from(size[0]) + place[0]) as usize;
            let light = points[at].iter().map(|c| u32::from(*c)).sum::<u32>() > 384;
            points[at] = if light { [0; 3] } else { [255; 3] };
        }
    }
}

/// What the pixel holds, on the side where the pixel is not.
fn draw_panel(state: &State, room: Rect, buffer: &mut Buffer) {
    let lines = match &state.shown {
        Some(drawn) if drawn.look.size == state.look.size => panel::lines(drawn, state.cursor),
        _ => vec!["drawing".to_owned()],
    };
    let width = PANEL.min(room.width);
    let is_left = 2 * state.cursor[0] >= state.look.size[0];
    let x = if is_left { 0 } else { room.width - width };
    let height = (lines.len() as u16).min(room.height);
    draw_box(buffer, Rect::new(x, 0, width, height), &lines);
}

fn draw_notice(notice: &[String], room: Rect, buffer: &mut Buffer) {
    let lines = notice.iter();
    let lines: Vec<String> = lines
        .flat_map(|l| wrapped(l, usize::from(room.width)))
        .collect();
    let height = (lines.len().min(usize::from(room.height))) as u16;
    let area = Rect::new(0, room.height - height, room.width, height);
    draw_box(buffer, area, &lines);
}

/// What is shown, and what is being drawn.
fn told(state: &State, waited: Duration) -> String {
    let mut words = match &state.shown {
        Some(drawn) => shown(state, drawn),
        None => state.facts.scene.clone(),
    };
    if let Some(asked) = state.asked.as_ref().filter(|_| waited >= PATIENCE) {
        let name = state.facts.techniques[asked.technique].name;
        words += &format!("  drawing {name}: {:.1} s", waited.as_secs_f64());
    }
    words
}

fn shown(state: &State, drawn: &Drawn) -> String {
    let (look, done) = (&drawn.look, &drawn.done);
    let light = look
        .light
        .map(|l| format!("  light {l} of {}", state.facts.lights));
    let overlay = look.overlay.map(|k| format!("  {}", k.name()));
    format!(
        "{}  {}{}{}  {}x{}{}  {}  {}{}",
        state.facts.techniques[look.technique].name,
        state.facts.scene,
        light.unwrap_or_default(),
        overlay.unwrap_or_default(),
        look.size[0],
        look.size[1],
        if look.size == state.look.size {
            ""
        } else {
            " draft"
        },
        numbers::milliseconds(done.frame_ms),
        numbers::bytes(tables::frame_bytes(&done.report)),
        warnings(done.warnings.len()),
    )
}

fn warnings(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => "  1 warning (s, then render)".to_owned(),
        count => format!("  {count} warnings (s, then render)"),
    }
}

fn hint(state: &State) -> &'static str {
    match state.mode {
        Mode::Orbit => {
            "arrows round  + - closer  t technique  L light  o overlay  p pixel  s save  ? help  q quit"
        }
        Mode::Cursor => "arrows the pixel (Shift by 10)  Enter history  p back to the eye  q quit",
        Mode::History(_) => "arrows, Page keys scroll  Esc back  q quit",
        Mode::Help => "? back  q quit",
    }
}

fn help() -> Vec<String> {
    KEYS.iter()
        .map(|[keys, what]| format!(" {keys:16} {what}"))
        .collect()
}
