//! A difference for people: words, pictures, and the history of its first pixel.

use std::fmt::Write;

use gnomon_raster::Recording;
use gnomon_traces::history::{self, Change, EventKind, History, HistoryOptions, PixelEvent};

use crate::compare::Difference;
use crate::measure::{Measured, Shown};
use crate::picture::{self, Picture};
use crate::{Golden, GoldenError};

impl Golden {
    /// Tells it, and writes the pictures.
    pub(crate) fn describe(
        &self,
        name: &str,
        recording: &Recording,
        actual: &Measured,
        difference: &Difference,
    ) -> Result<String, GoldenError> {
        let mut text = format!("`{name}` is not its golden\n");
        for line in &difference.lines {
            let _ = writeln!(text, "{line}");
        }
        let mut first = None;
        for shown in &actual.shown {
            let pixel = self.describe_picture(name, shown, &mut text)?;
            let found = pixel.map(|p| (Some(shown.name.clone()), p));
            first = first.or(found);
        }
        // Without a difference that eight bits show, the tile's first pixel.
        let of_tile = difference.tile.map(|t| (None, t.map(|c| c * 64)));
        if let Some((image, pixel)) = first.or(of_tile) {
            text += &describe_history(recording, image, pixel)?;
        }
        Ok(text)
    }

    /// Expected, difference and actual pictures; gives the first pixel that differs.
    fn describe_picture(
        &self,
        name: &str,
        shown: &Shown,
        text: &mut String,
    ) -> Result<Option<[u32; 2]>, GoldenError> {
        let path = self.picture(name, &shown.name);
        let Some(expected) = picture::read(&path, shown.picture.size) else {
            let _ = writeln!(text, "{}: no picture of this size", path.display());
            return Ok(None);
        };
        let (difference, count, first) = picture::difference(&expected, &shown.picture);
        let Some(pixel) = first else {
            let _ = writeln!(text, "{}: equal in eight bits a channel", shown.name);
            return Ok(None);
        };
        let [e, a] = [&expected, &shown.picture].map(|p| at(p, pixel));
        let _ = writeln!(
            text,
            "{}: {count} pixels differ, first ({}, {}): {e:?} expected, {a:?} found",
            shown.name, pixel[0], pixel[1]
        );
        let kinds = [
            ("expected", &expected),
            ("difference", &difference),
            ("actual", &shown.picture),
        ];
        for (kind, picture) in kinds {
            let file = format!("{name}-{}-{kind}.png", shown.name);
            let path = self.scratch.join(file);
            picture::write(&path, picture)?;
            let _ = writeln!(text, "  {kind:10} {}", path.display());
        }
        Ok(Some(pixel))
    }
}

fn at(picture: &Picture, [x, y]: [u32; 2]) -> [u8; 4] {
    let i = 4 * (y as usize * picture.size[0] as usize + x as usize);
    [0, 1, 2, 3].map(|c| picture.pixels[i + c])
}

fn describe_history(
    recording: &Recording,
    image: Option<String>,
    pixel: [u32; 2],
) -> Result<String, GoldenError> {
    let options = HistoryOptions {
        image: image.filter(|name| recording.output(name).is_some()),
        ..HistoryOptions::default()
    };
    let history = history::pixel(recording, &options, pixel)?;
    let mut text = format!("history of pixel ({}, {}):\n", pixel[0], pixel[1]);
    for event in &history.events {
        let _ = writeln!(text, "  {}", describe_event(&history, event));
    }
    Ok(text)
}

fn describe_event(history: &History, event: &PixelEvent) -> String {
    let what = match &event.kind {
        EventKind::Load { .. } => "load".to_owned(),
        EventKind::Store { .. } => "discarding store".to_owned(),
        EventKind::Fragment(f) => {
            let side = if f.front { "front" } else { "back" };
            format!(
                "draw {} `{}` primitive {} {side}: {:?}",
                f.draw, f.label, f.primitive, f.end
            )
        }
    };
    let changes = event.depth_stencil.iter().chain(&event.color);
    let changed: Vec<String> = changes
        .filter(|c| c.before != c.after)
        .map(|c| describe_change(history, c))
        .collect();
    let changed = match changed.is_empty() {
        true => "unchanged".to_owned(),
        false => changed.join(", "),
    };
    format!("`{}` {what}; {changed}", event.pass_label)
}

fn describe_change(history: &History, change: &Change) -> String {
    let label = &history.attachments[change.attachment].label;
    format!("{label} {:?} → {:?}", change.before, change.after)
}
