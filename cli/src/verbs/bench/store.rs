//! The folder of a benchmark: its plan and a file for each cell.

use std::path::{Path, PathBuf};

use super::envelope;
use super::stored::{Cell, Plan, Stored};
use crate::error::CliError;
use crate::output::files::Batch;

/// A folder with results.
pub(super) struct Store {
    folder: PathBuf,
}

/// What there is of a cell.
pub(super) enum Kept {
    /// Nothing.
    Nothing,
    /// Its result.
    Result(Box<Stored>),
    /// A file that cannot be used, and why.
    Broken(PathBuf, String),
}

const PLAN: &str = "plan";
const CELL: &str = "cell";

impl Store {
    pub(super) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
        }
    }

    /// Where a file of that name lies.
    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The plan.
    pub(super) fn plan(&self) -> Result<Plan, CliError> {
        let path = self.plan_path();
        let found = envelope::open(PLAN, &path).and_then(|found| {
            found.ok_or_else(|| {
                "there is no such file: is this a folder of `gnomon bench`?".to_owned()
            })
        });
        found.map_err(|problem| CliError::Results { path, problem })
    }

    /// Puts the plan there.
    pub(super) fn put_plan(&self, plan: &Plan) -> Result<(), CliError> {
        put(PLAN, &self.plan_path(), plan)
    }

    /// What there is of `cell`.
    pub(super) fn cell(&self, cell: &Cell) -> Kept {
        let path = self.cell_path(&cell.key);
        match envelope::open::<Stored>(CELL, &path) {
            Ok(None) => Kept::Nothing,
            Ok(Some(stored)) if stored.key == cell.key => Kept::Result(Box::new(stored)),
            Ok(Some(_)) => Kept::Broken(path, "it is the result of another cell".to_owned()),
            Err(problem) => Kept::Broken(path, problem),
        }
    }

    /// Puts a cell's result there, whole or not at all.
    pub(super) fn put_cell(&self, stored: &Stored) -> Result<(), CliError> {
        put(CELL, &self.cell_path(&stored.key), stored)
    }

    /// Where the plan lies.
    pub(super) fn plan_path(&self) -> PathBuf {
        self.path("bench.plan")
    }

    /// Where the result of the cell called `key` lies.
    pub(super) fn cell_path(&self, key: &str) -> PathBuf {
        self.folder.join("cells").join(format!("{key}.cell"))
    }
}

fn put(kind: &str, path: &Path, value: &impl serde::Serialize) -> Result<(), CliError> {
    let bytes = envelope::seal(kind, value).map_err(|e| CliError::Write {
        path: path.to_owned(),
        source: e.into(),
    })?;
    let mut batch = Batch::default();
    batch.stage(path, &bytes)?;
    batch.commit()
}
