//! `gnomon traffic` and `gnomon profiles`.

use super::common::Folder;

const RECORD: &str = "record creature --size 64x48 --technique shadow-volumes --out a.gnt";

#[test]
fn rows_add_up_to_the_totals_in_each_form() {
    let folder = Folder::new("traffic");
    folder.gnomon(RECORD).fine();
    for by in ["pass", "draw", "client", "tile", "pixel"] {
        let line = format!("traffic a.gnt --profile imr-2008 --by {by} --json --out {by}.csv");
        let document = folder.gnomon(&line).json();
        for level in ["logical", "cache", "dram"] {
            for way in ["read_bytes", "write_bytes"] {
                let rows = document["rows"].as_array().unwrap().iter();
                let sum: u64 = rows.map(|r| r[level][way].as_u64().unwrap()).sum();
                assert_eq!(
                    sum,
                    document["totals"][level][way].as_u64().unwrap(),
                    "{by}"
                );
                assert!(sum > 0, "{by} {level} {way}");
            }
        }
        let csv = std::fs::read_to_string(folder.path(&format!("{by}.csv"))).unwrap();
        let rows = document["rows"].as_array().unwrap().len();
        assert_eq!(csv.lines().count(), rows + 1, "{by}");
        let line = format!("traffic a.gnt --profile imr-2008 --by {by} --out -");
        assert_eq!(folder.gnomon(&line).fine().stdout(), csv, "{by}");
    }
}

/// Ambient, volumes and light share their tiles; what looks up a buffer does not.
#[test]
fn merged_passes_are_named_and_so_are_reasons_against() {
    let folder = Folder::new("traffic-merged");
    folder.gnomon(RECORD).fine();
    let line = "traffic a.gnt --profile tbr-mali --per-pass-merged --json";
    let documents = folder.gnomon(line).json();
    let [apart, merged] = [0, 1].map(|i| &documents[i]);
    assert!(apart["merges"].is_null());
    let merges = merged["merges"].as_array().unwrap();
    assert!(merges.len() >= 2);
    for merge in merges {
        assert_eq!(merge["merged"], true, "{merge}");
        assert!(merge["refused_reason"].is_null());
    }
    let dram = |d: &serde_json::Value| {
        let total = &d["totals"]["dram"];
        total["read_bytes"].as_u64().unwrap() + total["write_bytes"].as_u64().unwrap()
    };
    assert!(dram(merged) < dram(apart));
    folder
        .gnomon("record creature --size 64x48 --technique soft-shadow-volumes --out b.gnt")
        .fine();
    let text = folder
        .gnomon("traffic b.gnt --profile tbr-mali --per-pass-merged")
        .fine()
        .stdout();
    assert!(
        text.contains("goes on in the tiles of the passes before"),
        "{text}"
    );
    assert!(
        text.contains("begins tiles of its own: it samples `"),
        "{text}"
    );
}

#[test]
fn what_is_wrong_is_said() {
    let folder = Folder::new("traffic-wrong");
    folder.gnomon(RECORD).fine();
    folder.write("mine.toml", "order = 3");
    for (flags, said) in [
        ("--profile none", "valid are naive, compulsory"),
        ("--profile mine.toml", "`order` is 3"),
        ("--profile naive --out x.npy", "--by tile"),
        ("--profile naive --out x.png", ".csv"),
        ("--profile naive --json --out -", "document of --json"),
    ] {
        let run = folder.gnomon(&format!("traffic a.gnt {flags}"));
        run.refused(&[said]);
    }
    assert_eq!(folder.names(), ["a.gnt", "mine.toml"]);
}

#[test]
fn profiles_show_where_values_are_from() {
    let folder = Folder::new("profiles");
    let list = folder.gnomon("profiles --json").json();
    for profile in list["profiles"].as_array().unwrap() {
        let name = profile["name"].as_str().unwrap();
        let shown = folder
            .gnomon(&format!("profiles show {name} --json"))
            .json();
        for value in shown["values"].as_array().unwrap() {
            assert!(value["source"].is_string() != value["assumption"].is_string());
        }
    }
}
