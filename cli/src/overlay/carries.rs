//! How full the 8-bit channels are that coverage is added up in, and where carries are.

use gnomon_pipeline::measure::carries::{CHANNEL, Carries};

use super::Source;
use crate::draw::{Canvas, Legend, Picture, Swatch, heat};
use crate::output::numbers;

/// Contributions, of which none has been carried.
const UNCARRIED: [u8; 3] = [120, 144, 168];
/// More than a channel holds.
const SATURATED: [u8; 3] = [255, 0, 255];

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let mut canvas = Canvas::dimmed(&picture, 0.35);
    let Some(found) = source.carries else {
        return canvas.into_picture();
    };
    let width = picture.size[0] as usize;
    let mut pixels = Pixels::default();
    for (i, &sum) in found.most.iter().enumerate() {
        let fill = Fill::of(found, sum);
        pixels.add(fill);
        if let Some(color) = fill.color() {
            let at = [(i % width) as u32, (i / width) as u32];
            canvas.mix(at, color, 0.9);
        }
    }
    let legend = Legend {
        title: format!(
            "Carries: of {} bits of a channel a contribution takes {}, as full as it became",
            CHANNEL.count_ones(),
            found.channels.bits
        ),
        scale: scale(found),
        swatches: pixels.swatches(found.most.len() as u64),
        notes: notes(found),
        ..Legend::default()
    };
    legend.below(canvas, heat)
}

/// What a channel's sum means.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fill {
    Empty,
    Uncarried,
    /// How much of the room for carries is taken, 0 to 1.
    Carried(f32),
    Saturated,
}

impl Fill {
    fn of(found: &Carries, sum: u32) -> Self {
        let carries = found.carries(sum);
        match sum {
            0 => Self::Empty,
            _ if sum > CHANNEL => Self::Saturated,
            _ if carries == 0 => Self::Uncarried,
            _ => Self::Carried(carries as f32 / found.carries(CHANNEL) as f32),
        }
    }

    fn color(self) -> Option<[u8; 3]> {
        match self {
            Self::Empty => None,
            Self::Uncarried => Some(UNCARRIED),
            Self::Carried(room) => Some(heat(room)),
            Self::Saturated => Some(SATURATED),
        }
    }
}

/// How many pixels have what.
#[derive(Default)]
struct Pixels {
    uncarried: u64,
    carried: u64,
    saturated: u64,
}

impl Pixels {
    fn add(&mut self, fill: Fill) {
        match fill {
            Fill::Empty => {}
            Fill::Uncarried => self.uncarried += 1,
            Fill::Carried(_) => self.carried += 1,
            Fill::Saturated => self.saturated += 1,
        }
    }

    fn swatches(&self, all: u64) -> Vec<Swatch> {
        let share = |n| numbers::percent(n, all);
        vec![
            Swatch::new(
                UNCARRIED,
                format!("nothing carried: {}", share(self.uncarried)),
            ),
            Swatch::new(
                heat(0.6),
                format!("carries, by the scale: {}", share(self.carried)),
            ),
            Swatch::new(SATURATED, format!("saturated: {}", share(self.saturated))),
        ]
    }
}

/// Carries, of as many as a channel can note.
fn scale(found: &Carries) -> Vec<(f32, String)> {
    let room = found.carries(CHANNEL);
    let mut marks: Vec<u32> = (0..=4).map(|k| room * k / 4).collect();
    marks.dedup();
    let label = |n: u32| (n as f32 / room as f32, n.to_string());
    marks.into_iter().map(label).collect()
}

fn notes(found: &Carries) -> Vec<String> {
    let most = found.most.iter().copied().max().unwrap_or(0);
    let wedges = found.wedges.iter().copied().max().unwrap_or(0);
    let capacity = found.channels.capacity();
    let beyond = found.wedges.iter().filter(|n| **n > capacity).count();
    vec![
        format!(
            "most in a channel: {most} of {CHANNEL}, {} carries of {}; {} writes saturated",
            found.carries(most),
            found.carries(CHANNEL),
            numbers::count(found.saturated)
        ),
        format!(
            "{capacity} wedges of full coverage fit for certain; at most {wedges} wrote to a \
             buffer, more than {capacity} at {beyond} pixels"
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use gnomon_pipeline::technique::CarryChannels;

    fn found(bits: u32, most: Vec<u32>) -> Carries {
        Carries {
            size: [most.len() as u32, 1],
            channels: CarryChannels { bits, count: 4 },
            wedges: vec![0; most.len()],
            most,
            saturated: 0,
        }
    }

    #[test]
    fn carries_begin_above_the_bits_of_a_contribution_and_end_at_the_channel() {
        let fill = |bits, sum| Fill::of(&found(bits, Vec::new()), sum);
        assert_eq!(fill(3, 0), Fill::Empty);
        assert_eq!(fill(3, 7), Fill::Uncarried);
        assert_eq!(fill(3, 8), Fill::Carried(1.0 / 31.0));
        assert_eq!(fill(3, 255), Fill::Carried(1.0));
        assert_eq!(fill(3, 256), Fill::Saturated);
        assert_eq!(fill(6, 63), Fill::Uncarried);
        assert_eq!(fill(6, 64), Fill::Carried(1.0 / 3.0));
    }

    #[test]
    fn scales_count_what_the_channel_can_note() {
        let texts = |bits| -> Vec<String> {
            let scale = scale(&found(bits, Vec::new()));
            scale.into_iter().map(|(_, text)| text).collect()
        };
        assert_eq!(texts(3), ["0", "7", "15", "23", "31"]);
        assert_eq!(texts(6), ["0", "1", "2", "3"]);
    }

    #[test]
    fn the_fullest_channel_is_told() {
        let notes = notes(&found(3, vec![0, 300, 12]));
        assert!(
            notes[0].contains("300 of 255, 31 carries of 31"),
            "{notes:?}"
        );
        assert!(notes[1].starts_with("36 wedges"), "{notes:?}");
    }
}
