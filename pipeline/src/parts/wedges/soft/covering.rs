//! How the coverage of an edge is found: in closed form, or from the 4D texture of
//! paper III (§3.3), and the parameters that say so.

use std::borrow::Cow;

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::{Recording, TextureId};
use gnomon_shaders::coverage::{Edge, Image};
use gnomon_shaders::coverage_table::{BlendedTables, CoverageTable};
use gnomon_shaders::soft_volumes::{CoverTo, ExactCoverage, HardPlane, Penumbra};
use gnomon_shaders::split_volumes::textured::SplitTextured;
use gnomon_shaders::split_volumes::{Halves, SplitPenumbra, Tables};

use super::light::{LightSide, SoftLight};
use super::table::{self, Contents};
use crate::choices;
use crate::technique::{
    Condition, LIGHT_FRAME, LightFact, Param, ParamInfo, Params, TechniqueError,
};
use crate::world::light_image::{LightImage, LightMoment, LightSequence};
use crate::world::scene::Scene;

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
    "how the 4D texture is read: the nearest entry as the paper, or between sixteen, off the light's \
     center; under images of sharp contrast both err where an edge passes the center, and more \
     entries help",
)
.when(WITH_TEXTURE);

const TEXTURE_CENTRED: Param<TextureCentred> = Param::choice(
    "texture-centred",
    TextureCentred::Cell.word(),
    "entries of the 4D texture at cells' centres, as the paper's, or up to the border",
)
.when(WITH_TEXTURE);

/// Names of built-in images.
const IMAGES: &[&str] = &["white", "halves", "windows", "fire"];

choices! {
    /// What a coloured texture holds.
    enum TextureBits {
        /// Half floats.
        Sixteen = "16",
        /// Bytes.
        Eight = "8",
    }
}

const TEXTURE_BITS: Param<TextureBits> = Param::choice(
    "texture-bits",
    TextureBits::Sixteen.word(),
    "bits of a color in the 4D texture of an image: half floats, or 8 as the paper's; without an \
     image they are 8",
)
.unit("bits")
.when(Condition::All(&[
    EXTENDED,
    Condition::Not("light-image", &["white"]),
]));

pub(crate) const LIGHT_IMAGE: Param<LightSequence> = Param::images(
    IMAGES,
    "light-image",
    "colors on rectangles, by colored 4D textures: two, sixteen lights, a fire, or PNG, EXR and \
     HDR files of 2x2 to 32x32 texels, a frame each with --frames",
);

pub(crate) const FRAME: Param<f64> = Param::decimal(
    LIGHT_FRAME,
    0.0,
    0.0,
    "number of the image that is shown, of a fire or of files, from the first again after the \
     last; between two numbers their 4D textures are blended",
)
.when(Condition::All(&[
    EXTENDED,
    Condition::Not("light-image", &["white", "halves", "windows"]),
]));

/// How the coverage of edges is found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CoveringSettings {
    backend: Backend,
    table: CoverageTable,
    /// The colours on the light, where they are not one.
    pub(crate) image: Option<LightMoment>,
}

impl CoveringSettings {
    pub(crate) const PARAMS: &'static [ParamInfo] = &[
        BACKEND.info,
        TEXTURE_SIZE.info,
        TEXTURE_FILTER.info,
        TEXTURE_CENTRED.info,
        TEXTURE_BITS.info,
        LIGHT_IMAGE.info,
        FRAME.info,
    ];

    /// # Errors
    /// `backend=exact` is asked for together with an image.
    pub(crate) fn read(params: &Params) -> Result<Self, TechniqueError> {
        let backend = params.get(&BACKEND)?;
        let image = sequence(params)?;
        let asked = params.is_given(BACKEND.info.name) && backend == Backend::Exact;
        if asked && image.is_some() {
            let name = params.text(LIGHT_IMAGE.info.name).unwrap_or_default();
            return Err(TechniqueError::Contradiction {
                technique: params.technique(),
                settings: [
                    (BACKEND.info.name, backend.word().to_owned()),
                    (LIGHT_IMAGE.info.name, name.to_owned()),
                ],
                why: "coverage of an image is looked up in a 4D texture",
            });
        }
        let frame = params.get(&FRAME)?;
        Ok(Self {
            backend,
            table: CoverageTable {
                size: params.get(&TEXTURE_SIZE)?,
                linear: params.get(&TEXTURE_FILTER)? == TextureFilter::Quadlinear,
                vertex_centred: params.get(&TEXTURE_CENTRED)? == TextureCentred::Vertex,
                whole: image.is_some() && params.get(&TEXTURE_BITS)? == TextureBits::Eight,
            },
            image: image.map(|sequence| sequence.at(frame)),
        })
    }

    /// The image that lights have, and the truth with them; of two the blend.
    pub(crate) fn light_image(&self) -> Option<LightImage> {
        self.image.as_ref().map(LightMoment::blended)
    }

    /// `scene`, its lights in the colours of their image.
    pub(crate) fn lit<'a>(&self, scene: &'a Scene) -> Cow<'a, Scene> {
        match self.light_image() {
            Some(image) => Cow::Owned(scene.with_light_image(&image)),
            None => Cow::Borrowed(scene),
        }
    }
}

/// The images that parameters ask for.
pub(crate) fn sequence(params: &Params) -> Result<Option<LightSequence>, TechniqueError> {
    let one = |image: LightImage| LightSequence::Images([image].into());
    let built_in = match params.text(LIGHT_IMAGE.info.name) {
        Some("halves") => Some(one(LightImage::halves())),
        Some("windows") => Some(one(LightImage::windows())),
        Some("fire") => Some(LightSequence::Fire),
        _ => None,
    };
    let read = params.images(&LIGHT_IMAGE)?;
    Ok(built_in.or_else(|| read.cloned()))
}

/// How coverage is found.
#[derive(Clone, Copy)]
pub(crate) enum Covering {
    Exact,
    Table(CoverageTable, TextureId),
    /// Between two images of a light.
    Blended(BlendedTables, [TextureId; 2]),
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
        let image = settings.image.as_ref();
        let wanted = settings.backend == Backend::Texture4d || image.is_some();
        let Some(side) = light.sides.first().filter(|_| wanted) else {
            return Ok(Self::Exact);
        };
        let shape = side.projector.image();
        let Some(moment) = image else {
            let texture = table::create(&settings.table, &Contents::Plain(shape), recording)?;
            return Ok(Self::Table(settings.table, texture));
        };
        if shape != Image::Square {
            return Err(TechniqueError::UnsuitableLight {
                technique,
                light: number,
                why: "an image was asked for on a light that is no rectangle".to_owned(),
                valid: "rectangles for light-image",
            });
        }
        let mut texture =
            |of: &LightImage| table::create(&settings.table, &Contents::Coloured(of), recording);
        let first = texture(&moment.image)?;
        let Some((next, _)) = &moment.next else {
            return Ok(Self::Table(settings.table, first));
        };
        let tables = BlendedTables {
            table: settings.table,
            parts: moment.parts().map(|p| p as f32),
        };
        Ok(Self::Blended(tables, [first, texture(next)?]))
    }

    /// The coverage textures, where there are some.
    pub(crate) fn textures(self) -> impl Iterator<Item = TextureId> {
        let both = match self {
            Self::Exact => [None; 2],
            Self::Table(_, texture) => [Some(texture), None],
            Self::Blended(_, both) => both.map(Some),
        };
        both.into_iter().flatten()
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
            Self::Blended(covering, _) => Penumbra {
                light,
                covering,
                edge,
                plane,
                to,
            }
            .stage(),
        }
    }

    /// The same split over 8-bit buffers (paper IV): coverage has to be in textures.
    pub(crate) fn split_shader(
        self,
        side: &LightSide,
        edge: Edge,
        plane: HardPlane,
        halves: Halves,
        colors: u32,
    ) -> FragmentStage {
        let light = side.projector;
        match self {
            Self::Exact => SplitPenumbra {
                light,
                edge,
                plane,
                tables: Tables::default(),
                halves,
            }
            .stage(),
            Self::Table(covering, _) => SplitTextured {
                light,
                covering,
                edge,
                plane,
                halves,
                colors,
            }
            .stage(),
            Self::Blended(covering, _) => SplitTextured {
                light,
                covering,
                edge,
                plane,
                halves,
                colors,
            }
            .stage(),
        }
    }
}
