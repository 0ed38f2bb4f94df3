//! Where labels stand: near their points, on nothing else.

use super::layout::{LINE_HEIGHT, text_width};

/// A rectangle: left, top, right, bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect(pub(super) [f32; 4]);

impl Rect {
    /// A square round a point.
    pub(super) fn round([x, y]: [f32; 2], reach: f32) -> Self {
        Self([x - reach, y - reach, x + reach, y + reach])
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let [a, b] = [self.0, other.0];
        a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
    }

    pub(super) fn holds(&self, other: &Self) -> bool {
        let [a, b] = [self.0, other.0];
        a[0] <= b[0] && a[1] <= b[1] && a[2] >= b[2] && a[3] >= b[3]
    }

    /// Its point that is nearest to `to`.
    pub(super) fn nearest(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [left, top, right, bottom] = self.0;
        [x.max(left).min(right), y.max(top).min(bottom)]
    }

    /// Whether the segment from `a` to `b` runs through it (Liang and Barsky).
    fn is_crossed(&self, a: [f32; 2], b: [f32; 2]) -> bool {
        let [left, top, right, bottom] = self.0;
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let (mut enter, mut leave) = (0.0f32, 1.0f32);
        for (step, room) in [
            (-dx, a[0] - left),
            (dx, right - a[0]),
            (-dy, a[1] - top),
            (dy, bottom - a[1]),
        ] {
            if step == 0.0 {
                if room <= 0.0 {
                    return false;
                }
            } else if step < 0.0 {
                enter = enter.max(room / step);
            } else {
                leave = leave.min(room / step);
            }
        }
        enter < leave
    }
}

/// A label and what it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wanted {
    pub(super) text: String,
    pub(super) at: [f32; 2],
}

/// A label in its place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placed {
    pub(super) text: String,
    /// The point.
    pub(super) at: [f32; 2],
    pub(super) rect: Rect,
}

impl Placed {
    /// The line from the point to the label, where the label is not beside it.
    pub(super) fn leader(&self) -> Option<[[f32; 2]; 2]> {
        let end = self.rect.nearest(self.at);
        let [dx, dy] = [end[0] - self.at[0], end[1] - self.at[1]];
        (dx * dx + dy * dy > BESIDE * BESIDE).then_some([self.at, end])
    }
}

/// Distance of a label that needs no line to its point.
const BESIDE: f32 = 22.0;
/// Height of a label's box.
pub(super) const HEIGHT: f32 = 22.0;
const MARGIN: f32 = 4.0;
/// Gaps between a point and its label that are tried, nearest first.
const GAPS: [f32; 11] = [
    12.0, 18.0, 30.0, 45.0, 65.0, 90.0, 125.0, 170.0, 230.0, 300.0, 380.0,
];
/// Directions, best first.
const DIRECTIONS: [[f32; 2]; 12] = [
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.0, -1.0],
    [0.0, 1.0],
    [0.7, -0.7],
    [-0.7, -0.7],
    [0.7, 0.7],
    [-0.7, 0.7],
    [0.35, -0.95],
    [-0.35, -0.95],
    [0.35, 0.95],
    [-0.35, 0.95],
];

/// Places labels one after the other inside `area`, free of `obstacles` and of each
/// other. What finds no place stands in a column to the right of it, from `column` on.
pub(super) fn place(
    wanted: &[Wanted],
    obstacles: &[Rect],
    area: Rect,
    column: [f32; 2],
) -> Vec<Placed> {
    let mut placed: Vec<Placed> = Vec::new();
    let mut aside = 0;
    for label in wanted {
        let near = |crossing| near(label, obstacles, area, &placed, crossing);
        let near = near(false).or_else(|| near(true));
        let rect = near.unwrap_or_else(|| {
            let top = column[1] + LINE_HEIGHT * aside as f32;
            aside += 1;
            sized(&label.text, [column[0], top])
        });
        placed.push(Placed {
            text: label.text.clone(),
            at: label.at,
            rect,
        });
    }
    placed
}

/// The first place near the point that is free, and that no line between a label and its
/// point crosses, unless `crossing` is allowed.
fn near(
    label: &Wanted,
    obstacles: &[Rect],
    area: Rect,
    placed: &[Placed],
    crossing: bool,
) -> Option<Rect> {
    let candidates = GAPS
        .iter()
        .flat_map(|gap| DIRECTIONS.map(|d| candidate(label, *gap, d)));
    let free = |rect: &Rect| {
        let clear = |o: &Rect| !o.overlaps(rect);
        area.holds(rect)
            && obstacles.iter().all(clear)
            && placed
                .iter()
                .all(|p| clear(&p.rect) && (crossing || !crosses(p, rect, label.at)))
    };
    candidates.into_iter().find(free)
}

/// Whether one of two labels stands on the line of the other.
fn crosses(known: &Placed, rect: &Rect, at: [f32; 2]) -> bool {
    let line = known.leader();
    line.is_some_and(|[a, b]| rect.is_crossed(a, b)) || known.rect.is_crossed(at, rect.nearest(at))
}

fn candidate(label: &Wanted, gap: f32, [dx, dy]: [f32; 2]) -> Rect {
    let width = text_width(&label.text) + 2.0 * MARGIN;
    let [x, y] = [label.at[0] + gap * dx, label.at[1] + gap * dy];
    let left = match dx {
        d if d > 0.5 => x,
        d if d < -0.5 => x - width,
        d => x - 0.5 * width + 0.5 * width * d,
    };
    let top = match dy {
        d if d > 0.5 => y,
        d if d < -0.5 => y - HEIGHT,
        _ => y - 0.5 * HEIGHT,
    };
    sized(&label.text, [left, top])
}

fn sized(text: &str, [left, top]: [f32; 2]) -> Rect {
    let width = text_width(text) + 2.0 * MARGIN;
    Rect([left, top, left + width, top + HEIGHT])
}

/// Where the text of a label begins: left and top.
pub(super) fn text_at(rect: &Rect) -> [f32; 2] {
    [rect.0[0] + MARGIN, rect.0[1] + MARGIN]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crowd(count: usize) -> Vec<Wanted> {
        let label = |k: usize| Wanted {
            text: format!("label number {k}"),
            at: [200.0 + 37.0 * (k % 7) as f32, 150.0 + 23.0 * (k / 7) as f32],
        };
        (0..count).map(label).collect()
    }

    /// Nothing overlaps, however many there are; what has no room stands aside.
    #[test]
    fn labels_overlap_nothing() {
        let area = Rect([0.0, 0.0, 900.0, 600.0]);
        for count in [1, 10, 40, 120] {
            let wanted = crowd(count);
            let obstacles: Vec<Rect> = wanted.iter().map(|w| Rect::round(w.at, 11.0)).collect();
            let placed = place(&wanted, &obstacles, area, [920.0, 0.0]);
            assert_eq!(placed.len(), count);
            for (k, a) in placed.iter().enumerate() {
                assert!(
                    placed[..k].iter().all(|b| !a.rect.overlaps(&b.rect)),
                    "{a:?}"
                );
                assert!(obstacles.iter().all(|o| !a.rect.overlaps(o)), "{a:?}");
                assert!(area.holds(&a.rect) || a.rect.0[0] == 920.0, "{a:?}");
            }
        }
    }

    #[test]
    fn a_lone_label_stands_beside_its_point_without_a_line() {
        let placed = place(&crowd(1), &[], Rect([0.0, 0.0, 900.0, 600.0]), [920.0, 0.0]);
        assert_eq!(placed[0].leader(), None);
        assert_eq!(placed[0].rect.0[0], 212.0);
        let far = place(&crowd(1), &[], Rect([0.0; 4]), [920.0, 0.0]);
        assert!(far[0].leader().is_some());
    }

    #[test]
    fn segments_cross_what_they_run_through() {
        let rect = Rect([0.0, 0.0, 2.0, 1.0]);
        assert!(rect.is_crossed([-1.0, 0.5], [3.0, 0.5]));
        assert!(rect.is_crossed([1.0, 0.5], [9.0, 9.0]));
        assert!(!rect.is_crossed([-1.0, 0.5], [-0.5, 0.5]));
        assert!(!rect.is_crossed([-1.0, 2.0], [3.0, 2.0]));
        assert!(!rect.is_crossed([0.0, -1.0], [-1.0, 1.0]));
    }
}
