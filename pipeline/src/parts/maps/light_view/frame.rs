//! Where a light is seen from: its centre, axes and extent, in f64.

use glam::DVec3;
use gnomon_shaders::light_view::Projection;

use super::surroundings::Surroundings;
use crate::geometry::area_light::AreaLight;
use crate::technique::TechniqueError;
use crate::world::light::{HardLight, Light, LightShape};

/// Distance over extent in depth of what is lit, beyond which a light is far away:
/// numbers are then relative to what is lit, for distances from the light leave them
/// too few digits.
pub(super) const FAR_AWAY: f64 = 16.0;

/// A point of a light with orthonormal axes, world space: right, down and along
/// the axis of a view; right × down = along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightFrame {
    pub(crate) centre: DVec3,
    pub(crate) axes: [DVec3; 3],
    /// Orthographic: the centre is any point before all that matters.
    pub(crate) projection: Projection,
}

impl LightFrame {
    /// Coordinates of a world-space point: right, down, and planar distance.
    pub(crate) fn local(&self, p: DVec3) -> DVec3 {
        let from = p - self.centre;
        DVec3::from_array(self.axes.map(|a| a.dot(from)))
    }

    /// The same seen from another point.
    pub(crate) fn at(self, centre: DVec3) -> Self {
        Self { centre, ..self }
    }

    /// Turned about the right axis to look the other way.
    pub(crate) fn reversed(self) -> Self {
        let [right, down, along] = self.axes;
        Self {
            axes: [right, -down, -along],
            ..self
        }
    }

    /// The six faces of a cube round the centre. Their axes are this frame's up to
    /// sign and order, so that comparisons of coordinates agree between faces to
    /// the bit.
    pub(crate) fn faces(self) -> [Self; 6] {
        let [x, y, z] = self.axes;
        let face = |right: DVec3, down: DVec3, along: DVec3| Self {
            axes: [right, down, along],
            ..self
        };
        [
            face(x, y, z),
            face(x, -y, -z),
            face(-z, y, x),
            face(z, y, -x),
            face(x, -z, y),
            face(x, z, -y),
        ]
    }
}

/// How far a light reaches from its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LightExtent {
    /// A point.
    None,
    /// A parallelogram with these half edges, or what stands for a flat light: a
    /// square of the same area.
    Flat([DVec3; 2]),
    /// A ball; the half side of the square whose area it shows.
    Ball(f64),
}

impl LightExtent {
    /// Half width along a unit vector, world units.
    pub(crate) fn half_along(&self, axis: DVec3) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Flat(edges) => edges.iter().map(|e| e.dot(axis).abs()).sum(),
            Self::Ball(half) => *half,
        }
    }
}

/// A light as views are taken from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ViewedLight {
    /// Flat lights: along is their normal. Others: the world's axes.
    pub(crate) frame: LightFrame,
    pub(crate) extent: LightExtent,
}

impl ViewedLight {
    /// The scene's light of that number, for an error that names it.
    ///
    /// # Errors
    /// It has no place or direction, or no area where it should.
    pub(crate) fn new(
        technique: &'static str,
        light: &Light,
        number: usize,
    ) -> Result<Self, TechniqueError> {
        let refused = |why: String| TechniqueError::UnsuitableLight {
            technique,
            light: number,
            why,
            valid: "points, directions, rectangles, discs, spheres and polygons",
        };
        let centre = match light.hard() {
            HardLight::Point(centre) => centre,
            HardLight::Directional(towards) => {
                let frame = along_direction(towards);
                let why = || refused(format!("its direction is {towards}"));
                return Ok(Self {
                    frame: frame.ok_or_else(why)?,
                    extent: LightExtent::None,
                });
            }
        };
        if !centre.is_finite() {
            return Err(refused(format!("its centre is {centre}")));
        }
        if !matches!(light.shape, LightShape::Point { .. }) {
            AreaLight::new(&light.shape).map_err(|e| refused(e.to_string()))?;
        }
        let (axes, extent) = axes_and_extent(&light.shape);
        let projection = Projection::Perspective;
        let frame = LightFrame {
            centre,
            axes,
            projection,
        };
        Ok(Self { frame, extent })
    }

    /// Whether it has no place, or is far away from what is lit.
    pub(crate) fn is_far(&self, around: &Surroundings<'_>) -> bool {
        self.frame.projection == Projection::Orthographic || self.far_middle(around).is_some()
    }

    /// A point near the light, or near what is lit where the light is far.
    pub(crate) fn reference(&self, around: &Surroundings<'_>) -> DVec3 {
        let middle = match self.frame.projection {
            Projection::Perspective => self.far_middle(around),
            Projection::Orthographic => around.middle(),
        };
        middle.unwrap_or(self.frame.centre)
    }

    /// The middle of what is lit, if the light's centre is far away from it.
    fn far_middle(&self, around: &Surroundings<'_>) -> Option<DVec3> {
        let middle = around.middle()?;
        let distance = (middle - self.frame.centre).length();
        (distance > FAR_AWAY * around.radius(middle)).then_some(middle)
    }
}

/// The frame of a light from a direction; its centre is still to be found.
fn along_direction(towards: DVec3) -> Option<LightFrame> {
    let along = -towards.try_normalize()?;
    Some(LightFrame {
        centre: DVec3::ZERO,
        axes: axes_of(along.any_orthonormal_vector(), along),
        projection: Projection::Orthographic,
    })
}

/// Half the side of a square as large as a unit disc.
pub(super) const SQUARE_OF_DISC: f64 = 0.886_226_925_452_758;

fn axes_and_extent(shape: &LightShape) -> ([DVec3; 3], LightExtent) {
    let square = |[right, down, along]: [DVec3; 3], half: f64| {
        let extent = LightExtent::Flat([right * half, down * half]);
        ([right, down, along], extent)
    };
    match shape {
        LightShape::Rectangle { edge_u, edge_v, .. } => {
            let axes = axes_of(*edge_u, edge_u.cross(*edge_v));
            (axes, LightExtent::Flat([*edge_u * 0.5, *edge_v * 0.5]))
        }
        LightShape::Disc { normal, radius, .. } => {
            let right = normal.any_orthogonal_vector();
            square(axes_of(right, *normal), radius * SQUARE_OF_DISC)
        }
        LightShape::Polygon(polygon) => {
            let area = polygon.area_vector();
            let v = polygon.vertices();
            let longest = v
                .windows(2)
                .map(|e| e[1] - e[0])
                .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
            let right = longest.unwrap_or(DVec3::X);
            square(axes_of(right, area), area.length().sqrt() / 2.0)
        }
        LightShape::Sphere { radius, .. } => {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            (axes, LightExtent::Ball(radius * SQUARE_OF_DISC))
        }
        LightShape::Point { .. } | LightShape::Directional { .. } => {
            ([DVec3::X, DVec3::Y, DVec3::Z], LightExtent::None)
        }
    }
}

/// Right, down, along from directions of any length that are not parallel.
pub(super) fn axes_of(right: DVec3, along: DVec3) -> [DVec3; 3] {
    let along = along.normalize();
    let right = (right - along * along.dot(right)).normalize();
    [right, along.cross(right), along]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn viewed(shape: LightShape) -> ViewedLight {
        let colour = [1.0; 3];
        ViewedLight::new("test", &Light { shape, colour }, 0).unwrap()
    }

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        let lights = [
            Light::horizontal_square(DVec3::Y, 2.0).shape,
            LightShape::Disc {
                centre: DVec3::X,
                normal: DVec3::new(0.3, -2.0, 0.1),
                radius: 1.0,
            },
            LightShape::Sphere {
                centre: DVec3::X,
                radius: 1.0,
            },
        ];
        for shape in lights {
            let frame = viewed(shape).frame;
            let all = frame.faces().into_iter().chain([frame.reversed()]);
            for LightFrame { axes, .. } in all {
                let [r, d, a] = axes;
                assert!((r.cross(d) - a).length() < 1e-12, "{axes:?}");
                assert!((r.length() - 1.0).abs() < 1e-12 && r.dot(d).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_rectangle_is_as_wide_as_its_edges() {
        let light = viewed(LightShape::Rectangle {
            centre: DVec3::ZERO,
            edge_u: DVec3::X * 3.0,
            edge_v: DVec3::Z,
        });
        let halves = light.frame.axes.map(|a| light.extent.half_along(a));
        assert_eq!(halves, [1.5, 0.5, 0.0]);
    }

    #[test]
    fn a_disc_is_a_square_of_its_area() {
        let light = viewed(LightShape::Disc {
            centre: DVec3::ZERO,
            normal: DVec3::Y,
            radius: 2.0,
        });
        let side = 2.0 * light.extent.half_along(light.frame.axes[0]);
        assert!((side * side - 4.0 * std::f64::consts::PI).abs() < 1e-9);
    }

    #[test]
    fn directional_lights_need_a_direction() {
        let sun = |towards| LightShape::Directional { towards };
        let frame = viewed(sun(DVec3::new(0.0, 3.0, 0.0))).frame;
        assert_eq!(frame.projection, Projection::Orthographic);
        assert_eq!(frame.axes[2], DVec3::NEG_Y);
        for towards in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            let light = Light {
                shape: sun(towards),
                colour: [1.0; 3],
            };
            let message = ViewedLight::new("pcf", &light, 2).unwrap_err().to_string();
            assert!(
                message.contains("light 2") && message.contains("direction is"),
                "{message}"
            );
        }
    }
}
