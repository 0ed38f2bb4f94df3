//! From a chart to lines, dots, bars and text in pixels.

use gnomon_claims::chart::{Axis, Chart, Mark, Series};

use super::axis::{Range, tick_label};
use crate::draw::font;

/// Width and height of the area between the axes, in pixels.
const AREA: [f32; 2] = [720.0, 440.0];
/// Left, top, bottom, and right of the area.
pub(super) const LEFT: f32 = 92.0;
pub(super) const TOP: f32 = 74.0;
pub(super) const BOTTOM: f32 = 66.0;
pub(super) const GAP: f32 = 24.0;
/// Pixels of a font pixel.
pub(super) const TEXT_SCALE: u32 = 2;
pub(super) const LINE_HEIGHT: f32 = 26.0;

pub(super) const INK: [u8; 3] = [40, 40, 40];
pub(super) const GRID: [u8; 3] = [226, 226, 226];
pub(super) const PAPER: [u8; 3] = [255, 255, 255];
/// Told apart also by people who see few colours (Okabe and Ito), dark enough on
/// white.
pub(super) const COLOURS: [[u8; 3]; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    GREY,
];
/// The colour that goes with the paper.
pub(super) const GREY: [u8; 3] = [90, 90, 90];

/// What is drawn, in order.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Item {
    /// A line through points.
    Line {
        points: Vec<[f32; 2]>,
        colour: [u8; 3],
        width: f32,
        dashed: bool,
    },
    /// A filled disc.
    Dot {
        at: [f32; 2],
        radius: f32,
        colour: [u8; 3],
    },
    /// A filled rectangle.
    Bar {
        at: [f32; 2],
        size: [f32; 2],
        colour: [u8; 3],
    },
    /// A marker: an outline round its filling, with words for whoever points at it.
    Marker {
        outline: Vec<[f32; 2]>,
        fill: [u8; 3],
        colour: [u8; 3],
        title: String,
    },
    /// Text, its left, middle or right end at `at`, which is at the top.
    Text {
        at: [f32; 2],
        anchor: Anchor,
        text: String,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A chart as items on a canvas.
pub(super) struct Layout {
    pub(super) size: [u32; 2],
    pub(super) paper: [u8; 3],
    pub(super) ink: [u8; 3],
    pub(super) title: String,
    pub(super) items: Vec<Item>,
}

/// Width of text in pixels, in the bitmap font.
pub(super) fn text_width(text: &str) -> f32 {
    (font::text_width(text) * TEXT_SCALE) as f32
}

impl Layout {
    pub(super) fn new(chart: &Chart) -> Self {
        let values = |k: usize| {
            chart
                .series
                .iter()
                .flat_map(|s| &s.points)
                .map(move |p| p[k])
        };
        let plot = Plot {
            x: Range::new(chart.x.scale, values(0)),
            y: Range::new(chart.y.scale, values(1)),
            area: AREA,
        };
        let mut items = Vec::new();
        plot.draw_grid(&chart.title, [&chart.x, &chart.y], &mut items);
        let mut labels = Vec::new();
        for (k, series) in chart.series.iter().enumerate() {
            let hidden = plot.draw_series(series, Look::of(k, series.mark), &mut items);
            labels.push(match hidden {
                0 => series.label.clone(),
                n => format!("{} ({n} not shown)", series.label),
            });
        }
        let legend_width = draw_legend(chart, &labels, &mut items);
        let width = LEFT + AREA[0] + GAP + legend_width + GAP;
        let width = width.max(text_width(&chart.title) + 2.0 * GAP);
        Self {
            size: [width.ceil() as u32, (TOP + AREA[1] + BOTTOM) as u32],
            paper: PAPER,
            ink: INK,
            title: chart.title.clone(),
            items,
        }
    }
}

/// Both axes over the area.
pub(super) struct Plot {
    pub(super) x: Range,
    pub(super) y: Range,
    /// Width and height in pixels.
    pub(super) area: [f32; 2],
}

impl Plot {
    fn at_x(&self, x: f64) -> Option<f32> {
        self.x.place(x).map(|t| LEFT + self.area[0] * t as f32)
    }

    fn at_y(&self, y: f64) -> Option<f32> {
        self.y
            .place(y)
            .map(|t| TOP + self.area[1] * (1.0 - t as f32))
    }

    pub(super) fn at(&self, [x, y]: [f64; 2]) -> Option<[f32; 2]> {
        Some([self.at_x(x)?, self.at_y(y)?])
    }

    /// Title, ticks with their lines and labels, axes.
    pub(super) fn draw_grid(&self, title: &str, [across, up]: [&Axis; 2], items: &mut Vec<Item>) {
        let [right, bottom] = [LEFT + self.area[0], TOP + self.area[1]];
        let text = |at, anchor, text: &str| Item::Text {
            at,
            anchor,
            text: text.to_owned(),
        };
        let line = |points: [[f32; 2]; 2], colour| Item::Line {
            points: points.to_vec(),
            colour,
            width: 1.0,
            dashed: false,
        };
        items.push(text([GAP, 12.0], Anchor::Start, title));
        items.push(text([GAP, 44.0], Anchor::Start, &up.label));
        for (value, x) in self
            .x
            .ticks
            .iter()
            .filter_map(|v| Some((v, self.at_x(*v)?)))
        {
            items.push(line([[x, TOP], [x, bottom]], GRID));
            items.push(text([x, bottom + 8.0], Anchor::Middle, &tick_label(*value)));
        }
        for (value, y) in self
            .y
            .ticks
            .iter()
            .filter_map(|v| Some((v, self.at_y(*v)?)))
        {
            items.push(line([[LEFT, y], [right, y]], GRID));
            let at = [LEFT - 8.0, y - 7.0];
            items.push(text(at, Anchor::End, &tick_label(*value)));
        }
        items.push(line([[LEFT, TOP], [LEFT, bottom]], INK));
        items.push(line([[LEFT, bottom], [right, bottom]], INK));
        let middle = [LEFT + 0.5 * self.area[0], bottom + 34.0];
        items.push(text(middle, Anchor::Middle, &across.label));
    }

    /// Draws a series, its line interrupted where a point cannot be shown; how many
    /// cannot.
    fn draw_series(&self, series: &Series, look: Look, items: &mut Vec<Item>) -> usize {
        let places: Vec<Option<[f32; 2]>> = series.points.iter().map(|p| self.at(*p)).collect();
        if look.has_line() {
            let runs = places.split(Option::is_none).filter(|run| run.len() > 1);
            items.extend(runs.map(|run| look.line(run.iter().flatten().copied().collect())));
        }
        let bottom = TOP + self.area[1];
        let shown = places.iter().flatten();
        items.extend(shown.clone().filter_map(|at| look.mark_at(*at, bottom)));
        places.len() - shown.count()
    }
}

/// How a series looks, in the plot and in the legend.
#[derive(Clone, Copy)]
struct Look {
    mark: Mark,
    colour: [u8; 3],
    dashed: bool,
}

impl Look {
    /// Of series number `k`: colours in turn, then once more with dashed lines.
    fn of(k: usize, mark: Mark) -> Self {
        Self {
            mark,
            colour: COLOURS[k % COLOURS.len()],
            dashed: mark == Mark::Dashed || k / COLOURS.len() % 2 == 1,
        }
    }

    fn has_line(self) -> bool {
        matches!(self.mark, Mark::Line | Mark::Dashed)
    }

    fn line(self, points: Vec<[f32; 2]>) -> Item {
        Item::Line {
            points,
            colour: self.colour,
            width: 2.5,
            dashed: self.dashed,
        }
    }

    /// What stands at a point, if anything does; bars reach down to `bottom`.
    fn mark_at(self, at: [f32; 2], bottom: f32) -> Option<Item> {
        let colour = self.colour;
        match self.mark {
            Mark::Line | Mark::Dots => Some(Item::Dot {
                at,
                radius: 4.5,
                colour,
            }),
            Mark::Bars => Some(Item::Bar {
                at: [at[0] - 3.0, at[1]],
                size: [6.0, bottom - at[1]],
                colour,
            }),
            Mark::Dashed => None,
        }
    }
}

/// A sample and the label of each series, to the right of the area; its width.
fn draw_legend(chart: &Chart, labels: &[String], items: &mut Vec<Item>) -> f32 {
    const SAMPLE: f32 = 30.0;
    let left = LEFT + AREA[0] + GAP;
    let mut widest: f32 = 0.0;
    for (k, (series, label)) in chart.series.iter().zip(labels).enumerate() {
        let look = Look::of(k, series.mark);
        let y = TOP + 8.0 + LINE_HEIGHT * k as f32;
        if look.has_line() {
            items.push(look.line(vec![[left, y], [left + SAMPLE, y]]));
        }
        // A bar of the legend stands on the line of its text.
        let top = if series.mark == Mark::Bars {
            y - 7.0
        } else {
            y
        };
        items.extend(look.mark_at([left + 0.5 * SAMPLE, top], y + 7.0));
        items.push(Item::Text {
            at: [left + SAMPLE + 8.0, y - 7.0],
            anchor: Anchor::Start,
            text: label.clone(),
        });
        widest = widest.max(SAMPLE + 8.0 + text_width(label));
    }
    widest
}
