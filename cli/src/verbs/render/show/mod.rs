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

/// The file that `request` asks for, of a frame that is drawn afresh.
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
        Kind::Exr => {
            let format = texture.descriptor().format;
            if !textures::fits_floats(format) {
                let valid = format!("{format:?} has integers that no float holds: use .npy");
                return Err(refuse(request, valid));
            }
            textures::exr(&textures::values(texture, image, found.aspect)?)
        }
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
