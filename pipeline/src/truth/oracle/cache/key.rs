//! The hash that names an oracle image.

use glam::DVec3;

use crate::truth::oracle::area::ORACLE_VERSION;
use crate::truth::oracle::sampled::SAMPLED_VERSION;
use crate::world::light::LightShape;
use crate::world::light_image::LightImage;
use crate::world::scene::Scene;

/// Hash of everything that decides an oracle image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Key(pub(super) [u8; 32]);

impl Key {
    pub(super) fn of(scene: &Scene, light: &LightShape, size: [u32; 2]) -> Self {
        let mut hasher = Hasher(blake3::Hasher::new());
        hasher.integers([ORACLE_VERSION, size[0], size[1], scene.objects.len() as u32]);
        for object in &scene.objects {
            let (positions, triangles) = (object.mesh.positions(), object.mesh.triangles());
            let counts = [positions.len() as u32, triangles.len() as u32];
            hasher.integers([u32::from(object.casts)].into_iter().chain(counts));
            hasher.integers(positions.iter().flatten().map(|c| c.to_bits()));
            hasher.integers(triangles.iter().flatten().copied());
        }
        let camera = &scene.camera;
        hasher.points(&[camera.eye, camera.target, camera.up]);
        hasher.numbers(&[camera.fov_y_degrees, camera.near]);
        hasher.light(light);
        Self(*hasher.0.finalize().as_bytes())
    }

    /// The same for shadow rays: `side * side` to a pixel, jittered by `seed`.
    pub(super) fn of_rays(
        scene: &Scene,
        light: &LightShape,
        size: [u32; 2],
        (side, seed): (u32, u64),
    ) -> Self {
        let mut hasher = Hasher(blake3::Hasher::new());
        hasher.0.update(b"rays");
        hasher.0.update(&Self::of(scene, light, size).0);
        hasher.integers([SAMPLED_VERSION, side, seed as u32, (seed >> 32) as u32]);
        Self(*hasher.0.finalize().as_bytes())
    }

    /// The same for one colour of an image on the light.
    pub(super) fn of_light_image(
        scene: &Scene,
        light: &LightShape,
        size: [u32; 2],
        (image, colour): (&LightImage, usize),
    ) -> Self {
        let mut hasher = Hasher(blake3::Hasher::new());
        hasher.0.update(b"light image");
        hasher.0.update(&Self::of(scene, light, size).0);
        hasher.integers([image.side() as u32, colour as u32]);
        image.cells().iter().for_each(|cell| hasher.numbers(cell));
        Self(*hasher.0.finalize().as_bytes())
    }

    pub(super) fn file_name(&self) -> String {
        format!("{}.gnomvis", blake3::Hash::from_bytes(self.0).to_hex())
    }
}

/// Feeds numbers by their bits.
struct Hasher(blake3::Hasher);

impl Hasher {
    fn integers(&mut self, values: impl IntoIterator<Item = u32>) {
        let bytes: Vec<u8> = values.into_iter().flat_map(u32::to_le_bytes).collect();
        self.0.update(&bytes);
    }

    fn numbers(&mut self, values: &[f64]) {
        for value in values {
            self.0.update(&value.to_bits().to_le_bytes());
        }
    }

    fn points(&mut self, points: &[DVec3]) {
        points.iter().for_each(|p| self.numbers(&p.to_array()));
    }

    /// A number for the kind of shape, then its data.
    fn light(&mut self, light: &LightShape) {
        match light {
            LightShape::Point { position } => {
                self.integers([0]);
                self.points(&[*position]);
            }
            LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            } => {
                self.integers([1]);
                self.points(&[*centre, *edge_u, *edge_v]);
            }
            LightShape::Polygon(polygon) => {
                self.integers([2, polygon.vertices().len() as u32]);
                self.points(polygon.vertices());
            }
            LightShape::Disc {
                centre,
                normal,
                radius,
            } => {
                self.integers([3]);
                self.points(&[*centre, *normal]);
                self.numbers(&[*radius]);
            }
            LightShape::Sphere { centre, radius } => {
                self.integers([4]);
                self.points(&[*centre]);
                self.numbers(&[*radius]);
            }
            LightShape::Directional { towards } => {
                self.integers([5]);
                self.points(&[*towards]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    const SIZE: [u32; 2] = [24, 16];

    fn scene() -> Scene {
        builtin::build("peer-a").unwrap()
    }

    /// Whatever changes the image changes the key; names and colours do not.
    #[test]
    fn the_key_depends_on_what_is_seen_and_on_nothing_else() {
        type Change = fn(&mut Scene);
        let light = |s: &mut Scene, shape| s.lights[0].shape = shape;
        let key = |change: &dyn Fn(&mut Scene)| {
            let mut changed = scene();
            change(&mut changed);
            Key::of(&changed, &changed.lights[0].shape, SIZE)
        };
        let plain = key(&|_| {});
        let seen: [Change; 6] = [
            |s| s.camera.near = 0.11,
            |s| s.camera.eye.x = 1e-300,
            |s| s.objects[1].casts = false,
            |s| s.objects.swap(0, 1),
            |s| s.objects[1].mesh = s.objects[0].mesh.clone(),
            |s| s.objects.truncate(1),
        ];
        let mut keys: Vec<Key> = seen.iter().map(|c| key(c)).collect();
        let centre = DVec3::new(1.5, 4.0, 1.0);
        let (normal, radius) = (DVec3::Y, 0.5);
        for shape in [
            LightShape::Point { position: centre },
            LightShape::Directional { towards: centre },
            LightShape::Sphere { centre, radius },
            LightShape::Disc {
                centre,
                normal,
                radius,
            },
        ] {
            keys.push(key(&|s| light(s, shape.clone())));
        }
        keys.push(Key::of(&scene(), &scene().lights[0].shape, [16, 24]));
        for rays in [(8, 1), (9, 1), (8, 2), (8, 1 << 32)] {
            keys.push(Key::of_rays(&scene(), &scene().lights[0].shape, SIZE, rays));
        }
        keys.push(plain.clone());
        let mut names: Vec<String> = keys.iter().map(Key::file_name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), keys.len());
        let unseen: [Change; 3] = [
            |s| s.name = "another".into(),
            |s| s.lights[0].colour = [0.1, 0.2, 0.3],
            |s| s.objects[0].material.albedo = [0.0; 3],
        ];
        assert!(unseen.iter().all(|c| key(c) == plain));
    }
}
