//! Soft shadow volumes (Assarsson and Akenine-Möller, paper III; IMPLEMENTING
//! §0.1 and §1.4).
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

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Draw, Format, LoadOp, RenderPass, RenderPipeline, TextureBinding, TextureDescriptor, TextureId,
};
use gnomon_shaders::soft_volumes::{CountTo, CoverTo, HardPlane, Resolve};
use gnomon_shaders::transform::FullScreen;

use super::casters::{OPEN_CASTERS, SKIP};
use super::horizon::{HORIZON, Horizon};
use super::passes::{self, LitTest, SceneDraws, Targets, View};
use super::soft::count::Counting;
use super::soft::covering::{
    BACKEND, Covering, Coverings, LIGHT_FRAME, LIGHT_IMAGE, TEXTURE_CENTRED, TEXTURE_FILTER,
    TEXTURE_SIZE, light_image,
};
use super::soft::edges::{Casters, Silhouettes};
use super::soft::light::SoftLight;
use super::soft::wedges::{
    AreaStatistics, Note, WedgeArea, WedgePipeline, construction, warnings_of,
};
use super::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::scene::Scene;
use crate::technique::{
    Frame, ParamInfo, Params, Technique, TechniqueError, TextureSource, Warning,
};
use crate::wedge::{Wedge, WedgeStatistics};
use crate::wedge_work::COVERAGE_DRAW;

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
        textures: &mut dyn TextureSource,
    ) -> Result<Frame, TechniqueError> {
        let targets = Targets::create(size, params, textures)?;
        let positions = Positions::create(size, textures)?;
        let buffers = Buffers::create(size, params, textures)?;
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
                covering: coverings.of(self.name(), &soft, light, params, textures)?,
            };
            let label = |what: &str| passes::label(what, light, &lights);
            list.push(volumes.count_pass(label("quads"), &silhouettes));
            list.extend(volumes.wedge_passes(&label("wedges"), &silhouettes, &mut warnings));
            list.extend(buffers.resolve_pass(label("resolve")));
            let image = light_image(params).is_some();
            let horizon = Horizon::wanted(self.name(), light, shape, image, params)?;
            let limit =
                |h: Horizon| h.pass(label("horizon"), &draws, &targets, buffers.visibility());
            list.extend(horizon.and_then(limit));
            let test = LitTest::Visibility(buffers.visibility());
            list.push(draws.lit_pass(&targets, light, &label("lit"), test));
        }
        let mut frame = targets.frame(list, buffers.visibility().output());
        frame.warnings = warnings;
        Ok(frame)
    }
}

/// Textures that coverage is added up in.
struct Buffers {
    /// Red, green and blue apart.
    coloured: bool,
    /// Visibility, float.
    visibility: TextureId,
    /// For copying back, of the same kind.
    aside: Option<TextureId>,
    /// Coverage to add and to take, 8 bits a channel.
    six_bits: Option<[TextureId; 2]>,
}

impl Buffers {
    fn create(
        [width, height]: [u32; 2],
        params: &Params,
        textures: &mut dyn TextureSource,
    ) -> Result<Self, TechniqueError> {
        let mut create = |label: &str, format| {
            textures.create(&TextureDescriptor::d2(label, format, width, height))
        };
        let bytes = params.get(BUFFER.name) == "rgba8x2";
        let aside = !bytes && params.get(COPY_BACK.name) == "on";
        let coloured = light_image(params).is_some();
        let float = if coloured {
            Format::Rgba32Float
        } else {
            Format::R32Float
        };
        Ok(Self {
            coloured,
            visibility: create("visibility", float)?,
            aside: if aside {
                Some(create("visibility aside", float)?)
            } else {
                None
            },
            six_bits: if bytes {
                Some([
                    create("coverage added", Format::Rgba8Unorm)?,
                    create("coverage taken", Format::Rgba8Unorm)?,
                ])
            } else {
                None
            },
        })
    }

    fn visibility(&self) -> VisibilityTexture {
        VisibilityTexture {
            coloured: self.coloured,
            ..VisibilityTexture::red(self.visibility)
        }
    }

    /// Where coverage and counts are added.
    fn targets(&self) -> Vec<TextureId> {
        match self.six_bits {
            Some(both) => both.to_vec(),
            None => vec![self.visibility],
        }
    }

    /// Visibility from 8-bit buffers.
    fn resolve_pass(&self, label: String) -> Option<RenderPass> {
        let both = self.six_bits?;
        let pipeline = RenderPipeline {
            label: label.clone(),
            vertex: FullScreen.stage(),
            fragment: Some(Resolve::SixBits.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        Some(RenderPass {
            label,
            color: vec![attachment(self.visibility, LoadOp::DontCare)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, both.map(binding).to_vec())],
        })
    }
}

/// Quads and wedges of one light.
struct Volumes<'a> {
    view: &'a View,
    targets: &'a Targets,
    positions: Positions,
    buffers: &'a Buffers,
    light: &'a SoftLight,
    params: &'a Params,
    covering: Covering,
}

impl Volumes<'_> {
    /// Pass 1: the hard shadow count.
    fn count_pass(&self, label: String, silhouettes: &Silhouettes) -> RenderPass {
        let eight_bits = self.buffers.six_bits.is_some();
        let to = if eight_bits {
            CountTo::Alpha
        } else {
            CountTo::Visibility
        };
        let clear = if eight_bits { [0.0; 4] } else { [1.0; 4] };
        let counting = Counting {
            view: self.view,
            positions: self.positions,
            centre: self.light.centre,
            to,
        };
        let targets = self.buffers.targets().into_iter();
        RenderPass {
            label,
            color: targets
                .map(|t| attachment(t, LoadOp::Clear(clear)))
                .collect(),
            depth_stencil: None,
            draws: counting.draws(silhouettes),
        }
    }

    /// Pass 2: one wedge after the other; copying back, two passes for each.
    fn wedge_passes(
        &mut self,
        label: &str,
        silhouettes: &Silhouettes,
        warnings: &mut Vec<Warning>,
    ) -> Vec<RenderPass> {
        let construction = construction(self.params);
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
                        let plane = HardPlane(edge.normal);
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
            passes.push(self.pass(label, self.buffers.targets(), LoadOp::Load, draws));
        }
        passes
    }

    fn pass(
        &self,
        label: &str,
        targets: Vec<TextureId>,
        load: LoadOp<[f32; 4]>,
        draws: Vec<Draw>,
    ) -> RenderPass {
        RenderPass {
            label: label.to_owned(),
            color: targets.into_iter().map(|t| attachment(t, load)).collect(),
            depth_stencil: self.targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws,
        }
    }

    fn skip(&self) -> bool {
        self.params.get(SKIP.name) != "off"
    }

    fn blended(&self, area: &WedgeArea, shader: impl Fn(CoverTo) -> FragmentStage) -> Vec<Draw> {
        let to = if self.buffers.six_bits.is_some() {
            CoverTo::SixBits
        } else {
            CoverTo::Visibility
        };
        let pipeline = WedgePipeline {
            label: COVERAGE_DRAW,
            fragment: shader(to),
            targets: vec![ColorTargetState::ADDITIVE; self.buffers.targets().len()],
            textures: self.bindings(self.positions.texture),
            skip: self.skip(),
            note: Note::TakeAndRemove,
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
    ) -> [RenderPass; 2] {
        let visibility = self.buffers.visibility;
        let add = WedgePipeline {
            label: "penumbra aside",
            fragment: shader(CoverTo::Copied),
            targets: vec![ColorTargetState::OPAQUE],
            textures: self.bindings(visibility),
            skip: self.skip(),
            note: Note::Take,
        };
        let copy = WedgePipeline {
            label: "copy back",
            fragment: Resolve::Copy.stage(),
            targets: vec![ColorTargetState::OPAQUE],
            textures: vec![binding(aside)],
            skip: self.skip(),
            note: Note::Remove,
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
        slots.extend(self.covering.texture().map(binding));
        slots
    }
}
