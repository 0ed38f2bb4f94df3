//! What parameters decide.

use crate::choices;
use crate::parts::wedges::soft::covering::CoveringSettings;
use crate::parts::wedges::soft::settings::SoftSettings;
use crate::technique::{CarryChannels, Condition, Param, Params, TechniqueError};

choices! {
    /// What visibility is added up in.
    pub(super) enum Buffer {
        /// A float.
        R32f = "r32f",
        /// 6 of 8 bits to add and to take, and counts in the alphas.
        Rgba8x2 = "rgba8x2",
        /// The same in red and green of one buffer, and counts in the stencil.
        Rgba8 = "rgba8",
    }
}

pub(super) const BUFFER: Param<Buffer> = Param::choice(
    "buffer",
    Buffer::R32f.word(),
    "visibility in a float, the most exact; or 6 of 8 bits to add and to take in two buffers, or as \
     paper III in red and green of one, the umbra in the stencil by depth test",
);

choices! {
    /// How hard shadow quads are counted.
    pub(super) enum Count {
        /// By the sides of eye and surface.
        Sides = "sides",
        /// By depth test.
        Depth = "depth",
    }
}

pub(super) const COUNT: Param<Count> = Param::choice(
    "count",
    Count::Sides.word(),
    "hard quads by the side of eye and surface, which agrees with wedges to the bit, or by depth \
     test as paper III: a pixel within rounding of a quad may be off by 1",
)
.when(Condition::Is("buffer", &["r32f"]));

pub(super) const COPY_BACK: Param<bool> = Param::switch(
    "copy-back",
    false,
    "with r32f: no float blending at all, each quad and each wedge reads, writes aside and copies \
     back, as paper III",
)
.when(Condition::Is("buffer", &["r32f"]));

/// What parameters decide.
pub(super) struct SoftVolumesSettings {
    pub(super) covering: CoveringSettings,
    pub(super) buffer: Buffer,
    pub(super) count: Count,
    pub(super) copy_back: bool,
    pub(super) soft: SoftSettings,
}

impl SoftVolumesSettings {
    /// # Errors
    /// Two settings rule each other out.
    pub(super) fn read(params: &Params) -> Result<Self, TechniqueError> {
        let settings = Self {
            covering: CoveringSettings::read(params)?,
            buffer: params.get(&BUFFER)?,
            count: params.get(&COUNT)?,
            copy_back: params.get(&COPY_BACK)?,
            soft: SoftSettings::read(params)?,
        };
        let bytes = settings.buffer != Buffer::R32f;
        let contradiction = |name: &'static str, why| {
            let value = params.text(name).unwrap_or_default().to_owned();
            Err(TechniqueError::Contradiction {
                technique: params.technique(),
                settings: [
                    (BUFFER.info.name, settings.buffer.word().to_owned()),
                    (name, value),
                ],
                why,
            })
        };
        if settings.copy_back && bytes {
            let why =
                "8-bit buffers are blended; copying back stands in for the blending of floats";
            return contradiction(COPY_BACK.info.name, why);
        }
        if settings.covering.image.is_some() && settings.buffer == Buffer::Rgba8 {
            return contradiction("light-image", "red and green hold one color's coverage");
        }
        Ok(settings)
    }

    /// Six bits of coverage: of each colour, or to add and to take (paper III, §4.2).
    pub(super) fn carry_channels(&self) -> Option<CarryChannels> {
        let count = match self.buffer {
            Buffer::R32f => return None,
            Buffer::Rgba8x2 => 3,
            Buffer::Rgba8 => 2,
        };
        Some(CarryChannels { bits: 6, count })
    }
}
