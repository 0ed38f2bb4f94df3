//! The golden as text: a line for each texture, image, pass and draw, readable in a
//! review, and one form for one frame.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use crate::GoldenError;
use crate::measure::{Draw, Frame, Image, Pass, Tiles};

const FIRST_LINE: &str = "gnomon-golden 1";

/// The frame as text.
pub(crate) fn write(frame: &Frame) -> String {
    let mut out = format!("{FIRST_LINE}\n");
    for line in &frame.initial {
        let _ = writeln!(out, "texture {line}");
    }
    for image in &frame.images {
        let _ = writeln!(out, "image {} {}", image.hash, image.what);
    }
    for pass in &frame.passes {
        let _ = writeln!(out, "pass {}", one_line(&pass.label));
        let _ = writeln!(out, "  targets {}", pass.targets);
        pass.draws.iter().for_each(|d| write_draw(d, &mut out));
    }
    out
}

fn write_draw(draw: &Draw, out: &mut String) {
    let _ = writeln!(out, "  draw {}", one_line(&draw.label));
    for (name, n) in &draw.counters {
        let _ = writeln!(out, "    count {name} {n}");
    }
    for (row, tiles) in by_row(&draw.tiles) {
        let _ = writeln!(out, "    tiles {row}: {}", tiles.join(" "));
    }
}

/// Tiles as text, row by row.
fn by_row(tiles: &Tiles) -> BTreeMap<u32, Vec<String>> {
    let mut rows = BTreeMap::<u32, Vec<String>>::new();
    for ([row, column], hash) in tiles {
        let text = format!("{column}={hash:08x}");
        rows.entry(*row).or_default().push(text);
    }
    rows
}

fn one_line(label: &str) -> String {
    label.replace(['\n', '\r'], " ")
}

/// The frame that `text` of the file `path` holds.
pub(crate) fn read(path: &Path, text: &str) -> Result<Frame, GoldenError> {
    let mut frame = Frame::default();
    for (number, line) in text.lines().enumerate() {
        let taken = match number {
            0 => (line == FIRST_LINE).then_some(()),
            _ => take(&mut frame, line.trim_start()),
        };
        taken.ok_or_else(|| GoldenError::Malformed {
            path: path.to_owned(),
            line: number + 1,
            what: match number {
                0 => format!("`{line}`; a golden begins with `{FIRST_LINE}`"),
                _ => format!("`{line}` is no line of a golden; write it again with GNOMON_BLESS=1"),
            },
        })?;
    }
    Ok(frame)
}

/// Adds a line; `None` where it is none of a golden, or not in its place.
fn take(frame: &mut Frame, line: &str) -> Option<()> {
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    match word {
        "texture" => frame.initial.push(rest.to_owned()),
        "image" => {
            let (hash, what) = rest.split_once(' ')?;
            frame.images.push(Image {
                what: what.to_owned(),
                hash: hash.to_owned(),
            });
        }
        "pass" => frame.passes.push(Pass {
            label: rest.to_owned(),
            ..Pass::default()
        }),
        "targets" => frame.passes.last_mut()?.targets = rest.to_owned(),
        "draw" => frame.passes.last_mut()?.draws.push(Draw {
            label: rest.to_owned(),
            ..Draw::default()
        }),
        "count" => {
            let (name, n) = rest.split_once(' ')?;
            let draw = frame.passes.last_mut()?.draws.last_mut()?;
            draw.counters.push((name.to_owned(), n.parse().ok()?));
        }
        "tiles" => take_tiles(&mut frame.passes.last_mut()?.draws.last_mut()?.tiles, rest)?,
        _ => return None,
    }
    Some(())
}

fn take_tiles(tiles: &mut Tiles, text: &str) -> Option<()> {
    let (row, rest) = text.split_once(": ")?;
    let row = row.parse().ok()?;
    for tile in rest.split(' ') {
        let (column, hash) = tile.split_once('=')?;
        let hash = u32::from_str_radix(hash, 16).ok()?;
        tiles.insert([row, column.parse().ok()?], hash);
    }
    Some(())
}
