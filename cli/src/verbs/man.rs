//! `gnomon man`: pages of `man`, one for the program and one for each verb.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_mangen::Man;

use crate::error::CliError;
use crate::help;
use crate::output;
use crate::output::files::{Batch, check_folder};

/// Flags of `man`.
#[derive(Debug, Args)]
#[command(after_help = MAN_HELP)]
pub(crate) struct ManArgs {
    /// Folder for gnomon.1, gnomon-render.1 and so on
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

const MAN_HELP: &str = "\
Example: gnomon man ~/.local/share/man/man1 && man gnomon-render

Exit codes: 0 fine, 2 bad input.";

/// Writes all pages, together or not at all.
pub(crate) fn run(args: &ManArgs) -> Result<(), CliError> {
    check_folder("DIR", &args.folder)?;
    let mut batch = Batch::default();
    let pages = pages()?;
    for (name, page) in &pages {
        batch.stage(&args.folder.join(format!("{name}.1")), page)?;
    }
    batch.commit()?;
    let (count, folder) = (pages.len(), args.folder.display());
    output::print_summary(&format!("wrote {count} pages to {folder}\n"), false)
}

/// Names and contents, the program's own first.
fn pages() -> Result<Vec<(String, Vec<u8>)>, CliError> {
    let mut program = help::command();
    program.build();
    let mut pages = Vec::new();
    add(&program, "gnomon", &mut pages)?;
    Ok(pages)
}

/// A command's page, and those of the commands in it.
fn add(command: &Command, name: &str, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), CliError> {
    let mut page = Vec::new();
    // Pages have no date: they are the same whenever they are made.
    let man = Man::new(command.clone()).title(name).date("");
    man.render(&mut page).map_err(CliError::Stdout)?;
    pages.push((name.to_owned(), page));
    for inner in command.get_subcommands().filter(|c| c.get_name() != "help") {
        add(inner, &format!("{name}-{}", inner.get_name()), pages)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_verb_has_a_page_that_is_the_same_each_time() {
        let (pages, again) = (pages().unwrap(), pages().unwrap());
        assert_eq!(pages, again);
        for verb in help::command().get_subcommands() {
            let name = format!("gnomon-{}", verb.get_name());
            let page = pages.iter().find(|(n, _)| *n == name);
            let text = String::from_utf8_lossy(&page.unwrap().1).into_owned();
            assert!(text.contains(".SH SYNOPSIS"), "{name}");
        }
        let find = |name: &str| pages.iter().find(|(n, _)| n == name).unwrap();
        let render = String::from_utf8_lossy(&find("gnomon-render").1).replace('\\', "");
        assert!(render.contains("--visibility") && render.contains("FILE.npy"));
    }
}
