//! What the viewer knows, and how it changes: a pure function of what happens.

use super::event::{Action, Effect, Event, Saved};
use super::facts::Facts;
use super::fit::{Fit, points_of};
use super::look::{Look, draft_size};
use super::orbit::{Pose, STEP};
use super::studio::Drawn;

/// Rows of the terminal that say what is shown.
pub(super) const STATUS: u16 = 2;
/// Milliseconds that a frame may take while the eye moves.
const BUDGET: f64 = 40.0;
/// Pixels of a far step of the cursor.
const FAR: i32 = 10;
/// Degrees that the eye goes round for a cell that the mouse is dragged; cells are twice as
/// high as wide.
const DRAG: [f64; 2] = [2.0, 4.0];

/// What the arrows move.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// The eye.
    Orbit,
    /// The pixel that is looked at.
    Cursor,
    /// The history of the pixel, over the picture.
    History(Page),
    /// The keys, over the picture.
    Help,
}

/// Text that is too large for the screen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Page {
    /// The lines.
    pub(super) lines: Vec<String>,
    /// The first column and line that are seen.
    pub(super) at: [usize; 2],
}

/// Everything that is drawn from.
#[derive(Debug)]
pub(super) struct State {
    pub(super) facts: Facts,
    /// What is to be seen, at its full size.
    pub(super) look: Look,
    /// What is seen.
    pub(super) shown: Option<Box<Drawn>>,
    /// What is being drawn.
    pub(super) asked: Option<Look>,
    pub(super) mode: Mode,
    /// Column and row of the pixel that is looked at.
    pub(super) cursor: [u32; 2],
    /// What has to be said, until the next key.
    pub(super) notice: Vec<String>,
    /// Columns and rows of the terminal.
    pub(super) cells: [u16; 2],
    /// Pictures that were written.
    pub(super) saved: Vec<Saved>,
    /// A smaller picture than wanted was asked for last.
    is_draft: bool,
    /// Pictures that are being written.
    pub(super) saving: usize,
}

impl State {
    /// Technique number `technique` from the scene's own eye.
    pub(super) fn new(facts: Facts, technique: usize, cells: [u16; 2]) -> Self {
        let mut state = Self {
            look: Look {
                pose: None,
                technique,
                light: None,
                overlay: None,
                size: [0; 2],
            },
            facts,
            shown: None,
            asked: None,
            mode: Mode::Orbit,
            cursor: [0; 2],
            notice: Vec::new(),
            cells,
            saved: Vec::new(),
            is_draft: false,
            saving: 0,
        };
        state.look.size = state.full_size();
        state.cursor = state.look.size.map(|s| s / 2);
        state
    }

    /// What has to be done first.
    pub(super) fn start(&mut self) -> Vec<Effect> {
        self.ask(false)
    }

    /// Cells that the picture has.
    pub(super) fn room(&self) -> [u16; 2] {
        [self.cells[0], self.cells[1].saturating_sub(STATUS)]
    }

    fn full_size(&self) -> [u32; 2] {
        self.facts.size.unwrap_or(points_of(self.room()))
    }

    /// Whether what is seen is what is to be seen, whole.
    pub(super) fn is_settled(&self) -> bool {
        self.shown.as_ref().is_some_and(|s| s.look == self.look)
    }

    /// Takes notice of what happens; says what is to be done.
    pub(super) fn update(&mut self, event: Event) -> Vec<Effect> {
        match event {
            Event::Input(action) => self.act(action),
            Event::Rest => match self.is_draft {
                true => self.ask(false),
                false => Vec::new(),
            },
            Event::Drawn { look, result } => {
                self.take(&look, result);
                Vec::new()
            }
            Event::Told(result) => {
                self.tell(result);
                Vec::new()
            }
            Event::Saved(result) => {
                self.note_saved(result);
                Vec::new()
            }
        }
    }

    fn act(&mut self, action: Action) -> Vec<Effect> {
        self.notice.clear();
        match action {
            Action::Step { by, far } => self.step(by, far),
            Action::Drag { by, to } => match self.mode {
                Mode::Orbit => self.orbit([-DRAG[0], DRAG[1]], by),
                _ => self.point_at(to),
            },
            Action::Press(cell) => self.point_at(cell),
            Action::Zoom(steps) => self.moved(self.pose().zoomed(steps)),
            Action::Technique(by) => self.switch_technique(by),
            Action::Light => self.switch_light(),
            Action::Overlay(by) => {
                let look = &self.look;
                let next = (self.facts).overlay_after(look.overlay, by, look.technique);
                self.look.overlay = next;
                self.ask(false)
            }
            Action::Cursor => {
                self.mode = match self.mode {
                    Mode::Cursor => Mode::Orbit,
                    _ => Mode::Cursor,
                };
                Vec::new()
            }
            Action::Tell => self.ask_history(),
            Action::Save => self.save(),
            Action::Help => {
                self.mode = match self.mode {
                    Mode::Help => Mode::Orbit,
                    _ => Mode::Help,
                };
                Vec::new()
            }
            Action::Home => {
                self.look.pose = None;
                self.ask(false)
            }
            Action::Back => self.back(),
            Action::Quit => vec![Effect::Quit],
            Action::Resize(cells) => {
                self.cells = cells;
                self.look.size = self.full_size();
                self.keep_cursor_inside();
                self.ask(false)
            }
        }
    }

    fn pose(&self) -> Pose {
        self.look.pose.unwrap_or(self.facts.home)
    }

    fn step(&mut self, by: [i32; 2], far: bool) -> Vec<Effect> {
        match &mut self.mode {
            Mode::Orbit => {
                let step = if far { 4.0 * STEP } else { STEP };
                return self.orbit([step, -step], by);
            }
            Mode::Cursor => {
                let far = if far { FAR } else { 1 };
                for a in 0..2 {
                    self.cursor[a] = self.cursor[a].saturating_add_signed(by[a] * far);
                }
                self.keep_cursor_inside();
            }
            Mode::History(page) => {
                let far = if far { FAR as isize } else { 1 };
                for a in 0..2 {
                    page.at[a] = page.at[a].saturating_add_signed(by[a] as isize * far);
                }
                page.at[1] = page.at[1].min(page.lines.len().saturating_sub(1));
            }
            Mode::Help => {}
        }
        Vec::new()
    }

    fn keep_cursor_inside(&mut self) {
        for a in 0..2 {
            self.cursor[a] = self.cursor[a].min(self.look.size[a].saturating_sub(1));
        }
    }

    /// The eye goes `degrees` to the right and upwards for each of the steps.
    fn orbit(&mut self, degrees: [f64; 2], steps: [i32; 2]) -> Vec<Effect> {
        let [right, above] = [0, 1].map(|a| degrees[a] * f64::from(steps[a]));
        self.moved(self.pose().orbited(right, above))
    }

    fn moved(&mut self, pose: Pose) -> Vec<Effect> {
        self.look.pose = Some(pose);
        self.ask(true)
    }

    /// The pixel under a cell, where one is looked at.
    fn point_at(&mut self, cell: [u16; 2]) -> Vec<Effect> {
        let fit = Fit::new(self.look.size, self.room());
        let found = fit.and_then(|fit| fit.under(cell));
        if let (Mode::Cursor, Some(pixel)) = (&self.mode, found) {
            self.cursor = pixel;
        }
        Vec::new()
    }

    fn switch_technique(&mut self, by: i32) -> Vec<Effect> {
        let look = &mut self.look;
        let next = self.facts.technique_after(look.technique, by, look.light);
        if next == look.technique {
            self.notice = vec!["no other technique takes what shines".to_owned()];
            return Vec::new();
        }
        look.technique = next;
        let overlays = self.facts.overlays(next);
        look.overlay = look.overlay.filter(|kind| overlays.contains(kind));
        self.ask(false)
    }

    fn switch_light(&mut self) -> Vec<Effect> {
        let count = self.facts.lights;
        if count < 2 {
            self.notice = vec!["the scene has no other light".to_owned()];
            return Vec::new();
        }
        self.look.light = match self.look.light {
            None => Some(0),
            Some(light) => Some(light + 1).filter(|l| *l < count),
        };
        self.ask(false)
    }

    fn ask_history(&mut self) -> Vec<Effect> {
        if self.mode != Mode::Cursor || self.look.size.contains(&0) {
            return Vec::new();
        }
        let [x, y] = self.cursor;
        self.notice = vec![format!("drawing the history of pixel ({x}, {y})")];
        vec![Effect::Tell(self.look.clone(), self.cursor)]
    }

    fn save(&mut self) -> Vec<Effect> {
        if self.look.size.contains(&0) {
            return Vec::new();
        }
        if !self.is_settled() {
            self.notice = vec!["drawing the picture to write".to_owned()];
        }
        self.saving += 1;
        vec![Effect::Save(self.look.clone())]
    }

    fn back(&mut self) -> Vec<Effect> {
        self.mode = match self.mode {
            Mode::Orbit => return vec![Effect::Quit],
            Mode::History(_) => Mode::Cursor,
            Mode::Cursor | Mode::Help => Mode::Orbit,
        };
        Vec::new()
    }

    /// Asks for the frame that is to be seen, or for a smaller one that is there sooner.
    fn ask(&mut self, may_be_draft: bool) -> Vec<Effect> {
        if self.look.size.contains(&0) {
            return Vec::new();
        }
        let mut look = self.look.clone();
        if may_be_draft {
            look.size = draft_size(look.size, self.expected_ms(), BUDGET);
        }
        self.is_draft = look.size != self.look.size;
        self.asked = Some(look.clone());
        vec![Effect::Draw(look)]
    }

    /// What the whole frame may take, as the last one of its kind did.
    fn expected_ms(&self) -> f64 {
        let last = self.shown.as_ref().filter(|s| s.look.is_like(&self.look));
        let area = |[w, h]: [u32; 2]| f64::from(w) * f64::from(h);
        last.map_or(0.0, |s| s.ms * area(self.look.size) / area(s.look.size))
    }

    /// Shows a frame, unless something else is to be seen by now.
    fn take(&mut self, look: &Look, result: Result<Box<Drawn>, String>) {
        if self.asked.as_ref() == Some(look) {
            self.asked = None;
        }
        if !look.is_like(&self.look) {
            return;
        }
        match result {
            Ok(drawn) => self.shown = Some(drawn),
            Err(why) => {
                self.shown = None;
                self.notice = vec![why];
            }
        }
    }

    fn tell(&mut self, result: Result<Vec<String>, String>) {
        self.notice.clear();
        match result {
            Ok(lines) if self.mode == Mode::Cursor => {
                self.mode = Mode::History(Page { lines, at: [0; 2] });
            }
            Ok(_) => {}
            Err(why) => self.notice = vec![why],
        }
    }

    fn note_saved(&mut self, result: Result<Saved, String>) {
        self.saving -= 1;
        match result {
            Ok(saved) => {
                let path = saved.path.display();
                self.notice = vec![format!("wrote {path}"), saved.command.clone()];
                self.saved.push(saved);
            }
            Err(why) => self.notice = vec![why],
        }
    }
}
