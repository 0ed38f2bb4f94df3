//! Planes that receive, and how casters are projected on them.

use glam::DVec3;
use gnomon_shaders::planar_shadows::PlanarShadow;
use gnomon_shaders::transform::ClipFromWorld;

use crate::parts::maps::light_view::Surroundings;
use crate::parts::passes::View;
use crate::world::light::HardLight;
use crate::world::mesh::{Mesh, narrow};
use crate::world::scene::Scene;

/// Off its plane, as a share of its size, a plane's vertex may be by rounding.
const FLAT: f64 = 1e-5;
/// How far off it pixels may be that show it, likewise.
const TOLERANCE: f64 = 1e-4;
/// Nearest to a light, as a share of its height, that casters are looked at.
const NEAR: f64 = 1e-3;

/// A square of a plane with a texture of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Receiver {
    /// Number in the scene.
    pub(super) object: usize,
    /// The square's middle.
    middle: DVec3,
    /// To the right and downwards in the texture, and the normal; orthonormal.
    axes: [DVec3; 3],
    /// Half the square's side.
    half: f64,
    tolerance: f64,
    /// No caster is as high over it.
    highest: f64,
}

/// The planes that the camera sees, and how many other objects receive.
pub(super) fn receivers(scene: &Scene, around: &Surroundings<'_>) -> (Vec<Receiver>, usize) {
    let (mut planes, mut others) = (Vec::new(), 0);
    for (number, object) in scene.objects.iter().enumerate() {
        let seen = around.owned_receivers();
        let seen = seen.filter(|(owner, _)| owner.object == number);
        let corners: Vec<DVec3> = seen.flat_map(|(_, p)| p.iter().copied()).collect();
        if corners.is_empty() {
            continue;
        }
        match plane_of(&object.mesh) {
            Some((axes, size)) => {
                let plane = Receiver::of(number, axes, size, &corners);
                planes.push(plane.below(scene));
            }
            None => others += 1,
        }
    }
    (planes, others)
}

/// The axes of a flat mesh, and its size.
fn plane_of(mesh: &Mesh) -> Option<([DVec3; 3], f64)> {
    let triangles = (0..mesh.triangles().len()).map(|t| mesh.corners(t));
    let normals = triangles.map(|[a, b, c]| (b - a).cross(c - a));
    let normal = normals.fold(DVec3::ZERO, |sum, n| match sum.dot(n) < 0.0 {
        true => sum - n,
        false => sum + n,
    });
    let normal = normal.try_normalize()?;
    let (low, high) = mesh.bounds()?;
    let size = (high - low).length();
    let first = mesh.position(0);
    let count = mesh.positions().len() as u32;
    let flat = (0..count).all(|i| (mesh.position(i) - first).dot(normal).abs() <= FLAT * size);
    let right = normal.any_orthonormal_vector();
    flat.then(|| ([right, normal.cross(right), normal], size))
}

impl Receiver {
    /// The square round what is seen of a plane.
    fn of(object: usize, axes: [DVec3; 3], size: f64, corners: &[DVec3]) -> Self {
        let spans = [0, 1].map(|k| span(corners.iter().map(|p| p.dot(axes[k]))));
        let middle = [0, 1].map(|k| axes[k] * (0.5 * (spans[k][0] + spans[k][1])));
        let height = axes[2] * corners[0].dot(axes[2]);
        let half = spans.map(|[low, high]| 0.5 * (high - low));
        Self {
            object,
            middle: middle[0] + middle[1] + height,
            axes,
            half: half[0].max(half[1]).max(f64::MIN_POSITIVE),
            tolerance: TOLERANCE * size,
            highest: 0.0,
        }
    }

    /// With the height of casters.
    fn below(self, scene: &Scene) -> Self {
        let heights = casters_corners(scene).map(|p| (p - self.middle).dot(self.axes[2]).abs());
        let highest = heights.fold(self.half, f64::max);
        Self {
            highest: 1.01 * highest,
            ..self
        }
    }

    /// The part of it on which shadows can fall; `None` for no part.
    pub(super) fn shadowed(
        &self,
        scene: &Scene,
        points: &[HardLight],
        texels: u32,
    ) -> Option<Self> {
        let mut places = Vec::new();
        for corner in casters_corners(scene) {
            for point in points {
                // Beside or beyond the light a shadow has no end.
                let Some(place) = self.projected(point, corner) else {
                    return Some(*self);
                };
                places.push(place);
            }
        }
        self.part(&places, texels)
    }

    /// The part of the square round `places`, with a texel to spare.
    fn part(&self, places: &[[f64; 2]], texels: u32) -> Option<Self> {
        let free = 1.0 + 4.0 / f64::from(texels);
        let spans = [0, 1].map(|k| {
            let [low, high] = span(places.iter().map(|p| p[k]));
            [low.max(-self.half), high.min(self.half)]
        });
        if spans.iter().any(|[low, high]| low >= high) {
            return None;
        }
        let middle = spans.map(|[low, high]| 0.5 * (low + high));
        let half = spans.map(|[low, high]| 0.5 * (high - low) * free);
        Some(Self {
            middle: self.middle + self.axes[0] * middle[0] + self.axes[1] * middle[1],
            half: half[0].max(half[1]),
            ..*self
        })
    }

    /// Where the shadow of `p` falls, from the middle.
    fn projected(&self, light: &HardLight, p: DVec3) -> Option<[f64; 2]> {
        let from = p - self.middle;
        let [right, down, normal] = self.axes;
        let at = match light {
            HardLight::Point(l) => {
                let l = *l - self.middle;
                let (height, over) = (l.dot(normal), from.dot(normal));
                let share = (height - over) / height;
                if share.is_nan() || share <= NEAR {
                    return None;
                }
                l + (from - l) / share
            }
            HardLight::Directional(towards) => {
                let along = from.dot(normal) / towards.dot(normal);
                from - *towards * along
            }
        };
        let place = [at.dot(right), at.dot(down)];
        place.iter().all(|c| c.is_finite()).then_some(place)
    }

    /// The projection of casters from a point of the light; `None` where it is in the
    /// plane. Depth is 1 on the plane, and less towards the light.
    pub(super) fn projection(&self, light: &HardLight, view: &View) -> Option<ClipFromWorld> {
        let [right, down, normal] = self.axes;
        let rows = match light {
            HardLight::Point(l) => {
                let height = (*l - self.middle).dot(normal);
                // From the light to the plane.
                let (along, height) = (normal * -height.signum(), height.abs());
                if height.is_nan() || height <= f64::MIN_POSITIVE {
                    return None;
                }
                let near = height * NEAR;
                let depth = along * (height / (height - near));
                let row = |axis: DVec3, sign: f64| {
                    let beside = (*l - self.middle).dot(axis);
                    (axis * height + along * beside) * (sign / self.half)
                };
                let w = (along, -along.dot(*l));
                let about = |axis: DVec3| (axis, -axis.dot(*l));
                [
                    about(row(right, 1.0)),
                    about(row(down, -1.0)),
                    (depth, -depth.dot(*l) - near * height / (height - near)),
                    w,
                ]
            }
            HardLight::Directional(towards) => {
                let slope = towards.dot(normal);
                if slope.is_nan() || slope.abs() <= f64::MIN_POSITIVE {
                    return None;
                }
                let row = |axis: DVec3, sign: f64| {
                    let row = (axis - normal * (towards.dot(axis) / slope)) * (sign / self.half);
                    (row, -row.dot(self.middle))
                };
                let up = normal * (slope.signum() / self.highest);
                [
                    row(right, 1.0),
                    row(down, -1.0),
                    (-up, up.dot(self.middle) + 1.0),
                    (DVec3::ZERO, 1.0),
                ]
            }
        };
        // Rows are of world space; positions are relative to the view's origin.
        let origin = view.absolute(DVec3::ZERO);
        Some(ClipFromWorld(rows.map(|(row, offset)| {
            let [x, y, z] = row.to_array();
            [x, y, z, offset + row.dot(origin)].map(|c| c as f32)
        })))
    }

    /// Looks counts up in a texture of `size` texels a side.
    pub(super) fn look_up(&self, view: &View, size: u32, points: usize) -> PlanarShadow {
        let [right, down, normal] = self.axes;
        let corner = self.middle - (right + down) * self.half;
        let texels = f64::from(size) / (2.0 * self.half);
        PlanarShadow {
            origin: narrow(view.relative(corner)),
            normal: narrow(normal),
            tolerance: self.tolerance as f32,
            axes: [right, down].map(|axis| narrow(axis * texels)),
            size,
            points: points as u32,
        }
    }

    /// Width of a texel.
    pub(super) fn texel(&self, size: u32) -> f64 {
        2.0 * self.half / f64::from(size)
    }
}

/// Corners of the boxes round all casters.
fn casters_corners(scene: &Scene) -> impl Iterator<Item = DVec3> {
    let casters = scene.objects.iter().filter(|o| o.casts);
    let boxes = casters.filter_map(|o| o.mesh.bounds());
    boxes.flat_map(|(low, high)| {
        (0..8).map(move |corner| {
            let side = |k: usize| {
                if corner >> k & 1 == 0 {
                    low[k]
                } else {
                    high[k]
                }
            };
            DVec3::new(side(0), side(1), side(2))
        })
    })
}

fn span(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let empty = [f64::INFINITY, f64::NEG_INFINITY];
    values.fold(empty, |[low, high], v| [low.min(v), high.max(v)])
}
