//! The look-up textures of paper IV (§4.2 and §4.3): angles, areas, and three bits
//! a channel.

use std::f64::consts::PI;

use glam::DVec2;
use gnomon_raster::{
    Format, Recording, Subresource, TextureDescriptor, TextureDimension, TextureId,
};
use gnomon_shaders::coverage::Image;
use gnomon_shaders::split_volumes::{ANGLE_SIDE, AREA_SIDE, FULL, HALF_TURN, SPLIT_ENTRIES};

use super::table::polygon_image;
use crate::technique::TechniqueError;

/// All three textures, in the order of the shader's slots 1 to 3.
pub(crate) fn create(
    image: Image,
    recording: &mut Recording,
) -> Result<[TextureId; 3], TechniqueError> {
    Ok([
        angles(recording)?,
        areas(image, recording)?,
        split(recording)?,
    ])
}

/// `atan2(y, x)` of the direction through each texel of a cube, in 16 bits:
/// 6 faces of 128^2, 196,608 bytes.
fn angles(recording: &mut Recording) -> Result<TextureId, TechniqueError> {
    let texture = recording.create(&TextureDescriptor {
        label: "angles".to_owned(),
        dimension: TextureDimension::Cube,
        format: Format::R16Sint,
        size: [ANGLE_SIDE, ANGLE_SIDE, 1],
        mip_levels: 1,
    })?;
    let at = |k: u32| (2.0 * f64::from(k) + 1.0) / f64::from(ANGLE_SIDE) - 1.0;
    for face in 0..6 {
        let texel = |column: u32, row: u32| {
            let (s, t) = (at(column), at(row));
            // Vulkan's faces: x and y of the direction.
            let (x, y) = match face {
                0 => (1.0, -t),
                1 => (-1.0, -t),
                2 => (s, 1.0),
                3 => (s, -1.0),
                4 => (s, -t),
                _ => (-s, -t),
            };
            let stored = (libm::atan2(y, x) / PI * f64::from(HALF_TURN)).round_ties_even();
            [stored as f32, 0.0, 0.0, 1.0]
        };
        let rows = (0..ANGLE_SIDE).flat_map(|row| (0..ANGLE_SIDE).map(move |c| (c, row)));
        let texels: Vec<[f32; 4]> = rows.map(|(c, row)| texel(c, row)).collect();
        let image = Subresource {
            mip: 0,
            layer: face,
        };
        recording.write(texture, image, &texels)?;
    }
    Ok(texture)
}

/// Twice the share of the light between the rays at two angles, on the side where
/// they are less than half a turn apart. 16 bits (a half float) for discs, 8 for
/// squares and polygons.
fn areas(image: Image, recording: &mut Recording) -> Result<TextureId, TechniqueError> {
    let format = match image {
        Image::Square | Image::Polygon(_) => Format::R8Unorm,
        Image::Disc => Format::R16Float,
    };
    let desc = TextureDescriptor::d2("areas", format, AREA_SIDE, AREA_SIDE);
    let texture = recording.create(&desc)?;
    let angle = |k: u32| (2.0 * f64::from(k) / (f64::from(AREA_SIDE) - 1.0) - 1.0) * PI;
    let rows = (0..AREA_SIDE).flat_map(|row| (0..AREA_SIDE).map(move |c| (c, row)));
    let texel = |(c, row): (u32, u32)| {
        let share = share_between(image, angle(c), angle(row));
        [2.0 * share as f32, 0.0, 0.0, 1.0]
    };
    let texels: Vec<[f32; 4]> = rows.map(texel).collect();
    recording.write(texture, Subresource::default(), &texels)?;
    Ok(texture)
}

fn share_between(image: Image, from: f64, to: f64) -> f64 {
    let turn = (to - from).abs();
    let turn = turn.min(2.0 * PI - turn);
    let ray = |a: f64| DVec2::new(libm::cos(a), libm::sin(a));
    match image {
        Image::Disc => turn / (2.0 * PI),
        Image::Square => crate::geometry::coverage::square_share(ray(from), ray(to)),
        Image::Polygon(outline) => {
            let polygon = polygon_image(&outline);
            polygon.sector(ray(from), ray(to)) / polygon.area()
        }
    }
}

/// Bits of `round(4095 k / 1023)` three by three: 1024 texels, 4,096 bytes.
fn split(recording: &mut Recording) -> Result<TextureId, TechniqueError> {
    let desc = TextureDescriptor::d2("split", Format::Rgba8Unorm, SPLIT_ENTRIES, 1);
    let texture = recording.create(&desc)?;
    let last = f64::from(SPLIT_ENTRIES - 1);
    let texel = |k: u32| {
        let v = (f64::from(FULL) * f64::from(k) / last).round_ties_even() as u32;
        [0, 3, 6, 9].map(|shift| (v >> shift & 7) as f32 / 255.0)
    };
    let texels: Vec<[f32; 4]> = (0..SPLIT_ENTRIES).map(texel).collect();
    recording.write(texture, Subresource::default(), &texels)?;
    Ok(texture)
}
