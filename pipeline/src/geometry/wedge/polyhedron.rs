//! The shape that all wedges share: a convex polyhedron between the cones at
//! two ends of an edge, open towards infinity.
//!
//! ```text
//!        e0 ------- e1          apexes
//!       /|  front   |\
//!      / |          | \         rays run from the front (outer, lit) side
//!     r0 r1 ... s1 s0 ...       to the back (inner, umbra) side
//! ```
//!
//! Front and back faces hold the edge; each end is closed by the faces between
//! its consecutive rays; the far end is closed at infinity. Seen along the edge's
//! direction with the light above, the outer side is `(e1 - e0) x (light - e0)`.
//! That fixes the orientation of every face combinatorially, and so each mesh is
//! closed whatever the rounding.

use glam::DVec3;

use super::mesh::WedgeMesh;
use super::plane::Plane;

/// An apex and the rays that run from it to infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// End of the (perhaps relocated) edge.
    pub apex: DVec3,
    /// Unit directions. At the first end `r[i] x r[i+1]` points into the wedge,
    /// at the second out of it.
    pub rays: Vec<DVec3>,
}

/// The ends of a wedge.
#[derive(Clone, Debug, PartialEq)]
pub enum Ends {
    /// Cones at both ends, joined by a front and a back face; rays from front to
    /// back.
    Two([End; 2]),
    /// One cone holds the other: a pyramid with rays in a ring, `r[i] x r[i+1]`
    /// pointing inwards.
    One(End),
    /// All that lies before a plane: the light touches the edge.
    HalfSpace(Plane),
}

/// A convex polyhedron that reaches to infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    ends: Ends,
    planes: Vec<Plane>,
}

impl Polyhedron {
    /// The polyhedron between the ends; rays of no length are dropped. An end
    /// without rays takes those of the other; without any it is no volume: no
    /// planes, no mesh.
    pub fn new(ends: Ends) -> Self {
        let ends = normalised(ends);
        let planes = planes(&ends).into_iter().flatten().collect();
        Self { ends, planes }
    }

    /// Its ends.
    pub fn ends(&self) -> &Ends {
        &self.ends
    }

    /// Its bounding planes, positive inside. For two ends the front plane comes
    /// first and the back plane second.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// How deep `p` lies inside: the least distance to a plane, negative outside
    /// (and then no more than the true distance).
    pub fn depth(&self, p: DVec3) -> f64 {
        let depths = self.planes.iter().map(|plane| plane.distance(p));
        depths.fold(f64::INFINITY, f64::min)
    }

    /// Whether `p` is inside or on the boundary; for eyes as for receivers.
    pub fn contains(&self, p: DVec3) -> bool {
        self.depth(p) >= 0.0
    }

    /// The closed boundary, with its far cap at infinity.
    pub fn mesh(&self) -> WedgeMesh {
        assemble(&self.ends, &mut |mesh, _, ray| mesh.direction(ray), None)
    }

    /// The closed boundary with its far cap in `bottom` instead of at infinity
    /// (the bottom plane that paper II adds for z-fail, §5). `None` when some ray
    /// does not reach the plane's negative side from its positive one.
    pub fn mesh_to_bottom(&self, bottom: &Plane) -> Option<WedgeMesh> {
        if let Ends::HalfSpace(_) = self.ends {
            return None;
        }
        let reaches = |end: &End| {
            bottom.distance(end.apex) > 0.0 && end.rays.iter().all(|r| bottom.normal.dot(*r) < 0.0)
        };
        let all_reach = match &self.ends {
            Ends::Two([a, b]) => reaches(a) && reaches(b),
            Ends::One(end) => reaches(end),
            Ends::HalfSpace(_) => false,
        };
        all_reach.then(|| {
            assemble(
                &self.ends,
                &mut |mesh, apex, ray| {
                    let length = -bottom.distance(apex) / bottom.normal.dot(ray);
                    mesh.point(apex + ray * length)
                },
                None,
            )
        })
    }
}

/// Which face of a half is the cut, and what it consists of.
pub(super) struct Cut<'a> {
    /// Whether the back face is the cut (the outer half) or the front face.
    pub(super) replaces_back: bool,
    /// Triangles of the cut, facing the outer side.
    pub(super) triangles: &'a [[glam::DVec4; 3]],
    /// Directions at infinity between the ends of the cut, from the first end to
    /// the second.
    pub(super) between: [DVec3; 2],
}

/// Makes the vertex where a ray from an apex ends.
type RayEnd<'a> = dyn FnMut(&mut WedgeMesh, DVec3, DVec3) -> u32 + 'a;

/// The mesh of one half of a polyhedron with two ends.
pub(super) fn half_mesh(ends: &[End; 2], cut: &Cut) -> WedgeMesh {
    let ends = Ends::Two(ends.clone());
    assemble(&ends, &mut |mesh, _, ray| mesh.direction(ray), Some(cut))
}

fn normalised(ends: Ends) -> Ends {
    let unit = |end: End| End {
        apex: end.apex,
        rays: end.rays.iter().filter_map(|r| r.try_normalize()).collect(),
    };
    match ends {
        Ends::Two(two) => {
            let [mut a, mut b] = two.map(unit);
            if a.rays.is_empty() {
                a.rays.clone_from(&b.rays);
            } else if b.rays.is_empty() {
                b.rays.clone_from(&a.rays);
            }
            Ends::Two([a, b])
        }
        Ends::One(end) => Ends::One(unit(end)),
        half_space => half_space,
    }
}

fn planes(ends: &Ends) -> Vec<Option<Plane>> {
    let between = |end: &End, i: usize, j: usize| {
        Plane::spanned(end.apex, end.rays[i], end.rays[j]) // points inwards if i is first
    };
    match ends {
        Ends::Two([a, b]) => {
            let edge = b.apex - a.apex;
            let hold = |first: &DVec3, last: &DVec3| {
                [
                    Plane::spanned(a.apex, edge, *first),
                    Plane::spanned(a.apex, *last, edge),
                ]
            };
            let Some((first, last)) = a.rays.first().zip(a.rays.last()) else {
                return Vec::new();
            };
            let mut out = hold(first, last).to_vec();
            out.extend((1..a.rays.len()).map(|i| between(a, i - 1, i)));
            out.extend((1..b.rays.len()).map(|i| between(b, i, i - 1)));
            out
        }
        Ends::One(end) => {
            let n = end.rays.len();
            (0..n).map(|i| between(end, i, (i + 1) % n)).collect()
        }
        Ends::HalfSpace(plane) => vec![Some(*plane)],
    }
}

fn assemble(ends: &Ends, ray_end: &mut RayEnd, cut: Option<&Cut>) -> WedgeMesh {
    let mut mesh = WedgeMesh::default();
    match ends {
        Ends::Two([end, _]) | Ends::One(end) if end.rays.is_empty() => {}
        Ends::Two(ends) => join(&mut mesh, ends, ray_end, cut),
        Ends::One(end) => pyramid(&mut mesh, end, ray_end),
        Ends::HalfSpace(plane) => half_space(&mut mesh, plane),
    }
    mesh
}

fn join(mesh: &mut WedgeMesh, ends: &[End; 2], ray_end: &mut RayEnd, cut: Option<&Cut>) {
    let [a, b] = ends.each_ref().map(|end| mesh.point(end.apex));
    let mut far = |mesh: &mut WedgeMesh, end: &End| -> Vec<u32> {
        let ends = end.rays.iter().map(|ray| ray_end(mesh, end.apex, *ray));
        ends.collect()
    };
    let (r, s) = (far(mesh, &ends[0]), far(mesh, &ends[1]));
    let (k, l) = (r.len() - 1, s.len() - 1);
    let cut_back = cut.is_some_and(|c| c.replaces_back);
    if cut.is_none_or(|c| c.replaces_back) {
        mesh.face(&[a, r[0], s[0], b]);
    }
    if !cut_back {
        mesh.face(&[a, b, s[l], r[k]]);
    }
    r.windows(2).for_each(|w| mesh.face(&[a, w[1], w[0]]));
    s.windows(2).for_each(|w| mesh.face(&[b, w[0], w[1]]));
    // The ring at infinity: along r to the back, and along s to the front again.
    let mut ring = r.clone();
    let between = cut.map(|c| (c, c.between.map(|d| mesh.direction(d))));
    if let Some((_, [d0, d1])) = between.filter(|(c, _)| c.replaces_back) {
        ring.extend([d0, d1]);
    }
    ring.extend(s.iter().rev());
    if let Some((_, [d0, d1])) = between.filter(|(c, _)| !c.replaces_back) {
        ring.extend([d1, d0]);
    }
    if let Some(cut) = cut {
        draw_cut(mesh, cut);
    }
    let centre = cap_centre(ends.iter().flat_map(|e| &e.rays));
    let centre = far_centre(mesh, &ring, centre);
    cap(mesh, &ring, centre);
}

fn draw_cut(mesh: &mut WedgeMesh, cut: &Cut) {
    for triangle in cut.triangles {
        let [p, q, r] = triangle.map(|v| match v.w {
            0.0 => mesh.direction(v.truncate()),
            _ => mesh.point(v.truncate()),
        });
        if p != q && q != r && r != p {
            // Outwards is the outer side only for the inner half.
            mesh.triangles.push(if cut.replaces_back {
                [p, r, q]
            } else {
                [p, q, r]
            });
        }
    }
}

fn pyramid(mesh: &mut WedgeMesh, end: &End, ray_end: &mut RayEnd) {
    let apex = mesh.point(end.apex);
    let rays = end.rays.iter();
    let ring: Vec<u32> = rays.map(|ray| ray_end(mesh, end.apex, *ray)).collect();
    for k in 0..ring.len() {
        mesh.face(&[apex, ring[(k + 1) % ring.len()], ring[k]]);
    }
    let centre = far_centre(mesh, &ring, cap_centre(end.rays.iter()));
    cap(mesh, &ring, centre);
}

fn half_space(mesh: &mut WedgeMesh, plane: &Plane) {
    let (u, v) = plane.normal.any_orthonormal_pair();
    let apex = mesh.point(plane.point);
    let ring = [u, v, -u, -v].map(|d| mesh.direction(d));
    let turned = u.cross(v).dot(plane.normal) > 0.0;
    let ring = if turned {
        ring
    } else {
        [ring[0], ring[3], ring[2], ring[1]]
    };
    for k in 0..4 {
        mesh.face(&[apex, ring[(k + 1) % 4], ring[k]]);
    }
    let centre = mesh.direction(plane.normal);
    cap(mesh, &ring, centre);
}

/// A direction inside the far cap: far more even triangles than a fan from a
/// corner, and right for caps nearly as wide as a half-space.
fn cap_centre<'a>(rays: impl Iterator<Item = &'a DVec3>) -> DVec3 {
    rays.sum::<DVec3>().normalize_or(DVec3::Z)
}

/// The cap's centre as a vertex: a direction where the ring is at infinity, else
/// the mean of the ring.
fn far_centre(mesh: &mut WedgeMesh, ring: &[u32], direction: DVec3) -> u32 {
    let corners = ring.iter().map(|&i| mesh.vertices[i as usize]);
    let sum = corners.fold(glam::DVec4::ZERO, |sum, v| sum + v);
    if sum.w == 0.0 {
        mesh.direction(direction)
    } else {
        mesh.point(sum.truncate() / sum.w)
    }
}

fn cap(mesh: &mut WedgeMesh, ring: &[u32], centre: u32) {
    for k in 0..ring.len() {
        let next = ring[(k + 1) % ring.len()];
        if next != ring[k] {
            mesh.triangles.push([ring[k], next, centre]);
        }
    }
}
