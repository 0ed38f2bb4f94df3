//! The passes of a frame, in order.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    DepthStencilAttachment, Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, StoreOp,
    Subresource, TextureDescriptor, TextureId,
};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::buffers::{StencilCounts, TileDepths};
use gnomon_shaders::penumbra::inside::{Culling, WedgeInside};
use gnomon_shaders::transform::FullScreen;

use super::{Builder, Choices, PASSES, Parts, WedgeDraw};
use crate::parts::passes::Targets;
use crate::parts::visibility::{attachment, binding, full_screen};
use crate::parts::wedges::penumbra;
use crate::parts::wedges::penumbra::light::{self, LightSphere};
use crate::technique::{Params, TechniqueError};

/// A draw with the wedge shader that it runs, if it does.
pub(super) type Shaded = (Draw, Option<WedgeInside>);

/// The draws of one light by the pass that they belong to.
#[derive(Default)]
pub(super) struct LightDraws {
    /// Caps of z-fail, and volumes of lights without extent: depth is attached.
    pub(super) tested: Vec<Draw>,
    /// Boundaries of the umbra by facing, for the stencil.
    pub(super) umbra: [Vec<Shaded>; 2],
    /// Everything else.
    pub(super) intensity: Vec<Shaded>,
    /// The light has no extent: there are only volumes in `tested`.
    pub(super) hard: bool,
}

impl Builder<'_> {
    pub(super) fn light_passes(
        &self,
        light: usize,
        buffer: TextureId,
        named: Named<'_>,
        parts: &mut Parts,
    ) -> Vec<RenderPass> {
        let source = &self.scene.lights[light];
        parts.warnings.extend(light::substitution(light, source));
        let mut draws = LightDraws::default();
        match LightSphere::of(source) {
            None => self.hard_light(light, &mut draws, parts),
            Some(sphere) => self.soft_light(light, &sphere, &mut draws, parts),
        }
        let three = self.choices.three && !draws.hard;
        let passes = if three {
            self.three_passes(buffer, draws, named)
        } else {
            self.single_pass(buffer, draws, named)
        };
        note(passes, parts)
    }

    /// Umbra and penumbra in the light-intensity buffer from the first.
    fn single_pass(&self, buffer: TextureId, draws: LightDraws, named: Named<'_>) -> Vec<Pass> {
        let mut list = Vec::new();
        let mut load = penumbra::cleared(FULL);
        // A light without wedges still needs its buffer cleared.
        if draws.hard || !draws.tested.is_empty() {
            let label = named(if draws.hard { "volumes" } else { "umbra caps" });
            let mut pass = penumbra::intensity_pass(label, buffer, load);
            pass.depth_stencil = self.targets.depth_stencil(LoadOp::Load, LoadOp::Load);
            pass.draws = draws.tested;
            list.push((pass, Vec::new()));
            load = LoadOp::Load;
        }
        if !draws.hard {
            let pass = penumbra::intensity_pass(named("wedges"), buffer, load);
            list.push(filled(pass, draws.intensity));
        }
        list
    }

    /// The umbra by facing into a stencil, then its counts and the penumbrae into
    /// the light-intensity buffer.
    fn three_passes(&self, buffer: TextureId, draws: LightDraws, named: Named<'_>) -> Vec<Pass> {
        let mut list = Vec::new();
        let mut counts: Vec<TextureId> = self.umbra_stencil.into_iter().collect();
        let only_stencil = |label: &str, depth_stencil| RenderPass {
            label: named(label),
            color: Vec::new(),
            depth_stencil,
            draws: Vec::new(),
        };
        if !draws.tested.is_empty() {
            let scene = self.targets.depth_stencil(LoadOp::Load, LoadOp::Clear(0));
            let mut pass = only_stencil("umbra caps", scene);
            pass.draws = draws.tested;
            list.push((pass, Vec::new()));
            counts.push(self.targets.depth_texture());
        }
        let [front, back] = draws.umbra;
        let front_stencil = self.umbra_attachment(LoadOp::Clear(0));
        list.push(filled(only_stencil("umbra front", front_stencil), front));
        let back_stencil = self.umbra_attachment(LoadOp::Load);
        list.push(filled(only_stencil("umbra back", back_stencil), back));
        let full = penumbra::cleared(FULL);
        let mut pass = penumbra::intensity_pass(named("umbra counts"), buffer, full);
        pass.draws = vec![add_counts(&counts)];
        list.push((pass, Vec::new()));
        let pass = penumbra::intensity_pass(named("penumbra"), buffer, LoadOp::Load);
        list.push(filled(pass, draws.intensity));
        list
    }

    fn umbra_attachment(&self, stencil: LoadOp<u8>) -> Option<DepthStencilAttachment> {
        self.umbra_stencil.map(|texture| DepthStencilAttachment {
            texture,
            subresource: Subresource::default(),
            depth_load: LoadOp::DontCare,
            depth_store: StoreOp::Discard,
            stencil_load: stencil,
            stencil_store: StoreOp::Store,
        })
    }
}

/// Names a pass of the light.
type Named<'a> = &'a dyn Fn(&str) -> String;

/// A pass, and the wedge shaders of its draws.
type Pass = (RenderPass, Vec<Option<WedgeInside>>);

fn filled(mut pass: RenderPass, draws: Vec<Shaded>) -> Pass {
    let (draws, shaders) = draws.into_iter().unzip();
    pass.draws = draws;
    (pass, shaders)
}

/// Notes where the wedge shaders are, and takes them off.
fn note(list: Vec<Pass>, parts: &mut Parts) -> Vec<RenderPass> {
    for (p, (_, shaders)) in list.iter().enumerate() {
        for (d, shader) in shaders.iter().enumerate() {
            parts
                .wedge_draws
                .extend(shader.clone().map(|shader| WedgeDraw {
                    at: [parts.offset + p, d],
                    shader,
                }));
        }
    }
    list.into_iter().map(|(pass, _)| pass).collect()
}

/// Adds 255 times the stencil counts of `textures` everywhere.
fn add_counts(textures: &[TextureId]) -> Draw {
    let shader = StencilCounts {
        textures: textures.len(),
    };
    let pipeline = RenderPipeline {
        label: "umbra counts".into(),
        vertex: FullScreen.stage(),
        fragment: Some(shader.stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::ADDITIVE],
    };
    full_screen(pipeline, textures.iter().map(|&t| binding(t)).collect())
}

/// The pass that finds zmax, and zmin where it is wanted, of all tiles; and their
/// textures.
pub(super) fn tile_depths(
    choices: &Choices,
    targets: &Targets,
    size: [u32; 2],
    recording: &mut Recording,
) -> Result<Option<(RenderPass, Vec<TextureId>)>, TechniqueError> {
    let names: &[&str] = match choices.tiles.culling {
        Culling::None => return Ok(None),
        Culling::Zmax => &["zmax"],
        Culling::ZminZmax => &["zmax", "zmin"],
    };
    let shift = choices.tiles.shift;
    let [width, height] = size.map(|s| s.div_ceil(1 << shift));
    let create = |name: &&str| {
        let desc = TextureDescriptor::d2(name, Format::R32Float, width, height);
        recording.create(&desc)
    };
    let bounds = names.iter().map(create).collect::<Result<Vec<_>, _>>()?;
    let pipeline = RenderPipeline {
        label: "tile depths".into(),
        vertex: FullScreen.stage(),
        fragment: Some(TileDepths { shift, size }.stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE; bounds.len()],
    };
    let attached = bounds.iter().map(|&t| attachment(t, LoadOp::DontCare));
    let pass = RenderPass {
        label: "tile depths".into(),
        color: attached.collect(),
        depth_stencil: None,
        draws: vec![full_screen(
            pipeline,
            vec![binding(targets.depth_texture())],
        )],
    };
    Ok(Some((pass, bounds)))
}

/// The stencil of the three-pass algorithm; its depth is not used.
pub(super) fn umbra_stencil(
    params: &Params,
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<Option<TextureId>, TechniqueError> {
    if params.get(PASSES.name) != "three" {
        return Ok(None);
    }
    let format = Format::Depth24Stencil8;
    let desc = TextureDescriptor::d2("umbra stencil", format, width, height);
    Ok(Some(recording.create(&desc)?))
}
