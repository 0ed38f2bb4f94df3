//! What zmin/zmax would have saved, found from a frame that was drawn without them, is what
//! they do save, draw by draw.

use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques;
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::{Gpu, GpuConfig, Recording, SubmitReport, Wants};
use gnomon_tests::gpu_run::recorded;
use gnomon_tests::random::random_case;
use gnomon_traces::profile::{Client, HizCounts, Judge, Traffic, profile};
use gnomon_traces::{FrameShape, Witness};

fn gpu(recording: &Recording, skip: bool) -> Gpu {
    let mut gpu = Gpu::new(GpuConfig {
        threads: 1,
        skip,
        ..GpuConfig::default()
    })
    .unwrap();
    gpu.load(recording).unwrap();
    gpu
}

fn judged(recording: &Recording) -> Traffic {
    let gnomon = profile("gnomon").unwrap();
    let mut judge = Judge::new(&gnomon, &FrameShape::of(recording)).unwrap();
    let wants = Wants {
        depth_ranges: true,
        texels: true,
        witness: Some(&Witness),
        ..Wants::default()
    };
    gpu(recording, false)
        .submit_observed(&recording.list, wants, &mut judge)
        .unwrap();
    judge.finish()
}

fn skipping(recording: &Recording) -> SubmitReport {
    gpu(recording, true).submit(&recording.list).unwrap()
}

/// How many blocks the two agree on having been thrown away.
fn compare(name: &str, recording: &Recording) -> u64 {
    let (traffic, report) = (judged(recording), skipping(recording));
    let mut rows = traffic.rows.iter().filter(|r| r.draw.is_some());
    let mut culled = 0;
    for pass in &report.passes {
        for draw in &pass.draws {
            let c = &draw.counters;
            let truth = HizCounts {
                tested: c.tiles.tested,
                culled: c.tiles.culled,
                accepted: c.tiles.accepted,
                killed: c.fragments.hiz_killed,
                z_reads: c.traffic.z.read_accesses,
            };
            let row = rows.next().unwrap();
            let what = format!("{name}: {} {}", pass.label, draw.label);
            assert_eq!(row.hiz, truth, "{what}");
            let t = &c.traffic;
            let zs = row.client(Client::DepthStencil).logical;
            assert_eq!(
                zs.read_bytes,
                t.z.read_bytes + t.stencil.read_bytes,
                "{what}"
            );
            assert_eq!(
                zs.write_bytes,
                t.z.write_bytes + t.stencil.write_bytes,
                "{what}"
            );
            let hiz = row.client(Client::Hiz).logical;
            assert_eq!(hiz.read_bytes, t.hiz.read_bytes, "{what}");
            assert_eq!(hiz.write_bytes, t.hiz.write_bytes, "{what}");
            for (i, color) in t.color.iter().enumerate() {
                let row = row.client(Client::Color(i as u8)).logical;
                assert_eq!(row.bytes(), color.bytes(), "{what}");
            }
            for (i, tex) in t.tex.iter().enumerate() {
                let row = row.client(Client::Texture(i as u8)).logical;
                assert_eq!(row.read_bytes, tex.read_bytes, "{what} {i}");
            }
            culled += c.tiles.culled;
        }
    }
    culled
}

fn small(technique: &dyn Technique) -> Params {
    let wanted = ["map-size=64", "samples=4", "maps=4", "texture-size=8"];
    let has = |set: &&&str| {
        let key = set.split('=').next();
        technique.params().iter().any(|p| Some(p.name) == key)
    };
    let set: Vec<String> = wanted.iter().filter(has).map(|s| (*s).to_owned()).collect();
    Params::parse(technique, &set).unwrap()
}

#[test]
fn of_every_technique() {
    let mut culled = 0;
    for name in ["creature", "adversarial-eye-in-shadow"] {
        let scene = builtin::build(name).unwrap();
        for technique in techniques::all() {
            let params = small(*technique);
            let Ok(frame) = technique.frame(&scene, [72, 52], &params) else {
                continue;
            };
            culled += compare(technique.name(), &frame.recording);
        }
    }
    assert!(culled > 100, "{culled}");
}

#[test]
fn of_random_cases() {
    let culled: u64 = (0..400)
        .map(|seed| {
            compare(
                &format!("case {seed}"),
                &recorded(&random_case(seed)).unwrap(),
            )
        })
        .sum();
    assert!(culled > 100, "{culled}");
}
