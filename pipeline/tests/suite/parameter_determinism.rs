//! Every value of every parameter of every technique gives the same bits whatever executes
//! it: each word, and both ends and the middle of ranges, together with the settings under
//! which a parameter has an effect, since those are the ones that it acts together with.
//!
//! The list is made of the registry's own declarations. A frame is built once and drawn by
//! two GPUs that differ in threads, tile and SIMD level at once, and everything that it
//! leaves is compared: all textures, and with equal skipping all counters.

use std::cell::LazyCell;

use gnomon_pipeline::technique::{
    Condition, Domain, LightFact, ParamInfo, Params, Technique, Whole,
};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::{Counters, Gpu, GpuConfig, Recording, SimdLevel, Texture};

use crate::settings_effect::{self, base, scenes, under_sky};

const SIZE: [u32; 2] = [48, 32];

/// The most of what costs time or memory without bound; the ignored test goes farther.
const SHORT: [(&str, u64); 12] = [
    ("map-size", 64),
    ("texture-size", 5),
    ("samples", 9),
    ("search-samples", 16),
    ("pcf-samples", 16),
    ("maps", 9),
    ("split", 3),
    ("levels", 16),
    ("directions", 128),
    ("lights", 8),
    ("brightest", 4),
    ("m", 8),
];
const LONG: [(&str, u64); 3] = [("map-size", 2048), ("texture-size", 40), ("samples", 1024)];

type Settings = Vec<(String, String)>;

/// Cases of one technique, drawn as they are counted.
struct Matrix<'a> {
    technique: &'static dyn Technique,
    base: Settings,
    limits: &'a [(&'a str, u64)],
    drawn: usize,
    refused: Vec<String>,
}

impl Matrix<'_> {
    fn info(&self, key: &str) -> &'static ParamInfo {
        let mut all = self.technique.params().iter();
        all.find(|p| p.name == key).unwrap()
    }

    /// Each word; least, greatest and middle of numbers.
    fn values(&self, info: &ParamInfo) -> Vec<String> {
        let words = info.domain.words().iter().map(|w| (*w).to_owned());
        let mut all: Vec<String> = words.collect();
        match info.domain {
            Domain::Words(_) | Domain::Images { .. } => {}
            Domain::Whole { range, kind, .. } => {
                let limit = self.limits.iter().find(|(name, _)| *name == info.name);
                let high = range[1].min(limit.map_or(u64::MAX, |(_, most)| *most));
                let low = range[0].min(high);
                all.extend([low, middle(low, high, kind), high].map(|n| n.to_string()));
            }
            Domain::Decimal { numbers, .. } => {
                let from = info.default.to_string().parse().unwrap_or(1.6);
                let some = [numbers.low, 0.5 * from + 0.1, 2.0 * from + 0.3];
                all.extend(some.iter().map(f64::to_string));
            }
            Domain::List { .. } => all.extend(["1".to_owned(), "1+0".to_owned()]),
            Domain::Technique => {
                all.extend(["shadow-map:map-size=64", "unshadowed"].map(String::from))
            }
        }
        all.retain(|v| info.domain.takes(v));
        all.dedup();
        all
    }

    /// Settings, each way in which `condition` can come to hold.
    fn ways(&self, condition: &Condition, depth: usize) -> Vec<Settings> {
        let with = |key: &str, value: String| {
            let mut ways = match depth {
                0 => vec![Settings::new()],
                _ => self.ways(&self.info(key).applies, depth - 1),
            };
            ways.iter_mut().for_each(|way| set(way, key, &value));
            ways
        };
        match condition {
            Condition::Is(key, values) => values
                .iter()
                .flat_map(|v| with(key, (*v).to_owned()))
                .collect(),
            Condition::Not(key, values) => {
                let others = self.values(self.info(key)).into_iter();
                let others = others.filter(|v| !values.contains(&v.as_str()));
                others.flat_map(|v| with(key, v)).collect()
            }
            Condition::All(all) => all.iter().fold(vec![Settings::new()], |ways, c| {
                let more = self.ways(c, depth);
                let joined =
                    |way: &Settings| more.iter().map(|m| joined(way, m)).collect::<Vec<_>>();
                ways.iter().flat_map(joined).collect()
            }),
            Condition::Any(any) => any.iter().flat_map(|c| self.ways(c, depth)).collect(),
            _ => vec![Settings::new()],
        }
    }

    fn check(&mut self, info: &ParamInfo, scenes: &[Scene]) {
        let before = self.drawn;
        for way in self.ways(&info.applies, 1) {
            for value in self.values(info) {
                let mut settings = joined(&self.base, &way);
                set(&mut settings, info.name, &value);
                for scene in scenes {
                    self.draw(&settings, scene);
                }
            }
        }
        assert!(
            self.drawn > before,
            "{} {}: nothing is drawn, {:?}",
            self.technique.name(),
            info.name,
            self.refused
        );
    }

    fn draw(&mut self, settings: &Settings, scene: &Scene) {
        let text: Vec<String> = settings.iter().map(|(k, v)| format!("{k}={v}")).collect();
        let frame = Params::parse(self.technique, &text)
            .and_then(|params| self.technique.frame(scene, SIZE, &params));
        let frame = match frame {
            Ok(frame) => frame,
            Err(error) => return self.refused.push(format!("{text:?}: {error}")),
        };
        let [one, other] = pair(self.drawn).map(|gpu| Drawn::new(&frame.recording, gpu));
        let what = format!("{} {text:?}, {:?}", self.technique.name(), pair(self.drawn));
        for (label, (a, b)) in one.labels.iter().zip(one.images.iter().zip(&other.images)) {
            assert!(a == b, "{what}: `{label}` differs");
        }
        if pair(self.drawn)[1].skip {
            assert!(one.counters == other.counters, "{what}: counters differ");
        }
        self.drawn += 1;
    }
}

/// Two GPUs, the second another one for each number.
fn pair(number: usize) -> [GpuConfig; 2] {
    let levels = SimdLevel::available();
    let reference = GpuConfig {
        threads: 1,
        tile: 64,
        simd: levels[0],
        ..GpuConfig::default()
    };
    let other = GpuConfig {
        threads: 2 + number % 3,
        tile: [16, 32, 128][number / 3 % 3],
        simd: levels[number % levels.len()],
        skip: number % 4 != 3,
    };
    [reference, other]
}

/// Everything that a frame leaves.
struct Drawn {
    labels: Vec<String>,
    images: Vec<Vec<u32>>,
    counters: Vec<Counters>,
}

impl Drawn {
    fn new(recording: &Recording, config: GpuConfig) -> Self {
        let mut gpu = Gpu::new(config).unwrap();
        gpu.load(recording).unwrap();
        let report = gpu.submit(&recording.list).unwrap();
        let textures: Vec<&Texture> = gpu
            .texture_ids()
            .map(|id| gpu.texture(id).unwrap())
            .collect();
        Self {
            labels: textures
                .iter()
                .map(|t| t.descriptor().label.clone())
                .collect(),
            images: textures.iter().map(|t| bits(t)).collect(),
            counters: report.passes.iter().map(|p| p.totals()).collect(),
        }
    }
}

fn bits(texture: &Texture) -> Vec<u32> {
    let of_depth = texture.descriptor().format.is_depth_stencil();
    let images = texture.descriptor().images();
    let of_image = |image| match of_depth {
        true => {
            let stencil = texture.read_stencil(image).unwrap_or_default().into_iter();
            let depth = texture.read_depth_bits(image).unwrap().into_iter();
            depth.chain(stencil.map(u32::from)).collect::<Vec<u32>>()
        }
        false => texture.read_raw(image).unwrap().concat(),
    };
    images.flat_map(of_image).collect()
}

/// The setting in place of another one of the same name.
fn set(settings: &mut Settings, key: &str, value: &str) {
    settings.retain(|(k, _)| k != key);
    settings.push((key.to_owned(), value.to_owned()));
}

fn joined(first: &Settings, second: &Settings) -> Settings {
    let mut all = first.clone();
    second.iter().for_each(|(k, v)| set(&mut all, k, v));
    all
}

/// About half way between two numbers of a kind.
fn middle(low: u64, high: u64, kind: Whole) -> u64 {
    match kind {
        Whole::Any => low + (high - low) / 2,
        Whole::PowerOfTwo => 1 << ((low.max(1).ilog2() + high.max(1).ilog2()) / 2),
        Whole::Square => ((low.isqrt() + high.isqrt()) / 2).pow(2).max(low),
    }
}

/// Whether some part of a condition asks for something of the scene.
fn asks(condition: &Condition, of: &Condition) -> bool {
    match condition {
        Condition::All(all) | Condition::Any(all) => all.iter().any(|c| asks(c, of)),
        other => other == of,
    }
}

fn check(names: &[&str], limits: &[(&str, u64)]) {
    let known = scenes();
    let [two, ball, open] = [0, 1, 3].map(|k| known[k].clone());
    let sky = LazyCell::new(under_sky);
    for name in names {
        let technique = find(name).unwrap();
        let in_base = base(technique).into_iter();
        let pairs = in_base.map(|s| {
            s.split_once('=')
                .map(|(k, v)| (k.to_owned(), v.to_owned()))
                .unwrap()
        });
        let mut matrix = Matrix {
            technique,
            base: pairs.collect(),
            limits,
            drawn: 0,
            refused: Vec::new(),
        };
        for info in technique.params() {
            let mut scenes = vec![two.clone()];
            if asks(&info.applies, &Condition::Lights(LightFact::Sphere)) {
                scenes.push(ball.clone());
            }
            if info.name == "open-casters" {
                scenes.push(open.clone());
            }
            if asks(&info.applies, &Condition::Environment) || *name == settings_effect::DEFERRED {
                scenes = vec![sky.clone()];
            }
            matrix.check(info, &scenes);
        }
        println!(
            "{name}: {} drawn, {} refused",
            matrix.drawn,
            matrix.refused.len()
        );
    }
}

#[test]
fn values_of_volumes_and_linked_wedges_give_the_same_bits_everywhere() {
    check(&settings_effect::VOLUMES, &SHORT);
    check(&settings_effect::WEDGES, &SHORT);
}

#[test]
fn values_of_soft_volumes_give_the_same_bits_everywhere() {
    check(&settings_effect::SOFT, &SHORT);
    check(&settings_effect::LINES, &SHORT);
}

#[test]
fn values_of_maps_give_the_same_bits_everywhere() {
    check(&settings_effect::MAPS, &SHORT);
    check(&settings_effect::MOMENTS, &SHORT);
    check(&settings_effect::BACKPROJECTED, &SHORT);
}

#[test]
fn values_of_all_others_give_the_same_bits_everywhere() {
    check(&settings_effect::PLANAR, &SHORT);
    check(&settings_effect::RAYS, &SHORT);
    check(&settings_effect::CONES, &SHORT);
    check(&settings_effect::OTHERS, &SHORT);
    check(&[settings_effect::DEFERRED], &SHORT);
}

/// Ranges to their ends, as far as memory holds them: a quarter of an hour.
#[test]
#[ignore = "long; see CONTRIBUTING.md"]
fn ends_of_ranges_give_the_same_bits_everywhere() {
    for names in settings_effect::ALL {
        check(names, &LONG);
    }
}
