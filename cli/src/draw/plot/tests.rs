use gnomon_claims::chart::{Axis, Chart, Mark, Series};

use super::{picture, svg};

fn chart() -> Chart {
    Chart {
        name: "test".to_owned(),
        title: "Error & cost <of> a test".to_owned(),
        x: Axis::log2("tile"),
        y: Axis::log10("accesses"),
        series: vec![
            Series::line("first", vec![[2.0, 10.0], [8.0, 1000.0]]),
            Series::marked("second", vec![[4.0, 100.0], [4.0, 0.0]], Mark::Dots),
            Series::marked("limit", vec![[2.0, 50.0], [8.0, 50.0]], Mark::Dashed),
            Series::marked("bars", vec![[2.0, 20.0]], Mark::Bars),
        ],
    }
}

fn count(picture: &crate::draw::Picture, colour: [u8; 3]) -> usize {
    let [r, g, b] = colour;
    picture
        .pixels
        .iter()
        .filter(|p| **p == [r, g, b, 255])
        .count()
}

#[test]
fn every_series_is_seen_in_both_files() {
    let (picture, svg) = (picture(&chart()), svg(&chart()));
    for colour in [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167]] {
        assert!(count(&picture, colour) > 20, "{colour:?}");
        let [r, g, b] = colour;
        assert!(
            svg.contains(&format!("#{r:02x}{g:02x}{b:02x}")),
            "{colour:?}"
        );
    }
    let [width, height] = picture.size;
    assert!(svg.contains(&format!("width=\"{width}\" height=\"{height}\"")));
    assert!(svg.contains("stroke-dasharray"));
}

/// A point that a logarithmic axis cannot show is not lost in silence.
#[test]
fn points_that_cannot_be_shown_are_counted() {
    let svg = svg(&chart());
    assert!(svg.contains("second (1 not shown)") && svg.contains(">first<"));
    assert_eq!(svg.matches("<circle").count(), 2 + 1 + 2); // points and legend
}

/// Neither is a gap closed by a line through it.
#[test]
fn lines_are_interrupted_where_a_point_cannot_be_shown() {
    let mut chart = chart();
    let ys = [1.0, 2.0, f64::NAN, 3.0, 4.0, 0.0, 5.0];
    let points = ys.iter().enumerate().map(|(k, y)| [(k + 1) as f64, *y]);
    chart.series = vec![Series::line("gaps", points.collect())];
    let svg = svg(&chart);
    let lines: Vec<&str> = svg
        .lines()
        .filter(|l| l.contains("stroke-width=\"2.5\""))
        .collect();
    // Two pairs and the sample of the legend; the last point is a dot alone.
    assert_eq!(lines.len(), 3, "{svg}");
    assert!(
        lines.iter().all(|l| l.matches(',').count() == 2),
        "{lines:?}"
    );
    assert_eq!(svg.matches("<circle").count(), 5 + 1);
    assert!(svg.contains("gaps (2 not shown)"));
}

/// More series than colours are still told apart.
#[test]
fn colours_come_again_with_dashes() {
    let mut chart = chart();
    let line = |k: usize| Series::line(&format!("line {k}"), vec![[2.0, 10.0], [8.0, 1000.0]]);
    chart.series = (0..14).map(line).collect();
    let svg = svg(&chart);
    let lines = svg.lines().filter(|l| l.contains("stroke-width=\"2.5\""));
    let mut looks: Vec<&str> = lines.map(|l| &l[l.find("stroke=").unwrap()..]).collect();
    looks.sort_unstable();
    looks.dedup();
    assert_eq!(looks.len(), 14, "{looks:?}");
}

#[test]
fn text_is_escaped() {
    let svg = svg(&chart());
    assert!(svg.contains("Error &amp; cost &lt;of&gt; a test"));
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
}

#[test]
fn a_chart_without_points_is_still_drawn() {
    let mut empty = chart();
    empty.series.clear();
    assert!(picture(&empty).size[0] > 700);
    assert!(!svg(&empty).contains("NaN"));
}
