//! `gnomon render --show`: what an attachment or a texture holds at any moment of a frame.

mod find;
mod picture;
mod request;

use gnomon_raster::{GpuConfig, Recording};
use gnomon_traces::draw_until;

use crate::error::CliError;
use crate::output::textures::{self, Aspect};
use crate::output::{npy, png};
use find::Found;
pub(crate) use request::ShowRequest;
use request::{Kind, refuse};

/// Whether `request` asks for something that the frame has, and the file can hold.
pub(super) fn check_show(recording: &Recording, request: &ShowRequest) -> Result<(), CliError> {
    let found = Found::new(recording, request)?;
    let format = recording.textures()[found.texture].descriptor().format;
    match request.kind() {
        Kind::Exr if !textures::fits_floats(format) => {
            let valid = format!("{format:?} has integers that no float holds: use .npy");
            Err(refuse(request, valid))
        }
        _ => Ok(()),
    }
}

/// The file that `request` asks for, which has been checked, of a frame that is drawn afresh.
pub(super) fn show(
    recording: &Recording,
    request: &ShowRequest,
    config: GpuConfig,
) -> Result<Vec<u8>, CliError> {
    let found = Found::new(recording, request)?;
    let gpu = draw_until(recording, found.until, config)?;
    let id = gpu.texture_ids().nth(found.texture);
    let texture = gpu.texture(id.expect("the frame's textures are the GPU's"))?;
    let image = found.image;
    Ok(match request.kind() {
        Kind::Npy => {
            let array = textures::array(texture, image, found.aspect)?;
            npy::encode_texels(array.size, array.kind, array.channels, &array.bytes)
        }
        Kind::Exr => textures::exr(&textures::values(texture, image, found.aspect)?),
        Kind::Png => {
            let values = textures::values(texture, image, found.aspect)?;
            png::check_room(values.size)?;
            png::encode(&match (found.aspect, values.channels) {
                (Aspect::Color, 3..) => {
                    picture::colors(textures::picture(texture, image)?, &values, &found.title)
                }
                _ => picture::scalars(&values, &found.title),
            })
        }
    })
}
