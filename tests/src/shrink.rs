//! Makes a failing case small before a person looks at it.

use crate::twin::{DepthSource, Discard, Program, TwinCase, TwinDraw};

/// Removes whatever can be removed while `fails` stays true.
#[must_use]
pub fn shrink(case: &TwinCase, fails: impl Fn(&TwinCase) -> bool) -> TwinCase {
    let mut best = case.clone();
    loop {
        let smaller = candidates(&best).into_iter().find(|c| fails(c));
        match smaller {
            Some(c) => best = c,
            None => return best,
        }
    }
}

/// Cases that are a step smaller, boldest first.
fn candidates(case: &TwinCase) -> Vec<TwinCase> {
    let mut list = Vec::new();
    for p in 0..case.passes.len() {
        if case.passes.len() > 1 {
            let mut c = case.clone();
            c.passes.remove(p);
            list.push(c);
        }
        for d in 0..case.passes[p].draws.len() {
            let mut c = case.clone();
            c.passes[p].draws.remove(d);
            list.push(c);
            for smaller in smaller_draws(&case.passes[p].draws[d]) {
                let mut c = case.clone();
                c.passes[p].draws[d] = smaller;
                list.push(c);
            }
        }
    }
    list
}

fn smaller_draws(d: &TwinDraw) -> Vec<TwinDraw> {
    let mut list = Vec::new();
    let mut with = |change: &dyn Fn(&mut TwinDraw) -> bool| {
        let mut smaller = d.clone();
        if change(&mut smaller) {
            list.push(smaller);
        }
    };
    let step = match d.primitive.topology {
        gnomon_raster::state::PrimitiveTopology::TriangleList => 3,
        gnomon_raster::state::PrimitiveTopology::LineList => 2,
        gnomon_raster::state::PrimitiveTopology::PointList => 1,
    };
    with(&|d| d.count > step && shorten(d, 0, d.count / 2));
    with(&|d| d.count > step && shorten(d, step, d.count - step));
    with(&|d| d.count > step && shorten(d, 0, d.count - step));
    with(&|d| d.instances > 1 && set(&mut d.instances, 1));
    with(&|d| set(&mut d.scissor, None));
    with(&|d| set(&mut d.primitive.clip_planes, Vec::new()));
    with(&|d| d.primitive.clip_planes.pop().is_some());
    with(&|d| {
        set(
            &mut d.depth_stencil.bias,
            gnomon_raster::state::DepthBias::default(),
        )
    });
    with(&|d| set(&mut d.depth_stencil.depth.bounds, None));
    with(&|d| {
        set(
            &mut d.depth_stencil.stencil,
            gnomon_raster::state::StencilState::default(),
        )
    });
    with(&|d| {
        set(
            &mut d.depth_stencil.depth,
            gnomon_raster::state::DepthState::default(),
        )
    });
    with(&|d| {
        d.program
            .as_mut()
            .is_some_and(|p| set(&mut p.discard, None))
    });
    with(&|d| d.program.as_mut().is_some_and(|p| set(&mut p.depth, None)));
    with(&|d| {
        let constant = crate::twin::ColorSource::Constant([[0.5; 4]; 4]);
        d.program
            .as_mut()
            .is_some_and(|p| set(&mut p.color, constant))
    });
    with(&|d| d.program.as_mut().is_some_and(shorten_look_ups));
    with(&|d| {
        d.program
            .as_mut()
            .is_some_and(|p| set(&mut p.discards_first, false))
    });
    for k in 0..d.targets.len() {
        with(&|d| {
            set(
                &mut d.targets[k],
                gnomon_raster::state::ColorTargetState::NONE,
            )
        });
        with(&|d| set(&mut d.targets[k].blend, None));
    }
    with(&|d| set(&mut d.interpolation, Vec::new()));
    with(&|d| set(&mut d.vertex_tier, crate::twin::Tier::Lanes));
    with(&|d| set(&mut d.fragment_tier, crate::twin::Tier::Lanes));
    with(&|d| set(&mut d.vertex_source, crate::twin::VertexSource::Buffer));
    with(&|d| set(&mut d.viewport, None));
    list
}

/// Drops the last look-up, unless something else than colour needs look-ups.
fn shorten_look_ups(p: &mut Program) -> bool {
    let needed = matches!(p.depth, Some(DepthSource::LookUp(_)))
        || matches!(p.discard, Some(Discard::LookUpBelow(..)));
    !needed && p.look_ups.len() > 1 && p.look_ups.pop().is_some()
}

/// Leaves out the first few indices or vertices and those beyond a count.
fn shorten(d: &mut TwinDraw, skipped: u32, count: u32) -> bool {
    d.first += skipped;
    d.count = count;
    true
}

/// Assigns; whether that changed anything.
fn set<T: PartialEq>(slot: &mut T, value: T) -> bool {
    let changed = *slot != value;
    *slot = value;
    changed
}
