//! The camera as shaders have it.
//!
//! # Origin
//!
//! f32 transforms resolve about 2^-22 of the largest coordinate. Where the eye
//! looks at something much nearer than the world's origin is, [`View`] moves
//! the origin next to the eye, by an amount that leaves differences of nearby
//! f32 coordinates exact; scene and volumes move alike. Elsewhere the origin
//! stays, and with it the peers' bits.

use glam::DVec3;
use gnomon_shaders::surface::PixelRays;
use gnomon_shaders::transform::ClipFromWorld;

use crate::world::light::HardLight;
use crate::world::mesh::{narrow, widen};
use crate::world::scene::Camera;

/// The camera's transform, and the origin that it is relative to.
pub struct View {
    /// From world space relative to the origin.
    pub clip_from_world: ClipFromWorld,
    /// In world space; world-space inputs of shaders are relative to it.
    origin: DVec3,
    camera: Camera,
    size: [u32; 2],
}

impl View {
    /// Of `camera` for a picture of that width and height.
    pub fn new(camera: &Camera, [width, height]: [u32; 2]) -> Self {
        let origin = origin(camera);
        let moved = Camera {
            eye: camera.eye - origin,
            target: camera.target - origin,
            ..*camera
        };
        let aspect = f64::from(width) / f64::from(height);
        Self {
            clip_from_world: ClipFromWorld(moved.clip_from_world(aspect)),
            origin,
            camera: *camera,
            size: [width, height],
        }
    }

    /// The camera, world space.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Width and height of the picture.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The eye relative to the origin.
    pub fn eye(&self) -> DVec3 {
        self.relative(self.camera.eye)
    }

    /// Rays through pixels, relative to the origin.
    pub fn pixel_rays(&self) -> PixelRays {
        let [width, height] = self.size;
        let rays = self.camera.eye_rays(width, height);
        let first = rays.direction(0.0, 0.0);
        let across = rays.direction(f64::from(width), 0.0) - first;
        let down = rays.direction(0.0, f64::from(height)) - first;
        PixelRays {
            eye: narrow(self.eye()),
            first: narrow(first),
            right: narrow(across / f64::from(width)),
            down: narrow(down / f64::from(height)),
        }
    }

    /// A world-space position relative to the origin, as shaders have it.
    pub fn relative(&self, p: DVec3) -> DVec3 {
        p - self.origin
    }

    /// A position relative to the origin, in world space.
    pub fn absolute(&self, p: DVec3) -> DVec3 {
        p + self.origin
    }

    /// A world-space position relative to the origin.
    pub fn point(&self, p: [f32; 3]) -> [f32; 3] {
        narrow(widen(p) - self.origin)
    }

    /// The light as a homogeneous point relative to the origin.
    pub fn light(&self, light: HardLight) -> [f32; 4] {
        let ([x, y, z], w) = match light {
            HardLight::Point(p) => (narrow(p - self.origin), 1.0),
            HardLight::Directional(towards) => (narrow(towards), 0.0),
        };
        [x, y, z, w]
    }
}

/// Zero, or the eye rounded to a power of two near the distance it looks at,
/// if the eye is far from zero by that measure.
fn origin(camera: &Camera) -> DVec3 {
    let distance = (camera.target - camera.eye).length();
    if camera.eye.length() < 64.0 * distance {
        return DVec3::ZERO;
    }
    let mut step = 1.0;
    while step > distance {
        step /= 2.0;
    }
    while step * 2.0 <= distance {
        step *= 2.0;
    }
    (camera.eye / step).round() * step
}
