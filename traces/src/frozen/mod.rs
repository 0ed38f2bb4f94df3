//! Frames without their code: what shaders gave, in the place of the shaders.
//!
//! [`freeze`] draws a frame once, without skipping, and keeps the clip position of every
//! vertex and, of every fragment that a shader was run for, its colours before
//! conversion, its depth and whether it was discarded. The frame that it gives has
//! shaders that look these up, so it can be recorded and drawn again by whoever does not
//! have the code: closures work too. They are shaders with a name like any other; what
//! they keep are their uniforms, and [`table`] makes them again.
//!
//! With skipping, fewer fragments are shaded than were kept, none that were not: what
//! zmin/zmax throw away would have failed the depth test. Frozen shaders read no texture
//! and count nothing; a recording keeps what the live ones did.

mod collect;
mod fragment;
mod vertex;

use std::sync::Arc;

use gnomon_raster::shader::{FragmentStage, ShaderTable, VertexStage};
use gnomon_raster::{
    Draw, Error, Format, Gpu, GpuConfig, Recording, RenderPass, RenderPipeline, Wants,
};

use collect::Collector;
use fragment::{FrozenFragment, Outputs};
use vertex::FrozenVertex;

/// Begins the names of frozen shaders.
const PREFIX: &str = "frozen.";

/// Whether `name` is a frozen shader's.
pub(crate) fn is_frozen(name: &str) -> bool {
    name.starts_with(PREFIX)
}

/// The shaders of frozen frames.
///
/// # Panics
/// Never: there are two, of different stages.
#[must_use]
pub fn table() -> ShaderTable {
    let mut table = ShaderTable::default();
    table
        .add_vertex::<FrozenVertex>()
        .and_then(|()| table.add_fragment::<FrozenFragment>())
        .expect("an empty table takes a shader of each stage");
    table
}

/// `recording` with frozen shaders.
///
/// # Errors
/// What the GPU refuses.
pub fn freeze(recording: &Recording, config: GpuConfig) -> Result<Recording, Error> {
    let mut gpu = Gpu::new(GpuConfig {
        skip: false,
        ..config
    })?;
    gpu.load(recording)?;
    let wants = Wants {
        outputs: true,
        ..Wants::default()
    };
    let mut collector = Collector::new(recording);
    gpu.submit_observed(&recording.list, wants, &mut collector)?;
    let mut frozen = recording.clone();
    for (pass, outputs) in frozen.list.passes.iter_mut().zip(collector.passes) {
        let formats = formats(recording, pass)?;
        for (draw, outputs) in pass.draws.iter_mut().zip(outputs) {
            draw.pipeline = Arc::new(pipeline(draw, outputs, &formats)?);
        }
    }
    Ok(frozen)
}

fn formats(recording: &Recording, pass: &RenderPass) -> Result<Vec<Format>, Error> {
    let color = pass.color.iter();
    let format = |texture| Ok(recording.texture(texture)?.descriptor().format);
    color.map(|a| format(a.texture)).collect()
}

fn pipeline(draw: &Draw, outputs: Outputs, formats: &[Format]) -> Result<RenderPipeline, Error> {
    let live = &draw.pipeline;
    let fragment = live
        .fragment
        .as_ref()
        .map(|stage| FragmentStage::named(FrozenFragment::new(stage, formats, outputs)));
    Ok(RenderPipeline {
        vertex: VertexStage::named(FrozenVertex::of(draw)?),
        fragment,
        ..RenderPipeline::clone(live)
    })
}
