//! A picture's energy spread over the faces of a cube.
//!
//! Every texel of the picture is cut into parts, and its energy is shared out between
//! the texels of the cube that their centres point at. All of a texel's shares come to
//! one, whatever its size and however the map is turned, so that the cube has the energy
//! of the picture. Within that, shares are moved until each texel of the cube receives
//! what its solid angle asks for (iterative proportional fitting: Deming and Stephan,
//! 1940), so that an even sky stays even where texels are not aligned.

use super::cube::{FACES, place_of, texel_angle};
use super::layout::{Picture, Place, turned};
use crate::world::shape::on_circle;

/// Parts along a side of a texel of the cube, at least.
const PARTS: usize = 8;
/// Times that shares are fitted. An even map of 1024 texels round is then even to 2 % (RMS)
/// on faces of 128, where shares as they fall are off by 6 %.
const ROUNDS: usize = 4;

/// Energy of every texel of a cube, face after face, row by row: radiance times
/// steradians.
pub(super) struct Faces {
    pub(super) side: usize,
    pub(super) energy: Vec<[f64; 3]>,
}

/// Spreads `picture` over faces of at most `most` texels a side, turned about +y by
/// `turn` degrees.
pub(super) fn spread(picture: &Picture, most: usize, turn: f64) -> Faces {
    let side = picture.side().min(most);
    let parts = Parts::new(picture, side, turn);
    let wanted: Vec<f64> = (0..FACES * side * side)
        .map(|i| texel_angle(side, i))
        .collect();
    let mut factors = vec![1.0; wanted.len()];
    for _ in 0..ROUNDS {
        let mut received = vec![0.0; wanted.len()];
        parts.each(&factors, |place, to, share| {
            received[to] += share * parts.angles[place];
        });
        for (factor, (wanted, received)) in factors.iter_mut().zip(wanted.iter().zip(&received)) {
            if *received > 0.0 {
                *factor *= wanted / received;
            }
        }
    }
    let mut energy = vec![[0.0; 3]; wanted.len()];
    parts.each(&factors, |place, to, share| {
        let rgb = picture.texels[parts.places[place].texel];
        let share = share * parts.angles[place];
        (0..3).for_each(|c| energy[to][c] += share * f64::from(rgb[c]));
    });
    Faces { side, energy }
}

/// Where the parts of a picture's texels lie on a cube.
struct Parts {
    places: Vec<Place>,
    /// Solid angle of each place.
    angles: Vec<f64>,
    /// Parts of a place.
    count: usize,
    /// Place after place: a texel of the cube for each part.
    to: Vec<u32>,
    /// And its solid angle, up to a factor for each place.
    weight: Vec<f32>,
}

impl Parts {
    fn new(picture: &Picture, side: usize, turn: f64) -> Self {
        let along = if turn == 0.0 && picture.is_cube_of(side) {
            1
        } else {
            let finer = if picture.is_coarse() { 8 } else { 1 };
            (PARTS * side).div_ceil(picture.side()).max(1) * finer
        };
        let angle = on_circle(turn.to_radians());
        let middle = |k: usize| (k as f64 + 0.5) / along as f64;
        let places = picture.places();
        let (mut to, mut weight) = (Vec::new(), Vec::new());
        for place in &places {
            for k in 0..along * along {
                let inside = [middle(k % along), middle(k / along)];
                let (towards, density) = picture.direction(place, inside);
                let towards = if turn == 0.0 {
                    towards
                } else {
                    turned(towards, angle)
                };
                to.push(texel_towards(side, towards) as u32);
                weight.push(density as f32);
            }
        }
        Self {
            angles: places.iter().map(|p| picture.angle(p)).collect(),
            places,
            count: along * along,
            to,
            weight,
        }
    }

    /// Calls `take` with place, texel of the cube and share of the place's energy for
    /// each part; `factors` say what texels of the cube ask for.
    fn each(&self, factors: &[f64], mut take: impl FnMut(usize, usize, f64)) {
        for place in 0..self.places.len() {
            let parts = place * self.count..(place + 1) * self.count;
            let asked = |k: usize| f64::from(self.weight[k]) * factors[self.to[k] as usize];
            let total: f64 = parts.clone().map(asked).sum();
            for k in parts {
                take(place, self.to[k] as usize, asked(k) / total);
            }
        }
    }
}

/// The texel of a cube of `side` texels that a direction points at.
fn texel_towards(side: usize, towards: glam::DVec3) -> usize {
    let (face, at) = place_of(towards);
    let [x, y] = at.map(|c| (((c + 1.0) * 0.5 * side as f64) as usize).min(side - 1));
    (face * side + y) * side + x
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec3;

    use super::*;
    use crate::truth::oracle::sampled::jitter;
    use crate::world::environment::cube::direction;

    /// Radiance that tells the direction: 1 + its coordinates.
    fn of_direction(d: DVec3) -> [f32; 3] {
        let d = d / d.length();
        [1.0 + d.x as f32, 1.0 + d.y as f32, 1.0 + d.z as f32]
    }

    fn radiance(faces: &Faces, i: usize) -> [f64; 3] {
        faces.energy[i].map(|e| e / texel_angle(faces.side, i))
    }

    /// Root of the mean squared error of a cube's radiance.
    fn error(picture: &Picture, most: usize, turn: f64) -> f64 {
        let faces = spread(picture, most, turn);
        let n = faces.side;
        let mut squares = 0.0;
        for i in 0..faces.energy.len() {
            let place = |k: usize| -1.0 + (2.0 * k as f64 + 1.0) / n as f64;
            let d = direction(i / (n * n), [place(i % n), place(i / n % n)]);
            let expected = of_direction(turned(d, on_circle(-turn.to_radians())));
            let found = radiance(&faces, i);
            let off = (0..3).map(|c| found[c] - f64::from(expected[c]));
            squares += off.map(|d| d * d).sum::<f64>();
        }
        (squares / (3 * faces.energy.len()) as f64).sqrt()
    }

    fn sphere(width: usize) -> Picture {
        let height = width / 2;
        let texel = |i: usize| {
            let across = (i % width) as f64 + 0.5;
            let (ahead, right) = on_circle(2.0 * PI * (across / width as f64 - 0.5));
            let (up, ring) = on_circle(PI * ((i / width) as f64 + 0.5) / height as f64);
            of_direction(DVec3::new(ring * right, up, -ring * ahead))
        };
        let texels = (0..width * height).map(texel).collect();
        Picture::new("s", [width, height], texels).unwrap()
    }

    #[test]
    fn directions_survive_the_way_onto_the_cube() {
        for (most, turn) in [(128, 0.0), (8, 0.0), (32, 90.0), (32, 33.0)] {
            let off = error(&sphere(128), most, turn);
            println!("{most} {turn}: {off:.4}");
            assert!(off < 0.04, "{most} {turn}: {off}");
        }
    }

    /// Solid angles of all texels are the sphere's, in every layout.
    #[test]
    fn places_fill_the_sphere() {
        for size in [
            [64, 32],
            [2, 1],
            [1, 1],
            [32, 24],
            [24, 32],
            [48, 8],
            [8, 48],
        ] {
            let picture = Picture::new("s", size, vec![[1.0; 3]; size[0] * size[1]]).unwrap();
            let angles = picture
                .places()
                .iter()
                .map(|p| picture.angle(p))
                .sum::<f64>();
            assert!(
                (angles / (4.0 * PI) - 1.0).abs() < 1e-12,
                "{size:?} {angles}"
            );
        }
    }

    fn energy(picture: &Picture) -> f64 {
        let of = |p: &Place| f64::from(picture.texels[p.texel][0]) * picture.angle(p);
        picture.places().iter().map(of).sum()
    }

    /// Random maps with texels thousands of times as bright: the cube has their energy
    /// at every size and turn. Weighted means have it up to some hundredths, and flicker.
    #[test]
    fn energy_is_kept_whatever_the_size_and_the_turn() {
        for (size, seed) in [
            ([64, 32], 1),
            ([48, 36], 2),
            ([8, 48], 3),
            ([36, 48], 4),
            ([6, 3], 5),
        ] {
            let texel = |i: usize| {
                let bright = if jitter(seed, 2 * i as u64) < 0.01 {
                    9000.0
                } else {
                    1.0
                };
                [bright * jitter(seed, 2 * i as u64 + 1) as f32; 3]
            };
            let texels = (0..size[0] * size[1]).map(texel).collect();
            let picture = Picture::new("r", size, texels).unwrap();
            let expected = energy(&picture);
            for (most, turn) in [(128, 0.0), (128, 0.35), (128, 77.0), (5, 0.0), (3, 12.3)] {
                let faces = spread(&picture, most, turn);
                let found: f64 = faces.energy.iter().map(|e| e[0]).sum();
                let off = (found / expected - 1.0).abs();
                assert!(off < 1e-12, "{size:?} {most} {turn}: {off}");
            }
        }
    }

    /// An even sky stays even, texels aligned or not.
    #[test]
    fn an_even_map_stays_even() {
        for (size, most, turn) in [
            ([64, 32], 16, 0.0),
            ([64, 32], 13, 20.0),
            ([32, 24], 8, 33.0),
        ] {
            let picture = Picture::new("e", size, vec![[1.0; 3]; size[0] * size[1]]).unwrap();
            let faces = spread(&picture, most, turn);
            for i in 0..faces.energy.len() {
                let found = radiance(&faces, i)[0];
                assert!(
                    (found - 1.0).abs() < 0.06,
                    "{size:?} {most} {turn}: {found}"
                );
            }
        }
    }

    /// What a direction is looked up in is the texel that it lies in.
    #[test]
    fn pictures_are_looked_up_where_their_texels_are() {
        for size in [[16, 8], [12, 9], [9, 12], [18, 3], [3, 18]] {
            let texels = (0..size[0] * size[1]).map(|i| [i as f32; 3]).collect();
            let picture = Picture::new("l", size, texels).unwrap();
            for place in picture.places() {
                for inside in [[0.5, 0.5], [0.1, 0.9]] {
                    let (towards, _) = picture.direction(&place, inside);
                    assert_eq!(picture.radiance(towards)[0], place.texel as f32, "{size:?}");
                }
            }
        }
    }
}
