//! A light as parallel lines across it.

use glam::DVec3;

use crate::geometry::area_light::{AreaLight, AreaLightError};
use crate::world::light::LightShape;

/// Angle of lines to the first edge of a light, degrees: atan ½, which edges of buildings
/// do not have.
pub const ANGLE: f64 = 26.565_051_177_077_99;

/// Coordinates of a light: x along its lines, y across them, z out of its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightFrame {
    /// Where all three are 0, world space.
    pub centre: DVec3,
    /// Right-handed, of length 1.
    pub axes: [DVec3; 3],
}

impl LightFrame {
    /// A point of the world in these coordinates.
    pub fn local(&self, p: DVec3) -> DVec3 {
        self.direction(p - self.centre)
    }

    /// A direction in them.
    pub fn direction(&self, d: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        DVec3::new(x.dot(d), y.dot(d), z.dot(d))
    }

    /// The point of the light's plane at (x, y), world space.
    pub fn at(&self, [x, y]: [f64; 2]) -> DVec3 {
        self.centre + self.axes[0] * x + self.axes[1] * y
    }

    /// A frame about `centre` whose z is along `normal` (any length), x and y turned by
    /// `angle` degrees from wherever they are first.
    pub fn facing(centre: DVec3, normal: DVec3, first: Option<DVec3>, angle: f64) -> Self {
        let z = normal.normalize();
        let size = z.abs();
        let least = (1..3).fold(0, |best, k| if size[k] < size[best] { k } else { best });
        let x = first.unwrap_or(z.cross([DVec3::X, DVec3::Y, DVec3::Z][least]));
        let x = (x - z * z.dot(x)).normalize();
        let y = z.cross(x);
        let (sine, cosine) = libm::sincos(angle.to_radians());
        let axes = [x * cosine + y * sine, y * cosine - x * sine, z];
        Self { centre, axes }
    }
}

/// What of the light's plane shines.
#[derive(Clone, Debug, PartialEq)]
pub enum Extent {
    /// A convex polygon in the frame's coordinates, counter-clockwise.
    Polygon(Vec<[f64; 2]>),
    /// A disc of this radius about the centre.
    Disc(f64),
    /// A sphere of this radius: each receiver has a plane of its own.
    Sphere(f64),
}

/// One line: where it enters and leaves the light, and its foot on the *spine*, by which
/// all lines are reached from the centre without leaving the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Across the lines.
    pub y: f64,
    /// Least x.
    pub left: f64,
    /// Greatest x.
    pub right: f64,
    /// x over y of the foot.
    pub slope: f64,
}

/// A light with a plane to draw lines in.
#[derive(Clone, Debug, PartialEq)]
pub struct LineLight {
    /// Its coordinates; of a sphere those of the world about its centre.
    pub frame: LightFrame,
    /// Its extent.
    pub extent: Extent,
}

impl LineLight {
    /// Of a light of the scene, lines turned by `angle` degrees; `None` for lights without
    /// extent.
    ///
    /// # Errors
    /// Sizes that are not finite and positive.
    pub fn new(shape: &LightShape, angle: f64) -> Result<Option<Self>, AreaLightError> {
        if let LightShape::Point { .. } | LightShape::Directional { .. } = shape {
            return Ok(None);
        }
        Ok(Some(match AreaLight::new(shape)? {
            AreaLight::Polygon {
                corners,
                centre,
                normal,
            } => {
                let first = corners[1] - corners[0];
                let frame = LightFrame::facing(centre, normal, Some(first), angle);
                let place = |c: &DVec3| {
                    let at = frame.local(*c);
                    [at.x, at.y]
                };
                Self {
                    extent: Extent::Polygon(corners.iter().map(place).collect()),
                    frame,
                }
            }
            AreaLight::Disc {
                centre,
                normal,
                radius,
            } => Self {
                frame: LightFrame::facing(centre, normal, None, angle),
                extent: Extent::Disc(radius),
            },
            AreaLight::Sphere { centre, radius } => Self {
                frame: LightFrame {
                    centre,
                    axes: [DVec3::X, DVec3::Y, DVec3::Z],
                },
                extent: Extent::Sphere(radius),
            },
        }))
    }

    /// `n` lines at midpoints of the extent across them; of a sphere those of the disc of
    /// radius 1, to be scaled.
    pub fn lines(&self, n: u32) -> Vec<Line> {
        match &self.extent {
            Extent::Polygon(outline) => lines_of_polygon(outline, n),
            Extent::Disc(radius) => lines_of_disc(*radius, n),
            Extent::Sphere(_) => lines_of_disc(1.0, n),
        }
    }

    /// Corners of a convex body that holds the light, world space. `growth` is how much
    /// larger a sphere may look ([`Self::growth`]).
    pub fn corners(&self, growth: f64) -> Vec<DVec3> {
        const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        match &self.extent {
            Extent::Polygon(outline) => outline.iter().map(|c| self.frame.at(*c)).collect(),
            Extent::Disc(r) => SQUARE
                .iter()
                .map(|c| self.frame.at(c.map(|v| v * r)))
                .collect(),
            Extent::Sphere(r) => {
                let sign = |k: usize, bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
                let corner = |k: usize| DVec3::new(sign(k, 0), sign(k, 1), sign(k, 2));
                let place = |k: usize| self.frame.centre + corner(k) * (r * growth);
                (0..8).map(place).collect()
            }
        }
    }

    /// Area of the part of a polygon whose points have positive height, over that of the
    /// whole; `None` for round lights.
    pub fn share_before(&self, height: impl Fn([f64; 2]) -> f64) -> Option<f64> {
        let Extent::Polygon(outline) = &self.extent else {
            return None;
        };
        let mut part: Vec<[f64; 2]> = Vec::with_capacity(outline.len() + 1);
        for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            let (from, to) = (height(*a), height(*b));
            if from >= 0.0 {
                part.push(*a);
            }
            if (from >= 0.0) != (to >= 0.0) {
                let t = from / (from - to);
                part.push([0, 1].map(|k| a[k] + (b[k] - a[k]) * t));
            }
        }
        Some(double_area(&part) / double_area(outline))
    }

    /// How much larger a sphere looks from `distance` to its centre: the disc in its place
    /// has the radius r over the root of 1 - r²/D² (docs/papers.md, paper IV). Infinite from inside; 1
    /// for flat lights.
    pub fn growth(&self, distance: f64) -> f64 {
        let Extent::Sphere(radius) = self.extent else {
            return 1.0;
        };
        let share = radius * radius / (distance * distance);
        if share < 1.0 {
            1.0 / (1.0 - share).sqrt()
        } else {
            f64::INFINITY
        }
    }
}

fn lines_of_disc(radius: f64, n: u32) -> Vec<Line> {
    let line = |k: u32| {
        let y = ((f64::from(k) + 0.5) / f64::from(n) * 2.0 - 1.0) * radius;
        let half = (radius * radius - y * y).max(0.0).sqrt();
        Line {
            y,
            left: -half,
            right: half,
            slope: 0.0,
        }
    };
    (0..n).map(line).collect()
}

fn lines_of_polygon(outline: &[[f64; 2]], n: u32) -> Vec<Line> {
    let highest = |sign: f64| {
        let most = outline.iter().fold(f64::MIN, |m, c| m.max(sign * c[1]));
        let tops = outline
            .iter()
            .filter(|c| sign * c[1] >= most * (1.0 - 1e-9));
        let (sum, count) = tops.fold((0.0, 0.0), |(s, c), top| (s + top[0], c + 1.0));
        [sum / count, sign * most]
    };
    let [top, bottom] = [highest(1.0), highest(-1.0)];
    let line = |k: u32| {
        let y = bottom[1] + (f64::from(k) + 0.5) / f64::from(n) * (top[1] - bottom[1]);
        let [left, right] = span(outline, y);
        let [x, end] = if y >= 0.0 { top } else { bottom };
        let slope = x / end;
        Line {
            y,
            left,
            right,
            slope,
        }
    };
    (0..n).map(line).collect()
}

/// Twice the area of a counter-clockwise polygon.
pub fn double_area(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let cross = |(a, b): (&[f64; 2], &[f64; 2])| a[0] * b[1] - a[1] * b[0];
    outline.iter().zip(next).map(cross).sum()
}

/// Where a line enters and leaves a convex polygon.
fn span(outline: &[[f64; 2]], y: f64) -> [f64; 2] {
    let next = outline.iter().cycle().skip(1);
    let met = outline
        .iter()
        .zip(next)
        .filter(|(a, b)| (a[1] <= y) != (b[1] <= y));
    let x = met.map(|(a, b)| a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1])));
    x.fold([f64::MAX, f64::MIN], |[low, high], x| {
        [low.min(x), high.max(x)]
    })
}
