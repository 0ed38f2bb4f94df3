//! What `render` says of every draw.

use serde_json::Value;

use crate::common::Folder;

const SHOT: &str = "render demo --size 64x48 --out a.png";

/// Sums of the whole numbers below `values`, by their path.
fn sums<'a>(values: impl Iterator<Item = &'a Value>) -> Vec<(String, u64)> {
    let mut sums = std::collections::BTreeMap::new();
    for value in values {
        add(&mut sums, "", value);
    }
    sums.into_iter().filter(|(_, n)| *n > 0).collect()
}

fn add(sums: &mut std::collections::BTreeMap<String, u64>, path: &str, value: &Value) {
    match value {
        Value::Number(n) => *sums.entry(path.to_owned()).or_default() += n.as_u64().unwrap(),
        Value::Object(fields) => {
            for (key, value) in fields {
                add(sums, &format!("{path}/{key}"), value);
            }
        }
        _ => (),
    }
}

const SUMMED: [&str; 6] = [
    "primitives",
    "tiles",
    "fragments",
    "fragment_shader_invocations",
    "events",
    "traffic",
];

/// Every counter of the draws adds up to that of its pass, and of the frame.
#[test]
fn draws_add_up_to_passes_and_frame() {
    let doc = Folder::new("per-draw")
        .gnomon(&format!("{SHOT} --json --per draw"))
        .json();
    let draws = doc["draws"].as_array().unwrap();
    for key in SUMMED {
        let all = sums(draws.iter().map(|d| &d[key]));
        assert_eq!(all, sums([&doc["totals"][key]].into_iter()), "{key}");
        for (number, pass) in doc["passes"].as_array().unwrap().iter().enumerate() {
            let of_pass = draws.iter().filter(|d| d["pass"] == number);
            let of_pass = sums(of_pass.map(|d| &d[key]));
            assert_eq!(of_pass, sums([&pass[key]].into_iter()), "{key}");
        }
    }
    assert_eq!(doc["totals"]["draws"], draws.len());
}

#[test]
fn draws_stand_in_the_order_of_submission() {
    let doc = Folder::new("draw-order")
        .gnomon(&format!("{SHOT} --json --per draw"))
        .json();
    let at = |d: &Value| (d["pass"].as_u64().unwrap(), d["draw"].as_u64().unwrap());
    let places: Vec<_> = doc["draws"].as_array().unwrap().iter().map(at).collect();
    assert!(places.len() > 10 && places.is_sorted(), "{places:?}");
    for draw in doc["draws"].as_array().unwrap() {
        let pass = draw["pass"].as_u64().unwrap() as usize;
        assert_eq!(draw["pass_name"], doc["passes"][pass]["name"]);
        assert!(draw["label"].is_string() && draw["shader_counts"].is_object());
    }
}

/// Per pass the document is what it was.
#[test]
fn draws_come_when_asked_for() {
    let folder = Folder::new("per-pass");
    for flags in ["", "--per pass"] {
        let doc = folder.gnomon(&format!("{SHOT} --json {flags}")).json();
        assert!(doc.get("draws").is_none(), "{flags}");
    }
    let wrong = [
        ("--per draw", "--json"),
        ("--json --per primitive", "pass, draw"),
    ];
    for (flags, part) in wrong {
        folder.gnomon(&format!("{SHOT} {flags}")).refused(&[part]);
    }
    folder
        .gnomon("render demo --frames 2 --draws")
        .refused(&["--draws", "--frames"]);
}

/// Cells of the row of a table that begins with `name`.
fn cells<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    let row = text.lines().find(|l| l.trim_start().starts_with(name));
    let row = row.unwrap_or_else(|| panic!("no {name} in {text}"));
    row.trim_start()[name.len()..].split_whitespace().collect()
}

/// The table has the document's numbers, none of them rounded.
#[test]
fn the_table_has_full_numbers() {
    let folder = Folder::new("draw-table");
    let doc = folder.gnomon(&format!("{SHOT} --json --per draw")).json();
    let run = folder.gnomon(&format!("{SHOT} --draws")).fine();
    let text = run.stdout();
    let (work, traffic) = text
        .split_once("Draws: bytes")
        .expect("two tables of draws");
    let work = work.split_once("Draws: primitives").unwrap().1;
    for draw in doc["draws"].as_array().unwrap() {
        let name = format!("{} {}", draw["draw"], draw["label"].as_str().unwrap());
        let behind = |table: &str| {
            let pass = draw["pass_name"].as_str().unwrap();
            let from = table.find(&format!("\n{pass}\n")).unwrap();
            table[from..].to_owned()
        };
        let f = &draw["fragments"];
        let expected = [
            &draw["primitives"]["input"],
            &draw["primitives"]["rasterized"],
            &f["generated"],
            &f["hiz_killed"],
            &f["bounds_failed"],
            &f["stencil_failed"],
            &f["depth_failed"],
            &f["discarded"],
            &f["written"],
        ];
        assert_eq!(
            cells(&behind(work), &name),
            expected.map(Value::to_string),
            "{name}"
        );
        let moved =
            |t: &Value| t["read_bytes"].as_u64().unwrap() + t["write_bytes"].as_u64().unwrap();
        let total: u64 = draw["traffic"]
            .as_object()
            .unwrap()
            .values()
            .map(moved)
            .sum();
        let row = behind(traffic);
        assert_eq!(*cells(&row, &name).last().unwrap(), total.to_string());
    }
}
