//! Pages that show commands with their output: each command is run, and says what the page
//! says that it does.
//!
//! In a ```` ```console ```` block a line that begins with `$ gnomon ` is a command; the
//! lines below it, to the next one or the end of the block, are its standard output. A line
//! `...` stands for any number of lines, and `# exit 1` at the end for another exit code
//! than 0. The commands of a page run one after the other in one folder.

use std::fs;
use std::path::PathBuf;

use crate::common::Folder;

/// A command of a page, and what the page says that it prints.
#[derive(Debug, PartialEq)]
struct Shown {
    arguments: String,
    output: Vec<String>,
    exit: i32,
}

fn commands(page: &str) -> Vec<Shown> {
    let mut all: Vec<Shown> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        if line.starts_with("```") {
            inside = line == "```console";
        } else if let Some(arguments) = line.strip_prefix("$ gnomon ").filter(|_| inside) {
            all.push(Shown {
                arguments: arguments.to_owned(),
                output: Vec::new(),
                exit: 0,
            });
        } else if inside {
            let last = all.last_mut().expect("a block begins with a command");
            match line.strip_prefix("# exit ") {
                Some(code) => last.exit = code.parse().expect("an exit code"),
                None => last.output.push(line.to_owned()),
            }
        }
    }
    all
}

/// Whether `found` is `shown`, in which `...` stands for any lines.
fn matches(shown: &[String], found: &[&str]) -> bool {
    match shown.split_first() {
        None => found.is_empty(),
        Some((line, rest)) if line == "..." => {
            (0..=found.len()).any(|skipped| matches(rest, &found[skipped..]))
        }
        Some((line, rest)) => {
            found.first().is_some_and(|f| f.trim_end() == line) && matches(rest, &found[1..])
        }
    }
}

fn check(page: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../docs")
        .join(page);
    let text = fs::read_to_string(&path).unwrap();
    let commands = commands(&text);
    assert!(
        commands.len() >= 4,
        "{page} shows {} commands",
        commands.len()
    );
    let folder = Folder::new("walk-through");
    for shown in commands {
        let run = folder.gnomon(&shown.arguments);
        let output = run.stdout();
        let found: Vec<&str> = output.lines().collect();
        assert_eq!(
            run.code(),
            shown.exit,
            "{}\n{output}{}",
            shown.arguments,
            run.stderr()
        );
        assert!(
            matches(&shown.output, &found),
            "{page}: `gnomon {}` prints\n{output}\nbut the page says\n{}",
            shown.arguments,
            shown.output.join("\n")
        );
    }
}

#[test]
fn a_page_that_is_wrong_is_found_out() {
    let page = "```console\n$ gnomon a b\none\n...\nlast\n$ gnomon c\n# exit 1\n```\n$ gnomon no\n";
    let shown = commands(page);
    assert_eq!(shown.len(), 2);
    assert_eq!((shown[0].arguments.as_str(), shown[1].exit), ("a b", 1));
    let lines = &shown[0].output;
    assert!(matches(lines, &["one", "two", "three", "last"]));
    assert!(matches(lines, &["one", "last"]));
    assert!(!matches(lines, &["one", "two"]));
    assert!(!matches(lines, &["two", "last"]));
    assert!(!matches(lines, &["one", "last", "more"]));
    assert!(matches(&shown[1].output, &[]));
}

#[test]
fn the_walk_through_prints_what_it_says() {
    check("debugging.md");
}
