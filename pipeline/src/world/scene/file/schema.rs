//! What a scene file may contain, as serde sees it. Values that can be wrong in
//! themselves keep their spans; [`super::build`] judges them.

use std::fmt;

use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};
use toml::Spanned;

use super::array::Array;

pub(super) type Number = Spanned<f64>;
pub(super) type Triple = Spanned<Array<f64, 3>>;
pub(super) type Count = Spanned<u32>;

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneTable {
    #[serde(default)]
    pub(super) name: String,
    pub(super) size: Option<Spanned<Array<u32, 2>>>,
    pub(super) ambient: Option<Triple>,
    pub(super) background: Option<Triple>,
    pub(super) camera: CameraTable,
    pub(super) environment: Option<EnvironmentTable>,
    #[serde(default)]
    pub(super) lights: Vec<LightTable>,
    #[serde(default)]
    pub(super) objects: Vec<ObjectTable>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    pub(super) eye: Triple,
    pub(super) target: Triple,
    pub(super) up: Option<Triple>,
    pub(super) fov: Option<Number>,
    pub(super) near: Option<Number>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    pub(super) shape: LightShapeTable,
    #[serde(alias = "color")]
    pub(super) colour: Option<Triple>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) enum LightShapeTable {
    Point {
        position: Triple,
    },
    Square {
        #[serde(alias = "center")]
        centre: Triple,
        side: Number,
    },
    #[serde(rename_all = "kebab-case")]
    Rectangle {
        #[serde(alias = "center")]
        centre: Triple,
        edge_u: Triple,
        edge_v: Triple,
    },
    Polygon {
        vertices: Spanned<Vec<Array<f64, 3>>>,
    },
    Disc {
        #[serde(alias = "center")]
        centre: Triple,
        normal: Triple,
        radius: Number,
    },
    Sphere {
        #[serde(alias = "center")]
        centre: Triple,
        radius: Number,
    },
    Directional {
        towards: Triple,
    },
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectTable {
    pub(super) name: Option<String>,
    pub(super) mesh: MeshTable,
    pub(super) scale: Option<Spanned<Scale>>,
    pub(super) rotate: Option<Triple>,
    pub(super) translate: Option<Triple>,
    pub(super) crease: Option<Number>,
    pub(super) material: Option<MaterialTable>,
    pub(super) casts: Option<bool>,
    pub(super) receives: Option<bool>,
    pub(super) open: Option<bool>,
    pub(super) motion: Option<MotionTable>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotionTable {
    pub(super) velocity: Option<Triple>,
    pub(super) spin: Option<Triple>,
    #[serde(default)]
    pub(super) keys: Vec<KeyTable>,
    #[serde(default)]
    pub(super) repeat: bool,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyTable {
    pub(super) time: Number,
    pub(super) translate: Option<Triple>,
    pub(super) rotate: Option<Triple>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnvironmentTable {
    pub(super) map: Spanned<String>,
    pub(super) lights: Option<Count>,
    pub(super) form: Option<FormTable>,
    pub(super) threshold: Option<Number>,
    pub(super) residual: Option<ResidualTable>,
    pub(super) place: Option<PlaceTable>,
    pub(super) ambient: Option<AmbientTable>,
    pub(super) side: Option<Count>,
    pub(super) turn: Option<Number>,
    pub(super) brightness: Option<Number>,
}

#[derive(Clone, Copy, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FormTable {
    Square,
    Rectangle,
}

#[derive(Clone, Copy, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum ResidualTable {
    Excess,
    Mean,
}

#[derive(Clone, Copy, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum PlaceTable {
    Texels,
    Centroid,
    Moments,
}

#[derive(Clone, Copy, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum AmbientTable {
    Even,
    Harmonic,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct MaterialTable {
    pub(super) albedo: Option<Triple>,
    pub(super) texture: Option<Spanned<String>>,
    pub(super) texture_repeat: Option<Number>,
    pub(super) specular: Option<Triple>,
    pub(super) shininess: Option<Number>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) enum MeshTable {
    Obj(Spanned<String>),
    Model(Spanned<String>),
    Plane {
        half: Number,
    },
    Box {
        size: Triple,
    },
    Cylinder {
        segments: Count,
        radius: Number,
        height: Number,
    },
    Sphere {
        subdivisions: Count,
        radius: Number,
    },
    Capsule {
        from: Triple,
        to: Triple,
        radius: Number,
    },
    TorusKnot {
        p: Count,
        q: Count,
        ring: Number,
        minor: Number,
        tube: Number,
        along: Count,
        around: Count,
    },
    Terrain {
        cells: Count,
        half: Number,
        amplitude: Number,
    },
    Creature {
        phase: Number,
        walk: Option<Number>,
    },
}

impl MeshTable {
    /// Name of the kind, for objects that have none of their own.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Obj(_) => "obj",
            Self::Model(_) => "model",
            Self::Plane { .. } => "plane",
            Self::Box { .. } => "box",
            Self::Cylinder { .. } => "cylinder",
            Self::Sphere { .. } => "sphere",
            Self::Capsule { .. } => "capsule",
            Self::TorusKnot { .. } => "torus-knot",
            Self::Terrain { .. } => "terrain",
            Self::Creature { .. } => "creature",
        }
    }

    /// Whether it is a sheet, which is never closed.
    pub(super) fn is_sheet(&self) -> bool {
        matches!(self, Self::Plane { .. } | Self::Terrain { .. })
    }
}

/// A factor for all axes, or one for each.
#[derive(Clone, Copy)]
pub(super) struct Scale(pub(super) [f64; 3]);

impl<'de> Deserialize<'de> for Scale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ScaleVisitor)
    }
}

struct ScaleVisitor;

impl<'de> Visitor<'de> for ScaleVisitor {
    type Value = Scale;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or an array of three numbers")
    }

    fn visit_f64<E>(self, factor: f64) -> Result<Scale, E> {
        Ok(Scale([factor; 3]))
    }

    fn visit_i64<E>(self, factor: i64) -> Result<Scale, E> {
        Ok(Scale([factor as f64; 3]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Scale, A::Error> {
        let factors = Array::deserialize(SeqAccessDeserializer::new(seq))?;
        Ok(Scale(factors.0))
    }
}
