//! The naive twin: `docs/rasterisation-rules.md` and `docs/texture-rules.md`,
//! slowly and obviously.
//!
//! One pixel at a time, i64 edge functions, images as plain row-major vectors,
//! no tiles, no lanes, no bins. It shares only plain data types with
//! gnomon-raster: conversions, comparisons, blending and counting are its own,
//! so that a mistake must be made twice to go unseen.

mod block;
mod case;
mod clip;
mod color;
mod context_look_up;
mod convert;
mod coverage;
mod depth;
mod image;
mod lane_look_up;
mod lanes;
mod log;
mod look_up;
mod plane;
mod program;
mod render;
mod setup;
mod stencil;
mod texture;
mod varying;
mod vertex;

pub use case::{
    ColorImage, ColorUse, DepthImage, DepthUse, EventDetails, Log, Look, Outcome, PassOutcome,
    Tier, TwinCase, TwinDraw, TwinPass, VertexSource,
};
pub use convert::{div255_round, f16_bits, unorm8};
pub use coverage::covered_pixels;
pub use log::BlockHash;
pub use look_up::{Coordinate, LookUp, LookUpKind, MAX_LOOK_UPS, Origin, TexelAt};
pub use program::{ColorSource, DepthSource, Discard, Program};
pub use render::{render, render_logging, render_with};
pub use texture::{TextureSource, TextureUse, TwinTexture, depth_image};
