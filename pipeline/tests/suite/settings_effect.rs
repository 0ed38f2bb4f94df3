//! Every setting either changes something or is warned of, in every combination with
//! any other setting.
//!
//! For each technique, each parameter X and each value of each other parameter Y: where
//! a setting of X is warned of as without effect, picture, visibility, counters, casters
//! and figures are those without it, to the bit; where it is not, one of them differs in
//! some scene, or the setting is refused.

use std::collections::BTreeMap;

use glam::DVec3;
use gnomon_pipeline::measure::render::{RenderSettings, render};
use gnomon_pipeline::technique::{
    Domain, ParamInfo, Params, SETTING_WITHOUT_EFFECT, Technique, Whole,
};
use gnomon_pipeline::techniques::{self, find};
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::environment::{EnvironmentRequest, FittedMaps};
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene};
use gnomon_pipeline::world::shape::{self, Shape};
use gnomon_raster::GpuConfig;

const SIZE: [u32; 2] = [40, 30];

/// What makes the matrix cheap; samples of a parameter are taken round these values.
const CHEAP: [(&str, &str); 7] = [
    ("map-size", "64"),
    ("texture-size", "4"),
    ("maps", "4"),
    ("search-samples", "4"),
    ("brightest", "1"),
    ("first", "pcf:map-size=64"),
    ("rest", "shadow-volumes"),
];

/// Settings that change nothing by design of the technique, with the reason. Parameter
/// X, and `Y=y` or nothing.
const EXEMPT: [(&str, &str, &str); 3] = [
    (
        "smoothies fit ",
        "width=3.2",
        "smoothies as wide as all that is seen: views hold everything",
    ),
    (
        "deferred-shadowing seed",
        "lights=2",
        "from wherever two sites begin they relax to the same regions",
    ),
    (
        "deferred-shadowing plane",
        "groups=all",
        "the ball behind the eye is in the group, whose middle strikes nothing",
    ),
];

/// Everything that a setting could change.
#[derive(PartialEq)]
struct Print {
    picture: (String, String),
    passes: String,
    casters: String,
    figures: String,
    /// Starts of the messages of settings without effect: `technique: key=value `.
    told: Vec<String>,
}

impl Print {
    fn same_as(&self, other: &Self) -> bool {
        self.picture == other.picture
            && self.passes == other.passes
            && self.casters == other.casters
            && self.figures == other.figures
    }
}

fn print(scene: &Scene, technique: &dyn Technique, set: &[String]) -> Result<Print, String> {
    let params = Params::parse(technique, set).map_err(|e| e.to_string())?;
    let settings = RenderSettings {
        size: SIZE,
        gpu: GpuConfig {
            threads: 1,
            ..GpuConfig::default()
        },
        repeat: 1,
    };
    let done = render(scene, technique, &params, &settings).map_err(|e| e.to_string())?;
    let passes = done.report.passes.iter();
    let passes: Vec<_> = passes.map(|p| (&p.label, p.totals())).collect();
    let told = done
        .warnings
        .iter()
        .filter(|w| w.code == SETTING_WITHOUT_EFFECT);
    Ok(Print {
        picture: (done.color_hash(), done.visibility_hash()),
        passes: format!("{passes:?}"),
        casters: format!("{:?}", done.casters),
        figures: format!("{:?}", done.figures),
        told: told.map(|w| w.message.clone()).collect(),
    })
}

fn solid(shape: Shape) -> Mesh {
    shape.into_mesh(Shading::Smooth).unwrap()
}

/// Two boxes in a row with a hole's width between them, in one mesh: two outlines that
/// overlap seen from a light above.
fn two_boxes() -> Shape {
    let lower = shape::cuboid(DVec3::new(0.0, 0.5, 0.0), DVec3::new(1.2, 0.2, 1.0));
    let upper = shape::cuboid(DVec3::new(0.3, 1.0, 0.2), DVec3::new(1.0, 0.2, 0.8));
    Shape::merged([lower, upper])
}

/// The same without some triangles.
fn open_boxes() -> Shape {
    let mut shape = two_boxes();
    shape.triangles.truncate(20);
    shape
}

/// A floor, a caster and a ball over it, a prism with acute edges, a ball far behind
/// the eye, and one that takes no shadow.
fn scene(lights: Vec<Light>, caster: Shape) -> Scene {
    let material = Material::glossy([0.7, 0.6, 0.5], 0.6, 20.0);
    let ball = |at: [f64; 3]| solid(shape::icosphere(1, 0.4, DVec3::from_array(at)));
    let mut quiet = Object::new("quiet", ball([-1.5, 0.5, 0.5]), material);
    quiet.receives = false;
    let prism = shape::cylinder(3, 0.4, 0.2, 0.6).translated(DVec3::new(1.3, 0.0, 0.2));
    let prism = prism.into_mesh(Shading::Flat).unwrap();
    let floor = shape::plane(6.0, 0.0).into_mesh(Shading::Flat).unwrap();
    let caster = caster.into_mesh(Shading::Flat).unwrap();
    Scene::new(
        Camera::look_at([0.4, 2.2, 4.5], [0.0, 0.5, 0.0]),
        lights,
        vec![
            Object::new("floor", floor, material).receiver_only(),
            Object::new("caster", caster, material),
            Object::new("upper", ball([0.2, 1.7, 0.1]), material),
            Object::new("prism", prism, material),
            Object::new("behind", ball([0.0, 3.0, 40.0]), material),
            quiet,
        ],
    )
}

fn lamp(shape: LightShape, bright: f32) -> Light {
    Light {
        shape,
        colour: [bright, 0.8 * bright, 0.5 * bright],
    }
}

/// Twice as long as wide.
fn rectangle(x: f64, z: f64, bright: f32) -> Light {
    let shape = LightShape::Rectangle {
        centre: DVec3::new(x, 4.0, z),
        edge_u: DVec3::X * 1.6,
        edge_v: DVec3::Z * 0.8,
    };
    lamp(shape, bright)
}

pub(crate) fn scenes() -> Vec<Scene> {
    let ball = lamp(
        LightShape::Sphere {
            centre: DVec3::new(0.8, 3.6, 0.6),
            radius: 0.6,
        },
        0.6,
    );
    let position = DVec3::new(0.8, 3.6, 0.6);
    let point = lamp(LightShape::Point { position }, 0.6);
    let two = || vec![rectangle(0.5, 0.3, 0.4), rectangle(-1.5, -1.0, 0.6)];
    let mut in_shadow = scene(two(), two_boxes());
    in_shadow.camera = Camera::look_at([0.2, 0.25, 0.3], [0.0, 0.0, -1.0]);
    vec![
        scene(two(), two_boxes()),
        scene(vec![ball], two_boxes()),
        in_shadow,
        scene(vec![rectangle(0.5, 0.3, 0.6)], open_boxes()),
        scene(vec![point], two_boxes()),
    ]
}

/// Three objects under an environment.
pub(crate) fn under_sky() -> Scene {
    let mut scene = scene(Vec::new(), two_boxes());
    let mut request = EnvironmentRequest::new("sky");
    request.settings.side = 8;
    request.fit.lights = 6;
    let known = &mut FittedMaps::default();
    request.light(&mut scene, known).unwrap();
    scene
}

/// Two lights over 256 plates: as many volumes as an 8-bit stencil takes for none.
fn stack() -> Scene {
    let plate = |k: u32| {
        let centre = DVec3::new(0.0, 0.4 + 0.004 * f64::from(k), 0.0);
        shape::cuboid(centre, DVec3::new(1.4, 0.002, 1.2))
    };
    let lights = vec![rectangle(0.5, 0.3, 0.4), rectangle(-0.5, -0.2, 0.6)];
    scene(lights, Shape::merged((0..256).map(plate)))
}

/// Values of a parameter besides the one that it has.
fn samples(info: &ParamInfo, now: &str) -> Vec<String> {
    let mut all: Vec<String> = info
        .domain
        .words()
        .iter()
        .map(|w| (*w).to_owned())
        .collect();
    let number = now.parse::<f64>().ok();
    match info.domain {
        Domain::Words(_) => {}
        Domain::Whole { range, kind, .. } => {
            let from = number.map_or(range[0].max(1), |n| n as u64);
            let near = match kind {
                Whole::Any => [range[0], from + 1, from / 2],
                Whole::PowerOfTwo => [from / 2, from * 2, range[0]],
                Whole::Square => {
                    let side = from.isqrt();
                    [range[0], (side + 1) * (side + 1), side * side / 4]
                }
            };
            all.extend(near.iter().map(u64::to_string));
        }
        Domain::Decimal { .. } => {
            // Nearer than some casters are to the lights, and farther than others.
            let from = number.unwrap_or(1.6);
            all.extend(
                [0.0, 0.5 * from + 0.1, 2.0 * from]
                    .iter()
                    .map(f64::to_string),
            );
        }
        Domain::List { .. } => all.extend(["1".to_owned(), "1+0".to_owned()]),
        // Words stand for them here; files have a suite of their own.
        Domain::Images { .. } => {}
        Domain::Technique => {
            all.extend(["shadow-map:map-size=64".to_owned(), "unshadowed".to_owned()])
        }
    }
    all.retain(|v| info.domain.takes(v) && !info.domain.same(v, now));
    all.dedup();
    all.truncate(3);
    all
}

/// Cheap settings of a technique.
pub(crate) fn base(technique: &dyn Technique) -> Vec<String> {
    let has = |key: &str| technique.params().iter().any(|p| p.name == key);
    let mut base: Vec<(&str, &str)> = CHEAP.into_iter().filter(|(k, _)| has(k)).collect();
    let name = technique.name();
    if name.starts_with("sampled") || ["ray-traced", "heckbert-herf"].contains(&name) {
        base.push(("samples", "4"));
    }
    if name == DEFERRED {
        base.extend([("map-size", "16"), ("directions", "64"), ("lights", "4")]);
    }
    base.iter().map(|(k, v)| format!("{k}={v}")).collect()
}

/// A technique with cheap settings, and what it draws with others.
struct Matrix<'a> {
    technique: &'static dyn Technique,
    scenes: &'a [Scene],
    known: BTreeMap<(usize, Vec<String>), Result<Print, String>>,
    /// Settings that neither change anything nor are warned of, or both.
    wrong: Vec<String>,
}

impl Matrix<'_> {
    fn draw(&mut self, scene: usize, set: &[String]) -> &Result<Print, String> {
        let key = (scene, set.to_vec());
        let (technique, scenes) = (self.technique, self.scenes);
        self.known
            .entry(key)
            .or_insert_with(|| print(&scenes[scene], technique, set))
    }

    /// The value of `key` after the settings `set`.
    fn value(&self, key: &str, set: &[String]) -> String {
        let params = Params::parse(self.technique, set).unwrap();
        params.text(key).unwrap().to_owned()
    }

    /// All settings of `x` together with `set`.
    fn check(&mut self, x: &ParamInfo, set: &[String]) {
        let values = samples(x, &self.value(x.name, set));
        let name = self.technique.name();
        let (mut applies, mut changes) = (false, false);
        for scene in 0..self.scenes.len() {
            for value in &values {
                let more = [set, &[format!("{}={value}", x.name)]].concat();
                let vain = self.in_vain(scene, &more, x.name);
                if changes && !vain {
                    continue;
                }
                let (told, same) = self.compared(scene, set, &more, x.name);
                if told && !same {
                    let wrong = format!("{name} {more:?}: acts, although warned of");
                    self.wrong.push(wrong);
                }
                applies |= !told && self.draw(scene, set).is_ok();
                changes |= !told && !same;
                if vain {
                    break; // one value shows it
                }
            }
        }
        if applies && !changes {
            let silent = format!("{name} {} with {set:?}: changes nothing", x.name);
            self.wrong.push(silent);
        }
    }

    /// Whether the declaration says that `key` has no effect.
    fn in_vain(&self, scene: usize, set: &[String], key: &str) -> bool {
        let params = Params::parse(self.technique, set).unwrap();
        let told = format!("{}: {key}=", self.technique.name());
        let warnings = params.without_effect(&self.scenes[scene]);
        warnings.iter().any(|w| w.message.starts_with(&told))
    }

    /// Whether `more` is warned of for `key`, and whether it draws what `set` draws, or
    /// is refused like it.
    fn compared(
        &mut self,
        scene: usize,
        set: &[String],
        more: &[String],
        key: &str,
    ) -> (bool, bool) {
        let told = format!("{}: {key}=", self.technique.name());
        let refused = self.draw(scene, set).is_err();
        let drawn = print(&self.scenes[scene], self.technique, more);
        let (Ok(drawn), Ok(without)) = (drawn.as_ref(), &self.known[&(scene, set.to_vec())]) else {
            return (false, refused == drawn.is_err());
        };
        let told = drawn.told.iter().any(|m| m.starts_with(&told));
        (told, drawn.same_as(without))
    }

    fn all_pairs(&mut self) {
        let params = self.technique.params();
        let base = base(self.technique);
        for x in params {
            self.check(x, &base);
            for y in params.iter().filter(|y| y.name != x.name) {
                for value in samples(y, &self.value(y.name, &base)).into_iter().take(2) {
                    let set = [&base[..], &[format!("{}={value}", y.name)]].concat();
                    self.check(x, &set);
                }
            }
        }
    }
}

fn wrong_settings(technique: &'static dyn Technique, scenes: &[Scene]) -> Vec<String> {
    let mut matrix = Matrix {
        technique,
        scenes,
        known: BTreeMap::new(),
        wrong: Vec::new(),
    };
    matrix.all_pairs();
    matrix.wrong
}

fn check(names: &[&str]) {
    let (scenes, mut wrong) = (scenes(), Vec::new());
    let with_stack = [&scenes[..], &[stack()]].concat();
    let with_sky = [&[under_sky()], &scenes[..2]].concat();
    for name in names {
        let technique = find(name).unwrap();
        let counts = technique.params().iter().any(|p| p.name == "overflow");
        let scenes = match *name {
            DEFERRED => &with_sky,
            _ if counts => &with_stack,
            _ => &scenes,
        };
        wrong.extend(wrong_settings(technique, scenes));
    }
    wrong.retain(|s| {
        !EXEMPT
            .iter()
            .any(|(start, with, _)| s.starts_with(start) && s.contains(with))
    });
    assert!(wrong.is_empty(), "settings:\n{}", wrong.join("\n"));
}

pub(crate) const VOLUMES: [&str; 3] = ["unshadowed", "shadow-volumes", "sampled-shadow-volumes"];
pub(crate) const WEDGES: [&str; 2] = ["penumbra-wedges", "penumbra-wedges-restructured"];
pub(crate) const SOFT: [&str; 2] = ["soft-shadow-volumes", "soft-shadow-volumes-optimised"];
pub(crate) const LINES: [&str; 1] = ["line-sampled-shadow-volumes"];
pub(crate) const MAPS: [&str; 4] = ["shadow-map", "pcf", "pcss", "shadow-maps-n"];
pub(crate) const MOMENTS: [&str; 4] = ["vsm", "evsm", "msm", "vssm"];
pub(crate) const PLANAR: [&str; 2] = ["soler-sillion", "heckbert-herf"];
pub(crate) const RAYS: [&str; 1] = ["ray-traced"];
pub(crate) const BACKPROJECTED: [&str; 2] = ["backprojection", "bitmask"];
pub(crate) const DEFERRED: &str = "deferred-shadowing";
pub(crate) const CONES: [&str; 2] = ["cone-culling", "smoothies"];
pub(crate) const OTHERS: [&str; 2] = ["convolution-soft-shadows", "mixed-lights"];

/// All of them.
pub(crate) const ALL: [&[&str]; 12] = [
    &VOLUMES,
    &WEDGES,
    &SOFT,
    &LINES,
    &MAPS,
    &MOMENTS,
    &BACKPROJECTED,
    &RAYS,
    &PLANAR,
    &CONES,
    &OTHERS,
    &[DEFERRED],
];

#[test]
fn no_technique_is_left_out() {
    let checked = ALL.concat();
    for technique in techniques::all() {
        assert!(checked.contains(&technique.name()), "{}", technique.name());
    }
}

#[test]
fn settings_of_volumes_act_or_are_warned_of() {
    check(&VOLUMES);
}

#[test]
fn settings_of_linked_wedges_act_or_are_warned_of() {
    check(&WEDGES);
}

#[test]
fn settings_of_soft_volumes_act_or_are_warned_of() {
    check(&SOFT);
}

#[test]
fn settings_of_lines_act_or_are_warned_of() {
    check(&LINES);
}

#[test]
fn settings_of_light_views_act_or_are_warned_of() {
    check(&MAPS);
}

#[test]
fn settings_of_moment_maps_act_or_are_warned_of() {
    check(&MOMENTS);
}

#[test]
fn settings_of_backprojection_act_or_are_warned_of() {
    check(&BACKPROJECTED);
}

#[test]
fn settings_of_rays_act_or_are_warned_of() {
    check(&RAYS);
}

#[test]
fn settings_of_planar_shadows_act_or_are_warned_of() {
    check(&PLANAR);
}

#[test]
fn settings_of_cones_and_smoothies_act_or_are_warned_of() {
    check(&CONES);
}

#[test]
fn settings_of_convolution_and_mixtures_act_or_are_warned_of() {
    check(&OTHERS);
}

#[test]
fn settings_of_deferred_shadowing_act_or_are_warned_of() {
    check(&[DEFERRED]);
}

fn warnings(technique: &str, set: &[&str]) -> Vec<String> {
    let technique = find(technique).unwrap();
    let params = Params::parse(technique, set).unwrap();
    let warnings = params.without_effect(&scenes()[0]);
    warnings.into_iter().map(|w| w.message).collect()
}

#[test]
fn messages_name_setting_value_and_condition() {
    let all = warnings("pcf", &["kernel=bicubic", "taps=9"]);
    assert_eq!(
        all,
        ["pcf: taps=9 has no effect here; it applies when kernel=box"]
    );
    let all = warnings("soft-shadow-volumes", &["texture-size=3", "light-frame=7"]);
    assert!(
        all.len() == 2 && all[0].contains("backend=texture4d"),
        "{all:?}"
    );
    assert!(all[1].contains("light-frame=7") && all[1].contains("light-image is not white"));
    assert!(warnings("pcf", &["taps=9"]).is_empty());
}

#[test]
fn settings_that_rule_each_other_out_are_refused() {
    let scene = &scenes()[0];
    for (set, values) in [
        (
            ["backend=exact", "light-image=fire"],
            ["backend=exact", "light-image=fire"],
        ),
        (
            ["copy-back=on", "buffer=rgba8x2"],
            ["buffer=rgba8x2", "copy-back=on"],
        ),
    ] {
        let technique = find("soft-shadow-volumes").unwrap();
        let params = Params::parse(technique, set).unwrap();
        let refused = technique
            .frame(scene, SIZE, &params)
            .err()
            .unwrap()
            .to_string();
        assert!(values.iter().all(|v| refused.contains(v)), "{refused}");
    }
}
