//! The colours of a light with an image, summed along lines.

use crate::geometry::line_sampling::light::{Line, LineLight};
use crate::world::light::LightShape;
use crate::world::light_image::LightImage;

/// Intervals of a line.
pub(super) const STEPS: u32 = 256;

/// Colour.
type Rgb = [f64; 3];

/// Sums from the left up to the end of each of [`STEPS`] intervals, line after line; all
/// lines together give 1 of each colour. `None` where the light is no rectangle.
pub(super) fn sums(
    shape: &LightShape,
    light: &LineLight,
    lines: &[Line],
    image: &LightImage,
) -> Option<Vec<[f32; 4]>> {
    let cells = Cells::new(shape, light, image)?;
    let all: Vec<Vec<Rgb>> = lines.iter().map(|line| cells.along(line)).collect();
    let last = all.iter().filter_map(|sums| sums.last());
    let total = last.fold([0.0; 3], |sum: Rgb, end| [0, 1, 2].map(|c| sum[c] + end[c]));
    let texel = |sum: &Rgb| {
        let share = |c: usize| (sum[c] / total[c]) as f32;
        [share(0), share(1), share(2), 0.0]
    };
    Some(all.iter().flatten().map(texel).collect())
}

/// An image, and where lines meet it.
struct Cells {
    /// Covectors from the light's coordinates to 0..=side of columns and of rows.
    rows: [[f64; 2]; 2],
    side: usize,
    shares: Vec<Rgb>,
}

impl Cells {
    fn new(shape: &LightShape, light: &LineLight, image: &LightImage) -> Option<Self> {
        let LightShape::Rectangle { edge_u, edge_v, .. } = shape else {
            return None;
        };
        let normal = edge_u.cross(*edge_v);
        let squared = normal.length_squared();
        let covectors = [
            edge_v.cross(normal) / squared,
            normal.cross(*edge_u) / squared,
        ];
        let side = image.side();
        let [x, y, _] = light.frame.axes;
        Some(Self {
            rows: covectors.map(|c| [c.dot(x), c.dot(y)].map(|v| v * side as f64)),
            side,
            shares: image.shares(),
        })
    }

    /// Column and row, from the light's corner.
    fn place(&self, x: f64, y: f64) -> [f64; 2] {
        self.rows
            .map(|r| r[0] * x + r[1] * y + 0.5 * self.side as f64)
    }

    fn share(&self, x: f64, y: f64) -> Rgb {
        let most = (self.side - 1) as f64;
        let [column, row] = self
            .place(x, y)
            .map(|v| v.floor().clamp(0.0, most) as usize);
        self.shares[row * self.side + column]
    }

    /// Sums at the ends of steps, from pieces between borders of texels.
    fn along(&self, line: &Line) -> Vec<Rgb> {
        let length = line.right - line.left;
        let step = |k: u32| line.left + length * (f64::from(k) / f64::from(STEPS));
        let mut ends: Vec<f64> = (0..=STEPS).map(step).collect();
        ends.extend(self.borders(line));
        ends.sort_by(f64::total_cmp);
        let (mut sums, mut sum, mut next) = (vec![[0.0; 3]], [0.0; 3], 1);
        for pair in ends.windows(2) {
            let share = self.share(0.5 * (pair[0] + pair[1]), line.y);
            sum = [0, 1, 2].map(|c| sum[c] + share[c] * (pair[1] - pair[0]));
            while next <= STEPS && pair[1] >= step(next) {
                sums.push(sum);
                next += 1;
            }
        }
        sums.resize(STEPS as usize + 1, sum);
        sums
    }

    /// Where a line passes from texel to texel.
    fn borders<'a>(&'a self, line: &'a Line) -> impl Iterator<Item = f64> + 'a {
        let inside = move |x: &f64| *x > line.left && *x < line.right;
        let of = move |k: usize| {
            let row = self.rows[k];
            let first = self.place(0.0, line.y)[k];
            (0..=self.side).map(move |border| (border as f64 - first) / row[0])
        };
        (0..2).flat_map(of).filter(inside)
    }
}
