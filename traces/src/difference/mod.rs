//! What two frames differ in: as data, in what they draw, and which change of state
//! makes the difference.

mod align;
mod bisect;
mod effect;
mod facet;
mod image;
mod minimise;
mod mixture;
mod state;

pub use bisect::{BisectError, Cause, DifferingPixel, Suspects, bisect};
pub use effect::{AttachmentDifference, FirstDifference, first_difference};
pub use state::{Place, StateDifference, compare_states};
