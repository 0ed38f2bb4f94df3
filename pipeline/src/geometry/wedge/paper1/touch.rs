//! Where front and back planes touch a light.

use glam::DVec3;

/// The light that wedges are built for.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchedLight {
    /// Its centre, which silhouettes are seen from.
    pub centre: DVec3,
    /// Radius of the sphere that planes pass beside the centre of (paper I, §4.1).
    pub radius: f64,
    /// Corners of a convex light; planes are turned until they touch it on opposite sides
    /// (paper I, §8). Empty for spheres.
    pub corners: Vec<DVec3>,
}

impl TouchedLight {
    /// A sphere.
    pub fn sphere(centre: DVec3, radius: f64) -> Self {
        Self {
            centre,
            radius,
            corners: Vec::new(),
        }
    }

    /// Points of front and back plane through an edge at `point`, whose hard quad has the
    /// normal `outer` and holds the light's centre.
    pub(super) fn touched(&self, point: DVec3, along: DVec3, outer: DVec3) -> [DVec3; 2] {
        let beside = [-self.radius, self.radius].map(|r| self.centre + outer * r);
        // Square to the edge, towards the light.
        let up = outer.cross(along);
        let up = if up.dot(self.centre - point) < 0.0 {
            -up
        } else {
            up
        };
        let turned = |c: &DVec3| libm::atan2((*c - point).dot(outer), (*c - point).dot(up));
        let mut ends: Option<[(f64, DVec3); 2]> = None;
        for corner in &self.corners {
            let at = (turned(corner), *corner);
            let [least, greatest] = ends.unwrap_or([at; 2]);
            ends = Some([
                if at.0 < least.0 { at } else { least },
                if at.0 > greatest.0 { at } else { greatest },
            ]);
        }
        ends.map_or(beside, |ends| ends.map(|(_, corner)| corner))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{LinkedSettings, LinkedStatistics, link_under};
    use super::*;

    /// Both planes of every wedge have all of the light on one side, and touch it.
    #[test]
    fn turned_planes_touch_opposite_sides_of_a_convex_light() {
        let corners = [[-0.8, -0.3], [0.9, -0.4], [0.7, 0.5], [-0.6, 0.4]];
        let corners: Vec<DVec3> = corners.map(|[x, z]| DVec3::new(x, 4.0, z)).to_vec();
        let light = TouchedLight {
            centre: DVec3::new(0.05, 4.0, 0.05),
            radius: 0.5,
            corners,
        };
        let occluder = [[-0.5, 0.4], [0.6, 0.5], [0.5, -0.6], [-0.4, -0.5]];
        let occluder: Vec<DVec3> = occluder.map(|[x, z]| DVec3::new(x, 1.0, z)).to_vec();
        let settings = LinkedSettings {
            extra_wedges: false,
            ..LinkedSettings::default()
        };
        let wedges = link_under(
            &occluder,
            &light,
            &settings,
            &mut LinkedStatistics::default(),
        );
        assert_eq!(wedges.len(), 4);
        for wedge in wedges {
            for plane in [wedge.front, wedge.back] {
                let sides = light.corners.iter().map(|c| plane.distance(*c));
                let [least, most] = sides.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, m], d| {
                    [l.min(d), m.max(d)]
                });
                let touches = least.abs() < 1e-12 || most.abs() < 1e-12;
                assert!(touches && least * most < 1e-12, "{least} {most}");
            }
            // A sphere's planes would cut the light.
            let sphere = TouchedLight::sphere(light.centre, light.radius);
            let own = [&light, &sphere].map(|l| l.touched(wedge.edge[0], wedge.along, wedge.outer));
            assert!(own[0] != own[1]);
        }
    }
}
