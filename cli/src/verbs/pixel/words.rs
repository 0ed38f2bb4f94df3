//! Stored values in words.

use gnomon_raster::{Format, format};

/// A float as short as it can be told exactly; NaN and infinities by name.
pub(crate) fn float(bits: u32) -> String {
    format!("{}", f32::from_bits(bits))
}

/// Raw channels as what they mean: integers, or floats of float formats.
pub(crate) fn stored(f: Format, raw: [u32; 4]) -> String {
    let one = |v: &u32| match f {
        Format::R16Float | Format::Rgba16Float => float(format::f32_from_f16(*v as u16).to_bits()),
        Format::R32Float | Format::Rgba32Float => float(*v),
        Format::R16Sint => (*v as u16 as i16).to_string(),
        _ => v.to_string(),
    };
    let channels: Vec<_> = raw.iter().take(f.channels()).map(one).collect();
    channels.join(" ")
}
