//! The picture that the truth gives.

use std::borrow::Cow;

use super::{Aligned, Reference};
use crate::measure::comparison::given_visibility::GivenVisibility;
use crate::measure::render::{RenderError, RenderSettings, render};
use crate::technique::Params;
use crate::world::scene::Scene;

/// Names of the parameters that decide how a scene is shaded.
const SHADING_PARAMS: [&str; 3] = ["shading", "color-format", "depth-format"];

/// What of a technique's parameters decides the picture of the truth: techniques
/// with equal keys are held against the same picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShadingKey([String; 3]);

impl ShadingKey {
    /// The key of `params`.
    pub fn of(params: &Params) -> Self {
        Self(SHADING_PARAMS.map(|name| params.text(name).unwrap_or_default().to_owned()))
    }
}

/// `scene` under the light of `reference` alone, with the image that is on it, dimmed by the truth and shaded
/// and stored as a technique with `params` does, so that pictures differ in
/// visibility only: the sRGB picture, rows from the top. `under` is the truth
/// under that technique's depth buffer.
///
/// # Errors
/// The GPU refuses the settings.
pub fn shaded(
    scene: &Scene,
    reference: &Reference,
    under: &Aligned,
    params: &Params,
    settings: &RenderSettings,
) -> Result<Vec<[u8; 4]>, RenderError> {
    let technique = GivenVisibility {
        light: reference.light,
        values: &under.for_shading,
        others: under.other_colours.as_ref(),
    };
    let settings = RenderSettings {
        repeat: 1,
        ..*settings
    };
    let scene = match &reference.light_image {
        Some(image) => Cow::Owned(scene.with_light_image(image)),
        None => Cow::Borrowed(scene),
    };
    Ok(render(&scene, &technique, params, &settings)?.srgb)
}
