//! The values of a technique's parameters, given as `key=value`.

use super::domain::Domain;
use super::param::{Param, ParamInfo, Setting};
use super::{Technique, TechniqueError, Warning};
use crate::world::light_image::LightSequence;
use crate::world::scene::Scene;

/// Checked values of all parameters of a technique.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    technique: &'static str,
    values: Vec<ParamValue>,
}

#[derive(Clone, Debug, PartialEq)]
struct ParamValue {
    info: ParamInfo,
    text: String,
    /// Asked for, be it the default.
    given: bool,
    /// Of [`Domain::Images`], what the files hold.
    images: Option<LightSequence>,
}

impl Params {
    /// Every parameter at its default.
    pub fn defaults(technique: &dyn Technique) -> Self {
        let default = |info: &ParamInfo| ParamValue {
            info: *info,
            text: info.default.to_string(),
            given: false,
            images: None,
        };
        Self {
            technique: technique.name(),
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
            params.set(key.trim(), value.trim())?;
        }
        Ok(params)
    }

    /// Name of the technique whose parameters these are.
    pub fn technique(&self) -> &'static str {
        self.technique
    }

    fn set(&mut self, key: &str, text: &str) -> Result<(), TechniqueError> {
        let technique = self.technique;
        let Some(value) = self.values.iter_mut().find(|v| v.info.name == key) else {
            return Err(self.unknown(key));
        };
        if !value.info.domain.takes(text) {
            return Err(bad_value(technique, &value.info, text));
        }
        value.images = read_images(technique, &value.info, text)?;
        value.text = text.to_owned();
        value.given = true;
        Ok(())
    }

    /// Another technique's value of a parameter that both have, where nothing else was
    /// asked for; what is not one of its values here is left.
    pub(crate) fn hand_down(&mut self, key: &str, text: &str) {
        let value = self.values.iter_mut().find(|v| v.info.name == key);
        if let Some(value) = value.filter(|v| !v.given && v.info.domain.takes(text)) {
            value.text = text.to_owned();
        }
    }

    fn unknown(&self, key: &str) -> TechniqueError {
        let names: Vec<&'static str> = self.values.iter().map(|v| v.info.name).collect();
        TechniqueError::UnknownParameter {
            technique: self.technique,
            key: key.to_owned(),
            nearest: crate::world::error::nearest(key, &names),
            known: names,
        }
    }

    fn find(&self, name: &str) -> Option<&ParamValue> {
        self.values.iter().find(|v| v.info.name == name)
    }

    /// Value of a parameter.
    ///
    /// # Errors
    /// The technique does not list the parameter, or its domain takes what its type
    /// does not: both are faults of the technique.
    pub fn get<T: Setting>(&self, param: &Param<T>) -> Result<T, TechniqueError> {
        let name = param.info.name;
        let value = self.find(name).ok_or_else(|| self.unknown(name))?;
        T::read(&value.text).ok_or_else(|| bad_value(self.technique, &value.info, &value.text))
    }

    /// The images of files that a parameter names; `None` where it has one of its words.
    ///
    /// # Errors
    /// The technique does not list the parameter.
    pub fn images(
        &self,
        param: &Param<LightSequence>,
    ) -> Result<Option<&LightSequence>, TechniqueError> {
        let name = param.info.name;
        let value = self.find(name).ok_or_else(|| self.unknown(name))?;
        Ok(value.images.as_ref())
    }

    /// The same, so many images later: [`LIGHT_FRAME`] is that much more, where there is
    /// such a parameter.
    #[must_use]
    pub fn with_later_image(&self, by: f64) -> Self {
        let mut later = self.clone();
        let value = later.values.iter_mut().find(|v| v.info.name == LIGHT_FRAME);
        if let Some(value) = value
            && let Ok(now) = value.text.parse::<f64>()
        {
            value.text = (now + by).to_string();
        }
        later
    }

    /// Whether a parameter was asked for, be it with its default.
    pub fn is_given(&self, name: &str) -> bool {
        self.find(name).is_some_and(|v| v.given)
    }

    /// Value of the parameter called `name` as text; `None` where there is none.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.find(name).map(|v| v.text.as_str())
    }

    /// Whether the parameter called `name` has a value that means `text`.
    pub(super) fn has_value(&self, name: &str, text: &str) -> bool {
        self.find(name)
            .is_some_and(|v| v.info.domain.same(&v.text, text))
    }

    /// Names and values, in the technique's order.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.values.iter().map(|v| (v.info.name, v.text.as_str()))
    }

    /// A warning for each setting that was asked for and changes nothing in `scene`
    /// together with the others.
    pub fn without_effect(&self, scene: &Scene) -> Vec<Warning> {
        let given = self.values.iter().filter(|v| v.given);
        given
            .filter(|v| !v.info.applies.holds(self, scene))
            .map(|v| self.warning(v, &format!("it applies when {}", v.info.applies)))
            .collect()
    }

    /// The warning that a parameter was asked for in vain, if it was asked for.
    pub(crate) fn in_vain(&self, name: &str, why: &str) -> Option<Warning> {
        let value = self.find(name).filter(|v| v.given)?;
        Some(self.warning(value, why))
    }

    fn warning(&self, value: &ParamValue, why: &str) -> Warning {
        let (name, text, technique) = (value.info.name, &value.text, self.technique);
        Warning {
            code: SETTING_WITHOUT_EFFECT,
            count: 1,
            message: format!("{technique}: {name}={text} has no effect here; {why}"),
        }
    }
}

/// What the files hold that `text` names.
fn read_images(
    technique: &'static str,
    info: &ParamInfo,
    text: &str,
) -> Result<Option<LightSequence>, TechniqueError> {
    if !matches!(info.domain, Domain::Images { words } if !words.contains(&text)) {
        return Ok(None);
    }
    let read = LightSequence::read(text.split(','));
    read.map(Some).map_err(|why| TechniqueError::LightImage {
        technique,
        key: info.name,
        why,
    })
}

/// Name of the parameter that says which image of a sequence lights show; animations go
/// through them by it.
pub const LIGHT_FRAME: &str = "light-frame";

/// Code of warnings of settings that change nothing.
pub const SETTING_WITHOUT_EFFECT: &str = "setting-without-effect";

fn bad_value(technique: &'static str, info: &ParamInfo, value: &str) -> TechniqueError {
    TechniqueError::BadValue {
        technique,
        key: info.name,
        value: value.to_owned(),
        valid: info.domain.to_string(),
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
        assert_eq!(params.text("method"), Some("zfail"));
        assert_eq!(params.text("light"), Some("3"));
        assert_eq!(params.text("open-casters"), Some("refuse"));
        assert_eq!(params.text("nonsense"), None);
        assert!(params.is_given("light") && !params.is_given("open-casters"));
    }

    #[test]
    fn errors_say_what_is_valid() {
        let message = |a: &str| parse(&[a]).unwrap_err();
        assert!(message("method=zz").contains("auto|zpass|zfail"));
        assert!(message("light=-1").contains("all, or a whole number from 0"));
        assert!(message("methd=auto").contains("did you mean 'method'"));
        assert!(message("zfail").contains("key=value"));
    }

    #[test]
    fn parameters_of_other_techniques_are_not_read() {
        let params = parse(&[]).unwrap();
        let taps = Param::<u32>::whole("taps", 4, [1, 64], "");
        let refused = params.get(&taps).unwrap_err().to_string();
        assert!(
            refused.contains("'shadow-volumes' has no parameter 'taps'"),
            "{refused}"
        );
    }
}
