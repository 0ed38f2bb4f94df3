//! Viewport transform, snapping, and triangles of points, lines and polygons (rules, §3).

use gnomon_raster::state::{CullMode, FrontFace, PrimitiveState, PrimitiveTopology, Viewport};
use gnomon_raster::{MAX_VARYINGS, PrimitiveCounters};

use super::clip::{Clipped, Clipper, Screen};
use super::convert::rne;
use super::vertex::Vertex;

/// Largest snapped coordinate: 16384 pixels.
const SNAP_LIMIT: f64 = 4_194_304.0;

/// A corner of a triangle on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Snapped position, 24.8.
    pub(super) xy: [i64; 2],
    pub(super) z: f32,
    pub(super) inverse_w: f32,
    pub(super) vertex: Vertex,
}

/// A triangle that is rasterised.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [Corner; 3],
    /// Varyings of the primitive's vertex 0.
    pub(super) flat: [f32; MAX_VARYINGS],
    pub(super) front: bool,
    pub(super) primitive: u32,
    pub(super) piece: u32,
}

impl Triangle {
    pub(super) fn xy(&self) -> [[i64; 2]; 3] {
        self.corners.map(|c| c.xy)
    }
}

/// Doubled area, positive for clockwise with y up.
pub(super) fn doubled_area([a, b, c]: [[i64; 2]; 3]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

/// State that turns primitives into triangles.
pub(super) struct Setup<'a> {
    pub(super) state: &'a PrimitiveState,
    viewport: Viewport,
    screen: Screen,
    clipper: Clipper,
}

impl<'a> Setup<'a> {
    pub(super) fn new(state: &'a PrimitiveState, viewport: Viewport) -> Self {
        let screen = Screen::new(&viewport);
        Self {
            state,
            viewport,
            screen,
            clipper: Clipper::new(&screen, state.depth_clamp),
        }
    }

    /// Triangles of one primitive, in order.
    pub(super) fn triangles(
        &self,
        vertices: &[Vertex],
        primitive: u32,
        c: &mut PrimitiveCounters,
    ) -> Vec<Triangle> {
        c.input += 1;
        if vertices.iter().any(|v| !v.is_finite()) {
            c.non_finite += 1;
            return Vec::new();
        }
        let polygon = match self.clipper.clip(vertices) {
            Clipped::Culled => Vec::new(),
            Clipped::Whole => vertices.to_vec(),
            Clipped::Cut(polygon) => {
                c.clipped += 1;
                polygon
            }
        };
        if polygon.len() < vertices.len() {
            c.frustum_culled += 1;
            return Vec::new();
        }
        let Some(corners) = polygon
            .iter()
            .map(|v| self.corner(v))
            .collect::<Option<Vec<_>>>()
        else {
            c.non_finite += 1;
            return Vec::new();
        };
        self.pieces(&corners, c)
            .into_iter()
            .zip(0..)
            .filter_map(|(corners, piece)| {
                let flat = vertices[0].varyings;
                self.finish(
                    Triangle {
                        corners,
                        flat,
                        front: true,
                        primitive,
                        piece,
                    },
                    c,
                )
            })
            .collect()
    }

    /// Nothing where cutting an edge between vertices of wildly different
    /// magnitude has left a vertex outside the guard band.
    fn corner(&self, v: &Vertex) -> Option<Corner> {
        let [x, y, z, w] = v.position;
        let (s, port) = (&self.screen, &self.viewport);
        let sx = s.cx + (x / w) * s.hw;
        let sy = s.cy - (y / w) * s.hh;
        let z = (z / w) * (port.max_depth - port.min_depth) + port.min_depth;
        let snap = |v: f32| rne(256.0 * f64::from(v));
        let inside = snap(sx).abs() <= SNAP_LIMIT && snap(sy).abs() <= SNAP_LIMIT && z.is_finite();
        inside.then(|| Corner {
            xy: [snap(sx) as i64, snap(sy) as i64],
            z,
            inverse_w: 1.0 / w,
            vertex: *v,
        })
    }

    fn pieces(&self, corners: &[Corner], c: &mut PrimitiveCounters) -> Vec<[Corner; 3]> {
        match self.state.topology {
            PrimitiveTopology::TriangleList => (1..corners.len() - 1)
                .map(|k| [corners[0], corners[k], corners[k + 1]])
                .collect(),
            PrimitiveTopology::PointList => point(corners[0], self.state.point_size),
            PrimitiveTopology::LineList => {
                let pieces = line(corners[0], corners[1], self.state.line_width);
                c.degenerate += u64::from(pieces.is_empty());
                pieces
            }
        }
    }

    /// Degenerate and facing tests.
    fn finish(&self, mut t: Triangle, c: &mut PrimitiveCounters) -> Option<Triangle> {
        let area = doubled_area(t.xy());
        if area == 0 {
            c.degenerate += 1;
            return None;
        }
        if self.state.topology == PrimitiveTopology::TriangleList {
            t.front = (area < 0) == (self.state.front_face == FrontFace::Ccw);
            let culled = match self.state.cull_mode {
                CullMode::None => false,
                CullMode::Front => t.front,
                CullMode::Back => !t.front,
            };
            if culled {
                c.face_culled += 1;
                return None;
            }
        }
        c.rasterized += 1;
        Some(t)
    }
}

fn point(p: Corner, size: f32) -> Vec<[Corner; 3]> {
    let h = rne(128.0 * f64::from(size)) as i64;
    let at = |dx: i64, dy: i64| Corner {
        xy: [p.xy[0] + dx, p.xy[1] + dy],
        ..p
    };
    quad([at(-h, -h), at(h, -h), at(h, h), at(-h, h)])
}

/// Nothing for a line of no length.
fn line(p0: Corner, p1: Corner, width: f32) -> Vec<[Corner; 3]> {
    let dx = (p1.xy[0] - p0.xy[0]) as f64;
    let dy = (p1.xy[1] - p0.xy[1]) as f64;
    let len = (dx * dx + dy * dy).sqrt();
    if len == 0.0 {
        return Vec::new();
    }
    let ox = rne(-dy / len * 128.0 * f64::from(width)) as i64;
    let oy = rne(dx / len * 128.0 * f64::from(width)) as i64;
    let at = |p: Corner, s: i64| Corner {
        xy: [p.xy[0] + s * ox, p.xy[1] + s * oy],
        ..p
    };
    quad([at(p0, -1), at(p1, -1), at(p1, 1), at(p0, 1)])
}

fn quad([a, b, c, d]: [Corner; 4]) -> Vec<[Corner; 3]> {
    vec![[a, b, c], [a, c, d]]
}
