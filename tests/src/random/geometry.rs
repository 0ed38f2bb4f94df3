//! Geometry that is hard to rasterise, in clip space.

use gnomon_raster::state::Viewport;

use super::Random;

/// Maps pixels to clip space, against the viewport transform.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    viewport: Viewport,
}

impl Screen {
    /// Of a viewport.
    #[must_use]
    pub fn new(viewport: Viewport) -> Self {
        Self { viewport }
    }

    /// The position that lands on (x, y) with NDC depth z.
    #[must_use]
    pub fn place(&self, x: f32, y: f32, z: f32, w: f32) -> [f32; 4] {
        let v = &self.viewport;
        let (hw, hh) = (v.width * 0.5, v.height * 0.5);
        [
            (x - (v.x + hw)) / hw * w,
            ((v.y + hh) - y) / hh * w,
            z * w,
            w,
        ]
    }

    fn inside(&self, r: &mut Random) -> [f32; 2] {
        let v = &self.viewport;
        [r.float(v.x, v.x + v.width), r.float(v.y, v.y + v.height)]
    }
}

/// Vertex positions, in triples where triangles are meant.
pub(super) fn random_positions(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    match r.below(16) {
        0 | 1 => on_screen(r, s),
        2 => tiny(r, s),
        3 => slivers(r, s),
        4 => fan(r, s),
        5 => huge(r, s),
        6 => around_the_eye(r),
        7 => directions(r),
        8 | 9 => layers(r, s),
        10 => grid(r, s),
        11 => on_centres(r, s),
        12 => degenerate(r, s),
        13 => not_finite(r, s),
        14 => extreme(r),
        _ => near_plane(r, s),
    }
}

/// Often one of few values, so that depths meet.
fn depth(r: &mut Random) -> f32 {
    if r.one_in(3) {
        r.float(-0.25, 1.25)
    } else {
        r.pick(&[0.0, 0.25, 0.5, 0.75, 1.0])
    }
}

fn w(r: &mut Random) -> f32 {
    if r.one_in(3) { r.float(0.25, 4.0) } else { 1.0 }
}

fn triangles(
    r: &mut Random,
    most: i32,
    mut corner: impl FnMut(&mut Random) -> [f32; 4],
) -> Vec<[f32; 4]> {
    let n = r.between(1, most);
    (0..3 * n).map(|_| corner(r)).collect()
}

fn on_screen(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let flat = r.one_in(2).then(|| depth(r));
    triangles(r, 8, |r| {
        let [x, y] = s.inside(r);
        let z = flat.unwrap_or_else(|| depth(r));
        s.place(x, y, z, w(r))
    })
}

fn tiny(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let size = r.pick(&[0.01, 0.5, 2.0, 6.0]);
    let mut list = Vec::new();
    for _ in 0..r.between(1, 40) {
        let ([x, y], z, w) = (s.inside(r), depth(r), w(r));
        for _ in 0..3 {
            list.push(s.place(x + r.float(-size, size), y + r.float(-size, size), z, w));
        }
    }
    list
}

fn slivers(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let mut list = Vec::new();
    for _ in 0..r.between(1, 10) {
        let (a, b, t) = (s.inside(r), s.inside(r), r.float(0.0, 1.0));
        let c = [0, 1].map(|k| a[k] + (b[k] - a[k]) * t + r.float(-0.02, 0.02));
        for p in [a, b, c] {
            list.push(s.place(p[0], p[1], depth(r), w(r)));
        }
    }
    list
}

/// Triangles around one vertex, sharing edges.
fn fan(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let corner = |r: &mut Random| {
        let [x, y] = s.inside(r);
        s.place(x, y, depth(r), 1.0)
    };
    let centre = corner(r);
    let rim: Vec<_> = (0..r.between(3, 9)).map(|_| corner(r)).collect();
    (0..rim.len())
        .flat_map(|k| [centre, rim[k], rim[(k + 1) % rim.len()]])
        .collect()
}

fn huge(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let size = r.pick(&[300.0, 5000.0, 20000.0, 1e6]);
    triangles(r, 6, |r| {
        s.place(r.float(-size, size), r.float(-size, size), depth(r), w(r))
    })
}

/// In front of, behind and beside the eye.
fn around_the_eye(r: &mut Random) -> Vec<[f32; 4]> {
    triangles(r, 6, |r| {
        [
            r.float(-2.0, 2.0),
            r.float(-2.0, 2.0),
            r.float(-1.0, 2.0),
            r.float(-1.0, 2.0),
        ]
    })
}

/// Vertices at infinity, as the dark caps of shadow volumes have.
fn directions(r: &mut Random) -> Vec<[f32; 4]> {
    triangles(r, 6, |r| {
        let at_infinity = r.one_in(2);
        let [x, y] = [r.float(-1.5, 1.5), r.float(-1.5, 1.5)];
        if at_infinity {
            [x, y, r.pick(&[0.0, 0.5, -0.5]), 0.0]
        } else {
            [x, y, r.float(0.0, 1.0), 1.0]
        }
    })
}

/// Everything covered, level or slanted in depth.
fn layers(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let v = s.viewport;
    let mut list = Vec::new();
    for _ in 0..r.between(1, 3) {
        let slant = if r.one_in(2) { 0.0 } else { r.float(-0.4, 0.4) };
        let z = depth(r);
        let [a, b, c, d] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(i, j)| {
            s.place(
                v.x + i * v.width,
                v.y + j * v.height,
                z + slant * (i + j),
                1.0,
            )
        });
        let turned = r.one_in(2);
        list.extend(if turned {
            [a, c, b, a, d, c]
        } else {
            [a, b, c, a, c, d]
        });
    }
    list
}

fn grid(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let n = r.between(2, 9) as u32;
    let v = s.viewport;
    let corner = [v.x + r.float(-4.0, 4.0), v.y + r.float(-4.0, 4.0)];
    let step = [v.width / n as f32, v.height / n as f32].map(|f| f * r.pick(&[0.3, 1.0]));
    let jitter = r.pick(&[0.0, 0.4]);
    let points = grid_triangulation(r, n, corner, step, jitter);
    let z = depth(r);
    points
        .into_iter()
        .flatten()
        .map(|[x, y]| s.place(x, y, z, 1.0))
        .collect()
}

/// Triangles of an n×n grid of cells with displaced inner vertices, all edges shared.
pub fn grid_triangulation(
    r: &mut Random,
    n: u32,
    corner: [f32; 2],
    step: [f32; 2],
    jitter: f32,
) -> Vec<[[f32; 2]; 3]> {
    let mut vertices = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            let moved = [r.float(-jitter, jitter), r.float(-jitter, jitter)];
            let border = i == 0 || j == 0 || i == n || j == n;
            let [dx, dy] = if border { [0.0; 2] } else { moved };
            vertices.push([
                corner[0] + (i as f32 + dx) * step[0],
                corner[1] + (j as f32 + dy) * step[1],
            ]);
        }
    }
    let mut list = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let k = (j * (n + 1) + i) as usize;
            let [a, b, c, d] =
                [k, k + 1, k + n as usize + 2, k + n as usize + 1].map(|k| vertices[k]);
            let halves = if r.one_in(2) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            list.extend(halves.map(|[p, q, o]| if r.one_in(2) { [p, o, q] } else { [p, q, o] }));
        }
    }
    list
}

fn on_centres(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let v = s.viewport;
    triangles(r, 8, |r| {
        let at = |r: &mut Random, from: f32, size: f32| {
            from + r.between(-2, 2 * size as i32 + 2) as f32 * 0.5
        };
        let (x, y) = (at(r, v.x, v.width), at(r, v.y, v.height));
        s.place(x, y, depth(r), 1.0)
    })
}

fn degenerate(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let mut list = on_screen(r, s);
    for k in (0..list.len()).step_by(3) {
        match r.below(4) {
            0 => list[k + 1] = list[k],
            1 => list[k + 2] = std::array::from_fn(|c| (list[k][c] + list[k + 1][c]) * 0.5),
            2 => list[k + 2] = list[k + 1],
            _ => {}
        }
    }
    list
}

fn not_finite(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    let mut list = on_screen(r, s);
    for _ in 0..r.between(1, 3) {
        let (k, c) = (r.below(list.len() as u32) as usize, r.below(4) as usize);
        list[k][c] = r.pick(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
    }
    list
}

/// Any finite exponent.
fn extreme(r: &mut Random) -> Vec<[f32; 4]> {
    triangles(r, 4, |r| {
        let wild = r.one_in(2);
        r.array(|r| {
            let any = f32::from_bits(r.next() & 0xff7f_ffff);
            let tame = r.float(-1.5, 1.5);
            if wild && r.one_in(2) { any } else { tame }
        })
    })
}

/// Perspective triangles that cut the near or far plane.
fn near_plane(r: &mut Random, s: &Screen) -> Vec<[f32; 4]> {
    triangles(r, 6, |r| {
        let [x, y] = s.inside(r);
        let z = r.pick(&[-0.5, -0.001, 0.0, 0.25, 0.999, 1.0, 1.001, 1.5]);
        let w = r.float(0.1, 8.0);
        s.place(x, y, z, w)
    })
}
