//! From homogeneous world points to pixels, clipped at the near plane.

use gnomon_pipeline::world::scene::Camera;

/// Coordinates beyond this many image sizes are cut, so that no path is absurdly long.
const GUARD: f64 = 16.0;

/// A clip-space point.
type Clip = [f64; 4];

/// A point of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pixel {
    /// Column and row, y down.
    pub(crate) at: [f32; 2],
    /// Depth as the depth buffer has it.
    pub(crate) depth: f64,
}

/// World to pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    clip_from_world: [[f64; 4]; 4],
    size: [f64; 2],
}

impl Projection {
    /// For a picture of `size` pixels.
    pub(crate) fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let rows = camera.clip_from_world(aspect);
        Self {
            clip_from_world: rows.map(|r| r.map(f64::from)),
            size: size.map(f64::from),
        }
    }

    /// The visible part of the polygon with homogeneous world-space corners
    /// (w = 0 is a direction); empty when it is behind the eye.
    pub(crate) fn polygon(&self, corners: &[[f32; 4]]) -> Vec<[f32; 2]> {
        let mut clip: Vec<Clip> = corners.iter().map(|c| self.to_clip(*c)).collect();
        for inside in PLANES {
            clip = cut(&clip, inside);
        }
        clip.iter().map(|p| self.to_pixel(p).at).collect()
    }

    /// The visible part of a segment between two points.
    pub(crate) fn segment(&self, ends: [[f32; 4]; 2]) -> Option<[Pixel; 2]> {
        let mut ends = ends.map(|e| self.to_clip(e));
        for inside in PLANES {
            let [a, b] = ends;
            match (inside(&a) >= 0.0, inside(&b) >= 0.0) {
                (true, true) => {}
                (true, false) => ends = [a, between(&a, &b, inside)],
                (false, true) => ends = [between(&b, &a, inside), b],
                (false, false) => return None,
            }
        }
        Some(ends.map(|e| self.to_pixel(&e)))
    }

    fn to_clip(self, p: [f32; 4]) -> Clip {
        let p = p.map(f64::from);
        self.clip_from_world
            .map(|r| r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3] * p[3])
    }

    fn to_pixel(self, p: &Clip) -> Pixel {
        let x = (p[0] / p[3] + 1.0) / 2.0 * self.size[0];
        let y = (1.0 - p[1] / p[3]) / 2.0 * self.size[1];
        Pixel {
            at: [x as f32, y as f32],
            depth: p[2] / p[3],
        }
    }
}

/// Near plane, then a guard band round the image; inside is >= 0.
const PLANES: [fn(&Clip) -> f64; 5] = [
    |p| p[2],
    |p| GUARD * p[3] - p[0],
    |p| GUARD * p[3] + p[0],
    |p| GUARD * p[3] - p[1],
    |p| GUARD * p[3] + p[1],
];

/// Where the segment from `a` (inside) to `b` leaves.
fn between(a: &Clip, b: &Clip, inside: fn(&Clip) -> f64) -> Clip {
    let (da, db) = (inside(a), inside(b));
    let t = da / (da - db);
    [0, 1, 2, 3].map(|i| a[i] + t * (b[i] - a[i]))
}

fn cut(polygon: &[Clip], inside: fn(&Clip) -> f64) -> Vec<Clip> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let stays = inside(a) >= 0.0;
        if stays {
            out.push(*a);
        }
        if stays != (inside(b) >= 0.0) {
            out.push(if stays {
                between(a, b, inside)
            } else {
                between(b, a, inside)
            });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight() -> Projection {
        Projection::new(
            &Camera::look_at([0.0, 0.0, 5.0], [0.0, 0.0, 0.0]),
            [100, 100],
        )
    }

    #[test]
    fn the_target_is_in_the_middle_and_points_behind_vanish() {
        let seen = straight()
            .segment([[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]])
            .unwrap();
        assert_eq!(seen[0].at, [50.0, 50.0]);
        assert!(seen[1].at[1] < 50.0, "y is up in the world");
        assert!(
            straight()
                .segment([[0.0, 0.0, 6.0, 1.0], [1.0, 0.0, 9.0, 1.0]])
                .is_none()
        );
    }

    #[test]
    fn quads_to_infinity_are_cut_to_finite_pixels() {
        let quad = [
            [-1.0, 0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0, 1.0],
            [0.1, 0.1, 1.0, 0.0],
            [-0.1, 0.1, 1.0, 0.0],
        ];
        let polygon = straight().polygon(&quad);
        assert!(polygon.len() >= 3);
        assert!(
            polygon
                .iter()
                .flatten()
                .all(|c| c.is_finite() && c.abs() <= 17.0 * 100.0)
        );
    }
}
