//! The papers' reference: the mean of N hard shadow images, one for each of N
//! points of the light, all of it on the emulated GPU, so that its traffic is
//! counted (paper III §5, paper IV §6; docs/papers.md, baselines).
//!
//! A pass for each light has, for each point, the volumes of all casters into
//! the stencil, and then one triangle over the whole image that adds 1/N to a
//! float texture where the stencil is 0, and sets it to 0 elsewhere: ready for
//! the next point without a clear. Then one lit pass reads the texture, shading
//! as from the light's centre. So the N images differ from the papers' in that
//! shading is done once and not N times.
//!
//! Where N is a power of four up to 1024 the sums are exact, in `r16f` too;
//! otherwise they are off by some rounding steps of the format, and limited
//! to 1.
//!
//! All volumes of a light are held at a time: some hundred bytes for each
//! silhouette edge and point.

use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthStencilState, PrimitiveState, StencilFaceState,
    StencilOperation, StencilState,
};
use gnomon_raster::{Draw, Format, LoadOp, RenderPass, RenderPipeline, TextureDescriptor};
use gnomon_shaders::surface::Constant;
use gnomon_shaders::transform::FullScreen;

use crate::parts::frame_settings::FrameSettings;
use crate::parts::light_samples::{Pattern, light_points};
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::{VisibilityTexture, attachment, full_screen};
use crate::parts::volumes::volume_draws::{VolumeCasters, VolumeSettings};
use crate::technique::{
    Capabilities, CasterUse, Condition, Frame, LightFact, Param, ParamInfo, Params, Pass, PassRole,
    ShadowKind, Technique, TechniqueError, VolumeMethod, Warning,
};
use crate::world::scene::Scene;
use crate::{choices, param_list};

/// The registry's entry.
pub(crate) struct SampledShadowVolumes;

const SAMPLES: Param<u32> = Param::<u32>::square(
    "samples",
    64,
    [1, 4096],
    "points of the light, a square number from 1 to 4096; the papers have 256 and 1024",
)
.when(Condition::Lights(LightFact::Extended));

const PATTERN: Param<Pattern> = Param::choice(
    "pattern",
    "grid",
    "grid: the papers'; stratified: jittered in its cells; rotated-grid: no two in a line",
)
.when(Condition::Lights(LightFact::Extended));

const SEED: Param<u64> = Param::<u64>::whole(
    "seed",
    1,
    [0, u32::MAX as u64],
    "of the jitter of stratified samples, and of the depth of samples in spheres",
)
.when(Condition::Any(&[
    Condition::All(&[
        Condition::Is("pattern", &["stratified"]),
        Condition::Lights(LightFact::Extended),
    ]),
    Condition::Lights(LightFact::Sphere),
]));

choices! {
    /// What visibility is summed in.
    enum Accumulation {
        /// 32-bit floats.
        R32f = "r32f",
        /// 16-bit floats.
        R16f = "r16f",
    }
}

const ACCUMULATION: Param<Accumulation> = Param::choice(
    "accumulation",
    Accumulation::R32f.word(),
    "format in which visibility is summed; r16f is exact up to 1024 samples, powers of 4",
);

impl Accumulation {
    fn format(self) -> Format {
        match self {
            Self::R32f => Format::R32Float,
            Self::R16f => Format::R16Float,
        }
    }
}

/// What parameters decide.
struct SampledSettings {
    sampling: Sampling,
    accumulation: Accumulation,
    volumes: VolumeSettings,
    frame: FrameSettings,
}

impl SampledSettings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            sampling: Sampling {
                side: params.get(&SAMPLES)?.isqrt(),
                pattern: params.get(&PATTERN)?,
                seed: params.get(&SEED)?,
            },
            accumulation: params.get(&ACCUMULATION)?,
            volumes: VolumeSettings::read(params)?,
            frame: FrameSettings::read(params)?,
        })
    }
}

impl Technique for SampledShadowVolumes {
    fn name(&self) -> &'static str {
        "sampled-shadow-volumes"
    }

    fn summary(&self) -> &'static str {
        "soft shadows as the mean of N hard ones from N points of the light: the papers' reference"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[SAMPLES.info, PATTERN.info, SEED.info, ACCUMULATION.info],
            VolumeSettings::PARAMS,
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_silhouettes(ShadowKind::Soft)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = SampledSettings::read(params)?;
        let casters = VolumeCasters::new(scene, size, &settings.volumes)?;
        let mut frame = ShadowedFrame::new(scene, size, &settings.frame)?.with_ambient();
        let [width, height] = size;
        let format = settings.accumulation.format();
        let sum = TextureDescriptor::d2("visibility", format, width, height);
        let sum = VisibilityTexture::red(frame.recording.create(&sum)?);
        frame.lit(LitTest::Visibility(sum), |light| {
            let pass = settings.sampling.pass(&casters, sum, light)?;
            Ok(vec![Pass::new(PassRole::Samples, pass)])
        })
    }
}

/// How the light is sampled.
#[derive(Clone, Copy, Debug)]
struct Sampling {
    side: u32,
    pattern: Pattern,
    seed: u64,
}

/// The draws of all points of a light.
#[derive(Default)]
struct Sampled {
    draws: Vec<Draw>,
    /// One for each caster, all points together.
    uses: Vec<CasterUse>,
    warnings: Vec<Warning>,
}

impl Sampling {
    /// Adds up hard shadows of all points of a light in `sum`.
    fn pass(
        &self,
        casters: &VolumeCasters<'_>,
        sum: VisibilityTexture,
        light: &mut LightTurn<'_, '_>,
    ) -> Result<RenderPass, TechniqueError> {
        let built = self.draws(casters, light.scene, light.number)?;
        light.notes.casters.extend(built.uses);
        light.notes.warnings.extend(built.warnings);
        let lit = light
            .draws
            .not_receiving("fully visible", [1.0, 0.0, 0.0, 0.0]);
        Ok(RenderPass {
            label: light.label("samples"),
            color: vec![attachment(sum.texture, LoadOp::Clear([0.0; 4]))],
            depth_stencil: light.targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws: built.draws.into_iter().chain(lit).collect(),
        })
    }

    /// Volumes and accumulation for each point of light number `light`.
    fn draws(
        &self,
        casters: &VolumeCasters<'_>,
        scene: &Scene,
        light: usize,
    ) -> Result<Sampled, TechniqueError> {
        let points = light_points(&scene.lights[light], self.pattern, self.side, self.seed)?;
        let add = accumulation(1.0 / points.len() as f32);
        let mut sampled = Sampled::default();
        for point in points {
            let built = casters.volumes(light, point, &[ColorTargetState::NONE]);
            sampled.draws.extend(built.draws);
            sampled.draws.push(add.clone());
            sampled.join(built.uses, built.warnings);
        }
        Ok(sampled)
    }
}

impl Sampled {
    /// Adds up what became of each caster; keeps a warning once, with its largest
    /// count.
    fn join(&mut self, uses: Vec<CasterUse>, warnings: Vec<Warning>) {
        if self.uses.is_empty() {
            self.uses = uses;
        } else {
            for (all, one) in self.uses.iter_mut().zip(uses) {
                all.method = dearer(all.method, one.method);
                for (sum, triangles) in all.triangles.iter_mut().zip(one.triangles) {
                    *sum += triangles;
                }
            }
        }
        for warning in warnings {
            match self
                .warnings
                .iter_mut()
                .find(|w| w.message == warning.message)
            {
                Some(known) => known.count = known.count.max(warning.count),
                None => self.warnings.push(warning),
            }
        }
    }
}

/// What is said of a caster whose volumes were counted in both ways.
fn dearer(a: VolumeMethod, b: VolumeMethod) -> VolumeMethod {
    use VolumeMethod::{DepthFail, DepthPass, Skipped};
    match (a, b) {
        (DepthFail, _) | (_, DepthFail) => DepthFail,
        (DepthPass, _) | (_, DepthPass) => DepthPass,
        (Skipped, Skipped) => Skipped,
    }
}

/// Adds `weight` where the stencil is 0, and makes it 0 elsewhere.
fn accumulation(weight: f32) -> Draw {
    let face = StencilFaceState {
        compare: CompareFunction::Equal,
        fail_op: StencilOperation::Zero,
        ..StencilFaceState::IGNORE
    };
    let pipeline = RenderPipeline {
        label: "accumulate".into(),
        vertex: FullScreen.stage(),
        fragment: Some(Constant([weight, 0.0, 0.0, 0.0]).stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState {
            stencil: StencilState {
                front: face,
                back: face,
            },
            ..DepthStencilState::default()
        },
        color_targets: vec![ColorTargetState::ADDITIVE],
    };
    full_screen(pipeline, Vec::new())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::render::{RenderSettings, Rendered, render};
    use crate::techniques::find;
    use crate::world::light::LightShape;
    use crate::world::scene::builtin;

    fn rendered(scene: &Scene, technique: &str, given: &[&str]) -> Rendered {
        let technique = find(technique).unwrap();
        let params = Params::parse(technique, given).unwrap();
        let settings = RenderSettings {
            size: [72, 54],
            ..RenderSettings::default()
        };
        render(scene, technique, &params, &settings).unwrap()
    }

    fn bits(values: &[f32]) -> Vec<u32> {
        values.iter().map(|v| v.to_bits()).collect()
    }

    /// One sample of a grid is the light's centre.
    #[test]
    fn one_sample_is_the_hard_shadow_to_the_bit() {
        for name in ["cylinder", "creature", "adversarial-near-plane"] {
            let scene = builtin::build(name).unwrap();
            for method in ["method=zfail", "method=auto"] {
                let hard = rendered(&scene, "shadow-volumes", &[method]);
                for format in ["accumulation=r32f", "accumulation=r16f"] {
                    let given = ["samples=1", method, format];
                    let one = rendered(&scene, "sampled-shadow-volumes", &given);
                    assert_eq!(bits(&one.visibility), bits(&hard.visibility), "{name}");
                    assert!(one.srgb == hard.srgb, "{name} {method} {format}");
                }
            }
        }
    }

    /// The sum over the samples is the mean of hard shadows rendered one by one.
    #[test]
    fn visibility_is_the_mean_of_the_hard_shadows() {
        let scene = builtin::build("creature").unwrap();
        let points = light_points(&scene.lights[0], Pattern::Stratified, 4, 9).unwrap();
        let mut sum = vec![0.0f32; 72 * 54];
        for point in points {
            let mut hard = scene.clone();
            let crate::world::light::HardLight::Point(position) = point else {
                panic!("a square has points");
            };
            hard.lights[0].shape = LightShape::Point { position };
            let one = rendered(&hard, "shadow-volumes", &["method=zfail"]);
            for (sum, v) in sum.iter_mut().zip(one.visibility) {
                *sum += v / 16.0;
            }
        }
        let given = ["samples=16", "pattern=stratified", "seed=9", "method=zfail"];
        for format in ["accumulation=r32f", "accumulation=r16f"] {
            let given: Vec<&str> = given.iter().copied().chain([format]).collect();
            let all = rendered(&scene, "sampled-shadow-volumes", &given);
            let same = |(a, b): (&f32, &f32)| a == b || (a.is_nan() && b.is_nan());
            assert!(all.visibility.iter().zip(&sum).all(same), "{format}");
            assert!(all.visibility.iter().any(|v| *v > 0.0 && *v < 1.0));
            assert!(all.stencil.iter().all(|s| *s == 0));
        }
    }

    #[test]
    fn hard_lights_have_one_sample() {
        let mut scene = builtin::build("cylinder").unwrap();
        let towards = glam::DVec3::new(0.4, 1.0, 0.3);
        scene.lights[0].shape = LightShape::Directional { towards };
        let hard = rendered(&scene, "shadow-volumes", &[]);
        let sampled = rendered(&scene, "sampled-shadow-volumes", &["samples=1024"]);
        assert_eq!(bits(&sampled.visibility), bits(&hard.visibility));
    }

    #[test]
    fn objects_that_take_no_shadow_are_fully_visible() {
        let mut scene = builtin::build("cylinder").unwrap();
        scene.objects.iter_mut().for_each(|o| o.receives = false);
        let done = rendered(&scene, "sampled-shadow-volumes", &["samples=4"]);
        assert!(done.visibility.iter().all(|v| v.is_nan() || *v == 1.0));
        assert!(done.srgb == rendered(&scene, "unshadowed", &[]).srgb);
    }

    #[test]
    fn sample_counts_are_checked() {
        let technique = find("sampled-shadow-volumes").unwrap();
        for bad in ["0", "2", "1023", "4097", "8100"] {
            let refused = Params::parse(technique, [format!("samples={bad}")]);
            let message = refused.err().unwrap().to_string();
            assert!(
                message.contains(bad) && message.contains("square numbers"),
                "{message}"
            );
        }
    }
}
