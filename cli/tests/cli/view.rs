//! `gnomon view` on a terminal that `script` makes, and without one.

use std::io::{Read, Write};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

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

/// What `gnomon view` sends to a terminal while `keys` are pressed, and what is said behind
/// it: the exit code, and whether the terminal echoes again. A key that begins with `kill` is
/// a command that sends it a signal. `None` where there is no `script`.
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
    let mut stdout = script.stdout.take().unwrap();
    let shown = Arc::new(Mutex::new(Vec::<u8>::new()));
    let text = || String::from_utf8_lossy(&shown.lock().unwrap()).into_owned();
    let sent = Arc::clone(&shown);
    let reader = spawn(move || {
        let mut part = [0; 4096];
        while let Ok(count @ 1..) = stdout.read(&mut part) {
            sent.lock().unwrap().extend_from_slice(&part[..count]);
        }
    });
    for key in keys {
        // The frame between keys may not be there yet; none depends on that.
        sleep(Duration::from_millis(700));
        if key.starts_with("kill") {
            // Keys wait for a viewer that is slow to start; signals would end it.
            let start = Instant::now();
            while !text().contains(ENTER) {
                assert!(start.elapsed() < Duration::from_secs(120), "{}", text());
                sleep(Duration::from_millis(10));
            }
            let pid = std::fs::read_to_string(folder.path("pid")).unwrap();
            let line = format!("{key} {pid}");
            let kill = Command::new("sh").args(["-c", &line]).status();
            assert!(kill.unwrap().success(), "{line}");
            continue;
        }
        stdin.write_all(key.as_bytes()).unwrap();
        stdin.flush().unwrap();
    }
    script.wait_with_output().unwrap();
    drop(stdin);
    reader.join().unwrap();
    Some(text())
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

/// Whoever has left waits for what is being written, unless a signal says not to.
#[test]
fn signals_end_the_wait_for_pictures() {
    let folder = Folder::new("view-signals-late");
    let slow = "--technique sampled-shadow-volumes:samples=4096 --size 2400x1800";
    let Some(seen) = seen(&folder, slow, &["s", "q", "", "kill -TERM"]) else {
        return;
    };
    let after = afterwards(&seen);
    assert!(after.contains("code=143"), "{after}");
    assert!(!after.contains("wrote"), "{after}");
    assert!(!folder.path("out").exists());
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
