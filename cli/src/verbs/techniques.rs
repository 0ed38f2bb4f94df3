//! `gnomon techniques`.

use clap::Args;
use gnomon_pipeline::technique::{
    Capabilities, Condition, Domain, LightKinds, ParamInfo, ShadowKind, Source, Technique, Value,
    WedgeUse, Whole,
};
use gnomon_pipeline::techniques::Registry;
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::output;
use crate::output::wrap::hanging;

/// Flags of `techniques`.
#[derive(Debug, Args)]
#[command(after_help = TECHNIQUES_HELP)]
pub(crate) struct TechniquesArgs {
    /// Of these techniques alone, with all of their parameters [default: all, with the
    /// parameters that several share once, at the end]
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Print one JSON document on stdout
    #[arg(long)]
    json: bool,
}

const TECHNIQUES_HELP: &str = "\
Example: gnomon techniques pcss

Exit codes: 0 fine, 2 bad input.";

#[derive(Serialize)]
struct TechniquesDocument {
    techniques: Vec<TechniqueDocument>,
}

#[derive(Serialize)]
struct TechniqueDocument {
    name: &'static str,
    summary: &'static str,
    capabilities: Json,
    params: Vec<ParamDocument>,
}

#[derive(Serialize)]
struct ParamDocument {
    name: &'static str,
    #[serde(rename = "type")]
    kind: &'static str,
    default: Json,
    choices: &'static [&'static str],
    range: Json,
    unit: Option<&'static str>,
    summary: &'static str,
    applies_when: Json,
    valid: String,
}

impl From<&ParamInfo> for ParamDocument {
    fn from(p: &ParamInfo) -> Self {
        Self {
            name: p.name,
            kind: kind(&p.domain),
            default: default(p.default),
            choices: p.domain.words(),
            range: range(&p.domain),
            unit: p.unit,
            summary: p.summary,
            applies_when: condition(&p.applies),
            valid: p.domain.to_string(),
        }
    }
}

fn kind(domain: &Domain) -> &'static str {
    match domain {
        Domain::Words(["on", "off"]) => "switch",
        Domain::Words(_) => "choice",
        Domain::Whole { kind, .. } => match kind {
            Whole::Any => "whole",
            Whole::PowerOfTwo => "power-of-two",
            Whole::Square => "square",
        },
        Domain::Decimal { .. } => "decimal",
        Domain::List { .. } => "list",
        Domain::Images { .. } => "images",
        Domain::Technique => "technique",
    }
}

fn default(value: Value) -> Json {
    match value {
        Value::Word(word) => json!(word),
        Value::Whole(number) => json!(number),
        Value::Decimal(number) => json!(number),
    }
}

/// Smallest and largest number; `null` for none, and for no end.
fn range(domain: &Domain) -> Json {
    match domain {
        Domain::Words(_) | Domain::Images { .. } | Domain::Technique => Json::Null,
        Domain::Whole { range, .. } => json!({
            "min": range[0], "max": range[1], "min_included": true,
        }),
        Domain::Decimal { numbers, .. } => json!({
            "min": numbers.low, "max": null, "min_included": numbers.with_low,
        }),
        Domain::List { .. } => json!({
            "min": 0, "max": null, "min_included": true,
        }),
    }
}

fn condition(condition: &Condition) -> Json {
    let all = |list: &[Condition]| list.iter().map(self::condition).collect::<Vec<Json>>();
    match condition {
        Condition::Always => Json::Null,
        Condition::Is(param, values) => json!({ "param": param, "is": values }),
        Condition::Not(param, values) => json!({ "param": param, "is_not": values }),
        Condition::All(list) => json!({ "all": all(list) }),
        Condition::Any(list) => json!({ "any": all(list) }),
        Condition::Lights(fact) => json!({ "a_light_is": fact.name() }),
        Condition::Environment => json!({ "scene_has": "environment" }),
    }
}

fn capabilities(c: Capabilities) -> Json {
    json!({
        "shadows": match c.shadows {
            ShadowKind::None => "none",
            ShadowKind::Hard => "hard",
            ShadowKind::Soft => "soft",
        },
        "source": match c.source {
            Source::Nothing => "nothing",
            Source::Silhouettes => "silhouettes",
            Source::LightViews => "light-views",
            Source::Rays => "rays",
            Source::Techniques => "techniques",
        },
        "wedges": match c.wedges {
            WedgeUse::None => "none",
            WedgeUse::Single => "single",
            WedgeUse::Linked => "linked",
        },
        "needs_closed_casters": c.needs_closed_casters(),
        "lights": lights(c.lights),
    })
}

/// Names of the lights taken, as scene files have them.
fn lights(kinds: LightKinds) -> Vec<&'static str> {
    let all = [
        (kinds.points, "point"),
        (kinds.directions, "directional"),
        (kinds.rectangles, "rectangle"),
        (kinds.discs, "disc"),
        (kinds.spheres, "sphere"),
        (kinds.polygons, "polygon"),
    ];
    let taken = all.into_iter().filter(|(taken, _)| *taken);
    taken.map(|(_, name)| name).collect()
}

fn document(technique: &dyn Technique) -> TechniqueDocument {
    TechniqueDocument {
        name: technique.name(),
        summary: technique.summary(),
        capabilities: capabilities(technique.capabilities()),
        params: technique.params().iter().map(ParamDocument::from).collect(),
    }
}

/// Values, unit, and when it applies, in brackets.
fn values(p: &ParamInfo) -> String {
    let mut text = p.domain.to_string().replace('|', ", ");
    if let Some(unit) = p.unit {
        text += &format!("; {unit}");
    }
    if p.applies != Condition::Always {
        text += &format!("; applies when {}", p.applies);
    }
    text
}

/// Techniques that share a parameter before it is listed for all of them at once.
const SEVERAL: usize = 4;

/// Parameters that several techniques have alike, defaults included; of those of one name the
/// one that most have.
fn shared(registry: &Registry) -> Vec<ParamInfo> {
    let all = || registry.all().iter().flat_map(|t| t.params());
    let count = |info: &ParamInfo| all().filter(|p| *p == info).count();
    let mut shared: Vec<ParamInfo> = Vec::new();
    for info in all().filter(|info| count(info) >= SEVERAL) {
        match shared.iter_mut().find(|s| s.name == info.name) {
            Some(known) if count(known) < count(info) => *known = *info,
            Some(_) => {}
            None => shared.push(*info),
        }
    }
    shared
}

fn list_param(p: &ParamInfo) -> String {
    let setting = format!("    {}={}  ", p.name, p.default);
    hanging(&setting, 8, &format!("({})", values(p))) + &hanging(&" ".repeat(8), 8, p.summary)
}

/// Name, summary and parameters; those among `elsewhere` by name alone.
fn list(technique: &dyn Technique, elsewhere: &[ParamInfo]) -> String {
    let mut text = hanging(&format!("{}  ", technique.name()), 4, technique.summary());
    let params = technique.params().iter();
    let (common, own): (Vec<&ParamInfo>, Vec<_>) = params.partition(|p| elsewhere.contains(p));
    text.extend(own.into_iter().map(list_param));
    let names: Vec<&str> = common.iter().map(|p| p.name).collect();
    if !names.is_empty() {
        text += &hanging("    and: ", 8, &names.join(", "));
    }
    text
}

const LEGEND: &str = "Shown are the defaults, in brackets the values that are taken, the unit, and \
    when the setting has an effect: elsewhere it is warned of. Settings are given behind the \
    name, NAME:KEY=VALUE:..., or with --set KEY=VALUE.";

/// Lists the techniques with their parameters.
pub(crate) fn run(args: &TechniquesArgs, registry: &Registry) -> Result<(), CliError> {
    let named = args.names.iter().map(|name| registry.find(name));
    let named = named.collect::<Result<Vec<_>, _>>()?;
    let chosen = match named.is_empty() {
        true => registry.all().to_vec(),
        false => named.clone(),
    };
    if args.json {
        let techniques = chosen.iter().map(|t| document(*t)).collect();
        return output::print_json(&TechniquesDocument { techniques });
    }
    let elsewhere = match named.is_empty() {
        true => shared(registry),
        false => Vec::new(),
    };
    let mut text: String = chosen.iter().map(|t| list(*t, &elsewhere)).collect();
    if !elsewhere.is_empty() {
        text += "\nParameters of several techniques, with the same default:\n";
        text.extend(elsewhere.iter().map(list_param));
    }
    text.push('\n');
    text += &hanging("", 0, LEGEND);
    output::print(&text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each parameter of each technique is listed: in its place, or among those of several,
    /// once, if it is named.
    #[test]
    fn nothing_is_lost_among_shared_parameters() {
        let registry = Registry::built_in();
        let elsewhere = shared(&registry);
        assert!(elsewhere.len() > 3);
        let mut names: Vec<&str> = elsewhere.iter().map(|p| p.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), elsewhere.len(), "a name means one thing");
        for technique in registry.all() {
            let text = list(*technique, &elsewhere);
            let whole = list(*technique, &[]);
            for p in technique.params() {
                let setting = format!("    {}={}  ", p.name, p.default);
                assert!(whole.contains(setting.trim_end()), "{}", p.name);
                let own = text.contains(setting.trim_end());
                assert_eq!(
                    own,
                    !elsewhere.contains(p),
                    "{} {}",
                    technique.name(),
                    p.name
                );
                assert!(own || text.contains(p.name));
            }
        }
        let lengths = [&elsewhere[..], &[]].map(|e| {
            let all = registry.all().iter();
            all.map(|t| list(*t, e).lines().count()).sum::<usize>()
        });
        assert!(3 * lengths[0] < 2 * lengths[1], "{lengths:?}");
    }
}
