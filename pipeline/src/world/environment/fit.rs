//! Greedy fitting of area lights (Annen et al. 2008, §4.2).
//!
//! ```text
//! while some texel that no light covers has energy, and lights are wanted:
//!     choose the face with most energy in such texels, the first of equals
//!     begin a light at the brightest of them, the first of equals
//!     repeat: for each side in turn, left, right, top, bottom
//!         enlarge it by a texel if E_delta / E_total > t
//!     until no side grows
//!     take the light's energy out of the face, leaving a residual
//! ```
//!
//! # Departures from the paper, and why
//!
//! * Faces are fitted by turns, so that a count of lights is one for all faces and
//!   none is left out; for each face the lights are those it would get alone.
//! * The paper begins at the brightest texel of all; texels that a light covers
//!   would then be chosen for ever once what is left in them exceeds the rest.
//! * The paper leaves "the average amount of energy" in a light's texels, to bridge
//!   the hole for later lights. [`ResidualRule::Mean`] leaves at most the face's
//!   mean in each texel; all that is darker than the mean is then never taken, and
//!   lights there are empty. [`ResidualRule::Excess`] leaves the mean only where
//!   the texel exceeds it, and takes darker texels whole, so that a later light
//!   which grows over the hole takes what the first one left.
//! * A square grows by a row and a column at a time, at each of its four corners
//!   in turn.
//! * Where no threshold is given, the largest is looked for with which that many
//!   lights leave at most a twentieth of the energy bare ([`BARE`]); small lights where
//!   the map is bright are worth more than large ones that reach its last corner.
//!
//! Energy of comparisons is luminance; what is moved is each colour.

use super::EnvironmentError;
use super::cube::{CubeMap, FACES, luminance, sum};
use super::moments::Found;
pub use super::moments::Moments;

/// Shape of fitted lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightForm {
    /// As many texels across as down: the paper's results.
    #[default]
    Square,
    /// Sides grow one by one: the paper's §4.2.
    Rectangle,
}

/// What a light leaves of the energy of its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ResidualRule {
    /// The face's mean where there was more, else nothing.
    #[default]
    Excess,
    /// The face's mean or what there was, whichever is less.
    Mean,
}

/// Where a light lies that stands for texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightPlace {
    /// Over its texels: the paper's.
    Texels,
    /// As large, about the luminance centroid of what it took.
    Centroid,
    /// About the centroid, and as large as light spread evenly would have to be to be
    /// spread as much.
    #[default]
    Moments,
}

/// What light that no area light took is as ambient light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AmbientForm {
    /// The same from everywhere: the paper's.
    Even,
    /// Spherical harmonics up to order 1: four coefficients a colour.
    #[default]
    Harmonic,
}

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Most lights over all faces.
    pub lights: usize,
    /// `t`, between 0 and 1; `None` looks for one that suits the count.
    pub threshold: Option<f64>,
    /// Shape of the lights.
    pub form: LightForm,
    /// What they leave.
    pub residual: ResidualRule,
    /// Where they lie.
    pub place: LightPlace,
    /// What becomes of all that they leave.
    pub ambient: AmbientForm,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            lights: 30,
            threshold: None,
            form: LightForm::default(),
            residual: ResidualRule::default(),
            place: LightPlace::default(),
            ambient: AmbientForm::default(),
        }
    }
}

/// Most lights that may be asked for.
pub const MOST_LIGHTS: usize = 1024;

/// A fitted light: a rectangle of texels of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaFit {
    /// Which face.
    pub face: usize,
    /// First column and row.
    pub low: [usize; 2],
    /// Column and row behind the last.
    pub high: [usize; 2],
    /// Energy that it took, in units of the map.
    pub energy: [u64; 3],
    /// Where that is.
    pub moments: Moments,
}

/// Lights and what they left.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Brightest first; all have energy.
    pub lights: Vec<AreaFit>,
    /// Energy left in each texel, in units of the map.
    pub residual: Vec<[u64; 3]>,
    /// The threshold that was used.
    pub threshold: f64,
    /// Where lights lie.
    pub place: LightPlace,
    /// What the residual becomes.
    pub ambient: AmbientForm,
    /// Texels with energy that no light covers.
    pub uncovered: usize,
    /// Their energy, in units of the map; a part of the residual.
    pub uncovered_energy: [u64; 3],
}

/// Share of the luminance in texels that no light covers, up to which a
/// threshold is good enough. Of 0, 0.02, 0.05, 0.1 and 0.2 it had the least error
/// over six maps (docs/environment.md).
pub const BARE: f64 = 0.05;

impl Fit {
    /// Share of the luminance of `cube`, the map, that no light covers.
    pub fn bare_share(&self, cube: &CubeMap) -> f64 {
        luminance(self.uncovered_energy) as f64 / luminance(cube.total()) as f64
    }

    /// Sum of [`Fit::residual`].
    pub fn residual_energy(&self) -> [u64; 3] {
        sum(&self.residual)
    }
}

/// Fits lights to `cube`, which is called `name`.
///
/// # Errors
/// A setting is out of range, or all energy is residual.
pub fn fit(name: &str, cube: &CubeMap, settings: &FitSettings) -> Result<Fit, EnvironmentError> {
    if !(1..=MOST_LIGHTS).contains(&settings.lights) {
        return Err(EnvironmentError::Setting {
            what: "number of lights",
            value: settings.lights as f64,
            valid: "1 to 1024",
        });
    }
    let fit = match settings.threshold {
        Some(t) if t > 0.0 && t < 1.0 => Fitting::new(cube, settings, t).run(),
        Some(value) => {
            return Err(EnvironmentError::Setting {
                what: "threshold",
                value,
                valid: "above 0 and below 1",
            });
        }
        None => searched(cube, settings),
    };
    if fit.lights.is_empty() {
        return Err(EnvironmentError::NoLights {
            name: name.to_owned(),
        });
    }
    Ok(fit)
}

/// Halvings of the range of thresholds.
const HALVINGS: u32 = 16;
/// Smallest threshold tried: with it a light grows over a face of any size.
const SMALLEST: f64 = 1.0 / 65_536.0;

/// The fit with the largest threshold found that leaves little bare.
fn searched(cube: &CubeMap, settings: &FitSettings) -> Fit {
    let of = |t: f64| Fitting::new(cube, settings, t).run();
    let (mut low, mut high) = (SMALLEST, 1.0);
    let mut best = of(low);
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt(); // thresholds matter by ratio
        let found = of(middle);
        if found.bare_share(cube) <= BARE {
            (low, best) = (middle, found);
        } else {
            high = middle;
        }
    }
    best
}

/// Faces while lights are being taken out.
struct Fitting<'a> {
    settings: &'a FitSettings,
    threshold: f64,
    side: usize,
    /// Energy left.
    left: Vec<[u64; 3]>,
    /// What a texel of the face's mean radiance would have.
    mean: Vec<[u64; 3]>,
    covered: Vec<bool>,
    lights: Vec<AreaFit>,
}

/// A rectangle of texels, the high ends excluded.
#[derive(Clone, Copy)]
struct Area {
    face: usize,
    low: [usize; 2],
    high: [usize; 2],
}

impl<'a> Fitting<'a> {
    fn new(cube: &CubeMap, settings: &'a FitSettings, threshold: f64) -> Self {
        Self {
            settings,
            threshold,
            side: cube.side(),
            left: cube.texels().to_vec(),
            mean: means(cube),
            covered: vec![false; cube.texels().len()],
            lights: Vec::new(),
        }
    }

    fn run(mut self) -> Fit {
        let mut bare = [0, 1, 2, 3, 4, 5].map(|face| self.bare(face));
        while self.lights.len() < self.settings.lights {
            // The first of equals: `max_by_key` would give the last.
            let most = |best, face| if bare[face] > bare[best] { face } else { best };
            let face = (1..FACES).fold(0, most);
            let Some(seed) = self.seed(face) else {
                break;
            };
            let area = self.grown(self.area_of(seed));
            let (energy, found) = self.take(area);
            if let Some(moments) = found.moments(area.face, self.settings.form == LightForm::Square)
            {
                let Area { face, low, high } = area;
                self.lights.push(AreaFit {
                    face,
                    low,
                    high,
                    energy,
                    moments,
                });
            }
            bare[face] = self.bare(face);
        }
        // A stable sort: equals stay in the order of fitting.
        self.lights
            .sort_by_key(|l| std::cmp::Reverse(luminance(l.energy)));
        let texels = self.covered.iter().zip(&self.left);
        let bare = texels.filter(|(covered, left)| !**covered && luminance(**left) > 0);
        let bare: Vec<[u64; 3]> = bare.map(|(_, left)| *left).collect();
        Fit {
            uncovered: bare.len(),
            uncovered_energy: sum(&bare),
            lights: self.lights,
            residual: self.left,
            threshold: self.threshold,
            place: self.settings.place,
            ambient: self.settings.ambient,
        }
    }

    /// Luminance in texels of a face that no light covers.
    fn bare(&self, face: usize) -> u64 {
        let count = self.side * self.side;
        let texels = (face * count..(face + 1) * count).filter(|&i| !self.covered[i]);
        texels.map(|i| luminance(self.left[i])).sum()
    }

    /// The brightest texel with energy that no light covers, the first of equals.
    fn seed(&self, face: usize) -> Option<usize> {
        let count = self.side * self.side;
        let mut best = None;
        let mut most = 0;
        for i in face * count..(face + 1) * count {
            let bright = luminance(self.left[i]);
            if !self.covered[i] && bright > most {
                (best, most) = (Some(i), bright);
            }
        }
        best
    }

    fn area_of(&self, texel: usize) -> Area {
        let low = [texel % self.side, texel / self.side % self.side];
        Area {
            face: texel / (self.side * self.side),
            low,
            high: low.map(|k| k + 1),
        }
    }

    fn grown(&self, mut area: Area) -> Area {
        let mut energy = self.energy(area);
        loop {
            let before = energy;
            for turn in 0..4 {
                let larger = match self.settings.form {
                    LightForm::Rectangle => self.with_side(area, turn),
                    LightForm::Square => self.with_corner(area, turn),
                };
                let Some(larger) = larger else {
                    continue;
                };
                let total = self.energy_of_larger(area, larger, energy);
                if (total - energy) as f64 > self.threshold * total as f64 {
                    (area, energy) = (larger, total);
                }
            }
            if energy == before {
                return area; // what grows has gained energy
            }
        }
    }

    /// Larger by a texel at the left, right, top or bottom.
    fn with_side(&self, area: Area, turn: usize) -> Option<Area> {
        let (axis, mut larger) = (turn / 2, area);
        if turn.is_multiple_of(2) {
            larger.low[axis] = area.low[axis].checked_sub(1)?;
        } else {
            larger.high[axis] = Some(area.high[axis] + 1).filter(|h| *h <= self.side)?;
        }
        Some(larger)
    }

    /// Larger by a row and a column at one corner.
    fn with_corner(&self, area: Area, turn: usize) -> Option<Area> {
        let larger = self.with_side(area, turn % 2)?;
        self.with_side(larger, 2 + turn / 2)
    }

    fn energy(&self, area: Area) -> u64 {
        let rows = area.low[1]..area.high[1];
        rows.map(|y| self.row(area.face, y, area.low[0]..area.high[0]))
            .sum()
    }

    fn row(&self, face: usize, y: usize, columns: std::ops::Range<usize>) -> u64 {
        let first = (face * self.side + y) * self.side;
        let texels = &self.left[first + columns.start..first + columns.end];
        texels.iter().map(|e| luminance(*e)).sum()
    }

    /// Luminance in `larger`, of which `area` has `energy`.
    fn energy_of_larger(&self, area: Area, larger: Area, energy: u64) -> u64 {
        let part = |low: [usize; 2], high: [usize; 2]| {
            self.energy(Area {
                face: area.face,
                low,
                high,
            })
        };
        // Rows above and below over the whole width, then what is left and right.
        let [x0, y0] = larger.low;
        let [x1, y1] = larger.high;
        energy
            + part([x0, y0], [x1, area.low[1]])
            + part([x0, area.high[1]], [x1, y1])
            + part([x0, area.low[1]], [area.low[0], area.high[1]])
            + part([area.high[0], area.low[1]], [x1, area.high[1]])
    }

    /// Takes an area's energy out and covers it.
    fn take(&mut self, area: Area) -> ([u64; 3], Found) {
        let mut taken = [0; 3];
        let mut found = Found::new(self.side);
        for y in area.low[1]..area.high[1] {
            for x in area.low[0]..area.high[0] {
                let i = (area.face * self.side + y) * self.side + x;
                let (left, mean) = (self.left[i], self.mean[i]);
                let keep = match self.settings.residual {
                    ResidualRule::Mean => true,
                    ResidualRule::Excess => luminance(left) > luminance(mean),
                };
                let rest = [0, 1, 2].map(|c| if keep { left[c].min(mean[c]) } else { 0 });
                let own = [0, 1, 2].map(|c| left[c] - rest[c]);
                (0..3).for_each(|c| taken[c] += own[c]);
                found.add(area.face, [x, y], luminance(own));
                self.left[i] = rest;
                self.covered[i] = true;
            }
        }
        (taken, found)
    }
}

/// Energy that each texel would have if its face's were spread evenly over its
/// solid angle, rounded down.
fn means(cube: &CubeMap) -> Vec<[u64; 3]> {
    let count = cube.side() * cube.side();
    let mut out = Vec::with_capacity(FACES * count);
    for face in 0..FACES {
        let total = sum(&cube.texels()[face * count..(face + 1) * count]);
        let whole = 4.0 * std::f64::consts::PI / FACES as f64;
        out.extend((0..count).map(|i| {
            let share = cube.texel_angle(face * count + i) / whole;
            total.map(|e| (e as f64 * share) as u64)
        }));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::oracle::sampled::jitter;
    use crate::world::environment::{Environment, MapSettings, SKY};
    use proptest::prelude::*;

    fn sky() -> CubeMap {
        let settings = MapSettings {
            side: 48,
            ..MapSettings::default()
        };
        Environment::open(SKY, settings).unwrap().cube
    }

    /// Random texels, some of them thousands of times brighter.
    fn random(side: usize, seed: u64) -> CubeMap {
        let texel = |i: usize| {
            let value = |k: u64| jitter(seed, 8 * i as u64 + k);
            let scale = if value(3) < 0.02 { 3000.0 } else { 1.0 };
            [0, 1, 2].map(|c| scale * value(c) * value(c))
        };
        CubeMap::new(side, (0..6 * side * side).map(texel).collect()).unwrap()
    }

    fn sum_of(fit: &Fit) -> [u64; 3] {
        let lights: Vec<[u64; 3]> = fit.lights.iter().map(|l| l.energy).collect();
        sum(&[sum(&lights), fit.residual_energy()])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        /// Lights and residual are the map, in whole numbers; no texel gains.
        #[test]
        fn energy_is_conserved_exactly(
            seed in 0u64..1 << 40, side in 1usize..14, lights in 1usize..70,
            given in prop::option::of(0.001f64..0.5), square in any::<bool>(), mean in any::<bool>(),
        ) {
            let cube = random(side, seed);
            let settings = FitSettings {
                lights,
                threshold: given,
                form: if square { LightForm::Square } else { LightForm::Rectangle },
                residual: if mean { ResidualRule::Mean } else { ResidualRule::Excess },
                ..FitSettings::default()
            };
            let Ok(fit) = fit("random", &cube, &settings) else {
                // Every face is of one brightness: nothing exceeds the mean.
                prop_assert!(mean && side == 1);
                return Ok(());
            };
            prop_assert_eq!(sum_of(&fit), cube.total());
            prop_assert!(fit.lights.len() <= lights);
            for (left, had) in fit.residual.iter().zip(cube.texels()) {
                prop_assert!((0..3).all(|c| left[c] <= had[c]));
            }
            for light in &fit.lights {
                let sides = [0, 1].map(|k| light.high[k] - light.low[k]);
                prop_assert!(!square || sides[0] == sides[1]);
                prop_assert!(light.high.iter().all(|h| *h <= side) && luminance(light.energy) > 0);
            }
        }
    }

    #[test]
    fn counts_are_met_and_little_is_left_bare() {
        let cube = sky();
        for lights in [30, 45, 60] {
            for form in [LightForm::Square, LightForm::Rectangle] {
                let settings = FitSettings {
                    lights,
                    form,
                    ..FitSettings::default()
                };
                let fit = fit("sky", &cube, &settings).unwrap();
                assert!(fit.bare_share(&cube) <= BARE, "{}", fit.bare_share(&cube));
                let residual = luminance(fit.residual_energy()) as f64;
                assert!(residual < 0.2 * luminance(cube.total()) as f64);
                let found = fit.lights.len();
                assert!(
                    found <= lights && found * 4 >= lights * 3,
                    "{found} of {lights}"
                );
            }
        }
    }

    /// More lights hold more of the energy, and the brightest is the sun alone.
    #[test]
    fn the_sun_is_a_light_of_its_own() {
        let cube = sky();
        let fit = fit("sky", &cube, &FitSettings::default()).unwrap();
        let sun = fit.lights[0];
        assert!((0..2).all(|k| sun.high[k] - sun.low[k] <= 4), "{sun:?}");
        let share = luminance(sun.energy) as f64 / luminance(cube.total()) as f64;
        assert!(share > 0.2, "{share}");
    }

    /// A row of the paper's figure 6 worked by hand: a bright texel in the middle
    /// of a dim face is left at the mean, and the next light grows over it.
    #[test]
    fn the_hole_is_bridged() {
        const N: usize = 8;
        let mut radiance = vec![[0.0; 3]; 6 * N * N];
        radiance[..N * N].fill([1.0; 3]);
        radiance[3 * N + 3] = [500.0; 3];
        let cube = CubeMap::new(N, radiance).unwrap();
        let settings = FitSettings {
            threshold: Some(0.05),
            form: LightForm::Rectangle,
            ..FitSettings::default()
        };
        let excess = fit("hole", &cube, &settings).unwrap();
        let [spot, rest] = excess.lights[..] else {
            panic!("{:?}", excess.lights);
        };
        assert_eq!((spot.low, spot.high), ([3, 3], [4, 4]));
        assert_eq!((rest.low, rest.high), ([0, 0], [N, N]));
        // Nothing is left: the second light took the residual of the first.
        assert_eq!(excess.residual_energy(), [0; 3]);
        let settings = FitSettings {
            residual: ResidualRule::Mean,
            ..settings
        };
        let mean = fit("hole", &cube, &settings).unwrap();
        assert_eq!(mean.lights.len(), 1);
        assert!(mean.residual_energy()[0] > 0);
    }

    #[test]
    fn settings_are_checked() {
        let cube = sky();
        let message = |lights, threshold| {
            let settings = FitSettings {
                lights,
                threshold,
                ..FitSettings::default()
            };
            fit("sky", &cube, &settings).unwrap_err().to_string()
        };
        assert!(message(0, None).contains("1 to 1024"));
        assert!(message(30, Some(1.0)).contains("threshold is 1"));
        assert!(message(30, Some(f64::NAN)).contains("threshold"));
    }
}
