//! `gnomon techniques`.

use clap::Args;
use gnomon_pipeline::technique::{Condition, ParamInfo, Technique};
use gnomon_pipeline::techniques::Registry;

use crate::documents::TechniquesDocument;
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
        return output::print_json(&TechniquesDocument::new(&chosen));
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
                // On a line of its own: conditions name settings too.
                let setting = format!("\n    {}={}  ", p.name, p.default);
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
