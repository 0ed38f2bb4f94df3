//! The eye: a look-at camera with an infinite far plane.

use glam::DVec3;

/// A perspective look-at camera. World is right-handed; the eye looks along
/// `target - eye`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Eye point.
    pub eye: DVec3,
    /// Point in the centre of the image; must differ from `eye`.
    pub target: DVec3,
    /// Roughly up; must not be parallel to the line of sight.
    pub up: DVec3,
    /// Vertical field of view, degrees, between 0 and 180.
    pub fov_y_degrees: f64,
    /// Distance of the near plane, above 0.
    pub near: f64,
}

impl Camera {
    /// A camera with y up, 45 degrees vertical field of view and near 0.1 (the
    /// peers' lens).
    pub fn look_at(eye: impl Into<DVec3>, target: impl Into<DVec3>) -> Self {
        Self {
            eye: eye.into(),
            target: target.into(),
            up: DVec3::Y,
            fov_y_degrees: 45.0,
            near: 0.1,
        }
    }

    /// Orthonormal right, up and forward in world space.
    pub fn basis(&self) -> [DVec3; 3] {
        let forward = self.target - self.eye;
        let forward = forward / forward.length();
        let right = forward.cross(self.up);
        let right = right / right.length();
        [right, right.cross(forward), forward]
    }

    /// Tangent of half the vertical field of view.
    pub fn tan_half_fov(&self) -> f64 {
        libm::tan(self.fov_y_degrees.to_radians() / 2.0)
    }

    /// Rows of `view_from_world`: x right, y up, -z forward.
    pub fn view_from_world(&self) -> [[f64; 4]; 4] {
        let [right, up, forward] = self.basis();
        let row = |v: DVec3, w: f64| [v.x, v.y, v.z, w];
        [
            row(right, -right.dot(self.eye)),
            row(up, -up.dot(self.eye)),
            row(-forward, forward.dot(self.eye)),
            [0.0, 0.0, 0.0, 1.0],
        ]
    }

    /// Rows of `clip_from_view` for `aspect` = width / height: depth 0 at the
    /// near plane, 1 at infinity.
    pub fn clip_from_view(&self, aspect: f64) -> [[f64; 4]; 4] {
        let s = 1.0 / self.tan_half_fov();
        [
            [s / aspect, 0.0, 0.0, 0.0],
            [0.0, s, 0.0, 0.0],
            [0.0, 0.0, -1.0, -self.near],
            [0.0, 0.0, -1.0, 0.0],
        ]
    }

    /// Rows of `clip_from_world` (for column vectors), formed in f64 and rounded
    /// to f32 once, bit for bit the peers' `mvp(zero_to_one=True)`.
    pub fn clip_from_world(&self, aspect: f64) -> [[f32; 4]; 4] {
        let rows = product(&self.clip_from_view(aspect), &self.view_from_world());
        rows.map(|row| row.map(|x| x as f32))
    }

    /// Eye rays of an image of `width` by `height` pixels.
    pub fn eye_rays(&self, width: u32, height: u32) -> EyeRays {
        let [right, up, forward] = self.basis();
        let tan = self.tan_half_fov();
        let (width, height) = (f64::from(width), f64::from(height));
        EyeRays {
            origin: self.eye,
            forward,
            right: right * (tan * (width / height)),
            up: up * tan,
            width,
            height,
        }
    }
}

fn product(a: &[[f64; 4]; 4], b: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
    let mut out = [[0.0; 4]; 4];
    for (row, a_row) in out.iter_mut().zip(a) {
        for (column, cell) in row.iter_mut().enumerate() {
            *cell = a_row
                .iter()
                .zip(b)
                .fold(0.0, |sum, (x, b_row)| sum + x * b_row[column]);
        }
    }
    out
}

/// Rays from the eye through points of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeRays {
    /// The eye point, where every ray starts.
    pub origin: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    width: f64,
    height: f64,
}

impl EyeRays {
    /// Direction through image point `(x, y)` in pixels, y down from the top;
    /// the centre of pixel (i, j) is `(i + 0.5, j + 0.5)`. Not normalised: its
    /// component along the line of sight is 1, so a hit's ray parameter is its
    /// planar depth.
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        let across = 2.0 * x / self.width - 1.0;
        let above = 1.0 - 2.0 * y / self.height;
        self.forward + self.right * across + self.up * above
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(camera: Camera) -> [[u32; 4]; 4] {
        camera.clip_from_world(1.0).map(|r| r.map(f32::to_bits))
    }

    /// Bits printed by the peers' `mvp(zero_to_one=True)`.
    #[test]
    fn clip_from_world_has_the_peers_bits() {
        let a = Camera::look_at([0.0, 2.25, 4.25], [0.0, 0.5, 0.0]);
        assert_eq!(
            bits(a),
            [
                [0x401a827a, 0, 0, 0],
                [0, 0x400edf28, 0xbf6b516f, 0xbf8edf28],
                [0, 0xbec2f1a3, 0xbf6cb7b4, 0x4095f860],
                [0, 0xbec2f1a3, 0xbf6cb7b4, 0x40992b93],
            ]
        );
        let b = Camera::look_at([0.0, 3.25, 6.0], [0.0, 1.0, 0.0]);
        assert_eq!(
            bits(b),
            [
                [0x401a827a, 0, 0, 0],
                [0, 0x4010ac02, 0xbf590203, 0xc010ac02],
                [0, 0xbeb3c674, 0xbf6fb345, 0x40d51790],
                [0, 0xbeb3c674, 0xbf6fb345, 0x40d84ac3],
            ]
        );
        let c = Camera::look_at([0.0, 4.0, 6.5], [0.0, 0.5, 0.0]);
        assert_eq!(
            bits(c),
            [
                [0x401a827a, 0, 0, 0],
                [0, 0x40080a92, 0xbf92818a, 0xbf880a92],
                [0, 0xbef2bd36, 0xbf61668e, 0x40f09f6e],
                [0, 0xbef2bd36, 0xbf61668e, 0x40f3d2a1],
            ]
        );
    }

    /// A point on the ray of a pixel centre projects back to that centre.
    #[test]
    fn rays_and_matrix_agree() {
        let camera = Camera {
            up: DVec3::new(0.1, 1.0, 0.2),
            ..Camera::look_at([1.0, 2.0, 5.0], [0.0, 0.5, -1.0])
        };
        let (width, height) = (640u32, 360u32);
        let rays = camera.eye_rays(width, height);
        let clip = camera.clip_from_world(640.0 / 360.0);
        let (x, y) = (123.5, 301.5);
        let p = rays.origin + rays.direction(x, y) * 3.0;
        let at = |r: usize| {
            let row = clip[r].map(f64::from);
            row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3]
        };
        let w = at(3);
        assert!((w - 3.0).abs() < 1e-6);
        assert!(((at(0) / w + 1.0) / 2.0 * f64::from(width) - x).abs() < 1e-3);
        assert!(((1.0 - at(1) / w) / 2.0 * f64::from(height) - y).abs() < 1e-3);
        assert!((at(2) / w - (1.0 - 0.1 / 3.0)).abs() < 1e-6);
    }
}
