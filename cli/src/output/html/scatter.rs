//! Points with names in a plane whose axes begin at 0.

use std::fmt::Write;

use super::escape;

/// A point.
pub(crate) struct Point {
    pub(crate) label: String,
    pub(crate) at: [f64; 2],
}

/// A chart.
pub(crate) struct Scatter {
    pub(crate) title: String,
    /// Across and up.
    pub(crate) axes: [String; 2],
    pub(crate) points: Vec<Point>,
}

const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 20.0;
const BOTTOM: f64 = 40.0;

impl Scatter {
    /// A figure; every point's numbers stand in the caption of the point in full.
    pub(crate) fn to_svg(&self) -> String {
        let top = |axis: usize| {
            let values = self.points.iter().map(|p| p.at[axis]);
            values.fold(0.0, f64::max).max(f64::MIN_POSITIVE) * 1.15
        };
        let [right, up] = [top(0), top(1)];
        let mut points = String::new();
        for (i, p) in self.points.iter().enumerate() {
            let x = LEFT + (WIDTH - LEFT - 10.0) * p.at[0] / right;
            let y = (HEIGHT - BOTTOM) * (1.0 - p.at[1] / up);
            let label = escape(&p.label);
            let (anchor, dx) = if x > WIDTH / 2.0 {
                ("end", -8.0)
            } else {
                ("start", 8.0)
            };
            let dy = if i % 2 == 0 { -6.0 } else { 14.0 };
            let _ = writeln!(
                points,
                "<g><title>{label}: {}, {}</title><circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"5\"/><text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\">{label}</text></g>",
                p.at[0],
                p.at[1],
                x + dx,
                y + dy
            );
        }
        let base = HEIGHT - BOTTOM;
        format!(
            "<figure class=\"scatter\"><figcaption>{}</figcaption><svg viewBox=\"0 -10 {WIDTH} {}\" role=\"img\" aria-label=\"{0}\">\
             <path d=\"M{LEFT} 0V{base}H{WIDTH}\"/>{points}\
             <text x=\"{WIDTH}\" y=\"{}\" text-anchor=\"end\">{} →</text><text x=\"{}\" y=\"4\">{} ↑</text></svg></figure>\n",
            escape(&self.title),
            HEIGHT + 10.0,
            base + 18.0,
            escape(&self.axes[0]),
            LEFT + 6.0,
            escape(&self.axes[1]),
        )
    }
}
