//! How far convolution soft shadows are from the exact oracle, and what each of
//! their parameters is worth: order, size of the light view, mip chains or tables,
//! formats, sharpening.
//!
//! `cargo run --release -p gnomon --example convolution_error -- FOLDER [SCENE...]`
//!
//! writes `convolution.csv` and plots of the error against time and bytes (SVG) into
//! FOLDER, and prints each scene's figures as it goes. Scenes are built-in names,
//! scene files or models; without any, those of [`SCENES`]. Light 0 is what counts.
//! PCSS over every texel of the kernels has no series and no filter: what it errs by
//! is the map's texels, one view, and blockers flattened to one depth.

#![allow(clippy::print_stdout, reason = "a measurement prints")]

mod charts;
mod measure;

use std::error::Error;
use std::path::Path;

use gnomon::draw::plot;
use gnomon_pipeline::world::scene;

use measure::{Row, measure};

const SCENES: [&str; 4] = ["parallel-plates", "cylinder", "spheres", "creature"];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments
        .next()
        .ok_or("the folder to write into is missing")?;
    let mut names: Vec<String> = arguments.collect();
    if names.is_empty() {
        names = SCENES.map(str::to_owned).to_vec();
    }
    let mut rows: Vec<Row> = Vec::new();
    for name in &names {
        let mut scene = scene::open(name)?;
        // A model is called by its path.
        scene.name = Path::new(name)
            .file_stem()
            .map_or(name.clone(), |s| s.to_string_lossy().into_owned());
        rows.extend(measure(&scene)?);
    }
    std::fs::create_dir_all(&folder)?;
    let write = |name: &str, text: &str| std::fs::write(Path::new(&folder).join(name), text);
    write("convolution.csv", &measure::csv(&rows))?;
    for chart in charts::all(&rows) {
        write(&format!("{}.svg", chart.name), &plot::svg(&chart))?;
    }
    if let Some(worst) = rows
        .iter()
        .filter(|r| r.is_default())
        .max_by(|a, b| a.rmse.total_cmp(&b.rmse))
    {
        println!(
            "worst with defaults: {}, RMSE {:.4}",
            worst.scene, worst.rmse
        );
    }
    Ok(())
}
