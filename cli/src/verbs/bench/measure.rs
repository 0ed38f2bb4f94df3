//! A cell, measured.

use std::time::Instant;

use gnomon_pipeline::measure::comparison::{Reference, Score, shaded};
use gnomon_pipeline::measure::render::{RenderError, RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use gnomon_pipeline::truth::oracle::area::LightRegion;
use gnomon_pipeline::truth::oracle::cache::OracleCache;
use gnomon_pipeline::world::light_image::LightImage;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::{GpuConfig, Traffic};

use super::exact::Exact;
use super::load;
use super::plan::Task;
use super::stored::{Found, Measured, Outcome, Stored, Time};
use super::suite::Suite;
use crate::error::CliError;
use crate::output::tables;

/// Building is timed again until this much was spent on it.
const BUILDING_MS: f64 = 1000.0;

/// Measures cells of a suite; keeps the last truth, since neighbours share it.
pub(super) struct Bench<'a> {
    suite: &'a Suite,
    cache: OracleCache,
    truth: Option<Truth>,
}

struct Truth {
    scene: usize,
    size: [u32; 2],
    /// What is on the light.
    image: Option<LightImage>,
    reference: Reference,
}

impl<'a> Bench<'a> {
    pub(super) fn new(suite: &'a Suite, cache: OracleCache) -> Self {
        Self {
            suite,
            cache,
            truth: None,
        }
    }

    /// Makes what the task needs and what is not timed: the truth, unless it is that of the
    /// last task, and what the technique prepares once for a scene. What went wrong with
    /// the folder that keeps both.
    pub(super) fn prepare(&mut self, task: &Task) -> Result<Vec<String>, CliError> {
        let mut warnings = self.ask_oracle(task)?;
        let entry = &self.suite.entries[task.entry];
        let scene = &self.suite.scenes[task.scene].scene;
        let prepared = entry
            .technique
            .prepare(scene, &entry.params, &self.cache, &|_| {});
        // What is refused here the frame refuses too, which becomes the result.
        let prepared = prepared.unwrap_or_default();
        warnings.extend(prepared.iter().map(|w| w.to_string()));
        Ok(warnings)
    }

    fn ask_oracle(&mut self, task: &Task) -> Result<Vec<String>, CliError> {
        let (scene, size) = (task.scene, task.cell.size);
        let entry = &self.suite.entries[task.entry];
        let image = entry.technique.light_image(&entry.params)?;
        let known = self.truth.as_ref();
        if known.is_some_and(|t| (t.scene, t.size, &t.image) == (scene, size, &image)) {
            return Ok(Vec::new());
        }
        let reference = Reference::with_light_image(
            &self.suite.scenes[scene].scene,
            (self.suite.light, image.as_ref()),
            size,
            self.suite.reference,
            Some(&self.cache),
            &|| {},
        )?;
        let warnings = reference.warnings.iter().map(|w| w.to_string()).collect();
        self.truth = Some(Truth {
            scene,
            size,
            image,
            reference,
        });
        Ok(warnings)
    }

    /// Builds, draws, compares, once it is prepared. What a technique or the GPU refuses is a
    /// result.
    pub(super) fn measure(&self, task: &Task) -> Result<Stored, CliError> {
        let outcome = match self.draw(task) {
            Ok(measured) => Outcome::Measured(Box::new(measured)),
            Err(CliError::Render(refused)) => Outcome::Refused(one_line(&refused)),
            Err(other) => return Err(other),
        };
        Ok(Stored {
            key: task.cell.key.clone(),
            outcome,
        })
    }

    fn draw(&self, task: &Task) -> Result<Measured, CliError> {
        let Some(Truth { reference, .. }) = &self.truth else {
            return Err(CliError::Check("no truth was prepared".to_owned()));
        };
        let entry = &self.suite.entries[task.entry];
        let trial = Trial {
            scene: &self.suite.scenes[task.scene].scene,
            technique: entry.technique,
            params: &entry.params,
            reference,
            settings: RenderSettings {
                size: task.cell.size,
                gpu: GpuConfig {
                    threads: task.cell.threads,
                    ..GpuConfig::default()
                },
                repeat: self.suite.repeat,
            },
        };
        trial.measure()
    }
}

/// A scene by a technique beside its truth.
pub(crate) struct Trial<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) technique: &'static dyn Technique,
    pub(crate) params: &'a Params,
    pub(crate) reference: &'a Reference,
    pub(crate) settings: RenderSettings,
}

impl Trial<'_> {
    /// Builds, draws and compares.
    ///
    /// # Errors
    /// [`CliError::Render`] where the technique or the GPU refuses.
    pub(crate) fn measure(&self) -> Result<Measured, CliError> {
        let load = load::average();
        let done = render(self.scene, self.technique, self.params, &self.settings)?;
        let builds = self.time_builds(done.build_ms)?;
        let under = self.reference.under(&done.depth)?;
        let truth = shaded(
            self.scene,
            self.reference,
            &under,
            self.params,
            &self.settings,
        )?;
        let score = Score::measure(&under, &done, &truth)?;
        Ok(Measured {
            found: found(&done, &score),
            time: Time {
                builds,
                frames: done.frames_ms.iter().map(|t| Exact(*t)).collect(),
                load: load.map(Exact),
                cores: load::cores(),
                simd: self.settings.gpu.simd.name().to_owned(),
            },
        })
    }

    /// `first`, and further times of building, as many as frames are timed where that is
    /// not long.
    fn time_builds(&self, first: f64) -> Result<Vec<Exact>, RenderError> {
        let mut builds = vec![Exact(first)];
        let mut spent = first;
        while builds.len() < self.settings.repeat as usize && spent < BUILDING_MS {
            let start = Instant::now();
            let size = self.settings.size;
            let frame = self.technique.frame(self.scene, size, self.params)?;
            let ms = start.elapsed().as_secs_f64() * 1e3;
            drop(frame);
            builds.push(Exact(ms));
            spent += ms;
        }
        Ok(builds)
    }
}

fn found(done: &Rendered, score: &Score) -> Found {
    let all = |figure: fn(ErrorSummary) -> f64| score.visibility.all.map(|e| Exact(figure(e)));
    let rmse = |region| score.visibility.of_region(region).map(|e| Exact(e.rmse));
    let warnings = done
        .warnings
        .iter()
        .chain(&score.pixels.warning())
        .map(|w| (w.code.to_owned(), w.count))
        .collect();
    Found {
        rmse: all(|e| e.rmse),
        max: all(|e| e.max),
        p99: all(|e| e.p99),
        mean: all(|e| e.mean),
        rmse_umbra: rmse(LightRegion::Umbra),
        rmse_penumbra: rmse(LightRegion::Penumbra),
        rmse_lit: rmse(LightRegion::Lit),
        banding_p99: Exact(score.banding.p99),
        psnr: Exact(score.psnr),
        ssim: score.ssim.map(Exact),
        flip: Exact(score.flip),
        pixels_compared: score.pixels.compared,
        pixels_left_out: score.pixels.left_out.total(),
        bytes: tables::frame_bytes(&done.report),
        clients: clients(done),
        shaded_fragments: tables::frame_counters(&done.report).fragment_shader_invocations,
        color_hash: done.color_hash(),
        visibility_hash: done.visibility_hash(),
        warnings,
    }
}

/// Bytes read and written by each client, clears included.
fn clients(done: &Rendered) -> Vec<(String, [u64; 2])> {
    let mut traffic = tables::frame_counters(&done.report);
    traffic.add(&tables::clears(&done.report));
    let named = traffic.traffic.named().into_iter();
    named
        .map(|(name, t): (String, Traffic)| (name, [t.read_bytes, t.write_bytes]))
        .collect()
}

/// Reasons stand in cells of tables.
fn one_line(error: &RenderError) -> String {
    error
        .to_string()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}
