//! `gnomon techniques`.

use gnomon_pipeline::technique::{ParamInfo, Technique};
use gnomon_pipeline::techniques;
use serde::Serialize;

use crate::error::CliError;
use crate::flags::ListArgs;
use crate::output;
use crate::output::wrap::hanging;

#[derive(Serialize)]
struct TechniquesDocument {
    techniques: Vec<TechniqueDocument>,
}

#[derive(Serialize)]
struct TechniqueDocument {
    name: &'static str,
    summary: &'static str,
    params: Vec<ParamDocument>,
}

#[derive(Serialize)]
struct ParamDocument {
    name: &'static str,
    default: &'static str,
    valid: &'static str,
    summary: &'static str,
}

impl From<&ParamInfo> for ParamDocument {
    fn from(p: &ParamInfo) -> Self {
        Self {
            name: p.name,
            default: p.default,
            valid: p.valid,
            summary: p.summary,
        }
    }
}

fn document(technique: &dyn Technique) -> TechniqueDocument {
    TechniqueDocument {
        name: technique.name(),
        summary: technique.summary(),
        params: technique.params().iter().map(ParamDocument::from).collect(),
    }
}

/// Lists the techniques with their parameters.
pub(crate) fn run(args: &ListArgs) -> Result<(), CliError> {
    if args.json {
        let techniques = techniques::all().iter().map(|t| document(*t)).collect();
        return output::print_json(&TechniquesDocument { techniques });
    }
    let mut text = String::new();
    for technique in techniques::all() {
        text += &hanging(&format!("{}  ", technique.name()), 4, technique.summary());
        for p in technique.params() {
            let values = p.valid.replace('|', ", ");
            text += &format!("    --set {}={}  ({values})\n", p.name, p.default);
            text += &hanging(&" ".repeat(8), 8, p.summary);
        }
    }
    text.push('\n');
    text += &hanging(
        "",
        0,
        "Shown are the defaults, in brackets the values that are taken. N is any whole \
         number from 0, N+N several, X any decimal one, TECHNIQUE a technique: \
         NAME:KEY=VALUE:...",
    );
    output::print(&text)
}
