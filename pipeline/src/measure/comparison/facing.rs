//! Which surfaces face a light: others are dark whatever is visible from them.

use crate::truth::oracle::surfaces::Surfaces;
use crate::world::light::HardLight;
use crate::world::scene::Scene;

/// Whether the facet under each pixel's centre faces the centre of light number
/// `light`, rows from the top; false where no surface is seen, or no such light is.
pub fn facing(scene: &Scene, light: usize, [width, height]: [u32; 2]) -> Vec<bool> {
    let Some(hard) = scene.lights.get(light).map(|l| l.hard()) else {
        return vec![false; width as usize * height as usize];
    };
    let (surfaces, rays) = (Surfaces::new(scene), scene.camera.eye_rays(width, height));
    let faces = |i: u32| {
        let [x, y] = [i % width, i / width].map(|c| f64::from(c) + 0.5);
        surfaces.hit(&rays, x, y).is_some_and(|hit| {
            let mesh = &scene.objects[hit.object as usize].mesh;
            let [a, b, c] = mesh.corners(hit.triangle as usize);
            let towards = match hard {
                HardLight::Point(p) => p - a,
                HardLight::Directional(towards) => towards,
            };
            (b - a).cross(c - a).dot(towards) > 0.0
        })
    };
    (0..width * height).map(faces).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    /// The floor below the light faces it, and from below nothing of it does.
    #[test]
    fn the_floor_faces_the_light_above_it() {
        let mut scene = builtin::build("parallel-plates").unwrap();
        let floor = scene.objects.remove(0);
        scene.objects = vec![floor];
        let seen = |scene: &Scene| facing(scene, 0, [24, 18]).iter().filter(|f| **f).count();
        assert!(seen(&scene) > 100);
        scene.lights[0].shape = crate::world::light::LightShape::Directional {
            towards: -glam::DVec3::Y,
        };
        assert_eq!(seen(&scene), 0);
        assert_eq!(facing(&scene, 1, [2, 2]), [false; 4]);
    }
}
