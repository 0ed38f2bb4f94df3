//! Sides of shadow volumes, one per silhouette edge.

use glam::DVec3;
use gnomon_pipeline::geometry::caster::Caster;
use gnomon_pipeline::geometry::volume::ShadowVolume;
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::world::light::HardLight;
use gnomon_pipeline::world::scene::Scene;

/// The side of a volume behind one silhouette edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// The edge; seen from the light, the caster is on its left.
    pub(super) edge: [[f32; 4]; 2],
    /// Corners in order; the last one (parallel light) or two are at infinity.
    corners: [[f32; 4]; 4],
    used: usize,
    /// Whether it shows its outside to the eye.
    pub(super) front: bool,
}

impl Side {
    /// Homogeneous world-space corners.
    pub(super) fn corners(&self) -> &[[f32; 4]] {
        &self.corners[..self.used]
    }
}

/// Sides of all casters for the lights that shine.
pub(super) fn of(scene: &Scene, params: &Params) -> Vec<Side> {
    let mut sides = Vec::new();
    for light in lights(scene, params) {
        for object in scene.casters() {
            let volume = Caster::new(&object.mesh).volume(&object.mesh, light);
            add(&mut sides, &volume, light, scene.camera.eye);
        }
    }
    sides
}

fn lights(scene: &Scene, params: &Params) -> Vec<HardLight> {
    let all = scene.lights.iter().map(|l| l.hard());
    let one = params.text("light").map(str::parse::<usize>);
    match one {
        Some(Ok(one)) => all.skip(one).take(1).collect(),
        _ => all.collect(),
    }
}

fn add(sides: &mut Vec<Side>, volume: &ShadowVolume, light: HardLight, eye: DVec3) {
    let triangles_per_side = if light.is_directional() { 1 } else { 2 };
    let at = |i: u32| volume.positions()[i as usize];
    for triangles in volume.sides().chunks_exact(triangles_per_side) {
        let [b, a, a_far] = triangles[0].map(at);
        let b_far = triangles.last().map_or(a_far, |t| at(t[2]));
        sides.push(Side {
            edge: [a, b],
            corners: [b, a, a_far, b_far],
            used: 2 + triangles_per_side,
            front: faces(b, a, a_far, eye),
        });
    }
}

/// Whether `eye` is on the outer side of the triangle of two points and a direction.
fn faces(b: [f32; 4], a: [f32; 4], far: [f32; 4], eye: DVec3) -> bool {
    let wide = |p: [f32; 4]| DVec3::new(p[0].into(), p[1].into(), p[2].into());
    let normal = (wide(a) - wide(b)).cross(wide(far));
    normal.dot(eye - wide(b)) > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use gnomon_pipeline::techniques::find;
    use gnomon_pipeline::world::scene::builtin;

    #[test]
    fn a_volume_has_front_and_back_sides() {
        let scene = builtin::build("peer-a").unwrap();
        let params = Params::defaults(find("shadow-volumes").unwrap());
        let sides = of(&scene, &params);
        assert_eq!(sides.len(), 66);
        let front = sides.iter().filter(|s| s.front).count();
        assert!(front > 5 && front < 61, "{front}");
    }
}
