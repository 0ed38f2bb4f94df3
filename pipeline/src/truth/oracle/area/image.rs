//! Visibility of one light for every pixel of an image.

use rayon::prelude::*;

use super::{AreaOracle, CLASS_TOLERANCE, Workspace};
use crate::geometry::coverage::ImageSums;
use crate::truth::oracle::surfaces::{Receiver, Surfaces};
use crate::world::error::LightError;
use crate::world::light_image::LightImage;
use crate::world::scene::Scene;

/// Where a receiver lies in a light's shadow, by exact visibility.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LightRegion {
    /// Nothing of the light is seen.
    Umbra,
    /// A part of it.
    Penumbra,
    /// All of it.
    Lit,
}

impl LightRegion {
    /// All regions, dark to bright.
    pub const ALL: [Self; 3] = [Self::Umbra, Self::Penumbra, Self::Lit];

    /// The region of a visibility, within [`CLASS_TOLERANCE`]; `None` for NaN.
    pub fn of(visibility: f64) -> Option<Self> {
        if visibility.is_nan() {
            None
        } else if visibility <= CLASS_TOLERANCE {
            Some(Self::Umbra)
        } else if visibility >= 1.0 - CLASS_TOLERANCE {
            Some(Self::Lit)
        } else {
            Some(Self::Penumbra)
        }
    }
}

/// Visible share of a light per pixel, at pixel centres.
#[derive(Clone, Debug)]
pub struct VisibilityImage {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Row by row, row 0 on top; 0..=1, NaN where no surface is seen.
    pub values: Vec<f64>,
}

/// Equal to the bit, NaN included.
impl PartialEq for VisibilityImage {
    fn eq(&self, other: &Self) -> bool {
        let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        self.size == other.size && bits(&self.values) == bits(&other.values)
    }
}

impl VisibilityImage {
    /// Evaluates light number `light` of `scene` exactly. Runs in parallel; the
    /// result does not depend on the thread count. `row_done` is called once per
    /// finished row, from any thread.
    ///
    /// # Errors
    /// The light should have an extent and has none.
    ///
    /// # Panics
    /// There is no such light.
    pub fn of_scene(
        scene: &Scene,
        light: usize,
        size: [u32; 2],
        row_done: &(dyn Fn() + Sync),
    ) -> Result<Self, LightError> {
        let (surfaces, oracle) = AreaOracle::of_scene(scene, light)?;
        let per_row = || {
            let (oracle, mut work) = (&oracle, Workspace::default());
            move |receiver: &Receiver, _| oracle.visibility_with(receiver, &mut work).share
        };
        Ok(Self::of_pixels(&surfaces, scene, size, row_done, per_row))
    }

    /// The same of one colour of an image on the light, 0 for red, which is a rectangle.
    ///
    /// # Errors
    /// As [`VisibilityImage::of_scene`].
    ///
    /// # Panics
    /// There is no such light.
    pub fn of_light_image(
        scene: &Scene,
        light: usize,
        (image, colour): (&LightImage, usize),
        size: [u32; 2],
        row_done: &(dyn Fn() + Sync),
    ) -> Result<Self, LightError> {
        let (surfaces, oracle) = AreaOracle::of_scene(scene, light)?;
        let sums = ImageSums::new(image);
        let per_row = || {
            let (oracle, sums, mut work) = (&oracle, &sums, Workspace::default());
            move |receiver: &Receiver, _| oracle.colours_with(sums, receiver, &mut work)[colour]
        };
        Ok(Self::of_pixels(&surfaces, scene, size, row_done, per_row))
    }

    /// Evaluates `visibility(receiver, pixel)` at every pixel that shows a
    /// surface; `per_row` makes the function for one row.
    pub(crate) fn of_pixels<F>(
        surfaces: &Surfaces,
        scene: &Scene,
        [width, height]: [u32; 2],
        row_done: &(dyn Fn() + Sync),
        per_row: impl Fn() -> F + Sync,
    ) -> Self
    where
        F: FnMut(&Receiver, u32) -> f64,
    {
        let rays = scene.camera.eye_rays(width, height);
        let row = |y: u32| {
            let mut visibility = per_row();
            let values = (0..width).map(|x| {
                let (cx, cy) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                match surfaces.receiver(&rays, cx, cy) {
                    Some(receiver) => visibility(&receiver, y * width + x),
                    None => f64::NAN,
                }
            });
            let values: Vec<f64> = values.collect();
            row_done();
            values
        };
        let rows: Vec<Vec<f64>> = (0..height).into_par_iter().map(row).collect();
        Self {
            size: [width, height],
            values: rows.concat(),
        }
    }

    /// Value in column `x`, row `y` from the top.
    pub fn at(&self, x: u32, y: u32) -> f64 {
        self.values[(y * self.size[0] + x) as usize]
    }

    /// Region of each pixel; `None` where no surface is seen.
    pub fn regions(&self) -> Vec<Option<LightRegion>> {
        self.values.iter().map(|v| LightRegion::of(*v)).collect()
    }
}
