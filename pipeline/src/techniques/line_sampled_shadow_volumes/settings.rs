//! What parameters decide.

use crate::geometry::line_sampling::light::ANGLE;
use crate::parts::casters::{OPEN_CASTERS, SKIP};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::volumes::stencil_ranges::OVERFLOW;
use crate::parts::volumes::volume_draws::{METHOD, VolumeSettings};
use crate::parts::wedges::soft::covering::{FRAME, LIGHT_IMAGE, sequence};
use crate::technique::{Condition, LightFact, Param, ParamInfo, Params, TechniqueError};
use crate::world::light_image::{LightImage, LightMoment, LightSequence};

const EXTENDED: Condition = Condition::Lights(LightFact::Extended);

const LINES: Param<u32> = Param::<u32>::whole(
    "lines",
    16,
    [1, 256],
    "lines across the light; twice as many err a third to a half as much",
)
.unit("lines")
.when(EXTENDED);

const LINE_ANGLE: Param<f64> = Param::decimal(
    "angle",
    ANGLE,
    0.0,
    "of lines to a rectangle's or polygon's first edge; edges of casters should not be along lines",
)
.unit("degrees")
.when(EXTENDED);

const SKIPPED: Param<bool> = SKIP.with_summary(
    "leave out casters out of view, and edges that are no contour of the light for any receiver \
     of a block; same bits",
);

const IMAGE: Param<LightSequence> = LIGHT_IMAGE.with_summary(
    "colors on rectangles, summed along lines: two, sixteen lights, a fire, or PNG, EXR and HDR \
     files of 2x2 to 32x32 texels, a frame each with --frames",
);

const IMAGE_FRAME: Param<f64> = FRAME.with_summary(
    "number of the image that is shown, of a fire or of files, from the first again after the \
     last; between two numbers they are blended",
);

/// What parameters decide.
pub(super) struct LineSettings {
    pub(super) lines: u32,
    pub(super) angle: f64,
    pub(super) skip: bool,
    pub(super) image: Option<LightImage>,
    pub(super) volumes: VolumeSettings,
    pub(super) frame: FrameSettings,
}

impl LineSettings {
    pub(super) const PARAMS: &'static [ParamInfo] = &[
        LINES.info,
        LINE_ANGLE.info,
        SKIPPED.info,
        IMAGE.info,
        IMAGE_FRAME.info,
        METHOD.info,
        OVERFLOW.info,
        OPEN_CASTERS.info,
    ];

    pub(super) fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            lines: params.get(&LINES)?,
            angle: params.get(&LINE_ANGLE)?,
            skip: params.get(&SKIPPED)?,
            image: image(params)?,
            volumes: VolumeSettings::read(params)?,
            frame: FrameSettings::read(params)?,
        })
    }
}

/// The image that lights have, and the truth with them; of two the blend.
pub(super) fn image(params: &Params) -> Result<Option<LightImage>, TechniqueError> {
    let frame = params.get(&IMAGE_FRAME)?;
    let moment = sequence(params)?.map(|sequence| sequence.at(frame));
    Ok(moment.as_ref().map(LightMoment::blended))
}
