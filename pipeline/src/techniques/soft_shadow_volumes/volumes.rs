//! Quads and wedges as passes.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::ColorTargetState;
use gnomon_raster::{Draw, LoadOp, RenderPass, TextureBinding, TextureId};
use gnomon_shaders::soft_volumes::{CoverTo, Resolve};

use super::buffers::Buffers;
use crate::geometry::wedge::{Wedge, WedgeStatistics};
use crate::parts::passes::{Targets, View};
use crate::parts::visibility::{Positions, attachment, binding};
use crate::parts::wedges::soft::covering::Covering;
use crate::parts::wedges::soft::edges::Silhouettes;
use crate::parts::wedges::soft::light::SoftLight;
use crate::parts::wedges::soft::settings::SoftSettings;
use crate::parts::wedges::soft::wedges::{
    AreaStatistics, Note, WedgeArea, WedgePipeline, warnings_of,
};
use crate::technique::{DrawRole, Pass, PassRole, Warning};

/// Quads and wedges of one light.
pub(super) struct LightVolumes<'a> {
    pub(super) view: &'a View,
    pub(super) targets: &'a Targets,
    pub(super) positions: Positions,
    pub(super) buffers: &'a Buffers,
    pub(super) light: &'a SoftLight,
    pub(super) settings: &'a SoftSettings,
    pub(super) covering: Covering,
}

impl LightVolumes<'_> {
    /// Pass 2: one wedge after the other; copying back, two passes for each.
    pub(super) fn wedge_passes(
        &mut self,
        label: &str,
        silhouettes: &Silhouettes,
        warnings: &mut Vec<Warning>,
    ) -> Vec<Pass> {
        let construction = self.settings.construction;
        let mut statistics = WedgeStatistics::default();
        let mut areas = AreaStatistics::default();
        let mut passes = Vec::new();
        let mut draws = Vec::new();
        for side in &self.light.sides {
            for edge in &silhouettes.edges {
                let parts = Wedge::of_edge(construction, &side.area, edge.ends, &mut statistics);
                for part in parts.iter().filter(|_| edge.has_plane()) {
                    let area =
                        WedgeArea::new(self.view, construction, &side.area, part.edge, &mut areas);
                    let shader = |to| {
                        let plane = self.light.plane(edge);
                        self.covering.shader(side, side.edge(part.edge), plane, to)
                    };
                    match self.buffers.aside {
                        None => draws.extend(self.blended(&area, shader)),
                        Some(aside) => passes.extend(self.copied(label, &area, aside, shader)),
                    }
                }
            }
        }
        warnings.extend(warnings_of(label, &statistics, &areas));
        if self.buffers.aside.is_none() {
            let load = match self.buffers.cover_to() {
                CoverTo::RedGreen => LoadOp::Clear([0.0; 4]),
                _ => LoadOp::Load,
            };
            passes.push(self.pass(label, self.buffers.targets(), load, draws));
        }
        passes
    }

    fn pass(
        &self,
        label: &str,
        targets: Vec<TextureId>,
        load: LoadOp<[f32; 4]>,
        draws: Vec<(Draw, DrawRole)>,
    ) -> Pass {
        // A light before this one may have left its count there.
        let stencil = match self.buffers.cover_to() {
            CoverTo::RedGreen => LoadOp::Clear(0),
            _ => LoadOp::Load,
        };
        let pass = RenderPass {
            label: label.to_owned(),
            color: targets.into_iter().map(|t| attachment(t, load)).collect(),
            depth_stencil: self.targets.depth_stencil(LoadOp::Load, stencil),
            draws: Vec::new(),
        };
        Pass::with_draws(PassRole::Wedges, pass, draws)
    }

    fn blended(
        &self,
        area: &WedgeArea,
        shader: impl Fn(CoverTo) -> FragmentStage,
    ) -> Vec<(Draw, DrawRole)> {
        let pipeline = WedgePipeline {
            label: "penumbra",
            fragment: shader(self.buffers.cover_to()),
            targets: vec![ColorTargetState::ADDITIVE; self.buffers.targets().len()],
            textures: self.bindings(self.positions.texture),
            skip: self.settings.skip,
            note: Note::TakeAndRemove,
            role: DrawRole::Coverage,
        };
        area.draws(self.view, pipeline)
    }

    /// Reads visibility as a texture, writes the sum aside, copies it back.
    fn copied(
        &self,
        label: &str,
        area: &WedgeArea,
        aside: TextureId,
        shader: impl Fn(CoverTo) -> FragmentStage,
    ) -> [Pass; 2] {
        let visibility = self.buffers.visibility;
        let add = WedgePipeline {
            label: "penumbra aside",
            fragment: shader(CoverTo::Copied),
            targets: vec![ColorTargetState::OPAQUE],
            textures: self.bindings(visibility),
            skip: self.settings.skip,
            note: Note::Take,
            role: DrawRole::CoverageAside,
        };
        let copy = WedgePipeline {
            label: "copy back",
            fragment: Resolve::Copy.stage(),
            targets: vec![ColorTargetState::OPAQUE],
            textures: vec![binding(aside)],
            skip: self.settings.skip,
            note: Note::Remove,
            role: DrawRole::CopyBack,
        };
        let add = area.draws(self.view, add);
        let copy = area.draws(self.view, copy);
        [
            self.pass(label, vec![aside], LoadOp::Load, add),
            self.pass(label, vec![visibility], LoadOp::Load, copy),
        ]
    }

    /// Positions, `second`, and the coverage table where there is one.
    fn bindings(&self, second: TextureId) -> Vec<TextureBinding> {
        let mut slots = vec![binding(self.positions.texture), binding(second)];
        slots.extend(self.covering.textures().map(binding));
        slots
    }
}
