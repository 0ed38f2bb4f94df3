//! From the command line to results and tables.

use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::truth::oracle::cache::OracleCache;

use super::args::{BenchArgs, BenchVerb};
use super::document::BenchDocument;
use super::measure::Bench;
use super::pace::Pace;
use super::plan::{Planned, Task};
use super::publish::publish;
use super::request::request;
use super::results::Results;
use super::store::{Kept, Store};
use super::stored::{Outcome, Plan, Stored};
use super::suite::Suite;
use super::{merge, text};
use crate::error::CliError;
use crate::output;
use crate::output::files;
use crate::output::numbers::{error, milliseconds};

/// Measures what has no result yet, and writes everything that is made of results.
pub(crate) fn run(args: &BenchArgs, registry: &Registry) -> Result<(), CliError> {
    if let Some(BenchVerb::Merge(args)) = &args.verb {
        let (results, store) = merge::merge(args)?;
        return finish(&results, &store, args.json);
    }
    files::check_folder("--out-dir", &args.out_dir)?;
    let suite = Suite::new(&request(args)?, registry)?;
    let planned = Planned::new(&suite)?;
    let store = Store::new(&args.out_dir);
    store.put_plan(&planned.plan)?;
    measure_missing(args, &suite, &planned, &store)?;
    let (results, _) = Results::gather(planned.plan, &store);
    finish(&results, &store, args.json)
}

fn finish(results: &Results, store: &Store, json: bool) -> Result<(), CliError> {
    let files = publish(results, store)?;
    if json {
        output::print_json(&BenchDocument::new(results))?;
    }
    output::print_summary(&text::summarise(results, &files), json)
}

/// The shard's tasks without a usable result, and what is wrong with the unusable.
fn missing<'a>(
    args: &BenchArgs,
    planned: &'a Planned,
    store: &Store,
) -> (Vec<&'a Task>, Vec<String>) {
    let (mut tasks, mut notes) = (Vec::new(), Vec::new());
    let own = planned.tasks.iter().enumerate();
    for (_, task) in own.filter(|(k, _)| args.shard.takes(*k)) {
        match store.cell(&task.cell) {
            Kept::Result(_) => continue,
            Kept::Nothing => {}
            Kept::Broken(path, problem) => {
                notes.push(format!("{}: {problem}; measured again", path.display()));
            }
        }
        tasks.push(task);
    }
    (tasks, notes)
}

fn measure_missing(
    args: &BenchArgs,
    suite: &Suite,
    planned: &Planned,
    store: &Store,
) -> Result<(), CliError> {
    let (mut tasks, notes) = missing(args, planned, store);
    let limit = args.limit.map_or(tasks.len(), |n| n as usize);
    tasks.truncate(limit);
    let cache = args.cache_dir.clone();
    let cache = cache.unwrap_or_else(|| args.out_dir.join("oracle-cache"));
    let mut bench = Bench::new(suite, OracleCache::new(cache));
    let mut pace = Pace::new(tasks.len());
    for note in notes {
        pace.say(&format!("warning: {note}"));
    }
    for task in tasks {
        pace.doing(&name(&planned.plan, task));
        for warning in bench.prepare(task)? {
            pace.say(&format!("warning: {warning}"));
        }
        let stored = bench.measure(task)?;
        store.put_cell(&stored)?;
        pace.done(&format!("{}: {}", name(&planned.plan, task), say(&stored)));
    }
    Ok(())
}

/// What is measured, as short as it is clear.
fn name(plan: &Plan, task: &Task) -> String {
    let cell = &task.cell;
    let mut name = format!("{} {}", cell.scene, cell.label());
    if plan.cells.iter().any(|c| c.size != cell.size) {
        name += &format!(" {}x{}", cell.size[0], cell.size[1]);
    }
    if plan.cells.iter().any(|c| c.threads != cell.threads) {
        name += &format!(" threads={}", cell.threads);
    }
    name
}

fn say(stored: &Stored) -> String {
    match &stored.outcome {
        Outcome::Refused(why) => format!("refused: {why}"),
        Outcome::Measured(m) => {
            let rmse = m.found.rmse.map_or("none".to_owned(), |e| error(e.0));
            format!("{}, RMSE {rmse}", milliseconds(m.time.frame()))
        }
    }
}
