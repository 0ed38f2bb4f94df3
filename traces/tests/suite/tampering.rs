//! Files that were changed: what is wrong is said, and where.

use gnomon_raster::GpuConfig;
use gnomon_shaders::table;
use gnomon_traces::{Meta, RecordOptions, ReplayDepth, Trace, TraceError, record, replay};

use crate::forge::{Part, forged, put_together, take_apart};
use crate::golden::goldens;
use crate::user_frame;

#[test]
fn a_flipped_byte_in_every_section_names_it() {
    for (name, trace) in goldens() {
        let file = trace.to_bytes();
        let mut ends: Vec<usize> = take_apart(file).iter().map(|p| p.offset).collect();
        let starts = ends.clone();
        ends.remove(0);
        ends.push(starts[starts.len() - 1] + 56);
        for (part, end) in take_apart(file).iter().zip(ends) {
            // Version, codec, frame, sizes, hash, and bytes of what is stored.
            let places = [4, 6, 8, 16, 24, 32, 47, 48, 50].map(|k| part.offset + k);
            for at in places.into_iter().filter(|at| *at < end) {
                let mut bad = file.to_vec();
                bad[at] ^= 0x10;
                let error = Trace::read(bad).unwrap_err();
                let TraceError::Section { offset, tag, .. } = &error else {
                    panic!("{name} byte {at}: {error}");
                };
                assert_eq!(*offset, part.offset as u64, "{name} byte {at}: {error}");
                let tags = [
                    String::from_utf8_lossy(&part.tag).into_owned(),
                    "????".into(),
                ];
                assert!(tags.contains(tag), "{name} byte {at}: {error}");
            }
        }
    }
}

#[test]
fn every_truncation_opens_up_to_the_cut() {
    let trace = user_frame::trace();
    let file = trace.to_bytes();
    let ends: Vec<u64> = trace
        .sections()
        .iter()
        .map(|s| s.offset + 48 + s.stored)
        .collect();
    for cut in 0..file.len() {
        let whole = ends.iter().filter(|end| **end <= cut as u64).count();
        match Trace::read(file[..cut].to_vec()) {
            Ok(part) => {
                assert!(part.lost().is_some(), "cut at {cut}");
                // Zeros behind the last section may be cut off with it.
                assert!(part.sections().len() + 1 >= whole, "cut at {cut}");
                assert!(part.sections().len() <= whole, "cut at {cut}");
                if let Err(error) = part.recording(0, &table()) {
                    assert!(
                        matches!(error, TraceError::Missing { .. }),
                        "{cut}: {error}"
                    );
                }
            }
            Err(TraceError::NotATrace { .. }) => assert!(cut < 16),
            Err(TraceError::Missing { tag, .. }) => {
                assert!(tag == "META" && whole == 0 || cut < ends[0] as usize + 8)
            }
            Err(error) => panic!("cut at {cut}: {error}"),
        }
    }
}

#[test]
fn sections_of_the_future_are_skipped() {
    let file = user_frame::trace().to_bytes().to_vec();
    let mut parts = take_apart(&file);
    let mut future = parts[0].clone();
    (future.tag, future.version) = (*b"ZZZZ", 9);
    parts.insert(1, future);
    let trace = Trace::read(put_together(&parts)).unwrap();
    let done = replay(
        &trace,
        0,
        &table(),
        GpuConfig::default(),
        ReplayDepth::Draws,
    )
    .unwrap();
    assert_eq!(done.difference, None);
}

/// The least significant byte of the colour of the first constant shader.
fn change_uniform(shaders: &mut [u8]) {
    let name = b"surface.constant";
    let at = shaders.windows(name.len()).position(|w| w == name).unwrap();
    // Name, version, length, then the four floats.
    shaders[at + name.len() + 2 + 2] ^= 0x80;
}

#[test]
fn a_changed_uniform_is_found_at_its_draw() {
    let file = user_frame::trace().to_bytes().to_vec();
    let bad = forged(&file, b"SHAD", |part| change_uniform(&mut part.data));
    let trace = Trace::read(bad).unwrap();
    let done = replay(&trace, 0, &table(), GpuConfig::default(), ReplayDepth::Ends).unwrap();
    let difference = done.difference.unwrap();
    assert_eq!(difference.pass_label, "triangles");
    assert_eq!(difference.attachment.as_deref(), Some("color 0 'target'"));
    let draw = difference.draw.clone().unwrap();
    assert_eq!((draw.draw, draw.label.as_str()), (0, "opaque"));
    assert_eq!(draw.shader, "surface.constant 1");
    let [x, y] = draw.first.unwrap();
    assert!(draw.pixels > 0 && [x / 64, y / 64] == draw.tile.map(u32::from));
    assert_eq!(draw.apart, Some(0), "other values, in the same pixels");
    let text = difference.to_string();
    assert!(
        text.contains("draw 0 'opaque'") && text.contains("tile (0,0)"),
        "{text}"
    );
}

/// A draw whose first corner was elsewhere: pixels are written only then or only now, and
/// the first of them is named.
#[test]
fn pixels_that_were_written_only_then_are_counted() {
    let file = user_frame::trace().to_bytes().to_vec();
    // What the moved frame leaves, with the commands of the one that was not.
    let moved = record(
        Meta::new("user"),
        &user_frame::frame_moved_by(0.25),
        RecordOptions::default(),
    )
    .unwrap();
    let mut parts = take_apart(&file);
    for other in take_apart(moved.to_bytes()) {
        let same = |p: &&mut Part| (p.tag, p.part) == (other.tag, other.part);
        if [*b"HASH", *b"TRAF", *b"TEXL", *b"COUN"].contains(&other.tag) {
            parts.iter_mut().find(same).unwrap().data = other.data;
        }
    }
    let trace = Trace::read(put_together(&parts)).unwrap();
    let done = replay(&trace, 0, &table(), GpuConfig::default(), ReplayDepth::Ends).unwrap();
    let draw = done.difference.unwrap().draw.unwrap();
    assert_eq!((draw.draw, draw.label.as_str()), (0, "opaque"));
    let apart = draw.apart.unwrap();
    assert!(apart > 0 && apart < draw.pixels, "{draw:?}");
    assert!(draw.first.is_some(), "{draw:?}");
}

#[test]
fn other_shaders_and_versions_are_refused() {
    let file = user_frame::trace().to_bytes().to_vec();
    let refused = |change: &dyn Fn(&mut Vec<u8>)| {
        let bad = forged(&file, b"SHAD", |part| change(&mut part.data));
        let trace = Trace::read(bad).unwrap();
        let error = trace.recording(0, &table()).err().unwrap();
        assert!(trace.shape(0).is_ok(), "the shape needs no shader");
        error.to_string()
    };
    let name = b"surface.constant";
    let place = |data: &[u8]| data.windows(name.len()).position(|w| w == name).unwrap();
    let version = refused(&|data| {
        let at = place(data) + name.len();
        data[at] = 7;
    });
    for part in [
        "draw 0 `opaque`",
        "surface.constant",
        "version 1 here",
        "version 7",
    ] {
        assert!(version.contains(part), "{version}");
    }
    let unknown = refused(&|data| {
        let at = place(data);
        data[at] = b'x';
    });
    assert!(
        unknown.contains("xurface.constant") && unknown.contains("draw 0"),
        "{unknown}"
    );
}

#[test]
fn newer_formats_and_other_files_are_refused() {
    let file = user_frame::trace().to_bytes().to_vec();
    let mut newer = file.clone();
    newer[8] = 2;
    let error = Trace::read(newer).unwrap_err().to_string();
    assert!(error.contains("2.0 is newer"), "{error}");
    let section = forged(&file, b"FRAM", |part| part.version = 2);
    let error = Trace::read(section)
        .unwrap()
        .shape(0)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("FRAM") && error.contains("version 2"),
        "{error}"
    );
    let text = Trace::read(b"P6 640 480 and more\n".to_vec()).unwrap_err();
    assert!(matches!(text, TraceError::NotATrace { .. }));
}

#[test]
fn a_section_is_there_once() {
    let mut parts = take_apart(user_frame::trace().to_bytes());
    let again = parts.iter().find(|p| p.tag == *b"COUN").unwrap().clone();
    parts.push(again);
    let error = Trace::read(put_together(&parts)).unwrap_err().to_string();
    assert!(
        error.contains("COUN") && error.contains("before it"),
        "{error}"
    );
}
