//! `gnomon stress`.

use serde_json::Value;

use crate::common::Folder;

const FEW: &str = "stress --technique soft-shadow-volumes,pcf:taps=4 --axis scale,near-d32f \
                   --size 24x16 --out-dir out";

#[test]
fn verdicts_curves_and_files() {
    let folder = Folder::new("stress");
    let text = folder.gnomon(FEW).fine().stdout();
    for wanted in [
        "soft-shadow-volumes: holds on",
        "pcf:taps=4: holds on",
        "stress.csv",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    let document = std::fs::read_to_string(folder.path("out/stress.json")).unwrap();
    let document: Value = serde_json::from_str(&document).unwrap();
    let axes = document["axes"].as_array().unwrap();
    assert_eq!(axes.len(), 2);
    for axis in axes {
        let values = axis["values"].as_array().unwrap().len();
        let techniques = axis["techniques"].as_array().unwrap();
        assert_eq!(techniques.len(), 2);
        for technique in techniques {
            assert_eq!(technique["points"].as_array().unwrap().len(), values);
            assert!(technique["verdict"]["rmse_at_rest"].as_f64().unwrap() < 0.2);
        }
    }
    let csv = std::fs::read_to_string(folder.path("out/stress.csv")).unwrap();
    let lines: usize = axes
        .iter()
        .map(|a| 2 * a["values"].as_array().unwrap().len())
        .sum();
    assert_eq!(csv.lines().count(), 1 + lines);
    let record = std::fs::read_to_string(folder.path("out/stress.md")).unwrap();
    assert!(record.contains("| `pcf:taps=4` |") && record.contains("stress-scale.svg"));
    let plot = std::fs::read_to_string(folder.path("out/stress-scale.svg")).unwrap();
    assert!(plot.contains("soft-shadow-volumes") && plot.contains("stroke-dasharray"));
}

/// The same run, the same files, on any number of threads.
#[test]
fn the_record_is_the_same_every_time() {
    let read = |threads: u32| {
        let folder = Folder::new(&format!("stress-again-{threads}"));
        folder.gnomon(&format!("{FEW} --threads {threads}")).fine();
        let all = ["stress.csv", "stress.json", "stress-near-d32f.svg"];
        all.map(|name| std::fs::read(folder.path("out").join(name)).unwrap())
    };
    assert!(read(1) == read(2));
}

#[test]
fn what_is_not_there_is_named_and_nothing_is_written() {
    let folder = Folder::new("stress-bad");
    let refused = |flags: &str, words: &[&str]| {
        let line = format!("stress --size 8x8 --out-dir out {flags}");
        folder.gnomon(&line).refused(words);
    };
    refused("--axis depth", &["--axis", "depth", "near-d32f"]);
    refused("--technique pfc", &["pfc", "pcf"]);
    refused("--technique pcf:tap=4", &["tap", "taps"]);
    refused("--scene plates", &["plates", "parallel-plates"]);
    refused("--light 3", &["light 3", "1"]);
    assert!(!folder.path("out").exists());
}
