//! From a trace to the history of a pixel.

use gnomon_raster::{GpuConfig, Recording};
use gnomon_traces::history::{self, History, HistoryOptions};

use super::args::{PixelArgs, PlaceArgs};
use super::text::text;
use crate::documents::PixelDocument;
use crate::error::CliError;
use crate::output;
use crate::traces_of_frames::TraceFile;

/// A frame, and what happened to a pixel of it.
pub(crate) struct Shown {
    pub(crate) recording: Recording,
    pub(crate) options: HistoryOptions,
    pub(crate) history: History,
}

impl Shown {
    /// Draws the frame again.
    pub(crate) fn new(place: &PlaceArgs) -> Result<Self, CliError> {
        let file = TraceFile::open(&place.trace)?;
        let recording = file.frame(place.frame)?;
        let options = HistoryOptions {
            config: GpuConfig {
                skip: !place.gpu.no_skip,
                ..place.gpu.config()
            },
            image: place.image.clone(),
        };
        let draw = || history::pixel(&recording, &options, [place.x, place.y]);
        let history = file.drawn(place.frame, draw)??;
        Ok(Self {
            recording,
            options,
            history,
        })
    }
}

/// Prints the history.
pub(crate) fn run(args: &PixelArgs) -> Result<(), CliError> {
    let shown = Shown::new(&args.place)?;
    let frame = args.place.frame;
    if args.json {
        return output::print_json(&PixelDocument::new(&shown.history, frame));
    }
    output::print(&text(&shown.history, frame))
}
