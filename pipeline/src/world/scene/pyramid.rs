//! What a camera sees, as planes.

use glam::DVec3;

use super::Camera;
use crate::world::mesh::Mesh;

/// Keeps of a convex polygon where `side` is not negative; `side` must be affine.
/// `scratch` is overwritten.
pub(crate) fn clip(
    polygon: &mut Vec<DVec3>,
    scratch: &mut Vec<DVec3>,
    side: impl Fn(DVec3) -> f64,
) {
    clip_with(polygon, scratch, side, |a, b, share| a + (b - a) * share);
}

/// The same of vertices that are more than positions: `between` gives what is that share
/// of the way from one to another.
pub(crate) fn clip_with<V: Copy>(
    polygon: &mut Vec<V>,
    scratch: &mut Vec<V>,
    side: impl Fn(V) -> f64,
    between: impl Fn(V, V, f64) -> V,
) {
    scratch.clear();
    for (k, &b) in polygon.iter().enumerate() {
        let a = polygon[(k + polygon.len() - 1) % polygon.len()];
        let (from, to) = (side(a), side(b));
        if (from < 0.0) != (to < 0.0) {
            scratch.push(between(a, b, from / (from - to)));
        }
        if to >= 0.0 {
            scratch.push(b);
        }
    }
    std::mem::swap(polygon, scratch);
}

/// What a camera sees: beyond its near plane, and between four sides.
pub(crate) struct Pyramid {
    eye: DVec3,
    near: f64,
    forward: DVec3,
    /// Normals of the sides, inwards.
    sides: [DVec3; 4],
}

impl Pyramid {
    /// In a picture of that width and height.
    pub(crate) fn new(camera: &Camera, [width, height]: [u32; 2]) -> Self {
        let [right, up, forward] = camera.basis();
        let tan = camera.tan_half_fov();
        let across = forward * (tan * f64::from(width) / f64::from(height));
        let above = forward * tan;
        Self {
            eye: camera.eye,
            near: camera.near,
            forward,
            sides: [across + right, across - right, above + up, above - up],
        }
    }

    /// In a picture that is `factor` times as wide and as high, and from half the near
    /// distance on.
    pub(crate) fn wider(camera: &Camera, size: [u32; 2], factor: f64) -> Self {
        let seen = Self::new(camera, size);
        let sides = seen
            .sides
            .map(|s| s + seen.forward * (s.dot(seen.forward) * (factor - 1.0)));
        Self {
            near: camera.near * 0.5,
            sides,
            ..seen
        }
    }

    /// Its planes, as functions that are not negative inside.
    pub(crate) fn sides(&self) -> [impl Fn(DVec3) -> f64; 5] {
        let off = |normal: DVec3, least: f64| move |p: DVec3| normal.dot(p - self.eye) - least;
        let [a, b, c, d] = self.sides;
        [
            off(self.forward, self.near),
            off(a, 0.0),
            off(b, 0.0),
            off(c, 0.0),
            off(d, 0.0),
        ]
    }

    /// The same from the eye on.
    pub(crate) fn up_to_eye(self) -> Self {
        Self { near: 0.0, ..self }
    }

    /// Planar distance from the eye.
    pub(crate) fn depth(&self, p: DVec3) -> f64 {
        self.forward.dot(p - self.eye)
    }

    /// Keeps what of a convex polygon is seen.
    pub(crate) fn clip(&self, polygon: &mut Vec<DVec3>, scratch: &mut Vec<DVec3>) {
        for side in self.sides() {
            if polygon.is_empty() {
                return;
            }
            clip(polygon, scratch, side);
        }
    }

    /// Least and largest planar distance from the eye of what of a mesh is seen; `None`
    /// where nothing is. Only triangles that a plane crosses are clipped.
    pub(crate) fn depths(&self, mesh: &Mesh) -> Option<[f64; 2]> {
        let vertices = (0..mesh.positions().len() as u32).map(|i| self.outcode(mesh.position(i)));
        let codes: Vec<u8> = vertices.collect();
        let (mut polygon, mut scratch) = (Vec::new(), Vec::new());
        let (mut nearest, mut farthest) = (f64::INFINITY, f64::NEG_INFINITY);
        for (t, corners) in mesh.triangles().iter().enumerate() {
            let [a, b, c] = corners.map(|i| codes[i as usize]);
            if a & b & c != 0 {
                continue;
            }
            polygon.clear();
            polygon.extend(mesh.corners(t));
            if a | b | c != 0 {
                self.clip(&mut polygon, &mut scratch);
            }
            for p in &polygon {
                let depth = self.depth(*p);
                nearest = nearest.min(depth);
                farthest = farthest.max(depth);
            }
        }
        (nearest <= farthest).then_some([nearest, farthest])
    }

    /// Bit k: the point is outside of plane k.
    fn outcode(&self, p: DVec3) -> u8 {
        let outside = self.sides().map(|side| side(p) < 0.0);
        (0..5).map(|k| u8::from(outside[k]) << k).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    /// The same as clipping each triangle, whether planes cross it or not.
    #[test]
    fn depths_are_those_of_clipped_triangles() {
        let mut crossed = 0;
        for entry in builtin::SCENES {
            let scene = entry.build();
            let seen = Pyramid::new(&scene.camera, [160, 120]);
            for object in &scene.objects {
                let (mut all, mut scratch) = (Vec::new(), Vec::new());
                for t in 0..object.mesh.triangles().len() {
                    let mut polygon = object.mesh.corners(t).to_vec();
                    seen.clip(&mut polygon, &mut scratch);
                    crossed += usize::from(polygon.len() > 3);
                    all.extend(polygon.iter().map(|p| seen.depth(*p)));
                }
                let least = all.iter().copied().reduce(f64::min);
                let most = all.iter().copied().reduce(f64::max);
                let expected = least.zip(most).map(|(a, b)| [a, b]);
                assert_eq!(seen.depths(&object.mesh), expected, "{}", entry.name);
            }
        }
        assert!(crossed > 100, "{crossed}");
    }

    #[test]
    fn clipping_keeps_what_is_on_the_side() {
        let mut square = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        clip(&mut square, &mut Vec::new(), |p| p.x - 0.25);
        let area = (1..square.len() - 1)
            .map(|k| {
                (square[k] - square[0])
                    .cross(square[k + 1] - square[0])
                    .length()
                    / 2.0
            })
            .sum::<f64>();
        assert!((area - 0.75).abs() < 1e-12);
        clip(&mut square, &mut Vec::new(), |p| p.x - 2.0);
        assert!(square.is_empty());
    }
}
