//! What each draw of a frame counted, as JSON.

use gnomon_raster::{DrawReport, SubmitReport};
use serde::Serialize;

use super::object::Object;
use super::render::{
    EventDocument, FragmentDocument, PrimitiveDocument, TileDocument, TrafficDocument, traffic,
};

/// A draw and what it counted.
#[derive(Clone, Debug, Serialize)]
pub(super) struct DrawDocument {
    /// Number of its pass in the frame.
    pass: usize,
    pass_name: String,
    /// Its number in the pass.
    draw: usize,
    label: String,
    primitives: PrimitiveDocument,
    tiles: TileDocument,
    fragments: FragmentDocument,
    fragment_shader_invocations: u64,
    shader_counts: Object<u64>,
    events: EventDocument,
    traffic: Object<TrafficDocument>,
}

/// All draws in the order of submission.
pub(super) fn draw_documents(report: &SubmitReport) -> Vec<DrawDocument> {
    let passes = report.passes.iter().enumerate();
    passes
        .flat_map(|(number, pass)| {
            let draws = pass.draws.iter().enumerate();
            draws.map(move |(draw, d)| DrawDocument::new((number, &pass.label), draw, d))
        })
        .collect()
}

impl DrawDocument {
    fn new((pass, pass_name): (usize, &str), draw: usize, report: &DrawReport) -> Self {
        let c = &report.counters;
        let counts = report.counted.iter().zip(c.shader_counts);
        Self {
            pass,
            pass_name: pass_name.to_owned(),
            draw,
            label: report.label.clone(),
            primitives: (&c.primitives).into(),
            tiles: (&c.tiles).into(),
            fragments: (&c.fragments).into(),
            fragment_shader_invocations: c.fragment_shader_invocations,
            shader_counts: Object(counts.map(|(name, n)| ((*name).to_owned(), n)).collect()),
            events: (&c.events).into(),
            traffic: traffic(c.traffic.named()),
        }
    }
}
