//! Laws of the counters, on the GPU's own numbers.

use gnomon_raster::state::{CompareFunction, StencilOperation};
use gnomon_raster::{BlockAccess, Counters, GpuConfig, Traffic};
use gnomon_tests::check::config_of;
use gnomon_tests::compare::attachments;
use gnomon_tests::gpu_run::{run, run_in_pieces, run_observed};
use gnomon_tests::random::random_case;
use gnomon_tests::twin::{TwinDraw, render_with};

const CASES: u64 = 300;

fn assert_conserved(c: &Counters, what: &str) {
    let f = c.fragments;
    let ends = f.hiz_killed
        + f.bounds_failed
        + f.stencil_failed
        + f.depth_failed
        + f.discarded
        + f.written;
    assert_eq!(f.generated, ends, "{what}: {f:?}");
    let p = c.primitives;
    let ends = p.degenerate + p.face_culled + p.rasterized;
    assert!(
        p.input - p.non_finite - p.frustum_culled <= ends,
        "{what}: {p:?}"
    );
    assert!(p.steep_depth_planes <= p.rasterized, "{what}: {p:?}");
    assert!(
        c.tiles.culled + c.tiles.accepted <= c.tiles.tested,
        "{what}: {:?}",
        c.tiles
    );
    let t = c.traffic;
    assert_eq!(t.hiz.read_accesses, c.tiles.tested, "{what}");
    let both = |f: fn(&Traffic) -> u64| f(&t.z) + f(&t.stencil);
    assert_eq!(
        t.packed_depth_stencil.read_accesses,
        both(|t| t.read_accesses),
        "{what}"
    );
    assert_eq!(
        t.packed_depth_stencil.write_accesses,
        both(|t| t.write_accesses),
        "{what}"
    );
    assert!(c.events.silent_z_writes <= t.z.write_accesses, "{what}");
    assert!(
        c.events.silent_stencil_writes <= t.stencil.write_accesses,
        "{what}"
    );
    for (silent, color) in c.events.silent_color_writes.iter().zip(t.color) {
        assert!(
            *silent <= color.write_accesses && color.write_accesses <= f.written,
            "{what}"
        );
    }
    assert!(
        f.written <= c.fragment_shader_invocations || c.fragment_shader_invocations == 0,
        "{what}"
    );
    let listed: u64 = t.named().iter().map(|(_, t)| t.bytes()).sum();
    assert_eq!(listed, t.total_bytes(), "{what}");
}

#[test]
fn fragments_and_primitives_are_conserved() {
    for seed in 0..CASES {
        let outcome =
            run(&random_case(seed), config_of(seed)).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
        for c in outcome.passes.iter().flat_map(|p| &p.draws) {
            assert_conserved(c, &format!("seed {seed}"));
        }
    }
}

/// Ends are disjoint parts of what is covered.
fn assert_parted(e: &BlockAccess, what: &str) {
    let all = match e.ended.hiz {
        true => vec![e.covered],
        false => vec![
            e.ended.bounds,
            e.ended.stencil,
            e.ended.depth,
            e.ended.discarded,
            e.written(),
        ],
    };
    let pixels: u32 = all.iter().map(|m| m.count_ones()).sum();
    let union = all.iter().fold(0, |u, m| u | m);
    assert_eq!(
        (union, pixels),
        (e.covered, e.covered.count_ones()),
        "{what}: {e:?}"
    );
}

fn assert_sums(c: &Counters, events: &[&BlockAccess], what: &str) {
    let sum = |f: &dyn Fn(&BlockAccess) -> u64| {
        events
            .iter()
            .map(|e| u64::from(f(e).count_ones()))
            .sum::<u64>()
    };
    assert_eq!(sum(&|e| e.covered), c.fragments.generated, "{what}");
    let f = &c.fragments;
    let ends = [
        sum(&|e| if e.ended.hiz { e.covered } else { 0 }),
        sum(&|e| e.ended.bounds),
        sum(&|e| e.ended.stencil),
        sum(&|e| e.ended.depth),
        sum(&|e| e.ended.discarded),
        sum(&|e| e.written()),
    ];
    let counted = [
        f.hiz_killed,
        f.bounds_failed,
        f.stencil_failed,
        f.depth_failed,
        f.discarded,
        f.written,
    ];
    assert_eq!(ends, counted, "{what}: ends");
    events.iter().for_each(|e| assert_parted(e, what));
    let t = &c.traffic;
    let accesses = |t: &Traffic| [t.read_accesses, t.write_accesses];
    assert_eq!(
        [sum(&|e| e.z_read), sum(&|e| e.z_write)],
        accesses(&t.z),
        "{what}: z"
    );
    assert_eq!(
        [sum(&|e| e.stencil_read), sum(&|e| e.stencil_write)],
        accesses(&t.stencil),
        "{what}: stencil"
    );
    assert_eq!(
        [sum(&|e| e.hiz_read.into()), sum(&|e| e.hiz_write.into())],
        accesses(&t.hiz),
        "{what}: hiz"
    );
    for k in 0..4 {
        let pair = [sum(&|e| e.color_read[k]), sum(&|e| e.color_write[k])];
        assert_eq!(pair, accesses(&t.color[k]), "{what}: color[{k}]");
    }
}

#[test]
fn observed_accesses_sum_to_the_counters_and_equal_the_twins() {
    for seed in 0..CASES {
        let (case, config) = (random_case(seed), config_of(seed));
        let outcome = run_observed(&case, config).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
        let twin = render_with(&case, config.skip);
        for (k, (pass, twin)) in outcome.passes.iter().zip(&twin.passes).enumerate() {
            for (d, c) in pass.draws.iter().enumerate() {
                let events: Vec<_> = pass.events.iter().filter(|e| e.draw == d as u32).collect();
                assert_sums(c, &events, &format!("seed {seed}, pass {k}, draw {d}"));
            }
            let first = pass.events.iter().zip(&twin.events).find(|(a, b)| a != b);
            assert_eq!(first, None, "seed {seed}, pass {k}: GPU left, twin right");
            assert_eq!(
                pass.events.len(),
                twin.events.len(),
                "seed {seed}, pass {k}"
            );
        }
    }
}

#[test]
fn an_observer_and_skipping_change_no_bit() {
    for seed in 0..CASES {
        let case = random_case(seed);
        let with = |skip| GpuConfig {
            skip,
            ..config_of(seed)
        };
        let plain = run(&case, with(true)).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
        let mut observed =
            run_observed(&case, with(true)).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
        observed.passes.iter_mut().for_each(|p| p.events.clear());
        assert!(
            plain == observed,
            "seed {seed}: an observer changes the outcome"
        );
        let slow = run(&case, with(false)).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
        assert_eq!(
            attachments(&plain, &slow, case.size[0]),
            None,
            "seed {seed}: skipping (left) changes a pixel"
        );
        let draws = |o: &gnomon_tests::twin::Outcome| -> Vec<_> {
            o.passes
                .iter()
                .flat_map(|p| &p.draws)
                .map(|c| (c.primitives, c.fragments.generated, c.fragments.written))
                .collect()
        };
        assert_eq!(draws(&plain), draws(&slow), "seed {seed}");
    }
}

/// What zmin/zmax say about a depth test, from an event's ranges alone.
fn decided(compare: CompareFunction, e: &BlockAccess) -> Option<bool> {
    let ([a, b], [min, max]) = (e.span, e.stored);
    let same = a == b && min == max && a == min;
    let apart = b < min || a > max;
    let (passes, fails) = match compare {
        CompareFunction::Less => (b < min, a >= max),
        CompareFunction::LessEqual => (b <= min, a > max),
        CompareFunction::Greater => (a > max, b <= min),
        CompareFunction::GreaterEqual => (a >= max, b < min),
        CompareFunction::Equal => (same, apart),
        CompareFunction::NotEqual => (apart, same),
        CompareFunction::Never | CompareFunction::Always => (false, false),
    };
    match (passes, fails) {
        (true, _) => Some(true),
        (_, true) => Some(false),
        _ => None,
    }
}

/// Whether something can happen to fragments of that side that fail the depth test.
fn acts_on_failure(d: &TwinDraw, front: bool) -> bool {
    let s = &d.depth_stencil.stencil;
    let face = if front { &s.front } else { &s.back };
    let effective = |op| op != StencilOperation::Keep && face.write_mask != 0;
    effective(face.fail_op) || effective(face.depth_fail_op)
}

/// Blocks tested, culled and accepted, fragments killed, and depths read, had zmin/zmax
/// of 8×8 blocks been used in a run that did not.
fn what_if(d: &TwinDraw, attached: bool, events: &[&BlockAccess]) -> [u64; 5] {
    let state = &d.depth_stencil.depth;
    let looks = !matches!(
        state.compare,
        CompareFunction::Never | CompareFunction::Always
    );
    let own_depth = d.program.as_ref().is_some_and(|p| p.depth.is_some());
    let used = attached && looks && state.bounds.is_none() && !own_depth;
    let mut sums = [0; 5];
    for e in events {
        let decision = if used {
            decided(state.compare, e)
        } else {
            None
        };
        let culled = decision == Some(false) && !acts_on_failure(d, e.front);
        let pixels = |m: u64| u64::from(m.count_ones());
        sums[0] += u64::from(used);
        sums[1] += u64::from(culled);
        sums[2] += u64::from(decision.is_some() && !culled);
        sums[3] += if culled { pixels(e.covered) } else { 0 };
        sums[4] += if decision.is_none() {
            pixels(e.z_read)
        } else {
            0
        };
    }
    sums
}

/// The events of a run without skipping hold all that skipping needs: its counters
/// follow from them, draw by draw.
#[test]
fn skipping_follows_from_the_events_of_a_run_without() {
    let mut seen = [0; 5];
    for seed in 0..CASES {
        let case = random_case(seed);
        let with = |skip| GpuConfig {
            skip,
            ..config_of(seed)
        };
        let skipped = run(&case, with(true)).unwrap();
        let observed = run_observed(&case, with(false)).unwrap();
        for (k, (pass, of)) in observed.passes.iter().zip(&case.passes).enumerate() {
            for (d, draw) in of.draws.iter().enumerate() {
                let mine = pass.events.iter().filter(|e| e.draw == d as u32);
                let events: Vec<_> = mine.collect();
                let found = what_if(draw, of.depth.is_some(), &events);
                let c = &skipped.passes[k].draws[d];
                let counted = [
                    c.tiles.tested,
                    c.tiles.culled,
                    c.tiles.accepted,
                    c.fragments.hiz_killed,
                    c.traffic.z.read_accesses,
                ];
                assert_eq!(found, counted, "seed {seed}, pass {k}, draw {d}");
                (0..5).for_each(|i| seen[i] += counted[i]);
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 1000), "{seen:?}");
}

/// Textures that are made again from their bytes are the same textures: attachments and
/// counters of later passes, zmin/zmax tests included, do not tell them apart.
#[test]
fn textures_go_through_bytes_unseen() {
    let mut passes = 0;
    for seed in 0..CASES {
        let (case, config) = (random_case(seed), config_of(seed));
        let whole = run(&case, config).unwrap();
        let pieces = run_in_pieces(&case, config).unwrap();
        assert!(whole == pieces, "seed {seed} in {config:?}");
        passes += case.passes.len().saturating_sub(1);
    }
    assert!(passes > 50, "{passes} passes after others");
}
