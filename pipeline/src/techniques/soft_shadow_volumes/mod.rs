//! Soft shadow volumes (Assarsson and Akenine-Möller, paper III; docs/papers.md, paper III).
//!
//! Per light: the visibility buffer starts at 1; hard shadow quads take 1 where
//! the light's centre is hidden; then each silhouette edge's penumbra wedge adds
//! what the edge covers of the light on the umbra side of its quad, and takes it
//! away on the other. For one caster with one simple silhouette loop that is the
//! visible share of the light, not an approximation of it. What overlaps, and
//! silhouettes that differ over the light, are the papers' known errors.
//!
//! # Departures from the paper, and why
//!
//! * Quads are counted by the side of eye and receiver, not by depth: count and
//!   sign then share one predicate to the bit, and neither caps nor z-fail are
//!   needed for an eye in shadow.
//! * The receiver's position comes from an attachment of the ambient pass instead
//!   of the depth buffer, whose 24 bits would be seen in the penumbra.
//! * Wedges only choose pixels. The shader gives exactly 0 outside the penumbra,
//!   so `wedge` and `skip` change counters and no bit.

mod buffers;
mod volumes;

use crate::parts::casters::{OPEN_CASTERS, SKIP};
use crate::parts::horizon::{HORIZON, Horizon};
use crate::parts::passes::{self, LitTest, SceneDraws, Targets};
use crate::parts::visibility::Positions;
use crate::parts::wedges::soft::covering::{
    BACKEND, Coverings, LIGHT_FRAME, LIGHT_IMAGE, TEXTURE_CENTRED, TEXTURE_FILTER, TEXTURE_SIZE,
    light_image,
};
use crate::parts::wedges::soft::edges::Casters;
use crate::parts::wedges::soft::light::SoftLight;
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError};
use crate::world::scene::Scene;
use buffers::Buffers;
use gnomon_raster::Recording;
use volumes::Volumes;

/// The registry's entry.
pub(crate) struct SoftShadowVolumes;

pub(super) const WEDGE: ParamInfo = ParamInfo {
    name: "wedge",
    default: "exact",
    valid: "exact|paper3|paper4",
    summary: "penumbra wedges: the penumbra itself, or as papers III and IV build them; same bits",
};

const BUFFER: ParamInfo = ParamInfo {
    name: "buffer",
    default: "r32f",
    valid: "r32f|rgba8x2",
    summary: "visibility in a float, or 6 of 8 bits to add and to take",
};

const COPY_BACK: ParamInfo = ParamInfo {
    name: "copy-back",
    default: "off",
    valid: "on|off",
    summary: "with r32f: no float blending, each wedge reads, writes aside and copies back",
};

pub(super) const SPHERE: ParamInfo = ParamInfo {
    name: "sphere",
    default: "seen",
    valid: "seen|equator",
    summary: "a sphere as the disc that it looks like, or as one of its own radius",
};

impl Technique for SoftShadowVolumes {
    fn name(&self) -> &'static str {
        "soft-shadow-volumes"
    }

    fn summary(&self) -> &'static str {
        "soft shadows of rectangles, discs and spheres by penumbra wedges (paper III)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            WEDGE,
            BACKEND,
            TEXTURE_SIZE,
            TEXTURE_FILTER,
            TEXTURE_CENTRED,
            LIGHT_IMAGE,
            LIGHT_FRAME,
            BUFFER,
            COPY_BACK,
            SPHERE,
            HORIZON,
            OPEN_CASTERS,
            passes::LIGHT,
            SKIP,
            passes::SHADING,
            passes::COLOR_FORMAT,
            passes::DEPTH_FORMAT,
        ];
        PARAMS
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let mut recording = Recording::default();
        let targets = Targets::create(size, params, &mut recording)?;
        let positions = Positions::create(size, &mut recording)?;
        let buffers = Buffers::create(size, params, &mut recording)?;
        let draws = SceneDraws::new(scene, size, params);
        let casters = Casters::new(self.name(), scene, params)?;
        let lights = passes::lights(scene, params)?;
        let mut list = vec![draws.ambient_pass_with_positions(&targets, &positions)];
        let mut warnings = Vec::new();
        let mut coverings = Coverings::default();
        for &light in lights.iter().rev() {
            let seen = params.get(SPHERE.name) != "equator";
            let shape = &scene.lights[light];
            let soft = SoftLight::new(self.name(), shape, light, &draws.view, seen)?;
            let silhouettes = casters.silhouettes(soft.centre);
            let mut volumes = Volumes {
                view: &draws.view,
                targets: &targets,
                positions,
                buffers: &buffers,
                light: &soft,
                params,
                covering: coverings.of(self.name(), &soft, light, params, &mut recording)?,
            };
            let label = |what: &str| passes::label(what, light, &lights);
            list.push(volumes.count_pass(label("quads"), &silhouettes));
            list.extend(volumes.wedge_passes(&label("wedges"), &silhouettes, &mut warnings));
            list.extend(buffers.resolve_pass(label("resolve")));
            let image = light_image(params);
            let horizon = Horizon::wanted(self.name(), light, shape, image.is_some(), params)?;
            list.extend(horizon.pass(label("horizon"), &draws, &targets, buffers.visibility()));
            let test = LitTest::Visibility(buffers.visibility());
            list.push(draws.lit_pass(&targets, light, &label("lit"), test));
        }
        let mut frame = targets.frame(recording, list, buffers.visibility().output())?;
        frame.warnings = warnings;
        Ok(frame)
    }
}
