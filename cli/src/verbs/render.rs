//! `gnomon render`.

mod frames;

use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::heat::{self, Heat};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::measure::wedge_work::WedgeWork;
use gnomon_pipeline::technique::{Params, SceneWedges, Technique};
use gnomon_pipeline::techniques::{self, find};
use gnomon_pipeline::world::scene::{Scene, SceneSource};

use crate::args::{OverlayKind, RenderArgs};
use crate::error::CliError;
use crate::output::files::{self, Batch};
use crate::output::json::{FileDocument, RenderDocument, RenderJob, worker_threads};
use crate::output::progress::Progress;
use crate::output::tables::{self, Named};
use crate::output::{self, npy, numbers, png, warnings};
use crate::overlay;

const DEFAULT_SIZE: [u32; 2] = [800, 600];

/// Everything the command line asked for, checked.
struct Job {
    scene: Scene,
    technique: &'static dyn Technique,
    params: Params,
    settings: RenderSettings,
    out: PathBuf,
    overlays: Vec<(OverlayKind, PathBuf)>,
}

/// Renders one frame, or an animation, and writes what was asked for.
pub(crate) fn run(args: &RenderArgs) -> Result<(), CliError> {
    if let Some(count) = args.frames {
        return frames::run(args, count);
    }
    let progress = Progress::new(3 + args.overlay.len() as u64);
    progress.doing("loading the scene");
    let job = Job::new(args)?;
    progress.step();
    progress.doing("rendering");
    let done = render(&job.scene, job.technique, &job.params, &job.settings)?;
    progress.step();
    let files = write(&job, args, &done, &progress)?;
    drop(progress);
    if args.json {
        output::print_json(&job.document(&done, files.clone()))?;
    }
    output::print_summary(&summary(&job, &done, &files), args.json)
}

impl Job {
    fn new(args: &RenderArgs) -> Result<Self, CliError> {
        let technique = find(&args.technique)?;
        let params = super::parameters(technique, &args.settings, args.gpu.no_skip)?;
        if let Some(out) = &args.out {
            files::check_extension("--out", out, "png")?;
        }
        if let Some(visibility) = &args.visibility {
            files::check_extension("--visibility", visibility, "npy")?;
        }
        let scene = source(args)?.at(args.time)?;
        Self::of(args, technique, params, scene, args.out.clone())
    }

    /// The picture of `scene`, written to `out` or where it is by default.
    fn of(
        args: &RenderArgs,
        technique: &'static dyn Technique,
        params: Params,
        scene: Scene,
        out: Option<PathBuf>,
    ) -> Result<Self, CliError> {
        check_overlays(args, &scene)?;
        check_wedges(args, technique)?;
        let size = args.size.or(scene.size).unwrap_or(DEFAULT_SIZE);
        let out = out.unwrap_or_else(|| default_out(&scene.name, technique.name()));
        files::check_target(&out)?;
        Ok(Self {
            scene,
            technique,
            params,
            settings: RenderSettings {
                size,
                gpu: args.gpu.config(),
                repeat: args.repeat,
            },
            overlays: overlay_paths(&args.overlay, &out),
            out,
        })
    }

    fn document(&self, done: &Rendered, files: Vec<FileDocument>) -> RenderDocument {
        let of = RenderJob {
            scene: &self.scene,
            technique: self.technique,
            params: &self.params,
            gpu: self.settings.gpu,
            repeat: self.settings.repeat,
        };
        RenderDocument::new(of, done, files)
    }

    fn wedges(&self) -> Result<Option<SceneWedges>, CliError> {
        if !self.overlays.iter().any(|(k, _)| *k == OverlayKind::Wedges) {
            return Ok(None);
        }
        Ok(self.technique.wedges(&self.scene, &self.params)?)
    }

    fn heat(&self) -> Result<Option<Heat>, CliError> {
        if !self
            .overlays
            .iter()
            .any(|(kind, _)| overlay::needs_heat(*kind))
        {
            return Ok(None);
        }
        Ok(Some(heat::record(
            &self.scene,
            self.technique,
            &self.params,
            &self.settings,
        )?))
    }
}

/// Scenes by time, under the environment that was asked for.
fn source(args: &RenderArgs) -> Result<SceneSource, CliError> {
    let request = args.environment.request(args.lights);
    Ok(SceneSource::open(&args.scene)?.with_environment(request))
}

/// Refuses an overlay of what the scene does not have.
fn check_overlays(args: &RenderArgs, scene: &Scene) -> Result<(), CliError> {
    let wanted = args.overlay.contains(&OverlayKind::EnvLights);
    if !wanted || scene.environment.is_some() {
        return Ok(());
    }
    Err(CliError::Flag {
        flag: "--overlay",
        value: OverlayKind::EnvLights.name().to_owned(),
        valid: "the scene has no environment; give one with --env MAP".to_owned(),
    })
}

/// Refuses the wedges of a technique that has none.
fn check_wedges(args: &RenderArgs, technique: &dyn Technique) -> Result<(), CliError> {
    let wanted = args.overlay.contains(&OverlayKind::Wedges);
    if !wanted || technique.capabilities().has_wedges() {
        return Ok(());
    }
    let all = techniques::all().iter();
    let with_wedges = all.filter(|t| t.capabilities().has_wedges());
    let names: Vec<&str> = with_wedges.map(|t| t.name()).collect();
    Err(CliError::Flag {
        flag: "--overlay",
        value: OverlayKind::Wedges.name().to_owned(),
        valid: format!(
            "{} builds no penumbra wedges; those that do: {}",
            technique.name(),
            names.join(", ")
        ),
    })
}

/// `out/<scene>-<technique>.png`.
fn default_out(scene: &str, technique: &str) -> PathBuf {
    Path::new("out").join(format!("{}-{technique}.png", super::file_stem(scene)))
}

/// Each kind once, in the order asked for, beside the render.
fn overlay_paths(kinds: &[OverlayKind], out: &Path) -> Vec<(OverlayKind, PathBuf)> {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let mut paths: Vec<(OverlayKind, PathBuf)> = Vec::new();
    for kind in kinds {
        if !paths.iter().any(|(k, _)| k == kind) {
            paths.push((
                *kind,
                out.with_file_name(format!("{stem}-{}.png", kind.name())),
            ));
        }
    }
    paths
}

fn write(
    job: &Job,
    args: &RenderArgs,
    done: &Rendered,
    progress: &Progress,
) -> Result<Vec<FileDocument>, CliError> {
    let mut batch = Batch::default();
    let mut written = Vec::new();
    let mut stage = |kind, path: &Path, bytes: &[u8]| {
        written.push(FileDocument {
            kind,
            path: path.display().to_string(),
        });
        batch.stage(path, bytes)
    };
    progress.doing("writing");
    stage("render", &job.out, &png::encode(&overlay::picture(done)))?;
    if let Some(path) = &args.visibility {
        stage(
            "visibility",
            path,
            &npy::encode(done.size, &done.visibility),
        )?;
    }
    progress.step();
    let heat = job.heat()?;
    let wedges = job.wedges()?;
    let source = overlay::Source {
        scene: &job.scene,
        params: &job.params,
        done,
        heat: heat.as_ref(),
        wedges: wedges.as_ref(),
    };
    for (kind, path) in &job.overlays {
        progress.doing(format!("drawing {}", kind.name()));
        stage(
            kind.name(),
            path,
            &png::encode(&overlay::draw(*kind, &source)),
        )?;
        progress.step();
    }
    batch.commit()?;
    Ok(written)
}

fn summary(job: &Job, done: &Rendered, files: &[FileDocument]) -> String {
    let settings = &job.settings;
    let mut text = format!(
        "{}, {}, {}x{}: {} on {} threads, {}, skipping {}\n\n",
        job.scene.name,
        job.technique.name(),
        done.size[0],
        done.size[1],
        numbers::milliseconds(done.frame_ms),
        worker_threads(settings.gpu.threads),
        settings.gpu.simd,
        if settings.gpu.skip { "on" } else { "off" },
    );
    let frame = [Named {
        label: job.technique.name(),
        done,
    }];
    text += &tables::work(&frame).to_text();
    text.push('\n');
    text += &tables::traffic(&frame).to_text();
    if let Some(work) = WedgeWork::of(&done.report, &done.roles) {
        text += &format!(
            "\nwedges shaded {} fragments for {} pairs of a pixel and a penumbra that it is in: {:.2} times\n",
            numbers::count(work.shaded),
            numbers::count(work.covering),
            work.ratio(),
        );
    }
    text += &format!(
        "\ncolor      {}\nvisibility {}\n",
        done.color_hash(),
        done.visibility_hash()
    );
    for figure in &done.figures {
        text += &format!("{}: {:.6}\n", figure.name, figure.value);
    }
    for line in warnings::lines(&done.warnings) {
        text += &format!("warning: {line}\n");
    }
    for file in files {
        text += &format!("wrote {} ({})\n", file.path, file.kind);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scene_names_cannot_lead_out_of_the_folder() {
        assert_eq!(default_out("../a b", "t"), Path::new("out/---a-b-t.png"));
    }

    #[test]
    fn overlays_lie_beside_the_render_once_each() {
        let paths = overlay_paths(
            &[OverlayKind::Stencil, OverlayKind::Stencil],
            Path::new("x/a.png"),
        );
        assert_eq!(
            paths,
            [(OverlayKind::Stencil, PathBuf::from("x/a-stencil.png"))]
        );
    }
}
