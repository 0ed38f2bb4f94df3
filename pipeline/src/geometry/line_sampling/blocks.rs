//! Where the receivers in blocks of pixels are: boxes that hold them, without drawing.
//!
//! A triangle that is small on the screen enlarges the boxes of the blocks that it touches
//! by its own; of a large one only what the block's corners' rays meet of its plane. What is
//! hidden behind other surfaces counts too: boxes are never too small.

use glam::DVec3;
use rayon::prelude::*;

use super::shaft::Bounds;
use crate::world::scene::{Camera, EyeRays};

/// Pixels along a side of a block.
pub const BLOCK: u32 = 8;
/// Blocks that a triangle may touch and still give each of them its whole box.
const FEW: usize = 4;
/// How far a pixel's position may be off its triangle, in pixels: vertices are snapped to
/// 1/256, in two directions.
const SNAPPED: f64 = 1.0 / 64.0;
/// Least cosine between ray and facet that enlarges that; flatter facets are interpolated.
const EDGE_ON: f64 = 1e-3;
/// Rounding of positions in f32, as a share of coordinates, and more.
const ROUNDED: f64 = 1e-6;
/// Triangles that one thread takes at a time.
const CHUNK: usize = 2048;

/// Boxes of blocks, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockBounds {
    /// Blocks in a row, and rows.
    pub size: [u32; 2],
    /// One for each block; empty where nothing receives.
    pub bounds: Vec<Bounds>,
}

impl BlockBounds {
    /// Of the receivers `triangles` (world space) in a picture of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2], triangles: &[[DVec3; 3]]) -> Self {
        let screen = Screen::new(camera, size);
        let parts: Vec<Self> = triangles
            .par_chunks(CHUNK)
            .map(|part| {
                let mut own = Self::empty(size);
                part.iter().for_each(|t| screen.add(t, &mut own));
                own
            })
            .collect();
        let mut all = Self::empty(size);
        for part in &parts {
            for (whole, part) in all.bounds.iter_mut().zip(&part.bounds) {
                *whole = whole.joined(part);
            }
        }
        all
    }

    fn empty(size: [u32; 2]) -> Self {
        let size = size.map(|n| n.div_ceil(BLOCK));
        Self {
            size,
            bounds: vec![Bounds::EMPTY; (size[0] * size[1]) as usize],
        }
    }

    /// The box of a square of `side` blocks from column `x` and row `y` on.
    pub fn square(&self, [x, y]: [u32; 2], side: u32) -> Bounds {
        let rows = y..(y + side).min(self.size[1]);
        let columns = x..(x + side).min(self.size[0]);
        let blocks = rows.flat_map(|row| columns.clone().map(move |column| (row, column)));
        blocks.fold(Bounds::EMPTY, |all, (row, column)| {
            all.joined(&self.bounds[(row * self.size[0] + column) as usize])
        })
    }
}

/// The camera as blocks need it.
struct Screen {
    rays: EyeRays,
    eye: DVec3,
    basis: [DVec3; 3],
    /// Pixels of a tangent of 1.
    scale: f64,
    near: f64,
    size: [f64; 2],
    blocks: [u32; 2],
}

/// A triangle on the screen.
struct Outline {
    /// Pixels, where all corners are before the near plane.
    corners: Option<[[f64; 2]; 3]>,
    bounds: Bounds,
    normal: DVec3,
    slack: f64,
}

impl Screen {
    fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let [width, height] = size.map(f64::from);
        Self {
            rays: camera.eye_rays(size[0], size[1]),
            eye: camera.eye,
            basis: camera.basis(),
            scale: 0.5 * height / camera.tan_half_fov(),
            near: camera.near,
            size: [width, height],
            blocks: size.map(|n| n.div_ceil(BLOCK)),
        }
    }

    /// Pixels and depth.
    fn place(&self, p: DVec3) -> [f64; 3] {
        let [right, up, forward] = self.basis;
        let from = p - self.eye;
        let depth = forward.dot(from);
        let at = |along: f64, half: f64| half + along * self.scale / depth;
        [
            at(right.dot(from), 0.5 * self.size[0]),
            at(-up.dot(from), 0.5 * self.size[1]),
            depth,
        ]
    }

    fn add(&self, triangle: &[DVec3; 3], to: &mut BlockBounds) {
        let outline = self.outline(triangle);
        let Some([columns, rows]) = self.touched(&outline) else {
            return;
        };
        let few = (columns.1 - columns.0 + 1) as usize * (rows.1 - rows.0 + 1) as usize <= FEW;
        let own = outline.bounds.grown(outline.slack);
        for row in rows.0..=rows.1 {
            for column in columns.0..=columns.1 {
                let bounds = if few && outline.corners.is_some() {
                    own
                } else if outline.misses([column, row]) {
                    continue;
                } else {
                    self.seen_in(&outline, triangle[0], [column, row])
                        .common(&own)
                };
                let block = &mut to.bounds[(row * self.blocks[0] + column) as usize];
                if !bounds.is_empty() {
                    *block = block.joined(&bounds);
                }
            }
        }
    }

    fn outline(&self, triangle: &[DVec3; 3]) -> Outline {
        let [a, b, c] = *triangle;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let placed = triangle.map(|p| self.place(p));
        let before = placed.iter().all(|p| p[2] >= self.near);
        let farthest = placed.iter().fold(0.0, |most: f64, p| most.max(p[2]));
        let cosine = triangle.map(|p| normal.dot((p - self.eye).normalize_or_zero()).abs());
        let flattest = cosine.into_iter().fold(1.0, f64::min);
        let bounds = Bounds::of(*triangle);
        Outline {
            corners: before.then(|| placed.map(|[x, y, _]| [x, y])),
            slack: self.slack(farthest, flattest) + ROUNDED * bounds.largest(),
            bounds,
            normal,
        }
    }

    /// How far a position may be off, at a depth on a facet that is met under a cosine.
    fn slack(&self, depth: f64, cosine: f64) -> f64 {
        let rounded = ROUNDED * (self.eye.abs().max_element() + depth);
        depth / self.scale * SNAPPED / cosine.max(EDGE_ON) + rounded
    }

    /// First and last columns and rows of blocks.
    fn touched(&self, outline: &Outline) -> Option<[(u32, u32); 2]> {
        let whole = [(0, self.blocks[0] - 1), (0, self.blocks[1] - 1)];
        let Some(corners) = outline.corners else {
            let [_, _, forward] = self.basis;
            let beyond = |p: DVec3| forward.dot(p - self.eye) > 0.0;
            let (low, high) = (outline.bounds.low, outline.bounds.high);
            let any = (0..8).any(|k: u32| {
                let pick = |bit: u32, a: f64, b: f64| if k >> bit & 1 == 0 { a } else { b };
                beyond(DVec3::new(
                    pick(0, low.x, high.x),
                    pick(1, low.y, high.y),
                    pick(2, low.z, high.z),
                ))
            });
            return any.then_some(whole);
        };
        let mut touched = whole;
        for k in 0..2 {
            let [low, high] = corners.iter().fold([f64::MAX, f64::MIN], |[low, high], c| {
                [low.min(c[k]), high.max(c[k])]
            });
            if high < -1.0 || low > self.size[k] + 1.0 {
                return None;
            }
            let block = |x: f64| {
                (x / f64::from(BLOCK))
                    .floor()
                    .clamp(0.0, f64::from(whole[k].1))
            };
            touched[k] = (block(low - 1.0) as u32, block(high + 1.0) as u32);
        }
        Some(touched)
    }

    /// What rays through a block's corners meet of the triangle's plane, and so all others
    /// of the block; all of space where one does not.
    fn seen_in(&self, outline: &Outline, a: DVec3, [column, row]: [u32; 2]) -> Bounds {
        let all = Bounds {
            low: DVec3::NEG_INFINITY,
            high: DVec3::INFINITY,
        };
        let side = f64::from(BLOCK);
        let (x, y) = (f64::from(column) * side, f64::from(row) * side);
        let height = outline.normal.dot(a - self.eye);
        let (mut bounds, mut slack) = (Bounds::EMPTY, 0.0f64);
        for (dx, dy) in [(0.0, 0.0), (side, 0.0), (0.0, side), (side, side)] {
            let direction = self.rays.direction(x + dx, y + dy);
            let along = height / outline.normal.dot(direction);
            if !(along > 0.0 && along.is_finite()) {
                return all;
            }
            let at = self.eye + direction * along;
            let cosine = outline.normal.dot(direction.normalize()).abs();
            slack = slack.max(self.slack(along, cosine));
            bounds = bounds.joined(&Bounds { low: at, high: at });
        }
        bounds.grown(slack)
    }
}

impl Outline {
    /// Whether a block, and a pixel round it, is beyond one edge.
    fn misses(&self, [column, row]: [u32; 2]) -> bool {
        let Some([a, b, c]) = self.corners else {
            return false;
        };
        let side = f64::from(BLOCK);
        let (low, high) = (
            [f64::from(column) * side - 1.0, f64::from(row) * side - 1.0],
            [
                f64::from(column) * side + side + 1.0,
                f64::from(row) * side + side + 1.0,
            ],
        );
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let sign = if turn < 0.0 { -1.0 } else { 1.0 };
        [[a, b], [b, c], [c, a]].iter().any(|[from, to]| {
            // Inside is where this is positive.
            let (x, y) = (-(to[1] - from[1]) * sign, (to[0] - from[0]) * sign);
            let most = x * if x > 0.0 {
                high[0] - from[0]
            } else {
                low[0] - from[0]
            } + y * if y > 0.0 {
                high[1] - from[1]
            } else {
                low[1] - from[1]
            };
            most < 0.0
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::oracle::surfaces::Surfaces;
    use crate::world::scene::builtin;

    /// Every point that is seen lies in the box of its block, and one thread finds the same
    /// boxes as many.
    #[test]
    fn boxes_hold_what_is_seen_on_any_number_of_threads() {
        for name in ["peer-a", "creature", "adversarial-near-plane", "cylinder"] {
            let scene = builtin::build(name).unwrap();
            let size = [150, 90];
            let surfaces = Surfaces::new(&scene);
            let blocks = BlockBounds::new(&scene.camera, size, surfaces.corners());
            let alone = rayon::ThreadPoolBuilder::new()
                .num_threads(1)
                .build()
                .unwrap();
            let again = alone.install(|| BlockBounds::new(&scene.camera, size, surfaces.corners()));
            assert!(blocks == again, "{name}");
            let rays = scene.camera.eye_rays(size[0], size[1]);
            let mut seen = 0;
            for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
                let at = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                let Some(receiver) = surfaces.receiver(&rays, at.0, at.1) else {
                    continue;
                };
                let block = y / BLOCK * blocks.size[0] + x / BLOCK;
                let bounds = blocks.bounds[block as usize];
                assert_eq!(bounds.distance(receiver.point), 0.0, "{name} {x} {y}");
                seen += 1;
            }
            assert!(seen > 2000, "{name}: {seen}");
        }
    }
}
