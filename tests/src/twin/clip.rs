//! Clipping against w, near, far guard and the guard band (rules, §2).

use gnomon_raster::state::Viewport;

use super::convert::pow2;
use super::vertex::Vertex;

const PLANES: usize = 7;

/// The viewport as the transform uses it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Screen {
    pub(super) cx: f32,
    pub(super) cy: f32,
    pub(super) hw: f32,
    pub(super) hh: f32,
}

impl Screen {
    pub(super) fn new(v: &Viewport) -> Self {
        let (hw, hh) = (v.width * 0.5, v.height * 0.5);
        Self {
            cx: v.x + hw,
            cy: v.y + hh,
            hw,
            hh,
        }
    }
}

/// The planes of one draw.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clipper {
    right: f32,
    left: f32,
    bottom: f32,
    top: f32,
    depth_clamp: bool,
}

/// What clipping leaves of a primitive.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Clipped {
    /// All of it is outside.
    Culled,
    /// Nothing was cut.
    Whole,
    /// The polygon or segment that is left; fewer vertices than needed if nothing is.
    Cut(Vec<Vertex>),
}

impl Clipper {
    pub(super) fn new(s: &Screen, depth_clamp: bool) -> Self {
        Self {
            right: (12288.0 - s.cx) / s.hw,
            left: (s.cx + 4096.0) / s.hw,
            bottom: (12288.0 - s.cy) / s.hh,
            top: (s.cy + 4096.0) / s.hh,
            depth_clamp,
        }
    }

    /// Signed distance of a vertex from a plane.
    fn distance(&self, plane: usize, v: &Vertex) -> f64 {
        let [x, y, z, w] = v.position.map(f64::from);
        match plane {
            0 => w - pow2(-100),
            1 if self.depth_clamp => z + 1024.0 * w,
            1 => z,
            2 => 1024.0 * w - z,
            3 => f64::from(self.right) * w - x,
            4 => f64::from(self.left) * w + x,
            5 => f64::from(self.bottom) * w + y,
            _ => f64::from(self.top) * w - y,
        }
    }

    fn outside(&self, plane: usize, v: &Vertex) -> bool {
        self.distance(plane, v) < 0.0
    }

    /// Clips a point, segment or triangle.
    pub(super) fn clip(&self, vertices: &[Vertex]) -> Clipped {
        let all_outside = |p| vertices.iter().all(|v| self.outside(p, v));
        if (0..PLANES).any(all_outside) || (vertices.len() == 3 && beside_view_volume(vertices)) {
            return Clipped::Culled;
        }
        let crossed: Vec<_> = (0..PLANES)
            .filter(|&p| vertices.iter().any(|v| self.outside(p, v)))
            .collect();
        match (crossed.is_empty(), vertices.len()) {
            (true, _) => Clipped::Whole,
            (false, 1) => Clipped::Culled,
            (false, 2) => Clipped::Cut(self.cut_segment(vertices, &crossed)),
            _ => Clipped::Cut(self.cut_polygon(vertices, &crossed)),
        }
    }

    fn cut_polygon(&self, vertices: &[Vertex], crossed: &[usize]) -> Vec<Vertex> {
        let mut polygon = vertices.to_vec();
        for &p in crossed {
            let mut next = Vec::new();
            for (k, a) in polygon.iter().enumerate() {
                let b = &polygon[(k + 1) % polygon.len()];
                if !self.outside(p, a) {
                    next.push(*a);
                }
                if self.outside(p, a) != self.outside(p, b) {
                    next.push(self.cut(p, a, b));
                }
            }
            polygon = next;
        }
        polygon
    }

    fn cut_segment(&self, vertices: &[Vertex], crossed: &[usize]) -> Vec<Vertex> {
        let (mut a, mut b) = (vertices[0], vertices[1]);
        for &p in crossed {
            match (self.outside(p, &a), self.outside(p, &b)) {
                (true, true) => return Vec::new(),
                (true, false) => a = self.cut(p, &a, &b),
                (false, true) => b = self.cut(p, &a, &b),
                (false, false) => {}
            }
        }
        vec![a, b]
    }

    /// Where the edge between an inside and an outside vertex meets the plane.
    fn cut(&self, plane: usize, a: &Vertex, b: &Vertex) -> Vertex {
        let (inside, outside) = if self.outside(plane, a) {
            (b, a)
        } else {
            (a, b)
        };
        let (di, d_o) = (self.distance(plane, inside), self.distance(plane, outside));
        let t = di / (di - d_o);
        let between = |i: f32, o: f32| (f64::from(i) + t * (f64::from(o) - f64::from(i))) as f32;
        let mut v = Vertex {
            position: std::array::from_fn(|c| between(inside.position[c], outside.position[c])),
            varyings: std::array::from_fn(|k| between(inside.varyings[k], outside.varyings[k])),
        };
        match plane {
            0 => v.position[3] = pow2(-100) as f32,
            1 if !self.depth_clamp => v.position[2] = 0.0,
            _ => {}
        }
        v
    }
}

/// Whether all vertices are beyond the same side of the view volume, none behind the eye.
fn beside_view_volume(vertices: &[Vertex]) -> bool {
    let all = |f: fn([f32; 4]) -> bool| vertices.iter().all(|v| f(v.position));
    let beside = all(|[x, _, _, w]| x > w)
        || all(|[x, _, _, w]| x < -w)
        || all(|[_, y, _, w]| y > w)
        || all(|[_, y, _, w]| y < -w);
    beside && all(|[_, _, _, w]| w > 0.0)
}
