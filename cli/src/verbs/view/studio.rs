//! Draws what is looked at, and says how `render` would.

use std::path::Path;
use std::time::Instant;

use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::truth::oracle::cache::OracleCache;
use gnomon_pipeline::world::scene::{Scene, SceneSource, View};
use gnomon_raster::GpuConfig;
use gnomon_traces::history::{self, HistoryOptions};

use super::args::ViewerArgs;
use super::facts::{Facts, TechniqueFacts};
use super::look::Look;
use super::orbit::Pose;
use crate::draw::Picture;
use crate::error::CliError;
use crate::flags::parameters;
use crate::output::shell::quote;
use crate::overlay::{self, Explained, OverlayKind, Recorded};
use crate::verbs::pixel;

/// A scene, and the techniques that draw it.
pub(super) struct Studio {
    source: SceneSource,
    /// The scene without a view.
    plain: Scene,
    view: View,
    choices: Vec<Choice>,
    no_skip: bool,
    gpu: GpuConfig,
    cache: Option<OracleCache>,
    size: Option<[u32; 2]>,
    /// The part of the command line that stays.
    words: Vec<String>,
}

/// A technique with settings.
struct Choice {
    technique: &'static dyn Technique,
    settings: Vec<(String, String)>,
}

/// A frame.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) look: Look,
    pub(super) scene: Scene,
    pub(super) params: Params,
    pub(super) done: Rendered,
    /// What is shown: the frame, or what explains it.
    pub(super) picture: Picture,
    /// The overlay with its legend, as `render` writes it.
    pub(super) overlay: Option<Picture>,
    /// Milliseconds that everything took.
    pub(super) ms: f64,
}

impl Studio {
    /// What was asked for, checked; and the number of the technique that was.
    pub(super) fn new(args: &ViewerArgs, registry: &Registry) -> Result<(Self, usize), CliError> {
        let frame = &args.frame;
        let (wanted, no_skip) = (frame.technique.find(registry)?, frame.gpu.no_skip);
        let given = frame.technique.settings.iter().chain(&frame.settings);
        let given: Vec<(String, String)> = given.cloned().collect();
        parameters(wanted, &given, no_skip)?;
        let mut source = frame.source()?.with_view(View::default());
        let plain = source.at(frame.time)?;
        let choice = |t: &&'static dyn Technique| Choice {
            technique: *t,
            settings: match t.name() == wanted.name() {
                true => given.clone(),
                false => Vec::new(),
            },
        };
        let studio = Self {
            view: frame.view.view(),
            choices: registry.all().iter().map(choice).collect(),
            no_skip,
            gpu: frame.gpu.config(),
            cache: frame.cache.as_deref().map(OracleCache::new),
            size: frame.size,
            words: frame.words_of_scene(),
            source,
            plain,
        };
        // What is wrong with the view is told before anything is shown.
        studio.scene(None)?;
        let at = studio.choices.iter();
        let at = at
            .map(|c| c.technique.name())
            .position(|n| n == wanted.name());
        Ok((studio, at.unwrap_or(0)))
    }

    /// What there is to choose from.
    pub(super) fn facts(&self) -> Result<Facts, CliError> {
        let scene = self.scene(None)?;
        let technique = |choice: &Choice| {
            let lights = choice.technique.capabilities().lights;
            let params = parameters(choice.technique, &choice.settings, self.no_skip)?;
            Ok(TechniqueFacts {
                name: choice.technique.name(),
                takes: (scene.lights.iter().map(|l| lights.contains(&l.shape))).collect(),
                has_wedges: choice.technique.capabilities().has_wedges(),
                has_carries: matches!(choice.technique.carry_channels(&params), Ok(Some(_))),
            })
        };
        let techniques = self.choices.iter().map(technique);
        Ok(Facts {
            scene: scene.name.clone(),
            lights: scene.lights.len(),
            has_environment: scene.environment.is_some(),
            home: Pose {
                eye: scene.camera.eye,
                target: scene.camera.target,
                up: scene.camera.up,
            },
            size: self.size,
            techniques: techniques.collect::<Result<_, CliError>>()?,
        })
    }

    /// Draws a frame, and what explains it.
    pub(super) fn draw(&self, look: &Look) -> Result<Drawn, CliError> {
        let start = Instant::now();
        let (scene, params) = (self.scene(look.pose.as_ref())?, self.params(look)?);
        let technique = self.choices[look.technique].technique;
        if let Some(cache) = &self.cache {
            technique.prepare(&scene, &params, cache, &|_| {})?;
        }
        let settings = RenderSettings {
            size: look.size,
            gpu: self.gpu,
            repeat: 1,
        };
        let done = render(&scene, technique, &params, &settings)?;
        let frame = Explained {
            scene: &scene,
            technique,
            params: &params,
            settings: &settings,
        };
        let overlay = match look.overlay {
            Some(kind) => Some(explain(kind, frame, &done)?),
            None => None,
        };
        let picture = match (&overlay, look.overlay) {
            (Some(picture), Some(kind)) => without_legend(kind, picture, done.size),
            _ => overlay::picture(&done),
        };
        Ok(Drawn {
            look: look.clone(),
            picture,
            overlay,
            ms: start.elapsed().as_secs_f64() * 1e3,
            scene,
            params,
            done,
        })
    }

    /// Everything that happened to a pixel of a frame, as `pixel` tells it.
    pub(super) fn history(&self, look: &Look, pixel: [u32; 2]) -> Result<Vec<String>, CliError> {
        let (scene, params) = (self.scene(look.pose.as_ref())?, self.params(look)?);
        let technique = self.choices[look.technique].technique;
        let frame = technique.frame(&scene, look.size, &params)?;
        let options = HistoryOptions {
            config: self.gpu,
            image: None,
        };
        let history = history::pixel(&frame.recording, &options, pixel)?;
        Ok(pixel::text(&history, 0)
            .lines()
            .map(str::to_owned)
            .collect())
    }

    /// The line for a shell that makes the same frame.
    pub(super) fn command(&self, look: &Look, out: &Path) -> String {
        let mut words = vec!["gnomon".to_owned(), "render".to_owned()];
        words.extend(self.words.iter().cloned());
        let choice = &self.choices[look.technique];
        words.push(format!("--technique={}", choice.technique.name()));
        let settings = self.settings(look);
        words.extend(
            settings
                .iter()
                .map(|(key, value)| format!("--set={key}={value}")),
        );
        let eye = look.pose.map(|p| p.eye).or(self.view.eye);
        let target = look.pose.map(|p| p.target).or(self.view.target);
        for (flag, point) in [("eye", eye), ("target", target)] {
            words.extend(point.map(|p| format!("--{flag}={},{},{}", p.x, p.y, p.z)));
        }
        words.push(format!("--size={}x{}", look.size[0], look.size[1]));
        words.extend(
            look.overlay
                .map(|kind| format!("--overlay={}", kind.name())),
        );
        words.push(format!("--out={}", out.display()));
        let quoted: Vec<String> = words.iter().map(|w| quote(w)).collect();
        quoted.join(" ")
    }

    fn scene(&self, pose: Option<&Pose>) -> Result<Scene, CliError> {
        let mut view = self.view.clone();
        if let Some(pose) = pose {
            (view.eye, view.target) = (Some(pose.eye), Some(pose.target));
        }
        Ok(self.source.seen(&self.plain, &view)?)
    }

    /// What is set: what was given, and the light.
    fn settings(&self, look: &Look) -> Vec<(String, String)> {
        let choice = &self.choices[look.technique];
        let has_lights = choice.technique.params().iter().any(|p| p.name == LIGHT);
        let light = look.light.filter(|_| has_lights);
        let light = light.map(|light| (LIGHT.to_owned(), light.to_string()));
        choice.settings.iter().cloned().chain(light).collect()
    }

    fn params(&self, look: &Look) -> Result<Params, CliError> {
        let technique = self.choices[look.technique].technique;
        Ok(parameters(technique, &self.settings(look), self.no_skip)?)
    }
}

/// The parameter by which techniques choose lights.
const LIGHT: &str = "light";

fn explain(kind: OverlayKind, frame: Explained<'_>, done: &Rendered) -> Result<Picture, CliError> {
    let mut recorded = Recorded::default();
    recorded.add(kind, frame)?;
    Ok(overlay::draw(
        kind,
        &recorded.source(frame.scene, frame.params, done),
    ))
}

/// The part of an overlay that lies over the frame; a map stays whole.
fn without_legend(kind: OverlayKind, picture: &Picture, size: [u32; 2]) -> Picture {
    let [across, down] = picture.size;
    if kind == OverlayKind::EnvLights || across < size[0] || down < size[1] {
        return picture.clone();
    }
    let left = ((across - size[0]) / 2) as usize;
    let rows = picture
        .pixels
        .chunks(across as usize)
        .take(size[1] as usize);
    let pixels = rows.flat_map(|row| &row[left..left + size[0] as usize]);
    Picture {
        size,
        pixels: pixels.copied().collect(),
    }
}
