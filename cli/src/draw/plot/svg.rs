//! A laid-out plot as an SVG document.

use std::fmt::Write;

use super::layout::{Anchor, GREY, GRID, INK, Item, Layout, PAPER};
use super::raster::{DASH, MARKER_STROKE};

/// Of text, pixels: as wide as the bitmap font in a monospaced one.
const FONT_SIZE: f32 = 20.0;

/// Where a plot stands.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// In a file of its own, black on white.
    File,
    /// In a page that says what paper, ink and lines look like.
    Page,
}

impl Place {
    fn colour(self, colour: [u8; 3]) -> String {
        match (self, colour) {
            (Self::Page, INK) => "var(--ink)".to_owned(),
            (Self::Page, GRID) => "var(--line)".to_owned(),
            (Self::Page, PAPER) => "var(--page)".to_owned(),
            (Self::Page, GREY) => "var(--quiet)".to_owned(),
            _ => hex(colour),
        }
    }
}

pub(super) fn write(layout: &Layout, place: Place) -> String {
    let [width, height] = layout.size;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"monospace\" font-size=\"{FONT_SIZE}\" \
         fill=\"{}\">\n<title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        place.colour(layout.ink),
        escaped(&layout.title),
        place.colour(layout.paper),
    );
    for item in &layout.items {
        out += &element(item, place);
        out.push('\n');
    }
    out + "</svg>\n"
}

fn element(item: &Item, place: Place) -> String {
    let hex = |colour: [u8; 3]| place.colour(colour);
    match item {
        Item::Line {
            points,
            colour,
            width,
            dashed,
        } => {
            let dash = match dashed {
                true => format!(" stroke-dasharray=\"{} {}\"", DASH[0], DASH[1]),
                false => String::new(),
            };
            format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"{dash}/>",
                list(points),
                hex(*colour)
            )
        }
        Item::Marker {
            outline,
            fill,
            colour,
            title,
        } => format!(
            "<polygon points=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{MARKER_STROKE}\">\
             <title>{}</title></polygon>",
            list(outline),
            hex(*fill),
            hex(*colour),
            escaped(title)
        ),
        Item::Dot { at, radius, colour } => format!(
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{}\"/>",
            at[0],
            at[1],
            hex(*colour)
        ),
        Item::Bar { at, size, colour } => format!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\"/>",
            at[0],
            at[1],
            size[0],
            size[1],
            hex(*colour)
        ),
        Item::Text { at, anchor, text } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            // From the top of capitals to the baseline.
            let baseline = at[1] + 0.7 * FONT_SIZE;
            format!(
                "<text x=\"{:.1}\" y=\"{baseline:.1}\" text-anchor=\"{anchor}\">{}</text>",
                at[0],
                escaped(text)
            )
        }
    }
}

/// Points as attributes have them.
fn list(points: &[[f32; 2]]) -> String {
    let mut list = String::new();
    for [x, y] in points {
        // Writing to a string cannot fail.
        let _ = write!(list, "{x:.1},{y:.1} ");
    }
    list.trim_end().to_owned()
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            c => out.push(c),
        }
    }
    out
}
