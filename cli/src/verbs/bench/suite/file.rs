//! Suites in files:
//!
//! ```toml
//! [suite]
//! name = "mine"                        # else the file's
//! scenes = ["peer-a", "house.toml"]    # files beside this one
//! techniques = ["all", "pcf:taps=2|8:map-size=256|512"]
//! sizes = ["320x240"]
//! threads = [1, 0]                     # 0: as many as there are
//! repeat = 5
//! light = 0
//! time = 0.0
//! reference = "exact"                  # or "rays"
//! ```
//!
//! Everything but scenes may be left out. Unknown keys are errors; every error names file
//! and line.

use std::ops::Range;
use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::comparison::ReferenceKind;
use gnomon_raster::MAX_THREADS;
use serde::Deserialize;
use toml::Spanned;

use super::request::{Given, Request};
use crate::error::CliError;
use crate::flags::parse_size;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SuiteFile {
    suite: SuiteTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SuiteTable {
    name: Option<Spanned<String>>,
    scenes: Spanned<Vec<Spanned<String>>>,
    techniques: Option<Spanned<Vec<Spanned<String>>>>,
    sizes: Option<Spanned<Vec<Spanned<String>>>>,
    threads: Option<Spanned<Vec<Spanned<usize>>>>,
    repeat: Option<Spanned<u32>>,
    light: Option<Spanned<usize>>,
    time: Option<Spanned<f64>>,
    reference: Option<Spanned<String>>,
}

/// Whether a TOML file is a suite, be it a wrong one, and no scene.
pub(crate) fn is_suite(text: &str) -> bool {
    text.lines().any(|l| l.trim_start().starts_with("[suite]"))
}

/// Fills `defaults` with what the file called `file` says.
pub(crate) fn parse(file: &str, text: &str, defaults: Request) -> Result<Request, CliError> {
    let reader = Reader { file, text };
    let table = toml::from_str::<SuiteFile>(text).map_err(|e| {
        let problem = e.message().trim_end().to_owned();
        reader.error(e.span().unwrap_or_default(), problem)
    })?;
    reader.read(table.suite, defaults)
}

/// The file, for places in it.
struct Reader<'a> {
    file: &'a str,
    text: &'a str,
}

impl Reader<'_> {
    fn place(&self, span: &Range<usize>) -> String {
        let before = self.text.get(..span.start).unwrap_or_default();
        format!("{}:{}", self.file, before.matches('\n').count() + 1)
    }

    fn error(&self, span: Range<usize>, problem: String) -> CliError {
        CliError::Suite {
            place: self.place(&span),
            problem,
        }
    }

    fn given<T>(&self, value: Spanned<T>) -> Given<T> {
        let place = self.place(&value.span());
        Given {
            value: value.into_inner(),
            place,
        }
    }

    /// Each of a list that is not empty.
    fn list<T>(
        &self,
        key: &str,
        list: Spanned<Vec<Spanned<T>>>,
    ) -> Result<Vec<Given<T>>, CliError> {
        let list = self.given(list);
        if list.value.is_empty() {
            return Err(list.wrong(format!("`{key}` is empty; give at least one value")));
        }
        Ok(list.value.into_iter().map(|v| self.given(v)).collect())
    }

    fn read(&self, table: SuiteTable, defaults: Request) -> Result<Request, CliError> {
        let mut request = Request {
            scenes: self.list("scenes", table.scenes)?,
            folder: folder_of(self.file),
            ..defaults
        };
        if let Some(name) = table.name {
            request.name = self.given(name).value;
        }
        if let Some(list) = table.techniques {
            request.techniques = self.list("techniques", list)?;
        }
        if let Some(list) = table.sizes {
            let sizes = self.list("sizes", list)?;
            let sizes = sizes
                .iter()
                .map(|s| parse_size(&s.value).map_err(|e| s.wrong(e)));
            request.sizes = sizes.collect::<Result<_, _>>()?;
        }
        if let Some(list) = table.threads {
            let threads = self.list("threads", list)?;
            request.threads = threads
                .iter()
                .map(check_threads)
                .collect::<Result<_, _>>()?;
        }
        if let Some(repeat) = table.repeat {
            request.repeat = check_repeat(&self.given(repeat))?;
        }
        if let Some(light) = table.light {
            request.light = self.given(light);
        }
        if let Some(time) = table.time {
            request.time = check_time(&self.given(time))?;
        }
        if let Some(reference) = table.reference {
            let given = self.given(reference);
            let kind = given.value.parse::<ReferenceKind>();
            request.reference = kind.map_err(|e| given.wrong(e))?;
        }
        Ok(request)
    }
}

fn folder_of(file: &str) -> PathBuf {
    Path::new(file).parent().unwrap_or(Path::new("")).to_owned()
}

fn check_threads(given: &Given<usize>) -> Result<usize, CliError> {
    match given.value {
        n if n <= MAX_THREADS => Ok(n),
        n => Err(given.wrong(format!(
            "`threads` has {n}; expected numbers from 0 (as many as there are) to {MAX_THREADS}"
        ))),
    }
}

fn check_repeat(given: &Given<u32>) -> Result<u32, CliError> {
    match given.value {
        n if (5..=1000).contains(&n) => Ok(n),
        n => Err(given.wrong(format!("`repeat` is {n}; expected 5 to 1000"))),
    }
}

fn check_time(given: &Given<f64>) -> Result<f64, CliError> {
    match given.value {
        t if t.is_finite() => Ok(t),
        t => Err(given.wrong(format!(
            "`time` is {t}; expected a finite number of seconds"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use gnomon_pipeline::techniques::Registry;
    use gnomon_pipeline::world::files::Outside;

    use super::super::{STANDARD, Suite};
    use super::*;

    fn defaults() -> Request {
        Request {
            name: "s".to_owned(),
            scenes: Vec::new(),
            techniques: vec![Given::new("all".to_owned(), "default")],
            sizes: vec![[320, 240]],
            threads: vec![1],
            repeat: 5,
            light: Given::new(0, "default"),
            time: 0.0,
            reference: ReferenceKind::Exact,
            folder: PathBuf::new(),
            outside: Outside::Refused,
        }
    }

    fn read(lines: &str) -> Result<Request, String> {
        let text = format!("[suite]\nscenes = [\"cylinder\"]\n{lines}\n");
        parse("s.toml", &text, defaults()).map_err(|e| e.to_string())
    }

    #[test]
    fn what_is_left_out_is_as_by_default() {
        let request = read("sizes = [\"64x48\"]\nthreads = [1, 2]\nreference = \"rays\"").unwrap();
        assert_eq!(
            (&request.sizes[..], &request.threads[..]),
            (&[[64, 48]][..], &[1, 2][..])
        );
        assert_eq!(
            (request.repeat, request.reference),
            (5, ReferenceKind::Rays)
        );
        assert_eq!(request.scenes[0].place, "s.toml:2");
    }

    #[test]
    fn errors_have_the_line() {
        for (lines, parts) in [
            ("repeat = 4", ["s.toml:3: ", "5 to 1000"]),
            ("\nsizes = [\"axb\"]", ["s.toml:4: ", "WIDTHxHEIGHT"]),
            ("sizes = []", ["s.toml:3: ", "`sizes` is empty"]),
            ("threads = [1,\n 5000]", ["s.toml:4: ", "5000"]),
            ("scene = 1", ["s.toml:3: ", "scene"]),
            ("repeat = \"x\"", ["s.toml:3: ", "\"x\""]),
            ("time = nan", ["s.toml:3: ", "finite"]),
            ("reference = \"truth\"", ["s.toml:3: ", "exact, rays"]),
            ("light = [", ["s.toml:", "array"]),
        ] {
            let message = read(lines).unwrap_err();
            assert!(
                parts.iter().all(|p| message.contains(p)),
                "{lines}: {message}"
            );
        }
    }

    #[test]
    fn suites_are_told_from_scenes() {
        assert!(is_suite(STANDARD) && is_suite("# x\n [suite] # y\nnonsense ="));
        assert!(!is_suite("[camera]\neye = [0, 0, 1]\n# not a [suite]\n"));
    }

    /// Every technique, each also at other settings where it has a knob of quality.
    #[test]
    fn the_standard_suite_has_every_technique() {
        let request = parse("standard", STANDARD, defaults()).unwrap();
        let registry = Registry::built_in();
        let suite = Suite::new(&request, &registry).unwrap();
        for technique in registry.all() {
            let own = suite
                .entries
                .iter()
                .filter(|e| e.technique.name() == technique.name());
            assert!(
                own.clone().any(|e| e.settings.is_empty()),
                "{}",
                technique.name()
            );
        }
        assert!((4..=6).contains(&suite.scenes.len()));
        for scene in ["peer-a", "creature", "demo"] {
            assert!(suite.scenes.iter().any(|s| s.name == scene), "{scene}");
        }
        assert!(suite.entries.len() > 2 * registry.all().len());
    }
}
