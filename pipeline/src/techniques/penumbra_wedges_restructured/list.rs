//! The passes of a frame, in order.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::buffers::{StencilCounts, TileDepths};
use gnomon_shaders::penumbra::tiles::Culling;
use gnomon_shaders::transform::FullScreen;

use super::atlas::Shelves;
use super::{Choices, InsideDraws, WedgeDraw, WedgeModel};
use crate::parts::passes::Targets;
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::visibility::{attachment, binding, full_screen};
use crate::parts::volumes::light_contacts;
use crate::parts::wedges::penumbra;
use crate::parts::wedges::penumbra::light::{self, LightSphere};
use crate::technique::{Pass, PassRole, TechniqueError};

/// A draw with what it does of a wedge, if it does.
pub(super) type Shaded = (Draw, Option<WedgeModel>);

/// Wedges whose tiles' classes fit into the atlas together.
#[derive(Default)]
pub(super) struct Batch {
    /// What of the atlas is taken.
    pub(super) shelves: Shelves,
    /// Find the classes.
    pub(super) classes: Vec<Draw>,
    /// Use them.
    pub(super) wedges: Vec<Shaded>,
}

/// The draws of one light by the pass that they belong to.
pub(super) struct LightDraws {
    /// The intensity before all draws: full, but for casters all around the light that
    /// are counted from infinity.
    pub(super) start: f32,
    /// Caps of z-fail, and volumes of lights without extent: depth is attached.
    pub(super) tested: Vec<Draw>,
    /// Boundaries of the umbra by facing, for the stencil.
    pub(super) umbra: [Vec<Shaded>; 2],
    /// Everything else; at least one.
    batches: Vec<Batch>,
    /// The light has no extent: there are only volumes in `tested`.
    pub(super) hard: bool,
}

impl Default for LightDraws {
    fn default() -> Self {
        Self {
            start: FULL,
            tested: Vec::new(),
            umbra: [Vec::new(), Vec::new()],
            batches: vec![Batch::default()],
            hard: false,
        }
    }
}

impl LightDraws {
    /// The batch that wedges are put into.
    pub(super) fn batch(&mut self) -> &mut Batch {
        if self.batches.is_empty() {
            self.next_batch();
        }
        let last = self.batches.len() - 1;
        &mut self.batches[last]
    }

    pub(super) fn wedges(&mut self) -> &mut Vec<Shaded> {
        &mut self.batch().wedges
    }

    pub(super) fn next_batch(&mut self) {
        self.batches.push(Batch::default());
    }
}

impl InsideDraws<'_> {
    /// The passes of a light; `wedge_draws` gets what they do of wedges.
    pub(super) fn light_passes(
        &self,
        buffer: TextureId,
        turn: &mut LightTurn<'_, '_>,
        wedge_draws: &mut Vec<WedgeDraw>,
    ) -> Vec<Pass> {
        let (light, source) = (turn.number, turn.light());
        turn.notes.warnings.extend(light::substitution(
            light,
            source,
            self.choices.penumbra.light_as,
        ));
        turn.notes
            .warnings
            .extend(light_contacts::warning(turn.scene, light));
        let mut draws = LightDraws::default();
        match LightSphere::of(source, self.choices.penumbra.light_as) {
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
            list.extend(self.wedge_passes("wedges", buffer, load, draws.batches, turn));
        }
        list
    }

    /// For each batch the classes of its tiles, if tiles are culled, and its wedges.
    fn wedge_passes(
        &self,
        label: &str,
        buffer: TextureId,
        first: LoadOp<[f32; 4]>,
        batches: Vec<Batch>,
        turn: &LightTurn<'_, '_>,
    ) -> Vec<Shading> {
        let mut load = first;
        let mut list = Vec::new();
        for batch in batches {
            if let Some(atlas) = self.atlas.filter(|_| !batch.classes.is_empty()) {
                let pass = atlas.pass(turn.label("tile classes"), batch.classes);
                list.push(Shading::plain(PassRole::TileClasses, pass));
            }
            let mut pass = penumbra::intensity_pass(turn.label(label), buffer, load);
            pass.depth_stencil = turn.targets.depth_stencil(LoadOp::Load, LoadOp::Load);
            list.push(Shading::of(PassRole::Wedges, pass, batch.wedges));
            load = LoadOp::Load;
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
        let only_stencil = |label: &str, stencil: LoadOp<u8>| RenderPass {
            label: turn.label(label),
            color: Vec::new(),
            depth_stencil: turn.targets.depth_stencil(LoadOp::Load, stencil),
            draws: Vec::new(),
        };
        let mut load = LoadOp::Clear(0);
        if !draws.tested.is_empty() {
            let mut pass = only_stencil("umbra caps", load);
            pass.draws = draws.tested;
            list.push(Shading::plain(PassRole::UmbraCaps, pass));
            load = LoadOp::Load;
        }
        let [front, back] = draws.umbra;
        let pass = only_stencil("umbra front", load);
        list.push(Shading::of(PassRole::UmbraStencil, pass, front));
        let pass = only_stencil("umbra back", LoadOp::Load);
        list.push(Shading::of(PassRole::UmbraStencil, pass, back));
        let start = penumbra::cleared(draws.start);
        let mut pass = penumbra::intensity_pass(turn.label("umbra counts"), buffer, start);
        pass.draws = vec![add_counts(turn.targets.depth_texture())];
        list.push(Shading::plain(PassRole::UmbraCounts, pass));
        list.extend(self.wedge_passes("penumbra", buffer, LoadOp::Load, draws.batches, turn));
        list
    }
}

/// A pass, and what its draws do of wedges.
struct Shading {
    pass: Pass,
    models: Vec<Option<WedgeModel>>,
}

impl Shading {
    /// Without wedges.
    fn plain(role: PassRole, pass: RenderPass) -> Self {
        Self {
            pass: Pass::new(role, pass),
            models: Vec::new(),
        }
    }

    /// `pass` with these draws.
    fn of(role: PassRole, mut pass: RenderPass, draws: Vec<Shaded>) -> Self {
        let (draws, models) = draws.into_iter().unzip();
        pass.draws = draws;
        Self {
            pass: Pass::new(role, pass),
            models,
        }
    }
}

/// Notes where wedges are drawn, behind `passes_before` other passes, and takes
/// them off.
fn note(list: Vec<Shading>, passes_before: usize, wedge_draws: &mut Vec<WedgeDraw>) -> Vec<Pass> {
    let mut passes = Vec::with_capacity(list.len());
    for Shading { pass, models } in list {
        let at = passes_before + passes.len();
        for (draw, model) in models.into_iter().enumerate() {
            wedge_draws.extend(model.map(|model| WedgeDraw {
                at: [at, draw],
                model,
            }));
        }
        passes.push(pass);
    }
    passes
}

/// Adds 255 times the stencil counts of a texture everywhere.
fn add_counts(texture: TextureId) -> Draw {
    let shader = StencilCounts { textures: 1 };
    let pipeline = RenderPipeline {
        label: "umbra counts".into(),
        vertex: FullScreen.stage(),
        fragment: Some(shader.stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::ADDITIVE],
    };
    full_screen(pipeline, vec![binding(texture)])
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
