//! Numbers for shaders, in textures.

use gnomon_raster::{
    Format, MAX_TEXTURE_SIZE, Recording, Subresource, TextureDescriptor, TextureId,
};
use gnomon_shaders::shadow_rays::Table;

use crate::technique::TechniqueError;

/// A texture of these texels in rows, at least one.
///
/// # Errors
/// The GPU refuses it.
pub(crate) fn table(
    label: &str,
    mut texels: Vec<[f32; 4]>,
    recording: &mut Recording,
) -> Result<(TextureId, Table), TechniqueError> {
    let side = (texels.len().max(1) as f64).sqrt() as u64 + 1;
    let width = side.next_power_of_two().min(u64::from(MAX_TEXTURE_SIZE)) as usize;
    let height = texels.len().div_ceil(width).max(1);
    texels.resize(width * height, [0.0; 4]);
    let texture = image(label, [width as u32, height as u32], &texels, recording)?;
    let log_width = width.ilog2();
    Ok((texture, Table { log_width }))
}

/// A texture of these texels, rows from the top.
///
/// # Errors
/// The GPU refuses it.
pub(crate) fn image(
    label: &str,
    [width, height]: [u32; 2],
    texels: &[[f32; 4]],
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let desc = TextureDescriptor::d2(label, Format::Rgba32Float, width, height);
    let texture = recording.create(&desc)?;
    recording.write(texture, Subresource::default(), texels)?;
    Ok(texture)
}
