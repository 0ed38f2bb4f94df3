//! Worker threads: how many, and when they are started.

use super::pass;
use crate::MAX_THREADS;
use crate::command::{CommandList, RenderPass};
use crate::error::Error;
use crate::geometry::TileGrid;
use crate::gpu::Gpu;
use crate::texture::{Subresource, TextureId};

/// Stack of a worker. The crate's own code needs less than a megabyte without
/// optimisation; the rest is for shaders.
const STACK: usize = 4 << 20;

/// The number of threads that `asked` stands for: itself, or one per core for 0.
///
/// # Errors
/// For more than [`MAX_THREADS`].
pub fn worker_threads(asked: usize) -> Result<usize, Error> {
    match asked {
        0 => Ok(cores()),
        1..=MAX_THREADS => Ok(asked),
        _ => Err(Error::Threads {
            given: asked,
            reason: format!("the limit is {MAX_THREADS}"),
        }),
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, |n| n.get().min(MAX_THREADS))
}

/// Starts workers, no more than `list` has work for: there may be more threads
/// allowed than a small frame has tiles.
pub(super) fn ensure(gpu: &mut Gpu, list: &CommandList) -> Result<(), Error> {
    let work = list.passes.iter().map(|p| shares(gpu, p)).max();
    let wanted = gpu.threads.min(work.unwrap_or(0));
    let running = gpu.pool.as_ref().map_or(1, |p| p.current_num_threads());
    if wanted > running {
        gpu.pool = Some(start(wanted)?);
    }
    Ok(())
}

/// Into how many shares the work of a valid pass can be cut.
fn shares(gpu: &Gpu, pass: &RenderPass) -> usize {
    let chunks = pass.draws.iter().map(pass::chunks_of).sum();
    tiles(gpu, pass).max(chunks)
}

fn tiles(gpu: &Gpu, pass: &RenderPass) -> usize {
    let grid = |id: TextureId, s: Subresource| {
        let layout = gpu.textures[id.0 as usize].layouts[s.mip as usize];
        let side = layout.tile_side(gpu.config.tile);
        TileGrid::new(side, layout.width, layout.height).tiles()
    };
    let color = pass.color.first().map(|a| grid(a.texture, a.subresource));
    let depth = pass.depth_stencil.as_ref();
    color
        .or_else(|| depth.map(|a| grid(a.texture, a.subresource)))
        .unwrap_or(0)
}

fn start(n: usize) -> Result<rayon::ThreadPool, Error> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(n)
        .stack_size(STACK)
        .build()
        .map_err(|e| Error::Threads {
            given: n,
            reason: e.to_string(),
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ColorAttachment, Format, GpuConfig, LoadOp, StoreOp, TextureDescriptor};

    #[test]
    fn the_number_of_threads_is_limited() {
        assert_eq!(worker_threads(0), Ok(cores()));
        assert_eq!(worker_threads(MAX_THREADS), Ok(1024));
        let error = worker_threads(1025).unwrap_err().to_string();
        assert!(error.contains("1025") && error.contains("1024"), "{error}");
    }

    fn clear(texture: TextureId) -> CommandList {
        let pass = RenderPass {
            label: "clear".into(),
            color: vec![ColorAttachment {
                texture,
                subresource: Subresource::default(),
                load: LoadOp::Clear([1.0; 4]),
                store: StoreOp::Store,
            }],
            depth_stencil: None,
            draws: vec![],
        };
        CommandList { passes: vec![pass] }
    }

    #[test]
    fn no_more_workers_are_started_than_there_are_tiles() {
        let config = GpuConfig {
            threads: 7,
            tile: 16,
            ..GpuConfig::default()
        };
        let mut gpu = Gpu::new(config).unwrap();
        let mut image = |w| {
            let desc = TextureDescriptor::d2("image", Format::R8Unorm, w, 16);
            gpu.create_texture(&desc).unwrap()
        };
        let images = [16, 48, 32, 512].map(&mut image);
        let mut started = |image| {
            gpu.submit(&clear(image)).unwrap();
            gpu.pool.as_ref().map(|p| p.current_num_threads())
        };
        // One tile needs none; what has been started stays; the limit holds.
        assert_eq!(images.map(&mut started), [None, Some(3), Some(3), Some(7)]);
    }
}
