//! Plots: error against each cost, for each group.

use gnomon_claims::chart::Axis;

use super::front::{Cost, along, front, points};
use super::results::{Group, Results, Row};
use crate::draw::plot::{Cloud, Member, Spot};
use crate::output::numbers;

/// Errors below are shown here: a logarithmic axis has no 0.
const FLOOR: f64 = 1e-5;

/// A plot, and the name of its files.
pub(super) struct Chart {
    pub(super) name: String,
    pub(super) cloud: Cloud,
}

/// The plots of `group`, one for each cost.
pub(super) fn of_group(results: &Results, group: &Group<'_>) -> Vec<Chart> {
    let chart = |cost: Cost| Chart {
        name: format!("{}-{}", group.stem(), cost.name()),
        cloud: cloud(&techniques(results), group, cost),
    };
    Cost::ALL.map(chart).into()
}

/// Techniques in the order of the suite, which decides their markers.
fn techniques(results: &Results) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for cell in &results.plan.cells {
        if !names.contains(&cell.technique.as_str()) {
            names.push(&cell.technique);
        }
    }
    names
}

fn cloud(techniques: &[&str], group: &Group<'_>, cost: Cost) -> Cloud {
    let points = points(group, cost);
    let labels = labels(group, &points);
    let shown: Vec<Option<[f64; 2]>> = points.iter().map(|p| p.map(|p| scaled(p, cost))).collect();
    let mut series = Vec::new();
    for (number, technique) in techniques.iter().enumerate() {
        let rows = group.rows.iter().enumerate();
        let own = rows.filter(|(_, row)| row.cell.technique == *technique);
        let mut spots: Vec<Spot> = own
            .filter_map(|(k, row)| Some(spot(row, shown[k]?, labels[k].clone(), cost)))
            .collect();
        spots.sort_by(|a, b| a.at[0].total_cmp(&b.at[0]));
        series.push(Member { number, spots });
    }
    Cloud {
        title: format!("{}: error against {}", group.title(), what(cost)),
        axes: [
            Axis::log10(axis(cost)),
            Axis::log10("RMSE of visibility (1e-5 and less at the bottom)"),
        ],
        series,
        front: along(&points)
            .into_iter()
            .filter_map(|k| shown[k])
            .collect(),
    }
}

fn what(cost: Cost) -> &'static str {
    match cost {
        Cost::Time => "time from the mesh on",
        Cost::Frame => "time of a frame, once built",
        Cost::Bytes => "bytes",
    }
}

fn axis(cost: Cost) -> &'static str {
    match cost {
        Cost::Time => "build and frame, ms",
        Cost::Frame => "frame, ms",
        Cost::Bytes => "bytes read and written, MB",
    }
}

fn scaled([paid, rmse]: [f64; 2], cost: Cost) -> [f64; 2] {
    let unit = match cost {
        Cost::Bytes => 1e6,
        _ => 1.0,
    };
    [paid / unit, rmse.max(FLOOR)]
}

fn spot(row: &Row<'_>, at: [f64; 2], label: Option<String>, cost: Cost) -> Spot {
    let paid = match cost {
        Cost::Bytes => format!("{:.2} MB", at[0]),
        _ => numbers::milliseconds(at[0]),
    };
    let rmse = row.rmse().map_or("none".to_owned(), numbers::error);
    Spot {
        at,
        label,
        title: format!("{}: {paid}, RMSE {rmse}", row.cell.label()),
    }
}

/// On the front every point has its settings and each technique its name; beside the
/// front each technique has its name at its least error.
fn labels(group: &Group<'_>, points: &[Option<[f64; 2]>]) -> Vec<Option<String>> {
    let on = front(points);
    let mut labels = vec![None; points.len()];
    let mut named: Vec<&str> = Vec::new();
    for k in along(points) {
        let cell = group.rows[k].cell;
        labels[k] = Some(if named.contains(&cell.technique.as_str()) {
            match cell.settings_text() {
                text if text.is_empty() => "defaults".to_owned(),
                text => text,
            }
        } else {
            cell.label()
        });
        named.push(&cell.technique);
    }
    for row in &group.rows {
        let technique = row.cell.technique.as_str();
        if named.contains(&technique) {
            continue;
        }
        named.push(technique);
        let own = |k: &usize| group.rows[*k].cell.technique == technique && !on[*k];
        let error = |k: &usize| points[*k].map_or(f64::INFINITY, |p| p[1]);
        let best = (0..points.len())
            .filter(own)
            .min_by(|a, b| error(a).total_cmp(&error(b)));
        if let Some(best) = best {
            labels[best] = Some(technique.to_owned());
        }
    }
    labels
}
