//! Keys and the mouse, as what they ask for.

use crossterm::event::{
    Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseEvent, MouseEventKind,
};

use super::event::Action;

/// What each key does, for people.
pub(super) const KEYS: [[&str; 2]; 13] = [
    [
        "arrows, h j k l",
        "go round; with Shift by more. Or drag the mouse",
    ],
    ["+ -", "closer and farther away, as the wheel"],
    ["t T", "the next technique, and the one before"],
    ["L", "one light after the other alone, and all"],
    ["o O", "the next overlay, and the one before"],
    ["p, Tab", "look at one pixel: arrows and mouse move it"],
    ["Enter", "everything that happened to that pixel"],
    ["s", "write the picture, and say what makes it again"],
    ["0, Home", "the scene's own eye"],
    ["Esc", "back, and out"],
    ["?", "this"],
    ["q, Ctrl-C", "quit"],
    ["", "under a history: arrows and Page keys scroll"],
];

/// Turns what a terminal sends into what it asks for.
#[derive(Debug, Default)]
pub(super) struct Keys {
    /// Where the mouse was when it was dragged last.
    mouse: Option<[u16; 2]>,
}

impl Keys {
    /// What is asked for, if anything is.
    pub(super) fn action(&mut self, event: &Event) -> Option<Action> {
        match event {
            Event::Key(key) if key.kind != KeyEventKind::Release => of_key(key),
            Event::Mouse(mouse) => self.of_mouse(mouse),
            Event::Resize(columns, rows) => Some(Action::Resize([*columns, *rows])),
            _ => None,
        }
    }

    fn of_mouse(&mut self, mouse: &MouseEvent) -> Option<Action> {
        let at = [mouse.column, mouse.row];
        match mouse.kind {
            MouseEventKind::Down(_) => {
                self.mouse = Some(at);
                Some(Action::Press(at))
            }
            MouseEventKind::Drag(_) => {
                let from = self.mouse.replace(at)?;
                let by = [0, 1].map(|a| i32::from(at[a]) - i32::from(from[a]));
                Some(Action::Drag { by, to: at })
            }
            MouseEventKind::Up(_) => {
                self.mouse = None;
                None
            }
            MouseEventKind::ScrollUp => Some(Action::Zoom(1)),
            MouseEventKind::ScrollDown => Some(Action::Zoom(-1)),
            _ => None,
        }
    }
}

fn of_key(key: &KeyEvent) -> Option<Action> {
    let far = key.modifiers.contains(KeyModifiers::SHIFT);
    let step = |by, far| Some(Action::Step { by, far });
    if key.modifiers.contains(KeyModifiers::CONTROL) {
        return (key.code == KeyCode::Char('c')).then_some(Action::Quit);
    }
    match key.code {
        KeyCode::Left => step([-1, 0], far),
        KeyCode::Right => step([1, 0], far),
        KeyCode::Up => step([0, -1], far),
        KeyCode::Down => step([0, 1], far),
        KeyCode::PageUp => step([0, -1], true),
        KeyCode::PageDown => step([0, 1], true),
        KeyCode::Enter => Some(Action::Tell),
        KeyCode::Tab => Some(Action::Cursor),
        KeyCode::Home => Some(Action::Home),
        KeyCode::Esc => Some(Action::Back),
        KeyCode::Char(letter) => of_letter(letter),
        _ => None,
    }
}

fn of_letter(letter: char) -> Option<Action> {
    let step = |by| Action::Step { by, far: false };
    Some(match letter {
        'h' => step([-1, 0]),
        'l' => step([1, 0]),
        'k' => step([0, -1]),
        'j' => step([0, 1]),
        '+' | '=' => Action::Zoom(1),
        '-' | '_' => Action::Zoom(-1),
        't' => Action::Technique(1),
        'T' => Action::Technique(-1),
        'L' => Action::Light,
        'o' => Action::Overlay(1),
        'O' => Action::Overlay(-1),
        'p' => Action::Cursor,
        's' => Action::Save,
        '0' => Action::Home,
        '?' => Action::Help,
        'q' => Action::Quit,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use crossterm::event::MouseButton;

    use super::*;

    fn key(code: KeyCode, modifiers: KeyModifiers) -> Option<Action> {
        Keys::default().action(&Event::Key(KeyEvent::new(code, modifiers)))
    }

    #[test]
    fn keys_ask_for_what_the_help_says() {
        let plain = |code| key(code, KeyModifiers::NONE);
        let right = Action::Step {
            by: [1, 0],
            far: false,
        };
        assert_eq!(plain(KeyCode::Right), Some(right));
        assert_eq!(plain(KeyCode::Char('l')), Some(right));
        assert_eq!(plain(KeyCode::Char('k')), plain(KeyCode::Up));
        assert_eq!(plain(KeyCode::Char('T')), Some(Action::Technique(-1)));
        assert_eq!(plain(KeyCode::Char('L')), Some(Action::Light));
        assert_eq!(plain(KeyCode::Char('x')), None);
        let far = key(KeyCode::Up, KeyModifiers::SHIFT);
        assert_eq!(
            far,
            Some(Action::Step {
                by: [0, -1],
                far: true
            })
        );
        let control = |c| key(KeyCode::Char(c), KeyModifiers::CONTROL);
        assert_eq!([control('c'), control('t')], [Some(Action::Quit), None]);
        // Every key that the help names in one letter does something.
        for [names, _] in KEYS {
            let letters = names.split([' ', ',']).filter(|n| n.chars().count() == 1);
            for letter in letters.filter_map(|n| n.chars().next()) {
                assert!(of_letter(letter).is_some(), "{letter}");
            }
        }
    }

    #[test]
    fn drags_are_told_from_where_the_mouse_was_last() {
        let mut keys = Keys::default();
        let mut send = |kind, column, row| {
            keys.action(&Event::Mouse(MouseEvent {
                kind,
                column,
                row,
                modifiers: KeyModifiers::NONE,
            }))
        };
        let left = MouseButton::Left;
        assert_eq!(send(MouseEventKind::Drag(left), 3, 4), None);
        let press = send(MouseEventKind::Down(left), 10, 5);
        assert_eq!(press, Some(Action::Press([10, 5])));
        let by = |by, to| Some(Action::Drag { by, to });
        let drag = MouseEventKind::Drag(left);
        assert_eq!(send(drag, 12, 4), by([2, -1], [12, 4]));
        assert_eq!(send(drag, 12, 6), by([0, 2], [12, 6]));
        assert_eq!(send(MouseEventKind::Up(left), 12, 6), None);
        let wheel = send(MouseEventKind::ScrollDown, 1, 1);
        assert_eq!(wheel, Some(Action::Zoom(-1)));
    }
}
