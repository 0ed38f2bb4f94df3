//! Pictures of one size side by side, each column with a caption on top.

use super::canvas::Canvas;
use super::legend::{BAND, LINE, QUIET, TEXT, wrap};

/// Most columns beside each other; more go below.
const ACROSS: usize = 4;
/// Narrowest column, in font pixels: captions have to be read.
const NARROWEST: u32 = 190;
/// Between columns and pictures, in font pixels.
const GAP: u32 = 4;

/// A column: what it says, and its pictures from top to bottom.
pub(crate) struct Cell {
    /// First line, brighter; wrapped.
    pub(crate) name: String,
    /// Further lines.
    pub(crate) notes: Vec<String>,
    /// All of one size, the same in all cells.
    pub(crate) pictures: Vec<Canvas>,
}

/// Cells and the sizes they are drawn in, in pixels.
pub(crate) struct Grid {
    cells: Vec<Cell>,
    picture: [u32; 2],
    /// Pixels of a font pixel.
    scale: u32,
    column: u32,
    /// Caption and pictures of a cell, with the gaps.
    row: u32,
    caption: u32,
}

impl Grid {
    /// Lays `cells` out.
    pub(crate) fn new(cells: Vec<Cell>) -> Self {
        let picture = cells
            .first()
            .and_then(|c| c.pictures.first())
            .map_or([1, 1], Canvas::size);
        let scale = (picture[0] / 240).clamp(1, 4);
        let column = picture[0].max(NARROWEST * scale);
        let lines = |c: &Cell| wrap(&c.name, column / scale).len() + c.notes.len();
        let most = cells.iter().map(lines).max().unwrap_or(0) as u32;
        let caption = (most * LINE + GAP) * scale;
        let pictures = cells.iter().map(|c| c.pictures.len()).max().unwrap_or(0) as u32;
        Self {
            row: caption + pictures * (picture[1] + GAP * scale),
            cells,
            picture,
            scale,
            column,
            caption,
        }
    }

    /// Pixels of a font pixel of the captions.
    pub(crate) fn text_scale(&self) -> u32 {
        self.scale
    }

    /// Columns beside each other: as many in the last row as can be.
    fn across(&self) -> usize {
        let rows = self.cells.len().div_ceil(ACROSS).max(1);
        self.cells.len().div_ceil(rows).max(1)
    }

    /// Draws everything.
    pub(crate) fn draw(&self) -> Canvas {
        let (across, gap) = (self.across(), GAP * self.scale);
        let rows = self.cells.len().div_ceil(across) as u32;
        let width = across as u32 * (self.column + gap) + gap;
        let mut canvas = Canvas::new([width, rows * (self.row + gap) + gap], BAND);
        for (number, cell) in self.cells.iter().enumerate() {
            let [column, row] = [number % across, number / across].map(|c| c as u32);
            let at = [
                gap + column * (self.column + gap),
                gap + row * (self.row + gap),
            ];
            self.cell(&mut canvas, cell, at);
        }
        canvas
    }

    fn cell(&self, canvas: &mut Canvas, cell: &Cell, [left, top]: [u32; 2]) {
        let names = wrap(&cell.name, self.column / self.scale);
        let names = names.into_iter().map(|line| (line, TEXT));
        let notes = cell.notes.iter().map(|line| (line.clone(), QUIET));
        for (number, (line, colour)) in names.chain(notes).enumerate() {
            let y = top + number as u32 * LINE * self.scale;
            canvas.text([left as i32, y as i32], &line, colour, self.scale);
        }
        let inset = (self.column - self.picture[0]) / 2;
        let mut y = top + self.caption;
        for picture in &cell.pictures {
            canvas.place(picture, [(left + inset) as i32, y as i32]);
            y += self.picture[1] + GAP * self.scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(count: u8, size: [u32; 2]) -> Vec<Cell> {
        let cell = |k: u8| Cell {
            name: format!("number {k}"),
            notes: vec!["note".to_owned()],
            pictures: vec![Canvas::new(size, [k, 0, 0]), Canvas::new(size, [k, 1, 0])],
        };
        (1..=count).map(cell).collect()
    }

    #[test]
    fn every_picture_is_there_in_full_and_once() {
        for (count, size) in [(1, [1, 1]), (2, [50, 20]), (5, [333, 7]), (9, [20, 30])] {
            let picture = Grid::new(cells(count, size)).draw().into_picture();
            for k in 1..=count {
                for second in [0, 1] {
                    let found = picture.pixels.iter().filter(|p| **p == [k, second, 0, 255]);
                    assert_eq!(
                        found.count(),
                        (size[0] * size[1]) as usize,
                        "{count} {size:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn rows_are_filled_evenly() {
        let across = |count| Grid::new(cells(count, [9, 9])).across();
        assert_eq!([1, 3, 4, 5, 6, 7, 9].map(across), [1, 3, 4, 3, 3, 4, 3]);
    }
}
