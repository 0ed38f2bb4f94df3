//! What the command line asked for, checked.

use std::path::PathBuf;

use gnomon_pipeline::measure::comparison::{CompareError, ReferenceKind};
use gnomon_pipeline::measure::render::RenderSettings;
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::truth::oracle::cache::OracleCache;
use gnomon_pipeline::world::light_image::LightImage;
use gnomon_pipeline::world::scene::Scene;

use super::args::CompareArgs;
use crate::error::CliError;
use crate::flags::{EntryArg, expand_all, parameters};
use crate::output::{files, is_stdout};
use crate::verbs;

pub(super) const DEFAULT_SIZE: [u32; 2] = [640, 480];

/// A comparison, ready to run.
pub(super) struct CompareJob {
    pub(super) scene: Scene,
    /// Number of the light that shines.
    pub(super) light: usize,
    pub(super) entries: Vec<Entry>,
    /// Techniques that all would have been, which do not take the light.
    pub(super) left_out: Vec<String>,
    /// What is on the light, to all of the techniques.
    pub(super) image: Option<LightImage>,
    pub(super) reference: ReferenceKind,
    pub(super) cache: OracleCache,
    pub(super) settings: RenderSettings,
    /// The picture.
    pub(super) out: PathBuf,
    /// The table for other programs.
    pub(super) csv: Option<PathBuf>,
}

/// A technique with parameters.
pub(super) struct Entry {
    pub(super) technique: &'static dyn Technique,
    pub(super) params: Params,
    /// Name and the settings that were given.
    pub(super) label: String,
}

impl CompareJob {
    pub(super) fn new(args: &CompareArgs, registry: &Registry) -> Result<Self, CliError> {
        let scene = args.scene.open()?.at(args.time)?;
        let (given, count) = (args.light, scene.lights.len());
        let Some(light) = scene.lights.get(given) else {
            return Err(CompareError::NoSuchLight { given, count }.into());
        };
        let takes = |t: &dyn Technique| t.capabilities().lights.contains(&light.shape);
        let (entries, left_out) = parse_entries(args, registry, Some(args.light), &takes)?;
        let name = verbs::file_stem(&scene.name);
        let out = args.out_dir.join(format!("{name}-compare.png"));
        files::check_target(&out)?;
        let csv = checked_csv(args)?;
        Ok(Self {
            light: args.light,
            image: common_image(&entries)?,
            entries,
            left_out,
            reference: args.reference,
            cache: OracleCache::new(args.out_dir.join("oracle-cache")),
            settings: RenderSettings {
                size: args.size.or(scene.size).unwrap_or(DEFAULT_SIZE),
                gpu: args.gpu.config(),
                repeat: args.repeat,
            },
            scene,
            out,
            csv,
        })
    }

    /// What somebody else's image of `size` is held against.
    pub(super) fn against(args: &CompareArgs, size: [u32; 2]) -> Result<Self, CliError> {
        let scene = args.scene.open()?.at(args.time)?;
        let (given, count) = (args.light, scene.lights.len());
        if given >= count {
            return Err(CompareError::NoSuchLight { given, count }.into());
        }
        let name = verbs::file_stem(&scene.name);
        let out = args.out_dir.join(format!("{name}-against.png"));
        files::check_target(&out)?;
        Ok(Self {
            light: args.light,
            image: None,
            entries: Vec::new(),
            left_out: Vec::new(),
            csv: None,
            reference: args.reference,
            cache: OracleCache::new(args.out_dir.join("oracle-cache")),
            settings: RenderSettings {
                size,
                gpu: args.gpu.config(),
                repeat: 1,
            },
            scene,
            out,
        })
    }

    /// Steps of progress: rows of the truth, techniques, the picture.
    pub(super) fn steps(&self) -> u64 {
        u64::from(self.settings.size[1]) + self.entries.len() as u64 + 1
    }
}

/// Where the table goes, if it may; stdout has room for one document.
fn checked_csv(args: &CompareArgs) -> Result<Option<PathBuf>, CliError> {
    let Some(path) = args.csv.clone() else {
        return Ok(None);
    };
    match (is_stdout(&path), args.json) {
        (true, true) => Err(CliError::Flag {
            flag: "--csv",
            value: "-".to_owned(),
            valid: "stdout is for the document of --json; give a file, or leave --json out"
                .to_owned(),
        }),
        (true, false) => Ok(Some(path)),
        (false, _) => files::check_extension("--csv", &path, "csv").map(|()| Some(path)),
    }
}

/// The techniques to compare, under light number `light` alone or under all; and those that
/// `all` leaves out, since they do not take the light.
pub(super) fn parse_entries(
    args: &CompareArgs,
    registry: &Registry,
    light: Option<usize>,
    takes: &dyn Fn(&dyn Technique) -> bool,
) -> Result<(Vec<Entry>, Vec<String>), CliError> {
    let chosen = chosen(args, registry);
    let by_name = |e: &EntryArg| args.techniques.contains(e) || args.techniques.is_empty();
    let stays = |e: &EntryArg| by_name(e) || e.find(registry).is_ok_and(takes);
    let (chosen, out): (Vec<_>, Vec<_>) = chosen.into_iter().partition(stays);
    let entries = chosen
        .iter()
        .map(|arg| Entry::new(arg, args, registry, light));
    let entries = entries.collect::<Result<Vec<Entry>, CliError>>()?;
    check_settings(args, &chosen, registry)?;
    Ok((entries, out.into_iter().map(|e| e.technique).collect()))
}

/// What is compared where nothing is asked for: hard, by a map, filtered, by geometry.
const PRINCIPAL: [&str; 4] = [
    "shadow-volumes",
    "pcss",
    "convolution-soft-shadows",
    "soft-shadow-volumes",
];

/// The techniques that were asked for, or else the principal ones.
fn chosen(args: &CompareArgs, registry: &Registry) -> Vec<EntryArg> {
    if !args.techniques.is_empty() {
        return expand_all(&args.techniques, registry);
    }
    let known = PRINCIPAL.map(EntryArg::plain).into_iter();
    let known: Vec<_> = known.filter(|e| e.find(registry).is_ok()).collect();
    match known.is_empty() {
        // A registry of other crates' techniques alone.
        true => (registry.all().iter().map(|t| EntryArg::plain(t.name()))).collect(),
        false => known,
    }
}

impl Entry {
    fn new(
        arg: &EntryArg,
        args: &CompareArgs,
        registry: &Registry,
        light: Option<usize>,
    ) -> Result<Self, CliError> {
        let technique = arg.find(registry)?;
        let for_all = args
            .settings
            .iter()
            .filter(|s| s.technique == technique.name());
        let given: Vec<(String, String)> = for_all
            .map(|s| s.setting.clone())
            .chain(arg.settings.iter().cloned())
            .collect();
        if let Some((_, value)) = given.iter().find(|(key, _)| key == LIGHT) {
            let valid = match light {
                Some(_) => "one light is compared at a time: choose it with --light N",
                None => "all lights of an environment are compared together",
            };
            return Err(CliError::Flag {
                flag: "light",
                value: value.clone(),
                valid: valid.to_owned(),
            });
        }
        let mut label = technique.name().to_owned();
        for (key, value) in &given {
            label += &format!(" {key}={value}");
        }
        let has_lights = technique.params().iter().any(|p| p.name == LIGHT);
        let light = light.map(|l| (LIGHT.to_owned(), l.to_string()));
        let all: Vec<_> = light
            .filter(|_| has_lights)
            .into_iter()
            .chain(given)
            .collect();
        Ok(Self {
            technique,
            params: parameters(technique, &all, args.gpu.no_skip)?,
            label,
        })
    }
}

/// The image that is on the light for all techniques: under another one another truth
/// holds.
fn common_image(entries: &[Entry]) -> Result<Option<LightImage>, CliError> {
    let mut common = None;
    for (number, entry) in entries.iter().enumerate() {
        let image = entry.technique.light_image(&entry.params)?;
        if number > 0 && image != common {
            return Err(CliError::Flag {
                flag: "light-image",
                value: entry.label.clone(),
                valid: format!(
                    "all techniques compared have the same image on the light; '{}' has another",
                    entries[0].label
                ),
            });
        }
        common = image;
    }
    Ok(common)
}

/// The parameter by which techniques choose lights.
const LIGHT: &str = "light";

/// Settings of techniques that are not compared would go unnoticed.
fn check_settings(
    args: &CompareArgs,
    chosen: &[EntryArg],
    registry: &Registry,
) -> Result<(), CliError> {
    for given in &args.settings {
        registry.find(&given.technique)?;
        if !chosen.iter().any(|t| t.technique == given.technique) {
            let (key, value) = &given.setting;
            return Err(CliError::Flag {
                flag: "--set",
                value: format!("{}.{key}={value}", given.technique),
                valid: format!("'{}' is not among --techniques", given.technique),
            });
        }
    }
    Ok(())
}
