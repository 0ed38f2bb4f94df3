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
use gnomon_raster::{
    Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor,
};
use gnomon_shaders::surface::Constant;
use gnomon_shaders::transform::FullScreen;

use crate::parts::casters;
use crate::parts::light_samples::{Pattern, UnknownPattern, light_points};
use crate::parts::passes::{self, LitTest, SceneDraws, Targets};
use crate::parts::visibility::{VisibilityTexture, attachment, full_screen};
use crate::parts::volumes::volume_draws::{self, Casters};
use crate::technique::{
    CasterUse, Frame, ParamInfo, Params, Technique, TechniqueError, VolumeMethod, Warning,
};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct SampledShadowVolumes;

const SAMPLES: ParamInfo = ParamInfo {
    name: "samples",
    default: "64",
    valid: "N",
    summary: "points of the light, a square number from 1 to 4096; the papers have 256 and 1024",
};

const PATTERN: ParamInfo = ParamInfo {
    name: "pattern",
    default: "grid",
    valid: "grid|stratified|rotated-grid",
    summary: "grid: the papers'; stratified: jittered in its cells; rotated-grid: no two in a line",
};

const SEED: ParamInfo = ParamInfo {
    name: "seed",
    default: "1",
    valid: "N",
    summary: "of the jitter of stratified samples, and of the depth of samples in spheres",
};

const ACCUMULATION: ParamInfo = ParamInfo {
    name: "accumulation",
    default: "r32f",
    valid: "r32f|r16f",
    summary: "format in which visibility is summed; r16f is exact up to 1024 samples, powers of 4",
};

/// Most samples that are taken.
const MOST: u32 = 4096;

impl Technique for SampledShadowVolumes {
    fn name(&self) -> &'static str {
        "sampled-shadow-volumes"
    }

    fn summary(&self) -> &'static str {
        "soft shadows as the mean of N hard ones from N points of the light: the papers' reference"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            SAMPLES,
            PATTERN,
            SEED,
            ACCUMULATION,
            volume_draws::METHOD,
            casters::OPEN_CASTERS,
            passes::LIGHT,
            casters::SKIP,
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
    ) -> Result<Frame, TechniqueError> {
        let mut recording = Recording::default();
        let sampling = Sampling::new(self.name(), params)?;
        let targets = Targets::create(size, params, &mut recording)?;
        let format = match params.get(ACCUMULATION.name) {
            "r16f" => Format::R16Float,
            _ => Format::R32Float,
        };
        let [width, height] = size;
        let sum = TextureDescriptor::d2("visibility", format, width, height);
        let sum = VisibilityTexture::red(recording.create(&sum)?);
        let draws = SceneDraws::new(scene, size, params);
        let casters = Casters::new(self.name(), scene, size, params)?;
        let lights = passes::lights(scene, params)?;
        let mut list = vec![draws.ambient_pass(&targets)];
        let (mut uses, mut warnings) = (Vec::new(), Vec::new());
        for &light in lights.iter().rev() {
            let built = sampling.draws(&casters, scene, light)?;
            uses.extend(built.uses);
            warnings.extend(built.warnings);
            list.push(RenderPass {
                label: passes::label("samples", light, &lights),
                color: vec![attachment(sum.texture, LoadOp::Clear([0.0; 4]))],
                depth_stencil: targets.depth_stencil(LoadOp::Load, LoadOp::Load),
                draws: built
                    .draws
                    .into_iter()
                    .chain(draws.not_receiving("fully visible", [1.0, 0.0, 0.0, 0.0]))
                    .collect(),
            });
            let label = passes::label("lit", light, &lights);
            list.push(draws.lit_pass(&targets, light, &label, LitTest::Visibility(sum)));
        }
        let mut frame = targets.frame(recording, list, sum.output())?;
        frame.warnings = warnings;
        frame.casters = uses;
        Ok(frame)
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
    fn new(technique: &'static str, params: &Params) -> Result<Self, TechniqueError> {
        let bad = |key: &'static str, valid: &'static str| TechniqueError::BadValue {
            technique,
            key,
            value: params.get(key).to_owned(),
            valid,
        };
        let squares = "square numbers from 1 to 4096: 1, 4, 9, 16, 64, 256, 1024, ...";
        let samples: u32 = params.get(SAMPLES.name).parse().unwrap_or(0);
        let side = samples.isqrt();
        if side == 0 || side * side != samples || samples > MOST {
            return Err(bad(SAMPLES.name, squares));
        }
        let pattern = params.get(PATTERN.name).parse();
        let seed = params.get(SEED.name).parse();
        Ok(Self {
            side,
            pattern: pattern.map_err(|_: UnknownPattern| bad(PATTERN.name, PATTERN.valid))?,
            seed: seed.map_err(|_| bad(SEED.name, SEED.valid))?,
        })
    }

    /// Volumes and accumulation for each point of light number `light`.
    fn draws(
        &self,
        casters: &Casters<'_>,
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
    /// Adds up what became of each caster; keeps a warning once.
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
                Some(known) => known.count += warning.count,
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
        let scene = builtin::build("cylinder").unwrap();
        for bad in ["0", "2", "1023", "4097", "8100"] {
            let params = Params::parse(technique, [format!("samples={bad}")]).unwrap();
            let done = render(&scene, technique, &params, &RenderSettings::default());
            let message = done.err().unwrap().to_string();
            assert!(
                message.contains(bad) && message.contains("square numbers"),
                "{message}"
            );
        }
    }
}
