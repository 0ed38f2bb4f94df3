//! The rules, in f64, one receiver after the other and every edge for each.
//!
//! Slow and plain: the shader must do the same for receivers in lanes, with lists of
//! edges. The rules that make a walk over the light consistent whatever is rounded:
//!
//! * An end of an edge is *behind* a line or the spine where its coordinate is below 0, so
//!   an end on it belongs to the other side; both edges at a vertex use the same bits.
//! * Which of an edge's crossings with a line and with the spine comes first is decided
//!   once, by one comparison; both the count at the line's foot and the side of the foot on
//!   which the line is crossed follow from it.
//! * Edges of the receiver's own plane are left out: their images lie on its horizon. So
//!   all points that are walked over lie before the horizon.

use glam::DVec3;

use super::edges::{ContourEdge, Facet, LineCasters, NONE};
use super::light::{Extent, LightFrame, Line, LineLight};
use super::patches::Plane;

/// A point of a surface, and what hides light behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineReceiver {
    /// World space.
    pub point: DVec3,
    /// Of a caster: number of its plane, and the unit normal on the side that is seen.
    pub own: Option<(u32, DVec3)>,
}

/// What a receiver sees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// Share of the light.
    pub share: f64,
    /// Least D met; below 0 is an error.
    pub least: i32,
    /// Crossings with lines.
    pub crossings: usize,
}

/// A light as one receiver has it, which is at positive z.
struct SeenLight {
    frame: LightFrame,
    lines: Vec<Line>,
}

/// A receiver in a light's coordinates.
struct Walk<'a> {
    casters: &'a LineCasters,
    receiver: LineReceiver,
    /// In the light's coordinates.
    p: DVec3,
    light: SeenLight,
    /// Whether the share before the own plane is known in closed form.
    closed: bool,
}

/// An edge relative to the receiver: x, y, and the distance towards the light.
struct Image {
    ends: [DVec3; 2],
    jump: f64,
}

/// A crossing with a line.
#[derive(Clone, Copy, Debug)]
struct Event {
    x: f64,
    change: f64,
}

/// The share of `light` that a receiver sees, by `n` lines.
pub fn visible(casters: &LineCasters, light: &LineLight, n: u32, receiver: LineReceiver) -> Seen {
    let Some(seen) = seen_from(light, n, receiver.point) else {
        return Seen {
            share: 1.0,
            ..Seen::default()
        };
    };
    let p = seen.frame.local(receiver.point);
    let walk = Walk {
        casters,
        receiver,
        p,
        light: seen,
        closed: matches!(light.extent, Extent::Polygon(_)),
    };
    let mut seen = walk.sweep();
    if let Some(share) = walk.share_before(light) {
        seen.share = (seen.share * share).clamp(0.0, 1.0);
    }
    seen
}

/// The light with z towards `p`; `None` from inside of a sphere.
fn seen_from(light: &LineLight, n: u32, p: DVec3) -> Option<SeenLight> {
    let mut lines = light.lines(n);
    if let Extent::Sphere(radius) = light.extent {
        let away = p - light.frame.centre;
        let scale = radius * light.growth(away.length());
        if !scale.is_finite() {
            return None;
        }
        for line in &mut lines {
            line.y *= scale;
            line.left *= scale;
            line.right *= scale;
        }
        let frame = LightFrame::facing(light.frame.centre, away, None, 0.0);
        return Some(SeenLight { frame, lines });
    }
    let mut frame = light.frame;
    if frame.local(p).z < 0.0 {
        let [x, y, z] = frame.axes;
        frame.axes = [x, -y, -z];
        for line in &mut lines {
            line.y = -line.y;
            line.slope = -line.slope;
        }
    }
    Some(SeenLight { frame, lines })
}

impl Walk<'_> {
    fn sweep(&self) -> Seen {
        let spans: Vec<[f64; 2]> = self.light.lines.iter().map(|l| self.span(l)).collect();
        let (anchor, feet) = self.feet(&spans);
        let mut seen = Seen::default();
        let full: f64 = self.light.lines.iter().map(|l| l.right - l.left).sum();
        let whole = match self.receiver.own.is_some() && self.closed {
            true => spans.iter().map(|s| (s[1] - s[0]).max(0.0)).sum(),
            false => full,
        };
        let Some(anchor) = anchor else {
            return seen;
        };
        let images: Vec<Image> = self
            .casters
            .edges
            .iter()
            .filter_map(|e| self.image(e))
            .collect();
        let base = f64::from(self.depth(anchor));
        let mut visible = 0.0;
        for ((line, span), foot) in self.light.lines.iter().zip(&spans).zip(&feet) {
            if span[0] < span[1] {
                visible +=
                    self.sweep_line(&images, (line.y, *span), (anchor, *foot), base, &mut seen);
            }
        }
        if whole > 0.0 {
            seen.share = visible / whole;
        }
        seen
    }

    /// Of a polygon that the own plane cuts, the share before it: lines then only say how
    /// much of that is seen.
    fn share_before(&self, light: &LineLight) -> Option<f64> {
        let (_, normal) = self.receiver.own?;
        light.share_before(|s| normal.dot(light.frame.at(s) - self.receiver.point))
    }

    /// The part of a line before the receiver's horizon.
    fn span(&self, line: &Line) -> [f64; 2] {
        let mut span = [line.left, line.right];
        let Some((_, normal)) = self.receiver.own else {
            return span;
        };
        let n = self.light.frame.direction(normal);
        let at_zero = n.y * (line.y - self.p.y) - n.x * self.p.x - n.z * self.p.z;
        match () {
            () if n.x > 0.0 => span[0] = span[0].max(-at_zero / n.x),
            () if n.x < 0.0 => span[1] = span[1].min(-at_zero / n.x),
            () if at_zero <= 0.0 => span[1] = span[0],
            () => {}
        }
        span
    }

    /// Where D is counted, and the foot of each line: on the spine through the centre, or,
    /// where the horizon cuts the light, in the middle of what is before it. `None` where
    /// nothing is.
    fn feet(&self, spans: &[[f64; 2]]) -> (Option<[f64; 2]>, Vec<f64>) {
        let lines = &self.light.lines;
        let cut = lines
            .iter()
            .zip(spans)
            .any(|(l, s)| *s != [l.left, l.right]);
        if !cut {
            let feet = lines.iter().map(|l| l.slope * l.y).collect();
            return (Some([0.0, 0.0]), feet);
        }
        let feet: Vec<f64> = spans.iter().map(|s| 0.5 * (s[0] + s[1])).collect();
        let length = |k: &usize| spans[*k][1] - spans[*k][0];
        let longest = (0..lines.len()).max_by(|a, b| length(a).total_cmp(&length(b)));
        let longest = longest.filter(|k| length(k) > 0.0);
        (longest.map(|k| [feet[k], lines[k].y]), feet)
    }

    /// An edge that is a contour from here.
    fn image(&self, edge: &ContourEdge) -> Option<Image> {
        let own = self.receiver.own.map_or(NONE, |(patch, _)| patch);
        if own != NONE && edge.patches.contains(&own) {
            return None;
        }
        let faces = |patch: u32| {
            let before = |p: &Plane| p.height(self.receiver.point) > 0.0;
            f64::from(u8::from(
                self.casters.planes.get(patch as usize).is_some_and(before),
            ))
        };
        let [factor, less] = edge.jump.weights();
        let jump = factor * (faces(edge.patches[0]) - faces(edge.patches[1])) - less;
        let from_here = |v: DVec3| {
            let v = self.light.frame.local(v);
            DVec3::new(v.x - self.p.x, v.y - self.p.y, self.p.z - v.z)
        };
        (jump != 0.0).then(|| Image {
            ends: edge.ends.map(from_here),
            jump,
        })
    }

    /// Adds up where D is 0 on one line.
    fn sweep_line(
        &self,
        images: &[Image],
        (y, [left, right]): (f64, [f64; 2]),
        (anchor, foot): ([f64; 2], f64),
        base: f64,
        seen: &mut Seen,
    ) -> f64 {
        let slope = if y == anchor[1] {
            0.0
        } else {
            (foot - anchor[0]) / (y - anchor[1])
        };
        let mut depth = base;
        let mut events = Vec::new();
        for image in images {
            let spine = |v: &DVec3| {
                let at = (self.p.x - anchor[0]) - slope * (self.p.y - anchor[1]);
                v.x - slope * v.y + v.z * (at / self.p.z)
            };
            let above = |level: f64| move |v: &DVec3| v.y + v.z * ((self.p.y - level) / self.p.z);
            let crossing = Crossing::new(image, spine, above(y));
            depth += crossing.at_foot(self.p.z)
                - Crossing::new(image, spine, above(anchor[1])).at_foot(self.p.z);
            let Some((x, is_left, change)) = crossing.on_line(self.p) else {
                continue;
            };
            if is_left && x > left {
                depth -= change;
            }
            if (is_left && x > left) || (!is_left && x < right) {
                let x = x.clamp(left, right);
                events.push(Event { x, change });
            }
        }
        events.sort_by(|a, b| a.x.total_cmp(&b.x));
        seen.crossings += events.len();
        let (mut at, mut visible) = (left, 0.0);
        let end = Event {
            x: right,
            change: 0.0,
        };
        for event in events.into_iter().chain([end]) {
            if event.x > at {
                seen.least = seen.least.min(depth as i32);
            }
            if depth == 0.0 {
                visible += event.x - at;
            }
            at = event.x;
            depth += event.change;
        }
        visible
    }

    /// D at a point of the light, by all facets.
    fn depth(&self, s: [f64; 2]) -> i32 {
        let to = self.light.frame.at(s);
        let own = self.receiver.own.map_or(NONE, |(patch, _)| patch);
        let counts = |f: &&Facet| f.patch != own && crosses(f, self.receiver.point, to);
        self.casters.facets.iter().filter(counts).count() as i32
    }
}

/// Whether the segment from `p` to `s` crosses a facet that counts.
fn crosses(facet: &Facet, p: DVec3, s: DVec3) -> bool {
    let [a, b, c] = facet.corners.map(|v| v - p);
    let direction = s - p;
    let sides = [a.cross(b), b.cross(c), c.cross(a)].map(|n| n.dot(direction));
    let normal = (b - a).cross(c - a);
    let slope = normal.dot(direction);
    let along = normal.dot(a) / slope;
    let through = sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
    through && along > 0.0 && along < 1.0 && (facet.both || slope > 0.0)
}

/// Where an edge crosses the spine and a line.
struct Crossing<'a> {
    image: &'a Image,
    spine: [f64; 2],
    line: [f64; 2],
    /// Along the edge; infinite where it does not cross.
    at_spine: f64,
    at_line: f64,
}

impl<'a> Crossing<'a> {
    fn new(image: &'a Image, spine: impl Fn(&DVec3) -> f64, line: impl Fn(&DVec3) -> f64) -> Self {
        let [spine, line] = [
            [spine(&image.ends[0]), spine(&image.ends[1])],
            [line(&image.ends[0]), line(&image.ends[1])],
        ];
        let along = |[a, b]: [f64; 2]| match (a < 0.0) == (b < 0.0) {
            true => f64::INFINITY,
            false => a / (a - b),
        };
        Self {
            image,
            spine,
            line,
            at_spine: along(spine),
            at_line: along(line),
        }
    }

    fn spine_first(&self) -> bool {
        self.at_spine < self.at_line
    }

    /// Between the receiver and the light.
    fn is_between(&self, t: f64, height: f64) -> bool {
        let [a, b] = self.image.ends.map(|v| v.z);
        let z = a + (b - a) * t;
        z > 0.0 && z < height
    }

    /// What the edge adds to D where the spine meets the line, from far below.
    fn at_foot(&self, height: f64) -> f64 {
        if self.at_spine == f64::INFINITY || !self.is_between(self.at_spine, height) {
            return 0.0;
        }
        let rightwards = self.spine[0] < 0.0;
        let end = usize::from(!self.spine_first());
        match (self.line[end] < 0.0, rightwards) {
            (false, _) => 0.0,
            (true, true) => self.image.jump,
            (true, false) => -self.image.jump,
        }
    }

    /// x on the line, whether left of the foot, and what D changes by there, from left to
    /// right.
    fn on_line(&self, p: DVec3) -> Option<(f64, bool, f64)> {
        if self.at_line == f64::INFINITY || !self.is_between(self.at_line, p.z) {
            return None;
        }
        let [a, b] = &self.image.ends;
        let t = self.at_line;
        let (x, z) = (a.x + (b.x - a.x) * t, a.z + (b.z - a.z) * t);
        let end = usize::from(self.spine_first());
        let upwards = self.line[0] < 0.0;
        let change = if upwards {
            -self.image.jump
        } else {
            self.image.jump
        };
        Some((p.x + p.z * (x / z), self.spine[end] < 0.0, change))
    }
}
