//! The exact wedge is the penumbra: nothing outside, nothing more inside.

use crate::wedge_support::{
    Frame, KINDS, Kind, Random, edge, generators, grazing_point, inside, light, shape, winding,
};
use glam::DVec3;
use gnomon_pipeline::geometry::coverage::{LightPlane, SphereOutline};
use gnomon_pipeline::geometry::silhouette::{Orientation, Silhouette, light_facing};
use gnomon_pipeline::geometry::volume::ShadowVolume;
use gnomon_pipeline::geometry::wedge::polyhedron::Ends;
use gnomon_pipeline::geometry::wedge::{Construction, Plane, Wedge, WedgeStatistics};
use gnomon_pipeline::world::adjacency::EdgeAdjacency;
use gnomon_pipeline::world::light::HardLight;
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::shape::icosphere;

const ROUNDING: f64 = 1e-12;

fn exact(kind: Kind, frame: &Frame, edge: [DVec3; 2]) -> Wedge {
    let mut statistics = WedgeStatistics::default();
    let lit = light(kind, frame);
    let mut wedges = Wedge::of_edge(Construction::Exact, &lit, edge, &mut statistics);
    assert_eq!((wedges.len(), statistics.touching_light), (1, 0));
    wedges.remove(0)
}

/// Receivers that see the edge cut the light, by definition: behind a point of
/// the edge as seen from a point of the light.
#[test]
fn every_penumbra_point_lies_inside() {
    for kind in KINDS {
        let mut random = Random(11);
        let (mut samples, mut outside, mut single, mut least) = (0, 0, 0, f64::INFINITY);
        for case in 0..1000 {
            let frame = Frame::random(&mut random);
            let length = if case % 2 == 0 {
                [0.05, 1.0]
            } else {
                [1.0, 6.0]
            };
            let edge = edge(&frame, &mut random, length);
            let wedge = exact(kind, &frame, edge);
            single += i32::from(matches!(wedge.volume.ends(), Ends::One(_)));
            let shape = shape(kind, &frame);
            for _ in 0..120 {
                let along = [0.0, 1.0, random.unit(), random.unit()][random.below(4)];
                let e = edge[0] + (edge[1] - edge[0]) * along;
                let v = grazing_point(&shape, e, &mut random);
                let depth = wedge.volume.depth(e + (e - v) * random.range(0.0, 3.0));
                samples += 1;
                outside += i32::from(depth < -ROUNDING);
                least = depth.min(least);
            }
        }
        eprintln!(
            "{kind:?}: {outside} of {samples} penumbra points outside, least depth {least:.1e}; \
             {single} of 1000 edges pierce the light's plane in the light"
        );
        assert!(outside == 0 && samples >= 100_000, "{kind:?} {outside}");
        assert!(single > 5, "no edge stabbed the light");
    }
}

/// Inside points, off the boundary, see the edge cut the light. Under round lights
/// the facets at the ends may exceed the cone by 2 %: counted apart.
#[test]
fn every_inside_point_is_penumbra() {
    for kind in KINDS {
        let mut random = Random(12);
        let (mut samples, mut false_inside) = (0, 0);
        for case in 0..1000 {
            let frame = Frame::random(&mut random);
            let length = if case % 2 == 0 {
                [0.05, 1.0]
            } else {
                [1.0, 6.0]
            };
            let edge = edge(&frame, &mut random, length);
            let wedge = exact(kind, &frame, edge);
            let light = LightPlane::new(&shape(kind, &frame), SphereOutline::Seen).unwrap();
            for _ in 0..120 {
                let p = inside(&wedge.volume, &mut random);
                if wedge.volume.depth(p) < 1e-7 {
                    continue;
                }
                samples += 1;
                let seen = light.seen_from(p).and_then(|eye| eye.clip(edge));
                false_inside += i32::from(seen.is_none());
            }
        }
        let round = matches!(kind, Kind::Disc | Kind::Sphere);
        eprintln!("{kind:?}: {false_inside} of {samples} inside points see no cut");
        assert!(samples > 90_000, "{samples}");
        let allowed = if round { samples / 50 } else { 0 };
        assert!(false_inside <= allowed, "{kind:?} {false_inside}");
    }
}

/// Without its front plane the wedge takes in points that are not penumbra: the
/// test above can fail.
#[test]
fn negative_control_every_plane_is_needed() {
    let mut random = Random(13);
    let mut needed = 0;
    let mut planes = 0;
    for _ in 0..50 {
        let frame = Frame::random(&mut random);
        let edge = edge(&frame, &mut random, [0.3, 2.0]);
        let wedge = exact(Kind::Square, &frame, edge);
        let (apexes, rays) = generators(&wedge.volume);
        for (skipped, plane) in wedge.volume.planes().iter().enumerate() {
            planes += 1;
            // Just beyond the middle of its face, where others hold: not penumbra.
            let on = |v: &&DVec3| plane.normal.dot(**v).abs() < 1e-9;
            let held: Vec<&DVec3> = rays.iter().filter(on).collect();
            let start = apexes.iter().filter(|a| plane.distance(**a).abs() < 1e-9);
            let start: Vec<&DVec3> = start.collect();
            let middle = start.iter().copied().sum::<DVec3>() / start.len() as f64
                + held.into_iter().sum::<DVec3>();
            let beyond = middle - plane.normal * 1e-6;
            let others = wedge.volume.planes().iter().enumerate();
            needed += i32::from(
                others
                    .filter(|(k, _)| *k != skipped)
                    .all(|(_, p)| p.distance(beyond) > 0.0),
            );
        }
    }
    assert_eq!(needed, planes);
}

/// Meshes are closed, face outwards, and wind once round the inside; halves split
/// the inside by the hard plane and nothing is in both.
#[test]
fn meshes_and_halves_are_closed_and_outward() {
    for kind in KINDS {
        let mut random = Random(14);
        let (mut split, mut tested) = (0, 0);
        for case in 0..300 {
            let frame = Frame::random(&mut random);
            let length = if case % 2 == 0 {
                [0.05, 1.0]
            } else {
                [1.0, 6.0]
            };
            let wedge = exact(kind, &frame, edge(&frame, &mut random, length));
            let mesh = wedge.volume.mesh();
            assert_eq!(mesh.open_edges(), 0);
            let halves = wedge.halves().unwrap();
            assert_eq!(
                halves.outer.open_edges(),
                0,
                "{kind:?} {:?}",
                wedge.volume.ends()
            );
            assert_eq!(halves.inner.open_edges(), 0);
            for k in 0..8 {
                let scattered = wedge.edge[0] + random.in_box(4.0);
                let p = if k < 4 {
                    inside(&wedge.volume, &mut random)
                } else {
                    scattered
                };
                let (depth, side) = (wedge.volume.depth(p), halves.plane.distance(p));
                if depth.abs() < 1e-3 || side.abs() < 1e-3 {
                    continue;
                }
                tested += 1;
                let expected = f64::from(i32::from(depth > 0.0));
                let is_outer = f64::from(i32::from(depth > 0.0 && side > 0.0));
                let counts = [&mesh, &halves.outer, &halves.inner].map(|m| winding(m, p));
                for (count, wanted) in
                    counts
                        .into_iter()
                        .zip([expected, is_outer, expected - is_outer])
                {
                    assert!(
                        (count - wanted).abs() < 1e-6,
                        "{kind:?} {counts:?} {expected} {is_outer}"
                    );
                }
                split += i32::from(is_outer > 0.0);
            }
        }
        assert!(tested > 700 && split > 150, "{kind:?} {tested} {split}");
    }
}

/// The bottom plane of paper II cuts the wedge and closes it.
#[test]
fn a_bottom_plane_closes_the_wedge_at_finite_distance() {
    let frame = Frame {
        centre: DVec3::ZERO,
        axes: [DVec3::X, DVec3::Y, DVec3::Z],
    };
    let bottom = Plane {
        normal: -DVec3::Z,
        point: DVec3::Z * 9.0,
    };
    let mut random = Random(15);
    let mut closed = 0;
    for kind in KINDS {
        for _ in 0..100 {
            let wedge = exact(kind, &frame, edge(&frame, &mut random, [0.1, 1.0]));
            let Some(mesh) = wedge.volume.mesh_to_bottom(&bottom) else {
                continue;
            };
            closed += 1;
            assert_eq!(mesh.open_edges(), 0);
            assert!(mesh.vertices.iter().all(|v| v.w == 1.0));
            for _ in 0..8 {
                let p = inside(&wedge.volume, &mut random);
                if wedge.volume.depth(p).abs() < 1e-3 || (p.z - 9.0).abs() < 1e-3 {
                    continue;
                }
                let wanted = f64::from(i32::from(p.z < 9.0));
                assert!((winding(&mesh, p) - wanted).abs() < 1e-6);
            }
        }
    }
    assert!(closed > 400, "{closed}");
    let up = Plane {
        normal: DVec3::Z,
        point: DVec3::ZERO,
    };
    let wedge = exact(Kind::Square, &frame, edge(&frame, &mut random, [0.1, 1.0]));
    assert_eq!(wedge.volume.mesh_to_bottom(&up), None);
}

/// The hard quad in the middle of a wedge is the shadow volume's, to the bit, so
/// that one triangle set-up serves both.
#[test]
fn the_centre_is_the_shadow_volume_quad_to_the_bit() {
    let mesh = icosphere(2, 0.7, DVec3::new(0.1, 0.2, -0.3));
    let mesh: Mesh = mesh.into_mesh(Shading::Flat).unwrap();
    let frame = Frame {
        centre: DVec3::new(0.3, 4.0, 0.1),
        axes: [DVec3::Z, DVec3::X, DVec3::Y],
    };
    let frame = Frame {
        axes: [frame.axes[1], frame.axes[0], -frame.axes[2]],
        ..frame
    };
    let hard = HardLight::Point(frame.centre);
    let adjacency = EdgeAdjacency::new(mesh.triangles());
    let volume = ShadowVolume::of_closed(&mesh, &adjacency, hard);
    let facing = light_facing(&mesh, hard);
    let silhouette = Silhouette::new(&mesh, &adjacency, &Orientation::closed(&facing));
    assert!(silhouette.edges.len() > 20);
    for (k, ends) in silhouette.edges.iter().enumerate() {
        let wedge = exact(Kind::Square, &frame, ends.map(|i| mesh.position(i)));
        let centre = wedge.halves().unwrap().centre;
        for (ours, theirs) in centre.iter().zip(&volume.sides()[2 * k..2 * k + 2]) {
            let ours = ours.map(|v| v.to_array().map(|c| c as f32));
            assert_eq!(ours, theirs.map(|i| volume.positions()[i as usize]));
        }
    }
}
