//! Warnings for people: many of one kind, as tens of lights give them, in few
//! lines. JSON has them all.

use gnomon_pipeline::technique::Warning;

/// Most warnings of one code that are told one by one.
const FEW: usize = 4;

/// A line for each warning; of a code with more than [`FEW`] the first one and how
/// many there are. Codes are in the order in which they come up.
pub(crate) fn lines(warnings: &[Warning]) -> Vec<String> {
    let mut codes: Vec<&str> = Vec::new();
    for warning in warnings {
        if !codes.contains(&warning.code) {
            codes.push(warning.code);
        }
    }
    codes
        .iter()
        .flat_map(|code| of_code(code, warnings))
        .collect()
}

fn of_code(code: &str, warnings: &[Warning]) -> Vec<String> {
    let mine: Vec<&Warning> = warnings.iter().filter(|w| w.code == code).collect();
    let line = |w: &&Warning| format!("{code}: {}", w.message);
    if mine.len() <= FEW {
        return mine.iter().map(line).collect();
    }
    let sum: usize = mine.iter().map(|w| w.count).sum();
    let first = mine.first().map(line).unwrap_or_default();
    vec![format!(
        "{first} (and {} more such warnings, {sum} counted in all; --json has them)",
        mine.len() - 1
    )]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_of_a_kind_are_one_line() {
        let warning = |code, count| Warning {
            code,
            count,
            message: format!("{count} things"),
        };
        let few = [warning("a", 1), warning("b", 2), warning("a", 3)];
        assert_eq!(lines(&few), ["a: 1 things", "a: 3 things", "b: 2 things"]);
        let many: Vec<Warning> = (1..=60)
            .map(|k| warning("a", k))
            .chain([warning("b", 7)])
            .collect();
        let told = lines(&many);
        assert_eq!(told.len(), 2);
        assert!(told[0].starts_with("a: 1 things (and 59 more") && told[0].contains("1830"));
        assert_eq!(told[1], "b: 7 things");
    }
}
