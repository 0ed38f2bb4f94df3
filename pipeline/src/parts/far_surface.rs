//! Surfaces that reach much farther than the eye looks.
//!
//! f32 holds about 2^-24 of a coordinate. A floor of 10⁷ units, seen from a few units
//! above, has vertices that are off by more than its distance from the eye, and clipping
//! carries that to where it is seen. So such surfaces are clipped in f64 before anything
//! is rounded: to somewhat more than what is seen, so that no new edge is in the picture.
//!
//! Casters are drawn as they are: volumes have caps of the same vertices.

use glam::DVec3;

use super::surface_vertices::SurfaceVertices;
use super::view::View;
use crate::world::mesh::{narrow, widen};
use crate::world::scene::{Object, Pyramid, clip_with};

/// Distance of a vertex over that of the point looked at, from which on f32 is not
/// trusted with it.
const FAR: f64 = 16.0;
/// Tangents that are kept over those in the picture.
const MARGIN: f64 = 1.5;

/// What is seen of an object, if it casts nothing and reaches too far.
pub(crate) fn clipped(object: &Object, view: &View) -> Option<SurfaceVertices> {
    let camera = view.camera();
    let far = FAR * (camera.target - camera.eye).length();
    let positions = object.mesh.positions().iter();
    let beyond = positions.map(|p| (widen(*p) - camera.eye).length());
    (!object.casts && beyond.fold(0.0, f64::max) > far).then(|| in_view(object, view))
}

/// Position, normal and texture coordinates of a corner.
type Corner = [DVec3; 3];

fn in_view(object: &Object, view: &View) -> SurfaceVertices {
    let mesh = &object.mesh;
    let camera = view.camera();
    let pyramid = Pyramid::wider(camera, view.size(), MARGIN);
    let mut all = SurfaceVertices::new();
    let (mut polygon, mut scratch) = (Vec::new(), Vec::new());
    for (t, normals) in mesh.normal_triangles().iter().enumerate() {
        let normals = normals.map(|n| widen(mesh.normals()[n as usize]));
        let corners = mesh.corners(t);
        polygon.clear();
        let texels = object.coordinates_of(t as u32);
        let texels = texels.map(|[u, v]| DVec3::new(u.into(), v.into(), 0.0));
        polygon.extend([0, 1, 2].map(|k| [corners[k], normals[k], texels[k]]));
        for side in pyramid.sides() {
            let height = |v: Corner| side(v[0]);
            clip_with(&mut polygon, &mut scratch, height, |a, b, share| {
                [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * share)
            });
        }
        add(&mut all, &polygon, view);
    }
    all
}

/// Adds a polygon as a fan round the vertex nearest to the eye, whose digits count
/// most.
fn add(all: &mut SurfaceVertices, polygon: &[Corner], view: &View) {
    let eye = view.camera().eye;
    let away = |k: &usize| (polygon[*k][0] - eye).length();
    let nearest = (0..polygon.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
    let first = all.len();
    for k in 0..polygon.len() {
        let [p, n, t] = polygon[(k + nearest.unwrap_or(0)) % polygon.len()];
        all.data.extend(narrow(view.relative(p)));
        all.data.extend(narrow(n));
        let own = all.coordinates.get_or_insert_default();
        own.push([t.x as f32, t.y as f32]);
    }
    let fan = 1..(polygon.len() as u32).max(2) - 1;
    all.push(fan.map(|k| [first, first + k, first + k + 1]));
}
