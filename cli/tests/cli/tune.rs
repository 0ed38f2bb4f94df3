//! What `tune` finds, says and refuses.

use serde_json::Value;

use crate::common::Folder;

const SMALL: &str = "tune two-box --size 64x48 --threads 1 \
    --techniques unshadowed,shadow-volumes,pcf,soft-shadow-volumes";

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap()
}

/// The winner keeps the limit, and its command renders what was measured.
#[test]
fn the_winner_keeps_the_error_and_its_command_renders_it() {
    let folder = Folder::new("tune-error");
    let run = folder
        .gnomon(&format!("{SMALL} --max-error 0.05 --json"))
        .fine();
    let text = run.stderr();
    assert!(text.contains("The winner, measured anew"), "{text}");
    let doc = run.json();
    let winner = &doc["winner"];
    assert!(
        number(winner, "rmse") <= 0.05 && number(winner, "time_ms") > 0.0,
        "{winner}"
    );
    assert!(doc["tried"].as_u64().unwrap() > 20, "{doc}");
    for other in doc["runners_up"].as_array().unwrap() {
        assert!(number(other, "rmse") <= 0.05, "{other}");
    }
    let command = winner["command"].as_str().unwrap();
    assert!(text.replace("\n    ", " ").contains(command), "{text}");
    let flags = command.strip_prefix("gnomon ").unwrap();
    folder.gnomon(&format!("{flags} --out a.png")).fine();
    let mut entry = winner["technique"].as_str().unwrap().to_owned();
    for (key, value) in winner["params"].as_object().unwrap() {
        entry += &format!(":{key}={}", value.as_str().unwrap());
    }
    let compared = folder
        .gnomon(&format!(
            "compare two-box --size 64x48 --techniques {entry} --json"
        ))
        .json();
    let result = &compared["results"][0];
    let close = (number(result, "rmse") - number(winner, "rmse")).abs();
    assert!(close < 1e-12, "{result}");
    assert_eq!(result["bytes"], winner["bytes"]);
}

#[test]
fn a_budget_of_bytes_is_kept_at_the_least_error() {
    let folder = Folder::new("tune-bytes");
    let doc = folder
        .gnomon(&format!("{SMALL} --max-bytes 400000 --json"))
        .json();
    let winner = &doc["winner"];
    assert!(number(winner, "bytes") <= 400_000.0, "{winner}");
    let others = doc["runners_up"].as_array().unwrap();
    assert!(!others.is_empty());
    for other in others {
        assert!(number(other, "rmse") >= number(winner, "rmse"), "{other}");
        assert!(number(other, "bytes") <= 400_000.0, "{other}");
    }
}

/// Over an animation the largest figures count: at least those of its first frame.
#[test]
fn frames_of_an_animation_all_keep_the_budget() {
    let folder = Folder::new("tune-frames");
    let of = |frames: &str| {
        let line = "tune walk --size 32x24 --threads 1 --techniques unshadowed --max-bytes 1e9";
        folder.gnomon(&format!("{line} {frames} --json")).json()
    };
    let (one, five) = (of(""), of("--frames 5 --fps 2"));
    assert_eq!((&one["frames"], &five["frames"]), (&1.into(), &5.into()));
    assert!(number(&five["winner"], "rmse") > number(&one["winner"], "rmse"));
    // The largest is that of the second frame, neither the first nor the last.
    let rmse = |time: &str| number(&of(&format!("--time {time}"))["winner"], "rmse");
    let each = ["0", "0.5", "1", "1.5", "2"].map(rmse);
    assert!(each[1] > each[0] && each[1] > each[4], "{each:?}");
    assert_eq!(number(&five["winner"], "rmse"), each[1]);
}

#[test]
fn that_nothing_fits_is_said() {
    let folder = Folder::new("tune-none");
    let run = folder
        .gnomon(&format!("{SMALL} --max-error 1e-9 --json"))
        .fine();
    assert!(
        run.stderr()
            .contains("Nothing that was tried keeps this budget"),
        "{}",
        run.stderr()
    );
    let doc = run.json();
    assert_eq!(doc["winner"], Value::Null);
    let nearest = doc["runners_up"].as_array().unwrap();
    assert!(!nearest.is_empty() && nearest.iter().all(|n| number(n, "rmse") > 1e-9));
}

#[test]
fn bad_input_is_refused_and_leaves_nothing() {
    let folder = Folder::new("tune-bad");
    for (arguments, parts) in [
        ("tune two-box", ["--max-error", "required"]),
        ("tune two-box --max-error 0", ["--max-error", "above 0"]),
        ("tune two-box --max-ms fast", ["--max-ms", "fast"]),
        ("tune nowhere --max-ms 1", ["'nowhere'", "two-box"]),
        (
            "tune two-box --max-ms 1 --techniques pcff",
            ["'pcff'", "pcf"],
        ),
        ("tune two-box --max-ms 1 --light 4", ["light 4", "has 1"]),
        ("tune two-box --max-ms 1 --frames 0", ["--frames", "1"]),
        (
            "tune walk --max-ms 1 --frames 2 --fps 1e-320",
            ["--fps", "finite"],
        ),
    ] {
        folder.gnomon(arguments).refused(&parts);
        assert!(folder.names().is_empty(), "{arguments}");
    }
}
