//! Heat for overlays: every technique, at sizes that no tile or light view has and at
//! one that light views have.

use gnomon_pipeline::measure::heat::{self, BlockBytes, Heat, PassHeat};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::{self, find};
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::Counters;

fn measured(technique: &dyn Technique, set: &[&str], size: [u32; 2]) -> (Heat, Rendered) {
    let scene = builtin::build("parallel-plates").unwrap();
    let params = Params::parse(technique, set.iter().copied()).unwrap();
    let settings = RenderSettings {
        size,
        ..RenderSettings::default()
    };
    (
        heat::record(&scene, technique, &params, &settings).unwrap(),
        render(&scene, technique, &params, &settings).unwrap(),
    )
}

/// Fragments and bytes by client, as the GPU counts them.
fn counted(totals: &Counters) -> (u64, BlockBytes) {
    let traffic = &totals.traffic;
    let bytes = BlockBytes {
        z: traffic.z.bytes(),
        stencil: traffic.stencil.bytes(),
        color: traffic.color.iter().map(|c| c.bytes()).sum(),
        hiz: traffic.hiz.bytes(),
    };
    (totals.fragments.generated, bytes)
}

fn summed(pass: &PassHeat) -> (u64, BlockBytes) {
    let of = |client: fn(&BlockBytes) -> u64| pass.bytes.iter().map(client).sum();
    let bytes = BlockBytes {
        z: of(|b| b.z),
        stencil: of(|b| b.stencil),
        color: of(|b| b.color),
        hiz: of(|b| b.hiz),
    };
    (pass.overdraw.iter().map(|n| u64::from(*n)).sum(), bytes)
}

/// Every pass is either on the screen or elsewhere, and adds up to its counters.
fn assert_adds_up(heat: &Heat, drawn: &Rendered, what: &str) {
    let mut on_screen = heat.passes.iter();
    for (number, pass) in drawn.report.passes.iter().enumerate() {
        let (label, found) = match heat.elsewhere.iter().find(|p| p.number == number) {
            Some(work) => (&work.label, (work.fragments, work.bytes)),
            None => {
                let heat = on_screen.next().unwrap();
                (&heat.label, summed(heat))
            }
        };
        assert_eq!(label, &pass.label, "{what}");
        assert_eq!(found, counted(&pass.totals()), "{what}: {label}");
    }
    assert!(on_screen.next().is_none(), "{what}");
}

fn labels(heat: &Heat) -> [Vec<&str>; 2] {
    let on_screen = heat.passes.iter().map(|p| p.label.as_str());
    let elsewhere = heat.elsewhere.iter().map(|p| p.label.as_str());
    [on_screen.collect(), elsewhere.collect()]
}

#[test]
fn every_technique_adds_up_to_its_counters_at_odd_sizes() {
    for technique in techniques::all() {
        for size in [[1, 1], [7, 5], [65, 33], [100, 76]] {
            let (heat, drawn) = measured(*technique, &[], size);
            assert_adds_up(&heat, &drawn, &format!("{} {size:?}", technique.name()));
            assert_eq!(heat.blocks, size.map(|s: u32| s.div_ceil(8)));
        }
    }
}

/// Light views, their filters and tables with a texel for each tile are no places of
/// the picture, not even where they have its size; everything else is.
#[test]
fn passes_onto_other_images_are_told_apart_by_what_they_draw_on() {
    let of = |name: &str, set: &[&str], size| measured(find(name).unwrap(), set, size).0;
    let same_size = of("shadow-map", &["map-size=64"], [64, 64]);
    assert_eq!(labels(&same_size)[1], ["light view"]);
    let large = of("shadow-map", &[], [40, 24]);
    assert_eq!(labels(&large), labels(&same_size));
    let tiles = of("penumbra-wedges-restructured", &["culling=zmax"], [64, 48]);
    assert_eq!(labels(&tiles)[1], ["tile depths", "tile classes"]);
    for volumes in [
        "unshadowed",
        "shadow-volumes",
        "soft-shadow-volumes-optimised",
    ] {
        let heat = of(volumes, &[], [64, 48]);
        assert!(heat.elsewhere.is_empty(), "{:?}", labels(&heat));
    }
}
