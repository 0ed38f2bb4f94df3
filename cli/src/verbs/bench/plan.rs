//! From a suite to its cells, in order, each once.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read};

use gnomon_raster::MAX_THREADS;

use super::stored::{Cell, FORMAT, Plan};
use super::suite::{Entry, Subject, Suite, too_many};
use crate::error::CliError;

/// A cell, and where in the suite its parts are.
pub(super) struct Task {
    pub(super) cell: Cell,
    /// Number of the scene.
    pub(super) scene: usize,
    /// Number of the technique with parameters.
    pub(super) entry: usize,
}

/// What is measured by which program.
pub(super) struct Planned {
    pub(super) plan: Plan,
    /// In the order of the plan's cells.
    pub(super) tasks: Vec<Task>,
}

impl Planned {
    /// All cells of `suite`: scenes, then sizes, then threads, then techniques. Cells
    /// that come to the same are one.
    pub(super) fn new(suite: &Suite) -> Result<Self, CliError> {
        let counts = [suite.scenes.len(), suite.sizes.len(), suite.threads.len()];
        let all = counts
            .iter()
            .try_fold(suite.entries.len(), |n, c| n.checked_mul(*c));
        if let Some(problem) = too_many(all) {
            let place = suite.name.clone();
            return Err(CliError::Suite { place, problem });
        }
        let build = build_hash().map_err(|e| {
            CliError::Check(format!("the program cannot read its own executable: {e}"))
        })?;
        let mut plan = Plan {
            suite: suite.name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            build,
            repeat: suite.repeat,
            light: suite.light,
            reference: suite.reference.name().to_owned(),
            cells: Vec::new(),
        };
        let tasks = tasks(suite, &plan);
        plan.cells = tasks.iter().map(|t| t.cell.clone()).collect();
        Ok(Self { plan, tasks })
    }
}

fn tasks(suite: &Suite, plan: &Plan) -> Vec<Task> {
    let mut tasks = Vec::new();
    let mut known = BTreeSet::new();
    for (scene, subject) in suite.scenes.iter().enumerate() {
        for &size in &suite.sizes {
            for &threads in &suite.threads {
                for (entry, of) in suite.entries.iter().enumerate() {
                    let cell = cell(plan, subject, of, size, resolve(threads));
                    if known.insert(cell.key.clone()) {
                        tasks.push(Task { cell, scene, entry });
                    }
                }
            }
        }
    }
    tasks
}

/// 0 stands for the threads that the program has started with.
fn resolve(threads: usize) -> usize {
    match threads {
        0 => rayon::current_num_threads().min(MAX_THREADS),
        n => n,
    }
}

fn cell(plan: &Plan, subject: &Subject, entry: &Entry, size: [u32; 2], threads: usize) -> Cell {
    let params = entry.params.iter();
    let mut cell = Cell {
        key: String::new(),
        scene: subject.name.clone(),
        technique: entry.technique.name().to_owned(),
        settings: entry.settings.clone(),
        params: params.map(|(k, v)| (k.to_owned(), v.to_owned())).collect(),
        size,
        threads,
    };
    cell.key = key(plan, &subject.hash, &cell);
    cell
}

/// Hash of everything that decides a result: scene, technique, parameters, size,
/// threads, how it is measured, and the program that does.
fn key(plan: &Plan, scene_hash: &str, cell: &Cell) -> String {
    let mut text = format!(
        "gnomon bench {FORMAT}\n{} {}\nscene {} {scene_hash}\nlight {} {}\nrepeat {}\n\
         size {} {}\nthreads {}\ntechnique {}\n",
        plan.version,
        plan.build,
        cell.scene,
        plan.light,
        plan.reference,
        plan.repeat,
        cell.size[0],
        cell.size[1],
        cell.threads,
        cell.technique,
    );
    for (name, value) in &cell.params {
        text += &format!("{name}={value}\n");
    }
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// Which build this is, in 16 digits: another one may measure something else.
fn build_hash() -> io::Result<String> {
    let mut file = File::open(std::env::current_exe()?)?;
    let mut hasher = blake3::Hasher::new();
    let mut part = vec![0; 1 << 20];
    loop {
        match file.read(&mut part)? {
            0 => break,
            n => hasher.update(&part[..n]),
        };
    }
    Ok(hasher.finalize().to_hex()[..16].to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan() -> Plan {
        Plan {
            suite: "s".to_owned(),
            version: "1".to_owned(),
            build: "b".to_owned(),
            repeat: 5,
            light: 0,
            reference: "exact".to_owned(),
            cells: Vec::new(),
        }
    }

    fn plain() -> Cell {
        Cell {
            key: String::new(),
            scene: "demo".to_owned(),
            technique: "pcf".to_owned(),
            settings: Vec::new(),
            params: vec![("taps".to_owned(), "4".to_owned())],
            size: [64, 48],
            threads: 1,
        }
    }

    /// Whatever decides a result is in its key; the suite's name is not.
    #[test]
    fn keys_tell_apart_what_may_differ() {
        type Change = fn(&mut Plan, &mut Cell, &mut String);
        let changes: [Change; 11] = [
            |_, _, _| {},
            |p, _, _| p.version = "2".to_owned(),
            |p, _, _| p.build = "c".to_owned(),
            |p, _, _| p.repeat = 6,
            |p, _, _| p.light = 1,
            |p, _, _| p.reference = "rays".to_owned(),
            |_, c, _| c.technique = "pcss".to_owned(),
            |_, c, _| c.params[0].1 = "5".to_owned(),
            |_, c, _| c.size = [48, 64],
            |_, c, _| c.threads = 2,
            |_, _, hash| *hash = "other".to_owned(),
        ];
        let key_after = |change: &Change| {
            let (mut plan, mut cell, mut hash) = (plan(), plain(), "hash".to_owned());
            change(&mut plan, &mut cell, &mut hash);
            key(&plan, &hash, &cell)
        };
        let mut keys: Vec<String> = changes.iter().map(key_after).collect();
        let named: Change = |p, _, _| p.suite = "another".to_owned();
        assert_eq!(keys[0], key_after(&named));
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), changes.len());
    }

    #[test]
    fn a_program_has_one_hash() {
        let hash = build_hash().unwrap();
        assert_eq!((hash.len(), build_hash().unwrap()), (16, hash));
    }
}
