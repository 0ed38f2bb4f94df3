//! Counters by name, those of nothing left out.

use gnomon_raster::{
    Counters, DrawReport, EventCounters, FragmentCounters, PrimitiveCounters, TileCounters, Traffic,
};

/// A draw's counters, in a fixed order. Structs are taken apart without `..`: a counter
/// that is added to them does not compile before it is named here.
pub(crate) fn named(report: &DrawReport) -> Vec<(String, u64)> {
    let c = &report.counters;
    let mut all = Vec::new();
    primitives(&c.primitives, &mut all);
    fragments(&c.fragments, &mut all);
    events(&c.events, &mut all);
    let TileCounters {
        tested,
        culled,
        accepted,
    } = c.tiles;
    push(
        &mut all,
        "tiles",
        &[
            ("tested", tested),
            ("culled", culled),
            ("accepted", accepted),
        ],
    );
    all.push(("shaded".to_owned(), c.fragment_shader_invocations));
    traffic(c, &mut all);
    let counts = report.counted.iter().zip(c.shader_counts);
    all.extend(counts.map(|(name, n)| (format!("shader.{name}"), n)));
    all.retain(|(_, n)| *n > 0);
    all
}

fn push(all: &mut Vec<(String, u64)>, group: &str, counts: &[(&str, u64)]) {
    let named = counts
        .iter()
        .map(|(name, n)| (format!("{group}.{name}"), *n));
    all.extend(named);
}

fn primitives(c: &PrimitiveCounters, all: &mut Vec<(String, u64)>) {
    let PrimitiveCounters {
        vertex_shader_invocations,
        input,
        non_finite,
        frustum_culled,
        clipped,
        degenerate,
        face_culled,
        rasterized,
        steep_depth_planes,
    } = *c;
    let counts = [
        ("vertices", vertex_shader_invocations),
        ("input", input),
        ("non_finite", non_finite),
        ("frustum_culled", frustum_culled),
        ("clipped", clipped),
        ("degenerate", degenerate),
        ("face_culled", face_culled),
        ("rasterized", rasterized),
        ("steep_depth_planes", steep_depth_planes),
    ];
    push(all, "primitives", &counts);
}

fn fragments(c: &FragmentCounters, all: &mut Vec<(String, u64)>) {
    let FragmentCounters {
        generated,
        hiz_killed,
        bounds_failed,
        stencil_failed,
        depth_failed,
        discarded,
        written,
    } = *c;
    let counts = [
        ("generated", generated),
        ("hiz_killed", hiz_killed),
        ("bounds_failed", bounds_failed),
        ("stencil_failed", stencil_failed),
        ("depth_failed", depth_failed),
        ("discarded", discarded),
        ("written", written),
    ];
    push(all, "fragments", &counts);
}

fn events(c: &EventCounters, all: &mut Vec<(String, u64)>) {
    let EventCounters {
        silent_z_writes,
        silent_stencil_writes,
        silent_color_writes,
        blend_saturated,
        source_clamped,
        nan_canonicalised,
        depth_clamped,
    } = *c;
    let counts = [
        ("silent_z_writes", silent_z_writes),
        ("silent_stencil_writes", silent_stencil_writes),
        ("nan_canonicalised", nan_canonicalised),
        ("depth_clamped", depth_clamped),
    ];
    push(all, "events", &counts);
    let by_attachment = [
        ("silent_color_writes", silent_color_writes),
        ("blend_saturated", blend_saturated),
        ("source_clamped", source_clamped),
    ];
    for (name, counts) in by_attachment {
        let counts = counts.iter().enumerate();
        all.extend(counts.map(|(i, n)| (format!("events.{name}[{i}]"), *n)));
    }
}

fn traffic(c: &Counters, all: &mut Vec<(String, u64)>) {
    for (client, t) in c.traffic.named() {
        let Traffic {
            read_accesses,
            read_bytes,
            write_accesses,
            write_bytes,
        } = t;
        let counts = [
            ("read_accesses", read_accesses),
            ("read_bytes", read_bytes),
            ("write_accesses", write_accesses),
            ("write_bytes", write_bytes),
        ];
        push(all, &client, &counts);
    }
    let fetches = c.traffic.tex_fetches.iter().enumerate();
    all.extend(fetches.map(|(i, n)| (format!("tex[{i}].fetches"), *n)));
}
