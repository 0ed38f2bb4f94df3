//! Soft shadow volumes, optimised (paper IV; IMPLEMENTING §1.5): tight wedges, a
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

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Draw, Format, LoadOp, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::coverage::Image;
use gnomon_shaders::soft_volumes::{CountTo, HardPlane};
use gnomon_shaders::split_volumes::{
    AddVisibility, Combination, CombineGroups, Halves, SplitPenumbra, Tables,
};
use gnomon_shaders::transform::FullScreen;

use super::casters::{OPEN_CASTERS, SKIP};
use super::passes::{self, LitTest, SceneDraws, Targets, View};
use super::soft::count::Counting;
use super::soft::edges::{Casters, Silhouettes};
use super::soft::halves::Half;
use super::soft::horizon::{self, HORIZON};
use super::soft::light::{LightSide, SoftLight, split};
use super::soft::split_tables;
use super::soft::wedges::{
    AreaStatistics, Note, WedgeArea, WedgePipeline, construction, warnings_of,
};
use super::soft_shadow_volumes::SPHERE;
use super::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::scene::Scene;
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError, TextureSource};
use crate::wedge::{Wedge, WedgeStatistics};
use crate::wedge_work::COVERAGE_DRAW;

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
        textures: &mut dyn TextureSource,
    ) -> Result<Frame, TechniqueError> {
        let targets = Targets::create(size, params, textures)?;
        let positions = Positions::create(size, textures)?;
        let buffers = Buffers::create(size, textures)?;
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
                    tables: lookups.of(&light, params, textures)?,
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
            let seen = params.get(SPHERE.name) != "equator";
            let whole = SoftLight::new(
                self.name(),
                &scene.lights[number],
                number,
                &draws.view,
                seen,
            )?;
            if horizon::wanted(self.name(), number, &whole, None, params)? {
                let (label, visibility) = (label("horizon"), buffers.visibility());
                list.extend(horizon::pass(label, &draws, &targets, &whole, visibility));
            }
            let visibility = LitTest::Visibility(buffers.visibility());
            list.push(draws.lit_pass(&targets, number, &label("lit"), visibility));
        }
        let mut frame = targets.frame(list, buffers.visibility().output());
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

/// Look-up textures of the lights of a frame, one set for each shape.
#[derive(Default)]
struct Lookups(Vec<(Image, [TextureId; 3])>);

impl Lookups {
    /// Those of a light, where some are asked for.
    fn of(
        &mut self,
        light: &SoftLight,
        params: &Params,
        textures: &mut dyn TextureSource,
    ) -> Result<Option<(Tables, [TextureId; 3])>, TechniqueError> {
        let tables = Tables {
            coverage: params.get(COVERAGE.name) == "lut",
            split: params.get(SPLIT_BITS.name) == "lut",
        };
        let Some(side) = light.sides.first().filter(|_| tables != Tables::default()) else {
            return Ok(None);
        };
        let shape = side.projector.image();
        if let Some((_, made)) = self.0.iter().find(|(of, _)| *of == shape) {
            return Ok(Some((tables, *made)));
        }
        let made = split_tables::create(shape, textures)?;
        self.0.push((shape, made));
        Ok(Some((tables, made)))
    }
}

/// What wedges of all parts of a light met.
#[derive(Default)]
struct Met {
    wedges: WedgeStatistics,
    areas: AreaStatistics,
}

/// Textures that coverage is added up in.
struct Buffers {
    /// The hard count of a group: 1 minus it.
    hard: TextureId,
    /// Additive and subtractive coverage of a group.
    split: [TextureId; 2],
    /// What groups hide, before and after the last.
    combined: [TextureId; 2],
    /// Visibility of the light.
    visibility: TextureId,
}

impl Buffers {
    fn create(
        [width, height]: [u32; 2],
        textures: &mut dyn TextureSource,
    ) -> Result<Self, TechniqueError> {
        let mut create = |label: &str, format| {
            textures.create(&TextureDescriptor::d2(label, format, width, height))
        };
        Ok(Self {
            hard: create("hard count", Format::R32Float)?,
            split: [
                create("coverage added", Format::Rgba8Unorm)?,
                create("coverage taken", Format::Rgba8Unorm)?,
            ],
            combined: [
                create("hidden", Format::Rgba32Float)?,
                create("hidden before", Format::Rgba32Float)?,
            ],
            visibility: create("visibility", Format::R32Float)?,
        })
    }

    fn visibility(&self) -> VisibilityTexture {
        VisibilityTexture::red(self.visibility)
    }

    /// After group number `turn`; the first finds nothing hidden before it.
    fn combine_pass(&self, label: String, turn: usize) -> RenderPass {
        let [to, before] = [turn % 2, (turn + 1) % 2].map(|k| self.combined[k]);
        let shader = CombineGroups { first: turn == 0 };
        let sources = [self.hard, self.split[0], self.split[1], before].map(binding);
        let pipeline = over_screen(&label, shader.stage(), ColorTargetState::OPAQUE);
        RenderPass {
            label,
            color: vec![attachment(to, LoadOp::DontCare)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, sources.to_vec())],
        }
    }

    /// Adds a part's visibility after `groups` groups.
    fn add_pass(
        &self,
        label: String,
        groups: usize,
        add: AddVisibility,
        turn: usize,
    ) -> RenderPass {
        let last = self.combined[(groups + 1) % 2];
        let pipeline = over_screen(&label, add.stage(), ColorTargetState::ADDITIVE);
        let load = if turn == 0 {
            LoadOp::Clear([0.0; 4])
        } else {
            LoadOp::Load
        };
        RenderPass {
            label,
            color: vec![attachment(self.visibility, load)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, vec![binding(last)])],
        }
    }
}

fn over_screen(label: &str, fragment: FragmentStage, target: ColorTargetState) -> RenderPipeline {
    RenderPipeline {
        label: label.to_owned(),
        vertex: FullScreen.stage(),
        fragment: Some(fragment),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![target],
    }
}

/// Quads and wedges of one part of a light.
struct Volumes<'a> {
    view: &'a View,
    targets: &'a Targets,
    positions: Positions,
    buffers: &'a Buffers,
    tables: Option<(Tables, [TextureId; 3])>,
    light: &'a SoftLight,
    params: &'a Params,
}

impl Volumes<'_> {
    fn count_pass(&self, label: String, group: &Silhouettes) -> RenderPass {
        let counting = Counting {
            view: self.view,
            positions: self.positions,
            centre: self.light.centre,
            to: CountTo::Visibility,
        };
        RenderPass {
            label,
            color: vec![attachment(self.buffers.hard, LoadOp::Clear([1.0; 4]))],
            depth_stencil: None,
            draws: counting.draws(group),
        }
    }

    /// Both buffers at once, or one after the other with the half that it takes.
    fn wedge_passes(&self, label: &str, group: &Silhouettes, met: &mut Met) -> Vec<RenderPass> {
        let [added, taken] = self.buffers.split;
        if self.params.get(HALVES.name) != "on" {
            let to = WedgeTarget {
                buffers: vec![added, taken],
                half: None,
            };
            return vec![self.wedge_pass(label, group, &to, met)];
        }
        let of = |half, buffer| WedgeTarget {
            buffers: vec![buffer],
            half: Some(half),
        };
        let inner = self.wedge_pass(label, group, &of(Half::Inner, added), met);
        // The edges are the same; they are counted once.
        let mut outer_met = Met {
            areas: met.areas,
            ..Met::default()
        };
        let outer = self.wedge_pass(label, group, &of(Half::Outer, taken), &mut outer_met);
        met.areas = outer_met.areas;
        vec![inner, outer]
    }

    fn wedge_pass(
        &self,
        label: &str,
        group: &Silhouettes,
        to: &WedgeTarget,
        met: &mut Met,
    ) -> RenderPass {
        let construction = construction(self.params);
        let mut draws = Vec::new();
        for side in &self.light.sides {
            for edge in group.edges.iter().filter(|e| e.has_plane()) {
                let parts = Wedge::of_edge(construction, &side.area, edge.ends, &mut met.wedges);
                for part in parts {
                    let (view, light, areas) = (self.view, &side.area, &mut met.areas);
                    let area = match to.half {
                        None => WedgeArea::new(view, construction, light, part.edge, areas),
                        Some(h) => WedgeArea::half(view, construction, light, part.edge, h, areas),
                    };
                    draws.extend(self.wedge(side, &part, HardPlane(edge.normal), &area, to));
                }
            }
        }
        let clear = LoadOp::Clear([0.0; 4]);
        let buffers = to.buffers.iter();
        RenderPass {
            label: label.to_owned(),
            color: buffers.map(|t| attachment(*t, clear)).collect(),
            depth_stencil: self.targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws,
        }
    }

    fn wedge(
        &self,
        side: &LightSide,
        part: &Wedge,
        plane: HardPlane,
        area: &WedgeArea,
        to: &WedgeTarget,
    ) -> Vec<Draw> {
        let shader = SplitPenumbra {
            light: side.projector,
            edge: side.edge(part.edge),
            plane,
            tables: self.tables.map(|(tables, _)| tables).unwrap_or_default(),
            halves: match to.half {
                None => Halves::Both,
                Some(Half::Inner) => Halves::Inner,
                Some(Half::Outer) => Halves::Outer,
            },
        };
        let lookups = self.tables.iter().flat_map(|(_, textures)| textures);
        let textures = [self.positions.texture].into_iter().chain(lookups.copied());
        let pipeline = WedgePipeline {
            label: COVERAGE_DRAW,
            fragment: shader.stage(),
            targets: vec![ColorTargetState::ADDITIVE; to.buffers.len()],
            textures: textures.map(binding).collect(),
            skip: self.params.get(SKIP.name) != "off",
            note: Note::TakeAndRemove,
        };
        area.draws(self.view, pipeline)
    }
}

/// Where wedges are drawn to, and what of them.
struct WedgeTarget {
    buffers: Vec<TextureId>,
    /// Whole wedges where there is none.
    half: Option<Half>,
}
