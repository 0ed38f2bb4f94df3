//! Edges that wedge constructions fear, at scales and places where digits run out:
//! every wedge is finite, closed, encloses, and is accounted for.

use crate::wedge_support::{Frame, KINDS, Kind, Random, light_point, shape};
use glam::DVec3;
use gnomon_pipeline::geometry::area_light::AreaLight;
use gnomon_pipeline::geometry::coverage::{LightPlane, SphereOutline, loop_visibility};
use gnomon_pipeline::geometry::wedge::{Construction, Wedge, WedgeStatistics};
use gnomon_pipeline::world::light::LightShape;

const CONSTRUCTIONS: [Construction; 3] = [
    Construction::BoundingSphere,
    Construction::Tight,
    Construction::Exact,
];

/// A place where things are: scale and offset of everything.
#[derive(Clone, Copy, Debug)]
struct Place {
    scale: f64,
    offset: f64,
}

const PLACES: [Place; 4] = [
    Place {
        scale: 1.0,
        offset: 0.0,
    },
    Place {
        scale: 1e-4,
        offset: 0.0,
    },
    Place {
        scale: 1e4,
        offset: 0.0,
    },
    Place {
        scale: 1.0,
        offset: 1e5,
    },
];

impl Place {
    fn point(self, p: DVec3) -> DVec3 {
        p * self.scale + DVec3::new(1.0, -1.0, 1.0) * self.offset
    }

    fn shape(self, kind: Kind) -> LightShape {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let frame = Frame {
            centre: DVec3::ZERO,
            axes,
        };
        let centre = self.point(DVec3::ZERO);
        match shape(kind, &frame) {
            LightShape::Rectangle { edge_u, edge_v, .. } => LightShape::Rectangle {
                centre,
                edge_u: edge_u * self.scale,
                edge_v: edge_v * self.scale,
            },
            LightShape::Disc { normal, radius, .. } => LightShape::Disc {
                centre,
                normal,
                radius: radius * self.scale,
            },
            LightShape::Sphere { radius, .. } => LightShape::Sphere {
                centre,
                radius: radius * self.scale,
            },
            other => other,
        }
    }
}

/// Edges in light coordinates: light about 1 across at the origin, shining to +z.
fn edges() -> Vec<(&'static str, [DVec3; 2])> {
    let v = DVec3::new;
    vec![
        ("aimed at the centre", [v(0.6, 0.4, 2.0), v(0.9, 0.6, 3.0)]),
        (
            "aimed, along the axis",
            [v(0.0, 0.0, 2.0), v(0.0, 0.0, 3.0)],
        ),
        (
            "aimed, away from the light",
            [v(0.9, 0.6, 3.0), v(0.6, 0.4, 2.0)],
        ),
        ("nearly aimed", [v(0.6, 0.4, 2.0), v(0.9, 0.6 + 1e-9, 3.0)]),
        (
            "line stabs the light",
            [v(0.1, 0.12, 2.0), v(0.15, 0.1, 3.0)],
        ),
        (
            "line through a corner",
            [v(0.5, 0.5, 2.0), v(0.5, 0.5, 3.0)],
        ),
        ("line through a side", [v(0.5, 0.1, 1.0), v(0.5, 0.1, 3.0)]),
        (
            "parallel to a side, above it",
            [v(0.5, -1.0, 2.0), v(0.5, 1.0, 2.0)],
        ),
        (
            "in the plane of a side's pyramid",
            [v(1.0, -1.0, 2.0), v(1.0, 0.7, 2.0)],
        ),
        (
            "crosses the plane beside",
            [v(2.0, 0.0, -1.0), v(2.0, 0.3, 2.0)],
        ),
        (
            "ends in the plane beside",
            [v(2.0, 0.1, 0.0), v(2.0, 0.3, 2.0)],
        ),
        (
            "barely in front, beside",
            [v(1.5, 0.1, 1e-7), v(2.0, 0.3, 1e-7)],
        ),
        ("pierces the light", [v(0.1, 0.0, -1.0), v(0.1, 0.1, 2.0)]),
        (
            "touches the light with its end",
            [v(0.1, 0.1, 0.0), v(0.3, 0.2, 2.0)],
        ),
        ("touches a corner", [v(0.5, 0.5, 0.0), v(0.9, 0.5, 2.0)]),
        (
            "lies across the light",
            [v(-2.0, 0.1, 0.0), v(2.0, 0.1, 0.0)],
        ),
        (
            "lies beside the light",
            [v(-2.0, 3.0, 0.0), v(2.0, 3.0, 0.0)],
        ),
        ("behind the light", [v(0.0, 1.0, -1.0), v(0.0, -1.0, -1.0)]),
        ("without length", [v(0.3, 0.2, 2.0), v(0.3, 0.2, 2.0)]),
        (
            "hardly any length",
            [v(0.3, 0.2, 2.0), v(0.3, 0.2 + 1e-13, 2.0)],
        ),
        ("very long", [v(-1e3, 0.2, 2.0), v(1e3, 0.3, 2.5)]),
        (
            "straight over the light, wide",
            [v(-3.0, 0.01, 0.7), v(3.0, 0.01, 0.7)],
        ),
        ("very far", [v(1.0, 2.0, 1e4), v(1.0, 3.0, 1e4)]),
        ("touches the sphere", [v(0.5, -1.0, 0.0), v(0.5, 1.0, 1e-3)]),
    ]
}

/// Wedges of an edge with what must be true of each; the number of penumbra
/// points that lie in none of them, beyond what rounding of the place allows.
fn check(
    construction: Construction,
    kind: Kind,
    place: Place,
    (name, edge): (&str, [DVec3; 2]),
    statistics: &mut WedgeStatistics,
) -> u32 {
    let shape = place.shape(kind);
    let light = AreaLight::new(&shape).unwrap();
    let edge = edge.map(|e| place.point(e));
    let wedges = Wedge::of_edge(construction, &light, edge, statistics);
    let what = format!("{construction:?} {kind:?} {place:?} {name}");
    for wedge in &wedges {
        let mesh = wedge.volume.mesh();
        assert_eq!(mesh.open_edges(), 0, "{what}");
        assert!(mesh.vertices.iter().all(|v| v.is_finite()), "{what}");
        assert!(mesh.positions_f32().iter().flatten().all(|c| c.is_finite()));
        assert!(!wedge.volume.planes().is_empty(), "{what}");
        if let Some(halves) = wedge.halves() {
            assert_eq!(halves.outer.open_edges(), 0, "{what}");
            assert_eq!(halves.inner.open_edges(), 0, "{what}");
        }
    }
    // Per unit of the case; an edge without digits left has a plane without digits.
    let rounding = 1e-10 + 1e-15 * place.offset / place.scale;
    let mut random = Random(31);
    let mut outside = 0;
    for _ in 0..300 {
        let e = edge[0] + (edge[1] - edge[0]) * random.unit();
        let v = light_point(&shape, &mut random);
        let p = e + (e - v) * random.range(0.0, 3.0);
        let lit = light
            .normal()
            .is_none_or(|n| n.dot(e - light.centre()) > 1e-9 * place.scale);
        let clear = kind != Kind::Sphere || (e - light.centre()).length() > 0.5 * place.scale;
        let through_itself = kind == Kind::Sphere && (e - v).dot(v - light.centre()) < 0.0;
        if edge[0] == edge[1] || !lit || !clear || through_itself {
            continue; // the light hides the edge itself
        }
        let reach = (p - e).length() + (e - light.centre()).length();
        let within = |w: &Wedge| w.volume.depth(p) >= -rounding * reach;
        outside += u32::from(!wedges.iter().any(within));
    }
    if outside > 0 {
        eprintln!("{what}: {outside} of 300 outside");
    }
    outside
}

#[test]
fn feared_edges_give_finite_closed_enclosing_wedges() {
    for construction in CONSTRUCTIONS {
        let mut outside = 0;
        let mut total = WedgeStatistics::default();
        for kind in KINDS {
            for place in PLACES {
                for edge in edges() {
                    outside += check(construction, kind, place, edge, &mut total);
                }
            }
        }
        eprintln!("{construction:?}: {outside} outside; {total:?}");
        assert_eq!(outside, 0, "{construction:?}");
        assert_eq!(
            total.edges as usize,
            edges().len() * KINDS.len() * PLACES.len()
        );
        // All that needed care is counted, for every construction.
        // "Hardly any length" is none at all where coordinates are large.
        assert_eq!(total.zero_length, 25);
        assert!(total.behind_light >= 16 && total.in_light_plane >= 16);
        assert!(total.clipped >= 20 && total.touching_light >= 40);
        let built_otherwise = total.aimed_at_centre + total.meets_light;
        assert_eq!(built_otherwise > 0, construction != Construction::Exact);
        assert!(total.stabbing_light > 0);
    }
}

/// Edges accounted for: each gives a wedge, or is counted among those that cast none.
#[test]
fn no_edge_is_lost_in_silence() {
    for (kind, construction) in KINDS.iter().flat_map(|k| CONSTRUCTIONS.map(|c| (*k, c))) {
        let light = AreaLight::new(&PLACES[0].shape(kind)).unwrap();
        for (name, edge) in edges() {
            let mut s = WedgeStatistics::default();
            let wedges = Wedge::of_edge(construction, &light, edge, &mut s);
            let none = s.zero_length + s.behind_light + s.in_light_plane;
            assert_eq!(u64::from(wedges.is_empty()), none, "{kind:?} {name}");
            assert_eq!(wedges.len() as u64, s.wedges);
        }
    }
}

/// A prism through each feared edge: visibility is a number, in 0..=1 where the
/// loop is simple, wherever the receiver.
#[test]
fn coverage_of_feared_edges_is_finite() {
    let mut random = Random(32);
    let mut seen = 0;
    for (kind, place) in KINDS.iter().flat_map(|k| PLACES.map(|p| (*k, p))) {
        let light = LightPlane::new(&place.shape(kind), SphereOutline::Seen).unwrap();
        for (name, edge) in edges() {
            for _ in 0..50 {
                let p = place.point(random.in_box(5.0));
                let ends = edge.map(|e| place.point(e));
                let third = place.point(random.in_box(3.0));
                if let Some(eye) = light.seen_from(p) {
                    let c = eye.coverage(ends);
                    assert!((0.0..=0.5 + 1e-9).contains(&c), "{kind:?} {name} {c}");
                    assert_eq!(
                        light.seen_from(ends[0]).map_or(0.0, |e| e.coverage(ends)),
                        0.0
                    );
                }
                if let Some(v) = loop_visibility(&light, &[ends[0], ends[1], third], p) {
                    seen += 1;
                    assert!(v.is_finite());
                }
            }
        }
    }
    assert!(seen > 1000, "{seen}");
}
