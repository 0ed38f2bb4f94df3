//! What the command line asked for, checked.

use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::carries::{self, Carries};
use gnomon_pipeline::measure::heat::{self, Heat};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered};
use gnomon_pipeline::technique::{Params, SceneWedges, Technique};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::scene::Scene;

use super::args::{Per, RenderArgs};
use crate::documents::{FileDocument, RenderDocument, RenderInputs};
use crate::error::CliError;
use crate::output::{files, is_stdout};
use crate::overlay::{self, OverlayKind};
use crate::verbs;

/// Everything the command line asked for, checked.
pub(super) struct RenderJob {
    pub(super) scene: Scene,
    pub(super) technique: &'static dyn Technique,
    pub(super) params: Params,
    pub(super) settings: RenderSettings,
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
        };
        let document = RenderDocument::new(of, done, files);
        match self.per {
            Per::Pass => document,
            Per::Draw => document.with_draws(&done.report),
        }
    }

    pub(super) fn wedges(&self) -> Result<Option<SceneWedges>, CliError> {
        if !self.overlays.iter().any(|(k, _)| *k == OverlayKind::Wedges) {
            return Ok(None);
        }
        Ok(self.technique.wedges(&self.scene, &self.params)?)
    }

    /// What wedges add up to, or what would have to be set to keep carries at all.
    pub(super) fn carries(&self) -> Result<Option<Carries>, CliError> {
        let wanted = (self.overlays.iter()).any(|(k, _)| *k == OverlayKind::Carries);
        if !wanted {
            return Ok(None);
        }
        let (scene, technique, params) = (&self.scene, self.technique, &self.params);
        let found = carries::record(scene, technique, params, &self.settings)?;
        found.map(Some).ok_or_else(|| CliError::Flag {
            flag: "--overlay",
            value: OverlayKind::Carries.name().to_owned(),
            valid: format!(
                "{}, as it is set, adds no coverage up in 8-bit channels; \
                 soft-shadow-volumes-optimised does, and soft-shadow-volumes with \
                 --set buffer=rgba8 or rgba8x2",
                technique.name()
            ),
        })
    }

    pub(super) fn heat(&self) -> Result<Option<Heat>, CliError> {
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
    let name: String = settings.chain(time).collect();
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
