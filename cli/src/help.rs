//! The command line with an example and exit codes in the help of every verb.

use clap::{Command, CommandFactory};

use crate::command_line::Cli;

/// Examples of verbs, for those that bring none of their own.
const EXAMPLES: [(&str, &str); 20] = [
    ("demo", "gnomon demo -o out"),
    (
        "render",
        "gnomon render cylinder --technique pcss:samples=64 -o cylinder.png",
    ),
    (
        "record",
        "gnomon record demo --technique soft-shadow-volumes -o demo.gnt",
    ),
    ("replay", "gnomon replay demo.gnt -o replayed.png"),
    ("info", "gnomon info demo.gnt"),
    ("dump", "gnomon dump demo.gnt --images images"),
    ("trim", "gnomon trim demo.gnt --draws 5..9 -o part.gnt"),
    ("diff", "gnomon diff right.gnt wrong.gnt"),
    ("bisect", "gnomon bisect right.gnt wrong.gnt"),
    ("pixel", "gnomon pixel demo.gnt 400 300"),
    ("debug", "gnomon debug demo.gnt 400 300 2"),
    (
        "traffic",
        "gnomon traffic demo.gnt --profile imr-2008,tbr-mali -o rows.csv",
    ),
    ("profiles", "gnomon profiles show imr-2008"),
    (
        "light",
        "gnomon light demo --pixel 500 455 --size 960x640 -o light.png",
    ),
    ("wedge", "gnomon wedge demo --edge 167 -o wedge.png"),
    ("reproduce", "gnomon reproduce annen-lights --full"),
    ("scenes", "gnomon scenes --json"),
    ("techniques", "gnomon techniques pcss"),
    ("tune", "gnomon tune creature --max-error 0.02"),
    ("view", "gnomon view demo --technique soft-shadow-volumes"),
];

const EXIT_CODES: &str = "Exit codes: 0 fine, 1 differs or check failed, 2 bad input.";

/// All verbs and flags, as they are parsed, completed and described.
pub(crate) fn command() -> Command {
    EXAMPLES
        .iter()
        .fold(Cli::command(), |all, (verb, example)| {
            all.mut_subcommand(verb, |own| {
                let help = own.get_after_help().map(ToString::to_string);
                let help = completed(help.unwrap_or_default(), example);
                own.after_help(help)
            })
        })
}

/// A verb's own text, with what it does not say behind it.
fn completed(own: String, example: &str) -> String {
    let example = (!own.contains("Example:")).then(|| format!("Example: {example}"));
    let codes = (!own.contains("Exit codes:")).then(|| EXIT_CODES.to_owned());
    let own = Some(own).filter(|text| !text.is_empty());
    let all: Vec<String> = own.into_iter().chain(example).chain(codes).collect();
    all.join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_verb_has_an_example_and_exit_codes() {
        for verb in command().get_subcommands() {
            let name = verb.get_name();
            let help = verb.get_after_help().map(ToString::to_string);
            let help = help.unwrap_or_else(|| panic!("{name} has no example"));
            assert!(help.contains(&format!("gnomon {name}")), "{name}: {help}");
            assert!(help.contains("Exit codes: 0 fine"), "{name}: {help}");
        }
    }

    /// Examples are command lines that are taken.
    #[test]
    fn examples_parse() {
        for (verb, example) in EXAMPLES {
            let parsed = command().try_get_matches_from(example.split_whitespace());
            let found = parsed.unwrap_or_else(|e| panic!("{example}: {e}"));
            assert_eq!(found.subcommand_name(), Some(verb), "{example}");
        }
    }

    /// Lines are as wide as the terminal, or as COLUMNS where there is none, not wider.
    #[test]
    fn help_is_wrapped() {
        for width in [60, 90] {
            let mut narrow = command().term_width(width);
            let render = narrow.find_subcommand_mut("render").unwrap();
            let help = render
                .clone()
                .term_width(width)
                .render_long_help()
                .to_string();
            let longest = help.lines().map(|l| l.chars().count()).max().unwrap();
            assert!(longest <= width + 20, "{width}: {longest}");
        }
    }
}
