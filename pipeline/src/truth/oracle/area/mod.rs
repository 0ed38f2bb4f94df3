//! Area lights, exactly: the fraction of a light that a point sees, in f64.
//!
//! For a receiver, the triangles that may reach into the pyramid between it and
//! the light are gathered from a BVH; each takes its shadow, a convex polygon
//! in the light's plane, away from a list of convex fragments of the light
//! (`fragments.rs`); what is left is summed. There is no sampling noise, and
//! nothing is asked of the meshes: they may be open, overlap, or hold the same
//! triangle twice. It stops early when nothing is left.
//!
//! # Measures
//!
//! Visibility is the share of the light's *area* (not of its solid angle) that
//! can be joined to the receiver by a segment that crosses no caster. Both
//! faces of a flat light count. A sphere is replaced by the disc that is the
//! cross-section of its cone (as in docs/papers.md, paper IV), so the share is of that
//! disc, and what reaches into the sphere hides up to the disc's plane. A
//! receiver inside a spherical light sees all of it. A receiver in the plane of
//! a flat light is nothing special: the segments to it are well defined. Points
//! and directions are lights without extent: 0 or 1. A caster in the plane of the
//! light, such as the lamp's own mesh, is not in between and hides nothing.
//!
//! # Self-shadowing
//!
//! A receiver stands for the limit from the side that is seen ([`Receiver`]).
//! There, the triangle that it lies on hides exactly what is behind the facet's
//! plane, if its object casts: the light is clipped by that plane first and the
//! triangle is not asked again. A surface that casts nothing hides nothing, so
//! light from behind it counts. A receiver that faces away from the light is
//! thus at 0 on casters, and on others has the visibility of its place.
//!
//! # Rounding
//!
//! Different orders of the triangles change the sum by about 1e-15 per light
//! fragment; pieces below 1e-16 of the light are dropped. Classes use
//! [`CLASS_TOLERANCE`].

mod disc;
pub(crate) mod emitter;
mod form_factor;
mod fragments;
pub mod image;
mod occluder;

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};

use super::bvh::{Bvh, Ray, Region};
use super::surfaces::{Receiver, Surfaces};
use crate::geometry::coverage::ImageSums;
use crate::world::error::LightError;
use crate::world::light::{HardLight, LightShape};
use crate::world::scene::Scene;
use emitter::{Emitter, FlatLight};
use fragments::Fragments;
use occluder::{Shadow, pyramid, shadow_on};

#[cfg(test)]
mod tests;

pub use form_factor::FormFactor;
pub use image::{LightRegion, VisibilityImage};

/// Raised with every change of the values that this module finds, so that images
/// kept by [`super::cache`] are not taken for its own.
pub const ORACLE_VERSION: u32 = 1;

/// Visibility within this of 0 or 1 counts as umbra or lit.
pub const CLASS_TOLERANCE: f64 = 1e-9;

/// What a receiver sees of a light, and what it took to find out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visibility {
    /// Share of the light's area, 0..=1.
    pub share: f64,
    /// Triangles that were found near the pyramid to the light.
    pub triangles: u32,
    /// Most fragments of the light at a time.
    pub fragments: u32,
}

impl Visibility {
    fn simple(share: f64) -> Self {
        Self {
            share,
            triangles: 0,
            fragments: 0,
        }
    }
}

/// Buffers for [`AreaOracle::visibility_with`], to be reused.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    region: Region,
    fragments: Fragments,
}

/// The casters and one light of a scene; build once, query often.
#[derive(Clone, Debug)]
pub struct AreaOracle {
    emitter: Emitter,
    casters: Bvh,
    /// Surface index of each caster triangle.
    caster_surface: Vec<u32>,
}

impl AreaOracle {
    /// Prepares the casters of a scene for one light.
    ///
    /// # Errors
    /// The light should have an extent and has none.
    pub fn new(surfaces: &Surfaces, light: &LightShape) -> Result<Self, LightError> {
        let (caster_surface, triangles): (Vec<_>, Vec<_>) = surfaces.casters().unzip();
        Ok(Self {
            emitter: Emitter::new(light)?,
            casters: Bvh::new(&triangles),
            caster_surface,
        })
    }

    /// The same with any triangles as casters; their surface indices are their
    /// places in the list.
    ///
    /// # Errors
    /// As [`AreaOracle::new`].
    pub fn of_triangles(triangles: &[[DVec3; 3]], light: &LightShape) -> Result<Self, LightError> {
        Ok(Self {
            emitter: Emitter::new(light)?,
            casters: Bvh::new(triangles),
            caster_surface: (0..triangles.len() as u32).collect(),
        })
    }

    /// The oracle of a scene whose light has number `light`, with its surfaces.
    ///
    /// # Errors
    /// As [`AreaOracle::new`].
    ///
    /// # Panics
    /// There is no such light.
    pub fn of_scene(scene: &Scene, light: usize) -> Result<(Surfaces, Self), LightError> {
        let surfaces = Surfaces::new(scene);
        let oracle = Self::new(&surfaces, &scene.lights[light].shape)?;
        Ok((surfaces, oracle))
    }

    /// Share of the light that `receiver` sees.
    pub fn visibility(&self, receiver: &Receiver) -> f64 {
        self.visibility_with(receiver, &mut Workspace::default())
            .share
    }

    /// The same with buffers of the caller and with the effort it took.
    pub fn visibility_with(&self, receiver: &Receiver, work: &mut Workspace) -> Visibility {
        match self.emitter.seen_from(receiver.point) {
            Some(light) => self.of_flat(&light, receiver, work),
            None => Visibility::simple(self.of_hard(receiver)),
        }
    }

    /// Share of each colour of an image on a rectangle that `receiver` sees.
    pub fn colours_with(
        &self,
        image: &ImageSums,
        receiver: &Receiver,
        work: &mut Workspace,
    ) -> [f64; 3] {
        let Some(light) = self.emitter.seen_from(receiver.point) else {
            return [self.of_hard(receiver); 3];
        };
        self.cut(&light, receiver, work);
        // The image's coordinates go from -1 to 1 where the frame's go half as far.
        let place = |p: &[f64; 2]| DVec2::from(*p) * 2.0;
        let mut sum = [0.0; 3];
        for polygon in work.fragments.polygons() {
            let corners: Vec<DVec2> = polygon.iter().map(place).collect();
            let part = image.within(&corners);
            sum = [0, 1, 2].map(|c| sum[c] + part[c]);
        }
        sum.map(|v: f64| v.clamp(0.0, 1.0))
    }

    /// A light without extent, or a sphere with the receiver in it.
    fn of_hard(&self, receiver: &Receiver) -> f64 {
        let Emitter::Hard(light) = self.emitter else {
            return 1.0;
        };
        let towards = light.towards_from(receiver.point);
        let behind = |n: DVec3| receiver.caster.is_some() && n.dot(towards) <= 0.0;
        if receiver.normal.is_some_and(behind) {
            return 0.0;
        }
        let end = match light {
            HardLight::Point(_) => 1.0 - 1e-12, // short of the lamp's own mesh
            HardLight::Directional(_) => f64::INFINITY,
        };
        let blocked = self
            .casters
            .any(&Ray::new(receiver.point, towards), 0.0..end);
        f64::from(u8::from(!blocked))
    }

    fn of_flat(
        &self,
        light: &FlatLight<'_>,
        receiver: &Receiver,
        work: &mut Workspace,
    ) -> Visibility {
        let triangles = self.cut(light, receiver, work);
        let share = if work.fragments.is_empty() {
            0.0
        } else {
            (work.fragments.area() / light.area()).clamp(0.0, 1.0)
        };
        Visibility {
            share,
            triangles,
            fragments: work.fragments.most() as u32,
        }
    }

    /// Triangles near the pyramid from a point to the light, as places in the list of
    /// casters, in order; others hide nothing. `None` where no pyramid is seen: all may
    /// count.
    pub fn near(&self, point: DVec3, work: &mut Workspace) -> Option<Vec<u32>> {
        let light = self.emitter.seen_from(point)?;
        let frame = light.frame.relative_to(point);
        pyramid(&mut work.region, point, &frame, light.outline);
        let mut near = Vec::new();
        self.casters.gather(&work.region, |index, _| {
            near.push(index);
            ControlFlow::Continue(())
        });
        near.sort_unstable();
        Some(near)
    }

    /// Leaves the visible fragments in `work`; returns how many triangles were
    /// looked at.
    fn cut(&self, light: &FlatLight<'_>, receiver: &Receiver, work: &mut Workspace) -> u32 {
        let Workspace { region, fragments } = work;
        let p = receiver.point;
        let frame = light.frame.relative_to(p);
        fragments.reset(light.outline, light.emitting);
        if let (Some(normal), Some(_)) = (receiver.normal, receiver.caster) {
            fragments.keep(frame.trace(normal, 0.0));
        }
        let mut seen = 0;
        if fragments.is_empty() {
            return seen;
        }
        pyramid(region, p, &frame, light.outline);
        self.casters.gather(region, |index, corners| {
            if receiver.caster == Some(self.caster_surface[index as usize]) {
                return ControlFlow::Continue(());
            }
            seen += 1;
            match shadow_on(&frame, light.outline, p, corners) {
                Shadow::Nothing => {}
                Shadow::Everything => fragments.clear(),
                Shadow::Part { planes, count } => fragments.subtract(&planes[..count]),
            }
            if fragments.is_empty() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        seen
    }
}
