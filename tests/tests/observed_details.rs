//! What an observer is told beside the accesses: texels, shader outputs, the fragments of
//! one pixel, witnesses and what draws leave, record for record those of the naive twin, and
//! the same under every configuration.

use std::collections::BTreeMap;

use gnomon_raster::{
    BlockAccess, BlockLeft, Counters, FragmentEnd, FragmentRecord, GpuConfig, MAX_TEXTURES,
    SimdLevel,
};
use gnomon_tests::check::config_of;
use gnomon_tests::gpu_run::{run_observed, run_probed};
use gnomon_tests::parallel;
use gnomon_tests::random::{Random, random_case};
use gnomon_tests::twin::{Log, Outcome, PassOutcome, TwinCase, render_logging, render_with};

const CASES: u64 = 300;

/// Four pixels of a case, most of them drawn to.
fn pixels(seed: u64, case: &TwinCase) -> [[u32; 2]; 4] {
    let mut r = Random::new(seed ^ 0x9_1e75);
    let drawn = render_with(case, true);
    let events: Vec<_> = drawn.passes.iter().flat_map(|p| &p.events).collect();
    r.array(|r| {
        let [w, h] = case.size;
        if events.is_empty() || r.one_in(8) {
            return [r.below(w), r.below(h)];
        }
        let e = events[r.below(events.len() as u32) as usize];
        let set: Vec<u32> = (0..64).filter(|i| e.covered >> i & 1 != 0).collect();
        let i = set[r.below(set.len() as u32) as usize];
        [
            8 * u32::from(e.block[0]) + i % 8,
            8 * u32::from(e.block[1]) + i / 8,
        ]
    })
}

/// The first difference of two lists.
fn differs<T: PartialEq + std::fmt::Debug>(what: &str, gpu: &[T], twin: &[T]) -> Option<String> {
    if let Some((i, (a, b))) = (gpu.iter().zip(twin).enumerate()).find(|(_, (a, b))| a != b) {
        return Some(format!("{what} {i}: GPU {a:#x?}, twin {b:#x?}"));
    }
    let (a, b) = (gpu.len(), twin.len());
    (a != b).then(|| format!("{what}: {a} of the GPU, {b} of the twin"))
}

fn pass_difference(gpu: &PassOutcome, twin: &PassOutcome) -> Option<String> {
    let (a, b) = (&gpu.details, &twin.details);
    differs("event", &gpu.events, &twin.events)
        .or_else(|| differs("texel access", &a.texels, &b.texels))
        .or_else(|| differs("output", &a.outputs, &b.outputs))
        .or_else(|| differs("value", &a.values, &b.values))
        .or_else(|| differs("fragment", &a.fragments, &b.fragments))
        .or_else(|| differs("block left", &a.left, &left(&twin.events)))
}

/// What the last event of each draw in each block left there, each once.
fn left(events: &[BlockAccess]) -> Vec<BlockLeft> {
    let mut last = BTreeMap::new();
    for e in events.iter().filter(|e| e.witness != 0) {
        last.insert((e.draw, e.block[1], e.block[0]), e.witness);
    }
    let left = last.into_iter().map(|((draw, y, x), seen)| BlockLeft {
        draw,
        block: [x, y],
        seen,
    });
    left.collect()
}

/// How much was compared: texel accesses, values, integers, witnesses, records by end, and
/// those with a depth that is not the plane's.
#[derive(Default)]
struct Seen {
    texels: usize,
    values: usize,
    integers: usize,
    witnesses: usize,
    ends: [usize; 6],
    several: usize,
}

impl Seen {
    fn add(&mut self, o: &Outcome) {
        for p in &o.passes {
            let d = &p.details;
            self.texels += d.texels.len();
            self.values += d.values.len();
            self.integers += d.outputs.iter().filter(|o| o.integers[0] != 0).count();
            self.witnesses += p.events.iter().filter(|e| e.witness != 0).count();
            d.fragments
                .iter()
                .for_each(|f| self.ends[f.end as usize] += 1);
            let draw = |f: &FragmentRecord| p.events[f.event as usize].draw;
            self.several += d
                .fragments
                .windows(2)
                .filter(|w| draw(&w[0]) == draw(&w[1]))
                .count();
        }
    }

    fn join(mut self, other: Self) -> Self {
        self.texels += other.texels;
        self.values += other.values;
        self.integers += other.integers;
        self.witnesses += other.witnesses;
        self.several += other.several;
        (0..6).for_each(|i| self.ends[i] += other.ends[i]);
        self
    }
}

fn compare(seed: u64) -> Result<Seen, String> {
    let case = random_case(seed);
    let mut seen = Seen::default();
    for (k, probe) in pixels(seed, &case).into_iter().enumerate() {
        let skip = k % 2 == 0;
        let config = GpuConfig {
            skip,
            ..config_of(seed + k as u64)
        };
        let gpu = run_probed(&case, config, probe).map_err(|e| e.to_string())?;
        let log = Log {
            probe: Some(probe),
            witness: true,
        };
        let twin = render_logging(&case, skip, log);
        for (p, (gpu, twin)) in gpu.passes.iter().zip(&twin.passes).enumerate() {
            if let Some(d) = pass_difference(gpu, twin) {
                return Err(format!(
                    "seed {seed}, pixel {probe:?}, {config:?}, pass {p}: {d}"
                ));
            }
        }
        seen.add(&gpu);
    }
    Ok(seen)
}

#[test]
fn details_equal_the_twins_record_for_record() {
    let found = parallel::map(0..CASES, compare);
    let seen = found
        .into_iter()
        .map(|f| f.unwrap_or_else(|e| panic!("{e}")))
        .fold(Seen::default(), Seen::join);
    assert!(
        seen.texels > 10_000 && seen.values > 100_000,
        "{}",
        seen.values
    );
    assert!(
        seen.integers > 100 && seen.witnesses > 10_000,
        "{}",
        seen.integers
    );
    assert!(seen.several > 100, "{} times one draw again", seen.several);
    assert!(seen.ends.iter().all(|n| *n > 40), "{:?}", seen.ends);
}

/// Reads by slot are the counters' (those of discarded fragments that do not count are in
/// neither).
#[test]
fn taps_sum_to_the_counters() {
    let mut slots = 0;
    for seed in 0..CASES {
        let case = random_case(seed);
        let o = run_probed(&case, config_of(seed), [0, 0]).unwrap();
        for p in &o.passes {
            let mut taps = vec![[0; MAX_TEXTURES]; p.draws.len()];
            for t in &p.details.texels {
                let draw = p.events[t.event as usize].draw as usize;
                taps[draw][usize::from(t.slot)] += u64::from(t.taps);
                assert!(
                    u64::from(t.texels.count_ones()) <= u64::from(t.taps),
                    "{t:?}"
                );
            }
            for (taps, c) in taps.iter().zip(&p.draws) {
                assert_eq!(*taps, c.traffic.tex.map(|t| t.read_accesses), "seed {seed}");
                slots += taps.iter().filter(|n| **n > 0).count();
            }
        }
    }
    assert!(slots > 100, "{slots} slots were read");
}

/// What wants are met changes neither accesses nor attachments nor counters.
#[test]
fn wants_change_nothing_else() {
    for seed in 0..CASES {
        let (case, config) = (random_case(seed), config_of(seed));
        let mut all = run_probed(&case, config, [1, 1]).unwrap();
        for p in &mut all.passes {
            p.details = Default::default();
            p.events.iter_mut().for_each(|e| e.witness = 0);
        }
        assert!(all == run_observed(&case, config).unwrap(), "seed {seed}");
    }
}

fn configs() -> Vec<GpuConfig> {
    let mut list = Vec::new();
    for threads in [1, 2, 4] {
        for tile in [16, 64, 128] {
            for simd in SimdLevel::available() {
                list.push(GpuConfig {
                    threads,
                    tile,
                    simd,
                    skip: true,
                });
            }
        }
    }
    list
}

#[test]
fn details_are_the_same_under_every_configuration() {
    let same = |seed: u64| {
        let case = random_case(0xd00d_0000 + seed);
        let probe = pixels(seed, &case)[0];
        let mut first: Option<Outcome> = None;
        for config in configs() {
            let o = run_probed(&case, config, probe).unwrap();
            let reference = first.get_or_insert_with(|| o.clone());
            assert!(*reference == o, "case {seed} under {config:?}");
        }
    };
    parallel::map(0..24, same);
}

/// What follows on one record of a pass is what the one before left, and the last one left
/// what is stored in the end, if no store operation destroys it.
fn assert_chained(case: &TwinCase, o: &Outcome, [x, y]: [u32; 2], what: &str) {
    let at = (y * case.size[0] + x) as usize;
    for p in &o.passes {
        for w in p.details.fragments.windows(2) {
            let (a, b) = (&w[0], &w[1]);
            assert_eq!(a.stored_depth[1], b.stored_depth[0], "{what}");
            assert_eq!(a.stencil[1], b.stencil[0], "{what}");
            assert_eq!(a.color.map(|c| c[1]), b.color.map(|c| c[0]), "{what}");
        }
    }
    let (Some(p), Some(pass)) = (o.passes.last(), case.passes.last()) else {
        return;
    };
    let Some(last) = p.details.fragments.last() else {
        return;
    };
    for (k, c) in pass.color.iter().enumerate() {
        let stored = match c.store {
            gnomon_raster::StoreOp::Store => last.color[k][1],
            gnomon_raster::StoreOp::Discard => [0; 4],
        };
        assert_eq!(o.color[c.image][at], stored, "{what}");
    }
    if let Some(d) = &pass.depth {
        let kept = d.depth_store == gnomon_raster::StoreOp::Store;
        let stored = if kept { last.stored_depth[1] } else { 0 };
        assert_eq!(o.depth[at], stored, "{what}");
    }
}

/// Records by end of a draw.
fn by_end(c: &Counters) -> [u64; 6] {
    let f = &c.fragments;
    let mut ends = [0; 6];
    for (end, n) in [
        (FragmentEnd::Hiz, f.hiz_killed),
        (FragmentEnd::Bounds, f.bounds_failed),
        (FragmentEnd::Stencil, f.stencil_failed),
        (FragmentEnd::Depth, f.depth_failed),
        (FragmentEnd::Discarded, f.discarded),
        (FragmentEnd::Written, f.written),
    ] {
        ends[end as usize] = n;
    }
    ends
}

/// Over all pixels of a frame, records chain, and sum by end to the counters of each draw.
#[test]
fn records_of_all_pixels_sum_to_the_counters() {
    let mut frames = 0;
    for seed in 0.. {
        let case = random_case(seed);
        let [w, h] = case.size;
        if w * h > 1600 || w * h < 200 {
            continue;
        }
        let config = GpuConfig {
            threads: 1,
            ..config_of(seed)
        };
        let (mut sums, mut counted) = (Vec::new(), Vec::new());
        for pixel in 0..w * h {
            let probe = [pixel % w, pixel / w];
            let o = run_probed(&case, config, probe).unwrap();
            assert_chained(&case, &o, probe, &format!("seed {seed}, {probe:?}"));
            counted = o
                .passes
                .iter()
                .map(|p| p.draws.iter().map(by_end).collect())
                .collect();
            sums.resize(o.passes.len(), Vec::new());
            for (p, sums) in o.passes.iter().zip(&mut sums) {
                sums.resize(p.draws.len(), [0; 6]);
                for f in &p.details.fragments {
                    sums[p.events[f.event as usize].draw as usize][f.end as usize] += 1;
                }
            }
        }
        let counted: Vec<Vec<[u64; 6]>> = counted;
        assert_eq!(sums, counted, "seed {seed}");
        frames += 1;
        if frames == 3 {
            return;
        }
    }
}
