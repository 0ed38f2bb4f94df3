//! The wedge in the scene on the left, what its edge covers on the right.

use glam::DVec4;
use gnomon_pipeline::geometry::wedge::WedgeMesh;

use super::run::Shown;
use crate::draw::{Canvas, Legend, Picture, Projection, Stroke, Swatch, diverging};

// As on the scale: blue where light is taken.
const OUTER: [u8; 3] = [70, 160, 240];
const INNER: [u8; 3] = [240, 140, 50];
const QUAD: [u8; 3] = [235, 60, 60];
const EDGE: [u8; 3] = [255, 255, 255];
/// Opacity of a half's face.
const FACE: f32 = 0.16;

pub(super) fn draw(shown: &Shown<'_>, background: &Picture) -> Picture {
    let [width, height] = background.size;
    let mut both = Canvas::new([2 * width, height], [0; 3]);
    both.place(&geometry(shown, background), [0, 0]);
    both.place(&coverage(shown, background), [width as i32, 0]);
    legend(shown).below(both, diverging::diverging)
}

/// Halves, hard shadow quad, edge.
fn geometry(shown: &Shown<'_>, background: &Picture) -> Canvas {
    let mut canvas = Canvas::dimmed(background, 0.7);
    let projection = Projection::new(&shown.scene.camera, background.size);
    for wedge in &shown.wedges {
        match wedge.halves() {
            Some(halves) => {
                fill(&mut canvas, &projection, &halves.outer, OUTER);
                fill(&mut canvas, &projection, &halves.inner, INNER);
            }
            None => fill(&mut canvas, &projection, &wedge.volume.mesh(), OUTER),
        }
        let [e0, e1, d0, d1] = wedge.hard_quad();
        let quad = [e0, e1, d1, d0].map(narrow);
        let seen = projection.polygon(&quad);
        canvas.fill(&seen, QUAD, 0.2);
        canvas.line(&seen, true, stroke(QUAD, 1.5));
        if let Some(ends) = projection.segment([narrow(e0), narrow(e1)]) {
            canvas.line(&ends.map(|e| e.at), false, stroke(EDGE, 2.5));
        }
    }
    canvas
}

fn fill(canvas: &mut Canvas, projection: &Projection, mesh: &WedgeMesh, colour: [u8; 3]) {
    for face in &mesh.triangles {
        let corners = face.map(|i| narrow(mesh.vertices[i as usize]));
        let seen = projection.polygon(&corners);
        canvas.fill(&seen, colour, FACE);
        canvas.line(
            &seen,
            true,
            Stroke {
                colour,
                opacity: 0.35,
                width: 1.0,
            },
        );
    }
}

/// Signed coverage over the dimmed picture.
fn coverage(shown: &Shown<'_>, background: &Picture) -> Canvas {
    let mut canvas = Canvas::dimmed(background, 0.45);
    let width = background.size[0] as usize;
    for (i, &value) in shown.map.values.iter().enumerate() {
        // Coverage that is no light worth showing leaves the surface as it is.
        if value.abs() > diverging::LEAST {
            let at = [(i % width) as u32, (i / width) as u32];
            canvas.mix(at, diverging::diverging(diverging::place(value)), 0.9);
        }
    }
    canvas
}

fn legend(shown: &Shown<'_>) -> Legend {
    let totals = shown.map.totals();
    Legend {
        title: format!(
            "Wedge of edge {} ({}), light {} of {}; right: what the edge adds to visibility",
            shown.number, shown.construction, shown.light, shown.scene.name
        ),
        scale: diverging::labels(),
        swatches: vec![
            Swatch::new(OUTER, "outer half: the edge takes"),
            Swatch::new(INNER, "inner half: the edge gives back"),
            Swatch::new(QUAD, "hard shadow quad"),
            Swatch::new(EDGE, "the edge"),
        ],
        notes: vec![format!(
            "takes at {} pixels, up to {:.6}; adds at {}, up to {:.6}",
            totals.taking, totals.most_taken, totals.adding, totals.most_added
        )],
        ..Legend::default()
    }
}

fn stroke(colour: [u8; 3], width: f32) -> Stroke {
    Stroke {
        colour,
        opacity: 1.0,
        width,
    }
}

fn narrow(v: DVec4) -> [f32; 4] {
    v.to_array().map(|c| c as f32)
}
