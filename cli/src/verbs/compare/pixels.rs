//! How many pixels were compared, and why others were not.

use gnomon_pipeline::measure::comparison::{LeftOut, PixelCounts};

use crate::output::numbers::count;

/// Rows of a table with a column for each of `counts`. Reasons without pixels have
/// none.
pub(super) fn tabulate(counts: &[PixelCounts]) -> Vec<Vec<String>> {
    let row = |name: String, pixels: &dyn Fn(&PixelCounts) -> usize| -> Vec<String> {
        let cells = counts.iter().map(|c| count(pixels(c) as u64));
        std::iter::once(name).chain(cells).collect()
    };
    let mut rows = vec![
        row("pixels compared".to_owned(), &|c| c.compared),
        row("pixels left out".to_owned(), &|c| c.left_out.total()),
    ];
    for (k, reason) in LeftOut::default().reasons().iter().enumerate() {
        let of = |c: &PixelCounts| c.left_out.reasons()[k].pixels;
        if counts.iter().any(|c| of(c) > 0) {
            rows.push(row(format!("  {}", reason.text), &of));
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_without_pixels_have_no_row() {
        let mut counts = [PixelCounts::default(); 2];
        counts[1].compared = 70;
        counts[1].left_out.outline = 5;
        let expected = [
            ["pixels compared", "0", "70"],
            ["pixels left out", "0", "5"],
            ["  edge too near", "0", "5"],
        ];
        assert_eq!(tabulate(&counts), expected);
    }
}
