//! Plots of what was measured.

use gnomon_claims::chart::{Axis, Chart, Series};

use crate::measure::{FILTERS, ORDERS, PCSS, Row, SIDES, TECHNIQUE};

/// The size and the order at which the others are varied.
const SIDE: u32 = 512;
const ORDER: u32 = 4;
/// Exact sums: the filter that errs least.
const EXACT: [&str; 2] = FILTERS[3];

/// Everything that is plotted.
pub(crate) fn all(rows: &[Row]) -> Vec<Chart> {
    let scenes = scenes(rows);
    let mut charts = Vec::new();
    for scene in &scenes {
        charts.push(against(rows, scene, "time", "shadow passes, ms", |r| r.ms));
        charts.push(against(rows, scene, "bytes", "shadow passes, MB", |r| {
            r.bytes / 1e6
        }));
    }
    charts.push(by_scene(
        rows,
        &scenes,
        "convolution-order",
        "RMSE over the order, exact tables of 512x512, A = 30, B = 20",
        Axis::log2("order M"),
        |r| (r.setup.side == SIDE && sharpened(r, [30, 20])).then_some(r.setup.order),
    ));
    charts.push(by_scene(
        rows,
        &scenes,
        "convolution-order-unsharpened",
        "RMSE over the order, exact tables of 512x512, no sharpening",
        Axis::log2("order M"),
        |r| (r.setup.side == SIDE && sharpened(r, [0, 20])).then_some(r.setup.order),
    ));
    charts.push(by_scene(
        rows,
        &scenes,
        "convolution-size",
        "RMSE over the size of the view, exact tables, M = 4, A = 30, B = 20",
        Axis::log2("texels along a side"),
        |r| (r.setup.order == ORDER && sharpened(r, [30, 20])).then_some(r.setup.side),
    ));
    charts
}

fn scenes(rows: &[Row]) -> Vec<String> {
    let mut names: Vec<String> = rows.iter().map(|r| r.scene.clone()).collect();
    names.dedup();
    names
}

fn sharpened(row: &Row, by: [u32; 2]) -> bool {
    row.setup.technique == TECHNIQUE && row.setup.sharpening == by
}

fn filtered(row: &Row, [filter, format]: [&str; 2]) -> bool {
    row.setup.filter == filter && row.setup.format == format
}

/// RMSE over a cost of one scene: each filter over the sizes of the view at M = 4,
/// two of them over the orders at one size, and PCSS over the sizes.
fn against(rows: &[Row], scene: &str, short: &str, what: &str, cost: fn(&Row) -> f64) -> Chart {
    let rows: Vec<&Row> = rows.iter().filter(|r| r.scene == scene).collect();
    let curve = |label: &str, chosen: &dyn Fn(&Row) -> bool| {
        let points = rows.iter().filter(|r| chosen(r));
        Series::line(label, points.map(|r| [cost(r), r.rmse]).collect())
    };
    let names = ["mip", "mip, float", "SAT, f32", "SAT, u32"];
    let mut series = Vec::new();
    for (filter, name) in FILTERS.into_iter().zip(names) {
        let chosen =
            |r: &Row| sharpened(r, [30, 20]) && filtered(r, filter) && r.setup.order == ORDER;
        let label = format!("{name}: M = 4, {}-{}", SIDES[0], SIDES[3]);
        series.push(curve(&label, &chosen));
    }
    for (filter, name) in [(FILTERS[0], names[0]), (FILTERS[3], names[3])] {
        let chosen =
            |r: &Row| sharpened(r, [30, 20]) && filtered(r, filter) && r.setup.side == SIDE;
        let label = format!("{name}: {SIDE}, M = {}-{}", ORDERS[0], ORDERS[4]);
        series.push(curve(&label, &chosen));
    }
    let label = format!("PCSS, all texels, {}-{}", SIDES[0], SIDES[2]);
    series.push(curve(&label, &|r: &Row| r.setup.technique == PCSS));
    Chart {
        name: format!("convolution-{scene}-{short}"),
        title: format!("Error against {short}, {scene}"),
        x: Axis::log10(what),
        y: Axis::log10("RMSE of visibility"),
        series,
    }
}

/// RMSE over a parameter, a line for each scene, by exact tables.
fn by_scene(
    rows: &[Row],
    scenes: &[String],
    name: &str,
    title: &str,
    x: Axis,
    value: impl Fn(&Row) -> Option<u32>,
) -> Chart {
    let line = |scene: &String| {
        let own = rows
            .iter()
            .filter(|r| r.scene == *scene && filtered(r, EXACT));
        let points = own.filter_map(|r| Some([f64::from(value(r)?), r.rmse]));
        Series::line(scene, points.collect())
    };
    Chart {
        name: name.to_owned(),
        title: title.to_owned(),
        x,
        y: Axis::log10("RMSE of visibility"),
        series: scenes.iter().map(line).collect(),
    }
}
