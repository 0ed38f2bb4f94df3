//! What is cut out of a trace shows what it showed in it.

use gnomon_raster::{GpuConfig, StoreOp};
use gnomon_shaders::table;
use gnomon_traces::{
    Keep, Meta, RecordOptions, ReplayDepth, Trace, TraceError, record, replay, trim,
};

use crate::forge::{put_together, take_apart};
use crate::golden::goldens;
use crate::user_frame;

fn cut(trace: &Trace, keep: &Keep) -> Trace {
    let cut = trim(trace, keep, &table(), GpuConfig::default());
    let cut = cut.unwrap_or_else(|e| panic!("{keep:?}: {e}"));
    let done = replay(&cut, 0, &table(), GpuConfig::default(), ReplayDepth::Draws).unwrap();
    assert_eq!(done.difference, None, "{keep:?}");
    cut
}

fn draws(trace: &Trace) -> usize {
    let passes = trace.shape(0).unwrap().passes;
    passes.iter().map(|p| p.draws.len()).sum()
}

/// Bytes of all textures.
fn state(trace: &Trace) -> usize {
    let textures = trace.shape(0).unwrap().textures;
    let bytes = textures.iter().map(|d| {
        let texel = d.format.bytes() as usize + usize::from(d.format.is_depth_stencil());
        let texels: u32 = d.size.iter().product();
        2 * 6 * texel * texels as usize
    });
    bytes.sum()
}

#[test]
fn every_prefix_and_every_draw_shows_what_it_showed() {
    let mut all = goldens();
    all.push(("user".to_owned(), user_frame::trace()));
    for (name, trace) in all {
        let count = draws(&trace);
        let few = count.min(12);
        for n in 0..few {
            let at = n * count / few;
            for range in [0..at + 1, at..at + 1] {
                let kept = cut(&trace, &Keep::Draws(0, range.clone()));
                assert_eq!(draws(&kept), range.len(), "{name} {range:?}");
                let most = trace.to_bytes().len() + state(&trace);
                assert!(kept.to_bytes().len() <= most, "{name} {range:?}");
            }
        }
        let whole = cut(&trace, &Keep::Draws(0, 0..count));
        let again = cut(&whole, &Keep::Draws(0, 0..count));
        assert_eq!(whole.id().unwrap(), again.id().unwrap(), "{name}");
        let passes = trace.shape(0).unwrap().passes.len();
        for pass in 0..passes.min(6) {
            let kept = cut(&trace, &Keep::Passes(0, pass..pass + 1));
            let again = cut(&kept, &Keep::Passes(0, 0..1));
            assert!(kept.to_bytes() == again.to_bytes(), "{name} pass {pass}");
        }
        cut(&trace, &Keep::Frames(0..1));
    }
}

#[test]
fn what_is_not_there_cannot_be_kept() {
    let trace = user_frame::trace();
    for keep in [
        Keep::Draws(0, 0..99),
        Keep::Passes(0, 1..1),
        Keep::Frames(1..2),
        Keep::Draws(3, 0..1),
    ] {
        let refused = trim(&trace, &keep, &table(), GpuConfig::default()).unwrap_err();
        assert!(
            matches!(refused, TraceError::Range { .. }),
            "{keep:?}: {refused}"
        );
    }
}

/// What is cut is compared with what was recorded, here of another frame in each place.
#[test]
fn a_cut_that_would_show_something_else_is_refused() {
    let file = user_frame::trace().to_bytes().to_vec();
    let refused = |tag: &[u8; 4], part: u32, byte: &dyn Fn(usize) -> usize| {
        let mut parts = take_apart(&file);
        let found = parts.iter_mut().find(|p| p.tag == *tag && p.part == part);
        let data = &mut found.unwrap().data;
        let at = byte(data.len());
        data[at] ^= 1;
        let forged = Trace::read(put_together(&parts)).unwrap();
        let cut = trim(&forged, &Keep::Frames(0..1), &table(), GpuConfig::default());
        match cut.unwrap_err() {
            TraceError::Trimmed { frame, pass, what } => {
                assert_eq!(frame, 0);
                format!("{what} in pass {pass}")
            }
            other => panic!("{}: {other}", String::from_utf8_lossy(tag)),
        }
    };
    // The low bits of the first hash of a pass's end, and of the last hash of a tile.
    assert_eq!(refused(b"HASH", 0, &|_| 2), "what it leaves in pass 0");
    assert_eq!(
        refused(b"HASH", 0, &|n| n - 2),
        "what its draws leave in pass 1"
    );
    // The last counter of the last draw.
    let counted = refused(b"COUN", 0, &|n| n - 1);
    assert_eq!(counted, "what its draws count in pass 1");
    // The class that the last event saw; how often the last texels were read.
    for (tag, pass) in [(b"TRAF", 0), (b"TRAF", 1), (b"TEXL", 1)] {
        let found = refused(tag, pass, &|n| n - 1);
        let wanted = format!("in pass {pass}");
        assert!(
            found.starts_with("access ") && found.ends_with(&wanted),
            "{found}"
        );
    }
}

/// What a pass would throw away at its end is the result of one that is cut short.
#[test]
fn what_is_left_in_the_middle_of_a_pass_is_kept() {
    let mut frame = user_frame::frame();
    let pass = &mut frame.list.passes[0];
    pass.color[0].store = StoreOp::Discard;
    let depth = pass.depth_stencil.as_mut().unwrap();
    (depth.depth_store, depth.stencil_store) = (StoreOp::Discard, StoreOp::Discard);
    let trace = record(Meta::new("user"), &frame, RecordOptions::default()).unwrap();
    let stores = |draws| {
        let kept = cut(&trace, &Keep::Draws(0, draws));
        let pass = kept.recording(0, &table()).unwrap().list.passes.remove(0);
        let depth = pass.depth_stencil.unwrap();
        [pass.color[0].store, depth.depth_store, depth.stencil_store]
    };
    assert_eq!(stores(0..1), [StoreOp::Store; 3]);
    assert_eq!(stores(0..2), [StoreOp::Discard; 3]);
}
