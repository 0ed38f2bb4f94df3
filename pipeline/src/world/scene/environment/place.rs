//! Fitted lights in a scene.
//!
//! A light that is infinitely far away has no area, and techniques want one. So
//! lights lie on a cube round the casters, of half side [`DISTANCE`] times the
//! radius of the casters' bounding box. From its centre each light is seen where
//! the map has it; from a point that is off by a radius, in a direction that
//! differs by up to 1/64, 0.9 degrees. The reference ([`crate::truth::oracle::environment`])
//! keeps the map at infinity, so this error is part of what is measured.
//!
//! What the lights leave becomes ambient light, of the residual's mean radiance;
//! it takes no shadow and has no direction. The background is the mean radiance
//! of the map.

use std::sync::Arc;

use glam::DVec3;

use crate::world::environment::cube::{axes, direction, luminance};
use crate::world::environment::fit::BARE;
use crate::world::environment::{
    AreaFit, CubeMap, DISTANCE, Environment, EnvironmentError, Fit, PlacedEnvironment,
};
use crate::world::light::{Light, LightShape};
use crate::world::scene::{Scene, SceneWarning};

/// Lights `scene` by `map` alone: replaces lights, ambient light and background.
///
/// # Errors
/// The scene has no casters.
pub fn place(scene: &mut Scene, map: &Environment, fit: Fit) -> Result<(), EnvironmentError> {
    let bounds = scene.casters().filter_map(|o| o.mesh.bounds());
    let bounds = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (low, high) = bounds.ok_or(EnvironmentError::NoCasters)?;
    let (centre, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
    let reach = DISTANCE * if radius > 0.0 { radius } else { 1.0 };
    let cube = &map.cube;
    let light = |area: &AreaFit| light(cube, area, centre, reach);
    scene.lights = fit.lights.iter().map(light).collect();
    scene.ambient = mean_radiance(cube, fit.residual_energy());
    scene.background = mean_radiance(cube, cube.total());
    scene.warnings.extend(map.warnings.iter().cloned());
    scene.warnings.extend(uncovered(map, &fit));
    scene.environment = Some(Arc::new(PlacedEnvironment {
        map: map.clone(),
        fit,
        centre,
        reach,
    }));
    Ok(())
}

fn light(cube: &CubeMap, area: &AreaFit, centre: DVec3, reach: f64) -> Light {
    let [low, high] = [area.low, area.high].map(|k| k.map(|k| cube.edge(k)));
    let middle = [0, 1].map(|k| (low[k] + high[k]) * 0.5);
    let [_, right, down] = axes(area.face);
    let energy = cube.energy(area.energy);
    Light {
        shape: LightShape::Rectangle {
            centre: centre + direction(area.face, middle) * reach,
            edge_u: right * ((high[0] - low[0]) * reach),
            edge_v: down * ((high[1] - low[1]) * reach),
        },
        colour: energy.map(|e| (e / std::f64::consts::PI) as f32),
    }
}

/// Energy spread evenly over all directions.
fn mean_radiance(cube: &CubeMap, units: [u64; 3]) -> [f32; 3] {
    let whole = 4.0 * std::f64::consts::PI;
    cube.energy(units).map(|e| (e / whole) as f32)
}

fn uncovered(map: &Environment, fit: &Fit) -> Option<SceneWarning> {
    let share = luminance(fit.residual_energy()) as f64 / luminance(map.cube.total()) as f64;
    (fit.bare_share(&map.cube) > BARE).then(|| SceneWarning {
        code: "environment-uncovered",
        count: fit.uncovered,
        message: format!(
            "{} texels of environment map {} are in no light; {:.1}% of its energy is ambient light, ask for more lights",
            fit.uncovered,
            map.name,
            100.0 * share
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::environment::{FitSettings, MapSettings, SKY};
    use crate::world::light::HardLight;
    use crate::world::scene::builtin;

    fn placed(settings: FitSettings) -> Scene {
        let map = Environment::open(
            SKY,
            MapSettings {
                side: 32,
                ..MapSettings::default()
            },
        );
        let map = map.unwrap();
        let mut scene = builtin::build("creature").unwrap();
        let fit = map.fit(&settings).unwrap();
        place(&mut scene, &map, fit).unwrap();
        scene
    }

    #[test]
    fn lights_carry_the_energy_of_the_map() {
        let scene = placed(FitSettings::default());
        let environment = scene.environment.as_ref().unwrap();
        let cube = &environment.map.cube;
        let total = cube.energy(cube.total());
        for c in 0..3 {
            let lights: f64 = scene.lights.iter().map(|l| f64::from(l.colour[c])).sum();
            let ambient = 4.0 * f64::from(scene.ambient[c]); // of the whole sphere, over π
            let sum = (lights + ambient) * std::f64::consts::PI;
            assert!((sum / total[c] - 1.0).abs() < 1e-5, "{sum} {total:?}");
        }
    }

    /// Seen from the middle they are as wide and as high as their texels.
    #[test]
    fn lights_end_where_their_texels_do() {
        let scene = placed(FitSettings::default());
        let environment = scene.environment.as_ref().unwrap();
        for (light, area) in scene.lights.iter().zip(&environment.fit.lights) {
            let LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            } = light.shape
            else {
                panic!("{light:?}");
            };
            let [_, right, down] = axes(area.face);
            for (side, ends) in [(-0.5, area.low), (0.5, area.high)] {
                let corner = centre + (edge_u + edge_v) * side - environment.centre;
                for (axis, texel) in [(right, ends[0]), (down, ends[1])] {
                    let at = (corner.dot(axis) / environment.reach + 1.0) * 16.0;
                    assert!((at - texel as f64).abs() < 1e-6, "{at} {texel}");
                }
            }
        }
    }

    #[test]
    fn lights_lie_round_the_casters_where_the_map_has_them() {
        let scene = placed(FitSettings::default());
        let environment = scene.environment.as_ref().unwrap();
        for (light, area) in scene.lights.iter().zip(&environment.fit.lights) {
            let HardLight::Point(p) = light.hard() else {
                panic!("a rectangle has a centre");
            };
            let (face, at) = crate::world::environment::cube::place_of(p - environment.centre);
            assert_eq!(face, area.face);
            for k in 0..2 {
                let texel = (at[k] + 1.0) * 16.0;
                assert!(texel > area.low[k] as f64 && texel < area.high[k] as f64);
            }
        }
    }

    #[test]
    fn what_no_light_covers_is_told() {
        let scene = placed(FitSettings {
            lights: 3,
            ..FitSettings::default()
        });
        let codes: Vec<_> = scene.warnings.iter().map(|w| w.code).collect();
        assert_eq!(codes, ["environment-uncovered"]);
        assert!(scene.ambient[0] > 0.05);
        let mut bare = scene.clone();
        bare.objects.iter_mut().for_each(|o| o.casts = false);
        let map = Environment::open(SKY, MapSettings::default()).unwrap();
        let fit = map.fit(&FitSettings::default()).unwrap();
        assert_eq!(
            place(&mut bare, &map, fit),
            Err(EnvironmentError::NoCasters)
        );
    }
}
