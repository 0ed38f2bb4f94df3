//! Which frames: a scene, a technique, a size, a time.

use std::path::PathBuf;

use clap::Args;
use gnomon_pipeline::technique::{LIGHT_FRAME, Params, Technique, TechniqueError, Warning};
use gnomon_pipeline::truth::oracle::cache::OracleCache;
use gnomon_pipeline::world::scene::{Scene, SceneError, SceneSource};

use super::{
    EntryArg, EnvArgs, GpuArgs, SceneArgs, ViewArgs, parameters, parse_entry, parse_rate,
    parse_setting, parse_size, parse_time,
};
use crate::error::CliError;
use crate::output::progress::Progress;
use crate::prepared::prepare;

/// The size of pictures of scenes that ask for none.
pub(crate) const DEFAULT_SIZE: [u32; 2] = [800, 600];
/// Frames per second of an animation, unless told otherwise.
pub(crate) const RATE: f64 = 24.0;

/// What to draw, and how.
#[derive(Debug, Args)]
pub(crate) struct FrameArgs {
    /// The scene.
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Technique (see `gnomon techniques`), with settings behind colons if need be:
    /// NAME:KEY=VALUE:...
    #[arg(
        long,
        alias = "techniques",
        value_name = "NAME",
        default_value = "shadow-volumes",
        value_parser = parse_entry
    )]
    pub(crate) technique: EntryArg,
    /// A parameter of the technique; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = parse_setting)]
    pub(crate) settings: Vec<(String, String)>,
    /// Image size in pixels [default: the scene file's, or else 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// The time of animated scenes, in seconds: of the picture, or of the first frame
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_time, allow_negative_numbers = true)]
    pub(crate) time: f64,
    /// That many frames of an animation, each afresh
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) frames: Option<u32>,
    /// Frames per second of an animation [default: 24]
    #[arg(long, value_name = "F", value_parser = parse_rate, requires = "frames")]
    pub(crate) fps: Option<f64>,
    /// Images of a light's sequence per second of an animation, as files of light-image
    /// or the fire have them; a fraction of --fps blends neighbours [default: that of --fps,
    /// an image a frame]
    #[arg(long, value_name = "F", value_parser = parse_rate, requires = "frames")]
    pub(crate) light_fps: Option<f64>,
    /// Keep in this folder what techniques compute ahead of frames (the transport of
    /// deferred-shadowing), and look there first [default: for this run only]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// A map that lights the scene.
    #[command(flatten)]
    pub(crate) environment: EnvArgs,
    /// Another eye and other lights.
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    /// Most area lights fitted to the map, 1 to 1024 [default: 30]
    #[arg(long, value_name = "N", requires = "env")]
    pub(crate) lights: Option<usize>,
}

impl FrameArgs {
    /// Scenes by time, under the environment that was asked for.
    pub(crate) fn source(&self) -> Result<SceneSource, SceneError> {
        let request = self.environment.request(self.lights);
        let source = self.scene.open()?.with_environment(request);
        Ok(source.with_view(self.view.view()))
    }

    /// Has `technique` compute ahead what it needs for `scene`, or read it.
    pub(crate) fn prepare(
        &self,
        technique: &dyn Technique,
        params: &Params,
        scene: &Scene,
        progress: &Progress,
    ) -> Result<Vec<Warning>, CliError> {
        match &self.cache {
            Some(folder) => {
                let cache = OracleCache::new(folder);
                prepare(technique, params, scene, &cache, progress)
            }
            None => Ok(Vec::new()),
        }
    }

    /// Everything that makes the picture, as arguments of `render`, but for technique,
    /// settings, size, eye and target.
    pub(crate) fn words_of_scene(&self) -> Vec<String> {
        let mut words = self.scene.words();
        words.extend((self.time != 0.0).then(|| format!("--time={}", self.time)));
        words.extend(self.environment.words());
        words.extend(self.lights.map(|n| format!("--lights={n}")));
        words.extend(self.view.words_without_eye());
        words.extend(self.gpu.no_skip.then(|| "--no-skip".to_owned()));
        words
    }

    /// The parameters of `technique` that were given.
    pub(crate) fn params(&self, technique: &dyn Technique) -> Result<Params, TechniqueError> {
        let given = self.technique.settings.iter().chain(&self.settings);
        parameters(
            technique,
            &given.cloned().collect::<Vec<_>>(),
            self.gpu.no_skip,
        )
    }

    /// The parameters of frame number `frame` of an animation: lights show the image of
    /// that number of their sequence, or the one at its time.
    pub(crate) fn params_of(&self, params: &Params, frame: u32) -> Params {
        let images = match self.light_fps {
            Some(rate) => f64::from(frame) * rate / self.rate(),
            None => f64::from(frame),
        };
        params.with_later_image(images)
    }

    /// As asked for, or as the scene wants it.
    pub(crate) fn size_of(&self, scene: &Scene) -> [u32; 2] {
        self.size.or(scene.size).unwrap_or(DEFAULT_SIZE)
    }

    /// Frames per second.
    pub(crate) fn rate(&self) -> f64 {
        self.fps.unwrap_or(RATE)
    }

    /// The time of frame number `frame`.
    pub(crate) fn time_of(&self, frame: u32) -> f64 {
        self.time + f64::from(frame) / self.rate()
    }

    /// A rate of images for a technique that shows none would go unnoticed.
    pub(crate) fn check_light_fps(&self, params: &Params) -> Result<(), CliError> {
        match self.light_fps {
            Some(rate) if params.text(LIGHT_FRAME).is_none() => Err(CliError::Flag {
                flag: "--light-fps",
                value: rate.to_string(),
                valid: format!("'{}' puts no images on lights", params.technique()),
            }),
            _ => Ok(()),
        }
    }

    /// Frames that are very long may leave the range of numbers.
    pub(crate) fn check_times(&self, count: u32) -> Result<(), CliError> {
        if self.time_of(count - 1).is_finite() {
            return Ok(());
        }
        Err(CliError::Flag {
            flag: "--fps",
            value: self.rate().to_string(),
            valid: "the time of the last frame is not finite: give more frames per second"
                .to_owned(),
        })
    }
}
