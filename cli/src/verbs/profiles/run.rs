//! Lists profiles, or shows one.

use gnomon_traces::profile::{Fact, PROFILES, Profile, profile};
use serde::Serialize;

use super::args::{ProfilesArgs, ProfilesVerb};
use crate::error::CliError;
use crate::output;
use crate::verbs::traffic::find_profile;

#[derive(Serialize)]
struct ProfilesDocument {
    profiles: Vec<ProfileDocument>,
}

#[derive(Serialize)]
struct ProfileDocument {
    name: String,
    summary: String,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    values: Vec<Fact>,
}

/// Lists them, or shows one.
pub(crate) fn run(args: &ProfilesArgs) -> Result<(), CliError> {
    match &args.verb {
        Some(ProfilesVerb::Show { profile }) => show(&find_profile(profile)?, args.json),
        None => list(args.json),
    }
}

fn list(json: bool) -> Result<(), CliError> {
    let mut profiles = Vec::new();
    for (name, _) in PROFILES {
        profiles.push(ProfileDocument {
            values: Vec::new(),
            ..document(&profile(name)?)
        });
    }
    if json {
        return output::print_json(&ProfilesDocument { profiles });
    }
    let lines = profiles
        .iter()
        .map(|p| format!("{:<12} {}", p.name, p.summary));
    output::print(&lines.collect::<Vec<_>>().join("\n"))
}

fn document(profile: &Profile) -> ProfileDocument {
    ProfileDocument {
        name: profile.name.clone(),
        summary: profile.summary.clone(),
        values: profile.facts.clone(),
    }
}

fn show(profile: &Profile, json: bool) -> Result<(), CliError> {
    if json {
        return output::print_json(&document(profile));
    }
    let lines = profile.facts.iter().map(|fact| {
        let origin = match (&fact.source, &fact.assumption) {
            (Some(source), _) => format!("source: {source}"),
            (_, assumption) => format!("assumption: {}", assumption.as_deref().unwrap_or("")),
        };
        format!("{} = {}\n    {origin}", fact.key, fact.value)
    });
    let lines: Vec<String> = lines.collect();
    output::print(&format!(
        "{}: {}\n{}",
        profile.name,
        profile.summary,
        lines.join("\n")
    ))
}
