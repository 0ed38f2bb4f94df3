//! How the texels of a picture cover directions, and their way onto a cube.
//!
//! Every texel is cut into parts; each part adds its radiance, weighted by its
//! solid angle, to the cube texel that its centre points at. So a cube texel
//! holds the mean radiance over its directions, and a map of one brightness keeps
//! it exactly.

use std::f64::consts::PI;

use super::EnvironmentError;
use super::cube::{FACES, direction, place_of};
use crate::world::shape::on_circle;
use crate::world::warning::SceneWarning;
use glam::DVec3;

/// Parts along a side of a texel of the cube, at least.
const PARTS: usize = 4;

/// Which directions a picture shows where.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Layout {
    LatitudeLongitude,
    /// Square faces; column and row of each, in faces, and whether it is turned
    /// by half a turn.
    Cube([[usize; 2]; FACES], bool),
}

/// A 4:3 cross: -x, +z, +x, -z from left to right; +y above and -y below +z.
const HORIZONTAL: [[usize; 2]; FACES] = [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]];
/// A 3:4 cross: -z is at the bottom, upside down.
const VERTICAL: [[usize; 2]; FACES] = [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [1, 3]];
const ACROSS: [[usize; 2]; FACES] = [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [5, 0]];
const DOWN: [[usize; 2]; FACES] = [[0, 0], [0, 1], [0, 2], [0, 3], [0, 4], [0, 5]];

/// Linear radiance with a known layout, all texels finite and at least 0.
#[derive(Debug)]
pub(super) struct Picture {
    size: [usize; 2],
    pub(super) texels: Vec<[f32; 3]>,
    layout: Layout,
    pub(super) warnings: Vec<SceneWarning>,
}

/// Radiance of six faces.
pub(super) struct Faces {
    pub(super) side: usize,
    /// Face after face, row by row.
    pub(super) radiance: Vec<[f64; 3]>,
}

impl Picture {
    pub(super) fn new(
        name: &str,
        size: [usize; 2],
        mut texels: Vec<[f32; 3]>,
    ) -> Result<Self, EnvironmentError> {
        let [width, height] = size;
        if texels.len() != width * height {
            return Err(EnvironmentError::Length {
                name: name.to_owned(),
                width,
                height,
                found: texels.len(),
            });
        }
        let layout = layout(size).ok_or_else(|| EnvironmentError::Layout {
            name: name.to_owned(),
            width,
            height,
        })?;
        let warnings = mend(name, &mut texels);
        Ok(Self {
            size,
            texels,
            layout,
            warnings,
        })
    }

    /// Texels round the equator, a quarter of which a face spans.
    fn side(&self) -> usize {
        match self.layout {
            Layout::LatitudeLongitude => self.size[0].div_ceil(4),
            Layout::Cube(..) => self.face_side(),
        }
    }

    fn face_side(&self) -> usize {
        let Layout::Cube(places, _) = self.layout else {
            return 0;
        };
        let columns = places.iter().map(|p| p[0] + 1).max().unwrap_or(1);
        self.size[0] / columns
    }

    /// Spread over faces of at most `most` texels a side, turned about +y by
    /// `turn` degrees.
    pub(super) fn faces(&self, most: usize, turn: f64) -> Faces {
        let side = self.side().min(most);
        let parts = (PARTS * side).div_ceil(self.side()).max(1) * self.more_parts();
        let mut sums = vec![[0.0f64; 4]; FACES * side * side];
        let (cos, sin) = on_circle(turn.to_radians());
        let turned = |d: DVec3| DVec3::new(d.x * cos + d.z * sin, d.y, d.z * cos - d.x * sin);
        let mut add = |d: DVec3, weight: f64, rgb: [f32; 3]| {
            let d = if turn == 0.0 { d } else { turned(d) };
            let (face, at) = place_of(d);
            let [x, y] = at.map(|c| {
                let texel = ((c + 1.0) * 0.5 * side as f64) as usize;
                texel.min(side - 1)
            });
            let sum = &mut sums[(face * side + y) * side + x];
            (0..3).for_each(|c| sum[c] += weight * f64::from(rgb[c]));
            sum[3] += weight;
        };
        match self.layout {
            Layout::LatitudeLongitude => self.spread_sphere(parts, &mut add),
            Layout::Cube(places, upside) => self.spread_cube(places, upside, parts, &mut add),
        }
        // Parts are finer than texels, so that none is without.
        let mean = |s: &[f64; 4]| [0, 1, 2].map(|c| if s[3] > 0.0 { s[c] / s[3] } else { 0.0 });
        Faces {
            side,
            radiance: sums.iter().map(mean).collect(),
        }
    }

    /// A texel of the sphere is narrower at a face's corner than the cube's; the
    /// smallest maps have texels that are hardly square.
    fn more_parts(&self) -> usize {
        match self.layout {
            Layout::LatitudeLongitude if self.size[0] < 16 => 8,
            Layout::LatitudeLongitude => 1,
            Layout::Cube(..) => 1,
        }
    }

    fn spread_sphere(&self, parts: usize, add: &mut impl FnMut(DVec3, f64, [f32; 3])) {
        let [width, height] = self.size;
        let middle = |k: usize, n: usize| (k as f64 + 0.5) / (n * parts) as f64;
        let columns: Vec<(f64, f64)> = (0..width * parts)
            .map(|k| on_circle(2.0 * PI * (middle(k, width) - 0.5)))
            .collect();
        for row in 0..height * parts {
            let (up, ring) = on_circle(PI * middle(row, height));
            for (k, (ahead, right)) in columns.iter().enumerate() {
                let d = DVec3::new(ring * right, up, -ring * ahead);
                add(d, ring, self.texels[row / parts * width + k / parts]);
            }
        }
    }

    fn spread_cube(
        &self,
        places: [[usize; 2]; FACES],
        upside: bool,
        parts: usize,
        add: &mut impl FnMut(DVec3, f64, [f32; 3]),
    ) {
        let side = self.face_side();
        let fine = side * parts;
        let middle = |k: usize| -1.0 + (2.0 * k as f64 + 1.0) / fine as f64;
        for (face, [column, row]) in places.into_iter().enumerate() {
            for (y, x) in (0..fine).flat_map(|y| (0..fine).map(move |x| (y, x))) {
                let at = [middle(x), middle(y)];
                let squared = 1.0 + at[0] * at[0] + at[1] * at[1];
                let [mut px, mut py] = [x / parts, y / parts];
                if upside && face == 5 {
                    [px, py] = [side - 1 - px, side - 1 - py];
                }
                let texel = (row * side + py) * self.size[0] + column * side + px;
                let weight = 1.0 / (squared * squared.sqrt());
                add(direction(face, at), weight, self.texels[texel]);
            }
        }
    }
}

fn layout([width, height]: [usize; 2]) -> Option<Layout> {
    let is = |w: usize, h: usize| width >= w && width * h == height * w && width.is_multiple_of(w);
    match () {
        () if width == 1 && height == 1 => Some(Layout::LatitudeLongitude),
        () if is(2, 1) => Some(Layout::LatitudeLongitude),
        () if is(4, 3) => Some(Layout::Cube(HORIZONTAL, false)),
        () if is(3, 4) => Some(Layout::Cube(VERTICAL, true)),
        () if is(6, 1) => Some(Layout::Cube(ACROSS, false)),
        () if is(1, 6) => Some(Layout::Cube(DOWN, false)),
        () => None,
    }
}

/// Makes NaN and negative numbers 0 and infinite ones as large as the largest
/// finite one; says how many texels had some.
fn mend(name: &str, texels: &mut [[f32; 3]]) -> Vec<SceneWarning> {
    let finite = texels.iter().flatten().filter(|v| v.is_finite());
    let largest = finite.fold(0.0f32, |m, v| if *v > m { *v } else { m });
    let mut mended = |code, what: &str, wrong: fn(f32) -> bool, right: f32| {
        let mut count = 0;
        for texel in texels.iter_mut().filter(|t| t.iter().any(|v| wrong(*v))) {
            *texel = texel.map(|v| if wrong(v) { right } else { v });
            count += 1;
        }
        (count > 0).then(|| SceneWarning {
            code,
            count,
            message: format!("{count} texels of environment map {name} {what} {right}"),
        })
    };
    let nan = mended(
        "environment-nan",
        "were not a number; taken as",
        f32::is_nan,
        0.0,
    );
    let negative = mended(
        "environment-negative",
        "were negative; taken as",
        |v| v < 0.0,
        0.0,
    );
    let infinite = mended(
        "environment-infinite",
        "were infinite; taken as the largest finite one,",
        f32::is_infinite,
        largest,
    );
    [nan, negative, infinite].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Radiance that tells the direction: 1 + its coordinates.
    fn of_direction(d: DVec3) -> [f32; 3] {
        let d = d / d.length();
        [1.0 + d.x as f32, 1.0 + d.y as f32, 1.0 + d.z as f32]
    }

    fn worst(picture: &Picture, most: usize, turn: f64) -> f64 {
        let faces = picture.faces(most, turn);
        let n = faces.side;
        let (cos, sin) = on_circle(-turn.to_radians());
        let mut worst = 0.0f64;
        for (i, rgb) in faces.radiance.iter().enumerate() {
            let place = |k: usize| -1.0 + (2.0 * k as f64 + 1.0) / n as f64;
            let d = direction(i / (n * n), [place(i % n), place(i / n % n)]);
            let back = DVec3::new(d.x * cos + d.z * sin, d.y, d.z * cos - d.x * sin);
            let expected = of_direction(back);
            for c in 0..3 {
                worst = worst.max((rgb[c] - f64::from(expected[c])).abs());
            }
        }
        worst
    }

    fn sphere(width: usize) -> Picture {
        let height = width / 2;
        let texel = |i: usize| {
            let across = (i % width) as f64 + 0.5;
            let (ahead, right) = on_circle(2.0 * PI * (across / width as f64 - 0.5));
            let (up, ring) = on_circle(PI * ((i / width) as f64 + 0.5) / height as f64);
            of_direction(DVec3::new(ring * right, up, -ring * ahead))
        };
        Picture::new(
            "s",
            [width, height],
            (0..width * height).map(texel).collect(),
        )
        .unwrap()
    }

    #[test]
    fn directions_survive_the_way_onto_the_cube() {
        assert!(worst(&sphere(128), 128, 0.0) < 0.03);
        assert!(worst(&sphere(128), 8, 0.0) < 0.08);
        assert!(worst(&sphere(128), 32, 90.0) < 0.03);
        assert!(worst(&sphere(128), 32, 33.0) < 0.03);
    }

    /// All four cube layouts show the same cube.
    #[test]
    fn crosses_and_strips_agree() {
        const N: usize = 16;
        let value = |face: usize, x: usize, y: usize| {
            let place = |k: usize| -1.0 + (2.0 * k as f64 + 1.0) / N as f64;
            of_direction(direction(face, [place(x), place(y)]))
        };
        let sizes = [
            ([4, 3], HORIZONTAL),
            ([3, 4], VERTICAL),
            ([6, 1], ACROSS),
            ([1, 6], DOWN),
        ];
        for ([w, h], places) in sizes {
            let mut texels = vec![[f32::NAN; 3]; w * N * h * N];
            for (face, [column, row]) in places.into_iter().enumerate() {
                for (y, x) in (0..N).flat_map(|y| (0..N).map(move |x| (y, x))) {
                    let upside = [w, h] == [3, 4] && face == 5;
                    let [px, py] = if upside {
                        [N - 1 - x, N - 1 - y]
                    } else {
                        [x, y]
                    };
                    let at = (row * N + py) * w * N + column * N + px;
                    texels[at] = value(face, x, y);
                }
            }
            let picture = Picture::new("c", [w * N, h * N], texels).unwrap();
            assert!(worst(&picture, N, 0.0) < 1e-6, "{w}:{h}");
        }
    }

    /// In a cross, neighbouring faces meet: the picture has no jump there.
    #[test]
    fn the_middle_row_of_a_cross_is_one_panorama() {
        for (left, right) in [(1, 4), (4, 0), (0, 5), (5, 1)] {
            let a = direction(left, [1.0, 0.3]);
            let b = direction(right, [-1.0, 0.3]);
            assert!((a - b).length() < 1e-15, "{left} {right}");
        }
        for x in [-0.4, 0.9] {
            assert_eq!(direction(2, [x, 1.0]), direction(4, [x, -1.0]));
            assert_eq!(direction(3, [x, -1.0]), direction(4, [x, 1.0]));
            // Below -y hangs -z, upside down.
            assert_eq!(direction(3, [x, 1.0]), direction(5, [-x, 1.0]));
        }
    }

    /// The mean over a sphere of a few texels is that of the cube.
    #[test]
    fn energy_is_kept() {
        let mut texels = vec![[0.5f32; 3]; 64 * 32];
        texels[10 * 64 + 20] = [9000.0; 3];
        let faces = Picture::new("s", [64, 32], texels).unwrap().faces(128, 0.0);
        let (cube, n) = (&faces.radiance, faces.side);
        let place = |k: usize| -1.0 + 2.0 * k as f64 / n as f64;
        let energy: f64 = (0..cube.len())
            .map(|i| {
                let (x, y) = (i % n, i / n % n);
                let low = [place(x), place(y)];
                cube[i][0] * super::super::cube::solid_angle(low, [place(x + 1), place(y + 1)])
            })
            .sum();
        let ring = libm::sin(PI * 10.5 / 32.0);
        let expected = 0.5 * 4.0 * PI + 8999.5 * (2.0 * PI / 64.0) * (PI / 32.0) * ring;
        assert!(
            (energy / expected - 1.0).abs() < 0.05,
            "{energy} {expected}"
        );
    }
}
