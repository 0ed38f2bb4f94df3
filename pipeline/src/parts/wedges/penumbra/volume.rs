//! The wedges of one caster and the volume that their front planes bound.
//!
//! The front planes of a loop, the caster's light-facing triangles above them and
//! a cap at infinity below close a volume; its winding number W and the wedges
//! give the light that a point sees: `255 (1 - W) + sum of 255 s over wedges that
//! hold it` (paper II, §3). Wherever linking leaves a gap, plain pieces keep the
//! volume closed: a point may get the wrong intensity near them, but no streak
//! runs across the picture.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec3, DVec4};

use super::light::LightSphere;
use super::report::LinkedReport;
use crate::geometry::wedge::Plane;
use crate::geometry::wedge::paper1::{
    Cut, End, LinkedSettings, LinkedWedge, WedgeParts, between_rays, link_under,
};
use crate::geometry::winding;
use crate::world::mesh::Mesh;

/// Homogeneous corners, world space; counter-clockwise seen from outside.
pub(crate) type Triangle = [DVec4; 3];

/// What one caster does to a spherical light.
pub(crate) struct SoftVolume {
    /// In the order of the silhouette's loops.
    pub(crate) wedges: Vec<LinkedWedge>,
    /// Where the two front rays of each wedge are cut, for [`LinkedWedge::parts`].
    pub(crate) cuts: Vec<[Vec<Cut>; 2]>,
    /// Boundary of the umbra where there is no wedge.
    pub(crate) gaps: Vec<Gap>,
    /// Light-facing triangles of the caster.
    pub(crate) cap: Vec<[u32; 3]>,
    /// Between the caster's silhouette and the loop that collapsing left of it.
    pub(crate) patches: Vec<Triangle>,
    /// Where it ends.
    pub(crate) bottom: Vec<Triangle>,
    /// The plane in which each wedge ends.
    pub(crate) ends: Vec<End>,
    /// The wedges of each silhouette loop that has any.
    loops: Vec<Range<usize>>,
    /// Boundary of the shadows of loops without any.
    hard: Vec<Triangle>,
    /// Whether some of the bottom is not at infinity.
    pub(crate) ends_somewhere: bool,
    /// How often all of infinity is added to the bottom: once for a caster round the
    /// light, whose cap has no silhouette that would say so.
    pub(crate) all_around: i32,
}

/// A piece of the umbra's boundary without wedge.
pub(crate) struct Gap {
    pub(crate) triangles: Vec<Triangle>,
    /// Its plane, positive inside the umbra.
    pub(crate) plane: Plane,
}

/// A side of the volume: two near points and where they go.
struct Side {
    near: [DVec3; 2],
    far: [DVec3; 2],
    /// Index of its wedge among the loop's.
    wedge: Option<usize>,
}

/// A silhouette loop and what its shadow is bounded by.
struct Loop<'a> {
    points: &'a [DVec3],
    wedges: Vec<LinkedWedge>,
    sides: Vec<Side>,
    end: End,
}

impl SoftVolume {
    /// `length` is how far behind its silhouette each loop's shadow ends, if all of it
    /// comes there.
    pub(crate) fn new(
        loops: &[Vec<DVec3>],
        cap: Vec<[u32; 3]>,
        sphere: &LightSphere,
        settings: &LinkedSettings,
        length: Option<f64>,
        met: &mut LinkedReport,
    ) -> Self {
        let mut volume = Self {
            wedges: Vec::new(),
            cuts: Vec::new(),
            gaps: Vec::new(),
            cap,
            patches: Vec::new(),
            bottom: Vec::new(),
            ends: Vec::new(),
            loops: Vec::new(),
            hard: Vec::new(),
            ends_somewhere: false,
            all_around: 0,
        };
        for points in loops {
            let mut l = Loop::new(points, sphere, settings, met);
            l.end_behind(sphere.centre, length, met);
            volume.add_loop(l, sphere, met);
        }
        volume
    }

    /// For a caster round the light, on `mesh`: nothing hides the light's centre from
    /// itself.
    pub(crate) fn enclosing(mut self, mesh: &Mesh, centre: DVec3) -> Self {
        self.all_around = -self.winding(mesh, centre);
        self
    }

    fn add_loop(&mut self, l: Loop<'_>, sphere: &LightSphere, met: &mut LinkedReport) {
        let cuts = cuts(&l.sides, &l.wedges);
        let n = l.sides.len();
        for (k, side) in l.sides.iter().enumerate() {
            let cuts = [&cuts[(k + n - 1) % n], &cuts[k]];
            if side.wedge.is_some() {
                self.cuts.push(cuts.map(Clone::clone));
                self.ends.push(l.end);
            } else {
                met.gaps += 1;
                self.gaps.extend(side.gap(cuts, &l.end));
            }
        }
        self.patches.extend(patches(l.points, &l.sides));
        self.bottom
            .extend(bottom(l.points, sphere.centre, &l.sides, &l.end));
        self.ends_somewhere |= l.end != End::default();
        let first = self.wedges.len();
        if l.wedges.is_empty() {
            let gaps = l
                .sides
                .iter()
                .filter_map(|s| s.gap([&Vec::new(); 2], &l.end));
            self.hard.extend(gaps.flat_map(|g| g.triangles));
        } else {
            self.loops.push(first..first + l.wedges.len());
        }
        self.wedges.extend(l.wedges);
    }

    /// The boundary of a hard shadow between the front planes, share 0, and the back
    /// planes, share 1: sides, and a cap at infinity.
    pub(crate) fn level(&self, share: f64) -> (Vec<Triangle>, Vec<Triangle>) {
        let (mut sides, mut bottom) = (self.hard.clone(), self.bottom_of_hard());
        for range in &self.loops {
            let wedges = &self.wedges[range.clone()];
            let chain: Vec<Side> = chained_at(wedges, share);
            let sum: DVec3 = chain.iter().flat_map(|s| s.far).sum();
            let middle = sum.normalize_or(DVec3::NEG_Y).extend(0.0);
            for side in &chain {
                let none: &[Cut] = &[];
                let end = End::default();
                sides.extend(between_rays(side.near, side.far, [none; 2], &end));
                let [r, s] = side.far.map(|d| d.extend(0.0));
                bottom.extend((r != s).then_some([middle, s, r]));
            }
        }
        (sides, bottom)
    }

    /// The cap at infinity of loops without wedges: of their boundary's far corners.
    fn bottom_of_hard(&self) -> Vec<Triangle> {
        let far = |t: &Triangle| {
            let at_infinity: Vec<DVec4> = t.iter().copied().filter(|v| v.w == 0.0).collect();
            (at_infinity.len() == 2).then(|| [at_infinity[0], at_infinity[1]])
        };
        let sum: DVec4 = self.hard.iter().flatten().filter(|v| v.w == 0.0).sum();
        let middle = sum.truncate().normalize_or(DVec3::NEG_Y).extend(0.0);
        let edges = self.hard.iter().filter_map(far);
        edges.map(|[r, s]| [middle, s, r]).collect()
    }

    /// A wedge's boundary in parts.
    pub(crate) fn parts(&self, wedge: usize) -> WedgeParts {
        let cuts = self.cuts[wedge].each_ref().map(Vec::as_slice);
        self.wedges[wedge].parts(cuts, &self.ends[wedge])
    }

    /// The winding number of the front volume round `p`; `p` not on its boundary.
    pub(crate) fn winding(&self, mesh: &Mesh, p: DVec3) -> i32 {
        let fronts = (0..self.wedges.len()).flat_map(|k| {
            if self.ends[k] == End::default() {
                self.wedges[k].front_quad().to_vec()
            } else {
                let parts = self.parts(k);
                [parts.front, parts.beyond].concat()
            }
        });
        let gaps = self.gaps.iter().flat_map(|g| g.triangles.iter().copied());
        let cap = self
            .cap
            .iter()
            .map(|t| t.map(|i| mesh.position(i).extend(1.0)));
        let all = fronts
            .chain(gaps)
            .chain(cap)
            .chain(self.patches.iter().copied())
            .chain(self.bottom.iter().copied());
        winding::of_triangles(all, p) + self.all_around
    }

    /// Whether `p` may be inside a wedge, within `margin` in world units.
    pub(crate) fn may_hold(&self, p: DVec3, margin: f64) -> bool {
        self.wedges.iter().any(|w| w.depth(p) >= -margin)
    }
}

impl<'a> Loop<'a> {
    fn new(
        points: &'a [DVec3],
        sphere: &LightSphere,
        settings: &LinkedSettings,
        met: &mut LinkedReport,
    ) -> Self {
        let wedges = link_under(points, &sphere.touched(), settings, &mut met.linked);
        let sides = if wedges.is_empty() {
            hard_sides(points, sphere.centre)
        } else {
            chained(&wedges)
        };
        Self {
            points,
            wedges,
            sides,
            end: End::default(),
        }
    }

    /// Ends it `length` behind its points, if there is a length and all of it comes there.
    fn end_behind(&mut self, centre: DVec3, length: Option<f64>, met: &mut LinkedReport) {
        let Some(length) = length else {
            return;
        };
        let from_light = self.points.iter().map(|p| *p - centre);
        let sum: DVec3 = from_light.clone().map(|p| p.normalize_or_zero()).sum();
        let away = sum.normalize_or_zero();
        let farthest = from_light.map(|p| p.dot(away)).fold(0.0, f64::max);
        let end = End(Some(Plane {
            normal: -away,
            point: centre + away * (farthest + length),
        }));
        if self.reaches(&end) {
            self.end = end;
        } else {
            met.endless += 1;
        }
    }

    /// Whether all that bounds the shadow comes to the end.
    fn reaches(&self, end: &End) -> bool {
        let fronts = self.sides.iter().flat_map(|s| s.far);
        let backs = self.wedges.iter().flat_map(|w| w.back_rays);
        fronts.chain(backs).all(|ray| end.is_reached_by(ray))
    }
}

impl Side {
    fn gap(&self, cuts: [&Vec<Cut>; 2], end: &End) -> Option<Gap> {
        let [[a, b], [r, s]] = [self.near, self.far];
        let triangles = between_rays(self.near, self.far, cuts.map(Vec::as_slice), end);
        let plane = Plane::spanned(a, b - a, r)
            .or_else(|| Plane::spanned(a, b - a, s))
            .or_else(|| Plane::spanned(a, r, s));
        // Without plane it has no area from anywhere.
        plane.map(|plane| Gap { triangles, plane })
    }
}

/// Where front faces end on the rays that sides share; entry k is the ray between side k
/// and the next.
fn cuts(sides: &[Side], wedges: &[LinkedWedge]) -> Vec<Vec<Cut>> {
    let n = sides.len();
    let mut all = vec![Vec::new(); n];
    for (k, side) in sides.iter().enumerate() {
        let Some(tip) = side.wedge.and_then(|w| wedges[w].front_tip()) else {
            continue;
        };
        for (joint, end) in [((k + n - 1) % n, 0), (k, 1)] {
            let at = (tip - side.near[end]).dot(side.far[end]);
            // A turn at a vertex may end where it begins.
            if tip != side.near[end] {
                all[joint].push(Cut { at, point: tip });
            }
        }
    }
    for list in &mut all {
        list.sort_by(|a, b| a.at.total_cmp(&b.at));
        list.dedup_by(|a, b| a.point == b.point);
    }
    all
}

/// The sides of the hard shadow volume of a loop, where there are no wedges.
fn hard_sides(points: &[DVec3], centre: DVec3) -> Vec<Side> {
    let next = |k: usize| points[(k + 1) % points.len()];
    (0..points.len())
        .map(|k| Side {
            near: [points[k], next(k)],
            far: [points[k], next(k)].map(|p| p - centre),
            wedge: None,
        })
        .filter(|side| side.near[0] != side.near[1])
        .collect()
}

/// The front quads of a loop's wedges, and a side wherever one does not begin
/// where the last ends.
fn chained(wedges: &[LinkedWedge]) -> Vec<Side> {
    let mut sides = Vec::with_capacity(wedges.len());
    for (k, wedge) in wedges.iter().enumerate() {
        sides.push(Side {
            near: wedge.edge,
            far: wedge.front_rays,
            wedge: Some(k),
        });
        let next = &wedges[(k + 1) % wedges.len()];
        let gap = Side {
            near: [wedge.edge[1], next.edge[0]],
            far: [wedge.front_rays[1], next.front_rays[0]],
            wedge: None,
        };
        if gap.near[0] != gap.near[1] || gap.far[0] != gap.far[1] {
            sides.push(gap);
        }
    }
    sides
}

/// The same with rays between those of front and back planes.
fn chained_at(wedges: &[LinkedWedge], share: f64) -> Vec<Side> {
    let turned = |w: &LinkedWedge| {
        let between = |k: usize| {
            w.front_rays[k]
                .lerp(w.back_rays[k], share)
                .normalize_or_zero()
        };
        LinkedWedge {
            front_rays: [between(0), between(1)],
            ..w.clone()
        }
    };
    let turned: Vec<LinkedWedge> = wedges.iter().map(turned).collect();
    chained(&turned)
}

type Bits = [u64; 3];

fn bits(p: DVec3) -> Bits {
    p.to_array().map(f64::to_bits)
}

/// Triangles whose boundary is the sides' near loop less the loop of points:
/// fans from one point over the edges that only one of the two has.
fn patches(points: &[DVec3], sides: &[Side]) -> Vec<Triangle> {
    let mut balance: BTreeMap<(Bits, Bits), (i32, [DVec3; 2])> = BTreeMap::new();
    let mut add = |[a, b]: [DVec3; 2], count: i32| {
        if a != b {
            balance.entry((bits(a), bits(b))).or_insert((0, [a, b])).0 += count;
        }
    };
    for k in 0..points.len() {
        add([points[k], points[(k + 1) % points.len()]], -1);
    }
    sides.iter().for_each(|side| add(side.near, 1));
    let changed: Vec<(i32, [DVec3; 2])> = balance.into_values().filter(|(n, _)| *n != 0).collect();
    let Some((_, [apex, _])) = changed.first().copied() else {
        return Vec::new();
    };
    let fan = changed.iter().flat_map(|&(count, [a, b])| {
        let [a, b] = if count > 0 { [a, b] } else { [b, a] };
        let triangle = [apex, a, b].map(|p| p.extend(1.0));
        std::iter::repeat_n(triangle, count.unsigned_abs() as usize)
    });
    fan.filter(|[x, y, z]| x != y && z != x).collect()
}

/// The cap at the end: a fan from the loop's mean direction over the far ends.
fn bottom(points: &[DVec3], centre: DVec3, sides: &[Side], end: &End) -> Vec<Triangle> {
    let sum: DVec3 = points
        .iter()
        .map(|p| (*p - centre).normalize_or_zero())
        .sum();
    let Some(mean) = sum.try_normalize() else {
        return Vec::new();
    };
    let middle = end.of_ray(centre, mean);
    let far = |side: &Side, k: usize| end.of_ray(side.near[k], side.far[k]);
    let fan = sides
        .iter()
        .map(|side| [middle, far(side, 1), far(side, 0)]);
    fan.filter(|[_, a, b]| a != b).collect()
}
