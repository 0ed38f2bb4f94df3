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
use crate::technique::{ParamInfo, Params, TechniqueError};

pub(crate) const BACKEND: ParamInfo = ParamInfo {
    name: "backend",
    default: "exact",
    valid: "exact|texture4d",
    summary: "coverage of an edge in closed form, or from paper III's 4D texture",
};

pub(crate) const TEXTURE_SIZE: ParamInfo = ParamInfo {
    name: "texture-size",
    default: "32",
    valid: "N",
    summary: "entries in each dimension of the 4D texture, 2 to 90",
};

pub(crate) const TEXTURE_FILTER: ParamInfo = ParamInfo {
    name: "texture-filter",
    default: "nearest",
    valid: "nearest|quadlinear",
    summary: "how the 4D texture is read",
};

pub(crate) const TEXTURE_CENTRED: ParamInfo = ParamInfo {
    name: "texture-centred",
    default: "cell",
    valid: "cell|vertex",
    summary: "entries of the 4D texture at cells' centres, as the paper's, or up to the border",
};

pub(crate) const LIGHT_IMAGE: ParamInfo = ParamInfo {
    name: "light-image",
    default: "white",
    valid: "white|halves|windows|fire",
    summary: "colours on a rectangle, by a coloured 4D texture: two, sixteen lights, a fire",
};

pub(crate) const LIGHT_FRAME: ParamInfo = ParamInfo {
    name: "light-frame",
    default: "0",
    valid: "N",
    summary: "number of the fire's frame; each has a 4D texture of its own",
};

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
        params: &Params,
        recording: &mut Recording,
    ) -> Result<Covering, TechniqueError> {
        let shape = light.sides.first().map(|s| s.projector.image());
        let known = self.0.iter().find(|(of, _)| Some(*of) == shape);
        if let Some((_, covering)) = known {
            return Ok(*covering);
        }
        let covering = Covering::create(technique, light, number, params, recording)?;
        self.0.extend(shape.map(|shape| (shape, covering)));
        Ok(covering)
    }
}

impl Covering {
    fn create(
        technique: &'static str,
        light: &SoftLight,
        number: usize,
        params: &Params,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let image = light_image(params);
        let wanted = params.get(BACKEND.name) == "texture4d" || image.is_some();
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
        let given = params.get(TEXTURE_SIZE.name);
        let size = given.parse().ok().filter(|n| (2..=90).contains(n));
        let table = CoverageTable {
            size: size.ok_or(TechniqueError::BadValue {
                technique,
                key: TEXTURE_SIZE.name,
                value: given.to_owned(),
                valid: "2 to 90",
            })?,
            linear: params.get(TEXTURE_FILTER.name) == "quadlinear",
            vertex_centred: params.get(TEXTURE_CENTRED.name) == "vertex",
        };
        let texture = table::create(&table, &contents, recording)?;
        Ok(Self::Table(table, texture))
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

/// The colours on the light, where they are not one.
pub(crate) fn light_image(params: &Params) -> Option<LightImage> {
    let frame = params.get(LIGHT_FRAME.name).parse().unwrap_or(0);
    match params.get(LIGHT_IMAGE.name) {
        "halves" => Some(LightImage::halves()),
        "windows" => Some(LightImage::windows()),
        "fire" => Some(LightImage::fire(frame)),
        _ => None,
    }
}
