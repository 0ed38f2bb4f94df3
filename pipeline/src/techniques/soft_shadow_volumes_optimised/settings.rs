//! Parameters, and what they decide.

use gnomon_shaders::split_volumes::Tables;
use gnomon_shaders::split_volumes::resolve::Combination;

use crate::choices;
use crate::geometry::wedge::Construction;
use crate::parts::wedges::soft::covering::CoveringSettings;
use crate::parts::wedges::soft::edges::SoftCasters;
use crate::parts::wedges::soft::light::SoftLight;
use crate::parts::wedges::soft::loops::Loops;
use crate::parts::wedges::soft::settings::{SoftSettings, WEDGE};
use crate::technique::{
    Choice, Condition, LightFact, Param, ParamInfo, Params, TechniqueError, Value,
};

const WEDGE_TIGHT: Param<Construction> = WEDGE.with_default(Value::Word("paper4"));

choices! {
    /// Computed, or looked up in textures.
    enum Computed {
        /// By the shader.
        Arithmetic = "arithmetic",
        /// From a texture.
        Lut = "lut",
    }
}

const EXTENDED: Condition = Condition::Lights(LightFact::Extended);

/// Where paper III's texture is not read.
const WITHOUT_TEXTURE: Condition = Condition::All(&[
    EXTENDED,
    Condition::Is("backend", &["exact"]),
    Condition::Is("light-image", &["white"]),
]);

const COVERAGE: Param<Computed> = Param::choice(
    "coverage",
    Computed::Arithmetic.word(),
    "coverage computed, or from the paper's angle cube and area map",
)
.when(WITHOUT_TEXTURE);

const SPLIT_BITS: Param<Computed> = Param::choice(
    "split-bits",
    Computed::Arithmetic.word(),
    "12 bits of coverage split by arithmetic, or by a 1024-entry map that leaves 10",
)
.when(WITHOUT_TEXTURE);

impl Choice for Combination {
    const NAMES: &'static [&'static str] = &["sum", "paper", "bounded"];
    const ALL: &'static [Self] = &[Self::Sum, Self::Paper, Self::Bounded];
}

const COMBINE: Param<Combination> = Param::choice(
    "combine",
    "sum",
    "silhouettes: summed, max + min/2 one after the other, or half way from max to sum",
);

choices! {
    /// What is combined.
    enum CombineOver {
        /// Outlines with their holes.
        Outline = "outline",
        /// All of a caster's.
        Caster = "caster",
        /// Loops, as in the paper: holes are filled.
        Loop = "loop",
    }
}

const COMBINE_OVER: Param<CombineOver> = Param::choice(
    "combine-over",
    CombineOver::Outline.word(),
    "what is combined unless summed: outlines with holes, all of a caster's, or loops (paper IV)",
)
.when(Condition::Not("combine", &["sum"]));

const SPLIT: Param<u32> = Param::<u32>::whole(
    "split",
    1,
    [1, 8],
    "k: a rectangle as k x k lights, each with its own silhouettes and wedges",
);

const HALVES: Param<bool> = Param::switch(
    "halves",
    false,
    "inner and outer halves of wedges apart, each culled and to one buffer; same bits",
)
.when(EXTENDED);

/// Parameters of the technique's own.
pub(super) const PARAMS: &[ParamInfo] = &[
    WEDGE_TIGHT.info,
    COVERAGE.info,
    SPLIT_BITS.info,
    COMBINE.info,
    COMBINE_OVER.info,
    SPLIT.info,
    HALVES.info,
];

/// What parameters decide.
pub(super) struct OptimisedSettings {
    pub(super) tables: Tables,
    pub(super) covering: CoveringSettings,
    pub(super) combine: Combination,
    over: CombineOver,
    pub(super) split: u32,
    pub(super) halves: bool,
    pub(super) soft: SoftSettings,
}

impl OptimisedSettings {
    /// # Errors
    /// An image on a light that is split.
    pub(super) fn read(params: &Params) -> Result<Self, TechniqueError> {
        let settings = Self {
            tables: Tables {
                coverage: params.get(&COVERAGE)? == Computed::Lut,
                split: params.get(&SPLIT_BITS)? == Computed::Lut,
            },
            covering: CoveringSettings::read(params)?,
            combine: params.get(&COMBINE)?,
            over: params.get(&COMBINE_OVER)?,
            split: params.get(&SPLIT)?,
            halves: params.get(&HALVES)?,
            soft: SoftSettings::read(params)?,
        };
        if settings.split > 1 && settings.covering.image.is_some() {
            let image = params.text("light-image").unwrap_or_default();
            return Err(TechniqueError::Contradiction {
                technique: params.technique(),
                settings: [
                    (SPLIT.info.name, settings.split.to_string()),
                    ("light-image", image.to_owned()),
                ],
                why: "an image is of the whole light, and its coverage texture too",
            });
        }
        Ok(settings)
    }

    /// How many colours are covered apart.
    pub(super) fn colours(&self) -> usize {
        if self.covering.image.is_some() { 3 } else { 1 }
    }

    /// The silhouettes that are combined, seen from the middle of a light; of all casters
    /// as few as a stencil counts.
    pub(super) fn groups(&self, casters: &SoftCasters<'_>, light: &SoftLight) -> Loops {
        let centre = light.centre;
        let without_holes = |silhouettes| Loops {
            silhouettes,
            holes: 0,
        };
        match (self.combine, self.over) {
            (Combination::Sum, _) => without_holes(casters.in_ranges(centre)),
            (_, CombineOver::Caster) => without_holes(casters.each_in_ranges(centre)),
            (_, CombineOver::Outline) => without_holes(casters.outlines(centre)),
            (_, CombineOver::Loop) => casters.loops(centre),
        }
    }
}
