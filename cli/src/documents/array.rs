//! How texels are stored, as NumPy says it.

use gnomon_raster::Format;

/// NumPy's name of what a channel is stored as.
pub fn numpy_type(format: Format) -> &'static str {
    match format {
        Format::R8Unorm | Format::Rg8Unorm | Format::Rgba8Unorm => "|u1",
        Format::R16Sint => "<i2",
        Format::R16Float | Format::Rgba16Float => "<f2",
        Format::R32Float | Format::Rgba32Float | Format::Depth32FloatStencil8 => "<f4",
        Format::R32Uint | Format::Depth24Stencil8 => "<u4",
    }
}
