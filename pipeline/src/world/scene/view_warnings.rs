//! What a camera cannot show of its scene: objects before its near plane, and
//! casters that a depth buffer cannot tell from what is behind them.

use super::{Object, Pyramid, Scene, SceneWarning};
use crate::world::warning::first_few;

/// Largest step of depth over the size of a caster there.
const COARSEST: f64 = 1.0 / 32.0;
/// Steps between 0 and 1 of a 24-bit depth buffer, and of 32-bit floats near 1,
/// where all but the nearest surfaces are.
const STEPS: f64 = 16_777_216.0;
/// Most objects that are named.
const NAMED: usize = 3;

impl Scene {
    /// Warnings about the camera, in a picture of `size` (width, height).
    pub(crate) fn view_warnings(&self, size: [u32; 2]) -> Vec<SceneWarning> {
        let pyramid = Pyramid::new(&self.camera, size).up_to_eye();
        let depths: Vec<_> = self
            .objects
            .iter()
            .map(|o| pyramid.depths(&o.mesh))
            .collect();
        let hidden = self.before_near_plane(&depths);
        let coarse = self.coarse_depth(&depths);
        hidden.into_iter().chain(coarse).collect()
    }

    /// Objects of which nothing is beyond the near plane, though the eye looks at
    /// them.
    fn before_near_plane(&self, depths: &[Option<[f64; 2]>]) -> Option<SceneWarning> {
        let near = self.camera.near;
        let objects = self.objects.iter().zip(depths);
        let hidden = objects.filter_map(|(o, d)| d.filter(|[_, far]| *far <= near).map(|d| (o, d)));
        let (names, nearest) = hidden.fold(
            (Vec::new(), f64::INFINITY),
            |(mut names, least), (object, [nearest, _])| {
                names.push(format!("'{}'", object.name));
                (names, least.min(nearest))
            },
        );
        (!names.is_empty()).then(|| SceneWarning {
            code: "before-near-plane",
            count: names.len(),
            message: format!(
                "objects lie wholly before the camera's near plane at {near} and are not drawn: \
                 {}; they begin {nearest:.3e} from the eye: set near to less, or leave it out",
                first_few(&names, NAMED)
            ),
        })
    }

    /// Casters of whose size a step of depth is too large a share.
    fn coarse_depth(&self, depths: &[Option<[f64; 2]>]) -> Option<SceneWarning> {
        let near = self.camera.near;
        let objects = self.objects.iter().zip(depths).filter(|(o, _)| o.casts);
        let coarse = objects.filter_map(|(object, depths)| {
            let depth = depths.filter(|[_, far]| *far > near)?[0].max(near);
            let step = depth * depth / (near * STEPS);
            // What an animation has shrunk to a point hides nothing.
            let size = size(object).filter(|size| *size > 0.0)?;
            (step > COARSEST * size).then_some((object, depth, step, size))
        });
        let coarse: Vec<_> = coarse.collect();
        let ratio = |c: &(&Object, f64, f64, f64)| c.2 / c.3;
        let worst = coarse.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
        let (object, depth, step, size) = worst;
        Some(SceneWarning {
            code: "coarse-depth",
            count: coarse.len(),
            message: format!(
                "casters are hardly larger than a step of depth, so that shadows and outlines are \
                 wrong: '{}' is {size:.3e} large and {depth:.3e} away, where a depth buffer with \
                 near = {near} has steps of {step:.3e}; set near to {:.0e} or more, or leave it out",
                object.name,
                near * step / (COARSEST * size),
            ),
        })
    }
}

/// Largest extent of an object.
fn size(object: &Object) -> Option<f64> {
    let (low, high) = object.mesh.bounds()?;
    Some((high - low).max_element())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::mesh::Shading;
    use crate::world::scene::builtin;
    use crate::world::shape::Shape;

    const SIZE: [u32; 2] = [160, 120];

    fn codes(scene: &Scene) -> Vec<&'static str> {
        scene.view_warnings(SIZE).iter().map(|w| w.code).collect()
    }

    #[test]
    fn built_in_scenes_are_seen_well() {
        for entry in builtin::SCENES {
            assert_eq!(codes(&entry.build()), [""; 0], "{}", entry.name);
        }
    }

    #[test]
    fn what_lies_before_the_near_plane_is_named() {
        let mut scene = builtin::build("demo").unwrap();
        scene.camera.near = 1e3;
        let warnings = scene.view_warnings(SIZE);
        assert_eq!(warnings[0].code, "before-near-plane");
        assert_eq!(warnings[0].count, scene.objects.len());
        let (message, first) = (&warnings[0].message, &scene.objects[0].name);
        assert!(message.contains(&format!("'{first}'")), "{message}");
        assert!(
            message.contains("at 1000") && message.contains(" more"),
            "{message}"
        );
        // What is behind the eye was not to be seen anyway.
        let away = scene.camera.eye * 2.0 - scene.camera.target;
        scene.camera.target = away;
        assert_eq!(codes(&scene), [""; 0]);
    }

    #[test]
    fn steps_of_depth_are_held_against_casters() {
        let mut scene = builtin::build("cylinder").unwrap();
        scene.camera.near = 1e-6;
        let warnings = scene.view_warnings(SIZE);
        let [warning] = &warnings[..] else {
            panic!("{warnings:?}");
        };
        assert_eq!((warning.code, warning.count), ("coarse-depth", 1));
        // The near distance that is named is enough.
        let named = warning.message.split("set near to ").nth(1).unwrap();
        let named: f64 = named.split(' ').next().unwrap().parse().unwrap();
        scene.camera.near = named * 1.5;
        assert_eq!(codes(&scene), [""; 0], "{named}");
        scene.camera.near = named / 4.0;
        assert_eq!(codes(&scene), ["coarse-depth"], "{named}");
        for object in scene.objects.iter_mut().filter(|o| o.casts) {
            let point = glam::DVec3::ONE;
            let shape = Shape {
                positions: vec![point; 3],
                triangles: vec![[0, 1, 2]],
            };
            object.mesh = shape.into_mesh(Shading::Flat).unwrap().into();
        }
        assert_eq!(codes(&scene), [""; 0]);
    }
}
