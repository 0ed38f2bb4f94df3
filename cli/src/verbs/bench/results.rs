//! A plan with what there is of its cells.

use std::path::PathBuf;

use super::store::{Kept, Store};
use super::stored::{Cell, Measured, Outcome, Plan};

/// Everything that is known.
pub(super) struct Results {
    pub(super) plan: Plan,
    /// In the order of the plan's cells; `None` where a cell was not measured yet.
    pub(super) outcomes: Vec<Option<Outcome>>,
}

/// Cells that can be held against each other: of one scene, size and number of threads.
pub(super) struct Group<'a> {
    pub(super) scene: &'a str,
    pub(super) size: [u32; 2],
    pub(super) threads: usize,
    pub(super) rows: Vec<Row<'a>>,
}

/// A cell that was measured.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    pub(super) cell: &'a Cell,
    pub(super) measured: &'a Measured,
}

impl Row<'_> {
    /// The error of visibility, where there is one.
    pub(super) fn rmse(&self) -> Option<f64> {
        self.measured.found.rmse.map(|e| e.0)
    }
}

impl Results {
    /// What lies in `store`; files that cannot be used are as if they were not there.
    pub(super) fn gather(plan: Plan, store: &Store) -> (Self, Vec<(PathBuf, String)>) {
        let mut broken = Vec::new();
        let outcome = |cell: &Cell| match store.cell(cell) {
            Kept::Nothing => None,
            Kept::Result(stored) => Some(stored.outcome),
            Kept::Broken(path, problem) => {
                broken.push((path, problem));
                None
            }
        };
        let outcomes = plan.cells.iter().map(outcome).collect();
        (Self { plan, outcomes }, broken)
    }

    /// Cells with what there is of them.
    pub(super) fn cells(&self) -> impl Iterator<Item = (&Cell, Option<&Outcome>)> {
        let outcomes = self.outcomes.iter().map(Option::as_ref);
        self.plan.cells.iter().zip(outcomes)
    }

    /// Cells without a result.
    pub(super) fn missing(&self) -> usize {
        self.outcomes.iter().filter(|o| o.is_none()).count()
    }

    /// Cells that were refused, with the reason.
    pub(super) fn refused(&self) -> impl Iterator<Item = (&Cell, &str)> {
        self.cells().filter_map(|(cell, outcome)| match outcome {
            Some(Outcome::Refused(why)) => Some((cell, why.as_str())),
            _ => None,
        })
    }

    /// What was measured, in the plan's order.
    pub(super) fn groups(&self) -> Vec<Group<'_>> {
        let mut groups: Vec<Group<'_>> = Vec::new();
        for (cell, outcome) in self.cells() {
            let Some(Outcome::Measured(measured)) = outcome else {
                continue;
            };
            let row = Row { cell, measured };
            match groups.iter_mut().find(|g| g.holds(cell)) {
                Some(group) => group.rows.push(row),
                None => groups.push(Group {
                    scene: &cell.scene,
                    size: cell.size,
                    threads: cell.threads,
                    rows: vec![row],
                }),
            }
        }
        groups
    }
}

impl Group<'_> {
    /// Whether `cell` belongs to it.
    pub(super) fn holds(&self, cell: &Cell) -> bool {
        (self.scene, self.size, self.threads) == (cell.scene.as_str(), cell.size, cell.threads)
    }

    /// For titles: `peer-a, 320x240, 2 threads`.
    pub(super) fn title(&self) -> String {
        let [width, height] = self.size;
        format!("{}, {width}x{height}, {}", self.scene, self.threads_text())
    }

    /// `1 thread`, `2 threads`.
    pub(super) fn threads_text(&self) -> String {
        match self.threads {
            1 => "1 thread".to_owned(),
            n => format!("{n} threads"),
        }
    }

    /// For names of files: `peer-a-320x240-2`.
    pub(super) fn stem(&self) -> String {
        let [width, height] = self.size;
        format!("{}-{width}x{height}-{}", self.scene, self.threads)
    }
}
