//! Points as characters: the upper half of a cell is the foreground of `▀`, the lower one its
//! background.

use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::style::Color;

const UPPER_HALF: &str = "▀";

/// The colours that a terminal has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Palette {
    /// 8 bits for each channel.
    True,
    /// The cube and the greys of xterm.
    Indexed,
}

impl Palette {
    /// As the terminal says it.
    pub(super) fn of_terminal() -> Self {
        Self::of(&std::env::var("COLORTERM").unwrap_or_default())
    }

    fn of(colorterm: &str) -> Self {
        match colorterm.to_ascii_lowercase().as_str() {
            "truecolor" | "24bit" => Self::True,
            _ => Self::Indexed,
        }
    }

    /// The colour, or the nearest one that there is.
    pub(super) fn color(self, [r, g, b]: [u8; 3]) -> Color {
        match self {
            Self::True => Color::Rgb(r, g, b),
            Self::Indexed => Color::Indexed(nearest([r, g, b])),
        }
    }
}

/// Values of a channel in xterm's cube.
const CUBE: [u8; 6] = [0, 95, 135, 175, 215, 255];

/// The nearest colour among the cube, 16 to 231, and the greys, 232 to 255.
fn nearest(rgb: [u8; 3]) -> u8 {
    let step = |v: u8| (0..6u8).min_by_key(|i| CUBE[usize::from(*i)].abs_diff(v));
    let steps = rgb.map(|v| step(v).unwrap_or(0));
    let cube = steps.map(|i| CUBE[usize::from(i)]);
    let mean = rgb.iter().map(|v| u32::from(*v)).sum::<u32>() / 3;
    let grey = (mean.saturating_sub(3) / 10).min(23) as u8;
    let distance = |other: [u8; 3]| {
        let squares = (0..3).map(|c| u32::from(rgb[c].abs_diff(other[c])));
        squares.map(|d| d * d).sum::<u32>()
    };
    match distance([8 + 10 * grey; 3]) < distance(cube) {
        true => 232 + grey,
        false => 16 + 36 * steps[0] + 6 * steps[1] + steps[2],
    }
}

/// Writes points, row by row, into cells from the corner on; what is outside of the area is
/// left out. An odd last row has nothing below it.
pub(super) fn draw(
    buffer: &mut Buffer,
    area: Rect,
    corner: [u16; 2],
    (size, points): ([u32; 2], &[[u8; 3]]),
    palette: Palette,
) {
    let at = |x: u32, y: u32| {
        let inside = y < size[1];
        inside.then(|| points[(y * size[0] + x) as usize])
    };
    for row in 0..size[1].div_ceil(2) {
        for x in 0..size[0] {
            let place = [u32::from(corner[0]) + x, u32::from(corner[1]) + row];
            let [left, top] = [area.x, area.y].map(u32::from);
            if place[0] >= u32::from(area.width) || place[1] >= u32::from(area.height) {
                continue;
            }
            let place = ((left + place[0]) as u16, (top + place[1]) as u16);
            let Some(cell) = buffer.cell_mut(place) else {
                continue;
            };
            cell.set_symbol(UPPER_HALF);
            if let Some(upper) = at(x, 2 * row) {
                cell.set_fg(palette.color(upper));
            }
            cell.set_bg(match at(x, 2 * row + 1) {
                Some(lower) => palette.color(lower),
                None => Color::Reset,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(size: [u32; 2], corner: [u16; 2]) -> Buffer {
        let area = Rect::new(0, 0, 4, 3);
        let mut buffer = Buffer::empty(area);
        let points = (0..size[0] * size[1]).map(|i| [i as u8, 100, 200]);
        let points: Vec<_> = points.collect();
        draw(&mut buffer, area, corner, (size, &points), Palette::True);
        buffer
    }

    #[test]
    fn the_upper_point_is_the_foreground_and_the_lower_one_the_background() {
        let buffer = drawn([3, 4], [1, 0]);
        let color = |i| Color::Rgb(i, 100, 200);
        for (x, row, upper, lower) in [(0, 0, 0, 3), (2, 0, 2, 5), (1, 1, 7, 10)] {
            let cell = &buffer[(1 + x, row)];
            assert_eq!(cell.symbol(), "▀");
            assert_eq!(
                (cell.fg, cell.bg),
                (color(upper), color(lower)),
                "{x} {row}"
            );
        }
        assert_eq!(buffer[(0, 0)].symbol(), " ");
        assert_eq!(buffer[(1, 2)].symbol(), " ");
    }

    #[test]
    fn odd_rows_end_half_way_and_nothing_leaves_the_area() {
        let buffer = drawn([2, 3], [0, 1]);
        let last = &buffer[(1, 2)];
        assert_eq!((last.fg, last.bg), (Color::Rgb(5, 100, 200), Color::Reset));
        drawn([9, 40], [2, 2]);
    }

    #[test]
    fn colors_are_the_nearest_that_there_are() {
        assert_eq!(Palette::of("TrueColor"), Palette::True);
        assert_eq!(Palette::of("24bit"), Palette::True);
        assert_eq!(Palette::of(""), Palette::Indexed);
        let index = |rgb| match Palette::Indexed.color(rgb) {
            Color::Indexed(i) => i,
            other => panic!("{other}"),
        };
        assert_eq!(index([0, 0, 0]), 16);
        assert_eq!(index([255, 255, 255]), 231);
        assert_eq!(index([255, 0, 0]), 196);
        assert_eq!(index([94, 136, 214]), 16 + 36 + 12 + 4);
        assert_eq!(index([128, 128, 128]), 244);
        assert_eq!(index([8, 8, 8]), 232);
        assert_eq!(index([238, 238, 238]), 255);
    }
}
