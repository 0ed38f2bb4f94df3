//! Area lights as shaders project edges on them.

use glam::DVec3;
use gnomon_shaders::coverage::{
    Edge, FlatLight, Image, MAX_CORNERS, Outline, Projector, SphereLight,
};
use gnomon_shaders::soft_volumes::HardPlane;

use super::edges::SoftEdge;
use super::table::polygon_image;
use crate::geometry::area_light::AreaLight;
use crate::parts::passes::View;
use crate::technique::TechniqueError;
use crate::world::light::{ConvexPolygon, HardLight, Light, LightShape};
use crate::world::mesh::{narrow, widen};

/// A light for wedges and for shaders: flat lights once for each side.
pub(crate) struct SoftLight {
    /// Where hard shadow quads start, world space.
    pub(crate) centre: DVec3,
    /// Sides to which it shines; none for lights without area.
    pub(crate) sides: Vec<LightSide>,
    /// What shaders take positions relative to, world space: the centre or, of a far
    /// light, a place in front of the camera.
    origin: DVec3,
    is_far: bool,
}

/// A light so many times farther than the camera looks, or than the casters are large,
/// is far: positions relative to its centre would lose digits.
const FAR: f64 = 64.0;

/// One side of a flat light, or all of a sphere.
pub(crate) struct LightSide {
    /// For wedges, world space.
    pub(crate) area: AreaLight,
    /// For shaders, relative to the view's origin.
    pub(crate) projector: Projector,
    /// Rows that take a point relative to the centre to the projector's
    /// coordinates.
    rows: [DVec3; 3],
    /// What edges are relative to.
    origin: DVec3,
}

impl SoftLight {
    /// The light numbered `number`; points are lights without sides, and cast
    /// hard shadows. A sphere is `seen` as large as it looks, or of its own radius. The
    /// light is near or far for casters of the size `casters`.
    pub(crate) fn new(
        technique: &'static str,
        light: &Light,
        number: usize,
        view: &View,
        casters: f64,
        seen: bool,
    ) -> Result<Self, TechniqueError> {
        let refused = |why: String| TechniqueError::UnsuitableLight {
            technique,
            light: number,
            why,
            valid: "rectangles, discs, spheres, convex polygons of up to 16 corners, and points \
                    for hard shadows",
        };
        let HardLight::Point(centre) = light.hard() else {
            return Err(refused("it is directional".to_owned()));
        };
        let (origin, is_far) = light_origin(view, centre, casters);
        let mut soft = Self {
            centre,
            sides: Vec::new(),
            origin,
            is_far,
        };
        // Its corners are one point, or no lengths of f32 apart.
        let least = f64::EPSILON * centre.abs().max_element();
        if extent(&light.shape) <= least.max(f64::from(f32::MIN_POSITIVE)) {
            return Ok(soft);
        }
        let rows = match &light.shape {
            LightShape::Point { .. } | LightShape::Directional { .. } => return Ok(soft),
            LightShape::Rectangle { edge_u, edge_v, .. } => square_rows(*edge_u, *edge_v),
            LightShape::Disc { normal, radius, .. } => disc_rows(*normal, *radius),
            LightShape::Sphere { .. } => [DVec3::X, DVec3::Y, DVec3::Z],
            LightShape::Polygon(polygon) => disc_rows(polygon.area_vector(), extent(&light.shape)),
        };
        let area = AreaLight::new(&light.shape).map_err(|e| refused(e.to_string()))?;
        let at = narrow(view.relative(origin));
        let from_centre = |rows: [DVec3; 3]| {
            let offset = rows.map(|r| r.dot(origin - centre));
            is_far.then(|| narrow(DVec3::from_array(offset)))
        };
        let image = match &light.shape {
            LightShape::Rectangle { .. } => Image::Square,
            LightShape::Polygon(polygon) => {
                let corners = polygon.vertices().len();
                let outline = outline(polygon, rows);
                Image::Polygon(outline.ok_or_else(|| refused(format!("it has {corners} corners")))?)
            }
            _ => Image::Disc,
        };
        let flat = |rows: [DVec3; 3], area: AreaLight| LightSide {
            area,
            projector: Projector::Flat(FlatLight {
                origin: at,
                far: from_centre(rows),
                axes: rows.map(narrow),
                image,
            }),
            rows,
            origin,
        };
        soft.sides = match area {
            AreaLight::Sphere { radius, .. } => vec![LightSide {
                area,
                projector: Projector::Sphere(SphereLight {
                    origin: at,
                    far: from_centre(rows),
                    radius: radius as f32,
                    seen,
                }),
                rows,
                origin,
            }],
            area => {
                let [u, v, n] = rows;
                let other = area.clone().reversed();
                vec![flat(rows, area), flat([u, v, -n], other)]
            }
        };
        Ok(soft)
    }

    /// What shaders take positions relative to, relative to the view's origin.
    pub(crate) fn shader_origin(&self, view: &View) -> [f32; 3] {
        narrow(view.relative(self.origin))
    }

    /// Whether hard planes have an offset.
    pub(crate) fn is_far(&self) -> bool {
        self.is_far
    }

    /// The plane of an edge as shaders have it.
    pub(crate) fn plane(&self, edge: &SoftEdge) -> HardPlane {
        let offset = || widen(edge.normal).dot(self.origin - edge.ends[0]);
        HardPlane {
            normal: edge.normal,
            // Through the centre; a far one is nothing to take differences from.
            offset: if self.is_far { offset() as f32 } else { 0.0 },
        }
    }
}

/// The centre, or a place in the scene if that is far; and whether it is.
pub(crate) fn light_origin(view: &View, centre: DVec3, casters: f64) -> (DVec3, bool) {
    let camera = view.camera();
    let looks = camera.target - camera.eye;
    let scale = looks.length().min(casters);
    if (centre - camera.eye).length() <= FAR * scale {
        return (centre, false);
    }
    // As shaders have it, to the bit.
    let seen = camera.eye + looks.normalize_or_zero() * scale;
    let place = widen(narrow(view.relative(seen)));
    (view.absolute(place), true)
}

/// The length of the light's shape.
fn extent(shape: &LightShape) -> f64 {
    match shape {
        LightShape::Rectangle { edge_u, edge_v, .. } => edge_u.length().max(edge_v.length()),
        LightShape::Disc { radius, .. } | LightShape::Sphere { radius, .. } => *radius,
        LightShape::Polygon(polygon) => {
            let centre = polygon.centroid();
            let away = polygon.vertices().iter().map(|v| (*v - centre).length());
            away.fold(0.0, f64::max)
        }
        LightShape::Point { .. } | LightShape::Directional { .. } => f64::INFINITY,
    }
}

impl LightSide {
    /// A world-space edge in the projector's coordinates, rounded once.
    pub(crate) fn edge(&self, ends: [DVec3; 2]) -> Edge {
        ends.map(|e| narrow(DVec3::from_array(self.rows.map(|r| r.dot(e - self.origin)))))
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

/// A polygon in the light's coordinates; `None` where it has too many corners.
fn outline(polygon: &ConvexPolygon, [u, v, _]: [DVec3; 3]) -> Option<Outline> {
    let centre = polygon.centroid();
    let place = |p: &DVec3| [u, v].map(|row| row.dot(*p - centre) as f32);
    let mut corners = [[0.0; 2]; MAX_CORNERS];
    let vertices = polygon.vertices();
    for (to, vertex) in corners.get_mut(..vertices.len())?.iter_mut().zip(vertices) {
        *to = place(vertex);
    }
    let outline = Outline {
        area: 0.0,
        count: vertices.len() as u32,
        corners,
    };
    Some(Outline {
        area: polygon_image(&outline).area() as f32,
        ..outline
    })
}

fn disc_rows(normal: DVec3, radius: f64) -> [DVec3; 3] {
    let normal = normal.normalize_or(DVec3::Z);
    let (u, v) = normal.any_orthonormal_pair();
    [u / radius, v / radius, normal / radius]
}
