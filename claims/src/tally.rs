//! Counters, times and bytes of a frame, by the names of passes and draws.

use gnomon_raster::{Counters, TextureDescriptor, TextureDimension};

use gnomon_pipeline::measure::render::Rendered;

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

/// Sum of the counters of all passes that are called one of `labels`; with several
/// lights labels carry the light's number behind.
pub(super) fn counters(done: &Rendered, labels: &[&str]) -> Counters {
    let mut sum = Counters::default();
    let passes = done.report.passes.iter();
    for pass in passes.filter(|p| is_one_of(&p.label, labels)) {
        sum.add(&pass.totals());
    }
    sum
}

/// Milliseconds of the same passes.
pub(super) fn pass_time(done: &Rendered, labels: &[&str]) -> f64 {
    let passes = done.pass_ms.iter();
    passes
        .filter(|(label, _)| is_one_of(label, labels))
        .map(|(_, ms)| ms)
        .sum()
}

fn is_one_of(label: &str, labels: &[&str]) -> bool {
    let is_number = |rest: &str| {
        rest.strip_prefix(' ')
            .is_some_and(|n| n.parse::<u32>().is_ok())
    };
    let rests = labels.iter().filter_map(|l| label.strip_prefix(l));
    rests
        .into_iter()
        .any(|rest| rest.is_empty() || is_number(rest))
}

/// Invocations of the draws that are called `draw`, in all passes.
pub(super) fn invocations(done: &Rendered, draw: &str) -> u64 {
    let draws = done.report.passes.iter().flat_map(|p| &p.draws);
    draws
        .filter(|d| d.label == draw)
        .map(|d| d.counters.fragment_shader_invocations)
        .sum()
}

/// Fragments that draws called `draw` wrote, in all passes.
pub(super) fn written(done: &Rendered, draw: &str) -> u64 {
    let draws = done.report.passes.iter().flat_map(|p| &p.draws);
    draws
        .filter(|d| d.label == draw)
        .map(|d| d.counters.fragments.written)
        .sum()
}

/// Draws that are called `draw`, in all passes.
pub(super) fn draws(done: &Rendered, draw: &str) -> usize {
    let draws = done.report.passes.iter().flat_map(|p| &p.draws);
    draws.filter(|d| d.label == draw).count()
}

/// A ratio of counts; not finite for nothing.
pub(super) fn ratio(of: u64, to: u64) -> f64 {
    of as f64 / to as f64
}
