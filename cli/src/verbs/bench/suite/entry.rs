//! A technique with its parameters, in one writing.

use gnomon_pipeline::technique::{Domain, ParamInfo, Params, Technique, TechniqueError};

/// The parameter by which techniques choose lights.
pub(super) const LIGHT: &str = "light";

/// Keys and values.
pub(super) type Settings = Vec<(String, String)>;

/// A technique with parameters.
pub(crate) struct Entry {
    pub(crate) technique: &'static dyn Technique,
    pub(crate) params: Params,
    /// Those that are not at their defaults.
    pub(crate) settings: Settings,
}

/// The technique with `given` settings under light number `light`.
pub(super) fn entry(
    technique: &'static dyn Technique,
    given: &[(String, String)],
    light: usize,
) -> Result<Entry, TechniqueError> {
    let written = given.iter().map(|(k, v)| format!("{k}={v}"));
    let params = Params::parse(technique, written)?;
    let settings: Settings = technique
        .params()
        .iter()
        .filter_map(|info| changed(info, &params))
        .collect();
    let has_lights = technique.params().iter().any(|p| p.name == LIGHT);
    let light = has_lights.then(|| format!("{LIGHT}={light}"));
    let plain = settings.iter().map(|(k, v)| format!("{k}={v}"));
    let params = Params::parse(technique, light.into_iter().chain(plain))?;
    Ok(Entry {
        technique,
        params,
        settings,
    })
}

/// A parameter that is not at its default, its value in one writing.
fn changed(info: &ParamInfo, params: &Params) -> Option<(String, String)> {
    let text = params.text(info.name)?;
    if info.domain.same(text, &info.default.to_string()) {
        return None;
    }
    let number = match info.domain {
        Domain::Whole { .. } => text.parse::<u64>().ok().map(|n| n.to_string()),
        Domain::Decimal { .. } => text.parse::<f64>().ok().map(|x| x.to_string()),
        _ => None,
    };
    let text = number.unwrap_or_else(|| text.to_owned());
    Some((info.name.to_owned(), text))
}
