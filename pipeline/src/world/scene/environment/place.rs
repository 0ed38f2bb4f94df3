//! Fitted lights in a scene.
//!
//! A light that is infinitely far away has no area, and techniques want one. So
//! lights lie on a cube round the casters, of half side [`DISTANCE`] times the
//! radius of the casters' bounding box. From its centre each light is seen where
//! the map has it; from a point that is off by a radius, in a direction that
//! differs by up to 1/64, 0.9 degrees. The reference ([`crate::truth::oracle::environment`])
//! keeps the map at infinity, so this error is part of what is measured.
//!
//! What the lights leave becomes ambient light, without shadow: the residual's mean
//! radiance, and how it leans to one side (spherical harmonics up to order 1, which give
//! the irradiance E(n)/π = L0 + 2/3 L1·n of Ramamoorthi and Hanrahan 2001). Behind the
//! scene is the map.

use std::sync::Arc;

use glam::DVec3;

use crate::world::environment::cube::{axes, direction, luminance};
use crate::world::environment::fit::BARE;
use crate::world::environment::{
    AmbientForm, AreaFit, CubeMap, DISTANCE, Environment, EnvironmentError, Fit, LightPlace,
    PlacedEnvironment,
};
use crate::world::light::{Light, LightShape};
use crate::world::mesh::{narrow, widen};
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
    let light = |area: &AreaFit| light(cube, area, fit.place, centre, reach);
    scene.lights = fit.lights.iter().map(light).collect();
    scene.ambient = mean_radiance(cube, fit.residual_energy());
    scene.ambient_slope = match fit.ambient {
        AmbientForm::Even => [[0.0; 3]; 3],
        AmbientForm::Harmonic => slope(cube, &fit.residual),
    };
    scene.background = mean_radiance(cube, cube.total());
    scene.backdrop = Some(map.source.clone());
    scene.warnings.extend(map.warnings.iter().cloned());
    scene.warnings.extend(uncovered(map, &fit));
    let limited = limited(scene, &map.name);
    scene.warnings.extend(limited);
    scene.environment = Some(Arc::new(PlacedEnvironment {
        map: map.clone(),
        fit,
        centre,
        reach,
    }));
    Ok(())
}

fn light(cube: &CubeMap, area: &AreaFit, place: LightPlace, centre: DVec3, reach: f64) -> Light {
    let (middle, half) = rectangle(cube, area, place);
    let [_, right, down] = axes(area.face);
    let energy = cube.energy(area.energy);
    Light {
        shape: LightShape::Rectangle {
            centre: centre + direction(area.face, middle) * reach,
            edge_u: right * (2.0 * half[0] * reach),
            edge_v: down * (2.0 * half[1] * reach),
        },
        colour: energy.map(|e| (e / std::f64::consts::PI) as f32),
    }
}

/// Middle and half sides on the face.
fn rectangle(cube: &CubeMap, area: &AreaFit, place: LightPlace) -> ([f64; 2], [f64; 2]) {
    let [low, high] = [area.low, area.high].map(|k| k.map(|k| cube.edge(k)));
    let middle = [0, 1].map(|k| (low[k] + high[k]) * 0.5);
    let half = [0, 1].map(|k| (high[k] - low[k]) * 0.5);
    match place {
        LightPlace::Texels => (middle, half),
        LightPlace::Centroid => (area.moments.centroid, half),
        LightPlace::Moments => (area.moments.centroid, area.moments.half),
    }
}

/// What `residual` adds to ambient light per unit of a normal, for each colour:
/// 2/3 · 3/4π · ∑ energy · direction.
fn slope(cube: &CubeMap, residual: &[[u64; 3]]) -> [[f32; 3]; 3] {
    let side = cube.side();
    let middle = |k: usize| 0.5 * (cube.edge(k) + cube.edge(k + 1));
    let mut sums = [DVec3::ZERO; 3];
    for (i, units) in residual.iter().enumerate() {
        let at = [i % side, i / side % side].map(middle);
        let towards = direction(i / (side * side), at).normalize();
        let energy = cube.energy(*units);
        (0..3).for_each(|c| sums[c] += towards * energy[c]);
    }
    sums.map(|sum| narrow(sum / (2.0 * std::f64::consts::PI)))
}

/// Light cannot be negative: a slope steeper than the mean is as steep as the mean.
fn limited(scene: &mut Scene, name: &str) -> Option<SceneWarning> {
    let mut count = 0;
    for (slope, mean) in scene.ambient_slope.iter_mut().zip(scene.ambient) {
        let length = widen(*slope).length() as f32;
        if length > mean {
            *slope = slope.map(|v| v * (mean / length));
            count += 1;
        }
    }
    (count > 0).then(|| SceneWarning {
        code: "environment-ambient-limited",
        count,
        message: format!(
            "ambient light of environment map {name} comes from one side so much that order 1 would be negative on the other, in {count} colors; it is limited"
        ),
    })
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
                let centroid = (area.moments.centroid[k] + 1.0) * 16.0;
                assert!((texel - centroid).abs() < 1e-9, "{texel} {centroid}");
            }
        }
    }

    /// Corners of a light over its texels are where the map has the texels' corners; one
    /// by moments has those about the centroid.
    #[test]
    fn lights_are_as_wide_as_what_they_stand_for() {
        use crate::world::environment::cube::place_of;
        for place in [
            LightPlace::Texels,
            LightPlace::Centroid,
            LightPlace::Moments,
        ] {
            let scene = placed(FitSettings {
                place,
                ..FitSettings::default()
            });
            let environment = scene.environment.as_ref().unwrap();
            for (light, area) in scene.lights.iter().zip(&environment.fit.lights) {
                let LightShape::Rectangle {
                    centre,
                    edge_u,
                    edge_v,
                } = light.shape
                else {
                    panic!("a rectangle");
                };
                let texels = [0, 1].map(|k| (area.high[k] - area.low[k]) as f64 / 32.0);
                let wanted = match place {
                    LightPlace::Moments => area.moments.half,
                    _ => texels,
                };
                let middle = match place {
                    LightPlace::Texels => {
                        [0, 1].map(|k| (area.low[k] + area.high[k]) as f64 / 32.0 - 1.0)
                    }
                    _ => area.moments.centroid,
                };
                for [u, v] in [[-0.5, -0.5], [0.5, 0.25]] {
                    let corner = centre + edge_u * u + edge_v * v - environment.centre;
                    let [_, right, down] = axes(area.face);
                    let at = [right, down].map(|axis| axis.dot(corner) / environment.reach);
                    let expected = [0, 1].map(|k| middle[k] + 2.0 * wanted[k] * [u, v][k]);
                    let near = |k: usize| (at[k] - expected[k]).abs() < 1e-9;
                    assert!(near(0) && near(1), "{place:?}: {at:?} {expected:?}");
                }
                let (face, at) = place_of(centre - environment.centre);
                assert_eq!(face, area.face);
                assert!(
                    (0..2).all(|k| (at[k] - middle[k]).abs() < 1e-9),
                    "{place:?}"
                );
            }
        }
    }

    /// Of a bright upper half a surface that faces up sees all, one that faces sideways half,
    /// one that faces down nothing: order 1 is exact there.
    #[test]
    fn ambient_light_comes_from_where_the_residual_is() {
        let texels = (0..64 * 32).map(|i| {
            if i < 64 * 16 {
                [2.0, 1.0, 0.0]
            } else {
                [0.0; 3]
            }
        });
        let map =
            Environment::of_radiance("half", [64, 32], texels.collect(), MapSettings::default());
        let cube = map.unwrap().cube;
        let found = slope(&cube, cube.texels());
        for (c, bright) in [2.0, 1.0, 0.0].into_iter().enumerate() {
            let mean = f64::from(mean_radiance(&cube, cube.total())[c]);
            assert!((mean - 0.5 * bright).abs() < 1e-3, "{mean}");
            let off = widen(found[c]) - DVec3::Y * (0.5 * bright);
            assert!(off.length() < 5e-3, "{off}");
        }
        // What the paper has, and what is never negative.
        let even = placed(FitSettings {
            ambient: AmbientForm::Even,
            ..FitSettings::default()
        });
        assert_eq!(even.ambient_slope, [[0.0; 3]; 3]);
        let leaning = placed(FitSettings::default());
        assert_eq!(even.ambient, leaning.ambient);
        for (slope, mean) in leaning.ambient_slope.iter().zip(leaning.ambient) {
            let length = widen(*slope).length();
            assert!(length > 0.0 && length <= f64::from(mean) * (1.0 + 1e-6));
        }
    }

    #[test]
    fn what_no_light_covers_is_told() {
        let scene = placed(FitSettings {
            lights: 3,
            ..FitSettings::default()
        });
        let codes: Vec<_> = scene.warnings.iter().map(|w| w.code).collect();
        assert!(codes.contains(&"environment-uncovered"), "{codes:?}");
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
