//! The JSON document of `gnomon light`.

use gnomon_pipeline::measure::visibility_sum::SeenEdge;
use serde::Serialize;

use super::run::View;

/// What a pixel's surface sees of a light.
#[derive(Serialize)]
pub(super) struct LightDocument<'a> {
    scene: &'a str,
    size: [u32; 2],
    pixel: [u32; 2],
    light: usize,
    /// `square` or `disc`; `null` where the light is not seen.
    image: Option<&'static str>,
    receiver: ReceiverDocument<'a>,
    centre_hidden: Option<u32>,
    edges: Vec<EdgeDocument<'a>>,
    silhouette_edges: usize,
    sum: Option<f64>,
    saturation: Option<f64>,
    exact: f64,
    exact_without_own_plane: f64,
}

#[derive(Serialize)]
struct ReceiverDocument<'a> {
    object: &'a str,
    triangle: u32,
    point: [f64; 3],
    normal: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct EdgeDocument<'a> {
    edge: usize,
    object: &'a str,
    on_light: [[f64; 2]; 2],
    side: &'static str,
    coverage: f64,
    contribution: f64,
}

impl<'a> LightDocument<'a> {
    pub(super) fn new(view: &'a View) -> Self {
        let seen = view.seen.as_ref();
        let image = |square: bool| if square { "square" } else { "disc" };
        let edges = seen.map_or(&[][..], |s| &s.edges);
        Self {
            scene: &view.scene.name,
            size: view.size,
            pixel: view.pixel,
            light: view.light,
            image: seen.map(|s| image(s.is_square)),
            receiver: ReceiverDocument {
                object: view.object(view.hit.object as usize),
                triangle: view.hit.triangle,
                point: view.receiver.point.to_array(),
                normal: view.receiver.normal.map(|n| n.to_array()),
            },
            centre_hidden: seen.map(|s| s.centre_hidden),
            edges: edges.iter().map(|e| edge(view, e)).collect(),
            silhouette_edges: view.edges,
            sum: seen.map(|s| s.sum()),
            saturation: seen.map(|s| s.saturation()),
            exact: view.exact,
            exact_without_own_plane: view.free,
        }
    }
}

fn edge<'a>(view: &'a View, e: &SeenEdge) -> EdgeDocument<'a> {
    EdgeDocument {
        edge: e.number,
        object: view.object(e.object),
        on_light: e.on_light.map(|p| p.to_array()),
        side: if e.inside { "umbra" } else { "lit" },
        coverage: e.coverage,
        contribution: e.contribution(),
    }
}
