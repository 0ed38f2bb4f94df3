//! The light as it is seen: its outline, what hides it, and the edges that cut it.

use std::f64::consts::TAU;

use glam::DVec2;
use gnomon_pipeline::measure::visibility_sum::{SeenEdge, SeenLight};

use super::run::View;
use crate::draw::{Canvas, Legend, Picture, Stroke, Swatch, heat};

/// Width and height.
const SIDE: u32 = 560;
/// Pixels of half the light's size.
const UNIT: f64 = 180.0;
/// Sides of what is drawn for a circle.
const CIRCLE: usize = 180;
/// Most edges whose numbers are written beside them.
const NUMBERED: usize = 16;

const SKY: [u8; 3] = [30, 33, 40];
const LIGHT: [u8; 3] = [255, 244, 214];
const CASTER: [u8; 3] = [70, 92, 130];
const ADDS: [u8; 3] = [0, 150, 90];
const TAKES: [u8; 3] = [214, 69, 20];
const CENTRE: [u8; 3] = [20, 20, 20];

pub(super) fn draw(view: &View) -> Picture {
    let mut canvas = Canvas::new([SIDE; 2], SKY);
    let Some(seen) = &view.seen else {
        return legend(view, None).below(canvas, heat);
    };
    let outline = outline(seen.is_square);
    canvas.fill(&outline, LIGHT, 1.0);
    for triangle in &view.triangles {
        let corners: Vec<[f32; 2]> = triangle.corners.iter().map(|p| place(*p)).collect();
        canvas.fill(&corners, CASTER, 0.75);
        canvas.line(&corners, true, stroke(CASTER, 0.6));
    }
    canvas.line(&outline, true, stroke(LIGHT, 1.5));
    for edge in &seen.edges {
        canvas.line(&edge.on_light.map(place), false, stroke(color(edge), 3.0));
    }
    number(&mut canvas, seen);
    for [from, to] in [[[-6.0, 0.0], [6.0, 0.0]], [[0.0, -6.0], [0.0, 6.0]]] {
        let at = |p: [f64; 2]| place(DVec2::from(p) / UNIT);
        canvas.line(&[at(from), at(to)], false, stroke(CENTRE, 2.0));
    }
    legend(view, Some(seen)).below(canvas, heat)
}

/// Writes the numbers of the edges that cover most.
fn number(canvas: &mut Canvas, seen: &SeenLight) {
    let mut most: Vec<&SeenEdge> = seen.edges.iter().collect();
    most.sort_by(|a, b| {
        b.coverage
            .total_cmp(&a.coverage)
            .then(a.number.cmp(&b.number))
    });
    for edge in most.into_iter().take(NUMBERED) {
        let [p, q] = edge.on_light;
        let [x, y] = place((p + q) * 0.5).map(|c| c as i32);
        let text = edge.number.to_string();
        let half = text.len() as i32 * 3;
        canvas.fill_rect(
            [(x - half - 2) as f32, (y - 6) as f32],
            [(2 * half + 4) as f32, 12.0],
            SKY,
        );
        canvas.text([x - half, y - 4], &text, [255; 3], 1);
    }
}

fn outline(is_square: bool) -> Vec<[f32; 2]> {
    if is_square {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        return corners.map(|p| place(DVec2::from(p))).to_vec();
    }
    let at = |k: usize| {
        let turn = TAU * k as f64 / CIRCLE as f64;
        place(DVec2::new(libm::cos(turn), libm::sin(turn)))
    };
    (0..CIRCLE).map(at).collect()
}

/// From the light's coordinates to pixels, y up.
fn place(p: DVec2) -> [f32; 2] {
    let middle = f64::from(SIDE) / 2.0;
    [(middle + UNIT * p.x) as f32, (middle - UNIT * p.y) as f32]
}

fn stroke(colour: [u8; 3], width: f32) -> Stroke {
    Stroke {
        colour,
        opacity: 1.0,
        width,
    }
}

fn color(edge: &SeenEdge) -> [u8; 3] {
    if edge.inside { ADDS } else { TAKES }
}

fn legend(view: &View, seen: Option<&SeenLight>) -> Legend {
    let [x, y] = view.pixel;
    let title = format!(
        "Light {} of {} seen from pixel {x} {y}, on {}",
        view.light,
        view.scene.name,
        view.object(view.hit.object as usize)
    );
    let Some(seen) = seen else {
        return Legend {
            title,
            notes: vec!["the surface is in the light's plane, or inside it".to_owned()],
            ..Legend::default()
        };
    };
    let total = |inside: bool| {
        let of = seen.edges.iter().filter(|e| e.inside == inside);
        of.fold((0, 0.0), |(n, sum), e| (n + 1, sum + e.contribution()))
    };
    let ((adding, added), (taking, taken)) = (total(true), total(false));
    Legend {
        title,
        swatches: vec![
            Swatch::new(LIGHT, "the light"),
            Swatch::new(CASTER, "casters before it"),
            Swatch::new(ADDS, format!("umbra side: {adding} edges add {added:.6}")),
            Swatch::new(
                TAKES,
                format!("lit side: {taking} edges take {:.6}", f64::abs(taken)),
            ),
        ],
        notes: vec![
            format!(
                "1 - {} (layers before the centre, the cross) + edges = {:.6}; exact {:.6}",
                seen.centre_hidden,
                seen.sum(),
                view.exact
            ),
            "an edge covers the light between itself and the outline, within the rays \
             from the centre through its ends"
                .to_owned(),
        ],
        ..Legend::default()
    }
}
