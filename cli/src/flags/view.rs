//! Another eye and other lights.

use clap::Args;
use glam::DVec3;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::scene::View;

/// What takes the place of the scene's own.
#[derive(Debug, Args)]
#[command(next_help_heading = "Eye and lights")]
pub(crate) struct ViewArgs {
    /// Where the eye is, in the scene's units; a framed model is 2 large and stands on y = 0
    /// over the origin
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_negative_numbers = true)]
    eye: Option<DVec3>,
    /// What is in the middle of the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_negative_numbers = true)]
    target: Option<DVec3>,
    /// Vertical field of view, degrees
    #[arg(long, value_name = "DEGREES")]
    fov: Option<f64>,
    /// A light instead of the scene's; may be repeated: point:X,Y,Z, square:X,Y,Z,SIDE
    /// (horizontal), sphere:X,Y,Z,RADIUS, disc:X,Y,Z,NX,NY,NZ,RADIUS (its normal before its
    /// radius) or directional:X,Y,Z (towards it). :R,G,B behind it is its color
    #[arg(long = "light", value_name = "KIND:PLACE", value_parser = parse_written_light, conflicts_with = "env")]
    light: Vec<LightArg>,
}

/// A light, and how it was written.
#[derive(Clone, Debug)]
struct LightArg {
    text: String,
    light: Light,
}

impl ViewArgs {
    /// What was asked for.
    pub(crate) fn view(&self) -> View {
        View {
            eye: self.eye,
            target: self.target,
            fov_y_degrees: self.fov,
            lights: self.light.iter().map(|l| l.light.clone()).collect(),
        }
    }

    /// The flags as they were given, but for those of the eye and its target.
    pub(crate) fn words_without_eye(&self) -> Vec<String> {
        let fov = self.fov.map(|fov| format!("--fov={fov}"));
        let lights = self.light.iter().map(|l| format!("--light={}", l.text));
        fov.into_iter().chain(lights).collect()
    }
}

const POINT: &str = "expected three finite numbers, such as 0,1.5,4";

fn numbers(text: &str) -> Option<Vec<f64>> {
    let numbers = text.split(',').map(|n| n.trim().parse::<f64>().ok());
    let numbers = numbers.collect::<Option<Vec<_>>>()?;
    numbers.iter().all(|n| n.is_finite()).then_some(numbers)
}

fn parse_point(text: &str) -> Result<DVec3, String> {
    match numbers(text).as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err(POINT.to_owned()),
    }
}

const LIGHT: &str = "expected point:X,Y,Z, square:X,Y,Z,SIDE, sphere:X,Y,Z,RADIUS, \
    disc:X,Y,Z,NX,NY,NZ,RADIUS or directional:X,Y,Z, sizes above 0, directions with a length, \
    and perhaps :R,G,B of 0 or more";

fn parse_written_light(text: &str) -> Result<LightArg, String> {
    Ok(LightArg {
        text: text.to_owned(),
        light: parse_light(text)?,
    })
}

fn parse_light(text: &str) -> Result<Light, String> {
    light(text).ok_or_else(|| LIGHT.to_owned())
}

fn light(text: &str) -> Option<Light> {
    let mut parts = text.split(':');
    let kind = parts.next()?;
    let place = numbers(parts.next()?)?;
    let colour = match parts.next() {
        Some(color) => color_of(&numbers(color)?)?,
        None => [1.0; 3],
    };
    if parts.next().is_some() {
        return None;
    }
    let shape = shape(kind, &place)?;
    Some(Light { shape, colour })
}

fn color_of(rgb: &[f64]) -> Option<[f32; 3]> {
    let rgb: [f64; 3] = rgb.try_into().ok()?;
    let valid = |c: &f64| (0.0..=f64::from(f32::MAX)).contains(c);
    rgb.iter().all(valid).then(|| rgb.map(|c| c as f32))
}

fn shape(kind: &str, place: &[f64]) -> Option<LightShape> {
    let size = |size: f64| (size > 0.0).then_some(size);
    let direction = |d: DVec3| (d.length() > 0.0).then_some(d);
    let (centre, rest) = place.split_first_chunk::<3>()?;
    let centre = DVec3::from(*centre);
    Some(match (kind, rest) {
        ("point", []) => LightShape::Point { position: centre },
        ("square", [side]) => Light::horizontal_square(centre, size(*side)?).shape,
        ("sphere", [radius]) => LightShape::Sphere {
            centre,
            radius: size(*radius)?,
        },
        ("disc", [x, y, z, radius]) => {
            let normal = direction(DVec3::new(*x, *y, *z))?;
            LightShape::Disc {
                centre,
                normal: normal / normal.length(),
                radius: size(*radius)?,
            }
        }
        ("directional", []) => LightShape::Directional {
            towards: direction(centre)?,
        },
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_of_all_kinds_are_read() {
        let shape = |text: &str| parse_light(text).unwrap().shape;
        let position = DVec3::new(1.0, -2.5, 3.0);
        assert_eq!(shape("point:1,-2.5,3"), LightShape::Point { position });
        assert!(
            matches!(shape("square:0,4,0,0.5"), LightShape::Rectangle { edge_u, .. } if edge_u == DVec3::X * 0.5)
        );
        assert!(matches!(
            shape("sphere:0,4,0,0.5"),
            LightShape::Sphere { radius: 0.5, .. }
        ));
        assert!(
            matches!(shape("disc:0,4,0,0,-2,0,0.5"), LightShape::Disc { normal, .. } if normal == -DVec3::Y)
        );
        assert!(matches!(
            shape("directional:0,1,0"),
            LightShape::Directional { .. }
        ));
        let red = parse_light("point:1, 2, 3:1,0.5,0").unwrap();
        assert_eq!(red.colour, [1.0, 0.5, 0.0]);
    }

    #[test]
    fn what_is_no_light_is_refused_with_what_is() {
        for bad in [
            "",
            "point",
            "point:",
            "point:1,2",
            "point:1,2,3,4",
            "point:1,2,inf",
            "lamp:1,2,3",
            "square:1,2,3",
            "square:1,2,3,0",
            "sphere:1,2,3,-1",
            "directional:0,0,0",
            "disc:0,4,0,0,0,0,1",
            "point:1,2,3:1,1",
            "point:1,2,3:-1,0,0",
            "point:1,2,3:1,1,1:2",
        ] {
            assert!(
                parse_light(bad).unwrap_err().contains("square:X,Y,Z,SIDE"),
                "{bad}"
            );
        }
        for bad in ["1,2", "1,2,x", "1,2,3,4", "1,2,nan"] {
            assert!(parse_point(bad).unwrap_err().contains("0,1.5,4"), "{bad}");
        }
    }
}
