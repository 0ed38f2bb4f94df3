//! Transport of the vertices that are drawn towards the lights, and which maps are needed
//! for it.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::VertexBuffer;

use super::bodies::{Body, Evaluation, coefficients, normal_of};
use super::grazing::{Facing, Gain, Remainder};
use super::notes::Found;
use super::settings::Settings;
use super::shadows::{Job, Receivers};
use super::sheets::{Sheet, Sheets};
use super::sources::Source;

/// Lights, and what their transport is found with.
pub(super) struct Lit<'a> {
    pub(super) sources: &'a [Source],
    /// What bands leave out towards each, or none.
    pub(super) remainders: &'a [Remainder],
    pub(super) evaluation: Evaluation,
    /// Whether something is glossy.
    pub(super) glossy: bool,
}

/// What a sheet's vertices have of the lights.
pub(super) struct Transported {
    /// Position, normal, and for each light T and, where something is glossy, V (§6.2.3).
    pub(super) vertices: Arc<VertexBuffer>,
    /// Whether any vertex has some of a light.
    pub(super) reached: Vec<bool>,
    /// What L_s gains, vertex by vertex, where bands leave something out.
    pub(super) gains: Vec<Gain>,
}

/// Of one sheet.
pub(super) fn transported(
    sheet: &Sheet<'_, '_>,
    body: &Body<'_>,
    lit: &Lit<'_>,
    found: &mut Found,
) -> Transported {
    let (sources, evaluation) = (lit.sources, &lit.evaluation);
    let directions: Vec<DVec3> = sources
        .iter()
        .map(|s| body.own(s.at.towards_from(DVec3::ZERO)))
        .collect();
    let harmonics = evaluation.towards(&directions);
    let mut reached = vec![false; sources.len()];
    let (mut data, mut gains) = (Vec::new(), Vec::new());
    for &v in &sheet.vertices {
        let (position, normal) = sheet.vertex(v);
        data.extend(position.into_iter().chain(normal));
        let own = coefficients(&sheet.transport, v as usize);
        let normal = normal_of(sheet.surface, v, sheet.sign.into());
        let told = !lit.remainders.is_empty() && normal != DVec3::ZERO;
        let facing = told.then(|| Facing::new(body.own(normal), evaluation));
        let mut gain = Gain::default();
        for (light, at) in harmonics.iter().enumerate() {
            let [mut t, seen] = at.of(&own);
            if let Some(facing) = &facing {
                let lacks = facing.lacks(t, directions[light], (&lit.remainders[light], at));
                gain.add(sources[light].energy, lacks);
                t += lacks[0];
            }
            found.ringing(t);
            let seen = if lit.glossy {
                seen.clamp(0.0, 1.0)
            } else {
                0.0
            };
            reached[light] |= t > 0.0 || seen > 0.0;
            data.extend([t.max(0.0) as f32, seen as f32]);
        }
        if !lit.remainders.is_empty() {
            gains.push(gain);
        }
    }
    let stride = 6 + 2 * sources.len();
    Transported {
        vertices: Arc::new(VertexBuffer { data, stride }),
        reached,
        gains,
    }
}

/// What each body needs under each light that reaches it.
pub(super) fn jobs(
    bodies: &[Body<'_>],
    sheets: &Sheets<'_, '_>,
    sources: &[Source],
    transported: &[Transported],
    settings: &Settings,
) -> Vec<Job> {
    let receivers = Receivers::new(bodies, settings);
    let reaches = |light: usize, body: usize| {
        let own = sheets.all.iter().zip(transported);
        own.clone().any(|(s, t)| s.body == body && t.reached[light])
    };
    let of_light = |(light, source): (usize, &Source)| {
        receivers.jobs(light, source, settings, |body| reaches(light, body))
    };
    sources.iter().enumerate().flat_map(of_light).collect()
}
