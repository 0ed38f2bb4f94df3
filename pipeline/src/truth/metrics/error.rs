//! Why two images cannot be compared.

use thiserror::Error;

/// Why two images cannot be compared.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MetricError {
    /// The images differ in size.
    #[error("the images are {}x{} and {}x{}; both must have one size", .reference[0], .reference[1], .test[0], .test[1])]
    SizesDiffer {
        /// Width and height of the reference.
        reference: [u32; 2],
        /// Width and height of the other.
        test: [u32; 2],
    },
    /// The data does not fill the size.
    #[error("{found} values for {}x{} pixels; {expected} are needed", .size[0], .size[1])]
    WrongLength {
        /// Width and height.
        size: [u32; 2],
        /// Values there must be.
        expected: usize,
        /// Values there are.
        found: usize,
    },
    /// Too few pixels for the metric's window.
    #[error("the images are {}x{}; the metric needs at least {least}x{least} pixels", .size[0], .size[1])]
    TooSmall {
        /// Width and height.
        size: [u32; 2],
        /// Least width and height.
        least: u32,
    },
    /// A parameter outside its range.
    #[error("{name} is {value}; valid is {rule}")]
    Parameter {
        /// What it is called.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What would be valid.
        rule: &'static str,
    },
}

/// The common size of two images.
pub(super) fn same_size(reference: [u32; 2], test: [u32; 2]) -> Result<[u32; 2], MetricError> {
    if reference == test {
        Ok(reference)
    } else {
        Err(MetricError::SizesDiffer { reference, test })
    }
}

/// Checks that `found` values are `per_pixel` for each pixel.
pub(super) fn filled(size: [u32; 2], per_pixel: usize, found: usize) -> Result<(), MetricError> {
    let expected = size[0] as usize * size[1] as usize * per_pixel;
    if found == expected {
        Ok(())
    } else {
        Err(MetricError::WrongLength {
            size,
            expected,
            found,
        })
    }
}
