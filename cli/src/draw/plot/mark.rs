//! Markers: shapes that are told apart without colour.

use super::layout::{COLOURS, Item, PAPER};
use super::raster::ring;

/// Corners at these distances from the centre, and the first one's angle in turns.
const SHAPES: [(&[f32], f64); 9] = [
    (&[7.0; 16], 0.0),  // circle
    (&[8.5; 4], 0.125), // square
    (&[9.5; 3], 0.75),  // triangle up
    (&[9.5; 3], 0.25),  // triangle down
    (&[9.5; 4], 0.0),   // diamond
    (
        &[10.5, 4.5, 10.5, 4.5, 10.5, 4.5, 10.5, 4.5, 10.5, 4.5],
        0.75,
    ), // star of five
    (&[10.0, 3.5, 10.0, 3.5, 10.0, 3.5, 10.0, 3.5], 0.0), // star of four
    (&[10.0, 3.5, 10.0, 3.5, 10.0, 3.5, 10.0, 3.5], 0.125), // star of four, turned
    (&[10.5, 4.5, 4.5, 10.5, 4.5, 4.5], 0.0), // lens
];

/// Reach of the largest marker in pixels, its outline included.
pub(super) const REACH: f32 = 11.5;

/// How a series is marked: 9 shapes, each full, empty, and with a point inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Marker {
    shape: usize,
    filling: usize,
    pub(super) colour: [u8; 3],
}

impl Marker {
    /// Of series number `k`.
    pub(super) fn of(k: usize) -> Self {
        Self {
            shape: k % SHAPES.len(),
            filling: k / SHAPES.len() % 3,
            colour: COLOURS[k % COLOURS.len()],
        }
    }

    /// What is drawn at `at`.
    pub(super) fn items(self, at: [f32; 2], title: &str) -> Vec<Item> {
        let (radii, turn) = SHAPES[self.shape];
        let marker = |outline, fill| Item::Marker {
            outline,
            fill,
            colour: self.colour,
            title: title.to_owned(),
        };
        let fill = if self.filling == 0 {
            self.colour
        } else {
            PAPER
        };
        let mut items = vec![marker(ring(at, radii, turn), fill)];
        if self.filling == 2 {
            items.push(marker(ring(at, &[1.5; 4], 0.125), self.colour));
        }
        items
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without colour: by outline and filling.
    #[test]
    fn many_series_are_told_apart_in_grey() {
        let look = |k| {
            let items = Marker::of(k).items([0.0, 0.0], "");
            let grey = items.iter().map(|item| match item {
                Item::Marker { outline, fill, .. } => format!("{outline:?} {}", *fill == PAPER),
                other => panic!("{other:?}"),
            });
            grey.collect::<String>()
        };
        let mut looks: Vec<String> = (0..27).map(look).collect();
        looks.sort();
        looks.dedup();
        assert_eq!(looks.len(), 27);
    }

    #[test]
    fn no_marker_reaches_further_than_is_said() {
        for (radii, _) in SHAPES {
            assert!(radii.iter().all(|r| r + 1.0 <= REACH));
        }
    }
}
