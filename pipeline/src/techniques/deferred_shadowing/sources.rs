//! Lights that cast shadow: regions of the environment, fitted lights, or the scene's.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;

use super::settings::{Decomposition, Extent, Settings};
use crate::world::environment::decomposition::{DecompositionSettings, Region, decompose};
use crate::world::environment::{CubeMap, PlacedEnvironment};
use crate::world::light::{HardLight, Light, LightShape};
use crate::world::memo::Memo;

/// A light that casts shadow.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    /// Its centre, or the direction towards it, of length 1.
    pub(super) at: HardLight,
    extent: SourceExtent,
    /// B, radiance times solid angle.
    pub(super) energy: [f64; 3],
    /// Along which a square's side would lie; zero where there is no such thing.
    pub(super) side: DVec3,
}

#[derive(Clone, Debug, PartialEq)]
enum SourceExtent {
    /// The same solid angle from everywhere.
    Angle(f64),
    Shape(LightShape),
}

impl Source {
    /// Of a light of the scene.
    pub(super) fn of_light(light: &Light) -> Self {
        let at = match light.hard() {
            HardLight::Directional(towards) => HardLight::Directional(towards.normalize_or_zero()),
            point => point,
        };
        let side = match &light.shape {
            LightShape::Rectangle { edge_u, .. } => edge_u.normalize_or_zero(),
            _ => DVec3::ZERO,
        };
        Self {
            at,
            extent: SourceExtent::Shape(light.shape.clone()),
            energy: light.colour.map(|c| f64::from(c) * PI),
            side,
        }
    }

    fn of_region(region: &Region, map: &CubeMap, extent: Extent) -> Self {
        let angle = match extent {
            Extent::Region => region.angle,
            Extent::Spread => region.spread,
        };
        Self {
            at: HardLight::Directional(region.towards),
            extent: SourceExtent::Angle(angle),
            energy: map.energy(region.energy),
            side: DVec3::ZERO,
        }
    }

    /// A fitted light where the map has it: infinitely far away.
    fn of_fit(light: &Light, placed: &PlacedEnvironment) -> Self {
        let own = Self::of_light(light);
        let towards = light.hard().towards_from(placed.centre).normalize_or_zero();
        Self {
            at: HardLight::Directional(towards),
            extent: SourceExtent::Angle(own.solid_angle(placed.centre)),
            ..own
        }
    }

    /// How large it is seen from a point, steradians.
    pub(super) fn solid_angle(&self, from: DVec3) -> f64 {
        let shape = match &self.extent {
            SourceExtent::Angle(angle) => return *angle,
            SourceExtent::Shape(shape) => shape,
        };
        let away = self.at.towards_from(from);
        let squared = away.length_squared();
        let flat = |area: DVec3| (area.dot(away) / (squared * squared.sqrt())).abs();
        let angle = match shape {
            LightShape::Point { .. } | LightShape::Directional { .. } => 0.0,
            LightShape::Rectangle { edge_u, edge_v, .. } => flat(edge_u.cross(*edge_v)),
            LightShape::Polygon(polygon) => flat(polygon.area_vector()),
            LightShape::Disc { normal, radius, .. } => flat(*normal * (PI * radius * radius)),
            LightShape::Sphere { radius, .. } => {
                let share = (1.0 - radius * radius / squared).max(0.0);
                2.0 * PI * (1.0 - share.sqrt())
            }
        };
        if angle.is_finite() { angle } else { 0.0 }
    }
}

/// Lights that stand for an environment, brightest first.
pub(super) fn of_environment(
    placed: &PlacedEnvironment,
    lights: &[Light],
    settings: &Settings,
) -> Vec<Source> {
    let cube = &placed.map.cube;
    match settings.decomposition {
        Decomposition::Fit => {
            let fitted = lights.iter().take(placed.fit.lights.len());
            fitted.map(|light| Source::of_fit(light, placed)).collect()
        }
        Decomposition::KolligKeller => {
            let how = DecompositionSettings {
                lights: settings.lights,
                seed: settings.seed,
            };
            let regions = regions(cube, &how);
            let source = |r: &Region| Source::of_region(r, cube, settings.extent);
            regions.iter().map(source).collect()
        }
    }
}

/// Maps are cut once, not for every frame.
static REGIONS: Memo<Vec<Region>> = Memo::new(1 << 20);

fn regions(cube: &CubeMap, how: &DecompositionSettings) -> Arc<Vec<Region>> {
    let mut hasher = map_hash(cube);
    hasher.update(&(how.lights as u64).to_le_bytes());
    hasher.update(&how.seed.to_le_bytes());
    let key = *hasher.finalize().as_bytes();
    let bytes = |regions: &Vec<Region>| regions.len() * size_of::<Region>();
    REGIONS.get(key, bytes, || decompose(cube, how))
}

/// Of everything that a map holds.
pub(super) fn map_hash(cube: &CubeMap) -> blake3::Hasher {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&(cube.side() as u64).to_le_bytes());
    hasher.update(&cube.energy([1, 1, 1])[0].to_bits().to_le_bytes());
    let bytes: Vec<u8> = cube
        .texels()
        .iter()
        .flatten()
        .flat_map(|e| e.to_le_bytes())
        .collect();
    hasher.update(&bytes);
    hasher
}
