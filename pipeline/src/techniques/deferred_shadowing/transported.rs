//! Transport of the vertices that are drawn towards the lights, and which maps are needed
//! for it.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::VertexBuffer;

use super::bodies::{Body, Evaluation, coefficients};
use super::notes::Found;
use super::settings::Settings;
use super::shadows::{Job, Receivers};
use super::sheets::{Sheet, Sheets};
use super::sources::Source;

/// Position, normal, and for each light T and, where something is glossy, V (§6.2.3), of a
/// sheet's vertices; and whether any of them has some of a light.
pub(super) fn transported(
    sheet: &Sheet<'_, '_>,
    body: &Body<'_>,
    sources: &[Source],
    (evaluation, glossy): &(Evaluation, bool),
    found: &mut Found,
) -> (Arc<VertexBuffer>, Vec<bool>) {
    let directions: Vec<DVec3> = sources
        .iter()
        .map(|s| body.own(s.at.towards_from(DVec3::ZERO)))
        .collect();
    let harmonics = evaluation.towards(&directions);
    let mut reached = vec![false; sources.len()];
    let mut data = Vec::new();
    for &v in &sheet.vertices {
        let (position, normal) = sheet.vertex(v);
        data.extend(position.into_iter().chain(normal));
        let own = coefficients(&sheet.transport, v as usize);
        for (light, at) in harmonics.iter().enumerate() {
            let [t, seen] = at.of(&own);
            found.ringing(t);
            let seen = if *glossy { seen.clamp(0.0, 1.0) } else { 0.0 };
            reached[light] |= t > 0.0 || seen > 0.0;
            data.extend([t.max(0.0) as f32, seen as f32]);
        }
    }
    let stride = 6 + 2 * sources.len();
    (Arc::new(VertexBuffer { data, stride }), reached)
}

/// What each body needs under each light that reaches it.
pub(super) fn jobs(
    bodies: &[Body<'_>],
    sheets: &Sheets<'_, '_>,
    sources: &[Source],
    transported: &[(Arc<VertexBuffer>, Vec<bool>)],
    settings: &Settings,
) -> Vec<Job> {
    let receivers = Receivers::new(bodies, settings);
    let reaches = |light: usize, body: usize| {
        let own = sheets.all.iter().zip(transported);
        own.clone()
            .any(|(s, (_, reached))| s.body == body && reached[light])
    };
    let of_light = |(light, source): (usize, &Source)| {
        receivers.jobs(light, source, settings, |body| reaches(light, body))
    };
    sources.iter().enumerate().flat_map(of_light).collect()
}
