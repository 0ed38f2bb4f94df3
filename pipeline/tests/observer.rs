//! What an observer is told of whole frames: batches that follow one another, the same
//! for every execution, and no more of them in memory than fits.

use gnomon_pipeline::technique::{Frame, Params};
use gnomon_pipeline::techniques::{self, find};
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::state::{CompareFunction, DepthStencilState, StencilOperation};
use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, CommandList, Gpu, GpuConfig, PassReport, SimdLevel,
    SubmitReport, Subresource, Wants,
};

fn frame(scene: &str, technique: &str, size: [u32; 2]) -> Frame {
    let scene = builtin::build(scene).unwrap();
    let technique = find(technique).unwrap();
    let params = Params::defaults(technique);
    technique.frame(&scene, size, &params).unwrap()
}

/// Order of an access in its pass.
fn place(a: &BlockAccess) -> (u32, u32, u32, u16, u16) {
    (a.draw, a.primitive, a.piece, a.block[1], a.block[0])
}

/// Notes how accesses come, without keeping them.
#[derive(Default)]
struct Stream {
    /// Of the pass that is being drawn: number of batches, and the last access.
    batches: usize,
    last: Option<BlockAccess>,
    /// Fragments by draw.
    covered: Vec<u64>,
    written: Vec<u64>,
    /// FNV-1a of all accesses, in order.
    hash: u64,
    accesses: u64,
    most_batches: usize,
    passes: usize,
}

impl AccessObserver for Stream {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        assert_eq!(pass, self.passes, "passes come one after the other");
        assert!(!batch.blocks.is_empty());
        self.batches += 1;
        for access in batch.blocks {
            if let Some(last) = &self.last {
                assert!(place(last) < place(access), "{last:?} before {access:?}");
            }
            self.last = Some(*access);
            self.note(access);
        }
    }

    fn end(&mut self, pass: usize, report: &PassReport) {
        assert_eq!(pass, self.passes);
        self.covered.resize(report.draws.len(), 0);
        self.written.resize(report.draws.len(), 0);
        for (draw, (covered, written)) in report
            .draws
            .iter()
            .zip(self.covered.iter().zip(&self.written))
        {
            let counted = &draw.counters.fragments;
            assert_eq!((*covered, *written), (counted.generated, counted.written));
        }
        self.most_batches = self.most_batches.max(self.batches);
        self.passes += 1;
        self.batches = 0;
        self.last = None;
        self.covered.clear();
        self.written.clear();
    }
}

impl Stream {
    fn note(&mut self, a: &BlockAccess) {
        let draw = a.draw as usize;
        if self.covered.len() <= draw {
            self.covered.resize(draw + 1, 0);
            self.written.resize(draw + 1, 0);
        }
        self.covered[draw] += u64::from(a.covered.count_ones());
        self.written[draw] += u64::from(a.written().count_ones());
        self.accesses += 1;
        for byte in format!("{a:?}").bytes() {
            self.hash = (self.hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

/// Results of a frame, as bytes.
fn results(gpu: &Gpu, frame: &Frame) -> Vec<Vec<u8>> {
    let image = Subresource::default();
    let read = |(_, id)| gpu.texture(id).unwrap().read_packed(image).unwrap();
    frame.recording.outputs().map(read).collect()
}

fn unobserved(frame: &Frame, config: GpuConfig) -> (Vec<Vec<u8>>, SubmitReport) {
    let mut gpu = Gpu::new(config).unwrap();
    gpu.load(&frame.recording).unwrap();
    let report = gpu.submit(&frame.recording.list).unwrap();
    (results(&gpu, frame), report)
}

/// What was observed; results and counters are those of nobody looking.
fn observed(frame: &Frame, config: GpuConfig) -> Stream {
    let mut gpu = Gpu::new(config).unwrap();
    gpu.load(&frame.recording).unwrap();
    let mut stream = Stream::default();
    let wants = Wants {
        depth_ranges: true,
        ..Wants::default()
    };
    let list = &frame.recording.list;
    let report = gpu.submit_observed(list, wants, &mut stream).unwrap();
    assert_eq!(stream.passes, list.passes.len());
    let (pictures, plain) = unobserved(frame, config);
    assert!(results(&gpu, frame) == pictures, "{config:?}");
    for (pass, other) in report.passes.iter().zip(&plain.passes) {
        assert_eq!(pass.draws, other.draws, "{config:?}");
    }
    stream
}

/// However a frame is executed, the batches one after the other are the same.
#[test]
fn batches_follow_one_another_the_same_everywhere() {
    let frame = frame("demo", "shadow-volumes", [160, 120]);
    let mut first = None;
    for simd in SimdLevel::available() {
        for (threads, tile) in [(1, 16), (3, 64), (2, 128)] {
            let config = GpuConfig {
                threads,
                tile,
                simd,
                skip: true,
            };
            let stream = observed(&frame, config);
            assert!(stream.most_batches > 3, "{}", stream.most_batches);
            let found = (stream.accesses, stream.hash);
            assert_eq!(*first.get_or_insert(found), found, "{config:?}");
        }
    }
}

/// Counts, from the events of a run without skipping, what skipping would do.
struct WhatIf<'a> {
    list: &'a CommandList,
    /// By pass and draw: blocks tested, culled and accepted, fragments killed, depths read.
    found: Vec<Vec<[u64; 5]>>,
}

impl AccessObserver for WhatIf<'_> {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        for e in batch.blocks {
            let of = &self.list.passes[pass];
            let draw = e.draw as usize;
            let attached = of.depth_stencil.is_some();
            let state = &of.draws[draw].pipeline.depth_stencil;
            add(&mut self.found[pass][draw], state, attached, e);
        }
    }
}

fn add(to: &mut [u64; 5], state: &DepthStencilState, attached: bool, e: &BlockAccess) {
    let compare = state.depth.compare;
    let looks = !matches!(compare, CompareFunction::Always | CompareFunction::Never);
    let used = attached && looks && state.depth.bounds.is_none();
    let [passes, fails] = if used {
        decided(compare, e)
    } else {
        [false; 2]
    };
    let face = if e.front {
        &state.stencil.front
    } else {
        &state.stencil.back
    };
    let effective = |op| op != StencilOperation::Keep && face.write_mask != 0;
    let culled = fails && !effective(face.fail_op) && !effective(face.depth_fail_op);
    let pixels = |mask: u64| u64::from(mask.count_ones());
    to[0] += u64::from(used);
    to[1] += u64::from(culled);
    to[2] += u64::from((passes || fails) && !culled);
    to[3] += if culled { pixels(e.covered) } else { 0 };
    to[4] += if passes || fails { 0 } else { pixels(e.z_read) };
}

/// Whether a block passes or fails as a whole, for the tests that techniques use.
fn decided(compare: CompareFunction, e: &BlockAccess) -> [bool; 2] {
    let ([a, b], [min, max]) = (e.span, e.stored);
    match compare {
        CompareFunction::Less => [b < min, a >= max && b >= min],
        CompareFunction::LessEqual => [b <= min, a > max],
        CompareFunction::Greater => [a > max, b <= min],
        CompareFunction::GreaterEqual => [a >= max, b < min],
        CompareFunction::Equal => [a == b && min == max && a == min, b < min || a > max],
        other => panic!("no technique uses {other:?}"),
    }
}

/// What zmin/zmax skip follows from the events of a run without them, draw by draw.
#[test]
fn skipping_follows_from_unskipped_events_in_every_technique() {
    let mut seen = [0; 5];
    let with = |skip| GpuConfig {
        skip,
        ..GpuConfig::default()
    };
    for technique in techniques::all() {
        let frame = frame("creature", technique.name(), [96, 72]);
        let (_, skipped) = unobserved(&frame, with(true));
        let list = &frame.recording.list;
        let draws = list.passes.iter().map(|p| vec![[0; 5]; p.draws.len()]);
        let mut what_if = WhatIf {
            list,
            found: draws.collect(),
        };
        let mut gpu = Gpu::new(with(false)).unwrap();
        gpu.load(&frame.recording).unwrap();
        let wants = Wants {
            depth_ranges: true,
            ..Wants::default()
        };
        gpu.submit_observed(list, wants, &mut what_if).unwrap();
        for (pass, found) in skipped.passes.iter().zip(&what_if.found) {
            for (draw, found) in pass.draws.iter().zip(found) {
                let c = &draw.counters;
                let counted = [
                    c.tiles.tested,
                    c.tiles.culled,
                    c.tiles.accepted,
                    c.fragments.hiz_killed,
                    c.traffic.z.read_accesses,
                ];
                let what = (technique.name(), &pass.label, &draw.label);
                assert_eq!(*found, counted, "{what:?}");
                (0..5).for_each(|i| seen[i] += counted[i]);
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 1000), "{seen:?}");
}

/// Memory of the process so far at its highest, in bytes, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1024 * kib)
}

/// Counts accesses and their bytes, and keeps none.
#[derive(Default)]
struct Weighed {
    all: u64,
    largest: u64,
}

impl AccessObserver for Weighed {
    fn batch(&mut self, _: usize, batch: &AccessBatch<'_>) {
        let bytes = size_of_val(batch.blocks) as u64;
        self.all += bytes;
        self.largest = self.largest.max(bytes);
    }
}

const MIB: u64 = 1 << 20;

/// In a process of its own, or the memory of other tests would count too.
#[test]
fn accesses_of_a_large_pass_do_not_pile_up() {
    const CHILD: &str = "GNOMON_OBSERVER_MEMORY";
    if std::env::var_os(CHILD).is_some() {
        large_pass();
        return;
    }
    let me = std::env::current_exe().unwrap();
    let name = "accesses_of_a_large_pass_do_not_pile_up";
    let mut child = std::process::Command::new(me);
    child.args([name, "--exact", "--nocapture"]).env(CHILD, "1");
    let done = child.output().unwrap();
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(
        done.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&done.stderr)
    );
}

fn large_pass() {
    let frame = frame("statue", "soft-shadow-volumes", [640, 480]);
    let mut gpu = Gpu::new(GpuConfig {
        threads: 2,
        ..GpuConfig::default()
    })
    .unwrap();
    gpu.load(&frame.recording).unwrap();
    let before = peak_memory();
    let mut weighed = Weighed::default();
    let wants = Wants {
        depth_ranges: true,
        ..Wants::default()
    };
    gpu.submit_observed(&frame.recording.list, wants, &mut weighed)
        .unwrap();
    println!("{} MiB of accesses", weighed.all / MIB);
    println!("{} MiB in the largest batch", weighed.largest / MIB);
    assert!(weighed.all > 400 * MIB, "{}", weighed.all);
    assert!(weighed.largest < 64 * MIB, "{}", weighed.largest);
    if let (Some(before), Some(after)) = (before, peak_memory()) {
        println!("peak {} MiB, {} before", after / MIB, before / MIB);
        assert!(after < 256 * MIB, "{after} bytes");
    }
}
