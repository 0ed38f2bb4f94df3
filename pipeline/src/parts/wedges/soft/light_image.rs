//! Coloured lights: an image on a rectangle, and what an edge covers of each colour
//! (paper III, §3.2.3).
//!
//! Shares are of each channel's own sum, so the light's colour stays that of the
//! scene where all of it is seen, and dark cells shape the light.

use glam::DVec2;

use crate::geometry::coverage::square_swept;

/// Cells of equal size on the square -1..1, rows from y = -1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LightImage {
    side: usize,
    /// Linear red, green, blue of each cell.
    cells: Vec<[f64; 3]>,
}

impl LightImage {
    /// Red on the first half along x, green and blue on the other.
    pub(crate) fn halves() -> Self {
        let [red, cyan] = [[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]];
        Self {
            side: 2,
            cells: vec![red, cyan, red, cyan],
        }
    }

    /// Sixteen round lights in one: bright cells with dark ones between them.
    pub(crate) fn windows() -> Self {
        let side = 7;
        let lit = |k: usize| (k % side).is_multiple_of(2) && (k / side).is_multiple_of(2);
        let cells = (0..side * side).map(|k| if lit(k) { [1.0; 3] } else { [0.0; 3] });
        Self {
            side,
            cells: cells.collect(),
        }
    }

    /// A frame of a fire: cells flicker, red more than green, blue hardly.
    pub(crate) fn fire(frame: u32) -> Self {
        let side = 4;
        let cells = (0..side * side).map(|k| {
            let heat = flicker(k as u32, frame);
            [0.2 + heat, 0.05 + heat * heat, 0.1 * heat * heat]
        });
        Self {
            side,
            cells: cells.collect(),
        }
    }

    /// Covered share of each colour for an edge from p to q, between it and the
    /// border, within the rays from the centre through its ends.
    pub(crate) fn covered(&self, p: DVec2, q: DVec2) -> [f64; 3] {
        let region = region(p, q);
        let mut sums = [0.0; 3];
        for (k, colour) in self.cells.iter().enumerate() {
            let area = self.area_in_cell(&region, k);
            for (sum, c) in sums.iter_mut().zip(colour) {
                *sum += c * area;
            }
        }
        let cell = 4.0 / (self.side * self.side) as f64;
        [0, 1, 2].map(|i| {
            let total: f64 = self.cells.iter().map(|c| c[i]).sum();
            if total > 0.0 {
                sums[i] / (total * cell)
            } else {
                0.0
            }
        })
    }

    fn area_in_cell(&self, region: &[DVec2], k: usize) -> f64 {
        let n = self.side as f64;
        let low = DVec2::new((k % self.side) as f64, (k / self.side) as f64) * (2.0 / n) - 1.0;
        let high = low + 2.0 / n;
        let mut polygon = region.to_vec();
        for (axis, limit, sign) in [
            (0, low.x, 1.0),
            (0, high.x, -1.0),
            (1, low.y, 1.0),
            (1, high.y, -1.0),
        ] {
            polygon = clip(&polygon, |v| sign * (v[axis] - limit));
        }
        area(&polygon)
    }
}

/// Noise of 0..1 in space and time, smooth in time.
fn flicker(cell: u32, frame: u32) -> f64 {
    let noise = |key: u32| {
        let mixed = (cell.wrapping_mul(0x9e37_79b9) ^ key.wrapping_mul(0x85eb_ca6b))
            .wrapping_mul(0xc2b2_ae35);
        f64::from(mixed >> 8) / f64::from(1u32 << 24)
    };
    let (whole, part) = (frame / 4, f64::from(frame % 4) / 4.0);
    noise(whole) * (1.0 - part) + noise(whole + 1) * part
}

/// The convex region, counter-clockwise; empty for edges in line with the centre.
fn region(p: DVec2, q: DVec2) -> Vec<DVec2> {
    const CORNERS: [[f64; 2]; 4] = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let turn = p.perp_dot(q);
    if turn == 0.0 {
        return Vec::new();
    }
    let (p, q) = if turn > 0.0 { (p, q) } else { (q, p) };
    let border = |v: DVec2| v / v.x.abs().max(v.y.abs());
    let (from, to) = (square_swept(p), square_swept(q));
    let to = if to < from { to + 4.0 } else { to };
    let corners = (1..8)
        .filter(|k| f64::from(*k) > from && f64::from(*k) < to)
        .map(|k| DVec2::from(CORNERS[k as usize % 4]));
    [p, border(p)]
        .into_iter()
        .chain(corners)
        .chain([border(q), q])
        .collect()
}

/// What is not negative of a convex polygon.
fn clip(polygon: &[DVec2], inside: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (fa, fb) = (inside(a), inside(b));
        if fa >= 0.0 {
            out.push(a);
        }
        if (fa < 0.0) != (fb < 0.0) {
            out.push(a + (b - a) * (fa / (fa - fb)));
        }
    }
    out
}

fn area(polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    let twice: f64 = (0..n)
        .map(|k| polygon[k].perp_dot(polygon[(k + 1) % n]))
        .sum();
    (0.5 * twice).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::coverage::square_share;
    use crate::measure::render::{RenderSettings, render};
    use crate::technique::Params;
    use crate::techniques;
    use crate::truth::oracle::area::VisibilityImage;
    use crate::world::light::LightShape;
    use crate::world::scene::{Scene, builtin};

    fn points() -> Vec<DVec2> {
        let at = |k: i32| f64::from(k) / 3.0 - 0.97;
        (0..6)
            .flat_map(|i| (0..6).map(move |j| DVec2::new(at(i), at(j))))
            .collect()
    }

    #[test]
    fn a_white_image_covers_as_a_plain_light() {
        let white = LightImage {
            side: 3,
            cells: vec![[1.0; 3]; 9],
        };
        for p in points() {
            for q in points().into_iter().filter(|q| p.perp_dot(*q) != 0.0) {
                let plain = square_share(p, q) - 0.125 * p.perp_dot(q).abs();
                for share in white.covered(p, q) {
                    assert!((share - plain).abs() < 1e-12, "{p} {q}: {share} {plain}");
                }
            }
        }
    }

    #[test]
    fn colours_are_covered_apart() {
        let halves = LightImage::halves();
        // An edge up the whole left side: all of red beyond it, none of cyan.
        let [r, g, b] = halves.covered(DVec2::new(-0.5, 1.0), DVec2::new(-0.5, -1.0));
        assert!(
            (r - 0.5).abs() < 1e-12 && g == 0.0 && b == 0.0,
            "{r} {g} {b}"
        );
        assert_ne!(LightImage::fire(0).cells, LightImage::fire(1).cells);
        assert_eq!(
            LightImage::windows()
                .cells
                .iter()
                .filter(|c| c[0] > 0.0)
                .count(),
            16
        );
    }

    const SIZE: [u32; 2] = [96, 64];

    /// Red visibility under an image, by the technique.
    fn drawn(scene: &Scene, set: &[&str]) -> Vec<f32> {
        let table = [
            "texture-size=20",
            "texture-filter=quadlinear",
            "texture-centred=vertex",
        ];
        let technique = techniques::find("soft-shadow-volumes").unwrap();
        let params = Params::parse(technique, table.iter().chain(set).copied()).unwrap();
        let settings = RenderSettings {
            size: SIZE,
            ..RenderSettings::default()
        };
        render(scene, technique, &params, &settings)
            .unwrap()
            .visibility
    }

    /// The same as the sum over cells, each a light of its own to the oracle.
    fn summed(scene: &Scene, image: &LightImage) -> Vec<f64> {
        let LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        } = scene.lights[0].shape
        else {
            unreachable!()
        };
        let n = image.side as f64;
        let total: f64 = image.cells.iter().map(|c| c[0]).sum();
        let mut sum = vec![0.0; (SIZE[0] * SIZE[1]) as usize];
        let cells = image.cells.iter().enumerate();
        for (k, colour) in cells.filter(|(_, c)| c[0] > 0.0) {
            let place = |i: usize| (i as f64 + 0.5) / n - 0.5;
            let mut one = scene.clone();
            one.lights[0].shape = LightShape::Rectangle {
                centre: centre + edge_u * place(k % image.side) + edge_v * place(k / image.side),
                edge_u: edge_u / n,
                edge_v: edge_v / n,
            };
            let seen = VisibilityImage::of_scene(&one, 0, SIZE, &|| ()).unwrap();
            for (to, v) in sum.iter_mut().zip(&seen.values) {
                *to += v * colour[0] / total;
            }
        }
        sum
    }

    fn rmse(picture: &[f32], truth: &[f64]) -> f64 {
        let pairs = picture.iter().zip(truth);
        let known = pairs.filter(|(v, t)| !v.is_nan() && !t.is_nan());
        let off = known.map(|(v, t)| f64::from(*v) - t);
        let squares: Vec<f64> = off.map(|d| d * d).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    }

    /// Sixteen lights with black between them, and frames of a fire: visibility is the
    /// mean of the cells' own, weighted by their red.
    #[test]
    fn an_image_is_the_sum_of_its_cells() {
        let scene = builtin::build("parallel-plates").unwrap();
        let fire = |frame: u32| (LightImage::fire(frame), format!("light-frame={frame}"));
        let windows = (LightImage::windows(), "light-frame=0".to_owned());
        let white = drawn(&scene, &["light-image=white"]);
        let mut pictures = Vec::new();
        for (name, (image, frame)) in [("windows", windows), ("fire", fire(0)), ("fire", fire(9))] {
            let picture = drawn(&scene, &[&format!("light-image={name}"), &frame]);
            let truth = summed(&scene, &image);
            let [own, plain] = [&picture, &white].map(|p| rmse(p, &truth));
            println!("{name} {frame}: {own:.2e}, as a plain light {plain:.2e}");
            assert!(
                own < 6e-3 && plain > 3.0 * own,
                "{name} {frame}: {own} {plain}"
            );
            pictures.push(picture);
        }
        // One frame's fire is not another's.
        assert!(pictures[1] != pictures[2]);
    }
}
