//! Shadows on planes as the mean of many hard ones: the casters projected from each of N
//! points of the light, and how many of them hide each texel of the plane (Heckbert and
//! Herf 1997; docs/papers.md, baselines).
//!
//! A texel's count is a whole number, so that a plane has N + 1 levels at most. Each
//! caster is drawn once for each point; a stencil value for each point keeps what lies
//! over one another from counting twice.
//!
//! Only flat objects receive: others that do are lit, which is said. A plane's texture
//! covers the part of it that is seen and on which shadows can fall.

mod counting;
mod planes;

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{Draw, Format, LoadOp, RenderPass, RenderPipeline, TextureDescriptor};
use gnomon_shaders::transform::FullScreen;

use self::counting::Counting;
use self::planes::{Receiver, receivers};
use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::light_samples::{JITTER_SEED, Pattern, light_points};
use crate::parts::maps::light_view::{Surroundings, ViewedLight};
use crate::parts::passes::{LitTest, View};
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::technique::{
    Capabilities, Condition, Figure, Frame, LightFact, Param, ParamInfo, Params, Pass, PassRole,
    ShadowKind, Technique, TechniqueError, Warning,
};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct HeckbertHerf;

const SAMPLES: Param<u32> = Param::<u32>::square(
    "samples",
    64,
    [1, 1024],
    "points of the light, a square number from 1 to 1024; the papers have 64 to 256",
)
.when(Condition::Lights(LightFact::Extended));

const MAP_SIZE: Param<u32> = Param::<u32>::power_of_two(
    "map-size",
    256,
    [16, 4096],
    "texels along a side of a plane's texture",
)
.unit("texels");

/// What parameters decide.
struct Settings {
    /// Points along a side.
    side: u32,
    seed: u64,
    /// Texels along a side.
    size: u32,
    frame: FrameSettings,
}

impl Settings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            side: params.get(&SAMPLES)?.isqrt(),
            seed: params.get(&JITTER_SEED)?,
            size: params.get(&MAP_SIZE)?,
            frame: FrameSettings::read(params)?,
        })
    }
}

impl Technique for HeckbertHerf {
    fn name(&self) -> &'static str {
        "heckbert-herf"
    }

    fn summary(&self) -> &'static str {
        "soft shadows on planes as the mean of N projections (Heckbert and Herf 1997)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[SAMPLES.info, JITTER_SEED.info, MAP_SIZE.info],
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_light_views(ShadowKind::Soft)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = Settings::read(params)?;
        let frame = ShadowedFrame::new(scene, size, &settings.frame)?;
        let (mut frame, positions) = frame.with_positions()?;
        let view = View::new(&scene.camera, size);
        let (planes, others) = receivers(scene, &Surroundings::new(scene, size));
        frame.notes.warnings.extend(lit_receivers(others));
        let recording = &mut frame.recording;
        let [width, height] = size;
        let desc = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let visibility = VisibilityTexture::red(recording.create(&desc)?);
        let shadows = Planes {
            counting: Counting::create(scene, &view, settings.size, recording)?,
            settings,
            planes,
            positions,
            visibility,
            view,
        };
        frame.lit(LitTest::Visibility(visibility), |turn| shadows.passes(turn))
    }
}

/// Receivers that are no planes.
fn lit_receivers(count: usize) -> Option<Warning> {
    (count > 0).then(|| Warning {
        code: "receivers-not-flat",
        count,
        message: format!(
            "heckbert-herf: {count} objects that receive shadows are not flat and are lit; \
             use another technique, or make them flat"
        ),
    })
}

/// What all lights share.
struct Planes {
    settings: Settings,
    planes: Vec<Receiver>,
    counting: Counting,
    positions: Positions,
    visibility: VisibilityTexture,
    view: View,
}

impl Planes {
    /// All passes that leave a light's visibility behind.
    fn passes(&self, turn: &mut LightTurn<'_, '_>) -> Result<Vec<Pass>, TechniqueError> {
        let label = turn.labels();
        let light = turn.light();
        ViewedLight::new("heckbert-herf", light, turn.number)?;
        let Settings {
            side, seed, size, ..
        } = self.settings;
        let points = light_points(light, Pattern::Stratified, side, seed)?;
        let mut passes = vec![self.look_up(label("look-up"), LoadOp::Clear([1.0; 4]), None)];
        let (mut planes, mut texel) = (0, 0.0f64);
        for plane in &self.planes {
            let Some(part) = plane.shadowed(turn.scene, &points, size) else {
                continue;
            };
            texel = texel.max(part.texel(size));
            planes += 1;
            passes.extend(
                self.counting
                    .passes(&label("projections"), &part, &points, &self.view),
            );
            let draw = self.look_up_draw(&part, points.len());
            passes.push(self.look_up(label("look-up"), LoadOp::Load, Some(draw)));
        }
        let figures = [("planes", f64::from(planes)), ("texel", texel)];
        let figures = figures.map(|(name, value)| Figure {
            name: label(name),
            value,
        });
        turn.notes.figures.extend(figures);
        Ok(passes)
    }

    fn look_up_draw(&self, plane: &Receiver, points: usize) -> Draw {
        let shader = plane.look_up(&self.view, self.settings.size, points);
        let pipeline = RenderPipeline {
            label: "look-up".into(),
            vertex: FullScreen.stage(),
            fragment: Some(shader.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        let textures = [self.positions.texture, self.counting.counts];
        full_screen(pipeline, textures.map(binding).to_vec())
    }

    fn look_up(&self, label: String, load: LoadOp<[f32; 4]>, draw: Option<Draw>) -> Pass {
        let pass = RenderPass {
            label,
            color: vec![attachment(self.visibility.texture, load)],
            depth_stencil: None,
            draws: draw.into_iter().collect(),
        };
        Pass::new(PassRole::LookUp, pass)
    }
}
