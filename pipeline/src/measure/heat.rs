//! Where the work went: fragments per pixel and bytes per 8×8 block, pass by
//! pass, for overlays. Rendered by [`record`] with an access observer; slower
//! than [`crate::measure::render::render`], and the same bits.

mod screen;

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, Gpu, MAX_COLOR_ATTACHMENTS, PassReport, RenderPass,
    TextureId, Wants,
};

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
    /// Colour attachments.
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
    /// Passes onto the frame's own pixels, in their order.
    pub passes: Vec<PassHeat>,
    /// Passes onto other images, such as light views: they have no place in the
    /// picture.
    pub elsewhere: Vec<PassWork>,
}

/// The work of a pass, wherever it was done. Clears are left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PassWork {
    /// The pass's number in the frame.
    pub number: usize,
    /// The pass's label.
    pub label: String,
    /// Fragments generated.
    pub fragments: u64,
    /// Bytes by client.
    pub bytes: BlockBytes,
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

/// Adds up accesses.
struct Recorder {
    heat: Heat,
    /// The pass that is being drawn, where it draws onto the frame's pixels.
    pass: PassHeat,
    /// The same where it draws onto another image.
    work: PassWork,
    targets: Vec<PassTargets>,
}

/// What a pass draws into: whether the frame's pixels, and what an access costs.
struct PassTargets {
    on_screen: bool,
    depth_bytes: u64,
    color_bytes: [u64; MAX_COLOR_ATTACHMENTS],
}

impl Recorder {
    fn new(gpu: &Gpu, frame: &Frame, size: [u32; 2]) -> Result<Self, RenderError> {
        let on_screen = screen::screen_passes(gpu, frame)?;
        let passes = frame.recording.list.passes.iter().zip(on_screen);
        let targets = passes.map(|(pass, on_screen)| PassTargets::new(gpu, pass, on_screen));
        let blocks = size.map(|s| s.div_ceil(8));
        Ok(Self {
            heat: Heat {
                size,
                blocks,
                passes: Vec::new(),
                elsewhere: Vec::new(),
            },
            pass: PassHeat::new("", size, blocks),
            work: PassWork::default(),
            targets: targets.collect::<Result<_, _>>()?,
        })
    }
}

impl PassTargets {
    fn new(gpu: &Gpu, pass: &RenderPass, on_screen: bool) -> Result<Self, RenderError> {
        let bytes = |texture: TextureId| {
            Ok::<u64, RenderError>(gpu.texture(texture)?.descriptor().format.bytes())
        };
        let mut color_bytes = [0; MAX_COLOR_ATTACHMENTS];
        for (to, attachment) in color_bytes.iter_mut().zip(&pass.color) {
            *to = bytes(attachment.texture)?;
        }
        let depth = pass.depth_stencil.as_ref();
        Ok(Self {
            on_screen,
            depth_bytes: depth.map_or(Ok(0), |a| bytes(a.texture))?,
            color_bytes,
        })
    }

    fn bytes(&self, a: &BlockAccess) -> BlockBytes {
        let accesses = |read: u64, write: u64| u64::from(read.count_ones() + write.count_ones());
        let color = (0..MAX_COLOR_ATTACHMENTS)
            .map(|k| accesses(a.color_read[k], a.color_write[k]) * self.color_bytes[k]);
        BlockBytes {
            z: accesses(a.z_read, a.z_write) * self.depth_bytes,
            stencil: accesses(a.stencil_read, a.stencil_write),
            color: color.sum(),
            hiz: 8 * (u64::from(a.hiz_read) + u64::from(a.hiz_write)),
        }
    }
}

impl AccessObserver for Recorder {
    fn batch(&mut self, number: usize, batch: &AccessBatch<'_>) {
        let targets = &self.targets[number];
        for access in batch.blocks {
            let bytes = targets.bytes(access);
            if targets.on_screen {
                self.pass
                    .add(access, &bytes, self.heat.size[0], self.heat.blocks[0]);
            } else {
                self.work.fragments += u64::from(access.covered.count_ones());
                self.work.bytes.add(&bytes);
            }
        }
    }

    fn end(&mut self, number: usize, report: &PassReport) {
        if !self.targets[number].on_screen {
            self.heat.elsewhere.push(PassWork {
                number,
                label: report.label.clone(),
                ..std::mem::take(&mut self.work)
            });
            return;
        }
        let next = PassHeat::new("", self.heat.size, self.heat.blocks);
        let mut done = std::mem::replace(&mut self.pass, next);
        done.label.clone_from(&report.label);
        self.heat.passes.push(done);
    }
}
