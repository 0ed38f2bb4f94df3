//! Deferred shadowing (Tamura, Johan and Nishita 2006; docs/papers.md): objects lit by an
//! environment, each as if it were alone, less what the others hide.
//!
//! What an object hides of itself does not change while it moves as a whole. So it is
//! computed once for its shape, per vertex and in spherical harmonics
//! ([`crate::truth::oracle::transport`]); under any environment and any rotation the
//! light of a vertex, L_s, is an inner product. What other objects hide, L_o, is found
//! for what is seen: the environment is cut into lights, and for each light and
//! receiver the shadow of the occluders on a plane is convolved with a square as large
//! as the light seems from there, and looked up at each pixel. The picture is
//! `L_s - L_o`.
//!
//! Visibility is the share of the environment's light that arrives, by luminance. A
//! scene without an environment, or under one of its lights alone, has visibility of
//! each light instead: transport towards it over that of an open surface, times what
//! occlusion maps leave; a light with a place projects centrally.
//!
//! # Cost of motion
//!
//! Maps of pairs that did not move are those of the frame before (see
//! [`keeping`]); transport, lights and harmonics of the map are kept by content.
//!
//! Small lights near a surface's horizon are taken out of the bands, which cannot tell where
//! they set: see [`grazing`].
//!
//! Known errors, of the method: shadows of one object on another have the softness of
//! one distance per map; light is smooth between vertices; six bands know no sharp
//! self-shadow. Of this project: see `below` in [`placing`], which keeps occluders from
//! shading what lies before them, and the plane in [`settings`].

mod atlas;
mod bodies;
mod distant;
mod environment;
mod grazing;
mod groups;
mod keeping;
mod light;
mod notes;
mod placing;
mod radiance;
mod settings;
mod shadows;
mod sheets;
mod sources;
mod transported;

use std::cell::RefCell;

use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::technique::{
    Capabilities, Frame, KeptPictures, ParamInfo, Params, ShadowKind, Technique, TechniqueError,
};
use crate::truth::oracle::cache::{CacheWarning, OracleCache};
use crate::world::scene::Scene;
use settings::Settings;

/// The registry's entry.
pub(crate) struct DeferredShadowing;

impl Technique for DeferredShadowing {
    fn name(&self) -> &'static str {
        "deferred-shadowing"
    }

    fn summary(&self) -> &'static str {
        "moving objects under environments: precomputed self-shadows, less convolved shadows of each other"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(Settings::PARAMS, FrameSettings::PARAMS)
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_light_views(ShadowKind::Soft)
    }

    fn prepare(
        &self,
        scene: &Scene,
        params: &Params,
        cache: &OracleCache,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<CacheWarning>, TechniqueError> {
        let settings = Settings::read(params)?;
        // Of one pixel: only what objects are is asked for.
        let frame = ShadowedFrame::new(scene, [1; 2], &settings.frame)?.with_ambient();
        let warnings = RefCell::new(Vec::new());
        bodies::with_transport(scene, &frame.draws, &|object| {
            let found = cache.transport(object, settings.transport, done);
            warnings.borrow_mut().extend(found.warnings);
            found.transport
        });
        Ok(warnings.into_inner())
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        frame(scene, (size, None), params)
    }

    fn frame_after(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
        kept: &KeptPictures,
    ) -> Result<Frame, TechniqueError> {
        frame(scene, (size, Some(kept)), params)
    }
}

/// A frame of a size, by itself or after another one that left something.
fn frame(
    scene: &Scene,
    sequence: ([u32; 2], Option<&KeptPictures>),
    params: &Params,
) -> Result<Frame, TechniqueError> {
    let settings = Settings::read(params)?;
    let environment = scene.environment.as_ref();
    match environment.filter(|_| settings.frame.light.is_none()) {
        None => distant::frame(scene, sequence, &settings),
        Some(placed) => {
            // The residual is in L_s.
            environment::frame(&scene.without_ambient(), placed, sequence, &settings)
        }
    }
}
