//! What the command line asked for, checked.

use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::render::{RenderSettings, Rendered};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::MAX_TEXTURE_SIZE;

use super::args::{Per, RenderArgs};
use crate::documents::{FileDocument, RenderDocument, RenderInputs};
use crate::error::CliError;
use crate::output::{files, is_stdout};
use crate::overlay::{Explained, OverlayKind};
use crate::verbs;

/// Everything the command line asked for, checked.
pub(super) struct RenderJob {
    pub(super) scene: Scene,
    pub(super) technique: &'static dyn Technique,
    pub(super) params: Params,
    pub(super) settings: RenderSettings,
    /// Samples along a side of a pixel.
    pub(super) samples: u32,
    pub(super) out: PathBuf,
    pub(super) overlays: Vec<(OverlayKind, PathBuf)>,
    per: Per,
}

impl RenderJob {
    pub(super) fn new(args: &RenderArgs, registry: &Registry) -> Result<Self, CliError> {
        let technique = args.frame.technique.find(registry)?;
        check_wedges(args, technique, registry)?;
        let params = args.frame.params(technique)?;
        check_out(args)?;
        if let Some(visibility) = &args.visibility {
            files::check_extension("--visibility", visibility, "npy")?;
        }
        let scene = args.frame.source()?.at(args.frame.time)?;
        Self::of(args, technique, params, scene, args.out.clone())
    }

    /// The picture of `scene`, written to `out` or where it is by default.
    pub(super) fn of(
        args: &RenderArgs,
        technique: &'static dyn Technique,
        params: Params,
        scene: Scene,
        out: Option<PathBuf>,
    ) -> Result<Self, CliError> {
        check_overlays(args, &scene)?;
        let size = args.frame.size_of(&scene);
        check_samples(args, size)?;
        let out = out.unwrap_or_else(|| default_out(&scene.name, &distinguished(args)));
        if !is_stdout(&out) {
            files::check_target(&out)?;
        }
        Ok(Self {
            scene,
            technique,
            params,
            settings: RenderSettings {
                size,
                gpu: args.frame.gpu.config(),
                repeat: args.repeat,
            },
            samples: args.supersample,
            overlays: overlay_paths(&args.overlay, &out),
            out,
            per: args.per,
        })
    }

    pub(super) fn document(&self, done: &Rendered, files: Vec<FileDocument>) -> RenderDocument {
        let of = RenderInputs {
            scene: &self.scene,
            technique: self.technique,
            params: &self.params,
            gpu: self.settings.gpu,
            repeat: self.settings.repeat,
            supersample: self.samples,
        };
        let document = RenderDocument::new(of, done, files);
        match self.per {
            Per::Pass => document,
            Per::Draw => document.with_draws(&done.report),
        }
    }

    /// Refuses carries of a frame that keeps none.
    pub(super) fn check_carries(&self) -> Result<(), CliError> {
        let wanted = self
            .overlays
            .iter()
            .any(|(k, _)| *k == OverlayKind::Carries);
        match wanted {
            true => self.explained().check_carries(),
            false => Ok(()),
        }
    }

    /// The frame, for overlays.
    pub(super) fn explained(&self) -> Explained<'_> {
        Explained {
            scene: &self.scene,
            technique: self.technique,
            params: &self.params,
            settings: &self.settings,
        }
    }
}

/// Refuses more samples than a texture has room for, and what is of one sample.
fn check_samples(args: &RenderArgs, size: [u32; 2]) -> Result<(), CliError> {
    let side = args.supersample;
    let refuse = |valid: String| {
        let (flag, value) = ("--supersample", side.to_string());
        Err(CliError::Flag { flag, value, valid })
    };
    let most = MAX_TEXTURE_SIZE / size[0].max(size[1]).max(1);
    if side > most.max(1) {
        return refuse(format!(
            "{}x{} pixels have room for 1 to {} samples along a side: {MAX_TEXTURE_SIZE} in all",
            size[0],
            size[1],
            most.max(1)
        ));
    }
    if side > 1 && !(args.overlay.is_empty() && args.show.is_empty()) {
        let what = "overlays and buffers are those of one sample; leave them out, or give 1";
        return refuse(what.to_owned());
    }
    Ok(())
}

/// Refuses a picture of another kind, and stdout where more than the picture goes there or
/// beside it.
fn check_out(args: &RenderArgs) -> Result<(), CliError> {
    let Some(out) = &args.out else {
        return Ok(());
    };
    if !is_stdout(out) {
        return files::check_extensions("--out", out, &["png", "exr"]);
    }
    let beside = match () {
        () if args.json => "--json prints there",
        () if !args.overlay.is_empty() => "overlays are written beside the picture",
        () if args.show.iter().any(|s| !s.has_file()) => "buffers are written beside the picture",
        () => return Ok(()),
    };
    Err(CliError::Flag {
        flag: "--out",
        value: "-".to_owned(),
        valid: format!("it is stdout, but {beside}; give a file name"),
    })
}

/// The technique with what was given of its settings, and the time, for the name of a file.
pub(super) fn distinguished(args: &RenderArgs) -> String {
    let frame = &args.frame;
    let settings = frame.technique.settings.iter().chain(&frame.settings);
    let settings = settings.map(|(key, value)| format!("-{key}-{value}"));
    let time = (frame.time != 0.0).then(|| format!("-time-{}", frame.time));
    let samples = (args.supersample > 1).then(|| format!("-supersample-{}", args.supersample));
    let name: String = settings.chain(time).chain(samples).collect();
    let short: String = verbs::file_stem(&name)
        .chars()
        .take(MOST_OF_A_NAME)
        .collect();
    frame.technique.technique.clone() + &short
}

/// Characters of settings in a file's name.
const MOST_OF_A_NAME: usize = 80;

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
pub(super) fn check_wedges(
    args: &RenderArgs,
    technique: &dyn Technique,
    registry: &Registry,
) -> Result<(), CliError> {
    let wanted = args.overlay.contains(&OverlayKind::Wedges);
    if !wanted || technique.capabilities().has_wedges() {
        return Ok(());
    }
    let all = registry.all().iter();
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
pub(super) fn default_out(scene: &str, technique: &str) -> PathBuf {
    Path::new("out").join(format!("{}-{technique}.png", verbs::file_stem(scene)))
}

/// Each kind once, in the order asked for, beside the render.
fn overlay_paths(kinds: &[OverlayKind], out: &Path) -> Vec<(OverlayKind, PathBuf)> {
    let name = |kind: &OverlayKind| {
        let mut name = out.file_stem().unwrap_or_default().to_owned();
        name.push(format!("-{}.png", kind.name()));
        name
    };
    let mut paths: Vec<(OverlayKind, PathBuf)> = Vec::new();
    for kind in kinds {
        if !paths.iter().any(|(k, _)| k == kind) {
            paths.push((*kind, out.with_file_name(name(kind))));
        }
    }
    paths
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
