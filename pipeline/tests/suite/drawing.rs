//! Frames of scenes by techniques' names and settings, as the suites ask for them.

use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::Params;
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
    let params = Params::parse(technique, set).unwrap();
    let repeat = 1;
    let settings = RenderSettings { size, gpu, repeat };
    render(scene, technique, &params, &settings).unwrap()
}
