//! From planes of world space to planes of screen space, and what shaders need of
//! a wedge.

use glam::{DMat4, DVec3};
use gnomon_shaders::penumbra::crossing::SideIntensity;
use gnomon_shaders::penumbra::intensity::{IntensityRates, Interpolation};
use gnomon_shaders::penumbra::plane::ScreenPlane;
use gnomon_shaders::penumbra::tiles::WedgePlanes;

use crate::geometry::wedge::Plane;
use crate::geometry::wedge::paper1::{End, LinkedWedge};
use crate::parts::passes::View;

/// Turns planes into [`ScreenPlane`]s for one view and image size.
pub(crate) struct Screen {
    /// Planes of clip space from planes of world space.
    clip_from_world: DMat4,
    size: [f64; 2],
}

impl Screen {
    pub(crate) fn new(view: &View, size: [u32; 2]) -> Self {
        let rows = view.clip_from_world.0.map(|row| row.map(f64::from));
        // Rows taken as columns: the transpose, whose inverse moves planes.
        Self {
            clip_from_world: DMat4::from_cols_array_2d(&rows).inverse(),
            size: size.map(f64::from),
        }
    }

    /// The plane as a function of column, row and 1 - depth. Negation carries
    /// through every operation, so a reversed plane has negated coefficients.
    pub(crate) fn plane(&self, view: &View, plane: &Plane) -> ScreenPlane {
        ScreenPlane(self.coefficients(view, plane).map(|c| c as f32))
    }

    /// [`Screen::plane`] before rounding.
    pub(crate) fn coefficients(&self, view: &View, plane: &Plane) -> [f64; 4] {
        let n = plane.normal;
        let offset = -n.dot(view.relative(plane.point));
        let c = self.clip_from_world * n.extend(offset);
        let [width, height] = self.size;
        // c.clip / w at NDC (2 x / width - 1, 1 - 2 y / height, 1 - q).
        [
            2.0 * c.x / width,
            -2.0 * c.y / height,
            ((c.z + c.w) - c.x) + c.y,
            -c.z,
        ]
    }

    /// Front, back and side planes of a wedge.
    pub(crate) fn wedge(&self, view: &View, wedge: &LinkedWedge) -> [ScreenPlane; 4] {
        wedge.planes().map(|p| self.plane(view, &p))
    }

    /// The planes of a wedge as pixels and tiles are tested against them.
    pub(crate) fn wedge_planes(&self, view: &View, wedge: &LinkedWedge, end: &End) -> WedgePlanes {
        let planes = self.wedge(view, wedge);
        WedgePlanes {
            planes,
            front_margin: self.depth_margin(&planes[0]),
            bottom: end.0.map(|plane| self.plane(view, &plane)),
        }
    }

    /// By how much, as a value of the plane, the depth of its rasterised faces may be off:
    /// vertices are snapped to 1/256 pixel, depth and coefficients are rounded.
    pub(crate) fn depth_margin(&self, plane: &ScreenPlane) -> f32 {
        const SNAPPING: f64 = 1.0 / 256.0;
        const ROUNDING: f64 = 1e-5;
        let [a, b, c, d] = plane.0.map(|v| f64::from(v).abs());
        let largest = [a * self.size[0], b * self.size[1], c, d];
        let largest = largest.into_iter().fold(0.0, f64::max);
        ((a + b) * SNAPPING + largest * ROUNDING) as f32
    }

    /// For intensities in the side planes of a wedge. Both wedges at a joint get
    /// the same bits.
    pub(crate) fn sides(&self, view: &View, wedge: &LinkedWedge) -> [SideIntensity; 2] {
        [0, 1].map(|k| {
            let apex = wedge.edge[k];
            let [front, back] = between(wedge, k, apex);
            let direction = wedge.side_directions.0[k];
            SideIntensity {
                between: [front, back].map(|p| self.plane(view, &p)),
                back_over_front: over(
                    back.normal.dot(direction).abs(),
                    front.normal.dot(direction).abs(),
                ),
            }
        })
    }
}

/// Planes square to side plane k through its front and its back ray, positive
/// between the two.
fn between(wedge: &LinkedWedge, k: usize, apex: DVec3) -> [Plane; 2] {
    let normal = wedge.sides[k].normal;
    let [front, back] = [wedge.front_rays[k], wedge.back_rays[k]];
    let square = |ray: DVec3, towards: DVec3| {
        let n = normal.cross(ray).normalize_or_zero();
        Plane {
            normal: if n.dot(towards) < 0.0 { -n } else { n },
            point: apex,
        }
    };
    [square(front, back), square(back, front)]
}

/// The rates of a wedge's intensity (paper I, §5: constant over the wedge).
pub(crate) fn rates(wedge: &LinkedWedge, interpolation: Interpolation) -> IntensityRates {
    let rate = |plane: &Plane, direction: DVec3| plane.normal.dot(direction).abs();
    let ratio = |k: usize| {
        let d = wedge.side_directions.0[k];
        over(rate(&wedge.back, d), rate(&wedge.front, d))
    };
    let [first, second] = [0, 1].map(|k| rate(&wedge.sides[k], wedge.along));
    IntensityRates {
        back_over_front: [ratio(0), ratio(1)],
        first_over_second: over(first, second),
        interpolation,
    }
}

/// Where there is no wedge, and no intensity.
pub(crate) fn no_rates(interpolation: Interpolation) -> IntensityRates {
    IntensityRates {
        back_over_front: [1.0; 2],
        first_over_second: 1.0,
        interpolation,
    }
}

/// A quotient of rates; a direction inside a plane has none, and counts as 1 as
/// in [`LinkedWedge::intensity`].
fn over(above: f64, below: f64) -> f32 {
    // Limited, so that products with distances stay finite and above nothing.
    const LIMIT: f64 = 1e6;
    let or_one = |x: f64| if x == 0.0 { 1.0 } else { x };
    (or_one(above) / or_one(below)).clamp(1.0 / LIMIT, LIMIT) as f32
}
