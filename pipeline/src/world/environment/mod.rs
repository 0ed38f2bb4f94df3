//! Environment lighting: a map of the light that arrives from far away in every
//! direction, and area lights that stand for it (Annen et al. 2008, §4.2).
//!
//! A map is read (`read`), kept as its file has it ([`MapSource`]), and its energy is
//! spread over the six faces of a cube (`spread`) in whole numbers ([`cube`]). [`fit`] takes rectangles of energy
//! out of the faces; what it leaves is the residual. Since energy is counted in
//! integers, lights and residual sum to the map exactly, in each colour.
//! [`scene::environment`](crate::world::scene::environment) puts the rectangles into a scene as lights.
//!
//! # Units and directions
//!
//! Maps hold linear RGB radiance; energy is radiance times solid angle. A light
//! of energy E has the colour E/π, since a colour of 1 shades a facing white
//! surface to 1 and a Lambertian reflects albedo/π. In latitude-longitude maps
//! the top row is straight up (+y), the middle column looks along -z, and columns
//! further right turn towards +x.
//!
//! ```
//! use gnomon_pipeline::world::environment::{Environment, FitSettings};
//! use gnomon_pipeline::world::scene::{builtin, environment::place};
//!
//! let sky = Environment::open("sky", Default::default())?;
//! let fit = sky.fit(&FitSettings { lights: 30, ..FitSettings::default() })?;
//! assert!(fit.lights.len() <= 30);
//! let mut sum = fit.residual_energy();
//! for light in &fit.lights {
//!     (0..3).for_each(|c| sum[c] += light.energy[c]);
//! }
//! assert_eq!(sum, sky.cube.total()); // exactly
//! let mut scene = builtin::build("creature")?;
//! place(&mut scene, &sky, fit)?;
//! assert!(scene.lights.len() <= 30);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod cube;
pub mod decomposition;
mod error;
pub mod fit;
mod layout;
mod moments;
mod placed;
mod read;
mod settings;
mod sky;
mod source;
mod spread;

use std::path::Path;
use std::sync::Arc;

pub use cube::CubeMap;
pub use error::EnvironmentError;
pub use fit::{
    AmbientForm, AreaFit, Fit, FitSettings, LightForm, LightPlace, Moments, ResidualRule,
};
pub use placed::{DISTANCE, PlacedEnvironment};
pub(in crate::world) use read::decode;
pub use read::decode_exr;
pub use settings::MapSettings;
pub use source::MapSource;

use crate::world::files::SceneFolder;
use crate::world::warning::SceneWarning;
use layout::Picture;

/// Name of the procedural map, which needs no file.
pub const SKY: &str = "sky";

/// A map, ready to be fitted or sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// What it was called by.
    pub name: String,
    /// As its file has it.
    pub source: Arc<MapSource>,
    /// Its energy on a cube.
    pub cube: CubeMap,
    /// Texels that were mended, energy that was lost.
    pub warnings: Vec<SceneWarning>,
}

impl Environment {
    /// The map called `name`: `sky`, a `.hdr` or `.exr` file, or a folder of six.
    ///
    /// # Errors
    /// It cannot be read, has no known layout, or no light in it.
    pub fn open(name: &str, settings: MapSettings) -> Result<Self, EnvironmentError> {
        Self::open_from(name, None, settings)
    }

    /// The same; a file must lie in `folder` if there is one.
    pub(crate) fn open_from(
        name: &str,
        folder: Option<&SceneFolder>,
        settings: MapSettings,
    ) -> Result<Self, EnvironmentError> {
        settings.check()?;
        let picture = if name == SKY {
            sky::picture()
        } else {
            read::open(Path::new(name), folder)?
        };
        Self::of_picture(name, picture, settings)
    }

    /// A latitude-longitude, cross or strip map from linear radiance, rows from
    /// the top; see [`EnvironmentError::Layout`] for the shapes.
    ///
    /// # Errors
    /// The size is of no known layout, or there is no light.
    pub fn of_radiance(
        name: &str,
        size: [usize; 2],
        texels: Vec<[f32; 3]>,
        settings: MapSettings,
    ) -> Result<Self, EnvironmentError> {
        settings.check()?;
        Self::of_picture(name, Picture::new(name, size, texels)?, settings)
    }

    fn of_picture(
        name: &str,
        mut picture: Picture,
        settings: MapSettings,
    ) -> Result<Self, EnvironmentError> {
        let warnings = std::mem::take(&mut picture.warnings);
        let source = MapSource::new(picture, settings);
        let faces = source.faces();
        let cube = CubeMap::of_energy(faces.side, &faces.energy);
        Ok(Self {
            name: name.to_owned(),
            source: Arc::new(source),
            cube: cube.ok_or_else(|| EnvironmentError::Dark {
                name: name.to_owned(),
            })?,
            warnings,
        })
    }

    /// Fits area lights.
    ///
    /// # Errors
    /// As [`fit::fit`].
    pub fn fit(&self, settings: &FitSettings) -> Result<Fit, EnvironmentError> {
        fit::fit(&self.name, &self.cube, settings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(size: [usize; 2], texels: Vec<[f32; 3]>) -> Result<Environment, EnvironmentError> {
        Environment::of_radiance("test", size, texels, MapSettings::default())
    }

    #[test]
    fn one_texel_is_the_same_light_from_everywhere() {
        let all = of([1, 1], vec![[0.25, 0.5, 1.0]]).unwrap();
        assert_eq!(all.cube.side(), 1);
        let whole = 4.0 * std::f64::consts::PI;
        let total = all.cube.energy(all.cube.total());
        for (energy, radiance) in total.into_iter().zip([0.25, 0.5, 1.0]) {
            assert!((energy - whole * radiance).abs() < 1e-9, "{energy}");
        }
        let fit = all.fit(&FitSettings::default()).unwrap();
        assert_eq!(fit.lights.len(), 6);
        assert_eq!(fit.residual_energy(), [0; 3]);
    }

    #[test]
    fn maps_without_light_are_refused() {
        let message = of([2, 1], vec![[0.0; 3]; 2]).unwrap_err().to_string();
        assert!(message.contains("no light"), "{message}");
        let message = of([2, 1], vec![[f32::NAN; 3]; 2]).unwrap_err().to_string();
        assert!(message.contains("no light"), "{message}");
    }

    #[test]
    fn texels_that_are_no_radiance_are_mended_and_counted() {
        let mut texels = vec![[1.0; 3]; 32];
        texels[3] = [f32::NAN, 1.0, 1.0];
        texels[9] = [-2.0, 1.0, -1.0];
        texels[20] = [f32::INFINITY, 7.0, 1.0];
        let mended = of([8, 4], texels).unwrap();
        let codes: Vec<_> = mended.warnings.iter().map(|w| (w.code, w.count)).collect();
        let expected = [
            ("environment-nan", 1),
            ("environment-negative", 1),
            ("environment-infinite", 1),
        ];
        assert_eq!(codes, expected);
        let brightest = mended.cube.radiance().fold(0.0, |m, rgb| rgb[0].max(m));
        assert!((brightest - 7.0).abs() < 1e-2, "{brightest}");
    }

    /// The cube, in whole units, has the energy of the file at any turn.
    #[test]
    fn energy_of_the_file_is_kept() {
        for turn in [0.0, 0.35, 123.4] {
            let mut settings = MapSettings {
                turn,
                ..MapSettings::default()
            };
            for side in [16, 128] {
                settings.side = side;
                assert!(energy_error(&Environment::open(SKY, settings).unwrap()) < 1e-6);
            }
        }
    }

    /// Relative, of the colour that is furthest off.
    fn energy_error(map: &Environment) -> f64 {
        let (file, cube) = (&map.source, map.cube.energy(map.cube.total()));
        let off = |c: usize| {
            let energy: f64 = (0..file.len()).map(|i| file.energy(i)[c]).sum();
            (cube[c] / energy - 1.0).abs()
        };
        (0..3).map(off).fold(0.0, f64::max)
    }

    /// Of every map of the data folder.
    #[test]
    #[ignore = "needs GNOMON_DATA, a folder with env/*.hdr"]
    fn energy_of_files_is_kept() {
        let folder = std::env::var("GNOMON_DATA").expect("GNOMON_DATA names a folder");
        let mut count = 0;
        for entry in std::fs::read_dir(Path::new(&folder).join("env")).unwrap() {
            let path = entry.unwrap().path().display().to_string();
            for turn in [0.0, 0.35] {
                let settings = MapSettings {
                    turn,
                    ..MapSettings::default()
                };
                let off = energy_error(&Environment::open(&path, settings).unwrap());
                println!("{path} {turn}: {off:.1e}");
                assert!(off < 1e-6, "{path} {turn}: {off}");
                count += 1;
            }
        }
        assert!(count > 0);
    }

    #[test]
    fn settings_and_sizes_are_checked() {
        let wrong = of([3, 5], vec![[1.0; 3]; 15]).unwrap_err().to_string();
        assert!(wrong.contains("3x5") && wrong.contains("2:1"), "{wrong}");
        let few = of([4, 2], vec![[1.0; 3]; 7]).unwrap_err().to_string();
        assert!(few.contains("7 texels"), "{few}");
        for (side, turn, brightness) in [
            (0, 0.0, 1.0),
            (8, f64::NAN, 1.0),
            (8, 0.0, 0.0),
            (8, 0.0, -1.0),
        ] {
            let settings = MapSettings {
                side,
                turn,
                brightness,
            };
            assert!(Environment::open(SKY, settings).is_err());
        }
    }
}
