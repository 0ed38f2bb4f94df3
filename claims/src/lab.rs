//! What claims are measured with: renders, times, errors.

use std::collections::BTreeMap;

use gnomon_raster::{Gpu, GpuConfig, TextureDescriptor};
use thiserror::Error;

use gnomon_pipeline::measure::comparison::{
    CompareError, Directions, EnvironmentReference, Reference, ReferenceKind,
};
use gnomon_pipeline::measure::render::{RenderError, RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Frame, Params, Technique, TechniqueError};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::MetricError;
use gnomon_pipeline::truth::metrics::banding::Banding;
use gnomon_pipeline::truth::metrics::visibility::{ErrorSummary, VisibilityError};
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::truth::oracle::cache::OracleCache;
use gnomon_pipeline::world::environment::{Environment, EnvironmentError};
use gnomon_pipeline::world::error::{MeshError, UnknownScene};
use gnomon_pipeline::world::scene::{Scene, builtin};

/// How claims are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LabSettings {
    /// Width and height of pictures in pixels, where a claim does not fix its own.
    pub size: [u32; 2],
    /// How the emulated GPU executes.
    pub gpu: GpuConfig,
    /// Frames timed where times are compared; the least time counts.
    pub repeat: u32,
    /// Whole tables, and pictures of the whole size, where a claim else takes a part.
    pub full: bool,
}

impl Default for LabSettings {
    fn default() -> Self {
        Self {
            size: [512, 384],
            gpu: GpuConfig::default(),
            repeat: 5,
            full: false,
        }
    }
}

/// Why a claim was not measured.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ReproduceError {
    /// A built-in scene is missing.
    #[error(transparent)]
    Scene(#[from] UnknownScene),
    /// A mesh cannot be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A technique or a parameter is wrong.
    #[error(transparent)]
    Technique(#[from] TechniqueError),
    /// A scene cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// There is no truth to compare with.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// Pictures cannot be compared.
    #[error(transparent)]
    Metric(#[from] MetricError),
    /// A map cannot light a scene.
    #[error(transparent)]
    Environment(#[from] EnvironmentError),
    /// The GPU refuses its settings or a frame.
    #[error(transparent)]
    Gpu(#[from] gnomon_raster::Error),
    /// A frame cannot be recorded, or not be judged.
    #[error("{0}")]
    Recorded(String),
}

/// A place to measure in; keeps the truth about scenes it was asked for.
pub struct Lab {
    settings: LabSettings,
    cache: Option<OracleCache>,
    /// By the scene's name and the size.
    references: BTreeMap<(String, [u32; 2]), Reference>,
    /// By the scene's and the map's name, the size and the number of directions.
    skies: BTreeMap<(String, String, [u32; 2], usize), EnvironmentReference>,
}

/// A picture against the truth.
pub(super) struct Scored {
    /// Errors over all pixels.
    pub(super) error: ErrorSummary,
    /// Steps in penumbrae.
    pub(super) banding: Banding,
}

impl Lab {
    /// A lab; truths are read from and written to `cache`, if there is one.
    pub fn new(settings: LabSettings, cache: Option<OracleCache>) -> Self {
        Self {
            settings,
            cache,
            references: BTreeMap::new(),
            skies: BTreeMap::new(),
        }
    }

    /// How it measures.
    pub fn settings(&self) -> &LabSettings {
        &self.settings
    }

    pub(super) fn size(&self) -> [u32; 2] {
        self.settings.size
    }

    /// `name, WxH`, for [`super::Finding::scene`].
    pub(super) fn describe(&self, what: &str) -> String {
        let [width, height] = self.size();
        format!("{what}, {width}x{height}")
    }

    pub(super) fn scene(&self, name: &str) -> Result<Scene, ReproduceError> {
        Ok(builtin::build(name)?)
    }

    /// One frame, for counters.
    pub(super) fn render(
        &self,
        scene: &Scene,
        technique: &str,
        set: &[&str],
    ) -> Result<Rendered, ReproduceError> {
        self.rendered(scene, technique, set, self.size())
    }

    /// Several frames, for times.
    pub(super) fn timed(
        &self,
        scene: &Scene,
        technique: &str,
        set: &[&str],
    ) -> Result<Rendered, ReproduceError> {
        self.timed_at(scene, technique, set, self.size())
    }

    /// As [`Self::race`], for one run of any size.
    pub(super) fn timed_at(
        &self,
        scene: &Scene,
        technique: &str,
        set: &[&str],
        size: [u32; 2],
    ) -> Result<Rendered, ReproduceError> {
        self.least(self.settings.repeat, || {
            self.rendered(scene, technique, set, size)
        })
    }

    /// Techniques with settings, to be compared by time: frames in turn, so that what
    /// else the machine does meets all of them; of each pass, and of the frame, the
    /// least time, since that only makes times longer.
    pub(super) fn race<const N: usize>(
        &self,
        scene: &Scene,
        runs: [(&str, &[&str]); N],
    ) -> Result<[Rendered; N], ReproduceError> {
        let round = || -> Result<Vec<Rendered>, ReproduceError> {
            let run = |(technique, set): &(&str, &[&str])| self.render(scene, technique, set);
            runs.iter().map(run).collect()
        };
        let mut all = round()?;
        for _ in 1..self.settings.repeat.max(1) {
            for (least, again) in all.iter_mut().zip(round()?) {
                keep_least(least, &again);
            }
        }
        Ok(all.try_into().expect("a round has as many frames as runs"))
    }

    /// Several frames of one kind, with the least times.
    pub(super) fn least(
        &self,
        repeat: u32,
        frame: impl Fn() -> Result<Rendered, ReproduceError>,
    ) -> Result<Rendered, ReproduceError> {
        let mut least = frame()?;
        for _ in 1..repeat.max(1) {
            keep_least(&mut least, &frame()?);
        }
        Ok(least)
    }

    /// One frame of any size.
    pub(super) fn plain(
        &self,
        scene: &Scene,
        technique: &str,
        set: &[&str],
        size: [u32; 2],
    ) -> Result<Rendered, ReproduceError> {
        self.rendered(scene, technique, set, size)
    }

    /// Frames on one GPU, the median of at most `frames`; of several the first is not
    /// timed, so that textures are there.
    pub(super) fn steady(
        &self,
        scene: &Scene,
        technique: &str,
        set: &[&str],
        frames: u32,
    ) -> Result<Rendered, ReproduceError> {
        let (technique, params) = parsed(technique, set)?;
        let settings = RenderSettings {
            size: self.size(),
            gpu: self.settings.gpu,
            repeat: self.settings.repeat.min(frames),
        };
        Ok(render(scene, technique, &params, &settings)?)
    }

    fn rendered(
        &self,
        scene: &Scene,
        technique: &str,
        set: &[&str],
        size: [u32; 2],
    ) -> Result<Rendered, ReproduceError> {
        let (technique, params) = parsed(technique, set)?;
        let settings = RenderSettings {
            size,
            gpu: self.settings.gpu,
            repeat: 1,
        };
        Ok(render(scene, technique, &params, &settings)?)
    }

    /// A picture of light 0 of `scene` against the exact truth.
    pub(super) fn score(
        &mut self,
        scene: &Scene,
        done: &Rendered,
    ) -> Result<Scored, ReproduceError> {
        let truth = self.truth(scene, done)?;
        let pairs = done.visibility.iter().zip(&truth.values);
        let seen: Vec<f32> = pairs
            .map(|(v, t)| if t.is_nan() { f32::NAN } else { *v })
            .collect();
        let all = VisibilityError::measure(&truth, done.size, &seen)?.all;
        let edge = gnomon_pipeline::measure::comparison::BANDING_EDGE;
        Ok(Scored {
            error: all.unwrap_or(NOTHING_SEEN),
            banding: Banding::measure(&truth, done.size, &seen, edge)?,
        })
    }

    /// The exact truth under a picture's depth buffer.
    pub(super) fn truth(
        &mut self,
        scene: &Scene,
        done: &Rendered,
    ) -> Result<VisibilityImage, ReproduceError> {
        let key = (scene.name.clone(), done.size);
        if !self.references.contains_key(&key) {
            let cache = self.cache.as_ref();
            let kind = ReferenceKind::Exact;
            let found = Reference::new(scene, 0, done.size, kind, cache, &|| ())?;
            self.references.insert(key.clone(), found);
        }
        Ok(self.references[&key].under(&done.depth)?.truth)
    }

    /// Light of every pixel under a map, by sampled directions, with highlights.
    pub(super) fn sky(
        &mut self,
        scene: &Scene,
        map: &Environment,
        size: [u32; 2],
        count: usize,
    ) -> &EnvironmentReference {
        let key = (scene.name.clone(), map.name.clone(), size, count);
        let directions = Directions { count, seed: 1 };
        self.skies.entry(key).or_insert_with(|| {
            EnvironmentReference::new(scene, map, size, directions, true, &|| ())
        })
    }

    /// A frame that is built and not run, with all textures that it makes.
    pub(super) fn textures(
        &self,
        scene: &Scene,
        technique: &str,
        set: &[&str],
    ) -> Result<Vec<TextureDescriptor>, ReproduceError> {
        let (technique, params) = parsed(technique, set)?;
        let frame = technique.frame(scene, self.size(), &params)?;
        let made = frame.recording.textures().iter();
        Ok(made.map(|t| t.descriptor().clone()).collect())
    }

    /// A frame and the GPU that can run it.
    pub(super) fn frame(
        &self,
        scene: &Scene,
        technique: &str,
        set: &[&str],
    ) -> Result<(Gpu, Frame), ReproduceError> {
        let (technique, params) = parsed(technique, set)?;
        let frame = technique.frame(scene, self.size(), &params)?;
        let mut gpu = Gpu::new(self.settings.gpu)?;
        gpu.load(&frame.recording)?;
        Ok((gpu, frame))
    }
}

fn keep_least(least: &mut Rendered, again: &Rendered) {
    least.frame_ms = least.frame_ms.min(again.frame_ms);
    for (pass, other) in least.pass_ms.iter_mut().zip(&again.pass_ms) {
        pass.1 = pass.1.min(other.1);
    }
}

const NOTHING_SEEN: ErrorSummary = ErrorSummary {
    pixels: 0,
    rmse: f64::NAN,
    max: f64::NAN,
    p99: f64::NAN,
    mean: f64::NAN,
};

/// A technique with its parameters.
pub(super) fn parsed(
    technique: &str,
    set: &[&str],
) -> Result<(&'static dyn Technique, Params), TechniqueError> {
    let technique = find(technique)?;
    let set = as_published(technique).iter().chain(set);
    Ok((technique, Params::parse(technique, set)?))
}

/// Settings that take back what defaults are better than the papers by: claims are of what
/// was published.
fn as_published(technique: &dyn Technique) -> &'static [&'static str] {
    const CONVOLUTION: &[&str] = &[
        "horizon=off",
        "plane-offset=0",
        "map-size=512",
        "mip-sharper=0.8",
    ];
    let has = |name: &str| technique.params().iter().any(|p| p.name == name);
    match [has("plane-offset"), has("horizon"), has("grazing")] {
        [true, ..] => CONVOLUTION,
        [_, true, _] => &["horizon=off"],
        [.., true] => &["grazing=bands"],
        _ => &[],
    }
}
