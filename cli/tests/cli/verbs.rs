//! `demo` and the listings.

use crate::common::Folder;

#[test]
fn scenes_are_listed() {
    let folder = Folder::new("list-scenes");
    let text = folder.gnomon("scenes").fine().stdout();
    let doc = folder.gnomon("scenes --json").json();
    let scenes = doc["scenes"].as_array().unwrap();
    assert!(scenes.len() >= 10);
    for scene in scenes {
        assert!(text.contains(scene["name"].as_str().unwrap()));
        assert!(scene["triangles"].as_u64().unwrap() > 0, "{scene}");
    }
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    assert!(folder.names().is_empty());
}

#[test]
fn techniques_are_listed_with_parameters() {
    let folder = Folder::new("list-techniques");
    let text = folder.gnomon("techniques").fine().stdout();
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    let doc = folder.gnomon("techniques --json").json();
    for technique in doc["techniques"].as_array().unwrap() {
        assert!(text.contains(technique["name"].as_str().unwrap()));
        for param in technique["params"].as_array().unwrap() {
            let default = &param["default"];
            let number = default.as_f64().map(|x| x.to_string());
            let default = number.unwrap_or_else(|| default.as_str().unwrap().to_owned());
            let shown = format!("{}={default}", param["name"].as_str().unwrap());
            assert!(text.contains(&shown), "{shown}");
            assert!(!param["summary"].as_str().unwrap().is_empty());
        }
    }
}

#[test]
fn demo_writes_pictures_and_report_and_checks_itself() {
    let folder = Folder::new("demo");
    let run = folder.gnomon("demo --size 120x80 --json").fine();
    assert!(
        run.stderr().contains("same bits without skipping: yes"),
        "{}",
        run.stderr()
    );
    assert!(
        run.stderr()
            .lines()
            .all(|l| l.starts_with("warning: ") || l.chars().count() <= 80),
        "{}",
        run.stderr()
    );
    // Nobody looks: no bar, no escape sequences.
    assert!(!run.stderr().contains(['\r', '\u{1b}', '█']));
    let doc = run.json();
    assert_eq!(doc["checks"]["skipping_is_invisible"], true);
    assert_eq!(doc["checks"]["methods_agree"], true);
    assert_eq!(doc["renders"].as_array().unwrap().len(), 7);
    let rmse: Vec<f64> = doc["errors"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| e["rmse"].as_f64().unwrap())
        .collect();
    assert!(rmse[0] > 2.0 * rmse[1] && rmse[1] > 0.01, "{rmse:?}");
    assert!(rmse[1..4].iter().all(|r| *r == rmse[1]) && rmse.len() == 7);
    assert!(rmse[4] < 0.6 * rmse[1], "soft shadows are nearer: {rmse:?}");
    for file in doc["files"].as_array().unwrap() {
        assert!(
            folder.path(file["path"].as_str().unwrap()).is_file(),
            "{file}"
        );
    }
    let html = std::fs::read_to_string(folder.path("out/report.html")).unwrap();
    assert_eq!(html.matches("data:image/png;base64,").count(), 12);
    assert!(!html.contains("http"), "the page is self-contained");
}

#[test]
fn help_and_version_are_fine() {
    let folder = Folder::new("help");
    for arguments in [
        "--help",
        "--version",
        "render --help",
        "demo --help",
        "help techniques",
    ] {
        assert!(!folder.gnomon(arguments).fine().stdout().is_empty());
    }
}
