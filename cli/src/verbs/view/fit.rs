//! A picture fitted into cells of a terminal, each of which is two square points high.

use crate::draw::Picture;

/// Where a picture lies in an area of cells, in points: half a cell high each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fit {
    /// The picture's pixels.
    picture: [u32; 2],
    /// The points that it takes.
    pub(super) points: [u32; 2],
    /// The cell of its top left corner.
    pub(super) corner: [u16; 2],
}

/// The points of an area of cells.
pub(super) fn points_of(cells: [u16; 2]) -> [u32; 2] {
    [u32::from(cells[0]), 2 * u32::from(cells[1])]
}

impl Fit {
    /// As large as goes into the area, in the middle; `None` where either is empty.
    pub(super) fn new(picture: [u32; 2], cells: [u16; 2]) -> Option<Self> {
        let room = points_of(cells);
        if picture.contains(&0) || room.contains(&0) {
            return None;
        }
        let [w, h] = picture.map(u64::from);
        let [across, down] = room.map(u64::from);
        // The side that is short of room decides.
        let points = match w * down >= h * across {
            true => [across, (h * across / w).clamp(1, down)],
            false => [(w * down / h).clamp(1, across), down],
        };
        let points = points.map(|p| p as u32);
        let left = (room[0] - points[0]) / 2;
        let above = (room[1] - points[1]) / 4;
        Some(Self {
            picture,
            points,
            corner: [left as u16, above as u16],
        })
    }

    /// The pixel in the middle of a point.
    pub(super) fn pixel(&self, point: [u32; 2]) -> [u32; 2] {
        [0, 1].map(|a| {
            let middle = (2 * u64::from(point[a]) + 1) * u64::from(self.picture[a]);
            let pixel = middle / (2 * u64::from(self.points[a]));
            (pixel as u32).min(self.picture[a] - 1)
        })
    }

    /// The point that shows the middle of a pixel.
    pub(super) fn point(&self, pixel: [u32; 2]) -> [u32; 2] {
        [0, 1].map(|a| {
            let middle = (2 * u64::from(pixel[a]) + 1) * u64::from(self.points[a]);
            let point = middle / (2 * u64::from(self.picture[a]));
            (point as u32).min(self.points[a] - 1)
        })
    }

    /// The pixel under a cell of the area, in its upper half; `None` beside the picture.
    pub(super) fn under(&self, cell: [u16; 2]) -> Option<[u32; 2]> {
        let [x, y] = [0, 1].map(|a| cell[a].checked_sub(self.corner[a]).map(u32::from));
        let point = [x?, 2 * y?];
        let inside = point[0] < self.points[0] && point[1] < self.points[1];
        inside.then(|| self.pixel(point))
    }
}

/// The picture at `points`, row by row: pixels repeated where there are more points, and the
/// mean of those that a point stands for where there are fewer.
pub(super) fn scaled(picture: &Picture, points: [u32; 2]) -> Vec<[u8; 3]> {
    let spans = [0, 1].map(|a| spans(picture.size[a], points[a]));
    let mean = |xs: &[u32; 2], ys: &[u32; 2]| {
        let mut sum = [0u64; 3];
        for y in ys[0]..ys[1] {
            for x in xs[0]..xs[1] {
                let at = y as usize * picture.size[0] as usize + x as usize;
                let pixel = picture.pixels[at];
                (0..3).for_each(|c| sum[c] += u64::from(pixel[c]));
            }
        }
        let count = u64::from(xs[1] - xs[0]) * u64::from(ys[1] - ys[0]);
        sum.map(|s| ((s + count / 2) / count) as u8)
    };
    let rows = spans[1].iter();
    rows.flat_map(|ys| spans[0].iter().map(|xs| mean(xs, ys)))
        .collect()
}

/// First pixel, and the one behind the last, of every point.
fn spans(pixels: u32, points: u32) -> Vec<[u32; 2]> {
    let at = |point: u32| (u64::from(point) * u64::from(pixels) / u64::from(points)) as u32;
    (0..points)
        .map(|p| [at(p), at(p + 1).max(at(p) + 1)])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_the_areas_points_is_shown_as_it_is() {
        let fit = Fit::new([80, 44], [80, 22]).unwrap();
        assert_eq!((fit.points, fit.corner), ([80, 44], [0, 0]));
        for pixel in [[0, 0], [79, 43], [17, 30]] {
            assert_eq!((fit.point(pixel), fit.pixel(pixel)), (pixel, pixel));
        }
        assert_eq!(fit.under([3, 7]), Some([3, 14]));
        assert_eq!(fit.under([80, 7]), None);
    }

    #[test]
    fn others_are_fitted_in_and_lie_in_the_middle() {
        let wide = Fit::new([400, 100], [40, 20]).unwrap();
        assert_eq!((wide.points, wide.corner), ([40, 10], [0, 7]));
        let tall = Fit::new([100, 400], [40, 20]).unwrap();
        assert_eq!((tall.points, tall.corner), ([10, 40], [15, 0]));
        assert_eq!(tall.under([14, 0]), None);
        assert_eq!(tall.under([15, 1]), Some([5, 25]));
        assert_eq!(tall.point([99, 399]), [9, 39]);
        let one = Fit::new([8192, 1], [1, 1]).unwrap();
        assert_eq!((one.points, one.pixel([0, 0])), ([1, 1], [4096, 0]));
        assert_eq!(Fit::new([5, 5], [0, 3]), None);
    }

    #[test]
    fn pixels_are_repeated_or_their_mean_is_taken() {
        let pixels = [0, 10, 20, 31].map(|v| [v, 0, 100 + v, 255]).to_vec();
        let picture = Picture {
            size: [2, 2],
            pixels,
        };
        let twice = scaled(&picture, [4, 2]);
        let reds: Vec<u8> = twice.iter().map(|p| p[0]).collect();
        assert_eq!(reds, [0, 0, 10, 10, 20, 20, 31, 31]);
        assert_eq!(scaled(&picture, [1, 1]), [[15, 0, 115]]);
        assert_eq!(scaled(&picture, [1, 2])[1], [26, 0, 126]);
    }
}
