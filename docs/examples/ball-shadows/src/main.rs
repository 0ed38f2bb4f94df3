//! A technique in one file, outside of Gnomon's workspace: every caster casts the soft
//! shadow of a ball round it.
//!
//! Run it as the program `gnomon`, with one technique more:
//!
//! ```sh
//! cargo run --release -- render creature --technique ball-shadows --set softness=0.4
//! cargo run --release -- techniques
//! ```
//!
//! Visibility of a receiver is how far the ray from it to the light's centre passes by
//! the nearest ball: a rough stand-in for soft shadows, as games use for far characters.

use std::process::ExitCode;

use gnomon::pipeline::param_list;
use gnomon::pipeline::parts::frame_settings::FrameSettings;
use gnomon::pipeline::parts::passes::{LitTest, View};
use gnomon::pipeline::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use gnomon::pipeline::parts::visibility::{
    Positions, VisibilityTexture, attachment, binding, full_screen,
};
use gnomon::pipeline::technique::{
    Capabilities, Frame, Param, ParamInfo, Params, Pass, PassRole, ShadowKind, Technique,
    TechniqueError,
};
use gnomon::pipeline::world::scene::{Object, Scene};
use gnomon::raster::shader::{Fragment, FragmentOutputs, FragmentShader, FragmentStage};
use gnomon::raster::state::{BlendState, ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon::raster::{
    Draw, F32, Format, I32, Lanes, LoadOp, RenderPass, RenderPipeline, TextureDescriptor,
};
use gnomon::shaders::transform::FullScreen;

/// The technique.
struct BallShadows;

const SOFTNESS: Param<f64> = Param::decimal_above(
    "softness",
    0.3,
    0.0,
    "width of the penumbra as a share of the ball's radius",
)
.unit("radii");

const SCALE: Param<f64> = Param::decimal_above(
    "scale",
    0.8,
    0.0,
    "radius of the ball over half the diagonal of the caster's bounding box",
);

/// What parameters decide.
struct Settings {
    softness: f64,
    scale: f64,
    frame: FrameSettings,
}

impl Settings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            softness: params.get(&SOFTNESS)?,
            scale: params.get(&SCALE)?,
            frame: FrameSettings::read(params)?,
        })
    }
}

impl Technique for BallShadows {
    fn name(&self) -> &'static str {
        "ball-shadows"
    }

    fn summary(&self) -> &'static str {
        "every caster casts the soft shadow of a ball round it"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(&[SOFTNESS.info, SCALE.info], FrameSettings::PARAMS)
    }

    /// Any mesh may cast: only its bounding box is looked at.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            shadows: ShadowKind::Soft,
            ..Capabilities::UNSHADOWED
        }
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
        let [width, height] = size;
        let texture = TextureDescriptor::d2("visibility", Format::R32Float, width, height);
        let visibility = VisibilityTexture::red(frame.recording.create(&texture)?);
        frame.lit(LitTest::Visibility(visibility), |light| {
            let pass = settings.pass(light, positions, visibility);
            Ok(vec![Pass::new(PassRole::LookUp, pass)])
        })
    }
}

impl Settings {
    /// Visibility of a light: the least that some caster's ball leaves.
    fn pass(
        &self,
        light: &LightTurn<'_, '_>,
        positions: Positions,
        visibility: VisibilityTexture,
    ) -> RenderPass {
        let balls = light
            .scene
            .casters()
            .filter_map(|caster| self.ball(caster, light));
        let textures = || vec![binding(positions.texture)];
        let draw = |ball: Ball| -> Draw { full_screen(pipeline(ball), textures()) };
        RenderPass {
            label: light.label("balls"),
            color: vec![attachment(visibility.texture, LoadOp::Clear([1.0; 4]))],
            depth_stencil: None,
            draws: balls.map(draw).collect(),
        }
    }

    /// The ball round a caster, relative to the view's origin.
    fn ball(&self, caster: &Object, light: &LightTurn<'_, '_>) -> Option<Ball> {
        let view: &View = light.view();
        let (low, high) = caster.mesh.bounds()?;
        let centre = view.relative((low + high) * 0.5);
        let radius = (high - low).length() * 0.5 * self.scale;
        Some(Ball {
            centre: centre.to_array().map(|c| c as f32),
            radius: radius as f32,
            softness: (radius * self.softness) as f32,
            light: view.light(light.light().hard()),
        })
    }
}

fn pipeline(ball: Ball) -> RenderPipeline {
    RenderPipeline {
        label: "ball".to_owned(),
        vertex: FullScreen.stage(),
        fragment: Some(FragmentStage::from(ball)),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState {
            blend: Some(BlendState::MIN),
            ..ColorTargetState::OPAQUE
        }],
    }
}

/// How much of a light a ball leaves: 0 where the ray to the light meets it, 1 from
/// `softness` beside it.
struct Ball {
    centre: [f32; 3],
    radius: f32,
    softness: f32,
    /// A point, w being 1, or a direction.
    light: [f32; 4],
}

impl FragmentShader for Ball {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let own = [f.column(), f.row(), I32::splat(l, 0)];
        let [x, y, z, shadowable] = f.fetch_texel(0, own, 0);
        let at = [x, y, z];
        let value = |number: f32| F32::splat(l, number);
        let [light_x, light_y, light_z, is_point] = self.light;
        let to_light = [
            value(light_x) - x * is_point,
            value(light_y) - y * is_point,
            value(light_z) - z * is_point,
        ];
        let to_ball = [
            value(self.centre[0]) - at[0],
            value(self.centre[1]) - at[1],
            value(self.centre[2]) - at[2],
        ];
        // The point of the ray that is nearest to the ball, not behind the receiver and
        // not beyond the light.
        let along = dot(to_ball, to_light) / dot(to_light, to_light);
        let end = if is_point == 0.0 { f32::MAX } else { 1.0 };
        let along = along.clamp(0.0, end);
        let miss = [
            to_ball[0] - to_light[0] * along,
            to_ball[1] - to_light[1] * along,
            to_ball[2] - to_light[2] * along,
        ];
        let beside = dot(miss, miss).sqrt() - self.radius;
        let lit = (beside * (1.0 / self.softness)).clamp(0.0, 1.0);
        // A caster does not shade itself: what is in the ball is left out.
        let inside = dot(to_ball, to_ball).lt(value(self.radius * self.radius));
        let shaded = shadowable.gt(value(0.0)) & !inside;
        f.set_color(0, [shaded.select_f32(lit, value(1.0)); 4]);
    }
}

#[inline(always)]
fn dot<L: Lanes>(a: [F32<L>; 3], b: [F32<L>; 3]) -> F32<L> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn main() -> ExitCode {
    gnomon::main_with(&[&BallShadows])
}

#[cfg(test)]
mod tests {
    use super::*;
    use gnomon::pipeline::measure::render::{RenderSettings, Rendered, render};
    use gnomon::pipeline::techniques::Registry;
    use gnomon::pipeline::world::scene::builtin;
    use gnomon::raster::GpuConfig;

    fn registry() -> Registry {
        let mut registry = Registry::built_in();
        registry.register(&BallShadows).unwrap();
        registry
    }

    fn drawn(set: &[&str], gpu: GpuConfig) -> Rendered {
        let scene = builtin::build("spheres").unwrap();
        let registry = registry();
        let technique = registry.find("ball-shadows").unwrap();
        let params = Params::parse(technique, set).unwrap();
        let settings = RenderSettings {
            size: [48, 36],
            gpu,
            ..RenderSettings::default()
        };
        render(&scene, technique, &params, &settings).unwrap()
    }

    /// Pixels in shadow, in the penumbra, and in light.
    fn counts(done: &Rendered) -> [usize; 3] {
        let of = |test: fn(f32) -> bool| done.visibility.iter().filter(|v| test(**v)).count();
        [
            of(|v| v <= 0.0),
            of(|v| v > 0.0 && v < 1.0),
            of(|v| v >= 1.0),
        ]
    }

    #[test]
    fn softness_widens_penumbrae() {
        let hard = counts(&drawn(&["softness=0.01"], GpuConfig::default()));
        let soft = counts(&drawn(&["softness=0.6"], GpuConfig::default()));
        println!("{hard:?} {soft:?}");
        assert!(hard[0] > 20 && hard[2] > 200, "{hard:?}");
        assert!(soft[1] > 2 * hard[1].max(10), "{hard:?} {soft:?}");
        assert_eq!(hard.iter().sum::<usize>(), soft.iter().sum::<usize>());
    }

    /// What the built-in techniques are held to; its stage has no name in the table.
    #[test]
    fn it_conforms() {
        let report = gnomon::conformance::check(&BallShadows).unwrap();
        assert!(
            report.frames > 10 && report.refused.is_empty(),
            "{report:?}"
        );
        assert_eq!(report.unnamed.len(), 1, "{:?}", report.unnamed);
    }

    #[test]
    fn settings_are_checked_like_the_built_in_ones() {
        let registry = registry();
        let technique = registry.find("ball-shadows").unwrap();
        let refused = Params::parse(technique, ["softness=0"]).unwrap_err();
        assert!(
            refused.to_string().contains("a number above 0"),
            "{refused}"
        );
        assert!(registry.find("ball-shadow").is_err());
        assert!(registry.clone().register(&BallShadows).is_err());
    }
}
