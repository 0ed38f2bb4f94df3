//! The boundary of a linked wedge in parts that share vertices with its neighbours'.
//!
//! Where the front planes of two wedges meet in a ray, a front face of either may end on
//! it (figure 6 of paper I). Then both cut the ray there, so that rasterised faces meet
//! without gaps and wherever one lies over another, it is the same triangle.

use glam::{DVec3, DVec4};

use super::{End, LinkedWedge, Overlap};

/// A point of a front ray where the front face of a wedge ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// How far along the ray.
    pub at: f64,
    /// Where.
    pub point: DVec3,
}

/// Homogeneous corners, world space; counter-clockwise seen from outside.
type Triangle = [DVec4; 3];

/// The boundary of a wedge, and what else its front plane bounds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WedgeParts {
    /// The front face: boundary of wedge and umbra.
    pub front: Vec<Triangle>,
    /// Beyond the point where the sides meet in the front plane: boundary of the umbra
    /// only, facing the other way, so that fronts and their neighbours close a volume.
    pub beyond: Vec<Triangle>,
    /// All other faces of the wedge; with the front face they close it.
    pub others: Vec<Triangle>,
}

impl LinkedWedge {
    /// Where its sides meet in its front plane.
    pub fn front_tip(&self) -> Option<DVec3> {
        match self.overlap()? {
            Overlap::Front(tip) | Overlap::Both([tip, _]) => Some(tip),
            Overlap::Back(_) => None,
        }
    }

    fn back_tip(&self) -> Option<DVec3> {
        match self.overlap()? {
            Overlap::Back(tip) | Overlap::Both([_, tip]) => Some(tip),
            Overlap::Front(_) => None,
        }
    }

    /// The boundary in parts up to `end`, its two front rays cut at `cuts`, in order; among
    /// them must be the wedge's own [`LinkedWedge::front_tip`], if it has one there.
    pub fn parts(&self, cuts: [&[Cut]; 2], end: &End) -> WedgeParts {
        let whole = [0, 1].map(|k| chain(self.edge[k], self.front_rays[k], cuts[k], end));
        let (near, beyond) = match self.front_tip().filter(|tip| end.holds(*tip)) {
            None => (whole, Vec::new()),
            Some(tip) => {
                let [first, second] = whole.map(|c| split(c, tip));
                ([first.0, second.0], between(&first.1, &second.1))
            }
        };
        WedgeParts {
            front: between(&near[0], &near[1]),
            beyond,
            others: self.others(&near, end),
        }
    }

    /// Back, sides and far cap; `near` are the two sides of the front face.
    fn others(&self, near: &[Vec<Link>; 2], end: &End) -> Vec<Triangle> {
        let held = |tip: Option<DVec3>| tip.filter(|tip| end.holds(*tip));
        let tips = [held(self.front_tip()), held(self.back_tip())];
        let of_ray = |k: usize, rays: &[DVec3; 2]| end.of_ray(self.edge[k], rays[k]);
        let [first, second] = [0, 1].map(|k| match tips[1] {
            Some(tip) => tip.extend(1.0),
            None => of_ray(k, &self.back_rays),
        });
        let [a, b] = self.edge.map(|p| p.extend(1.0));
        let middle = match tips {
            [Some(tip), None] => Some(end.of_ray(tip, self.common_line(self.front.normal))),
            [None, Some(tip)] => Some(end.of_ray(tip, self.common_line(self.back.normal))),
            _ => None,
        };
        let [left, right] = [0, 1].map(|k| near[k].iter().map(|l| l.vertex));
        let mut out = fan(&[a, b, second, first]);
        let side: Vec<DVec4> = [first]
            .into_iter()
            .chain(middle)
            .chain(left.rev())
            .collect();
        out.extend(fan(&side));
        let side: Vec<DVec4> = [second].into_iter().chain(right).chain(middle).collect();
        out.extend(fan(&side));
        let [r, s] = [0, 1].map(|k| of_ray(k, &self.front_rays));
        match (middle, tips[0]) {
            (Some(m), Some(_)) => out.extend(fan(&[first, second, m])),
            (Some(m), None) => out.extend(fan(&[m, s, r])),
            (None, None) => out.extend(cap(&[first, second, s, r])),
            (None, Some(_)) => {}
        }
        out
    }

    /// Where the two side planes meet, towards `inwards`.
    fn common_line(&self, inwards: DVec3) -> DVec3 {
        let line = self.sides[0].normal.cross(self.sides[1].normal);
        let line = if line.dot(inwards) < 0.0 { -line } else { line };
        line.normalize_or_zero()
    }
}

/// A vertex along a ray.
#[derive(Clone, Copy)]
struct Link {
    at: f64,
    vertex: DVec4,
}

/// The vertices of a ray from `apex`, its end last.
fn chain(apex: DVec3, ray: DVec3, cuts: &[Cut], end: &End) -> Vec<Link> {
    let link = |at: f64, vertex: DVec4| Link { at, vertex };
    let cuts = cuts.iter().filter(|c| end.holds(c.point));
    let cuts = cuts.map(|c| link(c.at, c.point.extend(1.0)));
    std::iter::once(link(0.0, apex.extend(1.0)))
        .chain(cuts)
        .chain([link(f64::INFINITY, end.of_ray(apex, ray))])
        .collect()
}

/// Up to `tip`, and from it on.
fn split(chain: Vec<Link>, tip: DVec3) -> (Vec<Link>, Vec<Link>) {
    let tip = tip.extend(1.0);
    let at = chain.iter().position(|l| l.vertex == tip);
    let at = at.unwrap_or(chain.len() - 1);
    (chain[..=at].to_vec(), chain[at..].to_vec())
}

/// The triangles between two rays that each begin at an end of the same edge, where a
/// chain's side is that of the first end.
pub(crate) fn between_rays(
    apexes: [DVec3; 2],
    rays: [DVec3; 2],
    cuts: [&[Cut]; 2],
    end: &End,
) -> Vec<Triangle> {
    let [first, second] = [0, 1].map(|k| chain(apexes[k], rays[k], cuts[k], end));
    between(&first, &second)
}

/// Triangles between two chains that do not cross, each cut going to what lies opposite.
fn between(first: &[Link], second: &[Link]) -> Vec<Triangle> {
    let (mut i, mut j) = (0, 0);
    let mut out = Vec::new();
    while i + 1 < first.len() || j + 1 < second.len() {
        let (l, r) = (first[i].vertex, second[j].vertex);
        let along_first = match (first.get(i + 1), second.get(j + 1)) {
            (Some(p), Some(q)) => p.at <= q.at,
            (next, _) => next.is_some(),
        };
        let third = if along_first {
            i += 1;
            first[i].vertex
        } else {
            j += 1;
            second[j].vertex
        };
        out.push([r, l, third]);
    }
    out.retain(has_three_corners);
    out
}

/// A convex face from its first corner.
fn fan(corners: &[DVec4]) -> Vec<Triangle> {
    let pairs = corners.windows(2).skip(1);
    let triangles = pairs.map(|p| [corners[0], p[0], p[1]]);
    triangles.filter(has_three_corners).collect()
}

/// A cap, from its middle: at infinity far more even than from a corner.
fn cap(ring: &[DVec4; 4]) -> Vec<Triangle> {
    let sum: DVec4 = ring.iter().sum();
    let middle = match sum.w {
        0.0 => sum.truncate().normalize_or(DVec3::Z).extend(0.0),
        count => sum / count,
    };
    let next = |k: usize| ring[(k + 1) % 4];
    let triangles = (0..4).map(|k| [ring[k], next(k), middle]);
    triangles.filter(has_three_corners).collect()
}

fn has_three_corners([a, b, c]: &Triangle) -> bool {
    a != b && b != c && c != a
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::super::{LinkedSettings, LinkedStatistics, link};
    use super::*;
    use crate::geometry::wedge::Plane;

    type Bits = [u64; 4];

    /// How often each directed edge is walked more than against its direction.
    fn boundary<'a>(triangles: impl IntoIterator<Item = &'a Triangle>) -> Vec<[Bits; 2]> {
        let bits = |v: DVec4| v.to_array().map(f64::to_bits);
        let mut balance: BTreeMap<[Bits; 2], i32> = BTreeMap::new();
        for t in triangles {
            for k in 0..3 {
                let (a, b) = (bits(t[k]), bits(t[(k + 1) % 3]));
                let (edge, way) = if a < b { ([a, b], 1) } else { ([b, a], -1) };
                *balance.entry(edge).or_default() += way;
            }
        }
        let open = balance.into_iter().filter(|(_, n)| *n != 0);
        open.map(|(edge, _)| edge).collect()
    }

    /// A convex polygon, and one with a slot whose walls' fronts lean towards each other.
    fn outlines() -> [Vec<[f64; 2]>; 2] {
        let corner = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / 7.0;
            [0.5 * libm::cos(angle), 0.5 * libm::sin(angle)]
        };
        let slot = [
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, 1.0],
            [0.2, 1.0],
            [0.3, -0.4],
            [-0.2, -0.3],
            [-0.2, 1.0],
            [-1.0, 1.0],
        ];
        [(0..7).map(corner).collect(), slot.to_vec()]
    }

    /// A flat outline below a light, as wedges and where their rays are cut.
    fn linked(outline: &[[f64; 2]], radius: f64) -> Vec<(LinkedWedge, [Vec<Cut>; 2])> {
        let points: Vec<DVec3> = outline
            .iter()
            .map(|[x, y]| DVec3::new(*x, 1.0, -y))
            .collect();
        let centre = DVec3::new(0.05, 4.0, -0.02);
        let mut met = LinkedStatistics::default();
        let wedges = link(
            &points,
            centre,
            radius,
            &LinkedSettings::default(),
            &mut met,
        );
        let n = wedges.len();
        let at = |k: usize, end: usize| {
            let here = wedges[k].edge[end];
            let ray = wedges[k].front_rays[end];
            let beside = if end == 0 {
                (k + n - 1) % n
            } else {
                (k + 1) % n
            };
            let tips = [k, beside].map(|w| wedges[w].front_tip());
            let mut cuts: Vec<Cut> = tips
                .into_iter()
                .flatten()
                .filter(|tip| *tip != here)
                .map(|point| Cut {
                    at: (point - here).dot(ray),
                    point,
                })
                .collect();
            cuts.sort_by(|a, b| a.at.total_cmp(&b.at));
            cuts.dedup();
            cuts
        };
        let all: Vec<_> = (0..n).map(|k| [at(k, 0), at(k, 1)]).collect();
        wedges.into_iter().zip(all).collect()
    }

    /// At infinity, and in a plane before some of the tips.
    fn ends() -> [End; 2] {
        let plane = Plane {
            normal: DVec3::Y,
            point: DVec3::new(0.0, -0.5, 0.0),
        };
        [End(None), End(Some(plane))]
    }

    fn parts((wedge, cuts): &(LinkedWedge, [Vec<Cut>; 2]), end: &End) -> WedgeParts {
        wedge.parts(cuts.each_ref().map(Vec::as_slice), end)
    }

    /// Front face and other faces close every wedge, whether its sides meet or not.
    #[test]
    fn front_and_other_faces_close_a_wedge() {
        for outline in outlines() {
            for radius in [0.05, 0.6, 1.5] {
                for (wedge, end) in linked(&outline, radius).iter().zip(ends().iter().cycle()) {
                    let p = parts(wedge, end);
                    let open = boundary(p.front.iter().chain(&p.others));
                    assert!(open.is_empty(), "radius {radius}, {end:?}: {open:?}");
                }
            }
        }
    }

    /// Fronts share whole edges with their neighbours': only the silhouette and the far
    /// ends are left open, wherever front faces end on shared rays.
    #[test]
    fn fronts_of_a_loop_share_their_vertices() {
        for (outline, tips) in outlines().iter().zip([false, true]) {
            let mut meet = false;
            for radius in [0.05, 0.6, 1.5] {
                let wedges = linked(outline, radius);
                meet |= wedges.iter().any(|(w, _)| w.front_tip().is_some());
                for end in ends() {
                    let all = wedges.iter().map(|w| parts(w, &end));
                    let all: Vec<WedgeParts> = all.collect();
                    let fronts = all.iter().flat_map(|p| p.front.iter().chain(&p.beyond));
                    // Open edges lie in the silhouette or in the end, none between them.
                    let in_silhouette = |v: Bits| f64::from_bits(v[1]) == 1.0;
                    for [a, b] in boundary(fronts) {
                        let open = in_silhouette(a) != in_silhouette(b);
                        assert!(!open, "radius {radius}, {end:?}: an open ray");
                    }
                }
            }
            assert_eq!(meet, tips);
        }
    }
}
