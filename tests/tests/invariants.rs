//! Laws of the counters, on the GPU's own numbers.

use gnomon_raster::{BlockAccess, Counters, GpuConfig, Traffic};
use gnomon_tests::check::config_of;
use gnomon_tests::compare::attachments;
use gnomon_tests::gpu_run::{run, run_observed};
use gnomon_tests::random::random_case;
use gnomon_tests::twin::render_with;

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

fn assert_sums(c: &Counters, events: &[&BlockAccess], what: &str) {
    let sum = |f: &dyn Fn(&BlockAccess) -> u64| {
        events
            .iter()
            .map(|e| u64::from(f(e).count_ones()))
            .sum::<u64>()
    };
    assert_eq!(sum(&|e| e.covered), c.fragments.generated, "{what}");
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
