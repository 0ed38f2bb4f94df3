//! What two frames differ in: as data, in what they draw, and which change of state
//! makes the difference.

mod align;
mod facet;
mod state;

pub use state::{Place, StateDifference, compare_states};
