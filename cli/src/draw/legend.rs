//! Legends: a band below the picture with a title, a scale or swatches, and notes.

use super::canvas::{Canvas, Picture};
use super::font;

pub(super) const BAND: [u8; 3] = [24, 26, 30];
pub(super) const TEXT: [u8; 3] = [232, 234, 237];
pub(super) const QUIET: [u8; 3] = [154, 160, 168];
/// Distances in font pixels.
const MARGIN: u32 = 6;
pub(super) const LINE: u32 = 12;
const BOX: u32 = 8;

/// A colour and what it stands for.
#[derive(Clone, Debug)]
pub(crate) struct Swatch {
    /// The colour.
    pub(crate) colour: [u8; 3],
    /// What it stands for.
    pub(crate) label: String,
}

impl Swatch {
    /// A swatch.
    pub(crate) fn new(colour: [u8; 3], label: impl Into<String>) -> Self {
        Self {
            colour,
            label: label.into(),
        }
    }
}

/// What the band says, from top to bottom.
#[derive(Clone, Debug, Default)]
pub(crate) struct Legend {
    /// What the picture shows.
    pub(crate) title: String,
    /// Places along a scale, 0 to 1, with their labels; no scale when empty.
    pub(crate) scale: Vec<(f32, String)>,
    /// Colours with their meanings, wrapped to the width.
    pub(crate) swatches: Vec<Swatch>,
    /// Further lines.
    pub(crate) notes: Vec<String>,
    /// Pixels of a font pixel; by the picture's width where there is none.
    pub(crate) text_scale: Option<u32>,
}

impl Legend {
    /// The canvas with the band below it. Small canvases are centred above a
    /// band that is wide enough to read.
    pub(crate) fn below(&self, canvas: Canvas, ramp: fn(f32) -> [u8; 3]) -> Picture {
        let [width, height] = canvas.size();
        let scale = self.text_scale.unwrap_or_else(|| text_scale(width));
        let full = width.max(280 * scale);
        let lines = self.lines((full / scale).saturating_sub(2 * MARGIN));
        let band = scale * (2 * MARGIN + lines.iter().map(Line::height).sum::<u32>());
        let mut out = Canvas::new([full, height + band], BAND);
        out.place(&canvas, [((full - width) / 2) as i32, 0]);
        let mut pen = Pen {
            canvas: &mut out,
            scale,
            y: height + scale * MARGIN,
            width: full,
            ramp,
        };
        lines.iter().for_each(|line| pen.line(line));
        out.into_picture()
    }

    fn lines(&self, width: u32) -> Vec<Line<'_>> {
        let mut lines: Vec<Line<'_>> = wrap(&self.title, width)
            .into_iter()
            .map(Line::Title)
            .collect();
        if !self.scale.is_empty() {
            lines.push(Line::Scale(&self.scale));
        }
        lines.extend(
            wrap_swatches(&self.swatches, width)
                .into_iter()
                .map(Line::Swatches),
        );
        let notes = self.notes.iter().flat_map(|n| wrap(n, width));
        lines.extend(notes.map(Line::Note));
        lines
    }
}

enum Line<'a> {
    Title(String),
    Scale(&'a [(f32, String)]),
    Swatches(&'a [Swatch]),
    Note(String),
}

impl Line<'_> {
    fn height(&self) -> u32 {
        match self {
            Self::Scale(_) => 2 * LINE,
            _ => LINE,
        }
    }
}

struct Pen<'a> {
    canvas: &'a mut Canvas,
    scale: u32,
    y: u32,
    width: u32,
    ramp: fn(f32) -> [u8; 3],
}

impl Pen<'_> {
    fn line(&mut self, line: &Line<'_>) {
        match line {
            Line::Title(text) => self.text(MARGIN, text, TEXT),
            Line::Note(text) => self.text(MARGIN, text, QUIET),
            Line::Scale(labels) => self.scale_bar(labels),
            Line::Swatches(swatches) => self.swatches(swatches),
        }
        self.y += line.height() * self.scale;
    }

    fn text(&mut self, x: u32, text: &str, colour: [u8; 3]) {
        self.canvas.text(
            [(x * self.scale) as i32, self.y as i32],
            text,
            colour,
            self.scale,
        );
    }

    fn scale_bar(&mut self, labels: &[(f32, String)]) {
        let left = MARGIN * self.scale;
        let length = self.width - 2 * left;
        for x in 0..length {
            let colour = (self.ramp)(x as f32 / (length - 1).max(1) as f32);
            let at = [(left + x) as f32, self.y as f32];
            self.canvas
                .fill_rect(at, [1.0, (BOX * self.scale) as f32], colour);
        }
        for (place, label) in labels {
            self.tick(left + ((length - 1) as f32 * place) as u32, label);
        }
    }

    fn tick(&mut self, x: u32, label: &str) {
        let y = self.y + BOX * self.scale;
        self.canvas
            .fill_rect([x as f32, y as f32], [1.0, self.scale as f32], TEXT);
        let wide = font::text_width(label) * self.scale;
        let rightmost = (self.width - MARGIN * self.scale).saturating_sub(wide);
        let start = x
            .saturating_sub(wide / 2)
            .clamp(MARGIN * self.scale, rightmost.max(MARGIN * self.scale));
        let at = [start as i32, (y + 2 * self.scale) as i32];
        self.canvas.text(at, label, TEXT, self.scale);
    }

    fn swatches(&mut self, swatches: &[Swatch]) {
        let mut x = MARGIN;
        for swatch in swatches {
            let at = [x * self.scale, self.y].map(|c| c as f32);
            self.canvas
                .fill_rect(at, [(BOX * self.scale) as f32; 2], swatch.colour);
            self.text(x + BOX + 3, &swatch.label, TEXT);
            x += swatch_width(swatch);
        }
    }
}

/// Font pixels are enlarged on pictures that are wide enough.
fn text_scale(width: u32) -> u32 {
    (width / 480).clamp(1, 4)
}

fn swatch_width(swatch: &Swatch) -> u32 {
    BOX + 3 + font::text_width(&swatch.label) + 10
}

fn wrap_swatches(swatches: &[Swatch], width: u32) -> Vec<&[Swatch]> {
    let mut rows = Vec::new();
    let (mut start, mut used) = (0, 0);
    for (i, swatch) in swatches.iter().enumerate() {
        if i > start && used + swatch_width(swatch) > width + 10 {
            rows.push(&swatches[start..i]);
            (start, used) = (i, 0);
        }
        used += swatch_width(swatch);
    }
    rows.push(&swatches[start..]);
    rows.retain(|row| !row.is_empty());
    rows
}

/// Words in lines of at most `width` font pixels, longer words uncut.
pub(super) fn wrap(text: &str, width: u32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line)
                if font::text_width(line) + font::text_width(word) + 2 * font::ADVANCE <= width =>
            {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::heat;

    #[test]
    fn a_picture_of_one_pixel_gets_a_readable_legend() {
        let legend = Legend {
            title: "a title that is longer than the picture is wide by very much indeed".to_owned(),
            scale: vec![(0.0, "0".to_owned()), (1.0, "1".to_owned())],
            swatches: (0..30)
                .map(|i| Swatch::new([i; 3], format!("value {i}")))
                .collect(),
            notes: vec!["note".to_owned()],
            text_scale: None,
        };
        let picture = legend.below(Canvas::new([1, 1], [9; 3]), heat);
        assert_eq!(picture.size[0], 280);
        assert_eq!(picture.pixels[139], [9, 9, 9, 255]);
        assert_eq!(
            picture.pixels.len(),
            (picture.size[0] * picture.size[1]) as usize
        );
    }

    #[test]
    fn lines_break_between_words() {
        assert_eq!(wrap("aa bb cc", 34), ["aa bb", "cc"]);
        assert_eq!(wrap("", 30), Vec::<String>::new());
    }
}
