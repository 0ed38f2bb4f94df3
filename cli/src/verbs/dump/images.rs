//! What textures hold, as arrays of what is stored and as pictures.

use std::path::Path;

use gnomon_raster::{Error, Format, Gpu, GpuConfig, Recording, Subresource, Texture};

use crate::error::CliError;
use crate::output::files::Batch;
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
    let [width, height, _] = texture.mip_size(image.mip);
    let format = texture.descriptor().format;
    let array = |aspect: &str, channels, bytes: &[u8]| {
        let kind = if aspect == "-stencil" {
            "|u1"
        } else {
            kind(format)
        };
        let bytes = npy::encode_texels([width, height], kind, channels, bytes);
        (format!("{name}{aspect}.npy"), bytes)
    };
    if !format.is_depth_stencil() {
        let bytes = texture.read_packed(image)?;
        return Ok(vec![array("", format.channels(), &bytes)]);
    }
    let depth = texture.read_depth_bits(image)?;
    let depth: Vec<u8> = depth.iter().flat_map(|d| d.to_le_bytes()).collect();
    let stencil = texture.read_stencil(image)?;
    Ok(vec![
        array("-depth", 1, &depth),
        array("-stencil", 1, &stencil),
    ])
}

/// NumPy's name of what a channel is stored as; depths of 24 bits take 32.
fn kind(format: Format) -> &'static str {
    match format {
        Format::R8Unorm | Format::Rg8Unorm | Format::Rgba8Unorm => "|u1",
        Format::R16Sint => "<i2",
        Format::R16Float | Format::Rgba16Float => "<f2",
        Format::R32Float | Format::Rgba32Float | Format::Depth32FloatStencil8 => "<f4",
        Format::R32Uint | Format::Depth24Stencil8 => "<u4",
    }
}
