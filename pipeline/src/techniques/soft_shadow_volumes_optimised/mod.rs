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
//!   and side are one expression on one position (as in `soft-shadow-volumes`),
//!   and a wedge need not be drawn in halves. With `halves=on` it is: one buffer
//!   after the other, for less colour traffic and more draws.
//! * Carry bits hold [`gnomon_shaders::split_volumes::CAPACITY`] full contributions
//!   for certain; the counters tell where a channel saturated.

mod buffers;
mod lookups;
mod volumes;

use gnomon_shaders::split_volumes::{AddVisibility, Combination, Tables};

use crate::geometry::wedge::Construction;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::Positions;
use crate::parts::volumes::light_contacts;
use crate::parts::wedges::soft::edges::{Silhouettes, SoftCasters};
use crate::parts::wedges::soft::light::{SoftLight, split};
use crate::parts::wedges::soft::settings::{SOFT_LIGHTS, SoftSettings, WEDGE};
use crate::parts::wedges::soft::wedges::warnings_of;
use crate::technique::{
    Capabilities, Choice, Condition, Frame, LightFact, Param, ParamInfo, Params, Pass, PassRole,
    SceneWedges, ShadowKind, Technique, TechniqueError, Value, WedgeUse,
};
use crate::world::light::Light;
use crate::world::scene::Scene;
use crate::{choices, param_list};
use buffers::Buffers;
use lookups::Lookups;
use volumes::{PartStatistics, PartVolumes};

/// The registry's entry.
pub(crate) struct SoftShadowVolumesOptimised;

const WEDGE_TIGHT: Param<Construction> = WEDGE.with_default(Value::Word("paper4"));

choices! {
    /// Computed, or looked up in textures.
    enum Computed {
        /// By the shader.
        Arithmetic = "arithmetic",
        /// From a texture.
        Lut = "lut",
    }
}

const EXTENDED: Condition = Condition::Lights(LightFact::Extended);

const COVERAGE: Param<Computed> = Param::choice(
    "coverage",
    Computed::Arithmetic.word(),
    "coverage computed, or from the paper's angle cube and area map",
)
.when(EXTENDED);

const SPLIT_BITS: Param<Computed> = Param::choice(
    "split-bits",
    Computed::Arithmetic.word(),
    "12 bits of coverage split by arithmetic, or by a 1024-entry map that leaves 10",
)
.when(EXTENDED);

impl Choice for Combination {
    const NAMES: &'static [&'static str] = &["sum", "paper", "bounded"];
    const ALL: &'static [Self] = &[Self::Sum, Self::Paper, Self::Bounded];
}

const COMBINE: Param<Combination> = Param::choice(
    "combine",
    "sum",
    "silhouettes: summed, max + min/2 one after the other, or half way from max to sum",
);

choices! {
    /// What is combined.
    enum CombineOver {
        /// Outlines with their holes.
        Outline = "outline",
        /// All of a caster's.
        Caster = "caster",
    }
}

const COMBINE_OVER: Param<CombineOver> = Param::choice(
    "combine-over",
    CombineOver::Outline.word(),
    "what is combined unless summed: outlines with their holes, or all of a caster's",
)
.when(Condition::Not("combine", &["sum"]));

const SPLIT: Param<u32> = Param::<u32>::whole(
    "split",
    1,
    [1, 8],
    "k: a rectangle as k x k lights, each with its own silhouettes and wedges",
);

const HALVES: Param<bool> = Param::switch(
    "halves",
    false,
    "inner and outer halves of wedges apart, each culled and to one buffer; same bits",
)
.when(EXTENDED);

/// What parameters decide.
struct OptimisedSettings {
    tables: Tables,
    combine: Combination,
    over: CombineOver,
    split: u32,
    halves: bool,
    soft: SoftSettings,
}

impl OptimisedSettings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            tables: Tables {
                coverage: params.get(&COVERAGE)? == Computed::Lut,
                split: params.get(&SPLIT_BITS)? == Computed::Lut,
            },
            combine: params.get(&COMBINE)?,
            over: params.get(&COMBINE_OVER)?,
            split: params.get(&SPLIT)?,
            halves: params.get(&HALVES)?,
            soft: SoftSettings::read(params)?,
        })
    }

    /// The silhouettes that are combined, seen from the middle of a light.
    fn groups(&self, casters: &SoftCasters<'_>, light: &SoftLight) -> Vec<Silhouettes> {
        match (self.combine, self.over) {
            (Combination::Sum, _) => vec![casters.silhouettes(light.centre)],
            (_, CombineOver::Caster) => casters.each(light.centre),
            (_, CombineOver::Outline) => casters.outlines(light.centre),
        }
    }
}

impl Technique for SoftShadowVolumesOptimised {
    fn name(&self) -> &'static str {
        "soft-shadow-volumes-optimised"
    }

    fn summary(&self) -> &'static str {
        "soft shadows by tight wedges, 12 bits in 8-bit buffers, split lights (paper IV)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[
                WEDGE_TIGHT.info,
                COVERAGE.info,
                SPLIT_BITS.info,
                COMBINE.info,
                COMBINE_OVER.info,
                SPLIT.info,
                HALVES.info,
            ],
            SoftSettings::PARAMS,
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            wedges: WedgeUse::Single,
            lights: SOFT_LIGHTS,
            ..Capabilities::of_silhouettes(ShadowKind::Soft)
        }
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = OptimisedSettings::read(params)?;
        let soft = settings.soft;
        let casters = SoftCasters::new(scene, size, soft.open_casters)?;
        let frame = ShadowedFrame::new(scene, size, &soft.frame)?;
        let frame = frame.with_horizon(self.name(), soft.horizon, false);
        let (mut frame, positions) = frame.with_positions()?;
        let buffers = Buffers::create(size, &mut frame.recording)?;
        let mut lookups = Lookups::default();
        frame.lit(LitTest::Visibility(buffers.visibility()), |turn| {
            let (light, number) = (turn.light(), turn.number);
            let contact = light_contacts::warning(scene, number);
            turn.notes.warnings.extend(contact);
            let parts = split(self.name(), light, number, settings.split)?;
            let mut passes = Vec::new();
            let mut statistics = PartStatistics::default();
            for part in 0..parts.len() {
                let of = PartOfLight {
                    technique: self.name(),
                    settings: &settings,
                    casters: &casters,
                    positions,
                    buffers: &buffers,
                    parts: &parts,
                    part,
                };
                passes.extend(of.passes(turn, &mut lookups, &mut statistics)?);
            }
            let label = turn.label("wedges");
            let warnings = warnings_of(&label, &statistics.wedges, &statistics.areas);
            turn.notes.warnings.extend(warnings);
            Ok(passes)
        })
    }

    fn wedges(
        &self,
        scene: &Scene,
        params: &Params,
    ) -> Result<Option<SceneWedges>, TechniqueError> {
        let settings = OptimisedSettings::read(params)?;
        let wedges = settings
            .soft
            .scene_wedges(self.name(), scene, settings.split)?;
        Ok(Some(wedges))
    }
}

/// One of the lights that a light is split into.
struct PartOfLight<'a> {
    technique: &'static str,
    settings: &'a OptimisedSettings,
    casters: &'a SoftCasters<'a>,
    positions: Positions,
    buffers: &'a Buffers,
    parts: &'a [Light],
    part: usize,
}

impl PartOfLight<'_> {
    fn passes(
        &self,
        turn: &mut LightTurn<'_, '_>,
        lookups: &mut Lookups,
        statistics: &mut PartStatistics,
    ) -> Result<Vec<Pass>, TechniqueError> {
        let (settings, view) = (self.settings, turn.view());
        let source = &self.parts[self.part];
        let seen = settings.soft.seen();
        let reach = self.casters.size();
        let light = SoftLight::new(self.technique, source, turn.number, view, reach, seen)?;
        let groups = settings.groups(self.casters, &light);
        let volumes = PartVolumes {
            view,
            targets: turn.targets,
            positions: self.positions,
            buffers: self.buffers,
            tables: lookups.of(&light, settings.tables, turn.recording)?,
            light: &light,
            settings: &settings.soft,
            halves: settings.halves,
        };
        let mut passes = Vec::new();
        for (number, group) in groups.iter().enumerate() {
            passes.push(volumes.count_pass(turn.label("quads"), group));
            passes.extend(volumes.wedge_passes(&turn.label("wedges"), group, statistics));
            let combine = self.buffers.combine_pass(turn.label("combine"), number);
            passes.push(Pass::new(PassRole::Combine, combine));
        }
        let add = AddVisibility {
            rule: settings.combine,
            weight: 1.0 / self.parts.len() as f32,
        };
        let label = turn.label("resolve");
        let resolve = self.buffers.add_pass(label, groups.len(), add, self.part);
        passes.push(Pass::new(PassRole::Resolve, resolve));
        Ok(passes)
    }
}
