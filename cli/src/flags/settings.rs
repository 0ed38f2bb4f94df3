//! Settings of a technique.

use gnomon_pipeline::technique::{Params, Technique, TechniqueError};

/// Parameters from `--set`. With `no_skip`, techniques that can leave work out
/// themselves do not, unless told otherwise.
pub(crate) fn parameters(
    technique: &dyn Technique,
    settings: &[(String, String)],
    no_skip: bool,
) -> Result<Params, TechniqueError> {
    let can_skip = technique.params().iter().any(|p| p.name == "skip");
    let implied = (no_skip && can_skip).then(|| "skip=off".to_owned());
    let given = settings.iter().map(|(key, value)| format!("{key}={value}"));
    Params::parse(technique, implied.into_iter().chain(given))
}
