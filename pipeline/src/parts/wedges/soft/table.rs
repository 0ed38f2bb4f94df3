//! Coverage of a light for edges between any two of its points: the contents of
//! the four-dimensional texture of paper III (§3.2.3).

use glam::{DVec2, DVec3};
use gnomon_raster::{Format, Recording, Subresource, TextureDescriptor, TextureId};
use gnomon_shaders::coverage::Image;
use gnomon_shaders::coverage_table::CoverageTable;

use super::light_image::LightImage;
use crate::geometry::coverage::LightPlane;
use crate::technique::TechniqueError;

/// What the light looks like.
pub(crate) enum Contents {
    /// One colour, of either shape: 8 bits.
    Plain(Image),
    /// An image on a rectangle: three half floats and one unused, since a colour in
    /// one part of the light can be covered altogether.
    Coloured(LightImage),
}

/// Makes the texture.
pub(crate) fn create(
    table: &CoverageTable,
    contents: &Contents,
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let side = table.size * table.size;
    let format = match contents {
        Contents::Plain(_) => Format::R8Unorm,
        Contents::Coloured(_) => Format::Rgba16Float,
    };
    let desc = TextureDescriptor::d2("coverage", format, side, side);
    let texture = recording.create(&desc)?;
    recording.write(texture, Subresource::default(), &entries(table, contents))?;
    Ok(texture)
}

/// Twice the covered share, in the order of the texture's rows.
fn entries(table: &CoverageTable, contents: &Contents) -> Vec<[f32; 4]> {
    let n = table.size;
    let at = |i: u32| table.coordinate(i);
    let points: Vec<f64> = (0..n).map(at).collect();
    let mut texels = Vec::with_capacity((n * n * n * n) as usize);
    for row in 0..n * n {
        for column in 0..n * n {
            let p = DVec2::new(points[(column % n) as usize], points[(row % n) as usize]);
            let q = DVec2::new(points[(column / n) as usize], points[(row / n) as usize]);
            let [r, g, b] = match contents {
                Contents::Plain(image) => [covered(*image, p, q), 0.0, 0.0],
                Contents::Coloured(image) => image.covered(p, q),
            };
            texels.push([2.0 * r as f32, 2.0 * g as f32, 2.0 * b as f32, 1.0]);
        }
    }
    texels
}

/// Covered share of a light for an edge between two points of its plane, in units
/// of half its size.
fn covered(image: Image, p: DVec2, q: DVec2) -> f64 {
    let light = match image {
        Image::Square => LightPlane::Rectangle {
            centre: DVec3::ZERO,
            half_edges: [DVec3::X, DVec3::Y],
        },
        Image::Disc => LightPlane::Disc {
            centre: DVec3::ZERO,
            normal: DVec3::Z,
            radius: 1.0,
        },
    };
    // An edge in the light's plane is its own image, whatever the receiver.
    let projection = light.seen_from(DVec3::Z);
    projection.map_or(0.0, |s| s.coverage([p.extend(0.0), q.extend(0.0)]))
}
