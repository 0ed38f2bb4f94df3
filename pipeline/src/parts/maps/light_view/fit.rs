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

use super::between::Between;
use super::convex::TangentBox;
use super::frame::{FAR_AWAY, LightExtent, LightFrame};
use super::surroundings::Surroundings;
use crate::world::mesh::widen;
use crate::world::scene::clip;

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
    /// How far what is attached to casters reaches beyond them in the picture: tangents,
    /// or lengths.
    pub(crate) margin: f64,
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
    /// Distance to which shaders' distances are relative: that stored as 0 where the
    /// light is far away, else 0.
    pub(crate) base: f64,
    /// Numbers of the objects that may cover some of it, ascending.
    pub(crate) objects: Vec<usize>,
    /// Their triangles that may be in the way, where not all are drawn.
    pub(crate) triangles: Option<Vec<(usize, u32)>>,
    /// Triangles that the near distance cuts inside the picture.
    pub(crate) cut: usize,
    /// Largest tangent that matters.
    pub(crate) steepest: f64,
    /// Whether that is beyond what is looked at: some shadows are missing.
    pub(crate) limited: bool,
}

impl Fitted {
    /// The nearest and the farthest distance of a vertex of the casters that may cover
    /// some of the picture, within what is looked at.
    pub(crate) fn distances(&self, around: &Surroundings<'_>) -> [f64; 2] {
        let [near, far] = self.range;
        let casters = around.casters.iter();
        let seen = casters.filter(|(object, _)| self.objects.binary_search(object).is_ok());
        let corners = seen.flat_map(|(_, mesh)| mesh.positions().iter().map(|p| widen(*p)));
        let distances = corners.map(|p| self.frame.local(p).z.clamp(near, far));
        let (least, most) = distances.fold((far, near), |(a, b), z| (a.min(z), b.max(z)));
        [least.min(most), most]
    }
}

/// What comes of fitting.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Fit {
    /// No shadow can fall: nothing is received there, or nothing is in the way.
    Unshadowed,
    /// All that is in the way is beyond the tangents that are looked at.
    OutOfReach,
    View(Box<Fitted>),
}

/// A caster's triangle as a view sees it.
pub(super) struct Facet {
    pub(super) bounds: TangentBox,
    pub(super) object: usize,
    pub(super) triangle: u32,
    pub(super) cut: bool,
}

/// Fits a view to what is in its region.
pub(crate) fn fit(
    around: &Surroundings<'_>,
    frame: LightFrame,
    region: ViewRegion,
    extent: LightExtent,
    fitting: &Fitting,
) -> Fit {
    let Some(farthest) = farthest_receiver(around, &frame, region) else {
        return Fit::Unshadowed;
    };
    let near = fitting.near.unwrap_or(farthest * NEAR_SHARE);
    let receivers = receivers_box(around, &frame, region, near);
    if receivers.is_empty() {
        return Fit::Unshadowed;
    }
    let halves = [0, 1].map(|k| extent.half_along(frame.axes[k]));
    let scope = Scope {
        frame,
        region,
        halves,
        fitting,
        near,
        farthest,
        receivers,
    };
    let fit = scope.view(facets(around, &frame, near));
    if scope.is_settled(&fit) {
        return fit;
    }
    let range = [near, farthest];
    let places = receivers.grown([fitting.margin; 2]);
    let between = Between::new(around, frame, region, extent, places, range);
    scope.exact_view(between.facets(around))
}

/// What a view is to hold.
struct Scope<'a> {
    frame: LightFrame,
    region: ViewRegion,
    /// Half widths of the light along the picture's axes.
    halves: [f64; 2],
    fitting: &'a Fitting,
    /// Nearest distance that is looked at.
    near: f64,
    /// Distance of the farthest receiver.
    farthest: f64,
    receivers: TangentBox,
}

impl Scope<'_> {
    /// Whether bounds of triangles told enough. They do not where some are cut or out
    /// of reach, nor for lights from so far away that a level floor may be seen edge
    /// on all over.
    fn is_settled(&self, fit: &Fit) -> bool {
        match fit {
            Fit::Unshadowed => true,
            Fit::OutOfReach => false,
            Fit::View(view) => {
                let near = self.frame.projection == Projection::Perspective && view.base == 0.0;
                near && view.cut == 0 && !view.limited
            }
        }
    }

    /// The view of triangles all of which may be in the way; no others are drawn.
    fn exact_view(&self, facets: Vec<Facet>) -> Fit {
        let triangles = facets.iter().map(|f| (f.object, f.triangle)).collect();
        let fit = self.view(facets);
        match fit {
            Fit::View(mut view) => {
                view.triangles = Some(triangles);
                Fit::View(view)
            }
            other => other,
        }
    }

    fn view(&self, mut facets: Vec<Facet>) -> Fit {
        let farthest = self.farthest;
        facets.retain(|f| f.bounds.nearest < farthest * (1.0 + SLACK) * (1.0 + ROUNDING));
        let Some((window, casters)) = self.window(&facets) else {
            return Fit::Unshadowed;
        };
        let inside = match self.fitting.to {
            FitTo::Casters => window.meet(&casters.grown([self.fitting.margin; 2])),
            FitTo::Receivers => window,
        };
        let steepest = inside.steepest();
        let inside = inside.meet(&TangentBox {
            low: [-self.widest(); 2],
            high: [self.widest(); 2],
            ..TangentBox::EMPTY
        });
        if inside.is_empty() {
            return Fit::OutOfReach;
        }
        let (range, base) = self.range(casters.nearest);
        let (middle, half) = square(&inside, self.fitting.size, self.narrowest(range, base));
        let picture = TangentBox {
            low: middle.map(|m| m - half),
            high: middle.map(|m| m + half),
            ..inside
        };
        let snapping = 2.0 * half / f64::from(self.fitting.size) * SNAPPING;
        let picture = picture.grown([snapping + self.fitting.margin; 2]);
        facets.retain(|f| f.bounds.overlaps(&picture));
        let mut objects: Vec<usize> = facets.iter().map(|f| f.object).collect();
        objects.dedup();
        Fit::View(Box::new(Fitted {
            frame: self.frame,
            region: self.region,
            middle,
            half,
            range,
            base,
            objects,
            triangles: None,
            cut: facets.iter().filter(|f| f.cut).count(),
            steepest,
            limited: steepest > self.widest(),
        }))
    }

    /// Where receivers may read, and bounds of the casters there; `None` without any.
    fn window(&self, facets: &[Facet]) -> Option<(TangentBox, TangentBox)> {
        let matters = |f: &&Facet| f.bounds.nearest < self.farthest;
        let mut casters = joined(facets.iter().filter(matters));
        let mut window = self.receivers;
        // The first window is for the nearest of all casters, the second for the
        // nearest that it left.
        for _ in 0..2 {
            let reach = (1.0 / casters.nearest - 1.0 / self.farthest).max(0.0);
            window = self.receivers.grown(self.halves.map(|h| h * reach));
            let reached = window.grown([self.fitting.margin; 2]);
            let inside = |f: &&Facet| matters(f) && f.bounds.overlaps(&reached);
            casters = joined(facets.iter().filter(inside));
            if casters.is_empty() {
                return None;
            }
        }
        Some((window, casters))
    }

    fn widest(&self) -> f64 {
        match (self.frame.projection, self.region) {
            (Projection::Orthographic, _) => f64::INFINITY,
            (_, ViewRegion::Front) => WIDEST_PLANAR,
            (_, ViewRegion::Face) => WIDEST_FACE,
        }
    }

    /// Distances that are stored as 0 and 1, and what shaders' are relative to.
    fn range(&self, nearest: f64) -> ([f64; 2], f64) {
        let (near, farthest) = (self.near * (1.0 + ROUNDING), self.farthest);
        let depth = FAR_AWAY * (farthest - nearest);
        if self.frame.projection == Projection::Orthographic || depth >= farthest {
            let from = near.max(nearest * (1.0 - SLACK));
            return ([from, farthest * (1.0 + SLACK)], 0.0);
        }
        let slack = depth.max(farthest * f64::EPSILON) * SLACK;
        let from = near.max(nearest - slack);
        ([from, farthest + slack], from)
    }

    fn narrowest(&self, [from, to]: [f64; 2], base: f64) -> f64 {
        match self.frame.projection {
            Projection::Orthographic => NARROWEST * self.farthest,
            Projection::Perspective if base > 0.0 => NARROWEST * (to - from) / to,
            Projection::Perspective => NARROWEST,
        }
    }
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
    visit: impl FnMut(&[DVec3]),
) {
    clipped(around.receivers(), frame, region, near, visit);
}

/// The same of some polygons.
pub(super) fn clipped<'a>(
    receivers: impl Iterator<Item = &'a [DVec3]>,
    frame: &LightFrame,
    region: ViewRegion,
    near: f64,
    mut visit: impl FnMut(&[DVec3]),
) {
    let (mut polygon, mut scratch) = (Vec::new(), Vec::new());
    for receiver in receivers {
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
                triangle: t as u32,
                cut,
            });
        }
    }
    all
}
