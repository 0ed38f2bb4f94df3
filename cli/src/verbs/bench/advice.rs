//! Which technique one should use at which error.

use super::front::{Cost, points};
use super::results::{Group, Results, Row};

/// Errors that are asked for.
pub(super) const LIMITS: [f64; 8] = [0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001];

/// The cheapest row of `group` whose RMSE is at most `limit`; the first of equal ones.
pub(super) fn cheapest<'a>(group: &Group<'a>, cost: Cost, limit: f64) -> Option<(Row<'a>, f64)> {
    let points = points(group, cost);
    let rows = group.rows.iter().zip(points);
    let fine = rows.filter_map(|(row, p)| p.filter(|p| p[1] <= limit).map(|p| (*row, p[0])));
    fine.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// A technique with settings over all scenes of one size and number of threads.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Overall {
    pub(super) label: String,
    /// The largest RMSE.
    pub(super) worst: f64,
    /// What all scenes cost together.
    pub(super) cost: f64,
}

/// Groups that differ in their scenes only, in order.
pub(super) fn families<'a>(results: &'a Results) -> Vec<Vec<Group<'a>>> {
    let mut families: Vec<Vec<Group<'a>>> = Vec::new();
    for group in results.groups() {
        let like = |f: &&mut Vec<Group<'_>>| {
            f.iter()
                .all(|g| (g.size, g.threads) == (group.size, group.threads))
        };
        match families.iter_mut().find(like) {
            Some(family) => family.push(group),
            None => families.push(vec![group]),
        }
    }
    families
}

/// Every technique with settings that was measured on all scenes of `family`.
pub(super) fn overall(family: &[Group<'_>], cost: Cost) -> Vec<Overall> {
    let Some((first, others)) = family.split_first() else {
        return Vec::new();
    };
    let mut all: Vec<Overall> = Vec::new();
    for (row, point) in first.rows.iter().zip(points(first, cost)) {
        let label = row.cell.label();
        let found = others.iter().map(|g| point_of(g, cost, &label));
        let found = std::iter::once(point)
            .chain(found)
            .collect::<Option<Vec<_>>>();
        all.extend(found.map(|points| Overall {
            label,
            worst: points.iter().map(|p| p[1]).fold(0.0, f64::max),
            cost: points.iter().map(|p| p[0]).sum(),
        }));
    }
    all
}

fn point_of(group: &Group<'_>, cost: Cost, label: &str) -> Option<[f64; 2]> {
    let at = group.rows.iter().position(|r| r.cell.label() == label)?;
    points(group, cost)[at]
}

/// The cheapest of `all` whose worst RMSE is at most `limit`.
pub(super) fn best(all: &[Overall], limit: f64) -> Option<&Overall> {
    let fine = all.iter().filter(|o| o.worst <= limit);
    fine.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_keeps_the_limit_on_every_scene_at_the_least_cost() {
        let of = |label: &str, worst, cost| Overall {
            label: label.to_owned(),
            worst,
            cost,
        };
        let all = [of("a", 0.1, 1.0), of("b", 0.01, 5.0), of("c", 0.009, 4.0)];
        let label = |limit| best(&all, limit).map(|o| o.label.as_str());
        assert_eq!(
            [label(0.2), label(0.1), label(0.05)],
            [Some("a"), Some("a"), Some("c")]
        );
        assert_eq!(label(0.001), None);
    }
}
