//! Text over the picture: boxes, and lines that are no wider than the screen.

use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::style::{Color, Modifier, Style};

/// Text on a dark ground, whatever the terminal's own colours are.
const STYLE: Style = Style::new()
    .fg(Color::Indexed(252))
    .bg(Color::Indexed(235))
    .remove_modifier(Modifier::all());

/// Fills `area` with `lines`; what does not fit is left out.
pub(super) fn draw_box(buffer: &mut Buffer, area: Rect, lines: &[String]) {
    let area = area.intersection(buffer.area);
    for row in 0..area.height {
        let (y, width) = (area.y + row, usize::from(area.width));
        let line = lines.get(usize::from(row)).map_or("", String::as_str);
        let line: String = line.chars().map(plain).collect();
        buffer.set_stringn(area.x, y, format!("{line:width$}"), width, STYLE);
    }
}

/// Names come from files; what moves the cursor must not reach the terminal.
fn plain(c: char) -> char {
    match c.is_control() {
        true => '\u{fffd}',
        false => c,
    }
}

/// `text` in lines of at most `width` characters, broken between words where that goes.
pub(super) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let width = width.max(1);
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let mut rest: Vec<char> = word.chars().collect();
        let used = lines.last().map_or(0, |l| l.chars().count());
        if used > 0 && used + 1 + rest.len() > width {
            lines.push(String::new());
        } else if used > 0 {
            push(&mut lines, " ");
        }
        loop {
            let used = lines.last().map_or(0, |l| l.chars().count());
            let room = (width - used.min(width)).min(rest.len());
            let tail = rest.split_off(room);
            push(&mut lines, &rest.iter().collect::<String>());
            rest = tail;
            if rest.is_empty() {
                break;
            }
            lines.push(String::new());
        }
    }
    lines
}

fn push(lines: &mut [String], text: &str) {
    if let Some(last) = lines.last_mut() {
        last.push_str(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words_and_words_where_they_must() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("a longword b", 4), ["a", "long", "word", "b"]);
        assert_eq!(wrapped("", 5), [""]);
        assert_eq!(wrapped("ab", 0), ["a", "b"]);
        let long = wrapped(&"word ".repeat(50), 11);
        assert!(long.iter().all(|l| l.chars().count() <= 11));
    }

    #[test]
    fn boxes_are_filled_and_clipped() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 6, 3));
        let lines = ["a\u{1b}b", "second line"].map(str::to_owned);
        draw_box(&mut buffer, Rect::new(2, 1, 9, 9), &lines);
        let row = |y| (0..6).map(|x| buffer[(x, y)].symbol()).collect::<String>();
        assert_eq!(
            [row(0), row(1), row(2)],
            ["      ", "  a\u{fffd}b ", "  seco"]
        );
        assert_eq!(buffer[(5, 1)].bg, Color::Indexed(235));
        assert_eq!(buffer[(1, 1)].bg, Color::Reset);
    }
}
