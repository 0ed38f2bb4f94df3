//! Where the work went: fragments per pixel and bytes per 8×8 block, pass by
//! pass, for overlays. Rendered by [`record`] with an access observer; slower
//! than [`crate::measure::render::render`], and the same bits.

use gnomon_raster::{AccessBatch, AccessObserver, BlockAccess, Format, Gpu, PassReport, Wants};

use crate::measure::render::{RenderError, RenderSettings};
use crate::technique::{Frame, Params, Technique};
use crate::world::scene::Scene;

/// Bytes of one 8×8 block by client, reads and writes together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockBytes {
    /// Depth.
    pub z: u64,
    /// Stencil.
    pub stencil: u64,
    /// Colour attachment 0.
    pub color: u64,
    /// zmin/zmax entries.
    pub hiz: u64,
}

impl BlockBytes {
    /// All clients.
    pub fn total(&self) -> u64 {
        self.z + self.stencil + self.color + self.hiz
    }

    fn add(&mut self, o: &Self) {
        self.z += o.z;
        self.stencil += o.stencil;
        self.color += o.color;
        self.hiz += o.hiz;
    }
}

/// The work of one pass, or of several. Clears are left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PassHeat {
    /// The pass's label.
    pub label: String,
    /// Fragments generated at each pixel, rows from the top.
    pub overdraw: Vec<u32>,
    /// Bytes of each block, rows from the top.
    pub bytes: Vec<BlockBytes>,
}

/// The work of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heat {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Blocks across and down.
    pub blocks: [u32; 2],
    /// Pass by pass.
    pub passes: Vec<PassHeat>,
}

impl Heat {
    /// Sum over the passes that `wanted` picks by label.
    pub fn sum(&self, wanted: impl Fn(&str) -> bool) -> PassHeat {
        let mut sum = PassHeat::new("sum", self.size, self.blocks);
        for pass in self.passes.iter().filter(|p| wanted(&p.label)) {
            sum.overdraw
                .iter_mut()
                .zip(&pass.overdraw)
                .for_each(|(a, b)| *a += b);
            sum.bytes
                .iter_mut()
                .zip(&pass.bytes)
                .for_each(|(a, b)| a.add(b));
        }
        sum
    }
}

impl PassHeat {
    fn new(label: &str, [width, height]: [u32; 2], [across, down]: [u32; 2]) -> Self {
        Self {
            label: label.to_owned(),
            overdraw: vec![0; width as usize * height as usize],
            bytes: vec![BlockBytes::default(); across as usize * down as usize],
        }
    }

    /// Adds an access to an image `width` pixels and `across` blocks wide.
    fn add(&mut self, access: &BlockAccess, bytes: &BlockBytes, width: u32, across: u32) {
        let [column, row] = access.block.map(u32::from);
        self.bytes[(row * across + column) as usize].add(bytes);
        let mut left = access.covered;
        while left != 0 {
            let bit = left.trailing_zeros();
            let (x, y) = (8 * column + bit % 8, 8 * row + bit / 8);
            self.overdraw[(y * width + x) as usize] += 1;
            left &= left - 1;
        }
    }
}

/// Renders one frame and records where its work went.
///
/// # Errors
/// As [`crate::measure::render::render`].
pub fn record(
    scene: &Scene,
    technique: &dyn Technique,
    params: &Params,
    settings: &RenderSettings,
) -> Result<Heat, RenderError> {
    let frame = technique.frame(scene, settings.size, params)?;
    let mut gpu = Gpu::new(settings.gpu)?;
    gpu.load(&frame.recording)?;
    let mut recorder = Recorder::new(&gpu, &frame, settings.size)?;
    gpu.submit_observed(&frame.recording.list, Wants::default(), &mut recorder)?;
    Ok(recorder.heat)
}

/// Adds up accesses; what each of them costs in bytes.
struct Recorder {
    heat: Heat,
    /// The pass that is being drawn.
    pass: PassHeat,
    depth_bytes: u64,
    color_bytes: u64,
}

impl Recorder {
    fn new(gpu: &Gpu, frame: &Frame, size: [u32; 2]) -> Result<Self, RenderError> {
        let format = |id| Ok::<Format, RenderError>(gpu.texture(id)?.descriptor().format);
        let blocks = size.map(|s| s.div_ceil(8));
        Ok(Self {
            heat: Heat {
                size,
                blocks,
                passes: Vec::new(),
            },
            pass: PassHeat::new("", size, blocks),
            depth_bytes: format(frame.outputs.depth_stencil)?.bytes(),
            color_bytes: format(frame.outputs.color)?.bytes(),
        })
    }

    fn bytes(&self, a: &BlockAccess) -> BlockBytes {
        let accesses = |read: u64, write: u64| u64::from(read.count_ones() + write.count_ones());
        BlockBytes {
            z: accesses(a.z_read, a.z_write) * self.depth_bytes,
            stencil: accesses(a.stencil_read, a.stencil_write),
            color: accesses(a.color_read[0], a.color_write[0]) * self.color_bytes,
            hiz: 8 * (u64::from(a.hiz_read) + u64::from(a.hiz_write)),
        }
    }
}

impl AccessObserver for Recorder {
    fn batch(&mut self, _: usize, batch: &AccessBatch<'_>) {
        for access in batch.blocks {
            let bytes = self.bytes(access);
            self.pass
                .add(access, &bytes, self.heat.size[0], self.heat.blocks[0]);
        }
    }

    fn end(&mut self, _: usize, report: &PassReport) {
        let next = PassHeat::new("", self.heat.size, self.heat.blocks);
        let mut done = std::mem::replace(&mut self.pass, next);
        done.label.clone_from(&report.label);
        self.heat.passes.push(done);
    }
}
