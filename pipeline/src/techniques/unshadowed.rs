//! The scene without shadows: ambient light, then every light added everywhere.

use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::technique::{Capabilities, Frame, ParamInfo, Params, Technique, TechniqueError};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct Unshadowed;

impl Technique for Unshadowed {
    fn name(&self) -> &'static str {
        "unshadowed"
    }

    fn summary(&self) -> &'static str {
        "every light reaches everything: the picture without shadows"
    }

    fn params(&self) -> &'static [ParamInfo] {
        FrameSettings::PARAMS
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
        let settings = FrameSettings::read(params)?;
        let frame = ShadowedFrame::new(scene, size, &settings)?.with_ambient();
        frame.lit(LitTest::Everywhere, |_| Ok(Vec::new()))
    }
}
