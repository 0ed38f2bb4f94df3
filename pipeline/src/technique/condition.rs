//! When a parameter has an effect.

use std::fmt::{self, Display, Formatter};

use super::Params;
use crate::world::light::LightShape;
use crate::world::scene::Scene;

/// A condition on other parameters of the technique and on the lights that shine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// No condition.
    Always,
    /// A parameter has one of these values.
    Is(&'static str, &'static [&'static str]),
    /// A parameter has none of these values.
    Not(&'static str, &'static [&'static str]),
    /// All of these hold.
    All(&'static [Condition]),
    /// One of these holds.
    Any(&'static [Condition]),
    /// One of the lights that shine is such a light.
    Lights(LightFact),
    /// An environment lights the scene, by all of its lights.
    Environment,
}

/// What a light may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightFact {
    /// A sphere.
    Sphere,
    /// Of some extent.
    Extended,
}

impl LightFact {
    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Extended => "extended",
        }
    }

    pub(crate) fn holds(self, shape: &LightShape) -> bool {
        match self {
            Self::Sphere => matches!(shape, LightShape::Sphere { .. }),
            Self::Extended => !matches!(
                shape,
                LightShape::Point { .. } | LightShape::Directional { .. }
            ),
        }
    }
}

impl Condition {
    /// Whether it holds for `params` and the lights of `scene` that they let shine.
    pub fn holds(&self, params: &Params, scene: &Scene) -> bool {
        match self {
            Self::Always => true,
            Self::Is(key, values) => values.iter().any(|v| params.has_value(key, v)),
            Self::Not(key, values) => !values.iter().any(|v| params.has_value(key, v)),
            Self::All(all) => all.iter().all(|c| c.holds(params, scene)),
            Self::Any(any) => any.iter().any(|c| c.holds(params, scene)),
            Self::Lights(fact) => shining(params, scene).any(|shape| fact.holds(shape)),
            Self::Environment => {
                let all = params.text("light").is_none_or(|light| light == "all");
                scene.environment.is_some() && all
            }
        }
    }
}

/// Shapes of the lights that parameter `light` lets shine; all, where there is none.
fn shining<'a>(params: &Params, scene: &'a Scene) -> impl Iterator<Item = &'a LightShape> {
    let one = params.text("light").and_then(|n| n.parse::<usize>().ok());
    let lights = scene.lights.iter().enumerate();
    lights
        .filter(move |(number, _)| one.is_none_or(|one| one == *number))
        .map(|(_, light)| &light.shape)
}

/// For people: `kernel=box`.
impl Display for Condition {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Always => f.write_str("always"),
            Self::Is(key, values) => write!(f, "{key}={}", values.join("|")),
            Self::Not(key, values) => write!(f, "{key} is not {}", values.join("|")),
            Self::All(all) => f.write_str(&joined(all, " and ")),
            Self::Any(any) => f.write_str(&joined(any, " or ")),
            Self::Lights(LightFact::Sphere) => f.write_str("a light is a sphere"),
            Self::Lights(LightFact::Extended) => f.write_str("a light has an extent"),
            Self::Environment => f.write_str("an environment lights the scene, light=all"),
        }
    }
}

fn joined(conditions: &[Condition], between: &str) -> String {
    let texts: Vec<String> = conditions.iter().map(Condition::to_string).collect();
    texts.join(between)
}
