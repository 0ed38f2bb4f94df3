//! From an edge's number to its wedge.

use gnomon_pipeline::geometry::wedge::Wedge;
use gnomon_pipeline::measure::render::{RenderSettings, render};
use gnomon_pipeline::measure::visibility_sum::{SilhouetteEdge, VisibilitySum};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::scene::Scene;

use super::args::WedgeArgs;
use super::document::{EdgesDocument, WedgeDocument};
use super::map::CoverageMap;
use super::{picture, text};
use crate::draw::Picture;
use crate::error::CliError;
use crate::flags::DEFAULT_SIZE;
use crate::output::files::{self, Batch};
use crate::output::{self, npy, png};
use crate::overlay;

/// One edge of a scene, with its wedges.
pub(super) struct Shown<'a> {
    pub(super) scene: &'a Scene,
    pub(super) light: usize,
    pub(super) number: usize,
    pub(super) edge: SilhouetteEdge,
    /// How they should be built: where that is undefined, they are exact.
    pub(super) construction: &'static str,
    pub(super) wedges: Vec<Wedge>,
    pub(super) map: CoverageMap,
}

/// Lists edges, or shows the wedge of one.
pub(crate) fn run(args: &WedgeArgs) -> Result<(), CliError> {
    check_files(args)?;
    let scene = args.scene.open()?.at(args.time)?;
    let sum = VisibilitySum::new(&scene, args.light)?;
    let Some(number) = args.edge else {
        if args.json {
            return output::print_json(&EdgesDocument::new(&scene, args.light, sum.edges()));
        }
        return output::print(&text::edges(&scene, args.light, sum.edges()));
    };
    let shown = show(args, &scene, &sum, number)?;
    let mut written = Vec::new();
    let mut batch = Batch::default();
    if let Some(out) = &args.out {
        let drawn = picture::draw(&shown, &background(&scene, shown.map.size)?);
        batch.stage(out, &png::encode(&drawn))?;
        written.push(out.display().to_string());
    }
    if let Some(out) = &args.coverage {
        batch.stage(out, &npy::encode_f64(shown.map.size, &shown.map.values))?;
        written.push(out.display().to_string());
    }
    batch.commit()?;
    if args.json {
        return output::print_json(&WedgeDocument::new(&shown));
    }
    output::print(&text::wedge(&shown, &written))
}

fn check_files(args: &WedgeArgs) -> Result<(), CliError> {
    for (flag, path, extension) in [
        ("--out", &args.out, "png"),
        ("--coverage", &args.coverage, "npy"),
    ] {
        if let Some(path) = path {
            files::check_extension(flag, path, extension)?;
            files::check_target(path)?;
        }
    }
    Ok(())
}

fn show<'a>(
    args: &WedgeArgs,
    scene: &'a Scene,
    sum: &VisibilitySum,
    number: usize,
) -> Result<Shown<'a>, CliError> {
    let size = args.size.or(scene.size).unwrap_or(DEFAULT_SIZE);
    let count = sum.edges().len();
    let edge = *sum.edges().get(number).ok_or_else(|| CliError::Flag {
        flag: "--edge",
        value: number.to_string(),
        valid: match count {
            0 => "the scene's casters have no silhouette edge".to_owned(),
            _ => format!(
                "light {} has {count} silhouette edges: 0 to {}",
                args.light,
                count - 1
            ),
        },
    })?;
    let (width, height) = (2 * size[0], size[1]);
    png::check_room([width, height])?;
    let construction = args.construction.construction();
    Ok(Shown {
        scene,
        light: args.light,
        number,
        edge,
        construction: text::construction(construction),
        wedges: sum.wedges(number, construction),
        map: CoverageMap::new(scene, sum, number, size),
    })
}

/// The scene without shadows.
fn background(scene: &Scene, size: [u32; 2]) -> Result<Picture, CliError> {
    let technique = find("unshadowed")?;
    let settings = RenderSettings {
        size,
        ..RenderSettings::default()
    };
    let done = render(scene, technique, &Params::defaults(technique), &settings)?;
    Ok(overlay::picture(&done))
}
