//! What each rule of the memory models does, on frames small enough to add up by hand.

mod anchor_support;

use anchor_support::sums::unequal_sum;
use anchor_support::{Case, Vertex, draw_layers, judge};
use gnomon_raster::state::{CompareFunction, DepthStencilState};
use gnomon_raster::{Format, Gpu, GpuConfig, LoadOp, Recording, RenderPass, Wants};
use gnomon_traces::profile::{
    CacheKind, Client, Judge, JudgeOptions, Profile, Traffic, TrafficRow, profile,
};
use gnomon_traces::{FrameShape, Witness};

const ZS: Client = Client::DepthStencil;
const COLOR: Client = Client::Color(0);
const TEXTURE: Client = Client::Texture(0);
/// Bytes of a picture of 64×64.
const ALL: u64 = 4 * 64 * 64;

fn named(name: &str) -> Profile {
    profile(name).unwrap()
}

fn judged(recording: &Recording, profile: &Profile) -> Traffic {
    let options = JudgeOptions {
        pixels: true,
        merged: false,
    };
    let traffic = judge(recording, profile, options);
    assert_eq!(unequal_sum(&traffic), None, "{}", profile.name);
    traffic
}

fn draws(traffic: &Traffic) -> Vec<&TrafficRow> {
    traffic.rows.iter().filter(|r| r.draw.is_some()).collect()
}

/// A rectangle of pixels of a picture of 64×64, in one colour.
fn rectangle([x0, y0, x1, y1]: [f32; 4]) -> Case {
    let corner = |x, y| Vertex {
        position: [x, y],
        color: [0.25, 0.5, 0.75, 1.0],
    };
    let [a, b, c, d] = [
        corner(x0, y0),
        corner(x1, y0),
        corner(x1, y1),
        corner(x0, y1),
    ];
    Case {
        vertices: vec![a, b, c, a, c, d],
        ..Case::new(64, 64)
    }
}

/// The draws of all cases in one pass.
fn one_pass(cases: &[Case]) -> Recording {
    let mut all = cases[0].recording();
    for case in &cases[1..] {
        let more = case.recording().list.passes.remove(0).draws;
        all.list.passes[0].draws.extend(more);
    }
    all
}

fn one_line(profile: &Profile) -> Profile {
    let mut small = profile.clone();
    for port in [&mut small.depth_stencil, &mut small.color] {
        port.cache = CacheKind::Sets { sets: 1, ways: 1 };
    }
    small
}

/// Whoever made a line dirty pays for it, whoever forces it out.
#[test]
fn write_backs_are_charged_to_who_made_lines_dirty() {
    let mut plain = one_line(&named("imr-2008"));
    (plain.color.codec, plain.color.fast_clear) = (false, false);
    let whole = rectangle([0.0, 0.0, 8.0, 8.0]);
    let part = rectangle([16.0, 0.0, 20.0, 8.0]);
    let traffic = judged(&one_pass(&[whole, part]), &plain);
    let written: Vec<u64> = draws(&traffic)
        .iter()
        .map(|r| r.client(COLOR).dram.write_bytes)
        .collect();
    // A whole block; half of one, which touches all of its parts of two rows.
    assert_eq!(written, [256, 256]);
    let evicted: Vec<u64> = draws(&traffic).iter().map(|r| r.evicted_bytes).collect();
    assert!(evicted[0] == 0 && evicted[1] >= 256, "{evicted:?}");
    assert_eq!(traffic.flushed(COLOR), 256);
}

#[test]
fn opaque_colors_are_written_and_blended_ones_are_read_too() {
    for (blended, read) in [(false, 0), (true, 256)] {
        let case = Case {
            blended,
            ..rectangle([0.0, 0.0, 8.0, 8.0])
        };
        let traffic = judged(&case.recording(), &named("naive"));
        let color = draws(&traffic)[0].client(COLOR);
        for level in [color.logical, color.cache, color.dram] {
            assert_eq!([level.read_bytes, level.write_bytes], [read, 256]);
        }
    }
}

/// A compressed line that is written in part has to be known whole before.
#[test]
fn compressed_lines_are_completed() {
    let small = one_line(&named("imr-2008"));
    // The first block is written whole, forced out by the second, and written in part.
    let cases = [
        rectangle([0.0, 0.0, 8.0, 8.0]),
        rectangle([8.0, 0.0, 16.0, 8.0]),
        rectangle([0.0, 0.0, 4.0, 4.0]),
    ];
    let traffic = judged(&one_pass(&cases), &small);
    let color: Vec<[u64; 2]> = draws(&traffic)
        .iter()
        .map(|r| r.client(COLOR).dram)
        .map(|d| [d.read_bytes, d.write_bytes])
        .collect();
    assert_eq!(color, [[0, 64], [0, 64], [64, 64]]);
}

/// ATTILA's entries lag behind the cache.
#[test]
fn entries_follow_when_lines_are_written_back() {
    let mut case = draw_layers(1, 0);
    case.layers = vec![0.25, 0.5];
    let frame = case.recording();
    let culled = |profile: &Profile| draws(&judged(&frame, profile))[1].hiz.culled;
    let attila = named("imr-2008");
    assert_eq!(culled(&attila), 0);
    assert_eq!(
        culled(&one_line(&attila)),
        63,
        "but for the line in the cache"
    );
    let mut at_once = attila;
    at_once.hiz.on_write_back = false;
    assert_eq!(culled(&at_once), 64);
}

/// Entries of few bits are rounded away from what they hold.
#[test]
fn entries_are_rounded_to_the_safe_side() {
    let culled = |depth_format, layers: [f32; 2]| {
        let case = Case {
            depth_format,
            layers: layers.into(),
            ..draw_layers(1, 0)
        };
        let traffic = judged(&case.recording(), &named("imr-2003"));
        draws(&traffic)[1].hiz.culled
    };
    let fixed = Format::Depth24Stencil8;
    assert_eq!(culled(fixed, [0.51, 0.51 + 1.0 / 1024.0]), 0);
    assert_eq!(culled(fixed, [0.51, 0.51 + 1.0 / 128.0]), 64);
    // Of a float 30 bits count: eight of them are the exponent and one more.
    let float = Format::Depth32FloatStencil8;
    assert_eq!(culled(float, [0.5, 0.5625]), 0);
    assert_eq!(culled(float, [0.25, 0.75]), 64);
}

/// What is decided without reading depth reads none; what fails with effect is no less done.
#[test]
fn decided_blocks_read_no_depth() {
    let mut case = draw_layers(1, 0);
    case.layers = vec![0.5, 0.25, 0.75];
    let opaque = DepthStencilState::opaque();
    case.states = vec![opaque, opaque, DepthStencilState::z_fail_volumes()];
    let traffic = judged(&case.recording(), &named("gnomon"));
    let [_, near, fails] = draws(&traffic)[..] else {
        panic!("three draws");
    };
    assert_eq!((near.hiz.accepted, near.hiz.z_reads), (64, 0));
    assert_eq!((fails.hiz.culled, fails.hiz.accepted), (0, 64));
    assert_eq!(fails.client(ZS).logical.write_bytes, 64 * 64);
}

#[test]
fn entries_cost_where_they_are_in_memory() {
    let frame = draw_layers(2, 0).recording();
    let hiz = |name| judged(&frame, &named(name)).client(Client::Hiz);
    let here = hiz("gnomon");
    assert!(here.dram.read_bytes > 0 && here.dram == here.logical);
    let on_chip = hiz("imr-2003");
    assert!(on_chip.logical.read_bytes > 0);
    assert_eq!(on_chip.dram.bytes(), 0);
}

/// A block that is thrown away looks nothing up, though its shader would before its test.
#[test]
fn culled_blocks_read_no_texels() {
    let case = Case {
        discards: true,
        layers: vec![0.25, 0.5],
        depth: Some(CompareFunction::Less),
        ..textured(0.5)
    };
    let frame = case.recording();
    let read = |name: &str| -> Vec<u64> {
        let traffic = judged(&frame, &named(name));
        let rows = draws(&traffic);
        let texels = rows.iter().map(|r| r.client(TEXTURE).logical.read_bytes);
        texels.collect()
    };
    let all = read("naive");
    assert!(all[0] > 0 && all[1] == all[0], "{all:?}");
    assert_eq!(read("gnomon"), [all[0], 0]);
}

/// A square of 64×64 that shows so much of the image of 256×256, from its first quarter on.
fn textured(part: f32) -> Case {
    let corner = |x: f32, y: f32| Vertex {
        position: [64.0 * x, 64.0 * y],
        color: [0.25 + part * x, 0.25 + part * y, 0.0, 1.0],
    };
    let [a, b, c, d] = [
        corner(0.0, 0.0),
        corner(1.0, 0.0),
        corner(1.0, 1.0),
        corner(0.0, 1.0),
    ];
    Case {
        textured: true,
        vertices: vec![a, b, c, a, c, d],
        ..Case::new(64, 64)
    }
}

/// Texels that are looked up are read, not the blocks that they lie in.
#[test]
fn footprints_are_of_texels() {
    // 51.2 texels each way, and one more at either end for the filter.
    let traffic = judged(&textured(0.2).recording(), &named("compulsory"));
    let texels = traffic.client(TEXTURE).dram.read_bytes / 4;
    assert!((51 * 51..=54 * 54).contains(&texels), "{texels}");
}

/// Each unit has a cache of its own: what they share is read by each.
#[test]
fn units_read_for_themselves() {
    let frame = textured(0.125).recording();
    let mut units = named("compulsory");
    let one = judged(&frame, &units).client(TEXTURE).dram.read_bytes;
    units.texture_units = 4;
    let four = judged(&frame, &units).client(TEXTURE).dram.read_bytes;
    assert!(four > one && four <= 4 * one, "{four} {one}");
}

#[test]
fn whether_look_ups_were_recorded_is_known() {
    let told = |case: &Case, texels| {
        let recording = case.recording();
        let shape = FrameShape::of(&recording);
        let mut judge = Judge::new(&named("naive"), &shape).unwrap();
        let mut gpu = Gpu::new(GpuConfig {
            skip: false,
            ..GpuConfig::default()
        })
        .unwrap();
        gpu.load(&recording).unwrap();
        let wants = Wants {
            depth_ranges: true,
            texels,
            witness: Some(&Witness),
            ..Wants::default()
        };
        gpu.submit_observed(&recording.list, wants, &mut judge)
            .unwrap();
        judge.finish().texels_recorded
    };
    let looks_up = textured(0.5);
    assert!(told(&looks_up, true) && !told(&looks_up, false));
    assert!(told(&draw_layers(1, 0), false), "there are none to record");
}

#[test]
fn tilers_read_vertices_as_often_as_they_need_them() {
    let frame = draw_layers(1, 0).recording();
    let vertices = |name| judged(&frame, &named(name)).client(Client::Vertex);
    for (name, times) in [("naive", 1), ("tbr-mali", 1), ("tbr-adreno", 2)] {
        let v = vertices(name);
        assert!(v.logical.read_bytes > 0);
        assert_eq!(v.dram.read_bytes, times * v.logical.read_bytes, "{name}");
    }
}

/// The pass again, with these loads of depth, stencil and colour.
fn after(
    pass: &RenderPass,
    depth: LoadOp<f32>,
    stencil: LoadOp<u8>,
    color: LoadOp<[f32; 4]>,
) -> RenderPass {
    let mut pass = pass.clone();
    pass.draws.clear();
    pass.color[0].load = color;
    let attached = pass.depth_stencil.as_mut().unwrap();
    (attached.depth_load, attached.stencil_load) = (depth, stencil);
    pass
}

/// Half of each word is cleared: what is cached is written back, words are read and written.
#[test]
fn clears_of_an_aspect_move_words() {
    let mut frame = draw_layers(1, 0).recording();
    let first = frame.list.passes[0].clone();
    let second = after(&first, LoadOp::Load, LoadOp::Clear(0), LoadOp::Load);
    frame.list.passes.push(second);
    let traffic = judged(&frame, &named("compulsory"));
    let clears = traffic.rows.iter().find(|r| r.pass == Some(1)).unwrap();
    let zs = clears.client(ZS);
    assert_eq!([zs.dram.read_bytes, zs.dram.write_bytes], [ALL, ALL]);
    assert_eq!(zs.logical.write_bytes, ALL / 4);
    assert_eq!(draws(&traffic)[0].client(ZS).dram.write_bytes, ALL);
    assert_eq!(traffic.flushed(ZS), 0);
    let dirty = traffic.caches[0].dirty;
    assert_eq!([dirty.written_back, dirty.flushed], [ALL, 0]);
}

/// What is cleared whole need not be written back, and is dirty no more.
#[test]
fn what_is_cleared_is_forgotten() {
    let mut frame = draw_layers(1, 0).recording();
    let first = frame.list.passes[0].clone();
    let (clear, stencil) = (LoadOp::Clear(1.0), LoadOp::Clear(0));
    frame
        .list
        .passes
        .push(after(&first, clear, stencil, LoadOp::Load));
    for name in ["compulsory", "imr-2008"] {
        let mut profile = named(name);
        profile.scanout = false;
        let traffic = judged(&frame, &profile);
        assert_eq!(traffic.caches[0].dirty.dirtied, 0, "{name}");
        assert!(traffic.caches[1].dirty.dirtied > 0, "{name}");
        let drawn = draws(&traffic)[0].client(ZS).dram;
        assert_eq!(drawn.write_bytes, 0, "{name}");
    }
}

/// What was drawn to a texture is in memory before it is sampled, and is read anew when it
/// was drawn again.
#[test]
fn textures_are_drawn_and_sampled_in_turn() {
    let mut frame = textured(0.5).recording();
    let sampling = frame.list.passes[0].clone();
    let image = sampling.draws[0].textures[0].texture;
    // The image of 256×256 becomes an attachment; depth is not needed.
    let case = Case {
        depth: None,
        vertices: [[0.0, 0.0], [512.0, 0.0], [0.0, 512.0]]
            .map(|position| Vertex {
                position,
                color: [1.0; 4],
            })
            .into(),
        ..Case::new(256, 256)
    };
    let mut drawing = case.recording().list.passes.remove(0);
    drawing.color[0].texture = image;
    frame.list.passes = vec![
        drawing.clone(),
        sampling.clone(),
        drawing.clone(),
        sampling.clone(),
        sampling,
    ];
    let traffic = judged(&frame, &named("compulsory"));
    let bytes = 4 * 256 * 256;
    let row = |pass| {
        *draws(&traffic)
            .iter()
            .find(|r| r.pass == Some(pass))
            .unwrap()
    };
    for pass in [0, 2] {
        assert_eq!(row(pass).client(COLOR).dram.write_bytes, bytes, "{pass}");
    }
    let read = |pass: usize| row(pass).client(TEXTURE).dram.read_bytes;
    assert!(read(1) > 0);
    assert_eq!([read(3), read(4)], [read(1), 0]);
    // The second picture lies in the cache at the end; all of the image was written before.
    assert_eq!(traffic.flushed(COLOR), ALL);
}
