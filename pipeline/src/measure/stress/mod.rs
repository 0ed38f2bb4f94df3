//! Numerical stress: how far a scene can be pushed before a technique's error grows.
//!
//! An [`Axis`] varies one thing (units, place, triangles, near plane, light, eye) from what
//! the scene is at rest. A [`Curve`] is the error of techniques along it, each point against
//! the exact oracle on the same scene, rounded to f32 in the same way: what is measured is
//! the technique, not what rounding makes of the model. A [`Verdict`] says how far the error
//! stays what it is at rest, and whether a picture that is worse was warned of.
//!
//! ```
//! use gnomon_pipeline::measure::stress::{Axis, Candidate, Stress, Verdict};
//! use gnomon_pipeline::{techniques, world::scene::builtin};
//!
//! let scene = builtin::build("parallel-plates")?;
//! let stress = Stress { scene: &scene, light: 0, size: [48, 32], gpu: Default::default() };
//! let exact = Candidate::new(techniques::find("soft-shadow-volumes")?, &[])?;
//! let mut axis = Axis::find("scale")?;
//! axis.keep(|v| (0.5..2e2).contains(&v));
//! let curve = stress.curve(&axis, &[exact], &mut |_, _| ());
//! let verdict = Verdict::new(&curve, 0);
//! assert!(verdict.holds_throughout(), "{verdict}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod curve;
mod cut;
mod place;
mod verdict;

pub use axis::{Axis, Kind, Scale, UnknownAxis};
pub use curve::{Candidate, Curve, Measured, Outcome, Point, Stress};
pub use verdict::{End, Limit, Verdict};
