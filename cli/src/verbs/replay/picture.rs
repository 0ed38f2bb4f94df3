//! The picture of a replayed frame.

use gnomon_raster::Subresource;
use gnomon_traces::Replayed;

use crate::draw::Picture;
use crate::error::CliError;
use crate::output::textures;

/// The result called `color`.
pub(super) fn picture(replayed: &Replayed, frame: usize) -> Result<Picture, CliError> {
    let id = replayed.recording.output("color");
    let id = id.ok_or_else(|| CliError::Flag {
        flag: "--out",
        value: format!("frame {frame}"),
        valid: "the frame has no result called `color` that could be shown".to_owned(),
    })?;
    let texture = replayed.gpu.texture(id)?;
    Ok(textures::picture(texture, Subresource::default())?)
}
