//! Lights: of `KHR_lights_punctual`, and areas of `EXT_lights_area`.
//!
//! Lights here shine everywhere alike, and those of glTF weaken with distance. Each is
//! given the illuminance that it has at the middle of the model, and all are scaled so that
//! the brightest has 1 in its strongest colour.

use glam::{DMat4, DVec3};

use super::LARGEST;
use super::error::{Checked, GltfProblem, element};
use super::nodes::Placed;
use super::notes::Notes;
use super::schema::{AreaLight, PunctualLight, Root};
use crate::world::light::{Light, LightShape};

/// Candela per square metre of an area light that says nothing.
const NITS: f64 = 1000.0;

/// Of the model's extent: lights that are nearer to its middle shine as from there.
const NEAREST: f64 = 0.01;

/// Of a model without extent the same; no finite candela is infinite lux from there.
const LEAST: f64 = 1e-100;

/// A light before its brightness is known.
pub(super) struct Source {
    shape: LightShape,
    color: [f64; 3],
    /// Candela of what weakens with distance, lux of what does not.
    intensity: f64,
}

/// The lights at a node.
pub(super) fn at(root: &Root, placed: &Placed<'_>, notes: &mut Notes) -> Checked<Vec<Source>> {
    let place = format!("nodes[{}]", placed.number);
    let mut sources = Vec::new();
    let own = &placed.node.extensions;
    if let Some(light) = &own.punctual {
        let all = &root.extensions.punctual.lights;
        let own = element(all, light.light, "punctual lights", &place)?;
        let place = format!("KHR_lights_punctual.lights[{}]", light.light);
        sources.push(punctual(own, placed.model_from_node, notes, &place)?);
    }
    if let Some(light) = &own.area {
        let all = &root.extensions.area.lights;
        let own = element(all, light.light, "area lights", &place)?;
        let place = format!("EXT_lights_area.lights[{}]", light.light);
        sources.push(area(own, placed.model_from_node, notes, &place)?);
    }
    Ok(sources)
}

fn punctual(
    light: &PunctualLight,
    model_from_node: DMat4,
    notes: &mut Notes,
    place: &str,
) -> Checked<Source> {
    let shape = match light.kind.as_str() {
        "directional" => LightShape::Directional {
            towards: unit(model_from_node.transform_vector3(DVec3::Z), place)?,
        },
        "point" | "spot" => LightShape::Point {
            position: bounded(
                "its place",
                model_from_node.transform_point3(DVec3::ZERO),
                place,
            )?,
        },
        other => return Err(bad_kind(other, "directional, point or spot").at(place)),
    };
    if light.kind == "spot" {
        notes.spots.add(|| place.to_owned());
    }
    if light.kind != "directional" {
        notes.falloff.add(|| place.to_owned());
    }
    source(shape, light.color, light.intensity.unwrap_or(1.0), place)
}

fn area(
    light: &AreaLight,
    model_from_node: DMat4,
    notes: &mut Notes,
    place: &str,
) -> Checked<Source> {
    notes.falloff.add(|| place.to_owned());
    let centre = bounded(
        "its place",
        model_from_node.transform_point3(DVec3::ZERO),
        place,
    )?;
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|a| model_from_node.transform_vector3(a));
    // The extension's rule: one scale, the largest.
    let scale = axes.map(DVec3::length).into_iter().fold(0.0, f64::max);
    let size = positive("size", light.size.unwrap_or(1.0), place)? * scale;
    let size = positive("size where its node puts it", size, place)?;
    let (shape, area) = match light.kind.as_str() {
        "rect" => {
            let aspect = positive("rect.aspect", light.rect.aspect.unwrap_or(1.0), place)?;
            let edge = |axis, length| bounded("an edge", unit(axis, place)? * length, place);
            let edge_u = edge(axes[0], size * aspect)?;
            let edge_v = edge(axes[1], size)?;
            let shape = LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            };
            (shape, size * size * aspect)
        }
        "disk" => {
            let radius = size / 2.0;
            let normal = unit(axes[2], place)?;
            let shape = LightShape::Disc {
                centre,
                normal,
                radius,
            };
            (shape, std::f64::consts::PI * radius * radius)
        }
        other => return Err(bad_kind(other, "rect or disk").at(place)),
    };
    let nits = light.intensity.unwrap_or(NITS);
    source(shape, light.color, nits * area, place)
}

fn source(
    shape: LightShape,
    color: Option<[f64; 3]>,
    intensity: f64,
    place: &str,
) -> Checked<Source> {
    let color = color.unwrap_or([1.0; 3]);
    let valid = |v: f64| (0.0..=f64::from(f32::MAX)).contains(&v);
    if !color.into_iter().all(valid) || !valid(intensity) {
        let (what, value) = ("color or intensity", format!("{color:?}, {intensity}"));
        let valid = "numbers from 0 to 3.4e38";
        return Err(GltfProblem::Bad { what, value, valid }.at(place));
    }
    Ok(Source {
        shape,
        color,
        intensity,
    })
}

fn bad_kind(kind: &str, valid: &'static str) -> GltfProblem {
    GltfProblem::Bad {
        what: "type",
        value: format!("'{}'", crate::world::tally::beginning(kind, 20)),
        valid,
    }
}

fn positive(what: &'static str, value: f64, place: &str) -> Checked<f64> {
    if value > 0.0 && value <= LARGEST {
        return Ok(value);
    }
    let (value, valid) = (value.to_string(), "a number above 0 and up to 3.4e38");
    Err(GltfProblem::Bad { what, value, valid }.at(place))
}

/// A vector whose coordinates are those that positions may have.
fn bounded(what: &'static str, vector: DVec3, place: &str) -> Checked<DVec3> {
    if vector.abs().max_element() <= LARGEST && vector.is_finite() {
        return Ok(vector);
    }
    let (value, valid) = (vector.to_string(), "numbers below 3.4e38");
    Err(GltfProblem::Bad { what, value, valid }.at(place))
}

fn unit(axis: DVec3, place: &str) -> Checked<DVec3> {
    let length = axis.length();
    let unit = axis / length;
    // By an infinite length everything is 0.
    if length.is_finite() && unit.is_finite() {
        return Ok(unit);
    }
    let (what, value) = ("an axis of its node", format!("{axis}"));
    let valid = "any with a length that is not 0 and finite";
    Err(GltfProblem::Bad { what, value, valid }.at(place))
}

/// How far a light at `at` is from the middle of a model with those bounds, as its
/// brightness there is reckoned.
pub(crate) fn distance(at: DVec3, (low, high): (DVec3, DVec3)) -> f64 {
    let middle = (low + high) / 2.0;
    let nearest = (high - low).max_element() * NEAREST;
    (at - middle).length().max(nearest).max(LEAST)
}

/// The lights as they shine on the middle of a model with those bounds.
pub(super) fn lit(sources: Vec<Source>, bounds: (DVec3, DVec3)) -> Vec<Light> {
    let illuminance = |source: &Source| {
        let at = match &source.shape {
            LightShape::Point { position: at }
            | LightShape::Rectangle { centre: at, .. }
            | LightShape::Disc { centre: at, .. } => *at,
            _ => return source.intensity,
        };
        let distance = distance(at, bounds);
        source.intensity / distance / distance
    };
    let strongest = |s: &Source| s.color.into_iter().fold(0.0, f64::max);
    let each: Vec<f64> = sources.iter().map(illuminance).collect();
    let brightest = (sources.iter().zip(&each)).map(|(s, e)| e * strongest(s));
    let brightest = brightest.fold(0.0, f64::max);
    // Of what is black it may be anything, but finite.
    let finite = |e: f64| (e / brightest).min(f64::MAX);
    let share = |e: f64| if brightest > 0.0 { finite(e) } else { 0.0 };
    let light = |(source, e): (Source, f64)| Light {
        shape: source.shape,
        colour: source.color.map(|c| (c * share(e)) as f32),
    };
    sources.into_iter().zip(each).map(light).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_have_what_they_have_at_the_middle_of_the_model() {
        let point = |x: f64, intensity, color| Source {
            shape: LightShape::Point {
                position: DVec3::X * x,
            },
            color,
            intensity,
        };
        let sun = Source {
            shape: LightShape::Directional { towards: DVec3::Y },
            color: [0.5, 1.0, 0.25],
            intensity: 1.0,
        };
        // 8 / 2² = 2 lux of red beside a sun of 1.
        let sources = vec![point(2.0, 8.0, [1.0, 0.0, 0.0]), sun];
        let lights = lit(sources, (DVec3::splat(-1.0), DVec3::splat(1.0)));
        assert_eq!(lights[0].colour, [1.0, 0.0, 0.0]);
        assert_eq!(lights[1].colour, [0.25, 0.5, 0.125]);
        let dark = lit(vec![point(0.0, 0.0, [1.0; 3])], (DVec3::ZERO, DVec3::ZERO));
        assert_eq!(dark[0].colour, [0.0; 3]);
    }

    /// However near, dark or strong lights are, their colours are numbers, up to 1.
    #[test]
    fn colours_are_never_without_a_number() {
        let most = f64::from(f32::MAX);
        for (x, intensity, color, other) in [
            (1e-200, most, most, 1.0),
            (0.0, most, most, 1e-300),
            (0.0, most, 0.0, 1e-300),
            (0.0, most, 1e-320, 1e-300),
            (1e38, 1e-300, 1e-20, most),
        ] {
            let point = |x: f64, intensity, color| Source {
                shape: LightShape::Point {
                    position: DVec3::X * x,
                },
                color: [color, 0.0, 0.0],
                intensity,
            };
            let sources = vec![point(x, intensity, color), point(1.0, other, 1.0)];
            for light in lit(sources, (DVec3::ZERO, DVec3::ZERO)) {
                let valid = |c: &f32| (0.0..=1.0).contains(c);
                assert!(light.colour.iter().all(valid), "{x}: {:?}", light.colour);
            }
        }
    }

    #[test]
    fn axes_have_a_finite_length() {
        assert_eq!(unit(DVec3::Y * 1e100, "").unwrap(), DVec3::Y);
        for length in [0.0, 1e200, f64::INFINITY, f64::NAN] {
            let problem = unit(DVec3::Y * length, "").unwrap_err().problem;
            assert!(problem.to_string().contains("an axis"), "{problem}");
        }
    }
}
