//! The truth about one light of a scene, and how it was come by.

use std::str::FromStr;

use thiserror::Error;

use super::CompareError;
use super::aligned::Aligned;
use super::sight::Sight;
use crate::truth::metrics::MetricError;
use crate::truth::oracle::area::VisibilityImage;
use crate::truth::oracle::cache::{CacheWarning, Cached, OracleCache};
use crate::truth::oracle::sampled::SampledOracle;
use crate::truth::oracle::surfaces::Surfaces;
use crate::world::light::LightShape;
use crate::world::light_image::LightImage;
use crate::world::scene::Scene;

/// Side of the square of strata of [`ReferenceKind::Rays`]: 4096 rays a pixel.
pub const RAYS_SIDE: u32 = 64;
/// Seed of [`ReferenceKind::Rays`].
pub const RAYS_SEED: u64 = 1;

/// Which oracle is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReferenceKind {
    /// [`crate::truth::oracle::area`]: areas in f64, no noise.
    #[default]
    Exact,
    /// [`crate::truth::oracle::sampled`]: [`RAYS_SIDE`]² stratified shadow rays.
    Rays,
}

impl ReferenceKind {
    /// Names in the order of the variants.
    pub const NAMES: [&str; 2] = ["exact", "rays"];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// A reference that there is not.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("no reference is called '{0}'; valid are: {names}", names = ReferenceKind::NAMES.join(", "))]
pub struct UnknownReference(pub String);

impl FromStr for ReferenceKind {
    type Err = UnknownReference;

    fn from_str(name: &str) -> Result<Self, UnknownReference> {
        match name {
            "exact" => Ok(Self::Exact),
            "rays" => Ok(Self::Rays),
            other => Err(UnknownReference(other.to_owned())),
        }
    }
}

/// How a reference was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Worked out now.
    Computed,
    /// Read from the cache.
    Read,
}

/// Visibility of one light, true at every pixel of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The oracle that was asked.
    pub kind: ReferenceKind,
    /// Index into [`Scene::lights`].
    pub light: usize,
    /// Whether the light has an extent; without one the truth is a hard shadow.
    pub is_soft: bool,
    /// The truth. Objects that take no shadow see all of the light, as they do
    /// in every technique.
    pub image: VisibilityImage,
    /// Computed or read.
    pub origin: Origin,
    /// What went wrong with the cache.
    pub warnings: Vec<CacheWarning>,
    /// What is on the light.
    pub light_image: Option<LightImage>,
    /// Green and blue of a light with an image, of which `image` is red.
    others: Option<[VisibilityImage; 2]>,
    sight: Sight,
}

impl Reference {
    /// Asks the oracle `kind` about light number `light` of `scene` at `size`,
    /// by way of `cache` if there is one. `row_done` is called for every row
    /// that is computed, from any thread.
    ///
    /// # Errors
    /// The scene has no such light, or it should have an extent and has none.
    pub fn new(
        scene: &Scene,
        light: usize,
        size: [u32; 2],
        kind: ReferenceKind,
        cache: Option<&OracleCache>,
        row_done: &(dyn Fn() + Sync),
    ) -> Result<Self, CompareError> {
        Self::with_light_image(scene, (light, None), size, kind, cache, row_done)
    }

    /// The same of a light with an image, if there is one: each colour is seen apart.
    /// Without effect on lights that are no rectangles.
    ///
    /// # Errors
    /// As [`Reference::new`]; shadow rays know no images.
    pub fn with_light_image(
        scene: &Scene,
        (light, image): (usize, Option<&LightImage>),
        size: [u32; 2],
        kind: ReferenceKind,
        cache: Option<&OracleCache>,
        row_done: &(dyn Fn() + Sync),
    ) -> Result<Self, CompareError> {
        let count = scene.lights.len();
        let Some(shape) = scene.lights.get(light).map(|l| &l.shape) else {
            let given = light;
            return Err(CompareError::NoSuchLight { given, count });
        };
        let surfaces = Surfaces::new(scene);
        let image = image.filter(|_| matches!(shape, LightShape::Rectangle { .. }));
        if image.is_some() && kind == ReferenceKind::Rays {
            return Err(CompareError::ImageByRays);
        }
        let coloured = |image: &LightImage, colour: usize| match cache {
            Some(cache) => cache.of_light_image(scene, light, (image, colour), size, row_done),
            None => VisibilityImage::of_light_image(scene, light, (image, colour), size, row_done)
                .map(computed),
        };
        let mut found = match (kind, cache, image) {
            (_, _, Some(image)) => coloured(image, 0)?,
            (ReferenceKind::Exact, Some(cache), _) => {
                cache.visibility(scene, light, size, row_done)?
            }
            (ReferenceKind::Rays, Some(cache), _) => {
                cache.sampled(scene, light, size, (RAYS_SIDE, RAYS_SEED), row_done)?
            }
            (ReferenceKind::Exact, None, _) => {
                computed(VisibilityImage::of_scene(scene, light, size, row_done)?)
            }
            (ReferenceKind::Rays, None, _) => {
                let oracle = SampledOracle::new(&surfaces, shape, RAYS_SIDE, RAYS_SEED)?;
                computed(oracle.image(&surfaces, scene, size, row_done))
            }
        };
        let sight = Sight::new(scene, &surfaces, size);
        sight.light_what_takes_no_shadow(&mut found.image);
        let others = match image {
            Some(image) => {
                let mut both = [coloured(image, 1)?.image, coloured(image, 2)?.image];
                both.iter_mut()
                    .for_each(|i| sight.light_what_takes_no_shadow(i));
                Some(both)
            }
            None => None,
        };
        Ok(Self {
            kind,
            light,
            is_soft: !matches!(
                shape,
                LightShape::Point { .. } | LightShape::Directional { .. }
            ),
            image: found.image,
            origin: if found.was_read {
                Origin::Read
            } else {
                Origin::Computed
            },
            warnings: found.warnings,
            light_image: image.cloned(),
            others,
            sight,
        })
    }

    /// A truth that was found elsewhere: visibility of light number `light`, at every pixel
    /// of an image, NaN where it says nothing.
    ///
    /// # Errors
    /// The scene has no such light.
    pub fn given(
        scene: &Scene,
        light: usize,
        image: VisibilityImage,
    ) -> Result<Self, CompareError> {
        let count = scene.lights.len();
        let Some(shape) = scene.lights.get(light).map(|l| &l.shape) else {
            let given = light;
            return Err(CompareError::NoSuchLight { given, count });
        };
        Ok(Self {
            kind: ReferenceKind::Exact,
            light,
            is_soft: !matches!(
                shape,
                LightShape::Point { .. } | LightShape::Directional { .. }
            ),
            origin: Origin::Read,
            warnings: Vec::new(),
            light_image: None,
            others: None,
            sight: Sight::new(scene, &Surfaces::new(scene), image.size),
            image,
        })
    }

    /// The truth as a picture with this depth buffer (0..=1, 1 where no surface
    /// is seen, row 0 on top) should show it.
    ///
    /// # Errors
    /// `depth` is of another size.
    pub fn under(&self, depth: &[f32]) -> Result<Aligned, MetricError> {
        let mut aligned = Aligned::new(&self.image, &self.sight, depth)?;
        if let Some([green, blue]) = &self.others {
            let shading = |image| Ok(Aligned::new(image, &self.sight, depth)?.for_shading);
            aligned.other_colours = Some([shading(green)?, shading(blue)?]);
        }
        Ok(aligned)
    }
}

fn computed(image: VisibilityImage) -> Cached {
    Cached {
        image,
        was_read: false,
        warnings: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;
    use glam::DVec3;

    const SIZE: [u32; 2] = [40, 30];

    fn reference(scene: &Scene, kind: ReferenceKind) -> Result<Reference, CompareError> {
        Reference::new(scene, 0, SIZE, kind, None, &|| {})
    }

    #[test]
    fn the_two_references_agree_and_are_not_the_same() {
        let scene = builtin::build("cylinder").unwrap();
        let of = |kind| reference(&scene, kind).unwrap();
        let (exact, rays) = (of(ReferenceKind::Exact), of(ReferenceKind::Rays));
        assert!(exact.is_soft && exact.image != rays.image);
        let pairs = exact.image.values.iter().zip(&rays.image.values);
        let off = pairs
            .filter(|(e, _)| !e.is_nan())
            .map(|(e, r)| (e - r).abs());
        assert!(off.fold(0.0, f64::max) < 0.01);
    }

    #[test]
    fn lights_without_extent_have_a_hard_truth() {
        let mut scene = builtin::build("cylinder").unwrap();
        scene.lights[0].shape = LightShape::Directional {
            towards: DVec3::new(0.3, 1.0, 0.2),
        };
        for kind in [ReferenceKind::Exact, ReferenceKind::Rays] {
            let found = reference(&scene, kind).unwrap();
            assert!(!found.is_soft);
            let is_hard = |v: &f64| v.is_nan() || *v == 0.0 || *v == 1.0;
            assert!(found.image.values.iter().all(is_hard));
            assert!(found.image.values.contains(&0.0));
        }
    }

    #[test]
    fn what_takes_no_shadow_is_lit_in_the_truth() {
        let mut scene = builtin::build("cylinder").unwrap();
        let shadowed = |s: &Scene| {
            let image = reference(s, ReferenceKind::Exact).unwrap().image;
            image.values.iter().filter(|v| **v < 0.5).count()
        };
        let all = shadowed(&scene);
        scene.objects.iter_mut().for_each(|o| o.receives = false);
        assert_eq!((all > 20, shadowed(&scene)), (true, 0));
    }

    #[test]
    fn missing_lights_and_unknown_references_say_what_there_is() {
        let scene = builtin::build("cylinder").unwrap();
        let none = Reference::new(&scene, 3, SIZE, ReferenceKind::Exact, None, &|| {});
        let message = none.unwrap_err().to_string();
        assert!(
            message.contains("light 3") && message.contains("has 1"),
            "{message}"
        );
        let message = "truth".parse::<ReferenceKind>().unwrap_err().to_string();
        assert!(message.contains("'truth'") && message.contains("exact, rays"));
        for kind in [ReferenceKind::Exact, ReferenceKind::Rays] {
            assert_eq!(kind.name().parse(), Ok(kind));
        }
    }
}
