//! From the command line to what is asked for.

use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::comparison::ReferenceKind;
use gnomon_pipeline::world::files::{self, Outside};

use super::args::BenchArgs;
use super::suite::{Given, Request, STANDARD, is_suite, parse};
use crate::error::CliError;

/// The name of the built-in suite.
const STANDARD_NAME: &str = "standard";
/// Most bytes of a suite's file.
const LIMIT: u64 = 16 << 20;

/// What `args` ask for: scenes, or a suite in which flags replace what it says.
pub(super) fn request(args: &BenchArgs) -> Result<Request, CliError> {
    let mut request = match suite_text(args)? {
        Some((file, text)) => parse(&file, &text, defaults(args, stem(&file)))?,
        None => scenes(args),
    };
    replace(&mut request, args);
    Ok(request)
}

fn stem(file: &str) -> String {
    let stem = Path::new(file).file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

fn scenes(args: &BenchArgs) -> Request {
    let given = args.scenes.iter().map(|s| Given::new(s.clone(), "SCENE"));
    Request {
        scenes: given.collect(),
        ..defaults(args, "bench".to_owned())
    }
}

/// Name and text of the suite, if one is asked for; it stands alone.
fn suite_text(args: &BenchArgs) -> Result<Option<(String, String)>, CliError> {
    for name in &args.scenes {
        let found = match name.as_str() {
            STANDARD_NAME => Some(STANDARD.to_owned()),
            name => read_suite(name),
        };
        match found {
            Some(text) if args.scenes.len() == 1 => return Ok(Some((name.clone(), text))),
            Some(_) => {
                return Err(Given::new((), "SCENE|SUITE").wrong(format!(
                    "`{name}` is a suite, and {} others were given; a suite stands alone",
                    args.scenes.len() - 1
                )));
            }
            None => {}
        }
    }
    Ok(None)
}

/// The text of the file, if it is a suite. What cannot be read is said by who opens scenes.
fn read_suite(name: &str) -> Option<String> {
    let extension = Path::new(name).extension()?;
    if !extension.eq_ignore_ascii_case("toml") {
        return None;
    }
    let text = String::from_utf8(files::read(Path::new(name), LIMIT).ok()?).ok()?;
    is_suite(&text).then_some(text)
}

fn defaults(args: &BenchArgs, name: String) -> Request {
    Request {
        name,
        scenes: Vec::new(),
        techniques: vec![Given::new("all".to_owned(), "--techniques")],
        sizes: vec![[320, 240]],
        threads: vec![0],
        repeat: 5,
        light: Given::new(0, "--light"),
        time: 0.0,
        reference: ReferenceKind::Exact,
        folder: PathBuf::new(),
        outside: match args.allow_outside {
            true => Outside::Allowed,
            false => Outside::Refused,
        },
    }
}

/// Flags come before what a suite says.
fn replace(request: &mut Request, args: &BenchArgs) {
    if !args.techniques.is_empty() {
        let given = args
            .techniques
            .iter()
            .map(|t| Given::new(t.clone(), "--techniques"));
        request.techniques = given.collect();
    }
    if !args.size.is_empty() {
        request.sizes.clone_from(&args.size);
    }
    if !args.threads.is_empty() {
        request.threads.clone_from(&args.threads);
    }
    if let Some(light) = args.light {
        request.light = Given::new(light, "--light");
    }
    request.repeat = args.repeat.unwrap_or(request.repeat);
    request.time = args.time.unwrap_or(request.time);
    request.reference = args.reference.unwrap_or(request.reference);
}
