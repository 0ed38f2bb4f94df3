//! Pixel history: everything that ever happened to one pixel of a frame, in order.
//!
//! The whole frame is drawn again with a probe in the tile stage; nothing is cut down to
//! the pixel, since zmin/zmax of its block and textures that passes draw for one another
//! depend on its neighbours. Every value of an attachment is checked against what the
//! event before left, and the last against what the texture holds in the end.

mod attachments;
mod collect;
mod debug;
mod event;
#[cfg(test)]
mod tests;

pub use attachments::{Attachment, Value};
pub use debug::{Debug, DebugStage, DebugVertex};
pub use event::{Change, EventKind, FragmentEvent, PixelEvent, StencilUse};

use gnomon_raster::{Error, Gpu, GpuConfig, Recording, Subresource, TextureId, Wants};

use attachments::Attachments;
use collect::{Collector, Found};

/// How the frame is drawn, and which of its images is looked at.
#[derive(Clone, Debug, Default)]
pub struct HistoryOptions {
    /// How the frame is drawn; without `skip`, what zmin/zmax hid is shown.
    pub config: GpuConfig,
    /// Name of an output of the recording; of several, `color` unless told otherwise.
    /// Without outputs it is what the last pass draws to.
    pub image: Option<String>,
}

/// What happened to a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Width and height of the image.
    pub size: [u32; 2],
    /// The image, and what is attached together with it in any pass: what the history
    /// tells of.
    pub attachments: Vec<Attachment>,
    /// In order; passes that draw to other images are left out.
    pub events: Vec<PixelEvent>,
    /// What the pixel holds in the end, by attachment.
    pub last: Vec<Value>,
}

/// Why there is no history.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum HistoryError {
    /// The pixel is not in the image.
    #[error(
        "pixel ({}, {}) is outside of the image; valid are columns 0 to {} and rows 0 to {}",
        .pixel[0], .pixel[1], .size[0] - 1, .size[1] - 1
    )]
    Outside {
        /// The pixel.
        pixel: [u32; 2],
        /// The image.
        size: [u32; 2],
    },
    /// There is no such output.
    #[error("the frame has no output `{name}`; it has {valid}")]
    NoImage {
        /// What was asked for.
        name: String,
        /// What there is.
        valid: String,
    },
    /// Nothing is drawn.
    #[error("no pass of the frame draws to the image")]
    NotDrawn,
    /// The event is none of the pixel's, or not a fragment.
    #[error("the pixel has no fragment {event}; {valid}")]
    NoEvent {
        /// What was asked for.
        event: usize,
        /// What there is.
        valid: String,
    },
    /// The frame cannot be drawn.
    #[error(transparent)]
    Gpu(#[from] Error),
    /// An event does not begin with what the one before left: a fault of the program.
    #[error("pass {pass}, `{label}`: {what} was {left} and is {found}; please report this")]
    Broken {
        /// The pass.
        pass: usize,
        /// Of pass or draw.
        label: String,
        /// Which attachment.
        what: String,
        /// What the event before left.
        left: String,
        /// What the event found.
        found: String,
    },
}

/// Draws `recording` and tells what happened to a pixel.
///
/// # Errors
/// The pixel is outside of the image, there is no such image, or the frame cannot be drawn.
pub fn pixel(
    recording: &Recording,
    options: &HistoryOptions,
    pixel: [u32; 2],
) -> Result<History, HistoryError> {
    let attachments = Attachments::of(recording, options.image.as_deref())?;
    follow(recording, options.config, attachments, pixel)
}

/// [`pixel`] of an image that need be no output: `image` is a texture that a pass draws to,
/// and which of its images.
///
/// # Errors
/// Those of [`pixel`].
pub fn pixel_of(
    recording: &Recording,
    config: GpuConfig,
    image: (TextureId, Subresource),
    pixel: [u32; 2],
) -> Result<History, HistoryError> {
    let attachments = Attachments::beside(recording, vec![image])?;
    follow(recording, config, attachments, pixel)
}

fn follow(
    recording: &Recording,
    config: GpuConfig,
    attachments: Attachments,
    pixel: [u32; 2],
) -> Result<History, HistoryError> {
    let size = attachments.size;
    if pixel[0] >= size[0] || pixel[1] >= size[1] {
        return Err(HistoryError::Outside { pixel, size });
    }
    let mut gpu = Gpu::new(config)?;
    gpu.load(recording)?;
    let first = attachments.read(&gpu, pixel)?;
    let found = fragments(&mut gpu, recording, pixel)?;
    let last = attachments.read(&gpu, pixel)?;
    let events = event::events(recording, &attachments, &found, first, &last)?;
    Ok(History {
        pixel,
        size,
        attachments: attachments.list,
        events,
        last,
    })
}

/// All fragments of a pixel, of whatever pass.
fn fragments(
    gpu: &mut Gpu,
    recording: &Recording,
    pixel: [u32; 2],
) -> Result<Vec<Found>, HistoryError> {
    let wants = Wants {
        depth_ranges: true,
        probe: Some(pixel),
        ..Wants::default()
    };
    let mut collector = Collector {
        probe: pixel,
        found: Vec::new(),
    };
    gpu.submit_observed(&recording.list, wants, &mut collector)?;
    Ok(collector.found)
}

impl History {
    /// Event number `event`, if it is a fragment.
    ///
    /// # Errors
    /// It is none; the error tells which are.
    pub fn fragment(&self, event: usize) -> Result<(&PixelEvent, &FragmentEvent), HistoryError> {
        if let Some(e) = self.events.get(event)
            && let EventKind::Fragment(f) = &e.kind
        {
            return Ok((e, f));
        }
        let is_fragment = |e: &PixelEvent| matches!(e.kind, EventKind::Fragment(_));
        let numbers = self.events.iter().enumerate();
        let fragments: Vec<String> = numbers
            .filter(|(_, e)| is_fragment(e))
            .map(|(i, _)| i.to_string())
            .collect();
        let valid = match fragments.is_empty() {
            true => "it has none at all".to_owned(),
            false => format!("fragments are {}", fragments.join(", ")),
        };
        Err(HistoryError::NoEvent { event, valid })
    }
}
