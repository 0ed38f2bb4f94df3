//! The profiles that come with the program.

use super::{Profile, ProfileError};

/// Names and files of the profiles.
pub const PROFILES: [(&str, &str); 7] = [
    ("naive", include_str!("naive.toml")),
    ("compulsory", include_str!("compulsory.toml")),
    ("gnomon", include_str!("gnomon.toml")),
    ("imr-2003", include_str!("imr-2003.toml")),
    ("imr-2008", include_str!("imr-2008.toml")),
    ("tbr-mali", include_str!("tbr-mali.toml")),
    ("tbr-adreno", include_str!("tbr-adreno.toml")),
];

/// The profile of that name.
///
/// # Errors
/// There is none.
pub fn profile(name: &str) -> Result<Profile, ProfileError> {
    let found = PROFILES.iter().find(|(known, _)| *known == name);
    let Some((name, text)) = found else {
        let names: Vec<&str> = PROFILES.iter().map(|(name, _)| *name).collect();
        return Err(ProfileError::NoSuchProfile {
            name: name.to_owned(),
            valid: names.join(", "),
        });
    };
    Profile::parse(name, &format!("{name}.toml"), text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_profile_reads_and_every_value_says_where_it_is_from() {
        for (name, _) in PROFILES {
            let profile = profile(name).unwrap();
            assert!(profile.facts.len() > 10);
            for fact in profile.facts {
                assert!(fact.source.is_some() != fact.assumption.is_some());
            }
        }
    }

    fn error_of(from: &str, to: &str) -> String {
        let text = PROFILES[1].1.replacen(from, to, 1);
        assert_ne!(text, PROFILES[1].1);
        Profile::parse("p", "p.toml", &text)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn values_without_origin_and_unknown_keys_are_refused() {
        let line = "scanout = { value = false, assumption";
        let bare = error_of(line, "scanout = { value = false, because");
        assert!(
            bare.contains("p.toml: `scanout`") && bare.contains("source"),
            "{bare}"
        );
        let plain = error_of("[hiz]\nrules", "[hiz]\nextra = 1\nrules");
        assert!(plain.contains("`hiz.extra` is 1"), "{plain}");
        let extra = "[hiz]\nextra = { value = 1, assumption = \"x\" }\nrules";
        let unknown = error_of("[hiz]\nrules", extra);
        assert!(unknown.contains("`hiz.extra` is unknown"), "{unknown}");
        let empty = error_of(line, "scanout = { value = false, assumption = \" \", x");
        assert!(empty.contains("scanout"), "{empty}");
        let wrong = error_of("value = \"immediate\"", "value = \"random\"");
        assert!(wrong.contains("one of \"immediate\", \"tiled\""), "{wrong}");
        assert!(error_of("scanout =", "scanned =").contains("`scanout` is missing"));
    }
}
