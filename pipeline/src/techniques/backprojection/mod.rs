//! Soft shadows by backprojection: texels of a light view as patches, projected from each
//! receiver on the light (docs/papers.md, baselines).
//!
//! `backprojection` adds the patches' areas, so that what is hidden twice counts twice;
//! `bitmask` sets bits of a field over the light, so that it counts once, in steps of the
//! field, whose bits may be turned out of line. Both take the same patches, with gaps filled to neighbours; a pyramid of least
//! depths bounds which texels can have some.
//!
//! Exact where lights are rectangles parallel to the picture, as those are that planar
//! views look along the normal of, but for the texels; other lights are squares of their
//! area. Receivers whose patches hide more than all of the light are counted as
//! `hidden-more-than-once`.
//!
//! Known errors, of the methods: what the light's centre does not see is not in the
//! picture, and patches face the light whatever the surface does.

mod pyramid;

use gnomon_raster::shader::FragmentStage;
use gnomon_shaders::backprojection::Backprojection;
use gnomon_shaders::backprojection::cover::{AreaSum, BitField, LightCover};
use gnomon_shaders::backprojection::patches::Gaps;
use gnomon_shaders::backprojection::turned::TurnedBits;
use gnomon_shaders::shadow_maps::Shadow;

use self::pyramid::Pyramid;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::maps::mapped::{
    BIAS, FIT, LookUp, Looked, MapSettings, Mapped, Margin, NEAR, Planes, SKIP, SLOPE_BIAS,
    Sources, VIEW,
};
use crate::technique::{
    Capabilities, Frame, Param, ParamInfo, Params, ShadowKind, Technique, TechniqueError,
};
use crate::world::scene::Scene;
use crate::{choices, param_list};

/// The registry's entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BackprojectedMaps {
    /// Areas.
    Areas,
    /// Bits.
    Bits,
}

choices! {
    /// What becomes of gaps between patches.
    enum GapFilling {
        /// Patches reach to their neighbours.
        Fill = "fill",
        /// Light leaks.
        Leave = "leave",
    }
}

const GAPS: Param<GapFilling> = Param::choice(
    "gaps",
    GapFilling::Fill.word(),
    "patches reach to neighbours that block too, or light leaks between them",
);

const REFINE: Param<u32> = Param::<u32>::whole(
    "refine",
    2,
    [0, 4],
    "times that the region of texels is made smaller by the least depth in it",
);

const BITS: Param<u32> = Param::<u32>::power_of_two(
    "bits",
    16,
    [2, 16],
    "bits along a side of the field over the light",
)
.unit("bits");

choices! {
    /// Where the bits are.
    enum Places {
        /// Centres of cells.
        Grid = "grid",
        /// Not in line.
        Rotated = "rotated-grid",
    }
}

const PATTERN: Param<Places> = Param::choice(
    "pattern",
    Places::Grid.word(),
    "bits at the centres of a grid's cells (the paper's plain case), or that grid turned so that no two are in line along the light's sides",
);

const MAP_SIZE: Param<u32> = Param::<u32>::power_of_two(
    "map-size",
    128,
    [16, 2048],
    "texels along a side of a light view; the work for a pixel grows with their number",
)
.unit("texels");

const MAPS: &[ParamInfo] = &[
    MAP_SIZE.info,
    BIAS.info,
    SLOPE_BIAS.info,
    NEAR.info,
    VIEW.info,
    FIT.info,
    SKIP.info,
];

/// What parameters decide.
struct Settings {
    gaps: Gaps,
    refinements: u32,
    bits: u32,
    places: Places,
    horizon: bool,
    maps: MapSettings,
    frame: FrameSettings,
}

impl Settings {
    fn read(of: BackprojectedMaps, params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            gaps: match params.get(&GAPS)? {
                GapFilling::Fill => Gaps::Filled,
                GapFilling::Leave => Gaps::Left,
            },
            refinements: params.get(&REFINE)?,
            bits: match of {
                BackprojectedMaps::Areas => 0,
                BackprojectedMaps::Bits => params.get(&BITS)?,
            },
            places: match of {
                BackprojectedMaps::Areas => Places::Grid,
                BackprojectedMaps::Bits => params.get(&PATTERN)?,
            },
            horizon: params.get(&HORIZON)?,
            maps: MapSettings::read(params)?,
            frame: FrameSettings::read(params)?,
        })
    }
}

/// Texels are held against receivers' planes: no slope bias is as wide as regions are.
const MARGIN: Margin = Margin {
    bias: 0.5,
    slope: 0.0,
    planes: Planes::Always,
};

impl Technique for BackprojectedMaps {
    fn name(&self) -> &'static str {
        match self {
            Self::Areas => "backprojection",
            Self::Bits => "bitmask",
        }
    }

    fn summary(&self) -> &'static str {
        match self {
            Self::Areas => {
                "soft shadows by areas of texels projected on the light (Guennebaud et al. 2006)"
            }
            Self::Bits => {
                "soft shadows by texels that set bits over the light (Schwarz and Stamminger 2007)"
            }
        }
    }

    fn params(&self) -> &'static [ParamInfo] {
        match self {
            Self::Areas => param_list!(
                &[GAPS.info, REFINE.info],
                MAPS,
                &[HORIZON.info],
                FrameSettings::PARAMS
            ),
            Self::Bits => param_list!(
                &[BITS.info, PATTERN.info, GAPS.info, REFINE.info],
                MAPS,
                &[HORIZON.info],
                FrameSettings::PARAMS
            ),
        }
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_light_views(ShadowKind::Soft)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = Settings::read(*self, params)?;
        let mapped = Mapped {
            scene,
            size,
            frame: settings.frame,
            maps: settings.maps,
            horizon: settings.horizon,
            margin: MARGIN,
            apart: false,
        };
        let side = settings.maps.view.fitting.size;
        mapped.prefiltered_frame(
            |recording| Pyramid::create(side, recording),
            |light| Sources::centre(self.name(), scene, light),
            |pyramid, look_up| {
                let side = settings.bits;
                let all = (&settings, pyramid, look_up);
                match (self, settings.places) {
                    (Self::Areas, _) => looked(AreaSum, all, |s| s.stage()),
                    (Self::Bits, Places::Grid) => looked(BitField { side }, all, |s| s.stage()),
                    (Self::Bits, Places::Rotated) => {
                        looked(TurnedBits { side }, all, |s| s.stage())
                    }
                }
            },
        )
    }
}

/// The pyramid of a view, and the shader that projects its texels.
fn looked<C: LightCover>(
    cover: C,
    (settings, pyramid, look_up): (&Settings, &Pyramid, &LookUp<'_>),
    stage: impl FnOnce(Shadow<Backprojection<C>>) -> FragmentStage,
) -> Looked {
    let shader = Backprojection {
        light_half: look_up.light_half(),
        pyramid: look_up.first_slot(),
        refinements: settings.refinements,
        gaps: settings.gaps,
        cover,
    };
    let wanted = settings.refinements > 0;
    Looked {
        prefilter: match wanted {
            true => pyramid.passes(&(look_up.label)("least depths"), look_up.depths),
            false => Vec::new(),
        },
        stage: stage(look_up.whole(shader)),
        textures: vec![pyramid.binding()],
        figures: Vec::new(),
        warnings: Vec::new(),
    }
}
