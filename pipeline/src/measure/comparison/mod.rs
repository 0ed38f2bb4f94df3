//! Techniques against the truth: what `gnomon compare` measures.
//!
//! A [`Reference`] is the visibility of one light as an oracle finds it
//! (docs/papers.md, metrics and references, 1 and 2). [`Reference::under`] lines it up
//! with a rendered depth buffer, and [`Score::measure`] compares a technique's
//! visibility and picture with the result.
//!
//! A hard shadow is off by up to the whole light in the penumbra, and by
//! nothing in the umbra that it has:
//!
//! ```
//! use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind, Score, shaded};
//! use gnomon_pipeline::truth::oracle::area::LightRegion;
//! use gnomon_pipeline::measure::render::{self, RenderSettings};
//! use gnomon_pipeline::world::scene::builtin;
//! use gnomon_pipeline::{technique, techniques};
//!
//! let scene = builtin::build("parallel-plates")?;
//! let settings = RenderSettings { size: [64, 48], ..RenderSettings::default() };
//! let truth = Reference::new(&scene, 0, settings.size, ReferenceKind::Exact, None, &|| {})?;
//! let shadows = techniques::find("shadow-volumes")?;
//! let done = render::render(&scene, shadows, &technique::Params::defaults(shadows), &settings)?;
//! let under = truth.under(&done.depth)?;
//! let shaded = shaded(&scene, &truth, &under, &technique::Params::defaults(shadows), &settings)?;
//! let score = Score::measure(&under, &done, &shaded)?;
//! assert_eq!(score.visibility.of_region(LightRegion::Umbra).unwrap().max, 0.0);
//! assert!(score.psnr < 40.0);
//! assert!(score.visibility.of_region(LightRegion::Penumbra).unwrap().rmse > 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod aligned;
mod environment;
mod facing;
mod given_visibility;
mod pixels;
mod reference;
mod score;
mod shaded;
mod sight;

use thiserror::Error;

pub use aligned::Aligned;
pub use environment::{Directions, EnvironmentReference, RadianceScore};
pub use facing::facing;
pub use pixels::{LeftOut, PixelCounts, Reason};
pub use reference::{Origin, RAYS_SEED, RAYS_SIDE, Reference, ReferenceKind, UnknownReference};
pub use score::{BANDING_EDGE, Score};
pub use shaded::{ShadingKey, shaded};

use crate::truth::metrics::MetricError;
use crate::world::error::LightError;

/// Why nothing could be compared.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CompareError {
    /// A light that the scene does not have.
    #[error("light {given} was asked for; the scene has {count}, numbered from 0")]
    NoSuchLight {
        /// The number given.
        given: usize,
        /// Number of lights of the scene.
        count: usize,
    },
    /// Shadow rays against an image on the light.
    #[error("a light with an image has the reference 'exact' alone: shadow rays know no colors")]
    ImageByRays,
    /// The light cannot be integrated over.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The images do not fit together.
    #[error(transparent)]
    Metric(#[from] MetricError),
}
