//! What textures hold, as arrays of what is stored and as pictures.

use std::path::Path;

use gnomon_raster::{Error, Gpu, GpuConfig, Recording, Subresource, Texture};

use crate::error::CliError;
use crate::output::files::Batch;
use crate::output::textures::Aspect;
use crate::output::{npy, png, textures};

/// When textures are looked at.
#[derive(Clone, Copy)]
enum Moment {
    First,
    Last,
}

/// A file's name and its bytes.
type Named = (String, Vec<u8>);

/// All images of all textures of a frame, before its first pass and behind its last.
pub(super) fn draw(recording: &Recording) -> Result<Vec<Named>, Error> {
    let mut gpu = Gpu::new(GpuConfig::default())?;
    gpu.load(recording)?;
    let mut files = every_image(&gpu, Moment::First)?;
    gpu.submit(&recording.list)?;
    files.extend(every_image(&gpu, Moment::Last)?);
    Ok(files)
}

/// Puts `files` into `folder`.
pub(super) fn stage(files: &[Named], folder: &Path, batch: &mut Batch) -> Result<(), CliError> {
    for (name, bytes) in files {
        batch.stage(&folder.join(name), bytes)?;
    }
    Ok(())
}

fn every_image(gpu: &Gpu, moment: Moment) -> Result<Vec<Named>, Error> {
    let mut files = Vec::new();
    for id in gpu.texture_ids() {
        let texture = gpu.texture(id)?;
        for image in texture.descriptor().images() {
            let name = name(id.index(), image, moment);
            files.extend(arrays(texture, image, &name)?);
            if !texture.descriptor().format.is_depth_stencil() {
                files.push((
                    format!("{name}.png"),
                    png::encode(&textures::picture(texture, image)?),
                ));
            }
        }
    }
    Ok(files)
}

fn name(texture: usize, image: Subresource, moment: Moment) -> String {
    let moment = match moment {
        Moment::First => "first",
        Moment::Last => "last",
    };
    let (mip, layer) = (image.mip, image.layer);
    format!("texture-{texture}-mip-{mip}-layer-{layer}-{moment}")
}

/// Depth and stencil are an array each.
fn arrays(texture: &Texture, image: Subresource, name: &str) -> Result<Vec<Named>, Error> {
    let aspects: &[Aspect] = match texture.descriptor().format.is_depth_stencil() {
        true => &[Aspect::Depth, Aspect::Stencil],
        false => &[Aspect::Color],
    };
    let array = |aspect: &Aspect| {
        let array = textures::array(texture, image, *aspect)?;
        let suffix = match aspect {
            Aspect::Color => String::new(),
            _ => format!("-{}", aspect.name()),
        };
        let bytes = npy::encode_texels(array.size, array.kind, array.channels, &array.bytes);
        Ok((format!("{name}{suffix}.npy"), bytes))
    };
    aspects.iter().map(array).collect()
}
