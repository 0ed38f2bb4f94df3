//! Quads and wedges of one part of a light as passes.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::ColorTargetState;
use gnomon_raster::{Draw, LoadOp, RenderPass, TextureId};
use gnomon_shaders::coverage::Edge;
use gnomon_shaders::soft_volumes::HardPlane;
use gnomon_shaders::split_volumes::{Halves, SplitPenumbra};

use super::lookups::Covered;

use crate::geometry::wedge::{Wedge, WedgeStatistics};
use crate::parts::passes::{Targets, View};
use crate::parts::visibility::{Positions, attachment, binding};
use crate::parts::wedges::soft::edges::Silhouettes;
use crate::parts::wedges::soft::halves::Half;
use crate::parts::wedges::soft::light::{LightSide, SoftLight};
use crate::parts::wedges::soft::settings::SoftSettings;
use crate::parts::wedges::soft::stencil_count::StencilCounting;
use crate::parts::wedges::soft::wedges::{AreaStatistics, Note, WedgeArea, WedgePipeline};
use crate::technique::{DrawRole, Pass, PassRole, Warning};

/// What became of the wedges of all parts of a light.
#[derive(Default)]
pub(super) struct PartStatistics {
    pub(super) wedges: WedgeStatistics,
    pub(super) areas: AreaStatistics,
    /// Loops round holes that are combined, at most of any part.
    pub(super) holes: u64,
}

impl PartStatistics {
    /// Says that holes are filled, if some are.
    pub(super) fn hole_warning(&self, label: &str) -> Option<Warning> {
        (self.holes != 0).then(|| Warning {
            code: "loops-round-holes",
            count: self.holes as usize,
            message: format!(
                "{label}: {} silhouette loops run round holes, which combine-over=loop fills; \
                 combine-over=outline keeps them",
                self.holes
            ),
        })
    }
}

/// Quads and wedges of one part of a light.
pub(super) struct PartVolumes<'a> {
    pub(super) view: &'a View,
    pub(super) targets: &'a Targets,
    pub(super) positions: Positions,
    /// The additive and the subtractive buffer of each colour.
    pub(super) split: Vec<[TextureId; 2]>,
    pub(super) covered: Covered,
    pub(super) light: &'a SoftLight,
    pub(super) settings: &'a SoftSettings,
    /// Draw halves of wedges apart.
    pub(super) halves: bool,
}

impl PartVolumes<'_> {
    pub(super) fn count_pass(&self, label: String, group: &Silhouettes) -> Pass {
        let counting = StencilCounting {
            view: self.view,
            positions: self.positions,
            light: self.light,
            skip: self.settings.skip,
        };
        let pass = RenderPass {
            label,
            color: Vec::new(),
            depth_stencil: self.targets.depth_stencil(LoadOp::Load, LoadOp::Clear(0)),
            draws: counting.draws(group),
        };
        Pass::new(PassRole::HardCount, pass)
    }

    /// Both buffers at once, or one after the other with the half that it takes.
    pub(super) fn wedge_passes(
        &self,
        label: &str,
        group: &Silhouettes,
        statistics: &mut PartStatistics,
    ) -> Vec<Pass> {
        // A light without extent has no wedges to halve.
        let halves = self.halves && !self.light.sides.is_empty();
        if let (false, [both]) = (halves, &self.split[..]) {
            let to = WedgeTarget {
                buffers: both.to_vec(),
                half: None,
                halves: Halves::Both,
            };
            return vec![self.wedge_pass(label, group, &to, statistics)];
        }
        let of = |half, halves_of, k: usize| WedgeTarget {
            buffers: self.split.iter().map(|pair| pair[k]).collect(),
            half: halves.then_some(half),
            halves: halves_of,
        };
        let [inner, outer] = [
            of(Half::Inner, Halves::Inner, 0),
            of(Half::Outer, Halves::Outer, 1),
        ];
        let inner = self.wedge_pass(label, group, &inner, statistics);
        // The edges are the same; they are counted once.
        let mut of_outer = PartStatistics {
            areas: statistics.areas,
            ..PartStatistics::default()
        };
        let outer = self.wedge_pass(label, group, &outer, &mut of_outer);
        statistics.areas = of_outer.areas;
        vec![inner, outer]
    }

    fn wedge_pass(
        &self,
        label: &str,
        group: &Silhouettes,
        to: &WedgeTarget,
        statistics: &mut PartStatistics,
    ) -> Pass {
        let construction = self.settings.construction;
        let mut draws = Vec::new();
        for side in &self.light.sides {
            for edge in group.edges.iter().filter(|e| e.has_plane()) {
                let wedges = &mut statistics.wedges;
                let parts = Wedge::of_edge(construction, &side.area, edge.ends, wedges);
                for part in parts {
                    let (view, light, areas) = (self.view, &side.area, &mut statistics.areas);
                    let area = match to.half {
                        None => WedgeArea::new(view, construction, light, part.edge, areas),
                        Some(h) => WedgeArea::half(view, construction, light, part.edge, h, areas),
                    };
                    draws.extend(self.wedge(side, &part, self.light.plane(edge), &area, to));
                }
            }
        }
        let clear = LoadOp::Clear([0.0; 4]);
        let buffers = to.buffers.iter();
        let pass = RenderPass {
            label: label.to_owned(),
            color: buffers.map(|t| attachment(*t, clear)).collect(),
            depth_stencil: self.targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws: Vec::new(),
        };
        Pass::with_draws(PassRole::Wedges, pass, draws)
    }

    fn wedge(
        &self,
        side: &LightSide,
        part: &Wedge,
        plane: HardPlane,
        area: &WedgeArea,
        to: &WedgeTarget,
    ) -> Vec<(Draw, DrawRole)> {
        let (fragment, lookups) = self.shader(side, side.edge(part.edge), plane, to);
        let textures = [self.positions.texture].into_iter().chain(lookups);
        let pipeline = WedgePipeline {
            label: "penumbra",
            fragment,
            targets: vec![ColorTargetState::ADDITIVE; to.buffers.len()],
            textures: textures.map(binding).collect(),
            skip: self.settings.skip,
            note: Note::TakeAndRemove,
            role: DrawRole::Coverage,
        };
        area.draws(self.view, pipeline)
    }

    /// The shader of an edge, and the textures that it reads behind positions.
    fn shader(
        &self,
        side: &LightSide,
        edge: Edge,
        plane: HardPlane,
        to: &WedgeTarget,
    ) -> (FragmentStage, Vec<TextureId>) {
        let (light, halves) = (side.projector, to.halves);
        match self.covered {
            Covered::Split(tables) => {
                let shader = SplitPenumbra {
                    light,
                    edge,
                    plane,
                    tables: tables.map(|(tables, _)| tables).unwrap_or_default(),
                    halves,
                };
                let textures = tables.iter().flat_map(|(_, textures)| *textures);
                (shader.stage(), textures.collect())
            }
            Covered::Textured(covering) => {
                let colors = self.split.len() as u32;
                let shader = covering.split_shader(side, edge, plane, halves, colors);
                // In the second slot something that is not read.
                let textures = [self.positions.texture].into_iter();
                (shader, textures.chain(covering.textures()).collect())
            }
        }
    }
}

/// Where wedges are drawn to, and what of them.
struct WedgeTarget {
    buffers: Vec<TextureId>,
    /// Whole wedges where there is none.
    half: Option<Half>,
    /// What fragments are for these buffers.
    halves: Halves,
}
