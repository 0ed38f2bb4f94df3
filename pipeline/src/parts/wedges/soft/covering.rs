//! How the coverage of an edge is found: in closed form, or from the 4D texture of
//! paper III (§3.2.3), and the parameters that say so.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::{Recording, TextureId};
use gnomon_shaders::coverage::{Edge, Image};
use gnomon_shaders::coverage_table::CoverageTable;
use gnomon_shaders::soft_volumes::{CoverTo, ExactCoverage, HardPlane, Penumbra};

use super::light::{LightSide, SoftLight};
use super::light_image::LightImage;
use super::table::{self, Contents};
use crate::choices;
use crate::technique::{Condition, LightFact, Param, ParamInfo, Params, TechniqueError};

choices! {
    /// How the coverage of an edge is found.
    pub(crate) enum Backend {
        /// In closed form.
        Exact = "exact",
        /// From paper III's texture.
        Texture4d = "texture4d",
    }
}

choices! {
    /// How the texture is read.
    enum TextureFilter {
        /// The nearest entry.
        Nearest = "nearest",
        /// Sixteen entries.
        Quadlinear = "quadlinear",
    }
}

choices! {
    /// Where entries of the texture are.
    enum TextureCentred {
        /// At cells' centres.
        Cell = "cell",
        /// Up to the border.
        Vertex = "vertex",
    }
}

choices! {
    /// Colours on a rectangle.
    enum ImageName {
        /// One.
        White = "white",
        /// Two.
        Halves = "halves",
        /// Sixteen lights.
        Windows = "windows",
        /// A fire.
        Fire = "fire",
    }
}

const BACKEND: Param<Backend> = Param::choice(
    "backend",
    Backend::Exact.word(),
    "coverage of an edge in closed form, or from paper III's 4D texture; images need the texture",
)
.when(Condition::All(&[
    EXTENDED,
    Condition::Is("light-image", &["white"]),
]));

const EXTENDED: Condition = Condition::Lights(LightFact::Extended);

/// Where the 4D texture is used.
const WITH_TEXTURE: Condition = Condition::All(&[
    EXTENDED,
    Condition::Any(&[
        Condition::Is("backend", &["texture4d"]),
        Condition::Not("light-image", &["white"]),
    ]),
]);

const TEXTURE_SIZE: Param<u32> = Param::<u32>::whole(
    "texture-size",
    32,
    [2, 90],
    "entries in each dimension of the 4D texture",
)
.unit("entries")
.when(WITH_TEXTURE);

const TEXTURE_FILTER: Param<TextureFilter> = Param::choice(
    "texture-filter",
    TextureFilter::Nearest.word(),
    "how the 4D texture is read",
)
.when(WITH_TEXTURE);

const TEXTURE_CENTRED: Param<TextureCentred> = Param::choice(
    "texture-centred",
    TextureCentred::Cell.word(),
    "entries of the 4D texture at cells' centres, as the paper's, or up to the border",
)
.when(WITH_TEXTURE);

const LIGHT_IMAGE: Param<ImageName> = Param::choice(
    "light-image",
    ImageName::White.word(),
    "colours on a rectangle, by a coloured 4D texture: two, sixteen lights, a fire",
);

const LIGHT_FRAME: Param<u32> = Param::<u32>::whole(
    "light-frame",
    0,
    [0, u32::MAX as u64],
    "number of the fire's frame; each has a 4D texture of its own",
)
.when(Condition::All(&[
    EXTENDED,
    Condition::Is("light-image", &["fire"]),
]));

/// How the coverage of edges is found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CoveringSettings {
    backend: Backend,
    table: CoverageTable,
    /// The colours on the light, where they are not one.
    pub(crate) image: Option<LightImage>,
}

impl CoveringSettings {
    pub(crate) const PARAMS: &'static [ParamInfo] = &[
        BACKEND.info,
        TEXTURE_SIZE.info,
        TEXTURE_FILTER.info,
        TEXTURE_CENTRED.info,
        LIGHT_IMAGE.info,
        LIGHT_FRAME.info,
    ];

    /// # Errors
    /// `backend=exact` is asked for together with an image.
    pub(crate) fn read(params: &Params) -> Result<Self, TechniqueError> {
        let (backend, name) = (params.get(&BACKEND)?, params.get(&LIGHT_IMAGE)?);
        let frame = params.get(&LIGHT_FRAME)?;
        let image = match name {
            ImageName::White => None,
            ImageName::Halves => Some(LightImage::halves()),
            ImageName::Windows => Some(LightImage::windows()),
            ImageName::Fire => Some(LightImage::fire(frame)),
        };
        let asked = params.is_given(BACKEND.info.name) && backend == Backend::Exact;
        if asked && image.is_some() {
            return Err(TechniqueError::Contradiction {
                technique: params.technique(),
                settings: [
                    (BACKEND.info.name, backend.word().to_owned()),
                    (LIGHT_IMAGE.info.name, name.word().to_owned()),
                ],
                why: "coverage of an image is looked up in a 4D texture",
            });
        }
        Ok(Self {
            backend,
            table: CoverageTable {
                size: params.get(&TEXTURE_SIZE)?,
                linear: params.get(&TEXTURE_FILTER)? == TextureFilter::Quadlinear,
                vertex_centred: params.get(&TEXTURE_CENTRED)? == TextureCentred::Vertex,
            },
            image,
        })
    }
}

/// How coverage is found.
#[derive(Clone, Copy)]
pub(crate) enum Covering {
    Exact,
    Table(CoverageTable, TextureId),
}

/// Coverings of the lights of a frame. Lights of one shape share a texture: it
/// depends on nothing else that differs between them.
#[derive(Default)]
pub(crate) struct Coverings(Vec<(Image, Covering)>);

impl Coverings {
    /// That of light number `number`.
    pub(crate) fn of(
        &mut self,
        technique: &'static str,
        light: &SoftLight,
        number: usize,
        settings: &CoveringSettings,
        recording: &mut Recording,
    ) -> Result<Covering, TechniqueError> {
        let shape = light.sides.first().map(|s| s.projector.image());
        let known = self.0.iter().find(|(of, _)| Some(*of) == shape);
        if let Some((_, covering)) = known {
            return Ok(*covering);
        }
        let covering = Covering::create(technique, light, number, settings, recording)?;
        self.0.extend(shape.map(|shape| (shape, covering)));
        Ok(covering)
    }
}

impl Covering {
    fn create(
        technique: &'static str,
        light: &SoftLight,
        number: usize,
        settings: &CoveringSettings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let image = settings.image.clone();
        let wanted = settings.backend == Backend::Texture4d || image.is_some();
        let Some(side) = light.sides.first().filter(|_| wanted) else {
            return Ok(Self::Exact);
        };
        let contents = match (image, side.projector.image()) {
            (Some(image), Image::Square) => Contents::Coloured(image),
            (Some(_), Image::Disc) => {
                return Err(TechniqueError::UnsuitableLight {
                    technique,
                    light: number,
                    why: "an image was asked for on a round light".to_owned(),
                    valid: "rectangles for light-image",
                });
            }
            (None, shape) => Contents::Plain(shape),
        };
        let texture = table::create(&settings.table, &contents, recording)?;
        Ok(Self::Table(settings.table, texture))
    }

    /// The coverage texture, where there is one.
    pub(crate) fn texture(self) -> Option<TextureId> {
        match self {
            Self::Exact => None,
            Self::Table(_, texture) => Some(texture),
        }
    }

    /// The shader of one edge.
    pub(crate) fn shader(
        self,
        side: &LightSide,
        edge: Edge,
        plane: HardPlane,
        to: CoverTo,
    ) -> FragmentStage {
        let light = side.projector;
        match self {
            Self::Exact => Penumbra {
                light,
                covering: ExactCoverage,
                edge,
                plane,
                to,
            }
            .stage(),
            Self::Table(covering, _) => Penumbra {
                light,
                covering,
                edge,
                plane,
                to,
            }
            .stage(),
        }
    }
}
