//! From a pixel to the light that its surface sees.

use glam::DVec3;
use gnomon_pipeline::measure::visibility_sum::{SeenLight, SeenTriangle, VisibilitySum};
use gnomon_pipeline::truth::oracle::area::AreaOracle;
use gnomon_pipeline::truth::oracle::surfaces::{Receiver, SurfaceHit, Surfaces};
use gnomon_pipeline::world::scene::Scene;

use super::args::LightArgs;
use super::document::LightDocument;
use super::{picture, text};
use crate::error::CliError;
use crate::flags::DEFAULT_SIZE;
use crate::output::files::{self, Batch};
use crate::output::{self, png};

/// What one pixel's surface sees of a light.
pub(super) struct View {
    pub(super) scene: Scene,
    pub(super) light: usize,
    pub(super) size: [u32; 2],
    pub(super) pixel: [u32; 2],
    pub(super) hit: SurfaceHit,
    pub(super) receiver: Receiver,
    /// The summands; `None` in a light's plane or inside it.
    pub(super) seen: Option<SeenLight>,
    pub(super) triangles: Vec<SeenTriangle>,
    /// All edges before the casters were looked at from here.
    pub(super) edges: usize,
    /// The light's visible share as it is.
    pub(super) exact: f64,
    /// The same for a point of space in the surface's place, whose own plane hides
    /// nothing.
    pub(super) free: f64,
}

/// Prints the sum, and draws the light.
pub(crate) fn run(args: &LightArgs) -> Result<(), CliError> {
    if let Some(out) = &args.out {
        files::check_extension("--out", out, "png")?;
        files::check_target(out)?;
    }
    let view = View::new(args)?;
    if let Some(out) = &args.out {
        let mut batch = Batch::default();
        batch.stage(out, &png::encode(&picture::draw(&view)))?;
        batch.commit()?;
    }
    if args.json {
        output::print_json(&LightDocument::new(&view))?;
    }
    let mut summary = text::text(&view);
    if let Some(out) = &args.out {
        summary += &format!("wrote {}\n", out.display());
    }
    match args.json {
        true => Ok(()),
        false => output::print(&summary),
    }
}

impl View {
    fn new(args: &LightArgs) -> Result<Self, CliError> {
        let scene = args.scene.open()?.at(args.time)?;
        let size = args.size.or(scene.size).unwrap_or(DEFAULT_SIZE);
        let pixel = pixel(args, size)?;
        let sum = VisibilitySum::new(&scene, args.light)?;
        let surfaces = Surfaces::new(&scene);
        let rays = scene.camera.eye_rays(size[0], size[1]);
        let [x, y] = pixel.map(|c| f64::from(c) + 0.5);
        let Some(hit) = surfaces.hit(&rays, x, y) else {
            return Err(refused(pixel, "no surface is seen there".to_owned()));
        };
        let receiver = surfaces.receiver_of(&hit, &rays, x, y);
        let oracle = AreaOracle::new(&surfaces, &scene.lights[args.light].shape);
        let oracle = oracle.expect("a light that edges can cut has an extent");
        let point: DVec3 = receiver.point;
        Ok(Self {
            light: args.light,
            size,
            pixel,
            hit,
            seen: sum.seen_from(point),
            triangles: sum.triangles_seen_from(point),
            edges: sum.edges().len(),
            exact: oracle.visibility(&receiver),
            free: oracle.visibility(&Receiver::free(point)),
            receiver,
            scene,
        })
    }

    /// The name of an object.
    pub(super) fn object(&self, number: usize) -> &str {
        &self.scene.objects[number].name
    }
}

fn pixel(args: &LightArgs, size: [u32; 2]) -> Result<[u32; 2], CliError> {
    let pixel = [args.pixel[0], args.pixel[1]];
    if pixel[0] < size[0] && pixel[1] < size[1] {
        return Ok(pixel);
    }
    let [width, height] = size;
    let valid = format!(
        "the picture is {width}x{height}: columns 0 to {}, rows 0 to {}",
        width - 1,
        height - 1
    );
    Err(refused(pixel, valid))
}

fn refused([x, y]: [u32; 2], valid: String) -> CliError {
    CliError::Flag {
        flag: "--pixel",
        value: format!("{x} {y}"),
        valid,
    }
}
