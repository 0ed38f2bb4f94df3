//! Which change of state makes a pixel differ: that of the second frame is put into the
//! first, part by part.

use gnomon_raster::{Error, Format, Gpu, GpuConfig, Recording, Subresource, TextureId};

use super::facet::FACETS;
use super::image::{Aspect, Image};
use super::minimise::minimise;
use super::mixture::Mixture;
use super::state::{Place, StateDifference};
use crate::run::draw;

/// Which differences may be the cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suspects {
    /// All state, shaders included.
    State,
    /// Shaders and their uniforms only.
    Shaders,
}

/// The smallest set of differences that makes a pixel of the first frame what it is in the
/// second.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// The pixel that was looked at.
    pub pixel: DifferingPixel,
    /// What has to change, all of it.
    pub differences: Vec<StateDifference>,
    /// How many differences there are in all.
    pub of: usize,
    /// How often a frame was drawn to find them.
    pub replays: usize,
}

/// A pixel that differs when both frames are done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DifferingPixel {
    /// The texture's label.
    pub label: String,
    /// The texture's format.
    pub format: Format,
    /// `color`, `depth` or `stencil`.
    pub aspect: &'static str,
    /// Column and row.
    pub pixel: [u32; 2],
    /// What it is in both frames, raw.
    pub values: [[u32; 4]; 2],
    texture: TextureId,
    image: Subresource,
    looked_at: Aspect,
}

/// Why no cause is found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BisectError {
    /// Nothing differs when both frames are done.
    #[error("both frames end with the same bits in every texture")]
    Equal,
    /// The frames do not have the same textures.
    #[error("the frames have other textures ({0}): no state of one can be put into the other")]
    Unlike(String),
    /// What is suspected does not make the difference.
    #[error(
        "the {suspected} differences that are suspected do not make the pixel what it is in the second frame"
    )]
    NotGuilty {
        /// How many.
        suspected: usize,
    },
    /// The GPU refuses one of the frames.
    #[error("{0}")]
    Gpu(#[from] Error),
}

/// Finds which of `suspects` makes the first pixel that differs differ.
///
/// # Errors
/// The frames end equal, have other textures, or the suspects are not the cause.
pub fn bisect(
    a: &Recording,
    b: &Recording,
    suspects: Suspects,
    config: GpuConfig,
) -> Result<Cause, BisectError> {
    let mixture = Mixture::of(a, b);
    check_textures(&mixture.differences)?;
    let mut trials = Trials { config, count: 2 };
    let pixel = first_differing_pixel(&trials.run(a)?, &trials.run(b)?)?;
    let suspected: Vec<usize> = (0..mixture.differences.len())
        .filter(|i| suspects.include(&mixture.differences[*i]))
        .collect();
    let mut makes_it = |part: &[usize]| trials.gives(&mixture, part, &pixel);
    if !makes_it(&suspected)? {
        return Err(BisectError::NotGuilty {
            suspected: suspected.len(),
        });
    }
    let found = minimise(&suspected, makes_it)?;
    Ok(Cause {
        pixel,
        differences: found
            .iter()
            .map(|i| mixture.differences[*i].clone())
            .collect(),
        of: mixture.differences.len(),
        replays: trials.count,
    })
}

impl Suspects {
    fn include(self, difference: &StateDifference) -> bool {
        let is_shader = FACETS
            .iter()
            .any(|f| f.shader && f.name == difference.field);
        self == Self::State || is_shader
    }
}

fn check_textures(differences: &[StateDifference]) -> Result<(), BisectError> {
    let unlike = differences.iter().find(|d| d.field == "descriptor");
    match unlike {
        Some(StateDifference {
            place: Place::Texture { id, label },
            ..
        }) => Err(BisectError::Unlike(format!("texture {id} `{label}`"))),
        _ => Ok(()),
    }
}

/// Frames that were drawn, and how many.
struct Trials {
    config: GpuConfig,
    count: usize,
}

impl Trials {
    fn run(&self, frame: &Recording) -> Result<Gpu, Error> {
        draw(frame, &frame.list, self.config).map(|(gpu, _)| gpu)
    }

    /// Whether the first frame with `part` of the second has the second's value in `pixel`.
    /// A mixture that the GPU refuses has not.
    fn gives(
        &mut self,
        mixture: &Mixture<'_>,
        part: &[usize],
        pixel: &DifferingPixel,
    ) -> Result<bool, BisectError> {
        self.count += 1;
        let mixed = mixture.with(part)?;
        let Ok(gpu) = self.run(&mixed) else {
            return Ok(false);
        };
        let image = Image::read(&gpu, pixel.texture, pixel.image, pixel.looked_at)?;
        Ok(image.at(pixel.pixel) == pixel.values[1])
    }
}

/// The first pixel that differs between two frames that are done, colour first.
fn first_differing_pixel(a: &Gpu, b: &Gpu) -> Result<DifferingPixel, BisectError> {
    for aspect in [Aspect::Color, Aspect::Depth, Aspect::Stencil] {
        for id in a.texture_ids() {
            let descriptor = a.texture(id)?.descriptor();
            if descriptor.format.is_depth_stencil() == (aspect == Aspect::Color) {
                continue;
            }
            for image in descriptor.images() {
                let [a, b] = [
                    Image::read(a, id, image, aspect)?,
                    Image::read(b, id, image, aspect)?,
                ];
                if let Some((pixel, values)) = a.differing(&b).next() {
                    return Ok(DifferingPixel {
                        label: descriptor.label.clone(),
                        format: descriptor.format,
                        aspect: aspect.name(),
                        pixel,
                        values,
                        texture: id,
                        image,
                        looked_at: aspect,
                    });
                }
            }
        }
    }
    Err(BisectError::Equal)
}
