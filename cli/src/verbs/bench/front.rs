//! Pareto fronts: what nothing beats in both cost and error.

use super::results::Group;

/// What a picture costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cost {
    /// Building and drawing, milliseconds.
    Time,
    /// Drawing alone, milliseconds.
    Frame,
    /// Bytes read and written.
    Bytes,
}

impl Cost {
    pub(super) const ALL: [Self; 3] = [Self::Time, Self::Frame, Self::Bytes];

    /// For names of files and keys.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Frame => "frame",
            Self::Bytes => "bytes",
        }
    }
}

/// Cost and error of each row of `group`; `None` for rows without an error.
pub(super) fn points(group: &Group<'_>, cost: Cost) -> Vec<Option<[f64; 2]>> {
    let rows = group.rows.iter();
    rows.map(|row| {
        let time = &row.measured.time;
        let paid = match cost {
            Cost::Time => time.whole(),
            Cost::Frame => time.frame(),
            Cost::Bytes => row.measured.found.bytes as f64,
        };
        row.rmse().map(|rmse| [paid, rmse])
    })
    .collect()
}

/// Which of `points` no other is at least as good as in both, and better in one.
pub(super) fn front(points: &[Option<[f64; 2]>]) -> Vec<bool> {
    let beats = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    let is_best = |p: &[f64; 2]| !points.iter().flatten().any(|other| beats(other, p));
    points
        .iter()
        .map(|p| p.as_ref().is_some_and(is_best))
        .collect()
}

/// Numbers of the points on the front, the cheapest first.
pub(super) fn along(points: &[Option<[f64; 2]>]) -> Vec<usize> {
    let on = front(points);
    let mut all: Vec<(usize, [f64; 2])> = points
        .iter()
        .enumerate()
        .filter(|(k, _)| on[*k])
        .filter_map(|(k, p)| Some((k, (*p)?)))
        .collect();
    all.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
    all.into_iter().map(|(k, _)| k).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beaten_is_not_on_the_front() {
        let points = [
            Some([1.0, 0.5]),
            Some([2.0, 0.1]),
            Some([2.0, 0.2]),
            None,
            Some([3.0, 0.1]),
            Some([0.5, 0.9]),
            Some([4.0, 0.0]),
            Some([1.0, 0.5]),
        ];
        let on = front(&points);
        assert_eq!(on, [true, true, false, false, false, true, true, true]);
        assert_eq!(along(&points), [5, 0, 7, 1, 6]);
    }

    /// Nothing outside the front is unbeaten, nothing on it is beaten.
    #[test]
    fn fronts_are_by_definition() {
        let coordinate = |k: u64, m: u64| (k.wrapping_mul(m) >> 7) % 16;
        let point = |k| [coordinate(k, 0x9e37_79b9), coordinate(k, 0x85eb_ca6b)].map(|c| c as f64);
        let points: Vec<Option<[f64; 2]>> = (1..80).map(|k| Some(point(k))).collect();
        let on = front(&points);
        for (p, is_on) in points.iter().flatten().zip(&on) {
            let beaten = points.iter().flatten().any(|q| {
                let better = q[0] < p[0] || q[1] < p[1];
                better && q[0] <= p[0] && q[1] <= p[1]
            });
            assert_eq!(beaten, !is_on, "{p:?}");
        }
        assert!(on.iter().any(|o| *o) && !on.iter().all(|o| *o));
    }
}
