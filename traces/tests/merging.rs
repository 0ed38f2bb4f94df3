//! Which passes tilers draw in one go, and what that saves.

mod anchor_support;

use std::sync::Arc;

use anchor_support::sums::unequal_sum;
use anchor_support::{Case, draw_layers, judge};
use gnomon_raster::state::{ColorTargetState, DepthStencilState};
use gnomon_raster::{
    ColorAttachment, Draw, Format, Gpu, GpuConfig, LoadOp, Recording, RenderPass, StoreOp,
    Subresource, TextureId,
};
use gnomon_traces::profile::{
    Client, Judge, JudgeOptions, Levels, MergeRefusal, Profile, Traffic, profile,
};
use gnomon_traces::report::FrameReport;
use gnomon_traces::{FrameShape, judged};

const TILERS: [&str; 2] = ["tbr-mali", "tbr-adreno"];
const ZS: Client = Client::DepthStencil;
const COLOR: Client = Client::Color(0);
const PIXELS: u64 = 64 * 64;

fn options(merged: bool) -> JudgeOptions {
    JudgeOptions {
        pixels: true,
        merged,
    }
}

/// A draw again, in another state and with other colour targets.
fn again(draw: &Draw, state: DepthStencilState, targets: Vec<ColorTargetState>) -> Draw {
    let mut pipeline = (*draw.pipeline).clone();
    pipeline.depth_stencil = state;
    if targets.is_empty() {
        pipeline.fragment = None;
    }
    pipeline.color_targets = targets;
    Draw {
        pipeline: Arc::new(pipeline),
        ..draw.clone()
    }
}

/// As `pass`, with all attachments loaded.
fn loading(pass: &RenderPass, label: &str) -> RenderPass {
    let mut pass = pass.clone();
    pass.label = label.to_owned();
    pass.color.iter_mut().for_each(|a| a.load = LoadOp::Load);
    if let Some(depth) = &mut pass.depth_stencil {
        depth.depth_load = LoadOp::Load;
        depth.stencil_load = LoadOp::Load;
    }
    pass
}

/// Ambient, volumes with depth alone, and light: three passes of 64×64.
fn shadow_frame(depth_format: Format) -> Recording {
    let case = Case {
        depth_format,
        ..draw_layers(3, 5)
    };
    let mut r = case.recording();
    let ambient = r.list.passes[0].clone();
    let draw = ambient.draws[1].clone();
    let mut volumes = loading(&ambient, "volumes");
    volumes.color.clear();
    volumes.draws = vec![again(&draw, DepthStencilState::z_pass_volumes(), vec![])];
    let mut lit = loading(&ambient, "lit");
    let state = DepthStencilState::equal_where_stencil_matches();
    lit.draws = vec![again(&draw, state, vec![ColorTargetState::ADDITIVE])];
    r.list.passes.extend([volumes, lit]);
    r
}

fn traffic(recording: &Recording, profile: &Profile, merged: bool) -> Traffic {
    judge(recording, profile, options(merged))
}

/// What reports show: tilers twice, where merging says anything else.
#[test]
fn reports_have_tilers_merged_too() {
    let profiles = ["imr-2008", "tbr-mali"].map(|name| profile(name).unwrap());
    let names = |recording: &Recording| {
        let shape = FrameShape::of(recording);
        let config = GpuConfig::default();
        let mut gpu = Gpu::new(config).unwrap();
        gpu.load(recording).unwrap();
        let report = gpu.submit(&recording.list).unwrap();
        let frame = FrameReport::new(&shape, &report, config);
        let all = judged::judge(recording, &frame, &profiles, config).unwrap();
        let found = all.into_iter().map(|j| j.unwrap());
        let found = found.map(|j| (j.profile, j.frame.bytes()));
        found.collect::<Vec<_>>()
    };
    let frame = shadow_frame(Format::Depth24Stencil8);
    let said = names(&frame);
    let [immediate, apart, merged] = &said[..] else {
        panic!("{said:?}")
    };
    assert_eq!((&*immediate.0, &*apart.0), ("imr-2008", "tbr-mali"));
    assert_eq!(merged.0, "tbr-mali (passes merged)");
    assert!(merged.1 < apart.1, "{said:?}");
    // A pass alone is not merged with anything.
    let mut alone = frame;
    alone.list.passes.truncate(1);
    assert_eq!(names(&alone).len(), 2);
}

fn refusals(profile: &Profile, shape: &FrameShape) -> Vec<Option<MergeRefusal>> {
    let judge = Judge::with_options(profile, shape, options(true)).unwrap();
    let merges = judge.finish().merges;
    for (i, merge) in merges.iter().enumerate() {
        assert_eq!(
            (merge.pass, &merge.label),
            (i + 1, &shape.passes[i + 1].label)
        );
    }
    merges.into_iter().map(|m| m.refused).collect()
}

fn mali() -> Profile {
    profile("tbr-mali").unwrap()
}

/// Bytes of passes outside of their draws, read and written.
fn ends(traffic: &Traffic, client: Client) -> [u64; 2] {
    let rows = traffic.rows.iter().filter(|r| r.draw.is_none());
    let dram = rows.map(|r| r.client(client).dram);
    dram.fold([0; 2], |[r, w], d| [r + d.read_bytes, w + d.write_bytes])
}

/// Depth alone between two passes with colour: everything is written once, nothing is read.
#[test]
fn shadow_volumes_stay_on_chip() {
    for (format, bytes) in [
        (Format::Depth24Stencil8, 4),
        (Format::Depth32FloatStencil8, 8),
    ] {
        let frame = shadow_frame(format);
        for name in TILERS {
            let profile = profile(name).unwrap();
            let apart = traffic(&frame, &profile, false);
            assert_eq!(ends(&apart, ZS), [2 * bytes * PIXELS, 3 * bytes * PIXELS]);
            assert_eq!(ends(&apart, COLOR), [4 * PIXELS, 2 * 4 * PIXELS]);
            assert_eq!(apart.merges, []);
            let merged = traffic(&frame, &profile, true);
            let refused: Vec<_> = merged.merges.iter().map(|m| &m.refused).collect();
            assert_eq!(refused, [&None, &None], "{name}");
            assert_eq!(ends(&merged, ZS), [0, bytes * PIXELS], "{name}");
            assert_eq!(ends(&merged, COLOR), [0, 4 * PIXELS], "{name}");
        }
    }
}

/// The last pass that has an attachment writes it, the first reads it, whatever lies between.
#[test]
fn ends_of_a_group_are_charged_to_its_first_and_last_passes() {
    let mut frame = shadow_frame(Format::Depth24Stencil8);
    // Nobody wants depth afterwards; what is loaded first was drawn in another frame.
    let ambient = &mut frame.list.passes[0];
    ambient.color[0].load = LoadOp::Load;
    let lit = frame.list.passes[2].depth_stencil.as_mut().unwrap();
    (lit.depth_store, lit.stencil_store) = (StoreOp::Discard, StoreOp::Discard);
    let traffic = traffic(&frame, &mali(), true);
    assert_eq!(ends(&traffic, ZS), [0, 0]);
    assert_eq!(ends(&traffic, COLOR), [4 * PIXELS, 4 * PIXELS]);
    let of_pass = |pass: usize| {
        let mut rows = traffic.rows.iter();
        let row = rows.find(|r| r.pass == Some(pass) && r.draw.is_none());
        let dram = row.unwrap().client(COLOR).dram;
        [dram.read_bytes, dram.write_bytes]
    };
    let all = 4 * PIXELS;
    assert_eq!([0, 1, 2].map(of_pass), [[all, 0], [0, 0], [0, all]]);
}

/// Immediate-mode hardware has no tiles: asking changes nothing.
#[test]
fn only_tilers_merge() {
    let frame = shadow_frame(Format::Depth24Stencil8);
    for name in ["naive", "compulsory", "gnomon", "imr-2003", "imr-2008"] {
        let profile = profile(name).unwrap();
        let [apart, asked] = [false, true].map(|m| traffic(&frame, &profile, m));
        assert_eq!(apart, asked, "{name}");
        assert_eq!(asked.merges, []);
    }
}

/// What commands ask for does not depend on tiles; draws move no attachments either way.
#[test]
fn merging_moves_ends_of_passes_only() {
    let frame = shadow_frame(Format::Depth24Stencil8);
    let [apart, merged] = [false, true].map(|m| traffic(&frame, &mali(), m));
    assert_eq!(apart.rows.len(), merged.rows.len());
    for (a, b) in apart.rows.iter().zip(&merged.rows) {
        assert_eq!(a.total().logical, b.total().logical, "{}", a.label);
        if a.draw.is_some() {
            assert_eq!(a, b);
        }
    }
    assert!(merged.total().dram.bytes() < apart.total().dram.bytes());
}

/// The frame's shape with the second pass changed, and why it does not merge.
fn changed(change: impl Fn(&mut FrameShape)) -> Vec<Option<MergeRefusal>> {
    let mut shape = FrameShape::of(&shadow_frame(Format::Depth24Stencil8));
    change(&mut shape);
    refusals(&mali(), &shape)
}

/// A texture of the frame again.
fn copy(shape: &mut FrameShape, of: TextureId, label: &str) -> TextureId {
    let mut texture = shape.textures[of.index()].clone();
    texture.label = label.to_owned();
    shape.textures.push(texture);
    // Ids are given in order, by recordings only.
    let mut ids = Recording::default();
    let mut last = of;
    for texture in &shape.textures {
        last = ids.create(texture).unwrap();
    }
    last
}

#[test]
fn attachments_of_another_size_or_none_in_common() {
    let refused = changed(|shape| {
        let depth = shape.passes[0].depth_stencil.clone().unwrap();
        let other = copy(shape, depth.texture, "small");
        shape.textures[other.index()].size = [32, 64, 1];
        shape.passes[1].depth_stencil.as_mut().unwrap().texture = other;
    });
    let size = MergeRefusal::Size {
        before: [64, 64],
        now: [32, 64],
    };
    assert_eq!(refused[0], Some(size));
    // What came before the refused pass is off chip for those behind it.
    let back = MergeRefusal::Size {
        before: [32, 64],
        now: [64, 64],
    };
    assert_eq!(refused[1], Some(back));
    let nothing = Some(MergeRefusal::NothingShared);
    let refused = changed(|shape| {
        let depth = shape.passes[0].depth_stencil.clone().unwrap();
        let other = copy(shape, depth.texture, "other");
        shape.passes[1].depth_stencil.as_mut().unwrap().texture = other;
    });
    assert_eq!(refused, [nothing.clone(), nothing]);
}

#[test]
fn a_second_depth_attachment() {
    let refused = changed(|shape| {
        let depth = shape.passes[0].depth_stencil.clone().unwrap();
        let other = copy(shape, depth.texture, "other");
        shape.passes[2].depth_stencil.as_mut().unwrap().texture = other;
    });
    assert_eq!(refused, [None, Some(MergeRefusal::SecondDepth)]);
}

/// A cleared stencil or colour is cleared in the tile; a cleared depth begins anew.
#[test]
fn what_a_pass_clears() {
    let stencil = changed(|shape| {
        let depth = shape.passes[1].depth_stencil.as_mut().unwrap();
        depth.stencil_load = LoadOp::Clear(0);
    });
    assert_eq!(stencil, [None, None]);
    let color = changed(|shape| {
        shape.passes[2].color[0].load = LoadOp::Clear([0.0; 4]);
    });
    assert_eq!(color, [None, None]);
    for load in [LoadOp::Clear(1.0), LoadOp::DontCare] {
        let depth = changed(|shape| {
            shape.passes[1].depth_stencil.as_mut().unwrap().depth_load = load;
        });
        assert_eq!(depth, [Some(MergeRefusal::DepthCleared), None]);
    }
}

/// What is discarded cannot be loaded, aspect by aspect.
#[test]
fn what_was_discarded() {
    let gone = |texture: &str| {
        let texture = texture.to_owned();
        Some(MergeRefusal::Discarded { texture })
    };
    let color = changed(|shape| shape.passes[0].color[0].store = StoreOp::Discard);
    assert_eq!(color, [None, gone("color")]);
    let stencil = |load| {
        changed(|shape| {
            let all = shape.passes.iter_mut();
            let mut depths = all.map(|p| p.depth_stencil.as_mut().unwrap());
            depths.next().unwrap().stencil_store = StoreOp::Discard;
            depths.next().unwrap().stencil_load = load;
        })
    };
    assert_eq!(stencil(LoadOp::Load), [gone("depth"), None]);
    assert_eq!(stencil(LoadOp::Clear(0)), [None, None]);
}

/// Where shaders look nobody knows: neither what was drawn may be sampled nor what was
/// sampled be drawn to.
#[test]
fn what_is_sampled() {
    let bind = |shape: &mut FrameShape, pass: usize, texture: TextureId| {
        let binding = gnomon_raster::TextureBinding {
            texture,
            sampler: gnomon_raster::Sampler::bilinear(),
        };
        shape.passes[pass].draws[0].textures = vec![binding];
    };
    let color = changed(|shape| {
        let drawn = shape.passes[0].color[0].texture;
        bind(shape, 1, drawn);
    });
    let texture = "color".to_owned();
    assert_eq!(color[0], Some(MergeRefusal::Sampled { texture }));
    // Then the light cannot go on behind it: it draws to what was sampled.
    let texture = "color".to_owned();
    assert_eq!(color[1], Some(MergeRefusal::DrawnAfterSampling { texture }));
    let unrelated = changed(|shape| {
        let drawn = shape.passes[0].color[0].texture;
        let other = copy(shape, drawn, "other");
        bind(shape, 1, other);
    });
    assert_eq!(unrelated, [None, None]);
}

/// The frame's second pass with `more` more colour attachments.
fn with_colors(more: usize) -> FrameShape {
    let mut shape = FrameShape::of(&shadow_frame(Format::Depth24Stencil8));
    let drawn = shape.passes[0].color[0].texture;
    for i in 0..more {
        let texture = copy(&mut shape, drawn, &format!("more {i}"));
        shape.passes[1].color.push(ColorAttachment {
            texture,
            subresource: Subresource::default(),
            load: LoadOp::Clear([0.0; 4]),
            store: StoreOp::Store,
        });
    }
    shape
}

/// All attachments of a group count, each once, in the smallest tile that there is.
#[test]
fn memory_of_the_smallest_tile() {
    let small = |color: u32, depth: u32| {
        let mut profile = mali();
        (profile.tile.color_bytes, profile.tile.depth_bytes) = (color, depth);
        profile
    };
    let shape = with_colors(2);
    // 12 bytes of colour, 4 of depth, 64 pixels.
    assert_eq!(refusals(&small(12 * 64, 256), &shape), [None, None]);
    let full = |bytes, room| {
        let refused = Some(MergeRefusal::TileMemory { bytes, room });
        vec![refused; 2]
    };
    let refused = refusals(&small(12 * 64 - 1, 256), &shape);
    assert_eq!(refused, full(768, 767));
    let refused = refusals(&small(12 * 64, 255), &shape);
    assert_eq!(refused, full(256, 255));
    // Shared memory holds both; larger tiles have to be larger.
    assert_eq!(refusals(&small(16 * 64, 0), &shape), [None, None]);
    let refused = refusals(&small(16 * 64 - 1, 0), &shape);
    assert_eq!(refused, full(1024, 1023));
    let mut coarse = small(16 * 64, 0);
    coarse.tile.align = 16;
    assert_eq!(refusals(&coarse, &shape), full(4096, 1024));
}

/// Tiles are as small as the attachments of all passes of a group make them.
#[test]
fn more_attachments_make_smaller_tiles() {
    let frame = shadow_frame(Format::Depth24Stencil8);
    let mut profile = mali();
    profile.tile.color_bytes = 4 * 256;
    profile.tile.depth_bytes = 4 * 64;
    // Depth alone halves the tiles of all passes; nothing is left for merging to change.
    let list = |t: &Traffic| t.client(Client::PolygonList).dram.bytes();
    let [apart, merged] = [false, true].map(|m| traffic(&frame, &profile, m));
    assert_eq!(list(&apart), list(&merged));
    // Colour halves those of passes that have it, merged those of the volumes too.
    profile.tile.color_bytes = 4 * 64;
    profile.tile.depth_bytes = 4 * 256;
    let [apart, merged] = [false, true].map(|m| traffic(&frame, &profile, m));
    let of = |t: &Traffic, pass: usize| {
        let rows = t.rows.iter().filter(|r| r.pass == Some(pass));
        rows.map(|r| r.client(Client::PolygonList).dram.bytes())
            .sum::<u64>()
    };
    assert_eq!(
        [0, 2].map(|p| of(&apart, p)),
        [0, 2].map(|p| of(&merged, p))
    );
    // The layers are one triangle that covers all: 16 tiles of 16, or 64 of 8 pixels.
    let bytes = 2 * u64::from(profile.tile.list_bytes);
    assert_eq!([of(&apart, 1), of(&merged, 1)], [16 * bytes, 64 * bytes]);
}

/// Low-resolution Z that a draw froze stays so for all passes that are one.
#[test]
fn what_freezes_low_resolution_z_lasts_as_long_as_the_tiles() {
    let mut frame = shadow_frame(Format::Depth24Stencil8);
    let case = Case {
        layers: vec![0.5, 0.25, 0.375],
        ..draw_layers(1, 0)
    };
    let layers = case.recording().list.passes[0].draws.clone();
    let opaque = DepthStencilState::opaque();
    let solid = |i: usize| again(&layers[i], opaque, vec![ColorTargetState::OPAQUE]);
    let passes = &mut frame.list.passes;
    passes[0].draws = vec![solid(0)];
    passes[2].draws = vec![solid(1), solid(2)];
    let adreno = profile("tbr-adreno").unwrap();
    let culled = |merged| {
        let traffic = traffic(&frame, &adreno, merged);
        let rows = traffic.rows.iter().filter(|r| r.pass == Some(2));
        rows.map(|r| r.hiz.culled).sum::<u64>()
    };
    assert_eq!([culled(false), culled(true)], [64, 0]);
}

const PROFILES: [&str; 7] = [
    "naive",
    "compulsory",
    "gnomon",
    "imr-2003",
    "imr-2008",
    "tbr-mali",
    "tbr-adreno",
];

/// Draws, clients, places and pixels have the same sums over passes, merged and not.
#[test]
fn sums_of_several_passes_are_equal_each_way() {
    for format in [Format::Depth24Stencil8, Format::Depth32FloatStencil8] {
        let frame = shadow_frame(format);
        for name in PROFILES {
            let profile = profile(name).unwrap();
            for merged in [false, true] {
                let traffic = traffic(&frame, &profile, merged);
                assert!(traffic.total().dram.bytes() > 0);
                assert_eq!(unequal_sum(&traffic), None, "{name} {format:?} {merged}");
            }
        }
    }
}

/// Sums from which something is taken are unequal.
#[test]
fn negative_control_what_is_lost_is_noticed() {
    let frame = shadow_frame(Format::Depth24Stencil8);
    for name in ["imr-2008", "tbr-mali"] {
        let profile = profile(name).unwrap();
        let all = traffic(&frame, &profile, true);
        for i in 0..all.rows.len() {
            let mut traffic = traffic(&frame, &profile, true);
            let lost = traffic.rows.remove(i).total();
            let expected = (lost != Levels::default()).then(|| "places of".to_owned());
            let found = unequal_sum(&traffic).map(|w| w[..9].to_owned());
            assert_eq!(found, expected, "{name} {i}");
        }
    }
    let mut traffic = traffic(&frame, &profile("imr-2008").unwrap(), false);
    assert!(traffic.caches[0].dirty.dirtied > 0);
    traffic.caches[0].dirty.flushed += 1;
    assert_eq!(unequal_sum(&traffic), Some("dirty bytes".to_owned()));
}
