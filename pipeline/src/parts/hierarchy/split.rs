//! Where a part of a hierarchy is cut: where the boxes of both sides are hit least often
//! (surface area heuristic; MacDonald and Booth 1990), by bins of centres (Wald 2007).

use super::triangles::{Triangle, bounds, centre};

/// Bins along an axis.
const BINS: usize = 16;

/// Triangles whose centres are in a bin.
#[derive(Clone, Copy)]
struct Bin {
    low: [f32; 3],
    high: [f32; 3],
    count: usize,
}

const EMPTY: Bin = Bin {
    low: [f32::INFINITY; 3],
    high: [f32::NEG_INFINITY; 3],
    count: 0,
};

impl Bin {
    fn join(self, other: Self) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(other.high[k])),
            count: self.count + other.count,
        }
    }

    /// How often it is hit, but for a factor, times what there is to do then.
    fn cost(self) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|k| f64::from(self.high[k]) - f64::from(self.low[k]));
        (x * y + y * z + z * x) * self.count as f64
    }
}

/// An axis, and which bins are on the first side.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    axis: usize,
    /// Least and greatest centre.
    from: f32,
    to: f32,
    /// The last bin of the first side.
    last: usize,
}

/// Puts the numbers of the first side before those of the second, each in the order in
/// which they were; gives how many are on the first. `None` where no cut tells them apart.
pub(super) fn split(triangles: &[Triangle], part: &mut [u32]) -> Option<usize> {
    let cuts = (0..3).filter_map(|axis| best(triangles, part, axis));
    let (cut, _) = cuts.reduce(|a, b| if b.1 < a.1 { b } else { a })?;
    let is_first = |i: &u32| cut.bin(&triangles[*i as usize]) <= cut.last;
    let (first, second): (Vec<u32>, Vec<u32>) = part.iter().partition(|i| is_first(i));
    part[..first.len()].copy_from_slice(&first);
    part[first.len()..].copy_from_slice(&second);
    Some(first.len())
}

impl Cut {
    fn bin(&self, triangle: &Triangle) -> usize {
        let share = (centre(triangle, self.axis) - self.from) / (self.to - self.from);
        ((share * BINS as f32) as usize).min(BINS - 1)
    }
}

/// The best cut along an axis, and its cost; the first of equal ones.
fn best(triangles: &[Triangle], part: &[u32], axis: usize) -> Option<(Cut, f64)> {
    let centres = part.iter().map(|i| centre(&triangles[*i as usize], axis));
    let empty = (f32::INFINITY, f32::NEG_INFINITY);
    let (from, to) = centres.fold(empty, |(a, b), c| (a.min(c), b.max(c)));
    let cut = |last| Cut {
        axis,
        from,
        to,
        last,
    };
    let mut bins = [EMPTY; BINS];
    for &i in part {
        let bin = &mut bins[cut(0).bin(&triangles[i as usize])];
        let [low, high] = bounds(triangles, &[i]);
        let count = 1;
        *bin = bin.join(Bin { low, high, count });
    }
    let mut behind = [EMPTY; BINS];
    for k in (1..BINS).rev() {
        behind[k - 1] = behind[k].join(bins[k]);
    }
    let mut before = EMPTY;
    let mut best: Option<(Cut, f64)> = None;
    for last in 0..BINS - 1 {
        before = before.join(bins[last]);
        if before.count == 0 || behind[last].count == 0 {
            continue;
        }
        let cost = before.cost() + behind[last].cost();
        if best.is_none_or(|(_, least)| cost < least) {
            best = Some((cut(last), cost));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small(x: f32, y: f32) -> Triangle {
        [[x, y, 0.0], [x + 0.1, y, 0.0], [x, y + 0.1, 0.0]]
    }

    /// Two heaps are told apart, though one holds most: a cut in the middle would not.
    #[test]
    fn heaps_are_told_apart() {
        let heap = (0..30).map(|k| small(0.01 * k as f32, 0.0));
        let far = (0..3).map(|k| small(9.0, 0.01 * k as f32));
        let triangles: Vec<_> = far.chain(heap).collect();
        let mut part: Vec<u32> = (0..33).rev().collect();
        assert_eq!(split(&triangles, &mut part), Some(30));
        assert_eq!(part[30..], [2, 1, 0]);
        assert_eq!(part[..2], [32, 31]);
    }

    /// The cut that costs least is taken, wherever it is: between two heaps, not before the
    /// lone triangle behind them.
    #[test]
    fn the_cheapest_cut_is_taken() {
        let heap = |x: f32| (0..20).map(move |k| small(x + 0.01 * k as f32, 0.0));
        let triangles: Vec<_> = heap(0.0)
            .chain(heap(4.0))
            .chain([small(9.0, 0.0)])
            .collect();
        let mut part: Vec<u32> = (0..41).collect();
        assert_eq!(split(&triangles, &mut part), Some(20));
        let mirrored: Vec<_> = triangles
            .iter()
            .map(|t| t.map(|[x, y, z]| [-x, y, z]))
            .collect();
        assert_eq!(split(&mirrored, &mut part), Some(21));
    }

    /// Heaps that lie along one axis alone are told apart there, whichever it is: nothing is cut
    /// where centres are equal, and no side is ever empty.
    #[test]
    fn no_side_is_empty_where_only_one_axis_tells_apart() {
        for axis in 0..3 {
            let at = |k: u32| {
                let mut corner = [0.0; 3];
                corner[axis] = if k < 4 {
                    0.1 * k as f32
                } else {
                    8.0 + 0.1 * k as f32
                };
                [0, 1, 2].map(|j| {
                    let mut c = corner;
                    c[(axis + 1) % 3] += 0.05 * j as f32;
                    c
                })
            };
            let triangles: Vec<_> = (0..11).map(at).collect();
            let mut part: Vec<u32> = (0..11).collect();
            assert_eq!(split(&triangles, &mut part), Some(4), "{axis}");
            assert_eq!(part, (0..11).collect::<Vec<_>>());
        }
    }

    #[test]
    fn equal_centres_are_not_cut() {
        let triangles = [small(1.0, 2.0); 5];
        assert_eq!(split(&triangles, &mut [0, 1, 2, 3, 4]), None);
    }
}
