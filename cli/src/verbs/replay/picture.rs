//! The picture of a replayed frame.

use gnomon_pipeline::measure::render::SrgbEncoder;
use gnomon_raster::Subresource;
use gnomon_traces::{Replayed, TraceError};

use crate::draw::Picture;
use crate::error::CliError;

/// The result called `color`, encoded as sRGB.
pub(super) fn picture(replayed: &Replayed, frame: usize) -> Result<Picture, CliError> {
    let refused = |source| TraceError::Gpu { frame, source };
    let id = replayed.recording.output("color");
    let id = id.ok_or_else(|| CliError::Flag {
        flag: "--out",
        value: format!("frame {frame}"),
        valid: "the frame has no result called `color` that could be shown".to_owned(),
    })?;
    let texture = replayed.gpu.texture(id).map_err(refused)?;
    let image = Subresource::default();
    let texels = texture.read_color(image).map_err(refused)?;
    let [width, height, _] = texture.mip_size(0);
    let encoder = SrgbEncoder::new();
    let pixels = texels.iter().map(|t| {
        let [r, g, b, _] = encoder.encode(t.0);
        [r, g, b, 255]
    });
    Ok(Picture {
        size: [width, height],
        pixels: pixels.collect(),
    })
}
