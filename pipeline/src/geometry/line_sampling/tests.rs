//! The rules against the exact oracle, a closed form, and points of the light.

use glam::DVec3;

use super::blocks::BlockBounds;
use super::edges::LineCasters;
use super::kept_lists::KeptLists;
use super::light::{ANGLE, Extent, LineLight};
use super::lists::Culling;
use super::patches::Patches;
use super::walk::{LineReceiver, Seen, visible};
use crate::geometry::caster::{Caster, CasterPolicy};
use crate::truth::oracle::area::{AreaOracle, Workspace};
use crate::truth::oracle::surfaces::{Receiver, Surfaces};
use crate::world::light::LightShape;
use crate::world::scene::{Scene, builtin};

/// A scene as the rules have it.
struct Lined {
    casters: LineCasters,
    /// Plane of each surface, if it casts.
    own: Vec<Option<u32>>,
    surfaces: Surfaces,
    light: LineLight,
    oracle: AreaOracle,
}

impl Lined {
    fn new(scene: &Scene) -> Self {
        let light = &scene.lights[0];
        let mut casters = LineCasters::default();
        let mut own = Vec::new();
        for object in &scene.objects {
            let triangles = object.mesh.triangles().len();
            if !object.casts || triangles == 0 {
                own.extend(vec![None; triangles]);
                continue;
            }
            let caster = Caster::of_object(object, CasterPolicy::Generalised).unwrap();
            let patches = Patches::new(&object.mesh, caster.adjacency());
            let counting = caster.counting(&object.mesh, light.hard());
            let first = casters.push(&object.mesh, &caster, &patches, counting);
            own.extend(patches.of_triangle.iter().map(|p| Some(first + p)));
        }
        let surfaces = Surfaces::new(scene);
        Self {
            casters,
            own,
            light: LineLight::new(&light.shape, ANGLE).unwrap().unwrap(),
            oracle: AreaOracle::new(&surfaces, &light.shape).unwrap(),
            surfaces,
        }
    }

    fn of(name: &str) -> (Scene, Self) {
        let scene = builtin::build(name).unwrap();
        let lined = Self::new(&scene);
        (scene, lined)
    }

    /// What is seen at points of a picture, with their planes.
    fn receivers(&self, scene: &Scene, size: [u32; 2]) -> Vec<(Receiver, LineReceiver, [u32; 2])> {
        let rays = scene.camera.eye_rays(size[0], size[1]);
        let all = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        let at = |[x, y]: [u32; 2]| {
            let at = [x, y].map(|v| f64::from(v) + 0.5);
            let hit = self.surfaces.hit(&rays, at[0], at[1])?;
            let receiver = self.surfaces.receiver_of(&hit, &rays, at[0], at[1]);
            let own = self.own[self.surfaces.index_of(&hit) as usize];
            let own = own.and_then(|own| Some((own, receiver.normal?)));
            let point = receiver.point;
            Some((receiver, LineReceiver { point, own }, [x, y]))
        };
        all.filter_map(at).collect()
    }

    fn seen(&self, n: u32, receiver: LineReceiver) -> Seen {
        visible(&self.casters, &self.light, n, receiver)
    }
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

/// Of `n` lines over a picture, against the oracle; D is never below 0.
fn error(name: &str, lines: &[u32], size: [u32; 2]) -> Vec<f64> {
    let (scene, lined) = Lined::of(name);
    let receivers = lined.receivers(&scene, size);
    let of = |n: u32| {
        let error = |(receiver, own, at): &(Receiver, LineReceiver, [u32; 2])| {
            let seen = lined.seen(n, *own);
            assert!(seen.least >= 0, "{name} {at:?}: {seen:?}");
            let truth = lined
                .oracle
                .visibility_with(receiver, &mut Workspace::default());
            seen.share - truth.share
        };
        rms(&receivers.iter().map(error).collect::<Vec<_>>())
    };
    let errors: Vec<f64> = lines.iter().map(|n| of(*n)).collect();
    println!("{name}: {errors:?}");
    errors
}

#[test]
fn errors_fall_with_lines_and_depth_is_never_negative() {
    for name in ["peer-a", "single-silhouette", "overlap"] {
        let errors = error(name, &[4, 16, 64], [24, 18]);
        assert!(
            errors[1] < 2e-3 && errors[1] < 0.5 * errors[0],
            "{name} {errors:?}"
        );
        assert!(errors[2] < 0.5 * errors[1], "{name} {errors:?}");
    }
}

#[test]
fn casters_of_many_facets_see_themselves_right() {
    for name in ["spheres", "creature"] {
        let errors = error(name, &[16], [16, 12]);
        assert!(errors[0] < 3e-3, "{name} {errors:?}");
    }
}

/// A disc, a sphere and a triangle in place of the square.
#[test]
fn lights_of_every_shape_are_seen_right() {
    let scene = builtin::build("single-silhouette").unwrap();
    let crate::world::light::HardLight::Point(square) = scene.lights[0].hard() else {
        panic!("a square has a centre");
    };
    for shape in [
        LightShape::Disc {
            centre: square,
            normal: DVec3::new(0.2, 1.0, 0.1),
            radius: 0.6,
        },
        LightShape::Sphere {
            centre: square,
            radius: 0.5,
        },
        LightShape::Polygon(
            crate::world::light::ConvexPolygon::new(vec![
                square + DVec3::new(-0.6, 0.0, -0.4),
                square + DVec3::new(0.1, 0.1, 0.7),
                square + DVec3::new(0.7, 0.0, -0.3),
            ])
            .unwrap(),
        ),
    ] {
        let mut scene = scene.clone();
        scene.lights[0].shape = shape.clone();
        let lined = Lined::new(&scene);
        let error = |(receiver, own, _): &(Receiver, LineReceiver, [u32; 2])| {
            let seen = lined.seen(64, *own);
            assert!(seen.least >= 0, "{shape:?} {seen:?}");
            let truth = lined
                .oracle
                .visibility_with(receiver, &mut Workspace::default());
            seen.share - truth.share
        };
        let errors: Vec<f64> = lined
            .receivers(&scene, [20, 15])
            .iter()
            .map(error)
            .collect();
        assert!(rms(&errors) < 1e-3, "{shape:?}: {}", rms(&errors));
    }
}

/// What a list leaves out is no contour before the light: walks with a block's edges alone
/// are those with all, to the bit. Lists are those of one thread.
#[test]
fn lists_leave_out_what_is_irrelevant() {
    for name in ["peer-a", "creature", "adversarial-near-plane"] {
        let (scene, lined) = Lined::of(name);
        let size = [48, 36];
        let blocks = BlockBounds::new(&scene.camera, size, lined.surfaces.corners());
        let corners = lined.light.corners(1.0);
        let numbers = lined.casters.candidates(&corners, 1e-5);
        let edges: Vec<_> = numbers
            .iter()
            .map(|k| lined.casters.edges[*k as usize])
            .collect();
        let ends = lined.casters.ends_of(&numbers);
        let culling = Culling::new((&edges, &ends), &lined.casters.planes, &lined.light);
        let lists = culling.lists(&blocks);
        let alone = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .build()
            .unwrap();
        assert!(lists == alone.install(|| culling.lists(&blocks)), "{name}");
        let all = blocks.bounds.len() * edges.len();
        assert!(
            !lists.is_empty() && lists.len() < all * 3 / 4,
            "{name}: {} of {all}",
            lists.len()
        );
        for (_, receiver, [x, y]) in lined.receivers(&scene, size) {
            let block = (y / 8 * blocks.size[0] + x / 8) as usize;
            let listed = LineCasters {
                edges: lists.of(block).iter().map(|e| edges[*e as usize]).collect(),
                ..lined.casters.clone()
            };
            let (few, all) = (
                visible(&listed, &lined.light, 4, receiver),
                lined.seen(4, receiver),
            );
            assert_eq!(
                few.share.to_bits(),
                all.share.to_bits(),
                "{name} {x} {y} {few:?} {all:?}"
            );
        }
    }
}

/// What another frame left changes no list, and is not made again where nothing changed.
#[test]
fn lists_that_are_kept_are_those_that_are_made() {
    let (scene, lined) = Lined::of("creature");
    let blocks = BlockBounds::new(&scene.camera, [160, 120], lined.surfaces.corners());
    let light = |by: f64| {
        let mut light = lined.light.clone();
        light.frame.centre.y += by;
        light
    };
    let of = |lined: &Lined, light: &LineLight, before: &KeptLists| {
        let LineCasters {
            edges,
            ends,
            planes,
            ..
        } = &lined.casters;
        let culling = Culling::new((edges, ends), planes, light);
        let alone = culling.lists(&blocks);
        let (lists, kept) = culling.lists_after(&blocks, before);
        assert_eq!(
            (&lists.starts, &lists.entries),
            (&alone.starts, &alone.entries)
        );
        (alone.tests, lists.tests, kept)
    };
    let nothing = KeptLists::default();
    let (all, first, kept) = of(&lined, &light(0.0), &nothing);
    assert!(first == all && all > 1000, "{first} {all}");
    let (_, again, _) = of(&lined, &light(0.0), &kept);
    assert_eq!(again, 0);
    // Neither another light's nor those of edges elsewhere.
    let (all, other, _) = of(&lined, &light(0.01), &kept);
    assert_eq!(other, all);
    let mut moved = Lined::new(&scene);
    for end in moved.casters.edges.iter_mut().flat_map(|e| &mut e.ends) {
        end.x += 0.01;
    }
    let (all, other, _) = of(&moved, &light(0.0), &kept);
    assert_eq!(other, all);
    let mut turned = Lined::new(&scene);
    for plane in &mut turned.casters.planes {
        plane.offset += 1e-9;
    }
    let (all, other, _) = of(&turned, &light(0.0), &kept);
    assert_eq!(other, all);
}

#[test]
fn lines_of_a_polygon_cover_it() {
    let shape = &builtin::build("peer-a").unwrap().lights[0].shape;
    let light = LineLight::new(shape, ANGLE).unwrap().unwrap();
    let Extent::Polygon(outline) = &light.extent else {
        panic!("a square has corners");
    };
    let (n, heights) = (512, outline.iter().map(|c| c[1]));
    let extent = heights.clone().fold(f64::MIN, f64::max) - heights.fold(f64::MAX, f64::min);
    let lengths: f64 = light.lines(n).iter().map(|l| l.right - l.left).sum();
    let area = lengths * extent / f64::from(n);
    let LightShape::Rectangle { edge_u, edge_v, .. } = shape else {
        panic!("the peers' light is a rectangle");
    };
    assert!((area / edge_u.cross(*edge_v).length() - 1.0).abs() < 1e-4);
    for line in light.lines(n) {
        let foot = line.slope * line.y;
        assert!(line.left <= foot && foot <= line.right, "{line:?}");
    }
}
