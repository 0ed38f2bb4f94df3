//! `gnomon completions`: what makes a shell complete the command line.

use clap::Args;
use clap_complete::Shell;

use crate::error::CliError;
use crate::help;
use crate::output;

/// Flags of `completions`.
#[derive(Debug, Args)]
#[command(after_help = COMPLETIONS_HELP)]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

const COMPLETIONS_HELP: &str = "\
Example, bash: gnomon completions bash > ~/.local/share/bash-completion/completions/gnomon

Exit codes: 0 fine, 2 bad input.";

/// Prints the script.
pub(crate) fn run(args: &CompletionsArgs) -> Result<(), CliError> {
    output::print(&script(args.shell))
}

fn script(shell: Shell) -> String {
    let mut out = Vec::new();
    clap_complete::generate(shell, &mut help::command(), "gnomon", &mut out);
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;

    use super::*;

    /// Every verb is there, for every shell, and names of flags and values are.
    #[test]
    fn every_shell_completes_every_verb() {
        for shell in Shell::value_variants() {
            let script = script(*shell);
            for verb in help::command().get_subcommands() {
                assert!(
                    script.contains(verb.get_name()),
                    "{shell} {}",
                    verb.get_name()
                );
            }
            for word in ["visibility", "avx2", "env-turn", "harmonic"] {
                let listed = word != "avx2" && (word != "harmonic" || *shell != Shell::Elvish);
                assert!(!listed || script.contains(word), "{shell} {word}");
            }
        }
    }
}
