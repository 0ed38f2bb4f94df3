//! A scene shaded by visibility that is given: the picture that a technique
//! would make if its shadows were right. It is in no list; see
//! [`crate::measure::comparison::shaded`].

use gnomon_raster::{Format, Subresource, TextureDescriptor};

use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::parts::visibility::VisibilityTexture;
use crate::technique::{Capabilities, Frame, ParamInfo, Params, Technique, TechniqueError};
use crate::world::scene::Scene;

/// Light number `light` times `values`; no other light shines.
pub(crate) struct GivenVisibility<'a> {
    pub(crate) light: usize,
    /// Of each pixel, rows from the top.
    pub(crate) values: &'a [f32],
    /// Green and blue, where `values` are red alone.
    pub(crate) others: Option<&'a [Vec<f32>; 2]>,
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

    fn capabilities(&self) -> Capabilities {
        Capabilities::UNSHADOWED
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = FrameSettings {
            light: Some(self.light),
            ..FrameSettings::shading_only(params)?
        };
        let mut frame = ShadowedFrame::new(scene, size, &settings)?.with_ambient();
        let [width, height] = size;
        let format = match self.others {
            Some(_) => Format::Rgba32Float,
            None => Format::R32Float,
        };
        let desc = TextureDescriptor::d2("visibility", format, width, height);
        let texture = frame.recording.create(&desc)?;
        let other = |colour: usize, k: usize| self.others.map_or(0.0, |all| all[colour][k]);
        let values = self.values.iter().enumerate();
        let texels = values.map(|(k, v)| [*v, other(0, k), other(1, k), 0.0]);
        let texels: Vec<[f32; 4]> = texels.collect();
        frame
            .recording
            .write(texture, Subresource::default(), &texels)?;
        let visibility = VisibilityTexture {
            coloured: self.others.is_some(),
            ..VisibilityTexture::red(texture)
        };
        frame.lit(LitTest::Visibility(visibility), |_| Ok(Vec::new()))
    }
}
