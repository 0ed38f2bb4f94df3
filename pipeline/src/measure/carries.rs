//! What coverage leaves of the room for carries in 8-bit channels (paper III, §4.2: 6 of 8
//! bits; paper IV, §4.3: 3 of 8), pixel by pixel, for overlays. Sums are taken of what the
//! shaders wrote, so they go on where a channel has saturated.

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, Gpu, MAX_COLOR_ATTACHMENTS, ShadedBlock, Wants,
};

use crate::measure::render::{RenderError, RenderSettings};
use crate::technique::{CarryChannels, Frame, Params, PassRole, Technique};
use crate::world::scene::Scene;

/// The most that a channel holds.
pub const CHANNEL: u32 = 255;

/// How full the channels of coverage become.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Carries {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// How channels are shared.
    pub channels: CarryChannels,
    /// Of each pixel, rows from the top: the most that the wedges of one light, part and
    /// group add up to in a channel. Beyond [`CHANNEL`] it has saturated.
    pub most: Vec<u32>,
    /// Of each pixel: the most wedges that added to one buffer.
    pub wedges: Vec<u32>,
    /// Writes to channels that saturated.
    pub saturated: u64,
}

impl Carries {
    /// Carries in a channel's sum: what is above the bits of one contribution.
    pub fn carries(&self, sum: u32) -> u32 {
        sum.min(CHANNEL) >> self.channels.bits
    }
}

/// Renders one frame and records what its wedges add up to; `None` where the technique,
/// so set, keeps no carries.
///
/// # Errors
/// As [`crate::measure::render::render`].
pub fn record(
    scene: &Scene,
    technique: &dyn Technique,
    params: &Params,
    settings: &RenderSettings,
) -> Result<Option<Carries>, RenderError> {
    let Some(channels) = technique.carry_channels(params)? else {
        return Ok(None);
    };
    let frame = technique.frame(scene, settings.size, params)?;
    let mut gpu = Gpu::new(settings.gpu)?;
    gpu.load(&frame.recording)?;
    let mut recorder = Recorder::new(&frame, settings.size, channels);
    let wants = Wants {
        outputs: true,
        ..Wants::default()
    };
    gpu.submit_observed(&frame.recording.list, wants, &mut recorder)?;
    Ok(Some(recorder.found))
}

/// Sums of one pass, whose buffers begin empty.
struct Recorder {
    found: Carries,
    /// Number of attachments of each pass that adds wedges, else 0.
    attachments: Vec<usize>,
    /// Of each pixel: of each attachment its channels, and its wedges.
    sums: Vec<[Sums; MAX_COLOR_ATTACHMENTS]>,
}

#[derive(Clone, Copy, Default)]
struct Sums {
    channels: [u32; 4],
    wedges: u32,
}

impl Recorder {
    fn new(frame: &Frame, size: [u32; 2], channels: CarryChannels) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        let passes = frame.recording.list.passes.iter().zip(frame.roles.passes());
        let attachments = passes.map(|(pass, role)| match role {
            PassRole::Wedges => pass.color.len(),
            _ => 0,
        });
        Self {
            attachments: attachments.collect(),
            sums: vec![Default::default(); pixels],
            found: Carries {
                size,
                channels,
                most: vec![0; pixels],
                wedges: vec![0; pixels],
                saturated: 0,
            },
        }
    }

    /// What the fragments of an event wrote.
    fn add(&mut self, access: &BlockAccess, shaded: &ShadedBlock, values: &[u32], count: usize) {
        let [column, row] = access.block.map(u32::from);
        let mut fragments = shaded.shaded & !shaded.discarded;
        let mut first = shaded.first as usize;
        while fragments != 0 {
            let bit = fragments.trailing_zeros();
            let (x, y) = (8 * column + bit % 8, 8 * row + bit / 8);
            let pixel = (y * self.found.size[0] + x) as usize;
            for k in 0..count {
                let value = &values[first + 4 * k..][..4];
                if access.color_write[k] >> bit & 1 != 0 {
                    self.add_to(pixel, k, value);
                }
            }
            first += 4 * count;
            fragments &= fragments - 1;
        }
    }

    fn add_to(&mut self, pixel: usize, attachment: usize, value: &[u32]) {
        let sums = &mut self.sums[pixel][attachment];
        let channels = self.found.channels.count;
        let mut adds = false;
        for (sum, bits) in sums.channels.iter_mut().zip(value).take(channels) {
            let steps = (f32::from_bits(*bits) * CHANNEL as f32).round_ties_even() as u32;
            adds |= steps != 0;
            self.found.saturated += u64::from((*sum).min(CHANNEL) + steps > CHANNEL);
            *sum += steps;
        }
        sums.wedges += u32::from(adds);
    }
}

impl AccessObserver for Recorder {
    fn batch(&mut self, number: usize, batch: &AccessBatch<'_>) {
        let count = self.attachments[number];
        if count == 0 {
            return;
        }
        for shaded in batch.outputs {
            let access = &batch.blocks[shaded.event as usize];
            self.add(access, shaded, batch.values, count);
        }
    }

    fn end(&mut self, number: usize, _: &gnomon_raster::PassReport) {
        if self.attachments[number] == 0 {
            return;
        }
        let most = self.found.most.iter_mut().zip(&mut self.found.wedges);
        for (sums, (most, wedges)) in self.sums.iter_mut().zip(most) {
            for buffer in std::mem::take(sums) {
                *most = (*most).max(buffer.channels.into_iter().max().unwrap_or(0));
                *wedges = (*wedges).max(buffer.wedges);
            }
        }
    }
}
