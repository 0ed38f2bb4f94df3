//! The light above a facet's horizon.
//!
//! Nothing on a facet sees more of a flat light than what lies before the facet's
//! plane: one number for each facet, in closed form. So visibility is limited to it,
//! by one draw of the facets that cast and are not above the whole light, blended by
//! minimum.
//!
//! A silhouette from the light's centre does not tell that a facet whose plane cuts
//! the light sees a part of it only; on curved casters that is most of what soft shadow
//! volumes get wrong. In shadow maps a facet turned away is nearer to its own depth
//! than the bias, and comes out lit.
//!
//! The papers do not do this (`horizon=off`); it changes nothing for receivers that cast
//! no shadow. Spheres, whose share before a plane differs over a facet, and lights with an
//! image, whose colours do not lie alike before it, are left out, which is said.

use glam::DVec3;
use gnomon_raster::state::{BlendState, ColorTargetState};
use gnomon_raster::{LoadOp, RenderPass};
use gnomon_shaders::surface::FacetValue;

use super::passes::{SceneDraws, Targets};
use super::visibility::{VisibilityTexture, attachment};
use crate::geometry::area_light::AreaLight;
use crate::technique::{Param, Warning};
use crate::world::light::{HardLight, Light, LightShape};

pub(crate) const HORIZON: Param<bool> = Param::switch(
    "horizon",
    true,
    "limit what a caster's facet sees to the light before its plane; off: as in the papers",
);

/// A light of which facets see what is before their plane.
pub(crate) enum Horizon {
    /// A share of it.
    Area(AreaLight),
    /// All or nothing.
    Hard(HardLight),
}

impl Horizon {
    /// Of light number `number`.
    ///
    /// # Errors
    /// Why the light is left out.
    pub(crate) fn of(number: usize, light: &Light, has_image: bool) -> Result<Self, Warning> {
        let left_out = |why: &str| Warning {
            code: "horizon-left-out",
            count: 1,
            message: format!("light {number} {why}: facets are not limited to what is before them"),
        };
        match light.shape {
            LightShape::Sphere { .. } => Err(left_out("is a sphere")),
            LightShape::Point { .. } | LightShape::Directional { .. } => {
                Ok(Self::Hard(light.hard()))
            }
            _ if has_image => Err(left_out("has an image")),
            _ => match AreaLight::new(&light.shape) {
                Ok(area) => Ok(Self::Area(area)),
                Err(why) => Err(left_out(&format!("has no area ({why})"))),
            },
        }
    }

    /// Limits `visibility` of the light; `None` where no facet needs it.
    pub(crate) fn pass(
        &self,
        label: String,
        draws: &SceneDraws<'_>,
        targets: &Targets,
        visibility: VisibilityTexture,
    ) -> Option<RenderPass> {
        let view = &draws.view;
        let share = |corners: [DVec3; 3]| {
            let [a, b, c] = corners;
            let normal = (b - a).cross(c - a);
            let seen = if normal.dot(view.eye() - a) < 0.0 {
                -normal
            } else {
                normal
            };
            let share = self.before(view.absolute(a), seen.try_normalize()?)?;
            let texel = (share as f32 - visibility.offset) / visibility.scale;
            Some([texel, 0.0, 0.0, 0.0])
        };
        let target = ColorTargetState {
            blend: Some(BlendState::MIN),
            ..ColorTargetState::OPAQUE
        };
        let draws = draws.shadowed_facets(&label, (FacetValue.stage(), target), &share);
        (!draws.is_empty()).then(|| RenderPass {
            label,
            color: vec![attachment(visibility.texture, LoadOp::Load)],
            depth_stencil: targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws,
        })
    }

    /// The share of the light before the plane through `point` with the unit normal
    /// `normal`; `None` for all of it. World space.
    fn before(&self, point: DVec3, normal: DVec3) -> Option<f64> {
        let height = |p: DVec3| normal.dot(p - point);
        let share = match self {
            Self::Hard(light) if normal.dot(light.towards_from(point)) > 0.0 => 1.0,
            Self::Hard(_) => 0.0,
            Self::Area(AreaLight::Polygon { corners, .. }) => polygon_before(corners, height),
            Self::Area(AreaLight::Disc {
                centre,
                normal: axis,
                radius,
            }) => {
                let cosine = axis.dot(normal);
                let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                disc_before(height(*centre), sine * radius)
            }
            Self::Area(AreaLight::Sphere { .. }) => 1.0,
        };
        (share < 1.0).then_some(share)
    }
}

/// Area of the part of a convex polygon whose points have positive height, over
/// that of the whole.
fn polygon_before(corners: &[DVec3], height: impl Fn(DVec3) -> f64) -> f64 {
    let heights: Vec<f64> = corners.iter().map(|c| height(*c)).collect();
    if heights.iter().all(|h| *h >= 0.0) {
        return 1.0;
    }
    if heights.iter().all(|h| *h <= 0.0) {
        return 0.0;
    }
    let mut part = Vec::with_capacity(corners.len() + 1);
    for k in 0..corners.len() {
        let next = (k + 1) % corners.len();
        let (a, b) = (heights[k], heights[next]);
        if a >= 0.0 {
            part.push(corners[k]);
        }
        if (a >= 0.0) != (b >= 0.0) {
            part.push(corners[k] + (corners[next] - corners[k]) * (a / (a - b)));
        }
    }
    (area_of(&part) / area_of(corners)).clamp(0.0, 1.0)
}

fn area_of(corners: &[DVec3]) -> f64 {
    let Some(&first) = corners.first() else {
        return 0.0;
    };
    let fan = corners.windows(2);
    let twice: DVec3 = fan.map(|e| (e[0] - first).cross(e[1] - first)).sum();
    0.5 * twice.length()
}

/// The share of a disc whose centre has a height, and whose highest point is
/// `reach` above it: a circular segment.
fn disc_before(height: f64, reach: f64) -> f64 {
    if height >= reach {
        return 1.0;
    }
    if height <= -reach {
        return 0.0;
    }
    let x = height / reach;
    let angle = libm::acos(-x);
    (angle + x * (1.0 - x * x).max(0.0).sqrt()) / std::f64::consts::PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_counted_points() {
        let light = |disc: bool| {
            let centre = DVec3::new(0.3, 2.0, -0.2);
            if disc {
                return AreaLight::Disc {
                    centre,
                    normal: DVec3::NEG_Y,
                    radius: 0.7,
                };
            }
            let corner = |x: f64, z: f64| centre + DVec3::new(x, 0.0, z);
            let corners = [(-0.5, -0.7), (0.5, -0.7), (0.5, 0.7), (-0.5, 0.7)];
            AreaLight::polygon(corners.map(|(x, z)| corner(x, z)).to_vec()).unwrap()
        };
        let n = 400;
        let place = |k: usize| (k as f64 + 0.5) / n as f64 * 2.0 - 1.0;
        for disc in [false, true] {
            let light = light(disc);
            let (centre, horizon) = (light.centre(), Horizon::Area(light));
            for tilt in [-1.3, -0.4, 0.0, 0.1, 0.35, 1.1] {
                let normal = DVec3::new(1.0, 0.3 + tilt, tilt * tilt).normalize();
                let point = DVec3::new(0.1, 1.7, 0.1);
                let (mut inside, mut all) = (0, 0);
                for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                    let (x, z) = (place(i), place(j));
                    let on = if disc {
                        (x * x + z * z <= 1.0).then(|| DVec3::new(0.7 * x, 0.0, 0.7 * z))
                    } else {
                        Some(DVec3::new(0.5 * x, 0.0, 0.7 * z))
                    };
                    let Some(on) = on else { continue };
                    all += 1;
                    let p = centre + on;
                    inside += u32::from(normal.dot(p - point) > 0.0);
                }
                let counted = f64::from(inside) / f64::from(all);
                let share = horizon.before(point, normal).unwrap_or(1.0);
                assert!(
                    (share - counted).abs() < 4e-3,
                    "{disc} {tilt}: {share} {counted}"
                );
            }
        }
    }
}
