//! Points of many series over logarithmic axes, labelled where they stand.

use gnomon_claims::chart::Axis;

use super::axis::Range;
use super::layout::{
    Anchor, BOTTOM, GAP, INK, Item, LEFT, LINE_HEIGHT, Layout, PAPER, Plot, TOP, text_width,
};
use super::mark::{Marker, REACH};
use super::place::{HEIGHT, Placed, Rect, Wanted, place, text_at};

/// Width and height of the area between the axes, in pixels.
const AREA: [f32; 2] = [1180.0, 820.0];

/// A plot of labelled points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cloud {
    /// One line above.
    pub(crate) title: String,
    /// Horizontal and vertical axis.
    pub(crate) axes: [Axis; 2],
    /// What is plotted.
    pub(crate) series: Vec<Member>,
    /// Points that a line of steps joins, from left to right.
    pub(crate) front: Vec<[f64; 2]>,
}

/// Points that are marked alike and joined by a thin line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Member {
    /// Decides the marker: the same number, the same marker, in every plot.
    pub(crate) number: usize,
    pub(crate) spots: Vec<Spot>,
}

/// A point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spot {
    pub(crate) at: [f64; 2],
    /// Stands beside it.
    pub(crate) label: Option<String>,
    /// For whoever points at it.
    pub(crate) title: String,
}

impl Cloud {
    /// Lines, markers and text in pixels.
    pub(super) fn lay_out(&self) -> Layout {
        let spots = || self.series.iter().flat_map(|m| &m.spots);
        let values = |k: usize| {
            spots()
                .map(move |s| s.at[k])
                .chain(self.front.iter().map(move |p| p[k]))
        };
        let plot = Plot {
            x: Range::new(self.axes[0].scale, values(0)),
            y: Range::new(self.axes[1].scale, values(1)),
            area: AREA,
        };
        let mut items = Vec::new();
        plot.draw_grid(&self.title, [&self.axes[0], &self.axes[1]], &mut items);
        items.extend(self.series.iter().map(|m| joined(&plot, m)));
        items.push(steps(&plot, &self.front));
        let labels = self.labels(&plot);
        items.extend(labels.iter().flat_map(label_items));
        for member in &self.series {
            let marker = Marker::of(member.number);
            let shown = member
                .spots
                .iter()
                .filter_map(|s| Some((plot.at(s.at)?, &s.title)));
            items.extend(shown.flat_map(|(at, title)| marker.items(at, title)));
        }
        Layout {
            size: size(&labels, &self.title),
            paper: PAPER,
            ink: INK,
            title: self.title.clone(),
            items,
        }
    }

    fn labels(&self, plot: &Plot) -> Vec<Placed> {
        let spots = || self.series.iter().flat_map(|m| &m.spots);
        let wanted = spots().filter_map(|s| {
            Some(Wanted {
                text: s.label.clone()?,
                at: plot.at(s.at)?,
            })
        });
        let places = spots().filter_map(|s| plot.at(s.at));
        let obstacles: Vec<Rect> = places.map(|at| Rect::round(at, REACH)).collect();
        let area = Rect([LEFT + 4.0, TOP + 2.0, LEFT + AREA[0], TOP + AREA[1] - 2.0]);
        let column = [LEFT + AREA[0] + GAP, TOP];
        place(&wanted.collect::<Vec<_>>(), &obstacles, area, column)
    }
}

/// The thin line of a series.
fn joined(plot: &Plot, member: &Member) -> Item {
    Item::Line {
        points: member.spots.iter().filter_map(|s| plot.at(s.at)).collect(),
        colour: Marker::of(member.number).colour,
        width: 1.0,
        dashed: false,
    }
}

/// The front: whatever lies above and to the right of it is beaten.
fn steps(plot: &Plot, front: &[[f64; 2]]) -> Item {
    let mut points: Vec<[f32; 2]> = Vec::new();
    for at in front.iter().filter_map(|p| plot.at(*p)) {
        if let Some(last) = points.last().copied() {
            points.push([at[0], last[1]]);
        }
        points.push(at);
    }
    Item::Line {
        points,
        colour: INK,
        width: 3.0,
        dashed: true,
    }
}

/// The line to a label, paper under it, the text.
fn label_items(label: &Placed) -> Vec<Item> {
    let mut items = Vec::new();
    if let Some(points) = label.leader() {
        items.push(Item::Line {
            points: points.to_vec(),
            colour: INK,
            width: 1.0,
            dashed: false,
        });
    }
    let [left, top, right, _] = label.rect.0;
    items.push(Item::Bar {
        at: [left, top],
        size: [right - left, HEIGHT],
        colour: PAPER,
    });
    items.push(Item::Text {
        at: text_at(&label.rect),
        anchor: Anchor::Start,
        text: label.text.clone(),
    });
    items
}

/// Large enough for all labels, also those that stand aside.
fn size(labels: &[Placed], title: &str) -> [u32; 2] {
    let ends = |k: usize| labels.iter().map(move |l| l.rect.0[k]).fold(0.0, f32::max);
    let width = (LEFT + AREA[0] + GAP)
        .max(ends(2) + GAP)
        .max(text_width(title) + 2.0 * GAP);
    let height = (TOP + AREA[1] + BOTTOM).max(ends(3) + LINE_HEIGHT);
    [width, height].map(|s| s.ceil() as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> Cloud {
        let spot = |x: f64, y: f64, label: Option<&str>| Spot {
            at: [x, y],
            label: label.map(str::to_owned),
            title: format!("{x} {y}"),
        };
        Cloud {
            title: "Error".to_owned(),
            axes: [Axis::log10("ms"), Axis::log10("RMSE")],
            series: vec![
                Member {
                    number: 0,
                    spots: vec![spot(1.0, 0.1, None), spot(2.0, 0.01, Some("first"))],
                },
                Member {
                    number: 1,
                    spots: vec![
                        spot(5.0, 0.05, Some("second")),
                        spot(0.0, 0.5, Some("hidden")),
                    ],
                },
            ],
            front: vec![[1.0, 0.1], [2.0, 0.01]],
        }
    }

    #[test]
    fn every_point_has_a_marker_with_words_and_labels_stand_in_both_files() {
        let layout = cloud().lay_out();
        let markers = layout
            .items
            .iter()
            .filter(|i| matches!(i, Item::Marker { .. }));
        assert_eq!(
            markers.count(),
            3,
            "a point at 0 has no place on a logarithmic axis"
        );
        let svg = super::super::cloud_svg(&cloud());
        for part in [
            "first</text>",
            "second</text>",
            "<title>2 0.01</title>",
            "stroke-dasharray",
        ] {
            assert!(svg.contains(part), "{part}");
        }
        assert!(!svg.contains("hidden") && !svg.contains("NaN"));
        assert_eq!(super::super::cloud_picture(&cloud()).size, layout.size);
        let page = super::super::cloud_in_page(&cloud());
        assert!(
            page.contains("var(--ink)")
                && page.contains("var(--page)")
                && !page.contains("#ffffff")
        );
    }

    /// One step for two points: right, then down.
    #[test]
    fn the_front_goes_in_steps() {
        let plot = Plot {
            x: Range::new(gnomon_claims::chart::Scale::Log10, [1.0, 10.0].into_iter()),
            y: Range::new(gnomon_claims::chart::Scale::Log10, [0.01, 0.1].into_iter()),
            area: AREA,
        };
        let Item::Line { points, .. } = steps(&plot, &cloud().front) else {
            panic!("a line");
        };
        assert_eq!(points.len(), 3);
        assert!(points[1] == [points[2][0], points[0][1]] && points[2][1] > points[0][1]);
    }
}
