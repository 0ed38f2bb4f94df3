//! Area lights as shaders project edges on them.

use glam::DVec3;
use gnomon_shaders::coverage::{Edge, FlatLight, Image, Projector, SphereLight};

use crate::geometry::area_light::AreaLight;
use crate::parts::passes::View;
use crate::technique::TechniqueError;
use crate::world::light::{HardLight, Light, LightShape};
use crate::world::mesh::narrow;

/// A light for wedges and for shaders: flat lights once for each side.
pub(crate) struct SoftLight {
    /// Where hard shadow quads start, world space.
    pub(crate) centre: DVec3,
    /// Sides to which it shines; none for lights without area.
    pub(crate) sides: Vec<LightSide>,
}

/// One side of a flat light, or all of a sphere.
pub(crate) struct LightSide {
    /// For wedges, world space.
    pub(crate) area: AreaLight,
    /// For shaders, relative to the view's origin.
    pub(crate) projector: Projector,
    /// Rows that take a point relative to the centre to the projector's
    /// coordinates.
    rows: [DVec3; 3],
}

impl SoftLight {
    /// The light numbered `number`; points are lights without sides, and cast
    /// hard shadows. A sphere is seen as large as it looks, or of its own radius.
    pub(crate) fn new(
        technique: &'static str,
        light: &Light,
        number: usize,
        view: &View,
        seen: bool,
    ) -> Result<Self, TechniqueError> {
        let refused = |why: String| TechniqueError::UnsuitableLight {
            technique,
            light: number,
            why,
            valid: "rectangles, discs, spheres, and points for hard shadows",
        };
        let HardLight::Point(centre) = light.hard() else {
            return Err(refused("it is directional".to_owned()));
        };
        let rows = match light.shape {
            LightShape::Point { .. } => {
                let sides = Vec::new();
                return Ok(Self { centre, sides });
            }
            LightShape::Rectangle { edge_u, edge_v, .. } => square_rows(edge_u, edge_v),
            LightShape::Disc { normal, radius, .. } => disc_rows(normal, radius),
            LightShape::Sphere { .. } => [DVec3::X, DVec3::Y, DVec3::Z],
            _ => return Err(refused("it is a polygon".to_owned())),
        };
        let area = AreaLight::new(&light.shape).map_err(|e| refused(e.to_string()))?;
        let at = narrow(view.relative(centre));
        let image = match light.shape {
            LightShape::Rectangle { .. } => Image::Square,
            _ => Image::Disc,
        };
        let flat = |rows: [DVec3; 3], area: AreaLight| LightSide {
            area,
            projector: Projector::Flat(FlatLight {
                centre: at,
                axes: rows.map(narrow),
                image,
            }),
            rows,
        };
        let sides = match area {
            AreaLight::Sphere { radius, .. } => vec![LightSide {
                area,
                projector: Projector::Sphere(SphereLight {
                    centre: at,
                    radius: radius as f32,
                    seen,
                }),
                rows,
            }],
            area => {
                let [u, v, n] = rows;
                let other = area.clone().reversed();
                vec![flat(rows, area), flat([u, v, -n], other)]
            }
        };
        Ok(Self { centre, sides })
    }
}

impl LightSide {
    /// A world-space edge in the projector's coordinates, rounded once.
    pub(crate) fn edge(&self, ends: [DVec3; 2]) -> Edge {
        let centre = self.area.centre();
        ends.map(|e| narrow(DVec3::from_array(self.rows.map(|r| r.dot(e - centre)))))
    }
}

/// A rectangle as `k` x `k` lights of equal size and the same colour (paper IV,
/// §5.2); any light for k = 1.
pub(crate) fn split(
    technique: &'static str,
    light: &Light,
    number: usize,
    k: u32,
) -> Result<Vec<Light>, TechniqueError> {
    if k == 1 {
        return Ok(vec![light.clone()]);
    }
    let LightShape::Rectangle {
        centre,
        edge_u,
        edge_v,
    } = light.shape
    else {
        return Err(TechniqueError::UnsuitableLight {
            technique,
            light: number,
            why: format!("it cannot be split into {k} x {k}"),
            valid: "rectangles for split above 1",
        });
    };
    let n = f64::from(k);
    let place = |i: u32| (f64::from(i) + 0.5) / n - 0.5;
    let part = |i: u32, j: u32| Light {
        shape: LightShape::Rectangle {
            centre: centre + edge_u * place(i) + edge_v * place(j),
            edge_u: edge_u / n,
            edge_v: edge_v / n,
        },
        colour: light.colour,
    };
    Ok((0..k)
        .flat_map(|j| (0..k).map(move |i| part(i, j)))
        .collect())
}

/// Covectors that take the corners of a rectangle to (±1, ±1), and its unit normal.
fn square_rows(edge_u: DVec3, edge_v: DVec3) -> [DVec3; 3] {
    let (u, v) = (0.5 * edge_u, 0.5 * edge_v);
    let normal = u.cross(v);
    let squared = normal.length_squared();
    [
        v.cross(normal) / squared,
        normal.cross(u) / squared,
        normal / squared.sqrt(),
    ]
}

fn disc_rows(normal: DVec3, radius: f64) -> [DVec3; 3] {
    let normal = normal.normalize_or(DVec3::Z);
    let (u, v) = normal.any_orthonormal_pair();
    [u / radius, v / radius, normal / radius]
}
