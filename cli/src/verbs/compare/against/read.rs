//! Files of somebody else.

use std::path::Path;

use gnomon_pipeline::measure::render::SrgbEncoder;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::world::{environment, files};
use gnomon_raster::MAX_TEXTURE_SIZE;
use image::DynamicImage;

use crate::error::CliError;
use crate::output::npy;

/// Bytes of a file that are read at most.
const MOST: u64 = 1 << 30;

const FORMATS: &str = "valid are .npy (height, width) of visibility or (height, width, 3) of linear \
    RGB, .exr of linear RGB, .png of sRGB, and gray .png of visibility";

/// What a file shows.
pub(super) struct Theirs {
    pub(super) size: [u32; 2],
    pub(super) content: Content,
}

/// Rows from the top.
pub(super) enum Content {
    /// 1 fully lit, 0 in shadow, NaN where no surface is seen.
    Visibility(Vec<f32>),
    /// sRGB.
    Picture(Vec<[u8; 3]>),
}

impl Content {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Visibility(_) => "visibility",
            Self::Picture(_) => "picture",
        }
    }
}

fn wrong(path: &Path, problem: impl Into<String>) -> CliError {
    CliError::Results {
        path: path.to_owned(),
        problem: problem.into(),
    }
}

fn bytes(path: &Path) -> Result<Vec<u8>, CliError> {
    files::read(path, MOST).map_err(|e| wrong(path, e.to_string()))
}

/// Reads a visibility or a picture.
pub(super) fn theirs(path: &Path) -> Result<Theirs, CliError> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let read = match extension.to_str() {
        Some("npy") => of_array(&bytes(path)?),
        Some("exr") => of_exr(&bytes(path)?),
        Some("png") => of_png(&bytes(path)?),
        _ => Err(format!("is of no format that is compared; {FORMATS}")),
    };
    let theirs = read.map_err(|problem| wrong(path, problem))?;
    match theirs
        .size
        .iter()
        .all(|s| (1..=MAX_TEXTURE_SIZE).contains(s))
    {
        true => Ok(theirs),
        false => {
            let [w, h] = theirs.size;
            Err(wrong(
                path,
                format!("is {w}x{h}; sides are from 1 to {MAX_TEXTURE_SIZE}"),
            ))
        }
    }
}

/// Reads a truth: visibility as an array.
pub(super) fn truth(path: &Path) -> Result<VisibilityImage, CliError> {
    let array = npy::decode(&bytes(path)?).map_err(|problem| wrong(path, problem))?;
    if array.channels != 1 {
        return Err(wrong(
            path,
            "has channels; a truth is visibility, (height, width)",
        ));
    }
    Ok(VisibilityImage {
        size: array.size,
        values: array.values,
    })
}

fn of_array(bytes: &[u8]) -> Result<Theirs, String> {
    let array = npy::decode(bytes)?;
    let content = match array.channels {
        1 => Content::Visibility(array.values.iter().map(|v| *v as f32).collect()),
        3 | 4 => {
            let texels = array.values.chunks(array.channels);
            encoded(texels.map(|t| [t[0] as f32, t[1] as f32, t[2] as f32]))
        }
        other => return Err(format!("has {other} channels; {FORMATS}")),
    };
    let size = array.size;
    Ok(Theirs { size, content })
}

fn of_exr(bytes: &[u8]) -> Result<Theirs, String> {
    let (size, texels) = environment::decode_exr(bytes)?;
    let content = encoded(texels.into_iter());
    Ok(Theirs { size, content })
}

/// Linear light as the pictures here have it.
fn encoded(texels: impl Iterator<Item = [f32; 3]>) -> Content {
    let encoder = SrgbEncoder::new();
    let encode = |[r, g, b]: [f32; 3]| {
        let [r, g, b, _] = encoder.encode([r, g, b, 1.0]);
        [r, g, b]
    };
    Content::Picture(texels.map(encode).collect())
}

fn of_png(bytes: &[u8]) -> Result<Theirs, String> {
    let mut reader = image::ImageReader::new(std::io::Cursor::new(bytes));
    reader.set_format(image::ImageFormat::Png);
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_TEXTURE_SIZE);
    limits.max_image_height = Some(MAX_TEXTURE_SIZE);
    reader.limits(limits);
    let read = reader.decode().map_err(|e| e.to_string())?;
    let size = [read.width(), read.height()];
    let content = match &read {
        DynamicImage::ImageLuma8(v) => {
            Content::Visibility(v.as_raw().iter().map(|v| f32::from(*v) / 255.0).collect())
        }
        DynamicImage::ImageLuma16(v) => {
            Content::Visibility(v.as_raw().iter().map(|v| f32::from(*v) / 65535.0).collect())
        }
        other => {
            let rgb = other.to_rgb8();
            Content::Picture(rgb.pixels().map(|p| p.0).collect())
        }
    };
    Ok(Theirs { size, content })
}
