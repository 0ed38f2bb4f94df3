//! How many shadow volumes may lie over one another, bounded from above.
//!
//! Seen from the light, a volume covers the directions of its light cap, and how
//! often it does changes only across its silhouette. Walk along a meridian round the
//! light from a pole N: with M(N) layers there, and at most P silhouette edges that
//! each add one on the way, no direction of the meridian has more than M(N) + P. So
//! the bound is M(N) and the largest P of any meridian: one sweep over the edges,
//! sorted by longitude, whatever number of triangles a layer has. The same with
//! parallel lines where light is parallel; there nothing covers the plane's far end.

use glam::DVec3;

use crate::geometry::volume::ShadowVolume;
use crate::world::light::HardLight;

/// A number of layers that no point behind the volumes' casters exceeds; it may be
/// more than there are.
pub(crate) fn most_layers(light: HardLight, volumes: &[&ShadowVolume]) -> usize {
    let triangles: usize = volumes.iter().map(|v| v.light_cap().len()).sum();
    let chart = Chart::new(light, volumes);
    let at_pole: usize = volumes.iter().map(|v| chart.layers_at_pole(v)).sum();
    let mut crossings = Crossings::default();
    for volume in volumes {
        volume
            .silhouette()
            .for_each(|edge| crossings.add(&chart, edge));
    }
    triangles.min(at_pole + crossings.most())
}

/// Directions from the light by longitude, or places across parallel light.
struct Chart {
    light: HardLight,
    axes: [DVec3; 2],
    pole: DVec3,
}

impl Chart {
    fn new(light: HardLight, volumes: &[&ShadowVolume]) -> Self {
        let pole = match light {
            HardLight::Directional(towards) => towards,
            // Where little casts: away from the casters, and off every axis.
            HardLight::Point(centre) => {
                let away: DVec3 = volumes.iter().map(|v| centre - first_point(v)).sum();
                away.normalize_or(DVec3::Y) + DVec3::new(0.012_3, 0.023_7, 0.031_1)
            }
        };
        let pole = pole.normalize_or(DVec3::Y);
        let (u, v) = pole.any_orthonormal_pair();
        Self {
            light,
            axes: [u, v],
            pole,
        }
    }

    /// Longitude from 0 up to 4, rising with the angle; or a place.
    fn place(&self, p: DVec3) -> f64 {
        match self.light {
            HardLight::Directional(_) => self.axes[0].dot(p),
            HardLight::Point(centre) => {
                let [x, y] = self.axes.map(|a| a.dot(p - centre));
                let turned = y / (x.abs() + y.abs()).max(f64::MIN_POSITIVE);
                match (x >= 0.0, y >= 0.0) {
                    (true, true) => turned,
                    (true, false) => 4.0 + turned,
                    (false, _) => 2.0 - turned,
                }
            }
        }
    }

    /// Whether longitude rises along the shorter way from `a` to `b`.
    fn rises(&self, a: DVec3, b: DVec3) -> bool {
        match self.light {
            HardLight::Directional(_) => self.place(b) > self.place(a),
            HardLight::Point(centre) => {
                let [[ax, ay], [bx, by]] =
                    [a, b].map(|p| self.axes.map(|axis| axis.dot(p - centre)));
                ax * by - ay * bx > 0.0
            }
        }
    }

    fn layers_at_pole(&self, volume: &ShadowVolume) -> usize {
        let HardLight::Point(centre) = self.light else {
            return 0;
        };
        let holds = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|i| point(volume, i) - centre);
            let side = |p: DVec3, q: DVec3| p.cross(q).dot(self.pole) >= 0.0;
            let sides = [side(a, b), side(b, c), side(c, a)];
            (sides == [true; 3] || sides == [false; 3]) && (a + b + c).dot(self.pole) > 0.0
        };
        volume.light_cap().iter().filter(holds).count()
    }
}

/// Stretches of longitude that edges span, those that rise and those that fall.
#[derive(Default)]
struct Crossings([Vec<(f64, i32)>; 2]);

impl Crossings {
    fn add(&mut self, chart: &Chart, [a, b]: [DVec3; 2]) {
        let rises = chart.rises(a, b);
        let [p, q] = [a, b].map(|p| chart.place(p));
        let (from, to) = if rises { (p, q) } else { (q, p) };
        let events = &mut self.0[usize::from(rises)];
        events.extend([(from, 1), (to, -1)]);
        if to < from {
            events.push((f64::NEG_INFINITY, 1)); // round the end of the turn
        }
    }

    /// The most stretches of one kind over one longitude. Ends come before
    /// beginnings, so that edges that meet are not over one another.
    fn most(mut self) -> usize {
        let most_of = |events: &mut Vec<(f64, i32)>| {
            events.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let mut open = 0;
            let counts = events.iter().map(|(_, change)| {
                open += change;
                open
            });
            counts.max().unwrap_or(0).max(0) as usize
        };
        let [falling, rising] = &mut self.0;
        most_of(falling).max(most_of(rising))
    }
}

fn point(volume: &ShadowVolume, index: u32) -> DVec3 {
    let [x, y, z, _] = volume.positions()[index as usize].map(f64::from);
    DVec3::new(x, y, z)
}

fn first_point(volume: &ShadowVolume) -> DVec3 {
    let first = volume.light_cap().first();
    first.map_or(DVec3::ZERO, |t| point(volume, t[0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::caster::Caster;
    use crate::geometry::winding::volume_winding;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::mesh::{Mesh, Shading};
    use crate::world::scene::builtin;
    use crate::world::shape::{self, Shape};
    use proptest::prelude::*;

    fn bound(meshes: &[Mesh], light: HardLight) -> usize {
        let volume = |m: &Mesh| Caster::new(m).volume(m, light);
        let volumes: Vec<ShadowVolume> = meshes.iter().map(volume).collect();
        most_layers(light, &volumes.iter().collect::<Vec<_>>())
    }

    fn plates(count: u32) -> Mesh {
        let plate = |k: u32| {
            let centre = DVec3::Y * (0.01 * f64::from(k));
            shape::cuboid(centre, DVec3::new(1.0, 0.004, 1.0))
        };
        Shape::merged((0..count).map(plate))
            .into_mesh(Shading::Flat)
            .unwrap()
    }

    fn lights_of_all_kinds() -> [HardLight; 3] {
        [
            HardLight::Point(DVec3::new(0.1, 7.0, 0.2)),
            HardLight::Point(DVec3::new(300.0, 7000.0, -200.0)),
            HardLight::Directional(DVec3::new(0.02, 1.0, 0.03)),
        ]
    }

    #[test]
    fn stacks_count_every_plate_and_no_more() {
        for light in lights_of_all_kinds() {
            for count in [1, 2, 127, 128, 255, 256, 300] {
                let exact = count as usize;
                let found = bound(&[plates(count)], light);
                assert!(found >= exact && found <= exact + 1, "{found} for {count}");
            }
        }
    }

    /// Thousands of triangles in one layer, and hundreds of solids side by side.
    #[test]
    fn fine_meshes_and_many_solids_are_no_layers() {
        let ball = shape::icosphere(5, 1.0, DVec3::ZERO)
            .into_mesh(Shading::Smooth)
            .unwrap();
        let field: Vec<Mesh> = (0..900)
            .map(|k| {
                let centre = DVec3::new(f64::from(k % 30), 0.0, f64::from(k / 30));
                shape::cuboid(centre, DVec3::splat(0.5))
                    .into_mesh(Shading::Flat)
                    .unwrap()
            })
            .collect();
        for light in lights_of_all_kinds() {
            assert!(bound(std::slice::from_ref(&ball), light) <= 2, "{light:?}");
            let found = bound(&field, light);
            assert!(found < 64, "{light:?}: {found}");
        }
    }

    /// No plain scene is drawn in another way than by one stencil count.
    #[test]
    fn only_scenes_that_nest_exceed_a_stencil() {
        for entry in builtin::SCENES {
            let scene = entry.build();
            for light in &scene.lights {
                let meshes: Vec<Mesh> = scene.casters().map(|o| (*o.mesh).clone()).collect();
                let found = bound(&meshes, light.hard());
                let nests = ["adversarial", "adversarial-nested-300"].contains(&entry.name);
                assert_eq!(found > 255, nests, "{}: {found}", entry.name);
            }
        }
    }

    proptest! {
        /// Never below what a point is behind: knots, boxes in boxes, triangles
        /// of all kinds round the light.
        #[test]
        fn no_point_is_behind_more(
            soup in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-2.0f32..2.0)), 1..30),
            light in prop::array::uniform3(-3.0f64..3.0),
            directional in any::<bool>(),
            points in prop::collection::vec(prop::array::uniform3(-6.0f64..6.0), 20),
        ) {
            let positions: Vec<[f32; 3]> = soup.iter().flatten().copied().collect();
            let triangles = (0..soup.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
            let mesh = Mesh::new(positions, triangles.collect(), Shading::Flat).unwrap();
            let knot = shape::torus_knot(2, 3, 1.0, 0.4, 0.18, 48, 8, DVec3::ZERO);
            let knot = knot.into_mesh(Shading::Flat).unwrap();
            let light = DVec3::from(light);
            let light = if directional { HardLight::Directional(light) } else { HardLight::Point(light) };
            let generalised = ShadowVolume::generalised(&mesh, &EdgeAdjacency::new(mesh.triangles()), light);
            let closed = Caster::new(&knot).volume(&knot, light);
            for volumes in [vec![&generalised], vec![&closed], vec![&generalised, &closed]] {
                let most = most_layers(light, &volumes);
                for p in &points {
                    let layers: i32 = volumes.iter().map(|v| volume_winding(v, DVec3::from(*p))).sum();
                    prop_assert!(layers <= most as i32, "{} of {}", layers, most);
                }
            }
        }
    }
}
