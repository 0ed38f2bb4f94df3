//! Shadow rays: stratified, seeded points of the light, a ray to each from every
//! receiver, through a hierarchy of boxes that a fragment shader walks in textures
//! (docs/papers.md, baselines). What it costs is counted as fetches, and the rays as
//! `shadow-rays`.
//!
//! Points are jittered anew for each pixel of a block of pixels, which makes noise of the
//! steps; blocks repeat. Rays start a little off the surface that is seen, on the eye's
//! side, so that it shadows itself where eye and light are on different sides of it and
//! nowhere else.
//!
//! All arithmetic is f32: receivers whose light passes an edge by less than rounding may
//! go either way.

mod textures;

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{Format, LoadOp, RenderPass, RenderPipeline, TextureDescriptor};
use gnomon_shaders::shadow_rays::ShadowRays;
use gnomon_shaders::transform::FullScreen;

use self::textures::CasterTextures;
use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::light_samples::{JITTER_SEED, Pattern, light_points};
use crate::parts::maps::light_view::ViewedLight;
use crate::parts::passes::{LitTest, View};
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::technique::{
    Capabilities, Condition, Decimals, Figure, Frame, LightFact, Param, ParamInfo, Params, Pass,
    PassRole, ShadowKind, Technique, TechniqueError,
};
use crate::world::light::HardLight;
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct RayTraced;

const SAMPLES: Param<u32> = Param::<u32>::square(
    "samples",
    64,
    [1, 1024],
    "rays for each pixel, a square number from 1 to 1024",
)
.when(Condition::Lights(LightFact::Extended));

const BLOCK: Param<u32> = Param::<u32>::power_of_two(
    "block",
    8,
    [1, 32],
    "pixels along a side of a block, each with points of its own; 1: all have the same",
)
.unit("pixels")
.when(Condition::Lights(LightFact::Extended));

const BIAS: Param<Option<f64>> = Param::decimal_or(
    &["auto"],
    "bias",
    Decimals {
        low: 0.0,
        with_low: true,
    },
    "how far off its surface a ray starts, world units; auto: a share of the largest coordinate",
)
.unit("world units");

/// `auto`, of the largest coordinate of casters: positions have 24 bits.
const BIAS_SHARE: f64 = 4e-6;

/// What parameters decide.
struct Settings {
    /// Points along a side.
    side: u32,
    seed: u64,
    block: u32,
    bias: Option<f64>,
    frame: FrameSettings,
}

impl Settings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            side: params.get(&SAMPLES)?.isqrt(),
            seed: params.get(&JITTER_SEED)?,
            block: params.get(&BLOCK)?,
            bias: params.get(&BIAS)?,
            frame: FrameSettings::read(params)?,
        })
    }
}

impl Technique for RayTraced {
    fn name(&self) -> &'static str {
        "ray-traced"
    }

    fn summary(&self) -> &'static str {
        "soft shadows by stratified rays to points of the light, through boxes in textures"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[SAMPLES.info, JITTER_SEED.info, BLOCK.info, BIAS.info],
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_rays(ShadowKind::Soft)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = Settings::read(params)?;
        let frame = ShadowedFrame::new(scene, size, &settings.frame)?;
        let (mut frame, positions) = frame.with_positions_and_planes()?;
        let view = View::new(&scene.camera, size);
        let recording = &mut frame.recording;
        let casters = CasterTextures::create(self.name(), scene, &view, recording)?;
        let [width, height] = size;
        let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let visibility = VisibilityTexture::red(recording.create(&desc)?);
        let auto = f64::from(casters.largest) * BIAS_SHARE;
        let rays = Rays {
            bias: settings.bias.unwrap_or(auto),
            settings,
            positions,
            casters,
            visibility,
            view,
        };
        frame.lit(LitTest::Visibility(visibility), |turn| rays.passes(turn))
    }
}

/// What all lights share.
struct Rays {
    settings: Settings,
    positions: Positions,
    casters: CasterTextures,
    visibility: VisibilityTexture,
    view: View,
    bias: f64,
}

impl Rays {
    /// The pass that leaves a light's visibility behind.
    fn passes(&self, turn: &mut LightTurn<'_, '_>) -> Result<Vec<Pass>, TechniqueError> {
        let label = turn.labels();
        let rows = self.points(turn)?;
        let columns = rows.first().map_or(0, Vec::len);
        let points = textures::points(&rows, &self.view, turn.recording)?;
        turn.notes.figures.push(Figure {
            name: label("bias"),
            value: self.bias,
        });
        let shader = ShadowRays {
            nodes: self.casters.nodes.1,
            triangles: self.casters.triangles.1,
            count: self.casters.count,
            points: columns as u32,
            block: self.block(rows.len()),
            bias: self.bias as f32,
        };
        let pipeline = RenderPipeline {
            label: "shadow rays".into(),
            vertex: FullScreen.stage(),
            fragment: Some(shader.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        let [nodes, triangles] = [self.casters.nodes.0, self.casters.triangles.0];
        let textures = [self.positions.texture, nodes, triangles, points].into_iter();
        let textures = textures.chain(self.positions.planes);
        let pass = RenderPass {
            label: label("shadow rays"),
            color: vec![attachment(self.visibility.texture, LoadOp::Clear([1.0; 4]))],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, textures.map(binding).collect())],
        };
        Ok(vec![Pass::new(PassRole::ShadowRays, pass)])
    }

    /// Points of the light for each pixel of a block; a light without extent has one for
    /// all.
    fn points(&self, turn: &LightTurn<'_, '_>) -> Result<Vec<Vec<HardLight>>, TechniqueError> {
        let Settings {
            side, seed, block, ..
        } = self.settings;
        let light = turn.light();
        ViewedLight::new("ray-traced", light, turn.number)?;
        let rows = match LightFact::Extended.holds(&light.shape) {
            true => u64::from(block * block),
            false => 1,
        };
        let row = |row: u64| {
            let seed = seed.wrapping_mul(rows).wrapping_add(row);
            Ok(light_points(light, Pattern::Stratified, side, seed)?)
        };
        (0..rows).map(row).collect()
    }

    fn block(&self, rows: usize) -> u32 {
        if rows == 1 { 1 } else { self.settings.block }
    }
}
