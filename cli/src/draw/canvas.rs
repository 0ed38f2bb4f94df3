//! A picture to draw on, over tiny-skia.

use tiny_skia::{
    Color, FillRule, Paint, PathBuilder, Pixmap, PremultipliedColorU8, Rect, Transform,
};

use super::font;

/// An opaque RGBA image, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Row by row.
    pub pixels: Vec<[u8; 4]>,
}

/// Colour, width and opacity of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    /// Red, green, blue.
    pub(crate) colour: [u8; 3],
    /// 0 to 1.
    pub(crate) opacity: f32,
    /// Pixels.
    pub(crate) width: f32,
}

/// A picture being drawn.
pub(crate) struct Canvas {
    map: Pixmap,
}

impl Canvas {
    /// A canvas of one colour. `size` is not zero in either direction.
    pub(crate) fn new(size: [u32; 2], colour: [u8; 3]) -> Self {
        let mut map = Pixmap::new(size[0].max(1), size[1].max(1))
            .expect("sizes are limited by the GPU's textures");
        map.fill(opaque(colour));
        Self { map }
    }

    /// A picture as it is.
    pub(crate) fn showing(picture: &Picture) -> Self {
        let mut canvas = Self::new(picture.size, [0; 3]);
        let to = canvas.map.pixels_mut();
        for (out, &[r, g, b, _]) in to.iter_mut().zip(&picture.pixels) {
            *out = premultiplied([r, g, b]);
        }
        canvas
    }

    /// A picture, its colours multiplied by `light` in 0..=1 and half way to grey.
    pub(crate) fn dimmed(picture: &Picture, light: f32) -> Self {
        let mut canvas = Self::new(picture.size, [0; 3]);
        let to = canvas.map.pixels_mut();
        for (out, &[r, g, b, _]) in to.iter_mut().zip(&picture.pixels) {
            let grey = 0.299 * f32::from(r) + 0.587 * f32::from(g) + 0.114 * f32::from(b);
            let dim = |c: u8| ((f32::from(c) + grey) * 0.5 * light).round() as u8;
            *out = premultiplied([dim(r), dim(g), dim(b)]);
        }
        canvas
    }

    /// Width and height.
    pub(crate) fn size(&self) -> [u32; 2] {
        [self.map.width(), self.map.height()]
    }

    /// Mixes `colour` into one pixel. Pixels outside are ignored.
    pub(crate) fn mix(&mut self, [x, y]: [u32; 2], colour: [u8; 3], opacity: f32) {
        let [width, height] = self.size();
        if x >= width || y >= height {
            return;
        }
        let pixel = &mut self.map.pixels_mut()[(y * width + x) as usize];
        let blend = |from: u8, to: u8| {
            (f32::from(from) * (1.0 - opacity) + f32::from(to) * opacity).round() as u8
        };
        *pixel = premultiplied([
            blend(pixel.red(), colour[0]),
            blend(pixel.green(), colour[1]),
            blend(pixel.blue(), colour[2]),
        ]);
    }

    /// Fills a rectangle given by its corner and size.
    pub(crate) fn fill_rect(&mut self, at: [f32; 2], size: [f32; 2], colour: [u8; 3]) {
        if let Some(rect) = Rect::from_xywh(at[0], at[1], size[0], size[1]) {
            self.map.fill_rect(
                rect,
                &paint(colour, 1.0, false),
                Transform::identity(),
                None,
            );
        }
    }

    /// Fills a polygon.
    pub(crate) fn fill(&mut self, points: &[[f32; 2]], colour: [u8; 3], opacity: f32) {
        if let Some(path) = path(points, true) {
            let paint = paint(colour, opacity, true);
            self.map.fill_path(
                &path,
                &paint,
                FillRule::Winding,
                Transform::identity(),
                None,
            );
        }
    }

    /// Draws a line along `points`.
    pub(crate) fn line(&mut self, points: &[[f32; 2]], closed: bool, stroke: Stroke) {
        if let Some(path) = path(points, closed) {
            let pen = tiny_skia::Stroke {
                width: stroke.width,
                ..Default::default()
            };
            let paint = paint(stroke.colour, stroke.opacity, true);
            self.map
                .stroke_path(&path, &paint, &pen, Transform::identity(), None);
        }
    }

    /// Writes text with its top left corner at `at`, each font pixel `scale` wide.
    pub(crate) fn text(&mut self, at: [i32; 2], text: &str, colour: [u8; 3], scale: u32) {
        for (i, c) in text.chars().enumerate() {
            let left = at[0] + (i as u32 * font::ADVANCE * scale) as i32;
            self.character([left, at[1]], c, colour, scale);
        }
    }

    fn character(&mut self, at: [i32; 2], c: char, colour: [u8; 3], scale: u32) {
        let rows = font::glyph(c);
        for y in 0..font::GLYPH_HEIGHT * scale {
            for x in 0..font::GLYPH_WIDTH * scale {
                let bit = font::GLYPH_WIDTH - 1 - x / scale;
                let (px, py) = (at[0] + x as i32, at[1] + y as i32);
                if rows[(y / scale) as usize] >> bit & 1 == 1 && px >= 0 && py >= 0 {
                    self.mix([px as u32, py as u32], colour, 1.0);
                }
            }
        }
    }

    /// Copies another canvas with its top left corner at `at`.
    pub(crate) fn place(&mut self, other: &Self, at: [i32; 2]) {
        let paint = tiny_skia::PixmapPaint::default();
        self.map.draw_pixmap(
            at[0],
            at[1],
            other.map.as_ref(),
            &paint,
            Transform::identity(),
            None,
        );
    }

    /// The finished picture.
    pub(crate) fn into_picture(self) -> Picture {
        let size = self.size();
        let pixels = self.map.pixels().iter();
        Picture {
            size,
            pixels: pixels
                .map(|p| [p.red(), p.green(), p.blue(), 255])
                .collect(),
        }
    }
}

fn opaque([r, g, b]: [u8; 3]) -> Color {
    Color::from_rgba8(r, g, b, 255)
}

fn premultiplied([r, g, b]: [u8; 3]) -> PremultipliedColorU8 {
    PremultipliedColorU8::from_rgba(r, g, b, 255).expect("opaque colours are premultiplied")
}

fn paint([r, g, b]: [u8; 3], opacity: f32, anti_alias: bool) -> Paint<'static> {
    let mut paint = Paint {
        anti_alias,
        ..Default::default()
    };
    paint.set_color_rgba8(r, g, b, (opacity.clamp(0.0, 1.0) * 255.0).round() as u8);
    paint
}

/// `None` for fewer than two points or points that are not finite.
fn path(points: &[[f32; 2]], closed: bool) -> Option<tiny_skia::Path> {
    let (first, rest) = points.split_first()?;
    if rest.is_empty() || !points.iter().flatten().all(|c| c.is_finite()) {
        return None;
    }
    let mut builder = PathBuilder::new();
    builder.move_to(first[0], first[1]);
    rest.iter().for_each(|p| builder.line_to(p[0], p[1]));
    if closed {
        builder.close();
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_drawn_and_clipped() {
        let mut canvas = Canvas::new([8, 8], [0; 3]);
        canvas.text([-2, 1], "II", [255; 3], 1);
        canvas.text([0, 100], "outside", [255; 3], 2);
        let picture = canvas.into_picture();
        let lit = picture.pixels.iter().filter(|p| p[0] == 255).count();
        assert_eq!(
            picture.pixels[2 * 8],
            [255, 255, 255, 255],
            "the stem of the first I"
        );
        assert!(lit > 10);
    }

    #[test]
    fn dimming_keeps_black_and_darkens_white() {
        let picture = Picture {
            size: [2, 1],
            pixels: vec![[0, 0, 0, 255], [255, 255, 255, 255]],
        };
        let dim = Canvas::dimmed(&picture, 0.5).into_picture();
        assert_eq!(dim.pixels, [[0, 0, 0, 255], [128, 128, 128, 255]]);
    }

    #[test]
    fn points_that_are_not_finite_draw_nothing() {
        let mut canvas = Canvas::new([4, 4], [0; 3]);
        canvas.fill(&[[0.0, 0.0], [f32::NAN, 4.0], [4.0, 4.0]], [255; 3], 1.0);
        assert!(
            canvas
                .into_picture()
                .pixels
                .iter()
                .all(|p| *p == [0, 0, 0, 255])
        );
    }
}
