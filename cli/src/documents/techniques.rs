//! What techniques are, as JSON.

use gnomon_pipeline::technique::{
    Capabilities, Condition, Domain, LightKinds, ParamInfo, ShadowKind, Source, Technique, Value,
    WedgeUse, Whole,
};
use serde::Serialize;
use serde_json::{Value as Json, json};

/// Techniques with their parameters.
#[derive(Serialize)]
pub struct TechniquesDocument {
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

impl TechniquesDocument {
    /// Of `techniques`, in their order.
    pub fn new(techniques: &[&dyn Technique]) -> Self {
        Self {
            techniques: techniques.iter().map(|t| document(*t)).collect(),
        }
    }
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
