//! The frames of the demo: which, and how they are rendered.

use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::scene::Scene;

use super::args::DemoArgs;
use crate::documents::RenderInputs;
use crate::error::CliError;
use crate::flags::parameters;
use crate::output::progress::Progress;

/// Frames timed for each entry.
pub(super) const REPEAT: u32 = 3;

/// A picture of the demo: file name, technique, settings, what it shows.
pub(super) struct DemoEntry {
    pub(super) name: &'static str,
    pub(super) technique: &'static str,
    pub(super) settings: &'static [(&'static str, &'static str)],
    pub(super) caption: &'static str,
}

pub(super) const ENTRIES: &[DemoEntry] = &[
    DemoEntry {
        name: "unshadowed",
        technique: "unshadowed",
        settings: &[],
        caption: "All light everywhere: what shadows are measured against",
    },
    DemoEntry {
        name: "zpass",
        technique: "shadow-volumes",
        settings: &[("method", "zpass")],
        caption: "Shadow volumes counted where they pass the depth test",
    },
    DemoEntry {
        name: "zfail",
        technique: "shadow-volumes",
        settings: &[("method", "zfail")],
        caption: "Counted where they fail it: right from any point of view, and dearer",
    },
    DemoEntry {
        name: "auto",
        technique: "shadow-volumes",
        settings: &[("method", "auto")],
        caption: "The cheaper of the two that is right, caster by caster",
    },
    DemoEntry {
        name: "soft",
        technique: "soft-shadow-volumes",
        settings: &[("horizon", "on")],
        caption: "The whole light seen past every silhouette edge: soft shadow volumes",
    },
    DemoEntry {
        name: "csm",
        technique: "convolution-soft-shadows",
        settings: &[("horizon", "on")],
        caption: "Soft shadows from one shadow map, filtered as convolutions",
    },
    DemoEntry {
        name: "pcss",
        technique: "pcss",
        settings: &[("horizon", "on")],
        caption: "Soft shadows from one shadow map, by searching and filtering its texels",
    },
];

/// An entry, rendered with and without skipping.
pub(super) struct Shot {
    pub(super) entry: &'static DemoEntry,
    pub(super) technique: &'static dyn Technique,
    pub(super) params: Params,
    pub(super) plain_params: Params,
    pub(super) done: Rendered,
    pub(super) plain: Rendered,
}

pub(super) fn shoot(
    scene: &Scene,
    args: &DemoArgs,
    progress: &Progress,
) -> Result<Vec<Shot>, CliError> {
    let mut shots = Vec::new();
    for entry in ENTRIES {
        progress.doing(format!("rendering {}", entry.name));
        shots.push(Shot::new(scene, entry, args)?);
        progress.step();
    }
    Ok(shots)
}

pub(super) fn settings(args: &DemoArgs, repeat: u32) -> RenderSettings {
    RenderSettings {
        size: args.size,
        gpu: args.gpu.config(),
        repeat,
    }
}

impl Shot {
    pub(super) fn new(
        scene: &Scene,
        entry: &'static DemoEntry,
        args: &DemoArgs,
    ) -> Result<Self, CliError> {
        let technique = find(entry.technique)?;
        let given: Vec<(String, String)> = entry
            .settings
            .iter()
            .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
            .collect();
        let params = parameters(technique, &given, args.gpu.no_skip)?;
        let plain_params = parameters(technique, &given, true)?;
        let mut settings = settings(args, REPEAT);
        let done = render(scene, technique, &params, &settings)?;
        settings.gpu.skip = false;
        let plain = render(scene, technique, &plain_params, &settings)?;
        Ok(Self {
            entry,
            technique,
            params,
            plain_params,
            done,
            plain,
        })
    }

    pub(super) fn job<'a>(
        &'a self,
        scene: &'a Scene,
        args: &DemoArgs,
        skip: bool,
    ) -> RenderInputs<'a> {
        let mut gpu = args.gpu.config();
        gpu.skip &= skip;
        RenderInputs {
            scene,
            technique: self.technique,
            params: if skip {
                &self.params
            } else {
                &self.plain_params
            },
            gpu,
            repeat: REPEAT,
            supersample: 1,
        }
    }
}

/// Whether two frames are equal in every bit that they leave behind.
pub(super) fn same_bits(a: &Rendered, b: &Rendered) -> bool {
    let bits = |v: &[f32]| v.iter().map(|x| x.to_bits()).collect::<Vec<u32>>();
    a.srgb == b.srgb
        && a.stencil == b.stencil
        && bits(&a.depth) == bits(&b.depth)
        && bits(&a.visibility) == bits(&b.visibility)
}
