//! Penumbra wedges of papers I and II: intensities added to a light-intensity
//! buffer (`R16Sint`), out of planes in screen space and the depth buffer.
//!
//! Sources: Akenine-Möller and Assarsson, "Approximate Soft Shadows on Arbitrary
//! Surfaces using Penumbra Wedges" (paper I), §4 and §5; Assarsson and
//! Akenine-Möller, "Interactive Rendering of Soft Shadows using an Optimized and
//! Generalized Penumbra Wedge Algorithm" (paper II), §3 to §6.
//!
//! * [`plane`]: plane equations over pixel and depth, and their extremes in a box
//! * [`intensity`]: the interpolated intensity of a point in a wedge
//! * [`face`]: paper I, what a ray gains by a face of a wedge, as it was implemented
//! * [`crossing`]: paper I, what a ray gains between entering and leaving, as it is defined
//! * [`inside`]: paper II, the penumbra apart from the umbra
//! * [`tiles`]: paper II, which tiles a wedge reaches, tested once each
//! * [`buffers`]: smallest and largest depth of tiles; stencil counts to intensities
//!
//! Full light is 255, one step of an 8-bit channel is 1.

pub mod buffers;
pub mod crossing;
pub mod face;
pub mod inside;
pub mod intensity;
pub mod plane;
pub mod tiles;

use gnomon_raster::shader::Fragment;
use gnomon_raster::{F32, I32, Lanes, Mask};

use plane::ScreenPoint;

/// The intensity of a fully visible light in the light-intensity buffer.
pub const FULL: f32 = 255.0;

/// What the pixel of a fragment shows, by the depth in texture `slot`, and where
/// that is a surface at all.
#[inline(always)]
fn seen<L: Lanes>(l: L, f: &mut Fragment<'_, L>, slot: usize) -> (ScreenPoint<L>, Mask<L>) {
    let depth = stored_depth(l, f, slot);
    at_depth(l, f, depth)
}

/// The depth in texture `slot` at the pixel of a fragment.
#[inline(always)]
fn stored_depth<L: Lanes>(l: L, f: &mut Fragment<'_, L>, slot: usize) -> F32<L> {
    let at = [f.column(), f.row(), I32::splat(l, 0)];
    f.fetch_texel(slot, at, 0)[0]
}

/// The point of a fragment's pixel at `depth`, and where that is a surface.
#[inline(always)]
fn at_depth<L: Lanes>(l: L, f: &Fragment<'_, L>, depth: F32<L>) -> (ScreenPoint<L>, Mask<L>) {
    let q = F32::splat(l, 1.0) - depth;
    let point = ScreenPoint {
        x: f.x(),
        y: f.y(),
        q,
    };
    (point, q.gt(F32::splat(l, 0.0)))
}
