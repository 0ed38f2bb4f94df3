//! A laid-out plot as an SVG document.

use std::fmt::Write;

use super::layout::{Anchor, Item, Layout};
use super::raster::DASH;

/// Of text, pixels: as wide as the bitmap font in a monospaced one.
const FONT_SIZE: f32 = 20.0;

pub(super) fn write(layout: &Layout) -> String {
    let [width, height] = layout.size;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"monospace\" font-size=\"{FONT_SIZE}\" \
         fill=\"{}\">\n<title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        hex(layout.ink),
        escaped(&layout.title),
        hex(layout.paper),
    );
    for item in &layout.items {
        out += &element(item);
        out.push('\n');
    }
    out + "</svg>\n"
}

fn element(item: &Item) -> String {
    match item {
        Item::Line {
            points,
            colour,
            width,
            dashed,
        } => {
            let mut list = String::new();
            for [x, y] in points {
                // Writing to a string cannot fail.
                let _ = write!(list, "{x:.1},{y:.1} ");
            }
            let dash = match dashed {
                true => format!(" stroke-dasharray=\"{} {}\"", DASH[0], DASH[1]),
                false => String::new(),
            };
            format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"{dash}/>",
                list.trim_end(),
                hex(*colour)
            )
        }
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
