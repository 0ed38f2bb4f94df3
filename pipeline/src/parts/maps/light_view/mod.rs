//! Light views: planar pictures of the casters from a light, as passes of their
//! own ("light view"; docs/papers.md, Annen et al. 2008 and baselines).
//!
//! A view looks from one point along an axis at a square of tangents (x/z, y/z).
//! Its picture is an `R32Float` texture of *linear planar depth*: distance along
//! the axis, 0 at the view's near distance and 1 at its far distance, which is
//! also what is cleared to and means that nothing is in the way. A 32-bit depth
//! buffer finds the nearest surface; it keeps nothing that is read later.
//!
//! Flat lights are looked at along their normal, on either side; points and
//! spheres towards the receivers. Where that would need tangents beyond
//! [`WIDEST`], as when the light is among its receivers, the six faces of a cube
//! stand for it, each fitted like any other view and with a texture of its own.
//! Regions of views do not overlap, and each is drawn only where some receiver
//! that the camera sees can have a caster in the way; elsewhere all is lit.
//!
//! Directional lights are looked along by one orthographic view, from before all that
//! matters; places in its picture are lengths instead of tangents.
//!
//! Casters outside a view are left out, which changes no bit: `skip=off` draws
//! them all.

mod between;
mod convex;
mod fit;
mod frame;
mod picture;
mod reads;
mod surroundings;
#[cfg(test)]
mod tests;

use gnomon_shaders::light_view::{Projection, ViewRegion};

use fit::Fit;
pub(crate) use fit::{FitTo, Fitted, Fitting};
pub(crate) use frame::{LightExtent, LightFrame, ViewedLight};
pub(crate) use picture::{CasterGeometry, LightMap, PictureTarget};
pub(crate) use reads::Reads;
pub(crate) use surroundings::Surroundings;

use crate::world::mesh::widen;

/// Largest tangent of a view to one side; beyond, a cube is better.
const WIDEST: f64 = 4.0;

/// Which views a light is looked at with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Views {
    /// Planar where that is not too wide, else a cube.
    Auto,
    /// One to each side of the light.
    Planar,
    /// The faces of a cube.
    Cube,
}

/// The views of a light.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LightViews {
    /// Those that some shadow may come from; several have regions that do not overlap.
    /// None: all receivers are lit.
    pub(crate) views: Vec<Fitted>,
    /// Views that would have to be so wide that there are none.
    pub(crate) missing: usize,
}

impl LightViews {
    fn of(fits: impl Iterator<Item = Fit>) -> Self {
        let mut all = Self::default();
        for fit in fits {
            match fit {
                Fit::Unshadowed => {}
                Fit::OutOfReach => all.missing += 1,
                Fit::View(view) => all.views.push(*view),
            }
        }
        all
    }

    /// Whether planar views hold all that they should.
    fn are_narrow(&self) -> bool {
        let narrow = |v: &Fitted| v.steepest <= WIDEST && v.cut == 0;
        self.missing == 0 && self.views.iter().all(narrow)
    }
}

/// The views of `light`.
pub(crate) fn views_of(
    light: &ViewedLight,
    around: &Surroundings<'_>,
    views: Views,
    fitting: &Fitting,
) -> LightViews {
    if light.frame.projection == Projection::Orthographic {
        let frame = before_everything(light.frame, around);
        let view = fit::fit(around, frame, ViewRegion::Front, light.extent, fitting);
        return LightViews::of(std::iter::once(view));
    }
    let frame = match light.extent {
        LightExtent::Flat(_) => light.frame,
        LightExtent::None | LightExtent::Ball(_) => towards_receivers(light.frame, around),
    };
    let planar = || {
        let both = [frame, frame.reversed()].into_iter();
        let one = |f| fit::fit(around, f, ViewRegion::Front, light.extent, fitting);
        LightViews::of(both.map(one))
    };
    let cube = || {
        let faces = light.frame.faces().into_iter();
        let one = |f| fit::fit(around, f, ViewRegion::Face, light.extent, fitting);
        LightViews::of(faces.map(one))
    };
    match views {
        Views::Planar => planar(),
        Views::Cube => cube(),
        Views::Auto => {
            let found = planar();
            if found.are_narrow() { found } else { cube() }
        }
    }
}

/// An orthographic frame from which all receivers and casters are in front, the
/// nearest of them beyond where views begin.
fn before_everything(frame: LightFrame, around: &Surroundings<'_>) -> LightFrame {
    /// Room before the nearest point, as a share of the depth of all.
    const ROOM: f64 = 1.0 / 128.0;
    let Some(middle) = around.middle() else {
        return frame;
    };
    let frame = frame.at(middle);
    let receivers = around.receivers().flatten().copied();
    let casters = around.casters.iter();
    let corners = casters.flat_map(|(_, mesh)| mesh.positions().iter().map(|p| widen(*p)));
    let distances = receivers.chain(corners).map(|p| frame.local(p).z);
    let empty = (f64::INFINITY, f64::NEG_INFINITY);
    let (near, far) = distances.fold(empty, |(a, b), z| (a.min(z), b.max(z)));
    // All in one plane across: any room will do.
    let depth = if far > near { far - near } else { 1.0 };
    frame.at(middle + frame.axes[2] * (near - depth * ROOM))
}

/// A frame whose axis goes to the middle of what the camera sees.
fn towards_receivers(frame: LightFrame, around: &Surroundings<'_>) -> LightFrame {
    let Some(along) = around.middle().map(|m| m - frame.centre) else {
        return frame;
    };
    if along.length() <= f64::MIN_POSITIVE.sqrt() || !along.is_finite() {
        return frame;
    }
    let right = along.any_orthogonal_vector();
    LightFrame {
        axes: frame::axes_of(right, along),
        ..frame
    }
}
