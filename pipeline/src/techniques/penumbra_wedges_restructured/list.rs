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

use super::{Choices, InsideDraws, WedgeDraw};
use crate::parts::passes::Targets;
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::visibility::{attachment, binding, full_screen};
use crate::parts::volumes::light_contacts;
use crate::parts::wedges::penumbra;
use crate::parts::wedges::penumbra::light::{self, LightSphere};
use crate::technique::{Pass, PassRole, TechniqueError};

/// A draw with the wedge shader that it runs, if it does.
pub(super) type Shaded = (Draw, Option<WedgeInside>);

/// The draws of one light by the pass that they belong to.
pub(super) struct LightDraws {
    /// The intensity before all draws: full, but for casters all around the light that
    /// are counted from infinity.
    pub(super) start: f32,
    /// Caps of z-fail, and volumes of lights without extent: depth is attached.
    pub(super) tested: Vec<Draw>,
    /// Boundaries of the umbra by facing, for the stencil.
    pub(super) umbra: [Vec<Shaded>; 2],
    /// Everything else.
    pub(super) intensity: Vec<Shaded>,
    /// The light has no extent: there are only volumes in `tested`.
    pub(super) hard: bool,
}

impl Default for LightDraws {
    fn default() -> Self {
        Self {
            start: FULL,
            tested: Vec::new(),
            umbra: [Vec::new(), Vec::new()],
            intensity: Vec::new(),
            hard: false,
        }
    }
}

impl InsideDraws<'_> {
    /// The passes of a light; `wedge_draws` gets the wedge shaders in them.
    pub(super) fn light_passes(
        &self,
        buffer: TextureId,
        turn: &mut LightTurn<'_, '_>,
        wedge_draws: &mut Vec<WedgeDraw>,
    ) -> Vec<Pass> {
        let (light, source) = (turn.number, turn.light());
        turn.notes
            .warnings
            .extend(light::substitution(light, source));
        turn.notes
            .warnings
            .extend(light_contacts::warning(turn.scene, light));
        let mut draws = LightDraws::default();
        match LightSphere::of(source) {
            None => self.hard_light(turn, &mut draws),
            Some(sphere) => self.soft_light(turn, &sphere, &mut draws),
        }
        let three = self.choices.three && !draws.hard;
        let list = if three {
            self.three_passes(buffer, draws, turn)
        } else {
            self.single_pass(buffer, draws, turn)
        };
        note(list, turn.passes_before, wedge_draws)
    }

    /// Umbra and penumbra in the light-intensity buffer from the first.
    fn single_pass(
        &self,
        buffer: TextureId,
        draws: LightDraws,
        turn: &LightTurn<'_, '_>,
    ) -> Vec<Shading> {
        let mut list = Vec::new();
        let mut load = penumbra::cleared(draws.start);
        // A light without wedges still needs its buffer cleared.
        if draws.hard || !draws.tested.is_empty() {
            let (role, what) = match draws.hard {
                true => (PassRole::Volumes, "volumes"),
                false => (PassRole::UmbraCaps, "umbra caps"),
            };
            let label = turn.label(what);
            let mut pass = penumbra::intensity_pass(label, buffer, load);
            pass.depth_stencil = turn.targets.depth_stencil(LoadOp::Load, LoadOp::Load);
            pass.draws = draws.tested;
            list.push(Shading::plain(role, pass));
            load = LoadOp::Load;
        }
        if !draws.hard {
            let pass = penumbra::intensity_pass(turn.label("wedges"), buffer, load);
            list.push(Shading::of(PassRole::Wedges, pass, draws.intensity));
        }
        list
    }

    /// The umbra by facing into a stencil, then its counts and the penumbrae into
    /// the light-intensity buffer.
    fn three_passes(
        &self,
        buffer: TextureId,
        draws: LightDraws,
        turn: &LightTurn<'_, '_>,
    ) -> Vec<Shading> {
        let mut list = Vec::new();
        let mut counts: Vec<TextureId> = self.umbra_stencil.into_iter().collect();
        let only_stencil = |label: &str, depth_stencil| RenderPass {
            label: turn.label(label),
            color: Vec::new(),
            depth_stencil,
            draws: Vec::new(),
        };
        if !draws.tested.is_empty() {
            let scene = turn.targets.depth_stencil(LoadOp::Load, LoadOp::Clear(0));
            let mut pass = only_stencil("umbra caps", scene);
            pass.draws = draws.tested;
            list.push(Shading::plain(PassRole::UmbraCaps, pass));
            counts.push(turn.targets.depth_texture());
        }
        let [front, back] = draws.umbra;
        let front_stencil = self.umbra_attachment(LoadOp::Clear(0));
        let pass = only_stencil("umbra front", front_stencil);
        list.push(Shading::of(PassRole::UmbraStencil, pass, front));
        let back_stencil = self.umbra_attachment(LoadOp::Load);
        let pass = only_stencil("umbra back", back_stencil);
        list.push(Shading::of(PassRole::UmbraStencil, pass, back));
        let start = penumbra::cleared(draws.start);
        let mut pass = penumbra::intensity_pass(turn.label("umbra counts"), buffer, start);
        pass.draws = vec![add_counts(&counts)];
        list.push(Shading::plain(PassRole::UmbraCounts, pass));
        let pass = penumbra::intensity_pass(turn.label("penumbra"), buffer, LoadOp::Load);
        list.push(Shading::of(PassRole::Wedges, pass, draws.intensity));
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

/// A pass, and the wedge shaders of its draws.
struct Shading {
    pass: Pass,
    shaders: Vec<Option<WedgeInside>>,
}

impl Shading {
    /// Without wedge shaders.
    fn plain(role: PassRole, pass: RenderPass) -> Self {
        Self {
            pass: Pass::new(role, pass),
            shaders: Vec::new(),
        }
    }

    /// `pass` with these draws.
    fn of(role: PassRole, mut pass: RenderPass, draws: Vec<Shaded>) -> Self {
        let (draws, shaders) = draws.into_iter().unzip();
        pass.draws = draws;
        Self {
            pass: Pass::new(role, pass),
            shaders,
        }
    }
}

/// Notes where the wedge shaders are, behind `passes_before` other passes, and takes
/// them off.
fn note(list: Vec<Shading>, passes_before: usize, wedge_draws: &mut Vec<WedgeDraw>) -> Vec<Pass> {
    let mut passes = Vec::with_capacity(list.len());
    for Shading { pass, shaders } in list {
        let at = passes_before + passes.len();
        for (draw, shader) in shaders.into_iter().enumerate() {
            wedge_draws.extend(shader.map(|shader| WedgeDraw {
                at: [at, draw],
                shader,
            }));
        }
        passes.push(pass);
    }
    passes
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
) -> Result<Option<(Pass, Vec<TextureId>)>, TechniqueError> {
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
    Ok(Some((Pass::new(PassRole::TileDepths, pass), bounds)))
}

/// The stencil of the three-pass algorithm; its depth is not used.
pub(super) fn umbra_stencil(
    choices: &Choices,
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<Option<TextureId>, TechniqueError> {
    if !choices.three {
        return Ok(None);
    }
    let format = Format::Depth24Stencil8;
    let desc = TextureDescriptor::d2("umbra stencil", format, width, height);
    Ok(Some(recording.create(&desc)?))
}
