//! One part of a light, as passes: for each group of silhouettes the hard count, wedges,
//! and what the group hides.

use gnomon_raster::RenderPass;
use gnomon_shaders::split_volumes::resolve::{ResolveSplit, ResolveTo};

use super::buffers::Buffers;
use super::lookups::Lookups;
use super::settings::OptimisedSettings;
use super::volumes::{PartStatistics, PartVolumes};
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::visibility::Positions;
use crate::parts::wedges::soft::edges::SoftCasters;
use crate::parts::wedges::soft::light::SoftLight;
use crate::technique::{Pass, PassRole, TechniqueError};
use crate::world::light::Light;

/// One of the lights that a light is split into.
pub(super) struct PartOfLight<'a> {
    pub(super) technique: &'static str,
    pub(super) settings: &'a OptimisedSettings,
    pub(super) casters: &'a SoftCasters<'a>,
    pub(super) positions: Positions,
    pub(super) parts: &'a [Light],
    pub(super) part: usize,
}

impl PartOfLight<'_> {
    pub(super) fn passes(
        &self,
        turn: &mut LightTurn<'_, '_>,
        buffers: &mut Buffers,
        lookups: &mut Lookups,
        statistics: &mut PartStatistics,
    ) -> Result<Vec<Pass>, TechniqueError> {
        let (settings, view) = (self.settings, turn.view());
        let source = &self.parts[self.part];
        let (seen, reach) = (settings.soft.seen(), self.casters.size());
        let light = SoftLight::new(self.technique, source, turn.number, view, reach, seen)?;
        let loops = settings.groups(self.casters, &light);
        statistics.holes = statistics.holes.max(loops.holes);
        let mut groups = loops.silhouettes;
        if groups.is_empty() {
            groups.push(Default::default()); // nothing casts; the light is seen all the same
        }
        let covered = lookups.of(
            self.technique,
            &light,
            turn.number,
            settings,
            turn.recording,
        )?;
        let mut passes = Vec::new();
        for (number, group) in groups.iter().enumerate() {
            let volumes = PartVolumes {
                view,
                targets: turn.targets,
                positions: self.positions,
                split: buffers.split(),
                covered,
                light: &light,
                settings: &settings.soft,
                halves: settings.halves,
            };
            passes.push(volumes.count_pass(turn.label("quads"), group));
            passes.extend(volumes.wedge_passes(&turn.label("wedges"), group, statistics));
            let last = number + 1 == groups.len();
            for colour in 0..settings.colours() {
                passes.push(if last {
                    let resolve = self.resolve([colour, number], turn, buffers)?;
                    Pass::new(PassRole::Resolve, resolve)
                } else {
                    let combine = self.combine([colour, number], turn, buffers)?;
                    Pass::new(PassRole::Combine, combine)
                });
            }
        }
        Ok(passes)
    }

    /// After a group that is not the last.
    fn combine(
        &self,
        [colour, group]: [usize; 2],
        turn: &mut LightTurn<'_, '_>,
        buffers: &mut Buffers,
    ) -> Result<RenderPass, TechniqueError> {
        let shader = self.shader(group, false, ResolveTo::Groups);
        let label = turn.label("combine");
        buffers.group_pass(label, shader, [colour, group], turn.recording)
    }

    /// After the last group.
    fn resolve(
        &self,
        [colour, group]: [usize; 2],
        turn: &mut LightTurn<'_, '_>,
        buffers: &mut Buffers,
    ) -> Result<RenderPass, TechniqueError> {
        let (part, count) = (self.part, self.parts.len());
        let label = turn.label("resolve");
        if part + 1 < count {
            let shader = self.shader(group, part > 0, ResolveTo::Parts);
            return buffers.part_pass(label, shader, [colour, group, part], turn.recording);
        }
        let shares = self.settings.soft.horizon || self.settings.colours() > 1;
        let to = if shares {
            ResolveTo::Share(count as u32)
        } else {
            ResolveTo::Bytes(count as u32)
        };
        let shader = self.shader(group, part > 0, to);
        Ok(buffers.visibility_pass(label, shader, [colour, group, part]))
    }

    fn shader(&self, group: usize, added: bool, to: ResolveTo) -> ResolveSplit {
        ResolveSplit {
            rule: self.settings.combine,
            continued: group > 0,
            added,
            to,
        }
    }
}
