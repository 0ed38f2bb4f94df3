//! Parameters of techniques, given as `key=value`.

use super::{Technique, TechniqueError};

/// A parameter of a technique.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParamInfo {
    /// Name on the command line.
    pub name: &'static str,
    /// Value where none is given.
    pub default: &'static str,
    /// Values it takes, separated by `|`; `N` stands for any whole number from 0,
    /// `N+N` for several, `X` for any decimal number from 0, `TECHNIQUE` for a technique's name and
    /// settings, which it judges itself.
    pub valid: &'static str,
    /// One line for people.
    pub summary: &'static str,
}

impl ParamInfo {
    fn takes(&self, value: &str) -> bool {
        let is_number = || !value.is_empty() && value.parse::<u32>().is_ok();
        let is_decimal = || {
            value
                .parse::<f64>()
                .is_ok_and(|x| x.is_finite() && x >= 0.0)
        };
        self.valid.split('|').any(|v| match v {
            "N" => is_number(),
            "X" => is_decimal(),
            "N+N" => value.split('+').all(|n| n.parse::<u32>().is_ok()),
            "TECHNIQUE" => !value.is_empty(),
            word => word == value,
        })
    }
}

/// Checked values of all parameters of a technique.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Params {
    values: Vec<(&'static str, String)>,
}

impl Params {
    /// Every parameter at its default.
    pub fn defaults(technique: &dyn Technique) -> Self {
        let default = |p: &ParamInfo| (p.name, p.default.to_owned());
        Self {
            values: technique.params().iter().map(default).collect(),
        }
    }

    /// Defaults, changed by assignments `key=value`; the last one of a key counts.
    ///
    /// # Errors
    /// No such parameter, or not a value of it: the error names what is valid.
    pub fn parse<I>(technique: &dyn Technique, assignments: I) -> Result<Self, TechniqueError>
    where
        I: IntoIterator,
        I::Item: AsRef<str>,
    {
        let mut params = Self::defaults(technique);
        for assignment in assignments {
            let given = assignment.as_ref();
            let Some((key, value)) = given.split_once('=') else {
                return Err(TechniqueError::NotAnAssignment {
                    given: given.to_owned(),
                });
            };
            params.set(technique, key.trim(), value.trim())?;
        }
        Ok(params)
    }

    fn set(
        &mut self,
        technique: &dyn Technique,
        key: &str,
        value: &str,
    ) -> Result<(), TechniqueError> {
        let known = technique.params();
        let Some(at) = known.iter().position(|p| p.name == key) else {
            let names: Vec<&'static str> = known.iter().map(|p| p.name).collect();
            return Err(TechniqueError::UnknownParameter {
                technique: technique.name(),
                key: key.to_owned(),
                nearest: crate::world::error::nearest(key, &names),
                known: names,
            });
        };
        if !known[at].takes(value) {
            return Err(TechniqueError::BadValue {
                technique: technique.name(),
                key: known[at].name,
                value: value.to_owned(),
                valid: known[at].valid,
            });
        }
        self.values[at].1 = value.to_owned();
        Ok(())
    }

    /// Value of parameter `name`; empty for one that the technique does not have.
    pub fn get(&self, name: &str) -> &str {
        self.values
            .iter()
            .find(|(n, _)| *n == name)
            .map_or("", |(_, v)| v)
    }

    /// Names and values, in the technique's order.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.values.iter().map(|(n, v)| (*n, v.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques::find;

    fn parse(assignments: &[&str]) -> Result<Params, String> {
        Params::parse(find("shadow-volumes").unwrap(), assignments).map_err(|e| e.to_string())
    }

    #[test]
    fn assignments_change_defaults() {
        let params = parse(&["method=zpass", "light = 3", "method=zfail"]).unwrap();
        assert_eq!((params.get("method"), params.get("light")), ("zfail", "3"));
        assert_eq!(
            (params.get("open-casters"), params.get("nonsense")),
            ("refuse", "")
        );
    }

    #[test]
    fn errors_say_what_is_valid() {
        let message = |a: &str| parse(&[a]).unwrap_err();
        assert!(message("method=zz").contains("auto|zpass|zfail"));
        assert!(message("light=-1").contains("all|N"));
        assert!(message("methd=auto").contains("did you mean 'method'"));
        assert!(message("zfail").contains("key=value"));
    }
}
