//! What `reproduce` prints, writes and refuses.

use crate::common::Folder;
use serde_json::Value;

const SMALL: &str = "--size 96x72 --repeat 1";

#[test]
fn claims_are_listed_and_not_measured() {
    let folder = Folder::new("reproduce-list");
    let text = folder.gnomon("reproduce --list").fine().stdout();
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    let doc = folder.gnomon("reproduce --list --json").json();
    let claims = doc["claims"].as_array().unwrap();
    assert!(claims.len() >= 50);
    for claim in claims {
        let id = claim["id"].as_str().unwrap();
        assert!(text.contains(id) && claim["finding"].is_null(), "{id}");
        for key in ["source", "statement", "verdict"] {
            assert!(!claim[key].as_str().unwrap().is_empty(), "{id}: {key}");
        }
    }
    for letter in ["A", "B", "C", "D"] {
        assert!(claims.iter().any(|c| c["verdict"] == letter), "{letter}");
    }
    assert!(folder.names().is_empty());
}

/// The one claim of a document.
fn only(doc: &Value) -> &Value {
    let claims = doc["claims"].as_array().unwrap();
    assert_eq!(claims.len(), 1);
    &claims[0]
}

#[test]
fn a_claim_shows_theirs_and_ours_and_writes_its_plots() {
    let folder = Folder::new("reproduce-one");
    let run = folder.gnomon(&format!("reproduce paper2-tile-size {SMALL} --json"));
    let text = run.stderr();
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    for part in [
        "theirs",
        "ours",
        "counted:",
        "8-32",
        "wrote out/paper2-tile-size.svg",
    ] {
        assert!(text.contains(part), "no {part} in {text}");
    }
    let doc = run.json();
    let claim = only(&doc);
    assert_eq!(
        (&doc["size"], &claim["verdict"]),
        (&serde_json::json!([96, 72]), &"B".into())
    );
    let finding = &claim["finding"];
    for measure in finding["measures"].as_array().unwrap() {
        assert!(measure["ours"].as_f64().unwrap() >= 2.0, "{measure}");
        assert_eq!(measure["theirs"], "8-32");
    }
    assert!(finding["counted"].as_str().unwrap().contains(" B"));
    let files = claim["files"].as_array().unwrap();
    assert_eq!(files.len(), 2);
    let picture = image::open(folder.path("out/paper2-tile-size.png")).unwrap();
    let svg = std::fs::read_to_string(folder.path("out/paper2-tile-size.svg")).unwrap();
    assert!(svg.contains(&format!("width=\"{}\"", picture.width())));
    assert!(svg.contains("columns, single") && !svg.contains("NaN"));
}

/// A failing claim is a result: exit code 0, `does not hold`, and the reason.
#[test]
fn a_claim_that_does_not_hold_says_why() {
    let folder = Folder::new("reproduce-fails");
    let run = folder.gnomon("reproduce paper2-overlaps").fine();
    let text = run.stdout();
    assert!(
        text.contains("-> does not hold") && text.contains("why: "),
        "{text}"
    );
    let doc = folder.gnomon("reproduce paper2-overlaps --json").json();
    let finding = &only(&doc)["finding"];
    assert_eq!(
        (&finding["judgement"], &finding["direction"]),
        (&"does not hold".into(), &false.into())
    );
    assert!(
        finding["reason"]
            .as_str()
            .unwrap()
            .contains("127 and a half")
    );
    // Their own table speaks against it; a part of a table is measured unless asked.
    let doc = folder
        .gnomon("reproduce annen-missing-entries --json")
        .json();
    let finding = &only(&doc)["finding"];
    assert_eq!(
        (&doc["full"], &finding["direction"]),
        (&false.into(), &false.into())
    );
    assert!(finding["reason"].as_str().unwrap().contains("1.4 GB"));
    let holding = folder.gnomon("reproduce paper4-table-memory --json").json();
    let finding = &only(&holding)["finding"];
    assert_eq!(
        (&finding["rough_size"], &finding["reason"]),
        (&true.into(), &Value::Null)
    );
}

#[test]
fn quoted_claims_are_shown_as_such() {
    let folder = Folder::new("reproduce-quoted");
    let text = folder
        .gnomon("reproduce paper3-frame-rates")
        .fine()
        .stdout();
    assert!(
        text.contains("quoted only") && text.contains("[D]"),
        "{text}"
    );
}

#[test]
fn bad_input_is_refused_and_leaves_nothing() {
    let folder = Folder::new("reproduce-bad");
    let refused = |arguments: &str, parts: &[&str]| {
        folder.gnomon(arguments).refused(parts);
        assert!(folder.names().is_empty(), "{arguments}");
    };
    refused(
        "reproduce paper2-culing",
        &["did you mean 'paper2-culling'", "paper5-even-degree"],
    );
    refused("reproduce paper2-culling --size 0x4", &["WIDTHxHEIGHT"]);
    refused("reproduce paper2-culling --repeat 0", &["--repeat"]);
    refused(
        "reproduce paper2-overlaps --out-dir /dev/null",
        &["/dev/null"],
    );
}
