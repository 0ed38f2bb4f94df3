//! How the texels of a picture cover directions.
//!
//! A texel's energy is its radiance times its solid angle, exactly. What becomes of it
//! on a cube is in [`spread`](super::spread).

use std::f64::consts::PI;

use super::EnvironmentError;
use super::cube::{FACES, direction, place_of, solid_angle};
use crate::world::shape::on_circle;
use crate::world::warning::SceneWarning;
use glam::DVec3;

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
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    size: [usize; 2],
    pub(super) texels: Vec<[f32; 3]>,
    layout: Layout,
    pub(super) warnings: Vec<SceneWarning>,
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

    /// The six faces of a cube below each other.
    pub(super) fn strip(side: usize, texels: Vec<[f32; 3]>) -> Self {
        debug_assert_eq!(texels.len(), FACES * side * side);
        Self {
            size: [side, FACES * side],
            texels,
            layout: Layout::Cube(DOWN, false),
            warnings: Vec::new(),
        }
    }

    /// Texels along a quarter of the equator, which a face spans.
    pub(super) fn side(&self) -> usize {
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

    /// Whether texels of faces of `side` texels are made of whole ones.
    pub(super) fn is_cube_of(&self, side: usize) -> bool {
        matches!(self.layout, Layout::Cube(..)) && self.face_side().is_multiple_of(side)
    }

    /// Whether texels are hardly square: the smallest maps of the sphere.
    pub(super) fn is_coarse(&self) -> bool {
        self.layout == Layout::LatitudeLongitude && self.size[0] < 16
    }

    /// Texels that show a direction. Those of a cross that show none are not visited.
    pub(super) fn places(&self) -> Vec<Place> {
        let [width, height] = self.size;
        match self.layout {
            Layout::LatitudeLongitude => (0..width * height)
                .map(|texel| Place {
                    texel,
                    face: None,
                    corner: [texel % width, texel / width],
                })
                .collect(),
            Layout::Cube(places, upside) => {
                let side = self.face_side();
                let of_face = |face: usize| {
                    let [column, row] = places[face];
                    let turned = upside && face == 5;
                    (0..side * side).map(move |i| {
                        let [x, y] = [i % side, i / side];
                        let [px, py] = if turned {
                            [side - 1 - x, side - 1 - y]
                        } else {
                            [x, y]
                        };
                        Place {
                            texel: (row * side + py) * width + column * side + px,
                            face: Some(face),
                            corner: [x, y],
                        }
                    })
                };
                (0..FACES).flat_map(of_face).collect()
            }
        }
    }

    /// Solid angle of a texel, steradians.
    pub(super) fn angle(&self, place: &Place) -> f64 {
        let [x, y] = place.corner;
        let [width, height] = self.size;
        match place.face {
            None => {
                // cos a - cos b, without the cancellation near the poles.
                let middle = PI * (y as f64 + 0.5) / height as f64;
                let half = PI * 0.5 / height as f64;
                let (ring, rise) = (on_circle(middle).1, on_circle(half).1);
                2.0 * ring * rise * (2.0 * PI / width as f64)
            }
            Some(_) => {
                let edge = |k: usize| -1.0 + 2.0 * k as f64 / self.face_side() as f64;
                solid_angle([edge(x), edge(y)], [edge(x + 1), edge(y + 1)])
            }
        }
    }

    /// What [`Self::direction`] counts a texel's area as.
    pub(super) fn area(&self, place: &Place) -> f64 {
        let [width, height] = self.size;
        match place.face {
            None => 2.0 * PI * PI / (width * height) as f64,
            Some(_) => 4.0 / (self.face_side() * self.face_side()) as f64,
        }
    }

    /// The direction of a point at `inside` (0..1, right and down) of a texel, not
    /// normalised, and the solid angle there per area: of angles on the sphere, of the
    /// face of a cube of half side 1.
    pub(super) fn direction(&self, place: &Place, inside: [f64; 2]) -> (DVec3, f64) {
        let at = [0, 1].map(|k| place.corner[k] as f64 + inside[k]);
        match place.face {
            None => {
                let (ahead, right) = on_circle(2.0 * PI * (at[0] / self.size[0] as f64 - 0.5));
                let (up, ring) = on_circle(PI * at[1] / self.size[1] as f64);
                (DVec3::new(ring * right, up, -ring * ahead), ring)
            }
            Some(face) => {
                let at = at.map(|c| -1.0 + 2.0 * c / self.face_side() as f64);
                let squared = 1.0 + at[0] * at[0] + at[1] * at[1];
                (direction(face, at), 1.0 / (squared * squared.sqrt()))
            }
        }
    }

    /// Radiance towards a direction, that of the texel that shows it.
    pub(super) fn radiance(&self, towards: DVec3) -> [f32; 3] {
        let [width, height] = self.size;
        let within = |c: f64, n: usize| ((c * n as f64) as usize).min(n - 1);
        match self.layout {
            Layout::LatitudeLongitude => {
                let across = 0.5 + libm::atan2(towards.x, -towards.z) / (2.0 * PI);
                let level = (towards.x * towards.x + towards.z * towards.z).sqrt();
                let down = libm::atan2(level, towards.y) / PI;
                self.texels[within(down, height) * width + within(across, width)]
            }
            Layout::Cube(places, upside) => {
                let (face, at) = place_of(towards);
                let side = self.face_side();
                let [mut x, mut y] = at.map(|c| within((c + 1.0) * 0.5, side));
                if upside && face == 5 {
                    [x, y] = [side - 1 - x, side - 1 - y];
                }
                let [column, row] = places[face];
                self.texels[(row * side + y) * width + column * side + x]
            }
        }
    }
}

/// A texel that shows a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Number in [`Picture::texels`].
    pub(super) texel: usize,
    /// Of a cube; `None` on the sphere.
    face: Option<usize>,
    /// Column and row, on the face of a cube.
    corner: [usize; 2],
}

/// A direction turned about +y, counter-clockwise seen from above, by an angle whose
/// cosine and sine are given.
pub(super) fn turned(d: DVec3, (cos, sin): (f64, f64)) -> DVec3 {
    DVec3::new(d.x * cos + d.z * sin, d.y, d.z * cos - d.x * sin)
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
    use super::super::cube::texel_angle;
    use super::super::spread::spread;
    use super::*;

    /// Radiance that tells the direction: 1 + its coordinates.
    fn of_direction(d: DVec3) -> [f32; 3] {
        let d = d / d.length();
        [1.0 + d.x as f32, 1.0 + d.y as f32, 1.0 + d.z as f32]
    }

    fn worst(picture: &Picture, side: usize) -> f64 {
        let faces = spread(picture, side, 0.0);
        let place = |k: usize| -1.0 + (2.0 * k as f64 + 1.0) / side as f64;
        let mut worst = 0.0f64;
        for (i, energy) in faces.energy.iter().enumerate() {
            let at = [place(i % side), place(i / side % side)];
            let d = direction(i / (side * side), at);
            let [found, expected] = [picture.radiance(d), of_direction(d)];
            for c in 0..3 {
                let on_cube = energy[c] / texel_angle(side, i);
                worst = worst.max((on_cube - f64::from(expected[c])).abs());
                worst = worst.max(f64::from((found[c] - expected[c]).abs()));
            }
        }
        worst
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
            assert!(worst(&picture, N) < 1e-6, "{w}:{h}");
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
}
