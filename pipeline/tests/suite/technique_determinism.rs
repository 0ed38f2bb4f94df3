//! Every technique of the registry gives the same bits for every thread count,
//! execution tile and SIMD level, and with culling on and off.

use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques;
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::{GpuConfig, SimdLevel};

fn picture(scene: &str, technique: &dyn Technique, gpu: GpuConfig, skip: bool) -> Rendered {
    let scene = builtin::build(scene).unwrap();
    let has_skip = technique.params().iter().any(|p| p.name == "skip");
    let set = ["skip=off"].into_iter().filter(|_| has_skip && !skip);
    let settings = RenderSettings {
        size: [96, 64],
        gpu: GpuConfig { skip, ..gpu },
        repeat: 1,
    };
    let params = Params::parse(technique, set).unwrap();
    render(&scene, technique, &params, &settings).unwrap()
}

#[test]
fn the_registry_gives_the_same_bits_everywhere() {
    for technique in techniques::all() {
        for scene in ["demo", "adversarial-eye-in-shadow"] {
            let mut first = None;
            for (turn, simd) in SimdLevel::available().into_iter().enumerate() {
                for (threads, tile) in [(1, 16), (2, 64), (4, 128)] {
                    let gpu = GpuConfig {
                        threads,
                        tile,
                        simd,
                        ..GpuConfig::default()
                    };
                    let done = picture(scene, *technique, gpu, turn % 2 == 0);
                    let hashes = (done.color_hash(), done.visibility_hash());
                    let reference = first.get_or_insert_with(|| hashes.clone());
                    let name = technique.name();
                    assert_eq!(*reference, hashes, "{name}, {scene}, {simd:?}, {tile}");
                }
            }
        }
    }
}
