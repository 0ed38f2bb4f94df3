//! The history of a pixel is what the naive twin has written down, event for event.

use gnomon_raster::{FragmentEnd, GpuConfig, StoreOp};
use gnomon_tests::check::config_of;
use gnomon_tests::gpu_run;
use gnomon_tests::parallel;
use gnomon_tests::random::{Random, random_case};
use gnomon_tests::twin::{Log, Look, PassOutcome, TwinCase, TwinPass, render_logging};
use gnomon_traces::history::{
    self, Change, EventKind, FragmentEvent, History, HistoryError, HistoryOptions, PixelEvent,
    Value,
};

const CASES: u64 = 300;

/// What is compared, in the words of the history.
#[derive(Debug, PartialEq)]
enum Told {
    Load([Vec<Value>; 2]),
    Store([Vec<Value>; 2]),
    Fragment(Box<FragmentEvent>, [Vec<Value>; 2]),
}

fn values(look: &Look, pass: &TwinPass) -> Vec<Value> {
    let depth = look.depth.filter(|_| pass.depth.is_some());
    let color = pass.color.iter().map(|c| Value::Color(look.color[c.image]));
    let depth = depth.map(|(z, s)| Value::DepthStencil(z, s));
    depth.into_iter().chain(color).collect()
}

fn both(e: &PixelEvent) -> [Vec<Value>; 2] {
    let all: Vec<&Change> = e.depth_stencil.iter().chain(&e.color).collect();
    [
        all.iter().map(|c| c.before).collect(),
        all.iter().map(|c| c.after).collect(),
    ]
}

fn of_history(e: &PixelEvent) -> Told {
    match &e.kind {
        EventKind::Load { .. } => Told::Load(both(e)),
        EventKind::Store { .. } => Told::Store(both(e)),
        EventKind::Fragment(f) => Told::Fragment(f.clone(), both(e)),
    }
}

/// What the twin tells of a pass; of fragments, what it does not say is taken from `like`.
fn of_twin(pass: &TwinPass, o: &PassOutcome, like: &[&FragmentEvent]) -> Vec<Told> {
    let d = &o.details;
    let looks: Vec<_> = d.looks.iter().map(|l| values(l, pass)).collect();
    let mut told = vec![Told::Load([looks[0].clone(), looks[1].clone()])];
    for (i, r) in d.fragments.iter().enumerate().take(like.len()) {
        let e = &o.events[r.event as usize];
        let draw = &pass.draws[e.draw as usize];
        let side = usize::from(!e.front);
        let state = |when: usize| -> Vec<Value> {
            let depth = Value::DepthStencil(r.stored_depth[when], r.stencil[when]);
            let depth = pass.depth.as_ref().map(|_| depth);
            let color = r.color.iter().take(pass.color.len());
            let color = color.map(|c| Value::Color(c[when]));
            depth.into_iter().chain(color).collect()
        };
        let mut f = like[i].clone();
        (f.draw, f.primitive, f.piece, f.front) = (e.draw, e.primitive, e.piece, e.front);
        (f.end, f.depth, f.span, f.stored) = (r.end, r.depth, e.span, e.stored);
        let varyings = draw.interpolation.len();
        f.varyings = r.varyings.map(|v| v[..varyings].to_vec());
        f.outputs = r.source.map(|s| s[..pass.color.len()].to_vec());
        f.compare = pass
            .depth
            .as_ref()
            .map(|_| draw.depth_stencil.depth.compare);
        if let Some(s) = &mut f.stencil {
            let faces = &draw.depth_stencil.stencil;
            s.face = [faces.front, faces.back][side];
            s.reference = draw.stencil_reference[side];
            s.op = d.operations[i];
        }
        told.push(Told::Fragment(Box::new(f), [state(0), state(1)]));
    }
    let stores = pass.color.iter().map(|c| c.store);
    let depth = pass
        .depth
        .iter()
        .flat_map(|d| [d.depth_store, d.stencil_store]);
    if stores.chain(depth).any(|s| s == StoreOp::Discard) {
        told.push(Told::Store([looks[2].clone(), looks[3].clone()]));
    }
    told
}

/// How many fragments there were by end, and stores.
type Seen = [usize; 7];

/// One pixel of a case.
fn compare_pixel(seed: u64, case: &TwinCase, probe: [u32; 2], config: GpuConfig) -> Seen {
    let mut seen = Seen::default();
    let what = format!("seed {seed}, {probe:?}, {config:?}");
    let options = HistoryOptions {
        config,
        image: None,
    };
    let recording = gpu_run::recording(case, config).unwrap();
    let h = match history::pixel(&recording, &options, probe) {
        Err(HistoryError::NotDrawn) if case.passes.is_empty() => return seen,
        h => h.unwrap_or_else(|e| panic!("{what}: {e}")),
    };
    let log = Log {
        probe: Some(probe),
        witness: false,
    };
    let twin = render_logging(case, config.skip, log);
    for (p, (pass, o)) in case.passes.iter().zip(&twin.passes).enumerate() {
        let events = h.events.iter().filter(|e| e.pass == p);
        let told: Vec<_> = events.map(of_history).collect();
        if told.is_empty() {
            assert!(!is_followed(&h, case, p), "{what}, pass {p}");
            continue;
        }
        let like: Vec<_> = told.iter().filter_map(fragment).collect();
        let expected = of_twin(pass, o, &like);
        let first = told.iter().zip(&expected).find(|(a, b)| a != b);
        assert_eq!(first, None, "{what}, pass {p}: history left, twin right");
        assert_eq!(told.len(), expected.len(), "{what}, pass {p}");
        assert_eq!(like.len(), o.details.fragments.len(), "{what}, pass {p}");
        like.iter().for_each(|f| seen[f.end as usize] += 1);
        seen[6] += usize::from(matches!(told.last(), Some(Told::Store(_))));
    }
    seen
}

fn fragment(t: &Told) -> Option<&FragmentEvent> {
    match t {
        Told::Fragment(f, _) => Some(f),
        _ => None,
    }
}

/// Whether a pass shares an image with one that is told of.
fn is_followed(h: &History, case: &TwinCase, pass: usize) -> bool {
    let images = |p: &TwinPass| -> Vec<Option<usize>> {
        let color = p.color.iter().map(|c| Some(c.image));
        color.chain(p.depth.iter().map(|_| None)).collect()
    };
    let mine = images(&case.passes[pass]);
    let told = h.events.iter().map(|e| images(&case.passes[e.pass]));
    told.flatten().any(|i| mine.contains(&i))
}

fn compare(seed: u64) -> Seen {
    let case = random_case(seed);
    let mut r = Random::new(seed ^ 0x4157);
    let mut seen = Seen::default();
    for k in 0..4 {
        let probe = [r.below(case.size[0]), r.below(case.size[1])];
        let config = GpuConfig {
            skip: k % 2 == 0,
            ..config_of(seed + k)
        };
        let found = compare_pixel(seed, &case, probe, config);
        (0..7).for_each(|i| seen[i] += found[i]);
    }
    seen
}

#[test]
fn histories_equal_the_twins() {
    let mut seen = Seen::default();
    for found in parallel::map(0..CASES, compare) {
        (0..7).for_each(|i| seen[i] += found[i]);
    }
    assert!(seen.iter().all(|n| *n >= 10), "{seen:?}");
    assert!(seen[FragmentEnd::Written as usize] > 300, "{seen:?}");
}

/// What cannot be shown is said, with what would be valid.
#[test]
fn bad_requests_are_told_what_is_valid() {
    let (case, config) = (random_case(3), config_of(3));
    let recording = gpu_run::recording(&case, config).unwrap();
    let [w, h] = case.size;
    let ask = |image: Option<&str>, pixel| {
        let options = HistoryOptions {
            config,
            image: image.map(str::to_owned),
        };
        history::pixel(&recording, &options, pixel)
    };
    let e = ask(None, [w, 0]).unwrap_err().to_string();
    let valid = format!("columns 0 to {} and rows 0 to {}", w - 1, h - 1);
    assert!(e.contains(&valid), "{e}");
    assert!(ask(None, [w - 1, h - 1]).is_ok());
    let e = ask(Some("colour"), [0, 0]).unwrap_err().to_string();
    assert!(e.contains("no output `colour`; it has none"), "{e}");
    let history = ask(None, [w / 2, h / 2]).unwrap();
    let e = history.fragment(0).unwrap_err().to_string();
    assert!(e.starts_with("the pixel has no fragment 0; "), "{e}");
}
