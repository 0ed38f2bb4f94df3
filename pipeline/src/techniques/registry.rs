//! A list of techniques: the built-in ones, and those of other crates.

use thiserror::Error;

use super::all;
use crate::technique::{Technique, TechniqueError};
use crate::world::error::nearest;

/// Techniques by name, in the order in which they are listed.
///
/// ```
/// use gnomon_pipeline::techniques::Registry;
///
/// let registry = Registry::built_in();
/// assert_eq!(registry.find("pcf")?.name(), "pcf");
/// # Ok::<(), gnomon_pipeline::technique::TechniqueError>(())
/// ```
#[derive(Clone)]
pub struct Registry {
    techniques: Vec<&'static dyn Technique>,
}

/// Why a technique is not taken into a [`Registry`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum RegistryError {
    /// Another one has its name.
    #[error("a technique called '{name}' is registered already; give this one another name")]
    Duplicate {
        /// The name.
        name: &'static str,
    },
    /// The command line could not name it.
    #[error(
        "a technique is called '{name}'; valid are names of small letters, digits and hyphens, \
         a letter first"
    )]
    Name {
        /// The name.
        name: &'static str,
    },
    /// Two of its parameters have one name.
    #[error("technique '{technique}' has two parameters called '{name}'")]
    DuplicateParameter {
        /// The technique.
        technique: &'static str,
        /// The name.
        name: &'static str,
    },
    /// A parameter does not take its own default.
    #[error(
        "parameter {name} of technique '{technique}' has the default '{default}'; valid are: {valid}"
    )]
    Default {
        /// The technique.
        technique: &'static str,
        /// The parameter.
        name: &'static str,
        /// Its default.
        default: String,
        /// The values it takes.
        valid: String,
    },
}

impl Registry {
    /// The built-in techniques.
    pub fn built_in() -> Self {
        Self {
            techniques: all().to_vec(),
        }
    }

    /// Adds `technique` behind the others.
    ///
    /// # Errors
    /// Its name is taken or not a name, or its parameters contradict themselves.
    pub fn register(&mut self, technique: &'static dyn Technique) -> Result<(), RegistryError> {
        let name = technique.name();
        if !is_name(name) {
            return Err(RegistryError::Name { name });
        }
        if self.techniques.iter().any(|t| t.name() == name) {
            return Err(RegistryError::Duplicate { name });
        }
        check_params(technique)?;
        self.techniques.push(technique);
        Ok(())
    }

    /// All techniques, in order.
    pub fn all(&self) -> &[&'static dyn Technique] {
        &self.techniques
    }

    /// The technique called `name`.
    ///
    /// # Errors
    /// There is none: the error lists all names and suggests the nearest.
    pub fn find(&self, name: &str) -> Result<&'static dyn Technique, TechniqueError> {
        find_in(&self.techniques, name)
    }
}

/// The technique of `techniques` called `name`.
pub(super) fn find_in(
    techniques: &[&'static dyn Technique],
    name: &str,
) -> Result<&'static dyn Technique, TechniqueError> {
    if let Some(technique) = techniques.iter().find(|t| t.name() == name) {
        return Ok(*technique);
    }
    let known: Vec<&'static str> = techniques.iter().map(|t| t.name()).collect();
    Err(TechniqueError::Unknown {
        name: name.to_owned(),
        nearest: nearest(name, &known),
        known,
    })
}

fn is_name(name: &str) -> bool {
    let rest = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(rest)
}

fn check_params(technique: &dyn Technique) -> Result<(), RegistryError> {
    let params = technique.params();
    for (number, param) in params.iter().enumerate() {
        let (technique, name) = (technique.name(), param.name);
        if params[..number].iter().any(|p| p.name == name) {
            return Err(RegistryError::DuplicateParameter { technique, name });
        }
        let default = param.default.to_string();
        if !param.domain.takes(&default) {
            return Err(RegistryError::Default {
                technique,
                name,
                default,
                valid: param.domain.to_string(),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::{Capabilities, Frame, Param, ParamInfo, Params, Value};
    use crate::world::scene::Scene;

    /// A technique of that name and those parameters.
    struct Named(&'static str, &'static [ParamInfo]);

    impl Technique for Named {
        fn name(&self) -> &'static str {
            self.0
        }

        fn summary(&self) -> &'static str {
            "for tests"
        }

        fn params(&self) -> &'static [ParamInfo] {
            self.1
        }

        fn capabilities(&self) -> Capabilities {
            Capabilities::UNSHADOWED
        }

        fn frame(
            &self,
            scene: &Scene,
            size: [u32; 2],
            _params: &Params,
        ) -> Result<Frame, TechniqueError> {
            let unshadowed = all()[0];
            unshadowed.frame(scene, size, &Params::defaults(unshadowed))
        }
    }

    fn registered(technique: &'static Named) -> Result<Registry, RegistryError> {
        let mut registry = Registry::built_in();
        registry.register(technique)?;
        Ok(registry)
    }

    #[test]
    fn others_are_found_behind_the_built_in_ones() {
        let registry = registered(&Named("my-own", &[])).unwrap();
        assert_eq!(registry.find("my-own").unwrap().name(), "my-own");
        assert_eq!(registry.all().len(), all().len() + 1);
        let message = registry.find("my-ow").err().unwrap().to_string();
        assert!(message.contains("did you mean 'my-own'"), "{message}");
        assert!(Registry::built_in().find("my-own").is_err());
    }

    #[test]
    fn what_could_not_be_named_or_told_apart_is_refused() {
        let refused = |technique| registered(technique).err().unwrap().to_string();
        assert!(refused(&Named("pcf", &[])).contains("'pcf' is registered already"));
        for name in ["", "Mine", "1st", "my own", "my=own"] {
            let technique = Box::leak(Box::new(Named(name, &[])));
            assert!(refused(technique).contains("small letters"), "{name}");
        }
        const TAPS: ParamInfo = Param::<u32>::whole("taps", 4, [1, 64], "").info;
        assert!(refused(&Named("twice", &[TAPS, TAPS])).contains("two parameters called 'taps'"));
        const NONE: ParamInfo = ParamInfo {
            default: Value::Whole(0),
            ..TAPS
        };
        assert!(refused(&Named("none", &[NONE])).contains("a whole number 1 to 64"));
    }

    #[test]
    fn built_in_techniques_keep_the_rules() {
        for technique in all() {
            assert!(is_name(technique.name()), "{}", technique.name());
            assert_eq!(check_params(*technique), Ok(()), "{}", technique.name());
        }
    }
}
