//! `gnomon view` on a terminal that `script` makes, and without one.

use std::io::Write;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::common::Folder;

#[test]
fn without_a_terminal_it_says_what_to_do() {
    let folder = Folder::new("view-none");
    let view = "view cylinder --size 20x10";
    folder
        .gnomon(view)
        .refused(&["draws on a terminal", "gnomon render"]);
    folder
        .gnomon("view cylinder --frames 3")
        .refused(&["--frames", "--time"]);
    assert!(folder.names().is_empty());
}

/// What `gnomon view` sends to a terminal while `keys` are pressed, or it is sent a signal by
/// a command that begins with `kill`, and what is said behind it: the exit code, and whether the terminal echoes again. `None` where there is no
/// `script`.
fn seen(folder: &Folder, flags: &str, keys: &[&str]) -> Option<String> {
    let line = format!(
        "stty rows 20 cols 80; sh -c 'echo $$ >pid; exec \"$0\" view cylinder {flags}' '{}'; \
         echo code=$?; stty -a",
        env!("CARGO_BIN_EXE_gnomon")
    );
    let mut script = Command::new("script");
    script.args(["-qec", &line, "/dev/null"]);
    script.current_dir(folder.path("."));
    script
        .env("TERM", "xterm-256color")
        .env("COLORTERM", "truecolor");
    script.stdin(Stdio::piped()).stdout(Stdio::piped());
    let Ok(mut script) = script.stderr(Stdio::piped()).spawn() else {
        eprintln!("skipped: there is no script");
        return None;
    };
    let mut stdin = script.stdin.take().unwrap();
    for key in keys {
        // The frame between keys may not be there yet; none depends on that.
        sleep(Duration::from_millis(700));
        if key.starts_with("kill") {
            let pid = std::fs::read_to_string(folder.path("pid")).unwrap();
            let (shell, line) = ("sh", format!("{key} {pid}"));
            assert!(
                Command::new(shell)
                    .args(["-c", &line])
                    .status()
                    .unwrap()
                    .success()
            );
            continue;
        }
        stdin.write_all(key.as_bytes()).unwrap();
        stdin.flush().unwrap();
    }
    let output = script.wait_with_output().unwrap();
    drop(stdin);
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

const ENTER: &str = "\u{1b}[?1049h";
const LEAVE: &str = "\u{1b}[?1049l";

/// What is said behind the viewer's screen.
fn afterwards(seen: &str) -> &str {
    assert!(seen.contains(ENTER), "{seen}");
    let (_, after) = seen.rsplit_once(LEAVE).expect("the screen is given back");
    assert!(after.contains("\u{1b}[?25h"), "the cursor is shown");
    assert!(
        after.contains(" echo ") && after.contains(" icanon "),
        "{after}"
    );
    after
}

#[test]
fn keys_are_heard_and_the_terminal_is_given_back() {
    let folder = Folder::new("view-keys");
    let Some(seen) = seen(&folder, "", &["s", "\u{1b}[C", "t", "p", "\r", "\u{3}"]) else {
        return;
    };
    assert!(
        seen.contains("▀") && seen.contains("\u{1b}[38;2;"),
        "{seen}"
    );
    let after = afterwards(&seen);
    assert!(after.contains("code=0"), "{after}");
    let told = "wrote out/cylinder-shadow-volumes-view-1.png";
    assert!(after.contains(told), "{after}");
    let command = after
        .lines()
        .find(|l| l.trim().starts_with("gnomon render"));
    let command = command.unwrap().trim().trim_start_matches("gnomon ");
    assert!(command.contains("--size=80x36"), "{command}");
    let picture = folder.path("out/cylinder-shadow-volumes-view-1.png");
    let ours = std::fs::read(&picture).unwrap();
    std::fs::remove_file(&picture).unwrap();
    folder.gnomon(command).fine();
    assert!(ours == std::fs::read(&picture).unwrap(), "{command}");
}

/// Whoever ends the viewer from outside finds the terminal as it was, and sees a signal.
#[test]
fn signals_give_the_terminal_back() {
    let folder = Folder::new("view-signals");
    for (kill, code) in [("kill -TERM", 143), ("kill -HUP", 129)] {
        let Some(seen) = seen(&folder, "", &["", kill]) else {
            return;
        };
        let after = afterwards(&seen);
        assert!(after.contains(&format!("code={code}")), "{after}");
    }
}

/// A frame that cannot be had is said on the screen; the terminal is given back all the same.
#[test]
fn errors_leave_the_terminal_as_it_was() {
    let folder = Folder::new("view-errors");
    let Some(seen) = seen(&folder, "--set light=7", &["", "q"]) else {
        return;
    };
    assert!(seen.contains("light 7"), "{seen}");
    assert!(afterwards(&seen).contains("code=0"));
    let none = self::seen(&folder, "--eye 0,1,0 --target 0,1,0", &[]).unwrap();
    assert!(none.contains("code=2") && !none.contains(ENTER), "{none}");
}
