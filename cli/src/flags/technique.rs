//! A technique with settings, written alike for every verb: `pcss:samples=64`.

use gnomon_pipeline::technique::{Technique, TechniqueError};
use gnomon_pipeline::techniques::Registry;

use super::parse_setting;

/// What stands for every technique at its defaults, where several may be named.
const ALL: &str = "all";

/// A technique with the settings that it was given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct EntryArg {
    /// The technique's name, unchecked.
    pub(crate) technique: String,
    /// Keys and values, unchecked.
    pub(crate) settings: Vec<(String, String)>,
}

impl EntryArg {
    /// A technique as it is by default.
    pub(crate) fn plain(technique: &str) -> Self {
        Self {
            technique: technique.to_owned(),
            settings: Vec::new(),
        }
    }

    /// Whether it stands for every technique.
    pub(crate) fn is_all(&self) -> bool {
        self.technique == ALL
    }

    /// The technique, by its name.
    pub(crate) fn find(
        &self,
        registry: &Registry,
    ) -> Result<&'static dyn Technique, TechniqueError> {
        registry.find(&self.technique)
    }

    /// Keys and values as parameters are given.
    pub(crate) fn written(&self) -> Vec<String> {
        let settings = self.settings.iter();
        settings
            .map(|(key, value)| format!("{key}={value}"))
            .collect()
    }
}

/// Reads `NAME` or `NAME:KEY=VALUE:...`. [`ALL`] has no settings.
pub(crate) fn parse_entry(text: &str) -> Result<EntryArg, String> {
    let mut parts = text.split(':').map(str::trim);
    let technique = parts.next().unwrap_or_default();
    if technique.is_empty() {
        return Err(format!(
            "`{text}` names no technique; expected NAME or NAME:KEY=VALUE:..."
        ));
    }
    let setting = |part: &str| {
        let (key, value) = parse_setting(part).map_err(|e| format!("`{part}` of `{text}`: {e}"))?;
        Ok((key.trim().to_owned(), value.trim().to_owned()))
    };
    let settings = parts.map(setting).collect::<Result<Vec<_>, String>>()?;
    match settings.first() {
        Some((key, _)) if technique == ALL => Err(format!(
            "`{ALL}` takes no settings, and `{key}` was given; name the techniques"
        )),
        _ => Ok(EntryArg {
            technique: technique.to_owned(),
            settings,
        }),
    }
}

/// What was asked for, [`ALL`] being every technique of the registry in its order.
pub(crate) fn expand_all(entries: &[EntryArg], registry: &Registry) -> Vec<EntryArg> {
    let every = || registry.all().iter().map(|t| EntryArg::plain(t.name()));
    let expand = |entry: &EntryArg| match entry.is_all() {
        true => every().collect(),
        false => vec![entry.clone()],
    };
    entries.iter().flat_map(expand).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_have_settings_of_their_own() {
        let entry = parse_entry(" a : k = 1 :l=x=y").unwrap();
        let pair = |k: &str, v: &str| (k.to_owned(), v.to_owned());
        assert_eq!(entry.technique, "a");
        assert_eq!(entry.settings, [pair("k", "1"), pair("l", "x=y")]);
        assert_eq!(entry.written(), ["k=1", "l=x=y"]);
        for (bad, told) in [
            ("", "names no technique"),
            (":k=1", "names no technique"),
            ("a:b", "`b` of `a:b`: expected KEY=VALUE"),
            ("all:k=1", "`all` takes no settings, and `k` was given"),
        ] {
            let message = parse_entry(bad).unwrap_err();
            assert!(message.contains(told), "{bad}: {message}");
        }
    }

    #[test]
    fn all_is_every_technique_in_its_place() {
        let registry = Registry::built_in();
        let given = ["pcss:samples=64", "all"].map(|t| parse_entry(t).unwrap());
        let found = expand_all(&given, &registry);
        assert_eq!(found.len(), 1 + registry.all().len());
        assert_eq!(found[0], given[0]);
        assert!(found.iter().all(|e| e.find(&registry).is_ok()));
    }
}
