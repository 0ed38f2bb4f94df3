//! What is varied, and over which values.

use thiserror::Error;

/// What an axis does to a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Other units: everything is scaled about the origin.
    Scale,
    /// Away from the origin, in distances from the eye to what it looks at.
    Offset,
    /// Edges of casters are cut at an ever smaller share: slivers, at last without area.
    Slivers,
    /// Edges of casters in ever more pieces.
    Pieces,
    /// A near plane ever closer to the eye, in a depth buffer of 24 bits.
    Near,
    /// The same, of 32 bits.
    NearFloat,
    /// A light of another size about its centre.
    LightSize,
    /// A light ever closer to the level of the casters' centre, at its distance from there.
    LightDown,
    /// A light ever closer to the casters' centre, and in it.
    LightNear,
    /// An eye ever closer to what it looks at.
    EyeNear,
    /// An eye that goes into the shadow.
    EyeShadow,
}

/// How values lie along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By decades.
    Log10,
}

/// A thing that is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it does.
    pub kind: Kind,
    /// Its name on the command line.
    pub name: &'static str,
    /// What its values are, with their unit.
    pub label: &'static str,
    /// How values are laid out.
    pub scale: Scale,
    /// Values, ascending.
    pub values: Vec<f64>,
    /// The value of the scene as it is, or nearest to it; it is one of the values.
    pub rest: f64,
}

/// An axis that there is not.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("nothing to vary is called '{0}'; valid are: {names}", names = Axis::names().join(", "))]
pub struct UnknownAxis(pub String);

impl Axis {
    /// All of them.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let log = |kind, name, label, values, rest| Self {
            kind,
            name,
            label,
            scale: Scale::Log10,
            values,
            rest,
        };
        let smaller = "times smaller than in the scene";
        vec![
            log(
                Kind::Scale,
                "scale",
                "units of the scene",
                decades(-15..=16),
                1.0,
            ),
            log(
                Kind::Offset,
                "offset",
                "distance from the origin, in distances that the eye looks",
                decades(-1..=7),
                0.1,
            ),
            log(
                Kind::Slivers,
                "slivers",
                "lengths of an edge over that of its shorter piece",
                [&[2.0][..], &decades(1..=8)].concat(),
                2.0,
            ),
            log(
                Kind::Pieces,
                "pieces",
                "pieces of an edge",
                vec![1.0, 2.0, 4.0, 8.0, 16.0],
                1.0,
            ),
            log(Kind::Near, "near", NEAR, decades(0..=7), 1.0),
            log(Kind::NearFloat, "near-d32f", NEAR, decades(0..=7), 1.0),
            log(
                Kind::LightSize,
                "light-size",
                "size of the light over that in the scene",
                decades(-6..=1),
                1.0,
            ),
            log(
                Kind::LightDown,
                "light-down",
                "height of the light over the casters' centre, times lower",
                one_two_five(4),
                1.0,
            ),
            log(
                Kind::LightNear,
                "light-near",
                "distance of the light from the casters' centre, times smaller",
                one_two_five(4),
                1.0,
            ),
            log(Kind::EyeNear, "eye-near", smaller, one_two_five(4), 1.0),
            Self {
                kind: Kind::EyeShadow,
                name: "eye-shadow",
                label: "share of the way of the eye into the shadow",
                scale: Scale::Linear,
                values: (0..=8).map(|k| f64::from(k) / 8.0).collect(),
                rest: 0.0,
            },
        ]
    }

    /// The axis called `name`.
    ///
    /// # Errors
    /// There is none; the error lists all.
    pub fn find(name: &str) -> Result<Self, UnknownAxis> {
        let found = Self::all().into_iter().find(|a| a.name == name);
        found.ok_or_else(|| UnknownAxis(name.to_owned()))
    }

    /// Names of all.
    #[must_use]
    pub fn names() -> Vec<&'static str> {
        Self::all().iter().map(|a| a.name).collect()
    }

    /// Leaves out the values that `keep` does not want; that at rest stays.
    pub fn keep(&mut self, keep: impl Fn(f64) -> bool) {
        let rest = self.rest;
        self.values.retain(|v| *v == rest || keep(*v));
    }

    /// The setting that techniques draw with along this axis, where they have it.
    #[must_use]
    pub fn setting(&self) -> Option<(&'static str, &'static str)> {
        match self.kind {
            Kind::Near => Some(("depth-format", "d24")),
            Kind::NearFloat => Some(("depth-format", "d32f")),
            _ => None,
        }
    }
}

const NEAR: &str = "distance of the near plane, times smaller than in the scene";

/// Powers of ten.
fn decades(exponents: std::ops::RangeInclusive<i32>) -> Vec<f64> {
    exponents.map(|e| libm::pow(10.0, f64::from(e))).collect()
}

/// 1, 2, 5, 10 and on, over so many decades.
fn one_two_five(decades: i32) -> Vec<f64> {
    let steps = (0..decades).flat_map(|d| {
        let decade = libm::pow(10.0, f64::from(d));
        [1.0, 2.0, 5.0].map(|k| k * decade)
    });
    steps.chain([libm::pow(10.0, f64::from(decades))]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_ascend_from_or_around_rest() {
        for axis in Axis::all() {
            assert!(axis.values.is_sorted_by(|a, b| a < b), "{}", axis.name);
            assert!(axis.values.contains(&axis.rest), "{}", axis.name);
            assert_eq!(Axis::find(axis.name).as_ref(), Ok(&axis));
            let log = axis.scale == Scale::Log10;
            assert!(!log || axis.values[0] > 0.0, "{}", axis.name);
        }
    }

    #[test]
    fn errors_list_all() {
        let error = Axis::find("size").unwrap_err().to_string();
        assert!(
            error.contains("'size'") && error.contains("light-size, light-down"),
            "{error}"
        );
    }

    #[test]
    fn rest_is_kept() {
        let mut axis = Axis::find("scale").unwrap();
        axis.keep(|v| v > 1e10);
        assert_eq!(axis.values[0], 1.0);
        assert_eq!(axis.values.len(), 1 + 6);
    }
}
