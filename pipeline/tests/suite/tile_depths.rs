//! What modelled tiles of paper II know: the depths of their surfaces, exactly; and wedges of
//! more tiles than an atlas of classes holds.

use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::{Gpu, GpuConfig, Subresource};

const TECHNIQUE: &str = "penumbra-wedges-restructured";

/// Textures of these names after a frame, each red in rows, and how many passes have the
/// label `pass`.
fn red_of<const N: usize>(
    scene: &Scene,
    size: [u32; 2],
    set: &[&str],
    names: [&str; N],
    pass: &str,
) -> ([Vec<f32>; N], usize) {
    let technique = find(TECHNIQUE).unwrap();
    let params = Params::parse(technique, set).unwrap();
    let frame = technique.frame(scene, size, &params).unwrap();
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    gpu.load(&frame.recording).unwrap();
    gpu.submit(&frame.recording.list).unwrap();
    let ids = || gpu.texture_ids().map(|id| gpu.texture(id).unwrap());
    let values = names.map(|name| {
        let texture = ids().find(|t| t.descriptor().label == name).unwrap();
        let texels = texture.read_color(Subresource::default()).unwrap();
        texels.iter().map(|t| t.0[0]).collect()
    });
    let passes = frame.recording.list.passes.iter();
    (values, passes.filter(|p| p.label == pass).count())
}

/// Sky, which has no surface, stretches no tile; tiles at the border end with the image.
#[test]
fn depths_of_tiles_are_those_of_their_surfaces() {
    let scene = builtin::build("columns").unwrap();
    let size = [90, 61];
    for tile in [4u32, 8, 32] {
        let set = format!("tile={tile}");
        let names = ["depth copy", "zmax", "zmin"];
        let ([depth, zmax, zmin], _) = red_of(&scene, size, &[&set], names, "");
        let [across, down] = size.map(|s| s.div_ceil(tile));
        let (mut empty, mut mixed) = (0, 0);
        for (k, (most, least)) in zmax.iter().zip(&zmin).enumerate() {
            let (column, row) = (k as u32 % across, k as u32 / across);
            let rows = (row * tile..size[1].min((row + 1) * tile)).flat_map(|y| {
                (column * tile..size[0].min((column + 1) * tile)).map(move |x| (x, y))
            });
            let all: Vec<f32> = rows
                .map(|(x, y)| depth[(y * size[0] + x) as usize])
                .collect();
            let surfaces = || all.iter().copied().filter(|d| *d < 1.0);
            let expected = surfaces().fold([-1.0f32, 2.0], |[h, l], d| [h.max(d), l.min(d)]);
            assert_eq!([*most, *least], expected, "tile {column} {row} of {tile}");
            empty += u32::from(surfaces().next().is_none());
            mixed += u32::from(surfaces().count() != all.len() && surfaces().next().is_some());
        }
        assert_eq!(zmax.len() as u32, across * down);
        assert!(
            mixed > 0 && (empty > 0 || tile > 8),
            "{tile}: {empty} {mixed}"
        );
    }
}

/// Ten thousand wedges on few pixels: their classes take several turns in the atlas.
#[test]
fn wedges_of_several_atlases_add_up() {
    let scene = builtin::build("wireframe").unwrap();
    let size = [48, 32];
    let name = ["light intensity"];
    let ([culled], passes) = red_of(&scene, size, &["culling=zminmax"], name, "tile classes");
    let ([all], none) = red_of(&scene, size, &["culling=none"], name, "tile classes");
    assert!(passes > 1 && none == 0, "{passes} {none}");
    assert!(culled == all, "classes of tiles change the buffer");
    assert!(all.iter().any(|v| *v < 255.0));
}
