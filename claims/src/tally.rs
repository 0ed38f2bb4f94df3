//! Counters, times and bytes of a frame, by the roles of passes and draws.

use gnomon_raster::{Counters, TextureDescriptor, TextureDimension};

use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{DrawRole, PassRole};

/// Bytes of a texture without mip levels.
pub(super) fn bytes_of(texture: &TextureDescriptor) -> u64 {
    let layers = match texture.dimension {
        TextureDimension::Cube => 6,
        _ => 1,
    };
    let texels: u64 = texture.size.iter().map(|s| u64::from(*s)).product();
    layers * texels * texture.format.bytes()
}

/// Bytes of a flat texture with all its mip levels.
pub(super) fn bytes_with_levels(texture: &TextureDescriptor) -> u64 {
    let level = |k: u32| {
        let texels = texture.size[..2].iter().map(|s| u64::from((s >> k).max(1)));
        texels.product::<u64>() * texture.format.bytes()
    };
    (0..texture.mip_levels).map(level).sum()
}

/// Sum of the counters of all passes that have one of `roles`.
pub(super) fn counters(done: &Rendered, roles: &[PassRole]) -> Counters {
    let mut sum = Counters::default();
    for (pass, role) in done.report.passes.iter().zip(done.roles.passes()) {
        if roles.contains(role) {
            sum.add(&pass.totals());
        }
    }
    sum
}

/// Milliseconds of the same passes.
pub(super) fn pass_time(done: &Rendered, roles: &[PassRole]) -> f64 {
    let passes = done.pass_ms.iter().zip(done.roles.passes());
    passes
        .filter(|(_, role)| roles.contains(role))
        .map(|((_, ms), _)| ms)
        .sum()
}

/// Counters of the draws that are for `role`, in all passes.
fn of_draws(done: &Rendered, role: DrawRole) -> impl Iterator<Item = &Counters> {
    let passes = done.report.passes.iter().enumerate();
    let draws = passes.flat_map(|(p, pass)| {
        let draws = pass.draws.iter().enumerate();
        draws.map(move |(d, draw)| ([p, d], &draw.counters))
    });
    draws
        .filter(move |([pass, draw], _)| done.roles.of_draw(*pass, *draw) == role)
        .map(|(_, counters)| counters)
}

/// Invocations of the draws that are for `role`.
pub(super) fn invocations(done: &Rendered, role: DrawRole) -> u64 {
    of_draws(done, role)
        .map(|c| c.fragment_shader_invocations)
        .sum()
}

/// Fragments that draws for `role` wrote.
pub(super) fn written(done: &Rendered, role: DrawRole) -> u64 {
    of_draws(done, role).map(|c| c.fragments.written).sum()
}

/// Draws that are for `role`.
pub(super) fn draws(done: &Rendered, role: DrawRole) -> usize {
    of_draws(done, role).count()
}

/// A ratio of counts; not finite for nothing.
pub(super) fn ratio(of: u64, to: u64) -> f64 {
    of as f64 / to as f64
}
