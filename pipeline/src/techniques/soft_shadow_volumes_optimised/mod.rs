//! Soft shadow volumes, optimised (paper IV; docs/papers.md, paper IV): tight wedges, a
//! shader that computes coverage or looks it up, 12 bits of coverage split over
//! 8-bit buffers, silhouettes combined, and lights split.
//!
//! Per sub-light and group of silhouettes: hard count, wedges, and a pass that adds
//! what the group hides to what others do. With `combine=sum` all casters are one
//! group; otherwise each outline is one, with its holes, or each caster.
//! The light's visibility is the mean over the sub-lights.
//!
//! # Departures from the paper, and why
//!
//! * Both 8-bit buffers are attached at once and the shader chooses by the side of
//!   the hard quad, which the paper had to leave for want of precision: here count
//!   and side are one expression on one position ([`super::soft_shadow_volumes`]),
//!   and a wedge need not be drawn in halves. With `halves=on` it is: one buffer
//!   after the other, for less colour traffic and more draws.
//! * Carry bits hold [`gnomon_shaders::split_volumes::CAPACITY`] full contributions
//!   for certain; the counters tell where a channel saturated.

mod buffers;
mod lookups;
mod volumes;

use gnomon_raster::Recording;
use gnomon_shaders::split_volumes::{AddVisibility, Combination};

use super::soft_shadow_volumes::SPHERE;
use crate::parts::casters::{OPEN_CASTERS, SKIP};
use crate::parts::horizon::{HORIZON, Horizon};
use crate::parts::passes::{self, LitTest, SceneDraws, Targets};
use crate::parts::visibility::Positions;
use crate::parts::wedges::soft::edges::Casters;
use crate::parts::wedges::soft::light::{SoftLight, split};
use crate::parts::wedges::soft::wedges::warnings_of;
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError};
use crate::world::scene::Scene;
use buffers::Buffers;
use lookups::Lookups;
use volumes::{Met, Volumes};

/// The registry's entry.
pub(crate) struct SoftShadowVolumesOptimised;

const WEDGE: ParamInfo = ParamInfo {
    default: "paper4",
    ..super::soft_shadow_volumes::WEDGE
};

const COVERAGE: ParamInfo = ParamInfo {
    name: "coverage",
    default: "arithmetic",
    valid: "arithmetic|lut",
    summary: "coverage computed, or from the paper's angle cube and area map",
};

const SPLIT_BITS: ParamInfo = ParamInfo {
    name: "split-bits",
    default: "arithmetic",
    valid: "arithmetic|lut",
    summary: "12 bits of coverage split by arithmetic, or by a 1024-entry map that leaves 10",
};

const COMBINE: ParamInfo = ParamInfo {
    name: "combine",
    default: "sum",
    valid: "sum|paper|bounded",
    summary: "silhouettes: summed, max + min/2 one after the other, or half way from max to sum",
};

const COMBINE_OVER: ParamInfo = ParamInfo {
    name: "combine-over",
    default: "outline",
    valid: "outline|caster",
    summary: "what is combined unless summed: outlines with their holes, or all of a caster's",
};

pub(super) const SPLIT: ParamInfo = ParamInfo {
    name: "split",
    default: "1",
    valid: "1|2|3|4|5|6|7|8",
    summary: "k: a rectangle as k x k lights, each with its own silhouettes and wedges",
};

const HALVES: ParamInfo = ParamInfo {
    name: "halves",
    default: "off",
    valid: "on|off",
    summary: "inner and outer halves of wedges apart, each culled and to one buffer; same bits",
};

impl Technique for SoftShadowVolumesOptimised {
    fn name(&self) -> &'static str {
        "soft-shadow-volumes-optimised"
    }

    fn summary(&self) -> &'static str {
        "soft shadows by tight wedges, 12 bits in 8-bit buffers, split lights (paper IV)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            WEDGE,
            COVERAGE,
            SPLIT_BITS,
            COMBINE,
            COMBINE_OVER,
            SPLIT,
            HALVES,
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
        let buffers = Buffers::create(size, &mut recording)?;
        let draws = SceneDraws::new(scene, size, params);
        let casters = Casters::new(self.name(), scene, params)?;
        let lights = passes::lights(scene, params)?;
        let mut list = vec![draws.ambient_pass_with_positions(&targets, &positions)];
        let mut warnings = Vec::new();
        let mut lookups = Lookups::default();
        for &number in lights.iter().rev() {
            let k = params.get(SPLIT.name).parse().unwrap_or(1);
            let parts = split(self.name(), &scene.lights[number], number, k)?;
            let weight = 1.0 / parts.len() as f32;
            let mut met = Met::default();
            for (turn, part) in parts.iter().enumerate() {
                let seen = params.get(SPHERE.name) != "equator";
                let light = SoftLight::new(self.name(), part, number, &draws.view, seen)?;
                let groups = match combination(params) {
                    Combination::Sum => vec![casters.silhouettes(light.centre)],
                    _ if params.get(COMBINE_OVER.name) == "caster" => casters.each(light.centre),
                    _ => casters.outlines(light.centre),
                };
                let volumes = Volumes {
                    view: &draws.view,
                    targets: &targets,
                    positions,
                    buffers: &buffers,
                    tables: lookups.of(&light, params, &mut recording)?,
                    light: &light,
                    params,
                };
                let label = |what: &str| passes::label(what, number, &lights);
                for (turn, group) in groups.iter().enumerate() {
                    list.push(volumes.count_pass(label("quads"), group));
                    list.extend(volumes.wedge_passes(&label("wedges"), group, &mut met));
                    list.push(buffers.combine_pass(label("combine"), turn));
                }
                let add = AddVisibility {
                    rule: combination(params),
                    weight,
                };
                list.push(buffers.add_pass(label("resolve"), groups.len(), add, turn));
            }
            let label = |what: &str| passes::label(what, number, &lights);
            warnings.extend(warnings_of(&label("wedges"), &met.wedges, &met.areas));
            let light = &scene.lights[number];
            let horizon = Horizon::wanted(self.name(), number, light, false, params)?;
            list.extend(horizon.pass(label("horizon"), &draws, &targets, buffers.visibility()));
            let visibility = LitTest::Visibility(buffers.visibility());
            list.push(draws.lit_pass(&targets, number, &label("lit"), visibility));
        }
        let mut frame = targets.frame(recording, list, buffers.visibility().output())?;
        frame.warnings = warnings;
        Ok(frame)
    }
}

fn combination(params: &Params) -> Combination {
    match params.get(COMBINE.name) {
        "paper" => Combination::Paper,
        "bounded" => Combination::Bounded,
        _ => Combination::Sum,
    }
}
