//! The twin by itself: laws that hold without a second rasteriser.

use gnomon_raster::{Counters, MAX_TEXTURES};
use gnomon_tests::random::random_case;
use gnomon_tests::twin::{Outcome, render, render_with};

fn draws(o: &Outcome) -> impl Iterator<Item = &Counters> {
    o.passes.iter().flat_map(|p| &p.draws)
}

#[test]
fn every_fragment_ends_once_and_skipping_changes_no_bit() {
    for seed in 0..300 {
        let case = random_case(seed);
        let (with, without) = (render(&case), render_with(&case, false));
        for (a, b) in draws(&with).zip(draws(&without)) {
            for f in [a.fragments, b.fragments] {
                let ends = f.hiz_killed
                    + f.bounds_failed
                    + f.stencil_failed
                    + f.depth_failed
                    + f.discarded
                    + f.written;
                assert_eq!(f.generated, ends, "seed {seed}");
            }
            assert_eq!(a.fragments.generated, b.fragments.generated, "seed {seed}");
            assert_eq!(a.fragments.written, b.fragments.written, "seed {seed}");
            assert_eq!(a.primitives, b.primitives, "seed {seed}");
        }
        assert_eq!(with.color, without.color, "seed {seed}");
        assert_eq!(
            (with.depth, with.stencil),
            (without.depth, without.stencil),
            "seed {seed}"
        );
    }
}

#[test]
fn random_cases_reach_every_counter() {
    let mut sum = Counters::default();
    for seed in 0..400 {
        draws(&render(&random_case(seed))).for_each(|c| sum.add(c));
    }
    let text = format!("{sum:#?}");
    println!("{text}");
    let zero: Vec<_> = text
        .lines()
        .filter(|l| l.trim_end().ends_with(": 0,"))
        .collect();
    // Nothing writes textures, vertices or indices.
    assert!(
        sum.tiles.accepted > 0 && sum.tiles.culled > 0 && sum.primitives.steep_depth_planes > 0,
        "{zero:?}"
    );
    assert!(
        sum.events.blend_saturated[0] > 0
            && sum.events.depth_clamped > 0
            && sum.events.nan_canonicalised > 0
    );
    assert!((0..MAX_TEXTURES).all(|slot| {
        sum.traffic.tex_fetches[slot] > 0 && sum.traffic.tex[slot].read_accesses > 0
    }));
    assert!(
        sum.primitives.clipped > 0
            && sum.primitives.non_finite > 0
            && sum.primitives.face_culled > 0
    );
}
