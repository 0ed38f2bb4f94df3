//! The viewer without a terminal: what happens goes in, cells and effects come out.

mod cells;
mod effects;
mod same_bits;

use std::time::Duration;

use clap::Parser;
use gnomon_pipeline::techniques::Registry;
use ratatui_core::backend::TestBackend;
use ratatui_core::buffer::Buffer;
use ratatui_core::terminal::Terminal;

use super::args::ViewerArgs;
use super::blocks::Palette;
use super::event::{Action, Effect, Event};
use super::screen;
use super::state::State;
use super::studio::Studio;
use crate::command_line::{Cli, Verb};

/// A viewer whose frames are drawn at once.
pub(super) struct Bench {
    pub(super) studio: Studio,
    pub(super) state: State,
}

pub(super) fn arguments(line: &str) -> Box<ViewerArgs> {
    let words = ["gnomon", "view"].into_iter().chain(line.split(' '));
    match Cli::try_parse_from(words).unwrap().verb {
        Verb::View(args) => args,
        other => panic!("{other:?}"),
    }
}

impl Bench {
    /// Of `gnomon view LINE` on so many cells, before the first frame.
    pub(super) fn new(line: &str, cells: [u16; 2]) -> Self {
        let (studio, technique) = Studio::new(&arguments(line), &Registry::built_in()).unwrap();
        let facts = studio.facts().unwrap();
        Self {
            studio,
            state: State::new(facts, technique, cells),
        }
    }

    /// The same with the first frame.
    pub(super) fn started(line: &str, cells: [u16; 2]) -> Self {
        let mut bench = Self::new(line, cells);
        let effects = bench.state.start();
        bench.answer(effects);
        bench
    }

    /// Asks for something; gives what is to be done.
    pub(super) fn ask(&mut self, action: Action) -> Vec<Effect> {
        self.state.update(Event::Input(action))
    }

    /// Asks for something and has it drawn.
    pub(super) fn press(&mut self, action: Action) {
        let effects = self.ask(action);
        self.answer(effects);
    }

    /// Draws what is to be drawn, and takes it.
    pub(super) fn answer(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            let event = match effect {
                Effect::Draw(look) => Event::Drawn {
                    result: (self.studio.draw(&look).map(Box::new)).map_err(|e| e.to_string()),
                    look,
                },
                Effect::Tell(look, pixel) => {
                    let told = self.studio.history(&look, pixel);
                    Event::Told(told.map_err(|e| e.to_string()))
                }
                Effect::Save(_) | Effect::Quit => continue,
            };
            let more = self.state.update(event);
            self.answer(more);
        }
    }

    /// The cells of a terminal of the state's size.
    pub(super) fn cells(&self) -> Buffer {
        let [width, height] = self.state.cells;
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        let drawn = terminal.draw(|frame| {
            screen::draw(
                &self.state,
                Duration::from_secs(1),
                Palette::True,
                frame.buffer_mut(),
            );
        });
        drawn.unwrap().buffer.clone()
    }

    /// The cells as text, a line each.
    pub(super) fn text(&self) -> Vec<String> {
        let cells = self.cells();
        let row = |y| {
            (0..cells.area.width)
                .map(|x| cells[(x, y)].symbol().to_owned())
                .collect()
        };
        (0..cells.area.height).map(row).collect()
    }
}

/// To the right and down.
pub(super) fn step(right: i32, down: i32) -> Action {
    Action::Step {
        by: [right, down],
        far: false,
    }
}
