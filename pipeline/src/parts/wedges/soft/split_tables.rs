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

#[cfg(test)]
mod tests {
    use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader, FragmentStage};
    use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
    use gnomon_raster::{
        CommandList, F32, Gpu, GpuConfig, I32, Lanes, LoadOp, RenderPass, RenderPipeline,
    };
    use gnomon_shaders::split_volumes::{angle_texel, area_texel};
    use gnomon_shaders::transform::FullScreen;

    use super::*;
    use crate::parts::visibility::{attachment, binding, full_screen};

    const SIDE: u32 = 256;

    /// A direction for each pixel, on the square -1..1 but for its middle.
    fn direction(column: f64, row: f64) -> [f64; 2] {
        [column, row].map(|v| (2.0 * v + 1.0) / f64::from(SIDE) - 1.0)
    }

    /// The stored angle of the pixel's direction, and the area between that and a right
    /// angle: the penumbra shader's own look-ups.
    struct LookUp;

    impl FragmentShader for LookUp {
        fn outputs(&self) -> FragmentOutputs {
            FragmentOutputs {
                textures: 2,
                ..FragmentOutputs::default()
            }
        }

        #[inline(always)]
        fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
            let scale = 2.0 / SIDE as f32;
            let place = |k: I32<L>| k.to_f32() * scale + (0.5 * scale - 1.0);
            let towards = [place(f.column()), place(f.row())];
            let [angle, ..] = f.fetch_texel(0, angle_texel(l, towards), 0);
            let right = F32::splat(l, 0.5 * HALF_TURN);
            let [area, ..] = f.fetch_texel(1, area_texel(l, [angle, right]), 0);
            f.set_color(0, [angle, area, area, area]);
        }
    }

    fn looked_up(image: Image) -> Vec<[f64; 2]> {
        let mut recording = Recording::default();
        let [angles, areas, _] = create(image, &mut recording).unwrap();
        let desc = TextureDescriptor::d2("out", Format::Rgba32Float, SIDE, SIDE);
        let out = recording.create(&desc).unwrap();
        let pipeline = RenderPipeline {
            label: "look up".into(),
            vertex: FullScreen.stage(),
            fragment: Some(FragmentStage::from(LookUp)),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        let pass = RenderPass {
            label: "look up".into(),
            color: vec![attachment(out, LoadOp::DontCare)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, [angles, areas].map(binding).to_vec())],
        };
        recording.list = CommandList { passes: vec![pass] };
        let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
        gpu.load(&recording).unwrap();
        gpu.submit(&recording.list).unwrap();
        let texels = gpu.texture(out).unwrap();
        let texels = texels.read_color(Subresource::default()).unwrap();
        let value = |t: &gnomon_raster::texture::ColorTexel| [t.0[0], t.0[1]].map(f64::from);
        texels.iter().map(value).collect()
    }

    /// Entries of the map that splits are the nearest whole numbers, three bits a channel.
    #[test]
    fn the_map_that_splits_holds_the_nearest_whole_numbers() {
        let mut recording = Recording::default();
        let [_, _, split] = create(Image::Square, &mut recording).unwrap();
        let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
        gpu.load(&recording).unwrap();
        let texels = gpu.texture(split).unwrap();
        let texels = texels.read_color(Subresource::default()).unwrap();
        assert_eq!(texels.len(), SPLIT_ENTRIES as usize);
        for (k, texel) in texels.iter().enumerate() {
            let bits = texel.0.map(|c| (c * 255.0).round() as u32);
            assert!(bits.iter().all(|b| *b < 8), "{k}: {bits:?}");
            let value = bits[0] | bits[1] << 3 | bits[2] << 6 | bits[3] << 9;
            let exact = f64::from(FULL) * k as f64 / f64::from(SPLIT_ENTRIES - 1);
            assert!((f64::from(value) - exact).abs() <= 0.5, "{k}: {value}");
        }
    }

    /// Half a texel of a face is at most 1/128 in the tangent: no angle is off by more, and
    /// a map or a shader that is one texel off would be, nearly everywhere.
    #[test]
    fn angles_are_those_of_the_nearest_texel() {
        for (at, [angle, _]) in looked_up(Image::Disc).into_iter().enumerate() {
            let (column, row) = (at as u32 % SIDE, at as u32 / SIDE);
            let [x, y] = direction(f64::from(column), f64::from(row));
            let off = angle / f64::from(HALF_TURN) * PI - libm::atan2(y, x);
            let off = off - 2.0 * PI * (off / (2.0 * PI)).round();
            let limit = 1.0 / f64::from(ANGLE_SIDE) + PI / f64::from(HALF_TURN);
            assert!(off.abs() <= limit, "{x} {y}: {off}");
        }
    }

    /// Areas between an angle of the map and the nearest to a right one, rounded to 8 bits
    /// or a half: half a step of the map of areas for each of the two, and half a texel.
    #[test]
    fn areas_are_those_between_the_nearest_angles() {
        for image in [Image::Disc, Image::Square] {
            for [angle, area] in looked_up(image) {
                let angle = angle / f64::from(HALF_TURN) * PI;
                let want = share_between(image, angle, 0.5 * PI);
                // A step is 2 pi / 255; a square's share grows by at most 1/4 a radian.
                let limit = 2.0 * 0.25 * PI / 255.0 + 1.0 / 1020.0 + 1e-4;
                let off = (0.5 * area - want).abs();
                let wraps = want > 0.5 - limit; // half a turn may be taken either way
                assert!(off <= limit || wraps, "{image:?} {angle}: {off}");
            }
        }
    }
}
