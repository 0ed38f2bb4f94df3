//! Fitting a view round what matters: the receivers that the camera sees, and the
//! casters that can come between them and the light. All in f64, in scene order.
//!
//! A blocker of a receiver at distance d from the light's plane, itself at
//! distance z, lies within `half · (1/z − 1/d)` of the receiver in tangents, half
//! being the light's half width. So the picture holds the receivers' tangents,
//! grown by that much for the nearest caster, and of these only where there are
//! casters; what is outside of it is known to be empty.

use glam::DVec3;
use gnomon_shaders::light_view::{Projection, ViewRegion};

use super::convex::TangentBox;
use super::frame::{LightExtent, LightFrame};
use super::surroundings::Surroundings;
use crate::scene::clip;

/// What a picture is fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FitTo {
    /// The casters that matter: outside of it nothing is in the way.
    Casters,
    /// The receivers seen, and what filters read round them: nothing reads
    /// outside of it.
    Receivers,
}

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fitting {
    /// Texels along a side.
    pub(crate) size: u32,
    /// Nearest distance that is looked at; `None`: [`NEAR_SHARE`] of the farthest.
    pub(crate) near: Option<f64>,
    pub(crate) to: FitTo,
}

/// Nearest distance over the farthest, where none is given.
const NEAR_SHARE: f64 = 1.0 / 1024.0;
/// Texels left free on each side, so that the casters' outlines are inside.
const FREE_TEXELS: f64 = 2.0;
/// By how much the depth range is wider than what it must hold.
const SLACK: f64 = 1.0 / 1024.0;
/// Relative distances and share of a texel within which f32 and snapping may put a
/// triangle on the other side of a view's border.
const ROUNDING: f64 = 1e-4;
const SNAPPING: f64 = 0.25;
/// Largest tangents that are looked at. Of a cube's face, 1 and what is read round
/// it; casters next to a large light would need far more.
const WIDEST_PLANAR: f64 = 16.0;
const WIDEST_FACE: f64 = 2.0;
/// Smallest half width of a picture, in tangents: casters may be a line.
const NARROWEST: f64 = 1e-5;

/// A fitted view.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fitted {
    pub(crate) frame: LightFrame,
    pub(crate) region: ViewRegion,
    /// Tangents in the middle of the picture; of orthographic views, lengths.
    pub(crate) middle: [f64; 2],
    /// Half its width and height, likewise.
    pub(crate) half: f64,
    /// Distances that are stored as 0 and 1.
    pub(crate) range: [f64; 2],
    /// Numbers of the objects that may cover some of it, ascending.
    pub(crate) objects: Vec<usize>,
    /// Triangles that the near distance cuts inside the picture.
    pub(crate) cut: usize,
    /// Largest tangent that matters.
    pub(crate) steepest: f64,
    /// Whether that is beyond what is looked at: some shadows are missing.
    pub(crate) limited: bool,
}

/// A caster's triangle as a view sees it.
struct Facet {
    bounds: TangentBox,
    object: usize,
    cut: bool,
}

/// Fits a view to what is in its region; `None` where no shadow can fall: nothing
/// is received there, or nothing is in the way.
pub(crate) fn fit(
    around: &Surroundings<'_>,
    frame: LightFrame,
    region: ViewRegion,
    extent: LightExtent,
    fitting: &Fitting,
) -> Option<Fitted> {
    let farthest = farthest_receiver(around, &frame, region)?;
    let near = fitting.near.unwrap_or(farthest * NEAR_SHARE);
    let receivers = receivers_box(around, &frame, region, near);
    if receivers.is_empty() {
        return None;
    }
    let far = farthest * (1.0 + SLACK);
    let mut facets = facets(around, &frame, near);
    facets.retain(|f| f.bounds.nearest < far * (1.0 + ROUNDING));
    let matters = |f: &&Facet| f.bounds.nearest < farthest;
    let halves = [0, 1].map(|k| extent.half_along(frame.axes[k]));
    let mut casters = joined(facets.iter().filter(matters));
    let mut window = receivers;
    // The first window is for the nearest of all casters, the second for the
    // nearest that it left.
    for _ in 0..2 {
        let reach = (1.0 / casters.nearest - 1.0 / farthest).max(0.0);
        window = receivers.grown(halves.map(|h| h * reach));
        let inside = |f: &&Facet| matters(f) && f.bounds.overlaps(&window);
        casters = joined(facets.iter().filter(inside));
        if casters.is_empty() {
            return None;
        }
    }
    let inside = match fitting.to {
        FitTo::Casters => window.meet(&casters),
        FitTo::Receivers => window,
    };
    let widest = match (frame.projection, region) {
        (Projection::Orthographic, _) => f64::INFINITY,
        (_, ViewRegion::Front) => WIDEST_PLANAR,
        (_, ViewRegion::Face) => WIDEST_FACE,
    };
    let limited = inside.steepest() > widest;
    let steepest = inside.steepest();
    let inside = inside.meet(&TangentBox {
        low: [-widest; 2],
        high: [widest; 2],
        ..TangentBox::EMPTY
    });
    if inside.is_empty() {
        return None;
    }
    let narrowest = match frame.projection {
        Projection::Perspective => NARROWEST,
        Projection::Orthographic => NARROWEST * farthest,
    };
    let (middle, half) = square(&inside, fitting.size, narrowest);
    let picture = TangentBox {
        low: middle.map(|m| m - half),
        high: middle.map(|m| m + half),
        ..inside
    };
    let picture = picture.grown([2.0 * half / f64::from(fitting.size) * SNAPPING; 2]);
    facets.retain(|f| f.bounds.overlaps(&picture));
    let mut objects: Vec<usize> = facets.iter().map(|f| f.object).collect();
    objects.dedup();
    Some(Fitted {
        frame,
        region,
        middle,
        half,
        range: [
            (near * (1.0 + ROUNDING)).max(casters.nearest * (1.0 - SLACK)),
            far,
        ],
        objects,
        cut: facets.iter().filter(|f| f.cut).count(),
        steepest,
        limited,
    })
}

/// Middle and half side of the square round `inside`, with free texels.
fn square(inside: &TangentBox, size: u32, narrowest: f64) -> ([f64; 2], f64) {
    let middle = [0, 1].map(|k| (inside.low[k] + inside.high[k]) / 2.0);
    let halves = [0, 1].map(|k| (inside.high[k] - inside.low[k]) / 2.0);
    let size = f64::from(size);
    let free = size / (size - 2.0 * FREE_TEXELS);
    (middle, halves[0].max(halves[1]).max(narrowest) * free)
}

fn joined<'a>(facets: impl IntoIterator<Item = &'a Facet>) -> TangentBox {
    let mut all = TangentBox::EMPTY;
    facets.into_iter().for_each(|f| all.join(&f.bounds));
    all
}

/// Sides of a region, as functions that are not negative inside.
fn sides(region: ViewRegion) -> &'static [fn(DVec3) -> f64] {
    match region {
        ViewRegion::Front => &[],
        ViewRegion::Face => &[|p| p.z + p.x, |p| p.z - p.x, |p| p.z + p.y, |p| p.z - p.y],
    }
}

/// Calls `visit` with each receiver's part in the region beyond `near`.
pub(super) fn receivers_beyond(
    around: &Surroundings<'_>,
    frame: &LightFrame,
    region: ViewRegion,
    near: f64,
    mut visit: impl FnMut(&[DVec3]),
) {
    let (mut polygon, mut scratch) = (Vec::new(), Vec::new());
    for receiver in around.receivers() {
        polygon.clear();
        polygon.extend(receiver.iter().map(|p| frame.local(*p)));
        if polygon.iter().any(|p| p.z < near) {
            clip(&mut polygon, &mut scratch, |p| p.z - near);
        }
        for side in sides(region) {
            if polygon.is_empty() {
                break;
            }
            clip(&mut polygon, &mut scratch, side);
        }
        visit(&polygon);
    }
}

fn farthest_receiver(
    around: &Surroundings<'_>,
    frame: &LightFrame,
    region: ViewRegion,
) -> Option<f64> {
    let mut farthest = 0.0f64;
    receivers_beyond(around, frame, region, 0.0, |polygon| {
        for p in polygon {
            farthest = farthest.max(p.z);
        }
    });
    (farthest > 0.0 && farthest.is_finite()).then_some(farthest)
}

fn receivers_box(
    around: &Surroundings<'_>,
    frame: &LightFrame,
    region: ViewRegion,
    near: f64,
) -> TangentBox {
    let mut all = TangentBox::EMPTY;
    receivers_beyond(around, frame, region, near, |polygon| {
        all.join(&TangentBox::of(polygon, frame.projection));
    });
    all
}

/// The casters' triangles beyond `near`.
fn facets(around: &Surroundings<'_>, frame: &LightFrame, near: f64) -> Vec<Facet> {
    let (mut polygon, mut scratch) = (Vec::new(), Vec::new());
    let mut all = Vec::new();
    for &(object, mesh) in &around.casters {
        for t in 0..mesh.triangles().len() {
            let corners = mesh.corners(t).map(|p| frame.local(p));
            let nearer = corners.iter().filter(|p| p.z < near).count();
            let bounds = match nearer {
                0 => TangentBox::of(&corners, frame.projection),
                1 | 2 => {
                    polygon.clear();
                    polygon.extend(corners);
                    clip(&mut polygon, &mut scratch, |p| p.z - near);
                    TangentBox::of(&polygon, frame.projection)
                }
                _ => continue,
            };
            let cut = nearer > 0;
            all.push(Facet {
                bounds,
                object,
                cut,
            });
        }
    }
    all
}
