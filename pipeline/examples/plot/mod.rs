//! Plots of errors for the examples, both axes logarithmic.

use std::fmt::Write as _;

/// Marks along x.
#[derive(Clone, Copy, PartialEq, Eq)]
#[allow(dead_code, reason = "each example uses one of them")]
pub(crate) enum Axis {
    /// At powers of ten.
    Decades,
    /// At powers of two.
    Doublings,
}

/// A line, interrupted where there is no value.
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, Option<f64>)>,
}

/// A plot of values from `floor` to 1 over the x of the first series.
pub(crate) struct Plot {
    pub(crate) title: String,
    pub(crate) axis: Axis,
    pub(crate) floor: f64,
    pub(crate) series: Vec<Series>,
}

/// Height of a plot with its margins.
const HEIGHT: f64 = 360.0;
/// Left, right, top and bottom of a plot's frame.
const FRAME: [f64; 4] = [70.0, 590.0, 40.0, 310.0];

/// One plot below the other.
pub(crate) fn svg(plots: &[Plot]) -> String {
    let (width, height) = (860, HEIGHT as usize * plots.len() + 20);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    for (k, plot) in plots.iter().enumerate() {
        Placed::new(plot, HEIGHT * k as f64).draw(&mut text);
    }
    text + "</svg>\n"
}

/// A plot at its place.
struct Placed<'a> {
    plot: &'a Plot,
    /// Left, right, top and bottom of the frame.
    frame: [f64; 4],
    /// Logarithms of the least and greatest x.
    range: [f64; 2],
}

impl<'a> Placed<'a> {
    fn new(plot: &'a Plot, down: f64) -> Self {
        let xs = plot.series.first().map_or(&[][..], |s| &s.points);
        let end = |p: Option<&(f64, Option<f64>)>| libm::log10(p.map_or(1.0, |p| p.0));
        Self {
            plot,
            frame: [FRAME[0], FRAME[1], FRAME[2] + down, FRAME[3] + down],
            range: [end(xs.first()), end(xs.last())],
        }
    }

    fn x(&self, value: f64) -> f64 {
        let ([left, right, ..], [low, high]) = (self.frame, self.range);
        left + (right - left) * (libm::log10(value) - low) / (high - low)
    }

    fn y(&self, value: f64) -> f64 {
        let [_, _, top, bottom] = self.frame;
        let floor = self.plot.floor;
        top - (bottom - top) * libm::log10(value.max(floor)) / -libm::log10(floor)
    }

    fn draw(&self, text: &mut String) {
        let [left, right, top, _] = self.frame;
        let _ = writeln!(
            text,
            "<text x=\"{left}\" y=\"{}\" font-size=\"14\">{}</text>",
            top - 14.0,
            self.plot.title
        );
        self.rows(text);
        self.columns(text);
        for (k, series) in self.plot.series.iter().enumerate() {
            self.line(text, series, k);
            let place = [right + 16.0, top + 18.0 * k as f64 + 10.0];
            let _ = writeln!(
                text,
                "<path d=\"M{} {}h18\" stroke=\"{}\" stroke-width=\"2\"{}/>\
                 <text x=\"{}\" y=\"{}\">{}</text>",
                place[0],
                place[1] - 4.0,
                colour(k),
                dashes(k),
                place[0] + 24.0,
                place[1],
                series.name
            );
        }
    }

    fn rows(&self, text: &mut String) {
        let [left, right, ..] = self.frame;
        for exponent in (libm::log10(self.plot.floor) as i32)..=0 {
            let at = self.y(libm::pow(10.0, f64::from(exponent)));
            let _ = writeln!(
                text,
                "<path d=\"M{left} {at:.1}H{right}\" stroke=\"#ddd\"/>\
                 <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">1e{exponent}</text>",
                left - 6.0,
                at + 4.0
            );
        }
    }

    fn columns(&self, text: &mut String) {
        let [_, _, top, bottom] = self.frame;
        for (value, label) in self.marks() {
            let at = self.x(value);
            let _ = writeln!(
                text,
                "<path d=\"M{at:.1} {top}V{bottom}\" stroke=\"#ddd\"/>\
                 <text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
                bottom + 18.0
            );
        }
    }

    fn marks(&self) -> Vec<(f64, String)> {
        let [low, high] = self.range;
        if self.plot.axis == Axis::Doublings {
            let values = (0..31).map(|k| f64::from(1u32 << k));
            let within = values.filter(|v| (low..=high + 1e-9).contains(&libm::log10(*v)));
            return within.map(|v| (v, format!("{v}"))).collect();
        }
        let step = if high - low > 20.0 { 6 } else { 1 };
        let exponents = (low.ceil() as i32..=high as i32).step_by(step);
        let mark = |e: i32| (libm::pow(10.0, f64::from(e)), format!("1e{e}"));
        exponents.map(mark).collect()
    }

    fn line(&self, text: &mut String, series: &Series, k: usize) {
        let mut path = String::new();
        let mut pen_down = false;
        for (x, value) in &series.points {
            if let Some(value) = value {
                let command = if pen_down { 'L' } else { 'M' };
                let _ = write!(path, "{command}{:.1} {:.1}", self.x(*x), self.y(*value));
            }
            pen_down = value.is_some();
        }
        let _ = writeln!(
            text,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>",
            colour(k),
            dashes(k)
        );
    }
}

/// Colours that colour-blind people can tell apart (Okabe and Ito, 2008).
fn colour(k: usize) -> &'static str {
    const COLOURS: [&str; 8] = [
        "#000000", "#e69f00", "#56b4e9", "#009e73", "#0072b2", "#d55e00", "#cc79a7", "#999999",
    ];
    COLOURS[k % COLOURS.len()]
}

/// Every other line is dashed: where two lie on each other, both are seen.
fn dashes(k: usize) -> &'static str {
    match k % 2 {
        0 => "",
        _ => " stroke-dasharray=\"6 4\"",
    }
}
