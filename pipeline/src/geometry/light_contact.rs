//! Whether a light is free of a caster, touches or cuts it, or is inside it.
//!
//! Techniques that take silhouettes from the light's centre, or one sample there,
//! are far off where a caster hides that centre from all that the rest of the light
//! reaches: a lamp half in its shade, or set into a ceiling.

use glam::DVec3;

use crate::geometry::area_light::{AreaLight, nearest_on_segment};
use crate::geometry::winding::mesh_winding;
use crate::world::light::{HardLight, Light};
use crate::world::mesh::Mesh;

/// How a light meets a caster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Contact {
    /// Some of the light's shape is on the caster's surface.
    Touches,
    /// The light is wholly inside a closed caster whose surface faces outwards.
    Inside,
}

/// What counts as touching, in radii of the light, and relative to coordinates: a
/// few steps of the f32 that meshes are kept in.
const NEAR: f64 = 1e-6;
const NEAR_COORDINATES: f64 = 4e-7;

/// How `light` meets `mesh`; `None` where it is free of it. `closed` says whether the
/// mesh is, and is asked only if it matters. Rooms whose surface faces inwards may
/// hold lights.
pub(crate) fn contact(
    light: &Light,
    mesh: &Mesh,
    closed: impl FnOnce() -> bool,
) -> Option<Contact> {
    let HardLight::Point(centre) = light.hard() else {
        return None;
    };
    let area = AreaLight::new(&light.shape).ok();
    let radius = area.as_ref().map_or(0.0, AreaLight::bounding_radius);
    let near = NEAR * radius + NEAR_COORDINATES * centre.abs().max_element();
    let (low, high) = mesh.bounds()?;
    let reach = DVec3::splat(radius + near);
    if !(centre + reach).cmpge(low).all() || !(centre - reach).cmple(high).all() {
        return None;
    }
    let triangles = || (0..mesh.triangles().len()).map(|t| mesh.corners(t));
    let touches = match &area {
        Some(AreaLight::Sphere { .. }) | None => {
            triangles().any(|t| distance(centre, t) <= radius + near)
        }
        Some(flat) => triangles().any(|t| meets_flat(flat, centre, t, near)),
    };
    if touches {
        return Some(Contact::Touches);
    }
    let within = centre.cmpge(low).all() && centre.cmple(high).all();
    let inside = within && mesh_winding(mesh, centre) > 0 && closed();
    inside.then_some(Contact::Inside)
}

/// Distance of a point from a triangle, which may have no area.
fn distance(p: DVec3, corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners;
    let to_edge = |e: [DVec3; 2]| (nearest_on_segment(e, p) - p).length();
    let to_edges = to_edge([a, b]).min(to_edge([b, c])).min(to_edge([c, a]));
    match (b - a).cross(c - a).try_normalize() {
        Some(normal) if is_above(p, corners, normal) => normal.dot(p - a).abs().min(to_edges),
        _ => to_edges,
    }
}

/// Whether the point is above or below the triangle.
fn is_above(p: DVec3, [a, b, c]: [DVec3; 3], normal: DVec3) -> bool {
    let inner = |from: DVec3, to: DVec3| normal.cross(to - from).dot(p - from) >= 0.0;
    inner(a, b) && inner(b, c) && inner(c, a)
}

/// Whether a flat light and a triangle share a point, within `near`.
fn meets_flat(light: &AreaLight, centre: DVec3, corners: [DVec3; 3], near: f64) -> bool {
    let Some(normal) = light.normal() else {
        return false;
    };
    let in_plane = in_plane(corners, centre, normal, near);
    let pairs = (0..in_plane.len()).flat_map(|i| (i..in_plane.len()).map(move |j| [i, j]));
    let mut segments = pairs.map(|pair| pair.map(|k| in_plane[k]));
    segments.any(|s| light.meets_within(s, near).is_some()) || distance(centre, corners) <= near
}

/// Corners and points of the edges that lie in the light's plane.
fn in_plane(corners: [DVec3; 3], centre: DVec3, normal: DVec3, near: f64) -> Vec<DVec3> {
    let heights = corners.map(|p| normal.dot(p - centre));
    let mut points = Vec::new();
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        let (hp, hq) = (heights[k], heights[(k + 1) % 3]);
        if hp.abs() <= near {
            points.push(p);
        } else if hq.abs() > near && (hp < 0.0) != (hq < 0.0) {
            points.push(p + (q - p) * (hp / (hp - hq)));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::light::LightShape;
    use crate::world::mesh::Shading;
    use crate::world::scene::builtin;
    use crate::world::shape;
    use proptest::prelude::*;

    fn unit_box() -> Mesh {
        shape::cuboid(DVec3::ZERO, DVec3::ONE)
            .into_mesh(Shading::Flat)
            .unwrap()
    }

    fn of(shape: LightShape) -> Light {
        Light {
            shape,
            colour: [1.0; 3],
        }
    }

    /// One light of each kind, of the given extent; no polygon where its corners would
    /// be one point in f64.
    fn lights(centre: DVec3, extent: f64) -> Vec<Light> {
        let (u, v) = (DVec3::X * extent, DVec3::new(0.0, 0.2, 1.0) * extent);
        let corners = [-u - v, u - v, u + v * 0.5].map(|d| d * 0.5);
        let mean = (corners[0] + corners[1] + corners[2]) / 3.0;
        let corners: Vec<DVec3> = corners.iter().map(|d| centre + *d - mean).collect();
        let polygon = crate::world::light::ConvexPolygon::new(corners).ok();
        let mut lights = vec![
            of(LightShape::Point { position: centre }),
            of(LightShape::Sphere {
                centre,
                radius: 0.5 * extent,
            }),
            of(LightShape::Disc {
                centre,
                normal: DVec3::new(0.1, 1.0, 0.2).normalize(),
                radius: 0.5 * extent,
            }),
            of(LightShape::Rectangle {
                centre,
                edge_u: u,
                edge_v: v,
            }),
        ];
        lights.extend(polygon.map(|p| of(LightShape::Polygon(p))));
        lights
    }

    fn contacts(centre: DVec3, extent: f64) -> Vec<Option<Contact>> {
        let solid = unit_box();
        lights(centre, extent)
            .iter()
            .map(|l| contact(l, &solid, || true))
            .collect()
    }

    #[test]
    fn lights_are_free_touch_or_are_inside() {
        let free = [None; 5];
        assert_eq!(contacts(DVec3::new(0.0, 2.0, 0.0), 1.0), free);
        // Beside it, in its bounds' reach only.
        assert_eq!(contacts(DVec3::new(0.7, 0.7, 0.7), 0.3), free);
        assert_eq!(
            contacts(DVec3::new(0.1, 0.1, 0.1), 0.2),
            [Some(Contact::Inside); 5]
        );
        let touches = [Some(Contact::Touches); 5];
        for on_it in [
            DVec3::new(0.1, 0.5, 0.2), // a face
            DVec3::new(0.1, 0.5, 0.5), // an edge
            DVec3::splat(0.5),         // a corner
        ] {
            for extent in [1e-30, 1e-9, 1e-3, 1.0, 3.0] {
                let met = contacts(on_it, extent);
                assert_eq!(met, touches[..met.len()], "{on_it} {extent}");
                assert!(extent < 1e-3 || met.len() == 5, "{on_it} {extent}");
            }
        }
        // Large enough to reach the surface, or to hold all of the box.
        let cut = contacts(DVec3::new(0.1, 0.1, 0.1), 2.0);
        assert_eq!(cut[0], Some(Contact::Inside));
        assert_eq!(cut[1..], touches[1..]);
        assert_eq!(
            contacts(DVec3::new(0.0, 0.3, 0.0), 40.0)[1],
            Some(Contact::Touches)
        );
    }

    /// A light that does not reach the surface by a hair, and one that does.
    #[test]
    fn a_hair_decides() {
        let sphere = |y: f64| {
            of(LightShape::Sphere {
                centre: DVec3::new(0.1, y, 0.2),
                radius: 0.25,
            })
        };
        let solid = unit_box();
        assert_eq!(contact(&sphere(0.75 + 1e-4), &solid, || true), None);
        assert_eq!(
            contact(&sphere(0.75 - 1e-4), &solid, || true),
            Some(Contact::Touches)
        );
        assert_eq!(
            contact(&sphere(0.25 - 1e-4), &solid, || true),
            Some(Contact::Inside)
        );
        let square = |y: f64| Light::horizontal_square(DVec3::new(0.0, y, 0.0), 1.0);
        assert_eq!(
            contact(&square(0.5), &solid, || true),
            Some(Contact::Touches)
        );
        assert_eq!(contact(&square(0.5 + 1e-4), &solid, || true), None);
    }

    #[test]
    fn rooms_may_hold_lights() {
        let mut room = shape::cuboid(DVec3::ZERO, DVec3::splat(4.0));
        room.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        let room = room.into_mesh(Shading::Flat).unwrap();
        let light = Light::horizontal_square(DVec3::new(0.2, 1.0, 0.1), 1.0);
        assert_eq!(contact(&light, &room, || true), None);
        assert_eq!(contact(&light, &unit_box(), || false), None);
        let through = Light::horizontal_square(DVec3::new(0.2, 1.0, 0.1), 5.0);
        assert_eq!(contact(&through, &room, || true), Some(Contact::Touches));
    }

    #[test]
    fn lights_of_built_in_scenes_are_free() {
        for entry in builtin::SCENES {
            let scene = entry.build();
            for (light, object) in scene
                .lights
                .iter()
                .flat_map(|l| scene.casters().map(move |o| (l, o)))
            {
                let met = contact(light, &object.mesh, || true);
                assert_eq!(met, None, "{}: {}", scene.name, object.name);
            }
        }
    }

    proptest! {
        /// Spheres against the box's exact distance, by its own formula.
        #[test]
        fn spheres_touch_where_the_distance_says(
            p in prop::array::uniform3(-1.5f64..1.5), radius in 0.01f64..1.0,
        ) {
            let p = DVec3::from(p);
            let outside = (p.abs() - DVec3::splat(0.5)).max(DVec3::ZERO).length();
            let depth = (DVec3::splat(0.5) - p.abs()).min_element();
            let gap = if depth > 0.0 { depth } else { outside };
            prop_assume!((gap - radius).abs() > 1e-5);
            let expected = if gap < radius {
                Some(Contact::Touches)
            } else {
                (depth > 0.0).then_some(Contact::Inside)
            };
            let light = of(LightShape::Sphere { centre: p, radius });
            prop_assert_eq!(contact(&light, &unit_box(), || true), expected);
        }

        /// Rectangles against points sampled on them: if some are inside and some
        /// outside, the surface is cut.
        #[test]
        fn rectangles_that_are_partly_inside_touch(
            centre in prop::array::uniform3(-0.9f64..0.9),
            u in prop::array::uniform3(-1.0f64..1.0),
            v in prop::array::uniform3(-1.0f64..1.0),
        ) {
            let [centre, edge_u, edge_v] = [centre, u, v].map(DVec3::from);
            prop_assume!(edge_u.cross(edge_v).length() > 1e-2);
            let place = |k: i32| f64::from(k) / 8.0 - 0.5;
            let points = (0..9).flat_map(|i| (0..9).map(move |j| (i, j)));
            let depth = |(i, j): (i32, i32)| {
                let p = centre + edge_u * place(i) + edge_v * place(j);
                0.5 - p.abs().max_element()
            };
            let depths: Vec<f64> = points.map(depth).collect();
            prop_assume!(depths.iter().all(|d| d.abs() > 1e-5));
            let inside = depths.iter().filter(|d| **d > 0.0).count();
            let light = of(LightShape::Rectangle { centre, edge_u, edge_v });
            let met = contact(&light, &unit_box(), || true);
            match inside {
                0 => prop_assert!(met != Some(Contact::Inside)),
                n if n < depths.len() => prop_assert_eq!(met, Some(Contact::Touches)),
                _ => prop_assert_eq!(met, Some(Contact::Inside)), // the box is convex
            }
        }
    }
}
