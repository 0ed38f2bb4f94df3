//! A scene shaded by visibility that is given: the picture that a technique
//! would make if its shadows were right. It is in no list; see
//! [`crate::measure::comparison::shaded`].

use gnomon_raster::{Format, Recording, Subresource, TextureDescriptor};

use crate::parts::passes::{LitTest, SceneDraws, Targets};
use crate::parts::visibility::VisibilityTexture;
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError};
use crate::world::scene::Scene;

/// Light number `light` times `values`; no other light shines.
pub(crate) struct GivenVisibility<'a> {
    pub(crate) light: usize,
    /// Of each pixel, rows from the top.
    pub(crate) values: &'a [f32],
}

impl Technique for GivenVisibility<'_> {
    fn name(&self) -> &'static str {
        "given-visibility"
    }

    fn summary(&self) -> &'static str {
        "one light, dimmed by a picture of its visibility"
    }

    /// None of its own; shading and formats are those of the parameters given.
    fn params(&self) -> &'static [ParamInfo] {
        &[]
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let mut recording = Recording::default();
        let targets = Targets::create(size, params, &mut recording)?;
        let draws = SceneDraws::new(scene, size, params);
        let [width, height] = size;
        let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let texture = recording.create(&desc)?;
        let texels: Vec<[f32; 4]> = self.values.iter().map(|v| [*v, 0.0, 0.0, 0.0]).collect();
        recording.write(texture, Subresource::default(), &texels)?;
        let visibility = VisibilityTexture::red(texture);
        let lit = draws.lit_pass(&targets, self.light, "lit", LitTest::Visibility(visibility));
        let passes = vec![draws.ambient_pass(&targets), lit];
        targets.frame(recording, passes, visibility.output())
    }
}
