//! Where shadow volumes are, decided conservatively with separating planes.
//!
//! Both questions are about convex sets of homogeneous points: `(p, 1)` is a
//! point, `(v, 0)` a direction. A plane with all of one set on its inner side
//! and all of another strictly beyond separates them. Only some planes are
//! tried, so "may touch" can be wrong, "does not" cannot.

use glam::{DVec3, DVec4};

use crate::world::light::HardLight;
use crate::world::mesh::Mesh;
use crate::world::scene::Camera;

/// Distance from a plane, relative to the coordinates' size, that counts as
/// strictly beyond: far above what f32 vertices and snapping can move.
const MARGIN: f64 = 1e-5;

/// The hull of the eye, the near rectangle and the light: what a caster must
/// touch for its shadow to fall on the beginning of the view.
pub(crate) struct NearPyramid {
    points: Vec<DVec4>,
    /// Planes with all points on the negative side.
    faces: Vec<DVec4>,
    scale: f64,
}

impl NearPyramid {
    pub(crate) fn new(camera: &Camera, size: [u32; 2], light: HardLight) -> Self {
        let mut points = before_near(camera, size);
        points.push(homogeneous(light));
        Self::hull(camera, points)
    }

    /// The hull of the eye and the near rectangle alone: what a caster must touch
    /// to be seen cut open.
    pub(crate) fn before_near_plane(camera: &Camera, size: [u32; 2]) -> Self {
        Self::hull(camera, before_near(camera, size))
    }

    fn hull(camera: &Camera, points: Vec<DVec4>) -> Self {
        let extent = |p: &DVec4| (p.truncate() - camera.eye * p.w).length();
        let scale =
            points.iter().map(extent).fold(camera.near, f64::max) + camera.eye.length() * 1e-6;
        let faces = faces(&points);
        Self {
            points,
            faces,
            scale,
        }
    }

    /// Whether some triangle of the mesh may reach into the pyramid.
    pub(crate) fn may_touch(&self, mesh: &Mesh) -> bool {
        let bounds = box_corners(mesh);
        if self.is_beyond_a_face(&bounds) {
            return false;
        }
        (0..mesh.triangles().len()).any(|t| self.may_touch_triangle(mesh.corners(t)))
    }

    /// Whether the triangle may reach into the pyramid.
    pub(crate) fn may_touch_triangle(&self, corners: [DVec3; 3]) -> bool {
        let [a, b, c] = corners.map(|p| p.extend(1.0));
        !self.is_beyond_a_face(&[a, b, c])
            && !plane(a, b, c).is_some_and(|p| self.is_on_one_side_of(p))
    }

    fn is_beyond_a_face(&self, set: &[DVec4]) -> bool {
        let margin = MARGIN * self.scale;
        self.faces
            .iter()
            .any(|f| set.iter().all(|p| f.dot(*p) > margin))
    }

    fn is_on_one_side_of(&self, plane: DVec4) -> bool {
        let margin = |p: &DVec4| {
            MARGIN
                * if p.w == 0.0 {
                    p.truncate().length()
                } else {
                    self.scale
                }
        };
        let mut sides = self.points.iter().map(|p| (plane.dot(*p), margin(p)));
        sides.clone().all(|(d, m)| d > m) || sides.all(|(d, m)| d < -m)
    }
}

/// Whether the volume of `mesh`, caster included, is strictly outside the
/// view: beyond one of the planes through the eye and a side of the image, or
/// behind the eye.
pub(crate) fn outside_view(camera: &Camera, size: [u32; 2], mesh: &Mesh, light: HardLight) -> bool {
    let [a, b, c, d] = corner_rays(camera, size);
    let [_, _, forward] = camera.basis();
    // Outward normals; corners run counter-clockwise seen from the eye.
    let normals = [a.cross(b), b.cross(c), c.cross(d), d.cross(a), -forward];
    let corners = box_corners(mesh);
    normals.iter().any(|n| {
        let n = n.normalize();
        let beyond = |v: DVec3| n.dot(v) > MARGIN * v.length();
        corners.iter().all(|p| {
            let p = p.truncate();
            beyond(p - camera.eye) && beyond(light.shadow_direction(p))
        })
    })
}

/// The eye and the corners of the near rectangle.
fn before_near(camera: &Camera, size: [u32; 2]) -> Vec<DVec4> {
    let corners = corner_rays(camera, size).map(|ray| camera.eye + ray * camera.near);
    let all = [camera.eye].into_iter().chain(corners);
    all.map(|p| p.extend(1.0)).collect()
}

fn homogeneous(light: HardLight) -> DVec4 {
    match light {
        HardLight::Point(p) => p.extend(1.0),
        HardLight::Directional(towards) => towards.extend(0.0),
    }
}

/// Eye rays through the image's corners, counter-clockwise seen from the eye.
fn corner_rays(camera: &Camera, [width, height]: [u32; 2]) -> [DVec3; 4] {
    let rays = camera.eye_rays(width, height);
    let (w, h) = (f64::from(width), f64::from(height));
    [(0.0, h), (w, h), (w, 0.0), (0.0, 0.0)].map(|(x, y)| rays.direction(x, y))
}

fn box_corners(mesh: &Mesh) -> Vec<DVec4> {
    let Some((low, high)) = mesh.bounds() else {
        return Vec::new();
    };
    let pick = |k: u32, bit: u32, a: f64, b: f64| if k >> bit & 1 == 0 { a } else { b };
    (0..8)
        .map(|k| {
            DVec4::new(
                pick(k, 0, low.x, high.x),
                pick(k, 1, low.y, high.y),
                pick(k, 2, low.z, high.z),
                1.0,
            )
        })
        .collect()
}

/// The plane through three homogeneous points as `(unit normal, -offset)`;
/// `None` where they have none.
fn plane(a: DVec4, b: DVec4, c: DVec4) -> Option<DVec4> {
    // At least one is a point; move it to the front.
    let (a, b, c) = if a.w != 0.0 { (a, b, c) } else { (b, c, a) };
    let from_a = |p: DVec4| p.truncate() - a.truncate() * p.w;
    let (u, v) = (from_a(b), from_a(c));
    let normal = u.cross(v);
    let length = normal.length();
    if length <= 1e-12 * u.length() * v.length() {
        return None;
    }
    let normal = normal / length;
    Some(normal.extend(-normal.dot(a.truncate())))
}

/// Planes through three of the points that have all others on one side, turned
/// so that this is the negative one.
fn faces(points: &[DVec4]) -> Vec<DVec4> {
    let n = points.len();
    let triples =
        (0..n).flat_map(|i| (i + 1..n).flat_map(move |j| (j + 1..n).map(move |k| [i, j, k])));
    let mut faces = Vec::new();
    for [i, j, k] in triples {
        let Some(plane) = plane(points[i], points[j], points[k]) else {
            continue;
        };
        let others = (0..n).filter(|m| ![i, j, k].contains(m));
        let sides: Vec<f64> = others.map(|m| plane.dot(points[m])).collect();
        // Rounding may put coplanar points a hair outside; MARGIN covers it.
        let hair = 1e-9
            * points
                .iter()
                .map(|p| p.truncate().length())
                .fold(0.0, f64::max);
        if sides.iter().all(|&s| s <= hair) {
            faces.push(plane);
        }
        if sides.iter().all(|&s| s >= -hair) {
            faces.push(-plane);
        }
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::mesh::Shading;
    use crate::world::scene::builtin;
    use crate::world::shape;

    fn touches(name: &str) -> Vec<(String, bool)> {
        let scene = builtin::build(name).unwrap();
        let pyramid = NearPyramid::new(&scene.camera, [64, 64], scene.lights[0].hard());
        scene
            .casters()
            .map(|o| (o.name.clone(), pyramid.may_touch(&o.mesh)))
            .collect()
    }

    #[test]
    fn only_casters_between_near_rectangle_and_light_touch() {
        let only = |name: &str, expected: &str| {
            for (caster, touched) in touches(name) {
                assert_eq!(touched, caster == expected, "{name}: {caster}");
            }
        };
        only("adversarial-eye-in-shadow", "roof");
        only("adversarial-near-plane", "knife edge");
        for name in [
            "peer-a",
            "peer-b",
            "peer-c",
            "demo",
            "columns",
            "adversarial-offset",
            "adversarial-tiny",
        ] {
            only(name, "none");
        }
    }

    #[test]
    fn directional_light_makes_a_prism() {
        let camera = Camera::look_at([0.0, 1.0, 5.0], [0.0, 1.0, 0.0]);
        let pyramid = NearPyramid::new(
            &camera,
            [64, 64],
            HardLight::Directional(DVec3::new(0.0, 1.0, 0.2)),
        );
        let at = |y: f64, z: f64| {
            let cube = shape::cuboid(DVec3::new(0.0, y, z), DVec3::splat(0.5))
                .into_mesh(Shading::Flat)
                .unwrap();
            pyramid.may_touch(&cube)
        };
        assert!(at(6.0, 6.0) && at(1001.0, 205.0) && at(1.0, 5.0));
        assert!(!at(6.0, 4.0) && !at(-4.0, 4.0) && !at(6.0, 8.0));
    }

    #[test]
    fn volumes_beside_the_view_are_outside() {
        let camera = Camera::look_at([0.0, 1.0, 5.0], [0.0, 1.0, 0.0]);
        let light = HardLight::Point(DVec3::new(0.0, 8.0, 0.0));
        let at = |x: f64, z: f64| {
            let ball = shape::icosphere(1, 0.5, DVec3::new(x, 1.0, z))
                .into_mesh(Shading::Flat)
                .unwrap();
            outside_view(&camera, [64, 64], &ball, light)
        };
        assert!(!at(0.0, 0.0), "in view");
        assert!(at(20.0, 0.0) && at(-20.0, 0.0), "beside, leaning away");
        assert!(at(0.0, 30.0), "behind the eye");
        // Behind the eye but with the light further back: falls into view.
        let back = HardLight::Point(DVec3::new(0.0, 1.5, 40.0));
        let ball = shape::icosphere(1, 0.5, DVec3::new(0.0, 1.0, 30.0))
            .into_mesh(Shading::Flat)
            .unwrap();
        assert!(!outside_view(&camera, [64, 64], &ball, back));
    }
}
