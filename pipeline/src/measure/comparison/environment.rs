//! Environment lighting against sampled directions: errors of light, not of
//! visibility, since tens of lights overlap (Annen et al. 2008,
//! figures 10 and 11).

use super::CompareError;
use super::pixels::{LeftOut, PixelCounts};
use super::sight::{Match, Sight};
use crate::measure::render::{Rendered, SrgbEncoder};
use crate::truth::metrics::flip::{DEFAULT_PIXELS_PER_DEGREE, flip};
use crate::truth::metrics::psnr::psnr;
use crate::truth::metrics::ssim::ssim;
use crate::truth::metrics::{MetricError, Picture, rgb_of};
use crate::truth::oracle::environment::{EnvironmentOracle, samples};
use crate::truth::oracle::surfaces::Surfaces;
use crate::world::environment::Environment;
use crate::world::scene::Scene;

/// Luminance of linear Rec. 709 RGB.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Light of every pixel under a map, by sampled directions and shadow rays.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentReference {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Directions that were sampled.
    pub directions: usize,
    /// Linear RGB; `None` where no surface is seen.
    pub radiance: Vec<Option<[f64; 3]>>,
    /// The picture, with the map where no surface is seen.
    pub srgb: Vec<[u8; 4]>,
    sight: Sight,
}

/// How the reference is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Directions {
    /// How many.
    pub count: usize,
    /// Moves them.
    pub seed: u64,
}

impl EnvironmentReference {
    /// Casts the rays. Of `scene` geometry, camera, materials and background
    /// count; `highlights` as in the parameter `shading=phong`. `row_done` is
    /// called for every row, from any thread.
    pub fn new(
        scene: &Scene,
        map: &Environment,
        size: [u32; 2],
        directions: Directions,
        highlights: bool,
        row_done: &(dyn Fn() + Sync),
    ) -> Self {
        let surfaces = Surfaces::new(scene);
        let samples = samples(&map.source, directions.count, directions.seed);
        let oracle = EnvironmentOracle::new(&surfaces, samples);
        let radiance = oracle.image(&surfaces, scene, size, highlights, row_done);
        let encoder = SrgbEncoder::new();
        let rays = scene.camera.eye_rays(size[0], size[1]);
        let behind = |i: usize| {
            let [x, y] = [i as u32 % size[0], i as u32 / size[0]].map(f64::from);
            scene.behind(rays.direction(x + 0.5, y + 0.5))
        };
        let shown = |(i, rgb): (usize, &Option<[f64; 3]>)| {
            let [r, g, b] = rgb.map_or_else(|| behind(i), |rgb| rgb.map(|v| v as f32));
            encoder.encode([r, g, b, 1.0])
        };
        Self {
            size,
            directions: directions.count,
            srgb: radiance.iter().enumerate().map(shown).collect(),
            radiance,
            sight: Sight::new(scene, &surfaces, size),
        }
    }

    /// Luminance of `done` minus the reference's at every pixel; NaN where the
    /// reference has no surface, or where the picture may show another one.
    ///
    /// # Errors
    /// The sizes differ.
    pub fn difference(&self, done: &Rendered) -> Result<Vec<f64>, CompareError> {
        let luminance = |rgb: [f64; 3]| (0..3).map(|c| LUMINANCE[c] * rgb[c]).sum::<f64>();
        let difference = |(test, truth): ([f64; 3], [f64; 3])| luminance(test) - luminance(truth);
        let pairs = self.pairs(done)?;
        Ok(pairs
            .into_iter()
            .map(|p| p.map_or(f64::NAN, difference))
            .collect())
    }

    /// Light of the picture and of the reference where both show one surface.
    fn pairs(&self, done: &Rendered) -> Result<Vec<Option<Pair>>, CompareError> {
        if self.size != done.size {
            let (reference, test) = (self.size, done.size);
            return Err(MetricError::SizesDiffer { reference, test }.into());
        }
        let pair = |(i, found): (usize, Match)| {
            let truth = self.radiance[i].filter(|_| found == Match::Surface)?;
            Some((done.color[i].map(f64::from), truth))
        };
        Ok(self.matches(done).enumerate().map(pair).collect())
    }

    /// Of a picture of the same size.
    fn matches<'a>(&'a self, done: &'a Rendered) -> impl Iterator<Item = Match> + 'a {
        let depth = done.depth.iter().enumerate();
        depth.map(|(i, depth)| self.sight.match_depth(i, *depth))
    }

    /// Of which `compared` were compared.
    fn count_pixels(&self, done: &Rendered, compared: usize) -> PixelCounts {
        let mut left_out = LeftOut::of(self.matches(done));
        let surfaces = self.matches(done).filter(|m| *m == Match::Surface);
        left_out.no_value = surfaces.count() - compared;
        PixelCounts { compared, left_out }
    }
}

type Pair = ([f64; 3], [f64; 3]);

/// How far a picture is from the reference. Linear errors are of RGB, of which
/// 1 is display white; nothing is limited to it.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceScore {
    /// How many pixels linear errors are of, and why others were left out.
    pub pixels: PixelCounts,
    /// Root of the mean squared error over pixels and channels.
    pub rmse: f64,
    /// The same as a share of the reference's mean.
    pub relative_rmse: f64,
    /// Largest error of a channel.
    pub max: f64,
    /// 99% of the pixels' largest errors are within.
    pub p99: f64,
    /// Mean error, above 0 where the picture is too bright.
    pub mean: f64,
    /// `-20 log10(rmse)`, decibels; infinite for no error.
    pub linear_psnr: f64,
    /// Of the shaded sRGB pictures, decibels; infinite for equal ones.
    pub psnr: f64,
    /// Of their luma; `None` for pictures smaller than its window.
    pub ssim: Option<f64>,
    /// Mean LDR-FLIP.
    pub flip: f64,
}

impl RadianceScore {
    /// Compares `done` with `reference`.
    ///
    /// # Errors
    /// The sizes differ.
    pub fn measure(
        reference: &EnvironmentReference,
        done: &Rendered,
    ) -> Result<Self, CompareError> {
        let pairs = reference.pairs(done)?;
        let (mut squares, mut sum, mut truth_sum) = (0.0, 0.0, 0.0);
        let mut largest = Vec::new();
        for (test, truth) in pairs.iter().flatten() {
            let mut worst = 0.0f64;
            for c in 0..3 {
                let error = test[c] - truth[c];
                squares += error * error;
                sum += error;
                truth_sum += truth[c];
                worst = worst.max(error.abs());
            }
            largest.push(worst);
        }
        let values = (3 * largest.len()).max(1) as f64;
        let rmse = (squares / values).sqrt();
        largest.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let last = largest.len().saturating_sub(1) as f64;
            largest.get((share * last) as usize).copied().unwrap_or(0.0)
        };
        let [truth, test] = [rgb_of(&reference.srgb), rgb_of(&done.srgb)];
        let size = reference.size;
        let (truth, test) = (Picture::new(size, &truth)?, Picture::new(size, &test)?);
        Ok(Self {
            pixels: reference.count_pixels(done, largest.len()),
            rmse,
            relative_rmse: if truth_sum > 0.0 {
                rmse / (truth_sum / values)
            } else {
                0.0
            },
            max: at(1.0),
            p99: at(0.99),
            mean: sum / values,
            linear_psnr: if rmse > 0.0 {
                -20.0 * libm::log10(rmse)
            } else {
                f64::INFINITY
            },
            psnr: psnr(truth, test)?,
            ssim: match ssim(truth, test) {
                Ok(value) => Some(value),
                Err(MetricError::TooSmall { .. }) => None,
                Err(other) => return Err(other.into()),
            },
            flip: flip(truth, test, DEFAULT_PIXELS_PER_DEGREE)?.mean,
        })
    }
}
