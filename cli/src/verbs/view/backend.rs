//! Cells on a terminal, by `crossterm`.

use std::io::{self, Write};

use crossterm::cursor::{Hide, MoveTo, Show};
use crossterm::queue;
use crossterm::style::{Attribute, Color as Ink, Colors, Print, SetAttribute, SetColors};
use crossterm::terminal::{Clear, ClearType as Part, size, window_size};
use ratatui_core::backend::{Backend, ClearType, WindowSize};
use ratatui_core::buffer::Cell;
use ratatui_core::layout::{Position, Size};
use ratatui_core::style::{Color, Modifier};

/// A terminal that is written to.
pub(super) struct Crossterm<W: Write>(pub(super) W);

impl<W: Write> Backend for Crossterm<W> {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        let mut next = None;
        let mut style = (Color::Reset, Color::Reset, Modifier::empty());
        queue!(self.0, SetAttribute(Attribute::Reset))?;
        for (x, y, cell) in content {
            if next != Some((x, y)) {
                queue!(self.0, MoveTo(x, y))?;
            }
            // Symbols of the viewer are one column wide.
            next = Some((x + 1, y));
            if style.2 != cell.modifier {
                set_modifier(&mut self.0, cell.modifier)?;
                style = (Color::Reset, Color::Reset, cell.modifier);
            }
            if (style.0, style.1) != (cell.fg, cell.bg) {
                queue!(self.0, SetColors(Colors::new(ink(cell.fg), ink(cell.bg))))?;
                style = (cell.fg, cell.bg, cell.modifier);
            }
            queue!(self.0, Print(cell.symbol()))?;
        }
        queue!(self.0, SetAttribute(Attribute::Reset))
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        queue!(self.0, Hide)
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        queue!(self.0, Show)
    }

    /// Terminals need not answer where the cursor is, and nobody needs to know: it is hidden
    /// on a screen that is the viewer's alone.
    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(Position::ORIGIN)
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        let Position { x, y } = position.into();
        queue!(self.0, MoveTo(x, y))
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, part: ClearType) -> io::Result<()> {
        let part = match part {
            ClearType::All => Part::All,
            ClearType::AfterCursor => Part::FromCursorDown,
            ClearType::BeforeCursor => Part::FromCursorUp,
            ClearType::CurrentLine => Part::CurrentLine,
            ClearType::UntilNewLine => Part::UntilNewLine,
        };
        queue!(self.0, Clear(part))
    }

    fn size(&self) -> io::Result<Size> {
        size().map(Size::from)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        let found = window_size()?;
        Ok(WindowSize {
            columns_rows: Size::new(found.columns, found.rows),
            pixels: Size::new(found.width, found.height),
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// Those that the viewer uses.
fn set_modifier(out: &mut impl Write, modifier: Modifier) -> io::Result<()> {
    queue!(out, SetAttribute(Attribute::Reset))?;
    let known = [
        (Modifier::BOLD, Attribute::Bold),
        (Modifier::DIM, Attribute::Dim),
        (Modifier::REVERSED, Attribute::Reverse),
    ];
    for (wanted, attribute) in known {
        if modifier.contains(wanted) {
            queue!(out, SetAttribute(attribute))?;
        }
    }
    Ok(())
}

fn ink(color: Color) -> Ink {
    match color {
        Color::Reset => Ink::Reset,
        Color::Black => Ink::Black,
        Color::Red => Ink::DarkRed,
        Color::Green => Ink::DarkGreen,
        Color::Yellow => Ink::DarkYellow,
        Color::Blue => Ink::DarkBlue,
        Color::Magenta => Ink::DarkMagenta,
        Color::Cyan => Ink::DarkCyan,
        Color::Gray => Ink::Grey,
        Color::DarkGray => Ink::DarkGrey,
        Color::LightRed => Ink::Red,
        Color::LightGreen => Ink::Green,
        Color::LightYellow => Ink::Yellow,
        Color::LightBlue => Ink::Blue,
        Color::LightMagenta => Ink::Magenta,
        Color::LightCyan => Ink::Cyan,
        Color::White => Ink::White,
        Color::Rgb(r, g, b) => Ink::Rgb { r, g, b },
        Color::Indexed(i) => Ink::AnsiValue(i),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is sent for two cells side by side and one elsewhere.
    #[test]
    fn colors_are_sent_when_they_change_and_places_when_they_do_not_follow() {
        crossterm::style::force_color_output(true);
        let cell = |symbol, fg, bg| {
            let mut cell = Cell::new(symbol);
            cell.set_fg(fg).set_bg(bg);
            cell
        };
        let red = cell("▀", Color::Rgb(255, 0, 1), Color::Rgb(2, 3, 4));
        let indexed = cell("x", Color::Indexed(196), Color::Reset);
        let mut terminal = Crossterm(Vec::new());
        let cells = [(2, 1, &red), (3, 1, &red), (7, 1, &indexed)];
        terminal.draw(cells.into_iter()).unwrap();
        let sent = String::from_utf8(terminal.0).unwrap();
        assert_eq!(
            sent,
            "\u{1b}[0m\u{1b}[2;3H\u{1b}[38;2;255;0;1;48;2;2;3;4m▀▀\
             \u{1b}[2;8H\u{1b}[38;5;196;49mx\u{1b}[0m"
        );
    }
}
