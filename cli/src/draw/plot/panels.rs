//! Small plots over the same axes, one for each name: to be compared at a glance where lines
//! in one plot would hide each other.

use gnomon_claims::chart::Axis;

use super::axis::{Range, tick_label};
use super::layout::{
    Anchor, COLOURS, GAP, GREY, GRID, INK, Item, LEFT, LINE_HEIGHT, Layout, PAPER, TOP, text_width,
};

/// Width and height of a panel's area, in pixels.
const AREA: [f32; 2] = [348.0, 110.0];
/// Panels beside each other.
const ACROSS: usize = 4;
/// Above a panel's area: its name.
const HEAD: f32 = LINE_HEIGHT + 6.0;
/// Between panels: half a label of the one and of the other.
const BESIDE: f32 = 64.0;
/// Ticks of a narrow axis.
const MOST_TICKS: usize = 5;
/// Under the last row: ticks, and what is along the axis.
const FOOT: f32 = 66.0;

/// Panels over common axes.
pub(crate) struct Panels {
    pub(crate) title: String,
    /// Horizontal and vertical.
    pub(crate) axes: [Axis; 2],
    pub(crate) panels: Vec<Panel>,
}

/// A panel.
pub(crate) struct Panel {
    pub(crate) name: String,
    /// In order; the line is interrupted where a point cannot be shown.
    pub(crate) points: Vec<[f64; 2]>,
    /// What is above it is marked; drawn as a dashed line.
    pub(crate) limit: Option<f64>,
}

impl Panels {
    pub(super) fn lay_out(&self) -> Layout {
        let columns = self.panels.len().clamp(1, ACROSS);
        let rows = self.panels.len().div_ceil(columns).max(1);
        let plot = Plot {
            ranges: self.ranges(),
            columns,
            rows,
            count: self.panels.len(),
        };
        let mut items = vec![
            text([GAP, 12.0], Anchor::Start, &self.title),
            text([GAP, 44.0], Anchor::Start, &self.axes[1].label),
        ];
        for (number, panel) in self.panels.iter().enumerate() {
            plot.draw(number, panel, &mut items);
        }
        let [width, height] = plot.size();
        let middle = [LEFT + 0.5 * (width - LEFT), height - 30.0];
        items.push(text(middle, Anchor::Middle, &self.axes[0].label));
        let width = width.max(text_width(&self.title) + 2.0 * GAP);
        Layout {
            size: [width.ceil() as u32, height.ceil() as u32],
            paper: PAPER,
            ink: INK,
            title: self.title.clone(),
            items,
        }
    }

    /// Of both axes, over all panels.
    fn ranges(&self) -> [Range; 2] {
        let points = || self.panels.iter().flat_map(|p| &p.points);
        let limits = self.panels.iter().filter_map(|p| p.limit);
        [
            Range::new(self.axes[0].scale, points().map(|p| p[0])),
            Range::new(self.axes[1].scale, points().map(|p| p[1]).chain(limits)),
        ]
    }
}

struct Plot {
    ranges: [Range; 2],
    columns: usize,
    rows: usize,
    count: usize,
}

impl Plot {
    fn size(&self) -> [f32; 2] {
        let [columns, rows] = [self.columns as f32, self.rows as f32];
        [
            LEFT + columns * (AREA[0] + BESIDE),
            TOP + rows * (AREA[1] + HEAD) + FOOT,
        ]
    }

    /// Left and top of the area of panel number `number`.
    fn corner(&self, number: usize) -> [f32; 2] {
        let [column, row] = [number % self.columns, number / self.columns];
        [
            LEFT + column as f32 * (AREA[0] + BESIDE),
            TOP + HEAD + row as f32 * (AREA[1] + HEAD),
        ]
    }

    fn draw(&self, number: usize, panel: &Panel, items: &mut Vec<Item>) {
        let [left, top] = self.corner(number);
        items.push(text([left, top - LINE_HEIGHT], Anchor::Start, &panel.name));
        self.draw_grid(number, items);
        if let Some(y) = panel.limit.and_then(|l| self.at_y(top, l)) {
            items.push(line(vec![[left, y], [left + AREA[0], y]], GREY, 1.5, true));
        }
        let at = |p: &[f64; 2]| Some([self.at_x(left, p[0])?, self.at_y(top, p[1])?]);
        let places: Vec<Option<[f32; 2]>> = panel.points.iter().map(at).collect();
        for run in places.split(Option::is_none).filter(|run| run.len() > 1) {
            let points = run.iter().flatten().copied().collect();
            items.push(line(points, COLOURS[0], 2.0, false));
        }
        let shown = panel.points.iter().zip(&places);
        items.extend(shown.filter_map(|(point, place)| {
            let is_over = panel.limit.is_some_and(|limit| point[1] > limit);
            Some(Item::Dot {
                at: (*place)?,
                radius: if is_over { 5.0 } else { 3.0 },
                colour: COLOURS[usize::from(is_over)],
            })
        }));
    }

    /// Lines at ticks; labels where no other panel is left of it or below.
    fn draw_grid(&self, number: usize, items: &mut Vec<Item>) {
        let [left, top] = self.corner(number);
        let [right, bottom] = [left + AREA[0], top + AREA[1]];
        let is_last = number + self.columns >= self.count;
        for value in few(&self.ranges[0].ticks) {
            let Some(x) = self.at_x(left, value) else {
                continue;
            };
            items.push(line(vec![[x, top], [x, bottom]], GRID, 1.0, false));
            if is_last {
                items.push(text([x, bottom + 8.0], Anchor::Middle, &tick_label(value)));
            }
        }
        for value in few(&self.ranges[1].ticks) {
            let Some(y) = self.at_y(top, value) else {
                continue;
            };
            items.push(line(vec![[left, y], [right, y]], GRID, 1.0, false));
            if number.is_multiple_of(self.columns) {
                let label = tick_label(value);
                items.push(text([LEFT - 8.0, y - 7.0], Anchor::End, &label));
            }
        }
        items.push(line(vec![[left, top], [left, bottom]], INK, 1.0, false));
        items.push(line(vec![[left, bottom], [right, bottom]], INK, 1.0, false));
    }

    fn at_x(&self, left: f32, x: f64) -> Option<f32> {
        self.ranges[0].place(x).map(|t| left + AREA[0] * t as f32)
    }

    fn at_y(&self, top: f32, y: f64) -> Option<f32> {
        let place = self.ranges[1].place(y);
        place.map(|t| top + AREA[1] * (1.0 - t as f32))
    }
}

/// As many ticks as a narrow axis has room for.
fn few(ticks: &[f64]) -> impl Iterator<Item = f64> {
    let step = ticks.len().div_ceil(MOST_TICKS).max(1);
    ticks.iter().copied().step_by(step)
}

fn text(at: [f32; 2], anchor: Anchor, text: &str) -> Item {
    Item::Text {
        at,
        anchor,
        text: text.to_owned(),
    }
}

fn line(points: Vec<[f32; 2]>, colour: [u8; 3], width: f32, dashed: bool) -> Item {
    Item::Line {
        points,
        colour,
        width,
        dashed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panels(count: usize) -> Panels {
        let panel = |k: usize| Panel {
            name: format!("name {k}"),
            points: vec![[1.0, 0.1], [10.0, f64::NAN], [100.0, 0.2], [1000.0, 0.9]],
            limit: Some(0.3),
        };
        Panels {
            title: "error".to_owned(),
            axes: [Axis::log10("scale"), Axis::log10("RMSE")],
            panels: (0..count).map(panel).collect(),
        }
    }

    #[test]
    fn points_above_the_limit_are_marked_and_gaps_stay_gaps() {
        let items = panels(1).lay_out().items;
        let dots = |wanted: [u8; 3]| {
            let is = |i: &&Item| matches!(i, Item::Dot { colour, .. } if *colour == wanted);
            items.iter().filter(is).count()
        };
        assert_eq!([dots(COLOURS[0]), dots(COLOURS[1])], [2, 1]);
        let lines = items.iter().filter_map(|i| match i {
            Item::Line { points, colour, .. } if *colour == COLOURS[0] => Some(points.len()),
            _ => None,
        });
        assert_eq!(lines.collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn everything_lies_inside_and_every_panel_has_its_name() {
        for count in [1, 4, 5, 34] {
            let layout = panels(count).lay_out();
            let [width, height] = layout.size.map(|s| s as f32);
            let mut names = 0;
            for item in &layout.items {
                let places = match item {
                    Item::Line { points, .. } => points.clone(),
                    Item::Dot { at, .. } | Item::Text { at, .. } => vec![*at],
                    _ => Vec::new(),
                };
                let is_in =
                    |[x, y]: &[f32; 2]| (0.0..=width).contains(x) && (0.0..=height).contains(y);
                assert!(places.iter().all(is_in), "{item:?}");
                names += usize::from(
                    matches!(item, Item::Text { text, .. } if text.starts_with("name")),
                );
            }
            assert_eq!(names, count);
        }
    }
}
