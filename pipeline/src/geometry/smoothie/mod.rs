//! Geometry round silhouettes that softens the edges of a shadow map: smoothies (Chan and
//! Durand 2003), and cones and sheets (Haines 2001; Wyman and Hansen 2003); docs/papers.md.
//!
//! All of it is built in a picture taken from the light: places in it are tangents
//! (x/z, y/z), x to the right and y downwards, and z is the distance along its axis.

mod cones;
mod fins;

use glam::{DVec2, DVec3};

use crate::geometry::silhouette::Silhouette;
use crate::geometry::silhouette_loops::SilhouetteLoops;
use crate::world::mesh::Mesh;

/// Where a picture is taken from: a point, and unit vectors to the right, downwards and
/// along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureFrame {
    /// The light's centre.
    pub centre: DVec3,
    /// Right, down, along.
    pub axes: [DVec3; 3],
}

impl PictureFrame {
    fn local(&self, p: DVec3) -> DVec3 {
        let from = p - self.centre;
        DVec3::from_array(self.axes.map(|a| a.dot(from)))
    }

    fn world(&self, local: DVec3) -> DVec3 {
        let [right, down, along] = self.axes;
        self.centre + right * local.x + down * local.y + along * local.z
    }
}

/// What is attached to silhouettes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attachment {
    /// Rectangles of this width in the picture, in tangents, and corners between them.
    Smoothies(f64),
    /// Cones from the silhouette's vertices away from a disc or ball of this radius round
    /// the light's centre, and sheets between them.
    Cones(f64),
}

impl Attachment {
    /// Width or radius.
    pub fn size(self) -> f64 {
        let (Self::Smoothies(size) | Self::Cones(size)) = self;
        size
    }

    /// Whether there is nothing to attach: the light has no extent.
    fn is_empty(self) -> bool {
        !(self.size().is_finite() && self.size() > 0.0)
    }
}

/// A vertex of what is attached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothieVertex {
    /// Where it is, world space.
    pub position: DVec3,
    /// Its distance along the picture's axis.
    pub distance: f64,
    /// That of the edge or corner that it belongs to.
    pub blocker: f64,
    /// From the edge or corner, in the picture, over the width of a smoothie.
    pub offset: DVec2,
}

/// What one caster's silhouette has attached, and how many of what.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Smoothies {
    /// Three vertices for each triangle.
    pub vertices: Vec<SmoothieVertex>,
    /// Rectangles or sheets.
    pub edges: usize,
    /// Corners or cones.
    pub corners: usize,
    /// Concave corners, which have nothing.
    pub concave: usize,
    /// Edges and vertices nearer than what is looked at, which have nothing or less.
    pub cut: usize,
}

impl Smoothies {
    fn quad(&mut self, [a, b, c, d]: [SmoothieVertex; 4]) {
        self.vertices.extend([a, b, c, a, c, d]);
    }
}

/// A vertex of a silhouette.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Corner {
    world: DVec3,
    local: DVec3,
}

impl Corner {
    fn place(&self) -> DVec2 {
        self.local.truncate() / self.local.z
    }

    /// Itself as a vertex.
    fn vertex(&self) -> SmoothieVertex {
        SmoothieVertex {
            position: self.world,
            distance: self.local.z,
            blocker: self.local.z,
            offset: DVec2::ZERO,
        }
    }

    /// The point between two at a distance.
    fn between(a: &Self, b: &Self, z: f64) -> Self {
        let t = (z - a.local.z) / (b.local.z - a.local.z);
        Self {
            world: a.world + (b.world - a.world) * t,
            local: a.local + (b.local - a.local) * t,
        }
    }
}

/// A silhouette edge whose projection has a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    ends: [Corner; 2],
    /// In the picture; what casts is to its left as the light sees it.
    direction: DVec2,
}

impl Edge {
    /// Away from what casts.
    fn outward(&self) -> DVec2 {
        DVec2::new(-self.direction.y, self.direction.x)
    }
}

/// Distances between which silhouettes are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Above 0.
    pub near: f64,
    /// The farthest receiver's.
    pub far: f64,
}

impl Reach {
    fn holds(&self, corner: &Corner) -> bool {
        (self.near..self.far).contains(&corner.local.z)
    }

    /// The part of an edge in it.
    fn clip(&self, [mut a, mut b]: [Corner; 2]) -> Option<[Corner; 2]> {
        let (p, q) = (a, b);
        for z in [self.near, self.far] {
            let outside = |c: &Corner| (c.local.z < z) == (z == self.near) && c.local.z != z;
            match (outside(&a), outside(&b)) {
                (true, true) => return None,
                (true, false) => a = Corner::between(&p, &q, z),
                (false, true) => b = Corner::between(&p, &q, z),
                (false, false) => {}
            }
        }
        Some([a, b])
    }
}

/// Edges whose projection is shorter than this, in tangents, have no direction.
const POINT: f64 = 1e-9;

/// What is attached to a mesh's silhouette.
pub fn attach(
    mesh: &Mesh,
    silhouette: &Silhouette,
    frame: &PictureFrame,
    reach: Reach,
    attachment: Attachment,
) -> Smoothies {
    let mut all = Smoothies::default();
    // Silhouettes of any mesh balance.
    let Ok(loops) = SilhouetteLoops::new(silhouette) else {
        return all;
    };
    if attachment.is_empty() {
        return all;
    }
    for vertices in loops.vertices(silhouette) {
        let corner = |i: &u32| {
            let world = mesh.position(*i);
            let local = frame.local(world);
            Corner { world, local }
        };
        let corners: Vec<Corner> = vertices.iter().map(corner).collect();
        match attachment {
            Attachment::Smoothies(width) => fins::attach(&mut all, &corners, frame, reach, width),
            Attachment::Cones(radius) => cones::attach(&mut all, &corners, frame, reach, radius),
        }
    }
    all
}

/// The edges of a loop, those with a direction, each clipped to what is looked at; how
/// many are cut at the near distance.
fn edges(corners: &[Corner], reach: Reach, cut: &mut usize) -> Vec<Edge> {
    let mut all = Vec::with_capacity(corners.len());
    for (k, from) in corners.iter().enumerate() {
        let to = &corners[(k + 1) % corners.len()];
        *cut += usize::from(from.local.z.min(to.local.z) < reach.near);
        let Some(ends) = reach.clip([*from, *to]) else {
            continue;
        };
        let along = ends[1].place() - ends[0].place();
        let length = along.length();
        if length > POINT {
            all.push(Edge {
                ends,
                direction: along / length,
            });
        }
    }
    all
}

/// The mean distance of a silhouette's vertices between `reach`, and how many there are.
pub fn mean_distance(
    mesh: &Mesh,
    silhouette: &Silhouette,
    frame: &PictureFrame,
    reach: Reach,
) -> (f64, usize) {
    let distance = |e: &[u32; 2]| frame.local(mesh.position(e[0])).z;
    let all = silhouette.edges.iter().map(distance);
    let looked_at = all.filter(|z| (reach.near..reach.far).contains(z));
    let (sum, count) = looked_at.fold((0.0, 0), |(sum, n), z| (sum + z, n + 1));
    (if count > 0 { sum / count as f64 } else { 0.0 }, count)
}

#[cfg(test)]
mod tests;
