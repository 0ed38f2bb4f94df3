//! Writes the picture that is shown, as `render` would.

use std::borrow::Borrow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::event::{Event, Saved};
use super::studio::{Drawn, Studio};
use crate::draw::Picture;
use crate::error::CliError;
use crate::output::files::Batch;
use crate::overlay;
use crate::verbs::file_stem;
use crate::verbs::render::png_of;

/// Where pictures are written.
const FOLDER: &str = "out";

/// Writes a frame, if there is one, and says so.
pub(super) fn event(studio: &Studio, drawn: Result<impl Borrow<Drawn>, CliError>) -> Event {
    let saved = drawn.and_then(|drawn| save(studio, drawn.borrow(), Path::new(FOLDER)));
    Event::Saved(saved.map_err(|why| why.to_string()))
}

/// Writes the frame, and what explains it, into `folder` under names that nothing has yet.
pub(super) fn save(studio: &Studio, drawn: &Drawn, folder: &Path) -> Result<Saved, CliError> {
    // The thread that draws saves as well: a name is free only until its file is there.
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let path = new_name(folder, drawn);
    let written =
        |picture: &Picture| png_of(picture, &drawn.scene, &drawn.params, (&drawn.done, 1));
    let mut batch = Batch::default();
    batch.stage(&path, &written(&overlay::picture(&drawn.done)))?;
    if let (Some(kind), Some(picture)) = (drawn.look.overlay, &drawn.overlay) {
        batch.stage(&beside(&path, kind.name()), &written(picture))?;
    }
    batch.commit()?;
    Ok(Saved {
        command: studio.command(&drawn.look, &path),
        path,
    })
}

/// `SCENE-TECHNIQUE-view-N.png`, with the first number that is free, beside it as well.
fn new_name(folder: &Path, drawn: &Drawn) -> PathBuf {
    let scene = file_stem(&drawn.scene.name);
    let name = |n: u32| format!("{scene}-{}-view-{n}.png", drawn.params.technique());
    let paths = (1..).map(|n| folder.join(name(n)));
    let overlay = drawn.look.overlay;
    let is_taken = |path: &PathBuf| {
        path.exists() || overlay.is_some_and(|kind| beside(path, kind.name()).exists())
    };
    let mut free = paths.filter(|path| !is_taken(path));
    free.next().unwrap_or_else(|| folder.join(name(0)))
}

/// Where `render` writes an overlay.
fn beside(path: &Path, overlay: &str) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{overlay}.png"));
    path.with_file_name(name)
}
