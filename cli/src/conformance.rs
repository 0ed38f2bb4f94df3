//! What must hold of every technique, for those of other crates: the checks that the
//! built-in ones go through, as one call of a test.
//!
//! ```
//! use gnomon::{conformance, pipeline::techniques::find};
//!
//! let report = conformance::check(find("pcf")?)?;
//! assert!(report.frames > 20);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use gnomon_pipeline::technique::{Params, Technique, TechniqueError};
use gnomon_pipeline::techniques::{Registry, RegistryError, find};
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::{Counters, Drawn, Error, GpuConfig, Recording, SimdLevel, Subresource};

const SIZE: [u32; 2] = [64, 48];
/// One caster over a receiver each: flat under an area light, and round.
const SCENES: [&str; 2] = ["parallel-plates", "cylinder"];

/// What was tried.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Report {
    /// Frames that were drawn, each on several GPUs.
    pub frames: usize,
    /// Settings that the technique refused, and why.
    pub refused: Vec<String>,
    /// Stages that do not say which shader they are: such frames can be recorded frozen
    /// only (without their shaders).
    pub unnamed: Vec<String>,
}

/// What does not hold.
#[derive(Debug)]
#[non_exhaustive]
pub enum Violation {
    /// It cannot be registered.
    Registry(RegistryError),
    /// It refuses its own defaults.
    Defaults(TechniqueError),
    /// The GPU refuses a frame.
    Gpu {
        /// Scene and settings.
        frame: String,
        /// Why.
        source: Error,
    },
    /// Two builds of one frame, or two executions, differ.
    Differs {
        /// Scene and settings.
        frame: String,
        /// Between which two, and in what.
        what: String,
    },
    /// Visibility that is not a number in 0..=1.
    Visibility {
        /// Scene and settings.
        frame: String,
        /// Column, row.
        pixel: [usize; 2],
        /// What is there.
        value: f32,
    },
}

impl core::fmt::Display for Violation {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Registry(e) => write!(f, "{e}"),
            Self::Defaults(e) => write!(f, "it refuses its defaults: {e}"),
            Self::Gpu { frame, source } => write!(f, "{frame}: {source}"),
            Self::Differs { frame, what } => write!(f, "{frame}: {what}"),
            Self::Visibility {
                frame,
                pixel: [x, y],
                value,
            } => write!(
                f,
                "{frame}: visibility {value} at ({x}, {y}); it lies in 0..=1"
            ),
        }
    }
}

impl core::error::Error for Violation {}

/// Checks a technique, with its defaults and with each word that a parameter takes, on two
/// built-in scenes: it can be registered; frames are the same each time that they are
/// built; attachments and counters are the same for every thread count, tile size and SIMD
/// level, and without skipping all but the counters; visibility is a number in 0..=1.
///
/// # Errors
/// The first thing that does not hold.
pub fn check(technique: &'static dyn Technique) -> Result<Report, Violation> {
    if !find(technique.name()).is_ok_and(|known| core::ptr::addr_eq(known, technique)) {
        let mut registry = Registry::built_in();
        registry.register(technique).map_err(Violation::Registry)?;
    }
    let mut report = Report::default();
    for name in SCENES {
        let scene = builtin::build(name).expect("built in");
        for setting in settings(technique) {
            check_setting(technique, (name, &scene), &setting, &mut report)?;
        }
    }
    report.unnamed.sort_unstable();
    report.unnamed.dedup();
    Ok(report)
}

/// The defaults, and each word of each parameter beside them.
fn settings(technique: &dyn Technique) -> Vec<Vec<String>> {
    let words = technique.params().iter().flat_map(|info| {
        let words = info.domain.words().iter();
        words.map(|word| vec![format!("{}={word}", info.name)])
    });
    core::iter::once(Vec::new()).chain(words).collect()
}

fn check_setting(
    technique: &'static dyn Technique,
    (name, scene): (&str, &Scene),
    setting: &[String],
    report: &mut Report,
) -> Result<(), Violation> {
    let frame = format!("{name}, {} {}", technique.name(), setting.join(" "));
    let build = || {
        let params = Params::parse(technique, setting)?;
        technique.frame(scene, SIZE, &params)
    };
    let (first, second) = match (build(), build()) {
        (Ok(first), Ok(second)) => (first, second),
        (Err(error), _) | (_, Err(error)) if setting.is_empty() => {
            return Err(Violation::Defaults(error));
        }
        (Err(error), _) | (_, Err(error)) => {
            report.refused.push(format!("{frame}: {error}"));
            return Ok(());
        }
    };
    report.unnamed.extend(unnamed(&first.recording));
    let draw = |recording: &Recording, config| {
        let left = recording.draw(config).and_then(|drawn| Left::of(&drawn));
        left.map_err(|source| Violation::Gpu {
            frame: frame.clone(),
            source,
        })
    };
    let plain = draw(&first.recording, reference())?;
    plain.check_visibility(&frame)?;
    let again = draw(&second.recording, reference())?;
    plain.compare(&again, true, &frame, "built twice")?;
    for config in others() {
        let other = draw(&first.recording, config)?;
        plain.compare(&other, config.skip, &frame, &format!("{config:?}"))?;
    }
    report.frames += 1;
    Ok(())
}

fn reference() -> GpuConfig {
    GpuConfig {
        threads: 1,
        tile: 64,
        ..GpuConfig::default()
    }
}

/// GPUs that must do the same: every level, and two that differ in all else.
fn others() -> Vec<GpuConfig> {
    let levels = SimdLevel::available().into_iter();
    let mut all: Vec<_> = levels
        .map(|simd| GpuConfig {
            simd,
            ..reference()
        })
        .collect();
    let (threads, tile) = (3, 16);
    all.push(GpuConfig {
        threads,
        tile,
        ..reference()
    });
    all.push(GpuConfig {
        threads: 2,
        tile: 128,
        skip: false,
        ..reference()
    });
    all
}

/// Stages of a frame that do not say which shader they are.
fn unnamed(recording: &Recording) -> Vec<String> {
    let mut names = Vec::new();
    for draw in recording.list.passes.iter().flat_map(|pass| &pass.draws) {
        let (vertex, fragment) = (&draw.pipeline.vertex, draw.pipeline.fragment.as_ref());
        if vertex.identity().is_none() {
            names.push(vertex.type_name().to_owned());
        }
        if let Some(fragment) = fragment.filter(|f| f.identity().is_none()) {
            names.push(fragment.type_name().to_owned());
        }
    }
    names
}

/// What a frame leaves.
struct Left {
    images: Vec<(String, Vec<u8>)>,
    counters: Vec<Counters>,
    visibility: Option<Vec<f32>>,
}

impl Left {
    fn of(drawn: &Drawn) -> Result<Self, Error> {
        let mut images = Vec::new();
        for id in drawn.gpu.texture_ids() {
            let texture = drawn.gpu.texture(id)?;
            for at in texture.descriptor().images() {
                let label = texture.descriptor().label.clone();
                images.push((label, texture.read_packed(at)?));
            }
        }
        // Techniques without shadows have none.
        let visibility = drawn.output("visibility").ok();
        let texels = visibility.map(|t| t.read_color(Subresource::default()));
        Ok(Self {
            images,
            counters: drawn.report.passes.iter().map(|p| p.totals()).collect(),
            visibility: texels
                .transpose()?
                .map(|texels| texels.iter().map(|t| t.0[0]).collect()),
        })
    }

    fn check_visibility(&self, frame: &str) -> Result<(), Violation> {
        let values = self.visibility.iter().flatten();
        // NaN is in no range.
        let wrong = values.enumerate().find(|(_, v)| !(0.0..=1.0).contains(*v));
        match wrong {
            None => Ok(()),
            Some((i, &value)) => {
                let width = SIZE[0] as usize;
                Err(Violation::Visibility {
                    frame: frame.to_owned(),
                    pixel: [i % width, i / width],
                    value,
                })
            }
        }
    }

    fn compare(
        &self,
        other: &Self,
        counters: bool,
        frame: &str,
        with: &str,
    ) -> Result<(), Violation> {
        let differs = |what: String| {
            Err(Violation::Differs {
                frame: frame.to_owned(),
                what: format!("{what} ({with})"),
            })
        };
        if self.images.len() != other.images.len() {
            return differs("there are other textures".to_owned());
        }
        let mut both = self.images.iter().zip(&other.images);
        if let Some(((label, _), _)) = both.find(|(a, b)| a != b) {
            return differs(format!("`{label}` differs"));
        }
        if counters && self.counters != other.counters {
            return differs("counters differ".to_owned());
        }
        Ok(())
    }
}
