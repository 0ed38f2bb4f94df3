use std::f64::consts::PI;

use super::*;
use crate::geometry::harmonics::dot;
use crate::world::mesh::{Mesh, Shading};
use crate::world::shape::{self, Shape};

fn mesh(shape: Shape) -> Mesh {
    shape.into_mesh(Shading::Smooth).unwrap()
}

fn knot(along: u32, around: u32) -> Shape {
    shape::torus_knot(2, 3, 1.0, 0.4, 0.25, along, around, DVec3::ZERO)
}

fn transport(mesh: &Mesh, casts: bool, directions: usize) -> Transport {
    let list = mesh.shading_vertices();
    let object = TransportObject {
        positions: &list.positions,
        normals: &list.normals,
        triangles: &list.triangles,
        casts,
    };
    let settings = TransportSettings {
        directions,
        ..TransportSettings::default()
    };
    Transport::new(&object, settings, &|_| {})
}

fn wide(row: &[f32]) -> Vec<f64> {
    row.iter().map(|v| f64::from(*v)).collect()
}

/// Under the same light from everywhere, of radiance 1, what a vertex reflects at
/// albedo 1: only band 0 counts.
fn open(transport: &Transport, vertex: usize) -> f64 {
    f64::from(transport.diffuse_of(vertex)[0]) * (4.0 * PI).sqrt()
}

/// A mesh with as many vertices as the paper's Venus.
#[test]
fn bytes_are_those_of_the_paper() {
    let ball = mesh(shape::icosphere(1, 1.0, DVec3::ZERO));
    let found = transport(&ball, false, 64);
    assert_eq!(found.vertices(), ball.positions().len());
    assert_eq!(found.diffuse_bytes(), found.vertices() * 36 * 4);
    assert_eq!(
        found.bytes() - found.diffuse_bytes(),
        found.vertices() * 16 * 4
    );
    assert_eq!((5_776 * 36 * 4) as f64 / 1024.0, 812.25);
}

#[test]
fn a_convex_object_hides_nothing_of_itself() {
    for ball in [
        shape::icosphere(2, 0.7, DVec3::ONE),
        shape::icosphere(1, 3e-4, DVec3::ZERO),
    ] {
        let ball = mesh(ball);
        let (found, bare) = (transport(&ball, true, 512), transport(&ball, false, 512));
        assert!(found.rays > 0 && bare.rays == 0);
        assert_eq!(found.diffuse, bare.diffuse);
        assert_eq!(found.glossy, bare.glossy);
        for vertex in 0..found.vertices() {
            assert!((open(&found, vertex) - 1.0).abs() < 1e-6);
        }
    }
}

/// A small plate that looks up at a large one above it, and one that looks away.
#[test]
fn what_lies_above_is_taken_off() {
    let above = shape::cuboid(DVec3::Y * 0.05, DVec3::new(50.0, 0.01, 50.0));
    let below = shape::cuboid(DVec3::ZERO, DVec3::new(0.5, 0.01, 0.5));
    let both = Shape::merged([above, below])
        .into_mesh(Shading::Flat)
        .unwrap();
    let found = transport(&both, true, 1024);
    let list = both.shading_vertices();
    let (mut up, mut down) = (0, 0);
    for (i, (p, n)) in list.positions.iter().zip(&list.normals).enumerate() {
        if p[0].abs() > 1.0 || n[0].abs() + n[2].abs() > 0.5 {
            continue;
        }
        if n[1] > 0.5 {
            assert!(open(&found, i).abs() < 0.01, "{}", open(&found, i));
            up += 1;
        } else {
            assert!((open(&found, i) - 1.0).abs() < 1e-6);
            down += 1;
        }
    }
    assert!(up >= 4 && up == down, "{up} {down}");
}

/// A right-angled corner hides half of what a wall sees (form factors of quarter
/// spaces: at the edge ½ of the cosine, as the solid angle).
#[test]
fn an_edge_between_two_walls_sees_half() {
    let floor = shape::cuboid(DVec3::new(0.0, -0.5, 0.0), DVec3::new(200.0, 1.0, 200.0));
    let wall = shape::cuboid(
        DVec3::new(-50.0, 50.0, 0.0),
        DVec3::new(100.0, 100.0, 200.0),
    );
    let step = Shape::merged([floor, wall])
        .into_mesh(Shading::Flat)
        .unwrap();
    let list = step.shading_vertices();
    let positions = [[1e-3f32, 0.0, 0.0]];
    let object = TransportObject {
        positions: &[&positions[..], &list.positions].concat(),
        normals: &[&[[0.0f32, 1.0, 0.0]][..], &list.normals].concat(),
        triangles: &list
            .triangles
            .iter()
            .map(|t| t.map(|i| i + 1))
            .collect::<Vec<_>>(),
        casts: true,
    };
    let settings = TransportSettings {
        directions: 4096,
        ..TransportSettings::default()
    };
    let found = Transport::new(&object, settings, &|_| {});
    assert!((open(&found, 0) - 0.5).abs() < 5e-3, "{}", open(&found, 0));
    // Of V, the free quarter: half the half space.
    let half = f64::from(found.glossy_of(0)[0]) * (4.0 * PI).sqrt() / (2.0 * PI);
    assert!((half - 0.5).abs() < 5e-3, "{half}");
}

/// The lattice's error: T of a vertex in a bowl against ten times the directions.
#[test]
fn more_directions_give_the_same() {
    let knot = mesh(knot(60, 8));
    let [few, many] = [512, 8192].map(|n| transport(&knot, true, n));
    let basis = Basis::new(6);
    let up = basis.at(DVec3::new(0.36, 0.48, 0.8));
    let mut squares = 0.0;
    for vertex in 0..few.vertices() {
        let [a, b] = [&few, &many].map(|t| dot(&wide(t.diffuse_of(vertex)), &up));
        squares += (a - b) * (a - b);
    }
    let rms = (squares / few.vertices() as f64).sqrt() * PI;
    assert!(rms < 0.03 && rms > 0.0, "{rms}");
    assert!(few.rays * 15 < many.rays);
}

#[test]
fn any_number_of_threads_gives_the_same_bits_and_content_is_kept() {
    let knot = mesh(knot(24, 6));
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| transport(&knot, true, 128))
    };
    let one = with(1);
    assert_eq!(one, with(4));
    let list = knot.shading_vertices();
    let object = TransportObject {
        positions: &list.positions,
        normals: &list.normals,
        triangles: &list.triangles,
        casts: true,
    };
    let settings = one.settings;
    let kept = Transport::kept(&object, settings);
    assert_eq!(*kept, one);
    assert!(Arc::ptr_eq(&kept, &Transport::kept(&object, settings)));
    let key = |object: &TransportObject<'_>, settings| TransportKey::of(object, settings);
    let plain = key(&object, settings);
    let more = TransportSettings {
        directions: 129,
        ..settings
    };
    assert_ne!(plain, key(&object, more));
    let bare = TransportObject {
        casts: false,
        ..object
    };
    assert_ne!(plain, key(&bare, settings));
    let mut moved = list.positions.clone();
    moved[0][0] += 1e-5;
    let moved = TransportObject {
        positions: &moved,
        ..object
    };
    assert_ne!(plain, key(&moved, settings));
}

/// A column whose ends are inside two boxes: its rims see nothing, and what lies between
/// them sees nearly all.
#[test]
fn vertices_inside_their_object_take_after_those_outside() {
    let column = || shape::cylinder(12, 0.2, -1.0, 1.0);
    let ends = [-1.2, 1.2].map(|y| shape::cuboid(DVec3::Y * y, DVec3::new(1.0, 0.6, 1.0)));
    let [low, high] = ends;
    let whole = Shape::merged([column(), low, high]);
    let whole = whole.into_mesh(Shading::Crease { degrees: 40.0 }).unwrap();
    let found = transport(&whole, true, 256);
    let list = whole.shading_vertices();
    let mut sides = 0;
    for (i, (p, n)) in list.positions.iter().zip(&list.normals).enumerate() {
        let of_side = p[0].abs() < 0.3 && n[1].abs() < 0.1 && p[1].abs() < 1.05;
        if of_side {
            sides += 1;
            assert!(
                (open(&found, i) - 1.0).abs() < 1e-6,
                "{p:?} {}",
                open(&found, i)
            );
        }
    }
    // Both rims of the column, and the lids' own vertices.
    assert!(
        sides >= 24 && found.buried >= 48,
        "{sides} {}",
        found.buried
    );
    let bare = column().into_mesh(Shading::Smooth).unwrap();
    assert_eq!(transport(&bare, true, 256).buried, 0);
}
