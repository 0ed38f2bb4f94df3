//! Scenes A, B and C of `../shared/peers/`, to the same bits: the tests compare
//! SHA-256 digests with those that `scenes.py` prints.

use glam::DVec3;

use crate::world::light::Light;
use crate::world::mesh::Shading;
use crate::world::scene::{Camera, Material, Object, Scene};
use crate::world::shape::{self, Shape, Terrain};

const RECEIVER: Material = Material::matt([0.8, 0.8, 0.8]);
const CASTER: Material = Material::glossy([0.75, 0.45, 0.3], 0.3, 30.0);

/// Cylinder over a plane.
pub(super) fn a() -> Scene {
    let camera = Camera::look_at([0.0, 2.25, 4.25], [0.0, 0.5, 0.0]);
    let light = DVec3::new(1.5, 4.0, 1.0);
    let caster = shape::cylinder(64, 0.5, 0.5, 1.5);
    scene(
        camera,
        light,
        shape::plane(4.0, 0.0),
        caster,
        Shading::Crease { degrees: 40.0 },
    )
}

/// 27 spheres over a plane.
pub(super) fn b() -> Scene {
    let camera = Camera::look_at([0.0, 3.25, 6.0], [0.0, 1.0, 0.0]);
    let steps = || [-1.0, 0.0, 1.0].into_iter();
    let centres = steps().flat_map(|j| {
        steps().flat_map(move |k| steps().map(move |i| DVec3::new(0.9 * i, 1.5 + 0.9 * j, 0.9 * k)))
    });
    let spheres = centres.map(|c| shape::icosphere(3, 0.3, c));
    let light = DVec3::new(2.5, 6.0, 1.5);
    scene(
        camera,
        light,
        shape::plane(6.0, 0.0),
        Shape::merged(spheres),
        Shading::Smooth,
    )
}

/// Torus knot over a terrain.
pub(super) fn c() -> Scene {
    let camera = Camera::look_at([0.0, 4.0, 6.5], [0.0, 0.5, 0.0]);
    let terrain = Terrain {
        cells: 224,
        half: 6.0,
        frequency: 0.5,
        octaves: 7,
        amplitude: 0.55,
    };
    let knot = shape::torus_knot(2, 3, 1.0, 0.4, 0.18, 512, 24, DVec3::new(0.0, 2.0, 0.0));
    let light = DVec3::new(2.0, 6.0, 1.5);
    scene(
        camera,
        light,
        shape::terrain(terrain),
        knot,
        Shading::Smooth,
    )
}

fn scene(
    camera: Camera,
    light_centre: DVec3,
    receiver: Shape,
    caster: Shape,
    caster_shading: Shading,
) -> Scene {
    let mesh = |shape: Shape, shading| {
        let built = shape.snapped().into_mesh(shading);
        built.expect("the peers' numbers are finite")
    };
    Scene::new(
        camera,
        vec![Light::horizontal_square(light_centre, 1.0)],
        vec![
            Object::new("receiver", mesh(receiver, Shading::Smooth), RECEIVER).receiver_only(),
            Object::new("caster", mesh(caster, caster_shading), CASTER),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::volume::ShadowVolume;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::mesh::Mesh;
    use sha2::{Digest, Sha256};

    /// First 16 hex digits of SHA-256 over vertices, then indices, little endian.
    fn digest<const N: usize>(vertices: &[[f32; N]], triangles: &[[u32; 3]]) -> String {
        let mut hash = Sha256::new();
        vertices
            .iter()
            .flatten()
            .for_each(|x| hash.update(x.to_le_bytes()));
        triangles
            .iter()
            .flatten()
            .for_each(|i| hash.update(i.to_le_bytes()));
        hash.finalize()[..8]
            .iter()
            .map(|b| format!("{b:02x}"))
            .collect()
    }

    fn mesh_digest(mesh: &Mesh) -> String {
        digest(mesh.positions(), mesh.triangles())
    }

    /// Digests and counts as in the table of the peers' README.
    fn check(scene: &Scene, meshes: [&str; 2], volume_digest: &str, counts: [usize; 3]) {
        let [receiver, caster] = [0, 1].map(|i| &*scene.objects[i].mesh);
        assert_eq!([mesh_digest(receiver), mesh_digest(caster)], meshes);
        let adjacency = EdgeAdjacency::new(caster.triangles());
        let volume = ShadowVolume::of_closed(caster, &adjacency, scene.lights[0].hard());
        let parts = [volume.light_cap(), volume.dark_cap(), volume.sides()].map(<[_]>::len);
        assert_eq!(parts, [counts[0], counts[1], 2 * counts[2]]);
        assert_eq!(
            digest(volume.positions(), volume.triangles()),
            volume_digest
        );
    }

    #[test]
    fn scene_a_has_the_peers_digests() {
        let meshes = ["b1a289262c534e98", "8374a4881509c07d"];
        check(&a(), meshes, "68caa94c13cc0577", [116, 140, 66]);
    }

    #[test]
    fn scene_b_has_the_peers_digests() {
        let meshes = ["57142342f7c9cd38", "b996ee2d2e4f0556"];
        check(&b(), meshes, "5c8a62647777e3a1", [16314, 18246, 1474]);
    }

    #[test]
    fn scene_c_has_the_peers_digests() {
        let meshes = ["96a3d775f990a2a6", "977d0c5029a1a09e"];
        check(&c(), meshes, "65dac9fe97386bda", [11852, 12724, 2468]);
    }
}
