//! A technique and a grid over its parameters: `pcf:taps=2|4|8:map-size=256|512`.

use gnomon_pipeline::technique::TechniqueError;
use gnomon_pipeline::techniques::Registry;

use super::entry::{Entry, LIGHT, Settings, entry};
use super::request::Given;
use crate::error::CliError;
use crate::flags::parse_entry;

/// Most points of one grid.
const MOST_POINTS: usize = 4096;

/// Every point of the grid that `given` writes, under light number `light`.
pub(super) fn expand(
    given: &Given<String>,
    registry: &Registry,
    light: usize,
) -> Result<Vec<Entry>, CliError> {
    let grid = parse_entry(&given.value).map_err(|e| given.wrong(e))?;
    if grid.is_all() {
        return every(given, registry, light);
    }
    let technique = grid.find(registry).map_err(|e| given.wrong(e))?;
    let axes = grid.settings.iter().map(|axis| read_axis(given, axis));
    let axes = axes.collect::<Result<Vec<_>, _>>()?;
    let points = product(given, &axes)?;
    let entries = points.iter().map(|p| entry(technique, p, light));
    let entries: Result<_, TechniqueError> = entries.collect();
    entries.map_err(|e| given.wrong(e))
}

fn every(given: &Given<String>, registry: &Registry, light: usize) -> Result<Vec<Entry>, CliError> {
    let entries = registry.all().iter().map(|t| entry(*t, &[], light));
    let entries: Result<_, TechniqueError> = entries.collect();
    entries.map_err(|e| given.wrong(e))
}

/// The values of one setting: V1|V2|...
fn read_axis(
    given: &Given<String>,
    (key, values): &(String, String),
) -> Result<(String, Vec<String>), CliError> {
    if key == LIGHT {
        return Err(given.wrong(format!(
            "`{key}={values}` of `{}`: one light is measured at a time: choose it for all with \
             `light`",
            given.value
        )));
    }
    let values: Vec<String> = values.split('|').map(|v| v.trim().to_owned()).collect();
    Ok((key.clone(), values))
}

/// Every combination, the last axis fastest.
fn product(
    given: &Given<String>,
    axes: &[(String, Vec<String>)],
) -> Result<Vec<Settings>, CliError> {
    let count = axes
        .iter()
        .try_fold(1usize, |n, a| n.checked_mul(a.1.len()));
    if count.is_none_or(|n| n > MOST_POINTS) {
        return Err(given.wrong(format!(
            "`{}` has more than {MOST_POINTS} combinations; give fewer values",
            given.value
        )));
    }
    let mut points = vec![Settings::new()];
    for (key, values) in axes {
        let with = |point: &Settings| {
            let values = values.iter().map(|v| (key.clone(), v.clone()));
            values
                .map(|setting| point.iter().cloned().chain([setting]).collect())
                .collect::<Vec<Settings>>()
        };
        points = points.iter().flat_map(with).collect();
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(text: &str) -> Result<Vec<String>, String> {
        let given = Given::new(text.to_owned(), "s.toml:3");
        let entries = expand(&given, &Registry::built_in(), 0);
        let entries = entries.map_err(|e| e.to_string())?;
        let label = |e: &Entry| {
            let settings = e.settings.iter().map(|(k, v)| format!(" {k}={v}"));
            e.technique.name().to_owned() + &settings.collect::<String>()
        };
        Ok(entries.iter().map(label).collect())
    }

    #[test]
    fn grids_have_every_combination_and_defaults_no_name() {
        assert_eq!(
            labels("pcf:taps=2|04|8:map-size=256|512").unwrap(),
            [
                "pcf taps=2 map-size=256",
                "pcf taps=2",
                "pcf map-size=256",
                "pcf",
                "pcf taps=8 map-size=256",
                "pcf taps=8",
            ]
        );
        assert_eq!(
            labels("all").unwrap().len(),
            Registry::built_in().all().len()
        );
    }

    #[test]
    fn errors_name_the_place_the_value_and_what_is_valid() {
        for (text, parts) in [
            ("pcff", ["'pcff'", "did you mean 'pcf'"]),
            ("pcf:taps=0", ["'0'", "1 to 64"]),
            ("pcf:taps=2||4", ["taps", "1 to 64"]),
            ("pcf:tabs=2", ["'tabs'", "did you mean 'taps'"]),
            ("pcf:taps", ["`taps`", "KEY=VALUE"]),
            ("", ["``", "NAME"]),
            ("all:taps=3", ["`taps`", "name the techniques"]),
            ("pcf:light=1", ["`light=1`", "one light"]),
        ] {
            let message = labels(text).unwrap_err();
            assert!(message.starts_with("s.toml:3: "), "{message}");
            assert!(
                parts.iter().all(|p| message.contains(p)),
                "{text}: {message}"
            );
        }
        let values: Vec<String> = (1..=64).map(|n: u32| n.to_string()).collect();
        let wide = values.join("|");
        let message = labels(&format!("pcf:taps={wide}:bias={wide}:near={wide}")).unwrap_err();
        assert!(message.contains("4096"), "{message}");
    }
}
