//! Frames of scenes by techniques' names and settings, as the suites ask for them: in the
//! papers' form, where `set` does not say otherwise, since suites hold techniques against
//! their papers. What defaults add has suites of its own (`horizon`, `environment`).

use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::GpuConfig;

/// One frame; what is refused is a fault of the test.
pub(crate) fn drawn(scene: &Scene, technique: &str, set: &[&str], size: [u32; 2]) -> Rendered {
    drawn_on(scene, technique, set, size, GpuConfig::default())
}

/// The same, executed as `gpu` says.
pub(crate) fn drawn_on(
    scene: &Scene,
    technique: &str,
    set: &[&str],
    size: [u32; 2],
    gpu: GpuConfig,
) -> Rendered {
    let technique = find(technique).unwrap();
    let params = Params::parse(technique, as_published(technique).iter().chain(set)).unwrap();
    let repeat = 1;
    let settings = RenderSettings { size, gpu, repeat };
    render(scene, technique, &params, &settings).unwrap()
}

/// Settings that take back what defaults add to the papers' forms.
pub(crate) fn as_published(technique: &dyn Technique) -> Vec<&'static str> {
    let added = [
        ("horizon", "horizon=off"),
        ("grazing", "grazing=bands"),
        ("plane-offset", "plane-offset=0"),
        ("mip-sharper", "mip-sharper=0.8"),
    ];
    let has = |name: &str| technique.params().iter().any(|p| p.name == name);
    let mut set: Vec<_> = added
        .iter()
        .filter(|(n, _)| has(n))
        .map(|(_, s)| *s)
        .collect();
    if ["pcss", "convolution-soft-shadows"].contains(&technique.name()) {
        set.push("map-size=512");
    }
    set
}

/// One frame by defaults, where `set` does not say otherwise.
pub(crate) fn drawn_by_default(
    scene: &Scene,
    technique: &str,
    set: &[&str],
    size: [u32; 2],
    gpu: GpuConfig,
) -> Rendered {
    let technique = find(technique).unwrap();
    let params = Params::parse(technique, set).unwrap();
    let repeat = 1;
    let settings = RenderSettings { size, gpu, repeat };
    render(scene, technique, &params, &settings).unwrap()
}
