//! Two techniques for the lights of one scene: the brightest, or those chosen by
//! number, by one, the others by the other.
//!
//! A scene under an environment has tens of lights, few of which make shadows
//! that are seen as such. Each technique draws its own lights, ambient light with
//! the first ones only; then the second picture is added to the first. So any two
//! techniques of the registry go together, and neither knows of it; any number of them,
//! since one of both may be a mixture itself:
//! `rest=mixed-lights:brightest=4:first=(pcss:samples=16):rest=shadow-map`. The price is
//! a second colour and depth buffer and a second pass for depth, all of it
//! counted.

use gnomon_raster::state::{
    BlendState, ColorTargetState, ColorWrites, DepthStencilState, PrimitiveState,
};
use gnomon_raster::{LoadOp, RenderPass, RenderPipeline, TextureId};
use gnomon_shaders::soft_volumes::Resolve;
use gnomon_shaders::transform::FullScreen;

use crate::param_list;
use crate::parts::casters::SKIP;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::visibility::{attachment, binding, full_screen};
use crate::technique::{
    Capabilities, Condition, Frame, Nested, Param, ParamInfo, Params, PassRole, PictureToKeep,
    ShadowKind, Source, Technique, TechniqueError, Warning,
};
use crate::techniques::find;
use crate::world::light_image::LightImage;
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct MixedLights;

const BRIGHTEST: Param<u32> = Param::<u32>::whole(
    "brightest",
    8,
    [0, u32::MAX as u64],
    "how many lights the first technique draws; visibility is that of the brightest",
)
.unit("lights")
.when(Condition::Is("choose", &["brightest"]));

const CHOOSE: Param<Option<Vec<usize>>> = Param::list_or(
    &["brightest"],
    "choose",
    "lights of the first technique: the brightest, or those of these numbers; visibility is that of the first of them",
);

const FIRST: Param<Nested> = Param::technique(
    "first",
    "soft-shadow-volumes",
    "technique of the brightest lights, with settings behind colons: NAME:KEY=VALUE:...",
);

const REST: Param<Nested> = Param::technique(
    "rest",
    "shadow-volumes",
    "technique of the other lights, likewise",
);

/// Parameters that both techniques get as they are, where they have them.
const SHARED: [&str; 4] = ["skip", "shading", "color-format", "depth-format"];

/// Mixtures within a mixture.
const DEEPEST: usize = 16;

/// Luminance of linear Rec. 709 RGB.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// What parameters decide.
struct MixedSettings {
    brightest: usize,
    /// Numbers of the first technique's lights; `None` for the brightest.
    chosen: Option<Vec<usize>>,
    first: Inner,
    rest: Inner,
    frame: FrameSettings,
}

impl MixedSettings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            brightest: params.get(&BRIGHTEST)? as usize,
            chosen: params.get(&CHOOSE)?,
            first: Inner::read(&FIRST, params)?,
            rest: Inner::read(&REST, params)?,
            frame: FrameSettings::read(params)?,
        })
    }

    /// The first technique's lights, and the others.
    fn shared_out(&self, scene: &Scene) -> Result<(Vec<usize>, Vec<usize>), TechniqueError> {
        let lights = by_brightness(scene, self.frame.lights(scene)?);
        let Some(asked) = &self.chosen else {
            let (bright, others) = lights.split_at(self.brightest.min(lights.len()));
            return Ok((bright.to_vec(), others.to_vec()));
        };
        let count = scene.lights.len();
        let mut chosen = Vec::new();
        for &given in asked {
            if given >= count {
                return Err(TechniqueError::NoSuchLight { given, count });
            }
            if lights.contains(&given) && !chosen.contains(&given) {
                chosen.push(given);
            }
        }
        let mut others = lights;
        others.retain(|l| !chosen.contains(l));
        Ok((chosen, others))
    }

    /// Warnings of a technique that was asked for and has no lights, and of `skip` where
    /// no technique that draws can skip.
    fn unused(&self, params: &Params, bright: &[usize], others: &[usize]) -> Vec<Warning> {
        let idle = |param: &Param<Nested>, lights: &[usize]| {
            let warning = params.in_vain(param.info.name, "it has no lights left to draw");
            warning.filter(|_| lights.is_empty())
        };
        let skips = |inner: &Inner, lights: &[usize]| {
            !lights.is_empty() && inner.params.text(SKIP.info.name).is_some()
        };
        let can_skip = skips(&self.first, bright) || skips(&self.rest, others);
        let skip = params.in_vain(SKIP.info.name, "no technique that draws can leave work out");
        let all = [
            idle(&FIRST, bright),
            idle(&REST, others),
            skip.filter(|_| !can_skip),
        ];
        all.into_iter().flatten().collect()
    }
}

impl Technique for MixedLights {
    fn name(&self) -> &'static str {
        "mixed-lights"
    }

    fn summary(&self) -> &'static str {
        "the brightest lights by one technique, the others by another one"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[
                BRIGHTEST.info,
                CHOOSE.info,
                FIRST.info,
                REST.info,
                SKIP.info,
            ],
            FrameSettings::PARAMS
        )
    }

    /// Those of any technique: what it refuses its parts refuse.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            shadows: ShadowKind::Soft,
            source: Source::Techniques,
            ..Capabilities::UNSHADOWED
        }
    }

    /// Visibility is that of a light of the first technique, if it has any.
    fn light_image(&self, params: &Params) -> Result<Option<LightImage>, TechniqueError> {
        let settings = MixedSettings::read(params)?;
        let none = match &settings.chosen {
            Some(chosen) => chosen.is_empty(),
            None => settings.brightest == 0,
        };
        let seen = if none { settings.rest } else { settings.first };
        seen.technique.light_image(&seen.params)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = MixedSettings::read(params)?;
        let (bright, others) = settings.shared_out(scene)?;
        let (first, rest) = (&settings.first, &settings.rest);
        let mut frame = match (&bright[..], &others[..]) {
            (bright, []) => first.frame(scene, bright, size)?,
            ([], others) => rest.frame(scene, others, size)?,
            (bright, others) => {
                let dark = Scene {
                    background: [0.0; 3],
                    backdrop: None,
                    ..scene.without_ambient()
                };
                let frame = first.frame(scene, bright, size)?;
                joined(frame, rest.frame(&dark, others, size)?)
            }
        };
        frame
            .warnings
            .extend(settings.unused(params, &bright, &others));
        Ok(frame)
    }
}

/// A technique and its settings.
struct Inner {
    technique: &'static dyn Technique,
    params: Params,
}

impl Inner {
    fn read(which: &Param<Nested>, outer: &Params) -> Result<Self, TechniqueError> {
        let given = outer.get(which)?;
        let technique = find(&given.technique)?;
        let within = |text: &String| text.matches(outer.technique()).count();
        if given.settings.iter().map(within).sum::<usize>() >= DEEPEST {
            return Err(TechniqueError::BadValue {
                technique: outer.technique(),
                key: which.info.name,
                value: given.technique,
                valid: format!("mixtures of at most {DEEPEST} techniques more"),
            });
        }
        let mut params = Params::parse(technique, given.settings)?;
        for key in SHARED {
            if let Some(text) = outer.text(key) {
                params.hand_down(key, text);
            }
        }
        Ok(Self { technique, params })
    }

    /// The frame of some lights of `scene`, which keep their numbers in reports.
    fn frame(
        &self,
        scene: &Scene,
        lights: &[usize],
        size: [u32; 2],
    ) -> Result<Frame, TechniqueError> {
        let part = Scene {
            lights: lights.iter().map(|&l| scene.lights[l].clone()).collect(),
            ..scene.clone()
        };
        let frame = self.technique.frame(&part, size, &self.params);
        let mut frame = frame.map_err(|e| numbered(e, lights))?;
        frame.warnings.extend(self.params.without_effect(&part));
        for caster in &mut frame.casters {
            caster.light = lights[caster.light];
        }
        Ok(frame)
    }
}

/// The error with the light's number in the whole scene.
fn numbered(error: TechniqueError, lights: &[usize]) -> TechniqueError {
    match error {
        TechniqueError::UnsuitableLight {
            technique,
            light,
            why,
            valid,
        } => TechniqueError::UnsuitableLight {
            technique,
            light: lights.get(light).copied().unwrap_or(light),
            why,
            valid,
        },
        other => other,
    }
}

/// `lights`, brightest first; equals keep their order.
fn by_brightness(scene: &Scene, mut lights: Vec<usize>) -> Vec<usize> {
    let luminance = |l: usize| -> f64 {
        let colour = scene.lights[l].colour;
        (0..3).map(|c| LUMINANCE[c] * f64::from(colour[c])).sum()
    };
    lights.sort_by(|&a, &b| luminance(b).total_cmp(&luminance(a)));
    lights
}

/// Both frames and a pass that adds the second one's light to the first's.
fn joined(mut frame: Frame, second: Frame) -> Frame {
    let mut rest = second.recording;
    for pass in &mut rest.list.passes {
        pass.label += " (rest)";
    }
    let moved = frame.recording.append(rest);
    let add = addition(frame.outputs.color, moved(second.outputs.color));
    frame.recording.list.passes.push(add);
    frame.roles.append(second.roles);
    frame.roles.push(PassRole::AddPicture, Vec::new());
    frame.warnings.extend(second.warnings);
    frame.casters.extend(second.casters);
    let keep = second.keep.into_iter().map(|picture| PictureToKeep {
        texture: moved(picture.texture),
        ..picture
    });
    frame.keep.extend(keep);
    for mut figure in second.figures {
        figure.name += " (rest)";
        frame.figures.push(figure);
    }
    frame
}

/// Adds red, green and blue of `light` to `color`.
fn addition(color: TextureId, light: TextureId) -> RenderPass {
    let pipeline = RenderPipeline {
        label: "add the rest".into(),
        vertex: FullScreen.stage(),
        fragment: Some(Resolve::Copy.stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState {
            blend: Some(BlendState::ADDITIVE),
            write_mask: ColorWrites(0b111), // alpha stays
        }],
    };
    RenderPass {
        label: "add the rest".into(),
        color: vec![attachment(color, LoadOp::Load)],
        depth_stencil: None,
        draws: vec![full_screen(pipeline, vec![binding(light)])],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::render::{RenderSettings, Rendered, render};
    use crate::world::light::Light;
    use crate::world::scene::builtin;
    use glam::DVec3;

    /// Three lights, the second one the brightest, the first one the faintest.
    fn scene() -> Scene {
        let mut scene = builtin::build("creature").unwrap();
        let light = |x: f64, z: f64, bright: f32| Light {
            colour: [bright; 3],
            ..Light::horizontal_square(DVec3::new(x, 4.0, z), 0.7)
        };
        scene.lights = vec![
            light(2.0, 2.0, 0.125),
            light(-2.0, 1.0, 0.5),
            light(0.5, -2.0, 0.25),
        ];
        scene
    }

    fn drawn(scene: &Scene, technique: &str, set: &[&str]) -> Rendered {
        let technique = find(technique).unwrap();
        let params = Params::parse(technique, set).unwrap();
        let settings = RenderSettings {
            size: [72, 54],
            ..RenderSettings::default()
        };
        render(scene, technique, &params, &settings).unwrap()
    }

    const MIXED: &str = "mixed-lights";

    #[test]
    fn all_lights_by_one_technique_are_that_technique() {
        let mut scene = scene();
        scene.lights.swap(0, 1); // brightest first, as the mixture orders them
        scene.lights.swap(1, 2);
        let soft = drawn(&scene, "soft-shadow-volumes", &[]);
        let hard = drawn(&scene, "shadow-volumes", &["method=zfail"]);
        let all = drawn(&scene, MIXED, &["brightest=3"]);
        let none = drawn(
            &scene,
            MIXED,
            &["brightest=0", "rest=shadow-volumes:method=zfail"],
        );
        assert!(all.srgb == soft.srgb && none.srgb == hard.srgb);
        assert!(all.srgb != none.srgb);
        assert_eq!(all.report.passes.len(), soft.report.passes.len());
    }

    /// The mixture is the sum of its parts, up to the rounding of 16-bit floats.
    #[test]
    fn parts_add_up() {
        let scene = scene();
        let set = [
            "brightest=1",
            "first=soft-shadow-volumes:wedge=paper3",
            "rest=shadow-volumes",
        ];
        let mixed = drawn(&scene, MIXED, &set);
        let part = |technique, lights: &[usize], ambient: [f32; 3]| {
            let mut part = scene.clone();
            part.lights = lights.iter().map(|&l| scene.lights[l].clone()).collect();
            part.ambient = ambient;
            drawn(&part, technique, &[])
        };
        let soft = part("soft-shadow-volumes", &[1], scene.ambient);
        let hard = part("shadow-volumes", &[2, 0], [0.0; 3]);
        let bits = |v: &[f32]| -> Vec<u32> { v.iter().map(|v| v.to_bits()).collect() };
        assert_eq!(bits(&mixed.visibility), bits(&soft.visibility));
        let mut seen = 0;
        for i in (0..72 * 54).filter(|i| mixed.depth[*i] < 1.0) {
            for c in 0..3 {
                let sum = soft.color[i][c] + hard.color[i][c];
                let off = (mixed.color[i][c] - sum).abs();
                assert!(off <= 2e-3 * sum.max(0.1), "{i}: {sum}");
                seen += usize::from(hard.color[i][c] > 0.01);
            }
        }
        assert!(seen > 1000);
    }

    /// Chosen by number, in the order given: as if these were the brightest.
    #[test]
    fn lights_are_chosen_by_number() {
        let scene = scene();
        let brightest = drawn(&scene, MIXED, &["brightest=2"]);
        let chosen = drawn(&scene, MIXED, &["choose=1+2"]);
        assert!(chosen.srgb == brightest.srgb);
        let other = drawn(&scene, MIXED, &["choose=0", "brightest=2"]);
        assert!(other.srgb != brightest.srgb);
        let twice = drawn(&scene, MIXED, &["choose=0+0"]);
        assert!(twice.srgb == other.srgb);
    }

    /// A mixture within the mixture: three techniques, each with its own lights, add up.
    #[test]
    fn any_number_of_techniques_goes_together() {
        let scene = scene();
        let set = [
            "brightest=1",
            "first=unshadowed",
            "rest=mixed-lights:brightest=1:first=(pcss:samples=4:map-size=64):rest=shadow-volumes",
        ];
        let mixed = drawn(&scene, MIXED, &set);
        let part = |technique, light: usize, set: &[&str]| {
            let mut part = scene.clone();
            part.lights = vec![scene.lights[light].clone()];
            part.ambient = if light == 1 { scene.ambient } else { [0.0; 3] };
            drawn(&part, technique, set)
        };
        let parts = [
            part("unshadowed", 1, &[]),
            part("pcss", 2, &["samples=4", "map-size=64"]),
            part("shadow-volumes", 0, &[]),
        ];
        for i in (0..72 * 54).filter(|i| mixed.depth[*i] < 1.0) {
            for c in 0..3 {
                let sum: f32 = parts.iter().map(|p| p.color[i][c]).sum();
                let off = (mixed.color[i][c] - sum).abs();
                assert!(off <= 3e-3 * sum.max(0.1), "{i}: {sum}");
            }
        }
        let two = drawn(
            &scene,
            MIXED,
            &["brightest=1", "first=unshadowed", "rest=pcss:samples=4"],
        );
        assert!(two.srgb != mixed.srgb);
    }

    /// Images on lights are the truth's too, however deep they are asked for.
    #[test]
    fn images_on_lights_are_told() {
        let technique = find(MIXED).unwrap();
        let image = |set: &[&str]| {
            let params = Params::parse(technique, set).unwrap();
            technique.light_image(&params).unwrap()
        };
        let own = "soft-shadow-volumes:light-image=fire";
        assert!(image(&[]).is_none());
        assert!(image(&[&format!("first={own}")]).is_some());
        assert!(image(&[&format!("rest={own}")]).is_none());
        let deep = format!("rest=mixed-lights:first=({own})");
        assert!(image(&["brightest=0", &deep]).is_some());
    }

    #[test]
    fn techniques_are_checked() {
        let technique = find(MIXED).unwrap();
        let scene = scene();
        let refused = |set: &str| {
            let params = Params::parse(technique, [set]).unwrap();
            let done = render(&scene, technique, &params, &RenderSettings::default());
            done.err().unwrap().to_string()
        };
        assert!(refused("first=soft-shadow-volume").contains("did you mean"));
        let deep = format!("rest=mixed-lights{}", ":rest=mixed-lights".repeat(40));
        assert!(refused(&deep).contains("at most 16"));
        let open = Params::parse(technique, ["rest=mixed-lights:first=(pcss"]).unwrap_err();
        assert!(open.to_string().contains("parentheses"), "{open}");
        assert!(refused("rest=shadow-volumes:method=zz").contains("auto|zpass|zfail"));
        assert!(refused("light=7").contains("light 7"));
        assert!(refused("choose=0+7").contains("light 7"));
        let word = Params::parse(technique, ["choose=0+a"]).unwrap_err();
        assert!(
            word.to_string().contains("brightest, or whole numbers"),
            "{word}"
        );
    }
}
