//! What is kept in files: the plan of a suite, and the result of each of its cells.

use serde::{Deserialize, Serialize};

use super::exact::Exact;

/// Raised whenever files of older versions would be misread.
pub(super) const FORMAT: u32 = 1;

/// Everything that a suite measures, in the order of its tables.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plan {
    /// The suite's name.
    pub(super) suite: String,
    /// Version of the program.
    pub(super) version: String,
    /// Which build of it: a hash of the executable.
    pub(super) build: String,
    /// Frames that are timed.
    pub(super) repeat: u32,
    /// Number of the light that shines.
    pub(super) light: usize,
    /// Which oracle is asked.
    pub(super) reference: String,
    /// What is measured.
    pub(super) cells: Vec<Cell>,
}

/// One scene by one technique with its parameters, at a size, on so many threads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Cell {
    /// Hash of everything that decides the result.
    pub(super) key: String,
    /// The scene's name.
    pub(super) scene: String,
    /// The technique's name.
    pub(super) technique: String,
    /// Parameters that are not at their defaults.
    pub(super) settings: Vec<(String, String)>,
    /// All parameters.
    pub(super) params: Vec<(String, String)>,
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
    /// Worker threads.
    pub(super) threads: usize,
}

impl Cell {
    /// The settings as they are given: `samples=16 pattern=grid`.
    pub(super) fn settings_text(&self) -> String {
        let settings = self.settings.iter().map(|(k, v)| format!("{k}={v}"));
        settings.collect::<Vec<_>>().join(" ")
    }

    /// Technique and settings.
    pub(super) fn label(&self) -> String {
        format!("{} {}", self.technique, self.settings_text())
            .trim_end()
            .to_owned()
    }
}

/// The result of a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stored {
    /// Of the cell.
    pub(super) key: String,
    /// What came of it.
    pub(super) outcome: Outcome,
}

/// What came of a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Outcome {
    /// The technique does not draw this scene.
    Refused(String),
    /// It does.
    Measured(Box<Measured>),
}

/// Errors, bytes and times of a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Measured {
    /// Equal on every machine.
    pub(crate) found: Found,
    /// Different each time.
    pub(crate) time: Time,
}

/// What has the same bits on every machine, and each time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Found {
    pub(crate) rmse: Option<Exact>,
    pub(crate) max: Option<Exact>,
    pub(super) p99: Option<Exact>,
    pub(super) mean: Option<Exact>,
    pub(super) rmse_umbra: Option<Exact>,
    pub(super) rmse_penumbra: Option<Exact>,
    pub(super) rmse_lit: Option<Exact>,
    pub(super) banding_p99: Exact,
    pub(super) psnr: Exact,
    pub(super) ssim: Option<Exact>,
    pub(super) flip: Exact,
    pub(super) pixels_compared: usize,
    pub(super) pixels_left_out: usize,
    pub(crate) bytes: u64,
    /// Bytes read and written by client, clears included.
    pub(super) clients: Vec<(String, [u64; 2])>,
    pub(super) shaded_fragments: u64,
    pub(super) color_hash: String,
    pub(super) visibility_hash: String,
    /// Codes of warnings, with their counts.
    pub(super) warnings: Vec<(String, usize)>,
}

/// Times in milliseconds, and what they were measured under.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Time {
    /// Of building the frame, in the order measured.
    pub(super) builds: Vec<Exact>,
    /// Of drawing it, in the order measured.
    pub(super) frames: Vec<Exact>,
    /// Load average of the last minute before; `None` where the system tells none.
    pub(super) load: Option<Exact>,
    /// Processors.
    pub(super) cores: usize,
    /// The instruction set that was used.
    pub(super) simd: String,
}

impl Time {
    /// Median time of building.
    pub(super) fn build(&self) -> f64 {
        sorted(&self.builds).1
    }

    /// Median time of a frame.
    pub(super) fn frame(&self) -> f64 {
        sorted(&self.frames).1
    }

    /// Least and largest time of a frame.
    pub(super) fn spread(&self) -> [f64; 2] {
        let (low, _, high) = sorted(&self.frames);
        [low, high]
    }

    /// From the mesh to the picture: both medians.
    pub(crate) fn whole(&self) -> f64 {
        self.build() + self.frame()
    }
}

/// Least, median and largest; the median of an even number is the mean of two.
fn sorted(times: &[Exact]) -> (f64, f64, f64) {
    let mut times: Vec<f64> = times.iter().map(|t| t.0).collect();
    times.sort_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (times.first(), times.last()) else {
        return (0.0, 0.0, 0.0);
    };
    let middle = times.len() / 2;
    let median = match times.len() % 2 {
        1 => times[middle],
        _ => 0.5 * (times[middle - 1] + times[middle]),
    };
    (low, median, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_spreads_are_of_all_times() {
        let time = |all: &[f64]| Time {
            builds: vec![Exact(1.0), Exact(4.0)],
            frames: all.iter().map(|t| Exact(*t)).collect(),
            load: None,
            cores: 1,
            simd: "scalar".to_owned(),
        };
        let odd = time(&[5.0, 1.0, 2.0, 9.0, 3.0]);
        assert_eq!((odd.frame(), odd.spread()), (3.0, [1.0, 9.0]));
        assert_eq!((odd.build(), odd.whole()), (2.5, 5.5));
        assert_eq!(time(&[4.0, 2.0]).frame(), 3.0);
        assert_eq!(time(&[]).spread(), [0.0, 0.0]);
    }
}
