//! What happens to the viewer, and what it has done about it.

use std::path::PathBuf;

use super::look::Look;
use super::studio::Drawn;

/// What somebody asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// Move what the mode moves: to the right and down, by much or by little.
    Step { by: [i32; 2], far: bool },
    /// The mouse was dragged, so many cells.
    Drag { by: [i32; 2], to: [u16; 2] },
    /// The mouse was pressed on a cell.
    Press([u16; 2]),
    /// So many steps closer.
    Zoom(i32),
    /// The next technique, or the one before.
    Technique(i32),
    /// The next light alone, or all.
    Light,
    /// The next overlay, or the one before.
    Overlay(i32),
    /// Look at one pixel, or no more.
    Cursor,
    /// Tell everything of the pixel.
    Tell,
    /// Write the picture.
    Save,
    /// Which keys there are.
    Help,
    /// The scene's own eye.
    Home,
    /// Leave the mode, or the viewer.
    Back,
    /// Leave the viewer.
    Quit,
    /// The terminal has so many cells.
    Resize([u16; 2]),
}

/// What happens.
#[derive(Debug)]
pub(super) enum Event {
    /// Somebody asks for something.
    Input(Action),
    /// Nobody has asked for anything for a while.
    Rest,
    /// A frame is drawn, or cannot be.
    Drawn {
        /// As it was asked for.
        look: Look,
        /// The frame, or why there is none.
        result: Result<Box<Drawn>, String>,
    },
    /// The history of a pixel is there, or cannot be had.
    Told(Result<Vec<String>, String>),
    /// The picture is written, or cannot be.
    Saved(Result<Saved, String>),
}

/// A picture that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Saved {
    /// The file.
    pub(super) path: PathBuf,
    /// What makes it again.
    pub(super) command: String,
}

/// What is to be done.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Effect {
    /// Draw a frame; what was asked for before is no longer wanted.
    Draw(Look),
    /// Tell the history of a pixel of a frame.
    Tell(Look, [u32; 2]),
    /// Write the whole frame.
    Save(Look),
    /// Leave.
    Quit,
}
