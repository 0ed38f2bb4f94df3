//! From a silhouette loop to wedges that share their side planes.

use glam::DVec3;

use super::{LinkedWedge, SideDirections, TouchedLight};
use crate::geometry::wedge::Plane;

/// Most extra wedges at one vertex (paper I, figure 7).
pub const MOST_EXTRA: usize = 6;

/// Choices that the paper leaves open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkedSettings {
    /// Edges whose angle with the light's direction has a smaller sine are
    /// collapsed (paper I, §5).
    pub parallel_sine: f64,
    /// Whether acute vertices get extra wedges (§4.1).
    pub extra_wedges: bool,
}

impl Default for LinkedSettings {
    fn default() -> Self {
        Self {
            parallel_sine: 0.02,
            extra_wedges: true,
        }
    }
}

/// What linking met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkedStatistics {
    /// Edges given.
    pub edges: u64,
    /// Wedges made, extra ones included.
    pub wedges: u64,
    /// Extra wedges at acute vertices.
    pub extra_wedges: u64,
    /// Edges collapsed because they are nearly parallel to the light's direction.
    pub nearly_parallel: u64,
    /// Edges dropped because both ends are equal.
    pub zero_length: u64,
    /// Edges dropped because they have no hard shadow quad: they point at the
    /// light's centre to the last digit.
    pub aimed_at_centre: u64,
    /// Wedges whose side planes meet in front or back plane.
    pub overlapping_sides: u64,
    /// Wedges left out because no side plane exists that could bound them: two planes
    /// are parallel, or neighbours are so steep against each other that a shared ray
    /// leaves the edge towards the light.
    pub without_sides: u64,
    /// Loops of which less than two edges were left.
    pub dropped_loops: u64,
}

/// An edge, or a turn at a vertex, before its sides are known.
struct Part {
    edge: [DVec3; 2],
    along: DVec3,
    outer: DVec3,
    front: Plane,
    back: Plane,
    /// Points of the two planes at the light.
    touched: [DVec3; 2],
}

/// The wedges of one closed silhouette loop of points, directed as silhouettes
/// are, in the loop's order, for a spherical light. Consecutive wedges, and the
/// last with the first, share their side plane to the bit, but where
/// `statistics` counts gaps.
pub fn link(
    points: &[DVec3],
    centre: DVec3,
    radius: f64,
    settings: &LinkedSettings,
    statistics: &mut LinkedStatistics,
) -> Vec<LinkedWedge> {
    let light = TouchedLight::sphere(centre, radius);
    link_under(points, &light, settings, statistics)
}

/// The same for a light that front and back planes touch.
pub fn link_under(
    points: &[DVec3],
    light: &TouchedLight,
    settings: &LinkedSettings,
    statistics: &mut LinkedStatistics,
) -> Vec<LinkedWedge> {
    let centre = light.centre;
    statistics.edges += points.len() as u64;
    let points = collapse(points, centre, settings, statistics);
    let parts = parts(&points, light, settings, statistics);
    if parts.len() < 2 {
        statistics.dropped_loops += 1;
        return Vec::new();
    }
    let n = parts.len();
    let joints: Vec<Joint> = (0..n)
        .map(|k| Joint::new(&parts[k], &parts[(k + 1) % n], centre))
        .collect();
    let mut wedges = Vec::with_capacity(n);
    for (k, part) in parts.iter().enumerate() {
        match part.between(&joints[(k + n - 1) % n], &joints[k]) {
            Some(wedge) => wedges.push(wedge),
            None => statistics.without_sides += 1,
        }
    }
    statistics.wedges += wedges.len() as u64;
    let overlapping = wedges.iter().filter(|w| w.overlap().is_some());
    statistics.overlapping_sides += overlapping.count() as u64;
    wedges
}

/// Collapses edges without length and, one after the other in the loop's order,
/// those that are nearly parallel to the light's direction.
fn collapse(
    points: &[DVec3],
    centre: DVec3,
    settings: &LinkedSettings,
    statistics: &mut LinkedStatistics,
) -> Vec<DVec3> {
    let mut points = points.to_vec();
    let mut k = 0;
    while k < points.len() && points.len() > 1 {
        let next = (k + 1) % points.len();
        let (a, b) = (points[k], points[next]);
        let towards = (centre - 0.5 * (a + b)).normalize_or_zero();
        if a == b {
            statistics.zero_length += 1;
        } else if (b - a).normalize().cross(towards).length() < settings.parallel_sine {
            statistics.nearly_parallel += 1;
            points[k] = 0.5 * (a + b);
        } else {
            k += 1;
            continue;
        }
        points.remove(next);
        k = k.saturating_sub(1); // the edge before has a new end
    }
    points
}

fn parts(
    points: &[DVec3],
    light: &TouchedLight,
    settings: &LinkedSettings,
    statistics: &mut LinkedStatistics,
) -> Vec<Part> {
    let n = points.len();
    let mut edges = Vec::new();
    for k in 0..n {
        match Part::of_edge([points[k], points[(k + 1) % n]], light) {
            Some(part) => edges.push(part),
            None => statistics.aimed_at_centre += 1,
        }
    }
    if !settings.extra_wedges {
        return edges;
    }
    let mut out = Vec::new();
    let count = edges.len();
    let turns: Vec<Vec<Part>> = (0..count)
        .map(|k| turn(&edges[k], &edges[(k + 1) % count], light))
        .collect();
    for (edge, turn) in edges.into_iter().zip(turns) {
        statistics.extra_wedges += turn.len() as u64;
        out.push(edge);
        out.extend(turn);
    }
    out
}

/// The extra wedges between two edges that meet at an acute convex vertex.
fn turn(before: &Part, after: &Part, light: &TouchedLight) -> Vec<Part> {
    let centre = light.centre;
    let vertex = before.edge[1];
    if vertex != after.edge[0] {
        return Vec::new(); // an edge between them was left out
    }
    let Some(axis) = (vertex - centre).try_normalize() else {
        return Vec::new();
    };
    // Positive where the occluder's corner is convex: the silhouette turns left
    // as the light sees it, looking along the axis.
    let angle = libm::atan2(
        before.outer.cross(after.outer).dot(-axis),
        before.outer.dot(after.outer),
    );
    let quarter = std::f64::consts::FRAC_PI_2;
    let extra = (MOST_EXTRA as f64 * (angle - quarter) / quarter)
        .ceil()
        .max(0.0) as usize;
    let step = angle / (extra + 1) as f64;
    let across = before.outer.cross(axis);
    let outer = |k: usize| {
        let t = step * k as f64;
        (before.outer * libm::cos(t) + across * libm::sin(t)).normalize()
    };
    (1..=extra)
        .filter_map(|k| Part::at_vertex(vertex, outer(k), light))
        .collect()
}

impl Part {
    fn of_edge([a, b]: [DVec3; 2], light: &TouchedLight) -> Option<Self> {
        let along = (b - a).normalize();
        let outer = along.cross(light.centre - a).try_normalize()?;
        Self::new([a, b], along, outer, light)
    }

    fn at_vertex(vertex: DVec3, outer: DVec3, light: &TouchedLight) -> Option<Self> {
        // As for edges: along x (centre - vertex) points along outer.
        let along = (light.centre - vertex).cross(outer).try_normalize()?;
        Self::new([vertex; 2], along, outer, light)
    }

    fn new(edge: [DVec3; 2], along: DVec3, outer: DVec3, light: &TouchedLight) -> Option<Self> {
        let away = |light: DVec3| edge[0] - light;
        let [f, b] = light.touched(edge[0], along, outer);
        Some(Self {
            touched: [f, b],
            edge,
            along,
            outer,
            front: Plane::spanned(edge[0], along, away(f))?,
            back: Plane::spanned(edge[0], away(b), along)?,
        })
    }

    fn between(&self, first: &Joint, second: &Joint) -> Option<LinkedWedge> {
        let falls = |joint: &Joint| {
            let to_front = self.along.cross(joint.front_ray);
            let to_back = joint.back_ray.cross(self.along);
            to_front.dot(self.front.normal) > 0.0 && to_back.dot(self.back.normal) > 0.0
        };
        if !(falls(first) && falls(second)) {
            return None;
        }
        // The joint's plane is positive towards the wedge after it.
        Some(LinkedWedge {
            edge: self.edge,
            along: self.along,
            outer: self.outer,
            front: self.front,
            back: self.back,
            sides: [first.side?, second.side?.reversed()],
            front_rays: [first.front_ray, second.front_ray],
            back_rays: [first.back_ray, second.back_ray],
            side_directions: SideDirections([first.direction, second.direction]),
        })
    }
}

/// What two neighbours share.
struct Joint {
    side: Option<Plane>,
    front_ray: DVec3,
    back_ray: DVec3,
    direction: DVec3,
}

impl Joint {
    fn new(before: &Part, after: &Part, centre: DVec3) -> Self {
        let vertex = after.edge[0];
        let ray = |p: &Plane, q: &Plane, side: usize| {
            let beside = 0.5 * (before.touched[side] + after.touched[side]);
            common_ray(p.normal, q.normal, vertex - beside, vertex - centre)
        };
        let front_ray = ray(&before.front, &after.front, 0);
        let back_ray = ray(&before.back, &after.back, 1);
        let side = Plane::spanned(vertex, front_ray, back_ray);
        let mean = 0.5 * (before.outer + after.outer);
        let normal = side.map_or(DVec3::ZERO, |s| s.normal);
        let flat = |d: DVec3| d - normal * normal.dot(d);
        let direction = flat(mean)
            .try_normalize()
            .unwrap_or_else(|| flat(before.outer).normalize_or_zero());
        Self {
            side,
            front_ray,
            back_ray,
            direction,
        }
    }
}

/// The unit ray in two planes, away from the light; `if_equal` where they
/// coincide.
fn common_ray(p: DVec3, q: DVec3, if_equal: DVec3, away: DVec3) -> DVec3 {
    const EQUAL: f64 = 1e-9;
    let ray = p.cross(q);
    if ray.length() < EQUAL {
        return if_equal.normalize_or_zero();
    }
    let ray = ray.normalize();
    if ray.dot(away) < 0.0 { -ray } else { ray }
}
