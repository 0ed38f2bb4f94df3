//! The beginning of a command list.

use gnomon_raster::{CommandList, StoreOp};

/// `list` up to draw `[pass, draw]`, that one included; what the last pass would have
/// forgotten at its end is kept.
///
/// # Panics
/// Where there is no such draw.
pub(crate) fn until(list: &CommandList, [pass, draw]: [usize; 2]) -> CommandList {
    let mut passes = list.passes[..=pass].to_vec();
    let last = passes.last_mut().expect("at least one");
    last.draws.truncate(draw + 1);
    for attachment in &mut last.color {
        attachment.store = StoreOp::Store;
    }
    if let Some(attachment) = &mut last.depth_stencil {
        attachment.depth_store = StoreOp::Store;
        attachment.stencil_store = StoreOp::Store;
    }
    CommandList { passes }
}
