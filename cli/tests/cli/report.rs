//! The page that `report` writes. What a browser makes of it: `tests/report/check.mjs`.

use gnomon_pipeline::technique::Params;
use gnomon_traces::profile::{Judge, JudgeOptions, profile};
use gnomon_traces::{Meta, RecordOptions, Trace, record};
use serde_json::Value;

use crate::common::Folder;

const SHOT: &str = "report demo --size 64x48";

/// The text of the page that `flags` make.
fn page(folder: &Folder, flags: &str) -> String {
    folder
        .gnomon(&format!("{SHOT} --out a.html {flags}"))
        .fine();
    std::fs::read_to_string(folder.path("a.html")).unwrap()
}

fn assert_has(page: &str, parts: &[&str]) {
    for part in parts {
        assert!(page.contains(part), "no `{part}`");
    }
}

/// Every number of the table is the one that `render` prints, in full.
#[test]
fn the_page_has_the_numbers_of_the_frame() {
    let folder = Folder::new("report-numbers");
    let page = page(&folder, "");
    let doc = folder
        .gnomon("render demo --size 64x48 --json --per draw")
        .json();
    for draw in doc["draws"].as_array().unwrap() {
        let f = &draw["fragments"];
        let counts = [
            &draw["primitives"]["input"],
            &f["generated"],
            &f["hiz_killed"],
            &f["bounds_failed"],
            &f["stencil_failed"],
            &f["depth_failed"],
            &f["discarded"],
            &f["written"],
            &draw["fragment_shader_invocations"],
        ];
        let cells: String = counts.iter().map(|n| format!("<td>{n}</td>")).collect();
        let label = draw["label"].as_str().unwrap();
        assert_has(&page, &[&format!("<td>{label}</td><td>used</td>{cells}")]);
    }
    let totals = &doc["totals"]["fragments"];
    let generated = &totals["generated"];
    assert_has(
        &page,
        &[
            &format!("Fragments generated at each pixel: {generated} in all"),
            &format!("{generated} fragments were generated for 3072 pixels"),
            "ended by zmin/zmax</b>",
            &format!("<span class=\"n\">{}</span>", totals["written"]),
            doc["hash"]["color"].as_str().unwrap(),
            doc["hash"]["visibility"].as_str().unwrap(),
            "gnomon report demo --size 64x48 --out a.html",
        ],
    );
}

/// Nothing but the page's own; text of scenes is no markup.
#[test]
fn the_page_stands_alone() {
    let page = page(&Folder::new("report-alone"), "");
    for outside in ["http:", "https:", "src=\"/", "@import", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert_eq!(page.matches("<script").count(), 1);
}

#[test]
fn histories_stand_on_the_page() {
    let folder = Folder::new("report-pixel");
    let page = page(&folder, "--pixel 30,20 --pixel 0,47");
    assert_has(
        &page,
        &["id=\"s0p30-20\"", "href=\"#s0p0-47\"", "Pixel 30, 20"],
    );
    folder
        .gnomon(&format!("{SHOT} --out b.html --pixel 64,0"))
        .refused(&["--pixel", "64,0", "columns 0 to 63 and rows 0 to 47"]);
    folder
        .gnomon(&format!("{SHOT} --out b.html --pixel 1"))
        .refused(&["400,300"]);
    assert!(!folder.path("b.html").exists());
}

/// Errors of several techniques, each beside its bytes and its time.
#[test]
fn techniques_are_compared() {
    let folder = Folder::new("report-compare");
    let both = "--technique shadow-volumes:method=zfail --technique soft-shadow-volumes";
    let page = page(&folder, both);
    assert_has(
        &page,
        &[
            "Error against logical megabytes",
            "Error against milliseconds",
            "shadow-volumes method=zfail",
            "id=\"s1\"",
        ],
    );
    let compared = folder
        .gnomon("compare demo --size 64x48 --techniques soft-shadow-volumes --json")
        .json();
    let rmse = compared["results"][0]["rmse"].as_f64().unwrap();
    assert_has(&page, &[&format!("<td>{rmse}</td>")]);
}

/// Draws follow one another along the bytes; clients end at their sums.
#[test]
fn the_timeline_adds_up() {
    let folder = Folder::new("report-chrome");
    page(&folder, "--chrome a.json --profile none");
    let text = std::fs::read_to_string(folder.path("a.json")).unwrap();
    let trace: Value = serde_json::from_str(&text).unwrap();
    let events = trace["traceEvents"].as_array().unwrap();
    let of = |ph: &'static str| events.iter().filter(move |e| e["ph"] == ph);
    assert!(of("M").any(|e| e["args"]["name"] == "logical kilobytes so far, not time"));
    let mut bytes = 0;
    for draw in of("X") {
        assert_eq!(draw["ts"].as_f64(), Some(bytes as f64 / 1e3));
        bytes += draw["args"]["bytes"].as_u64().unwrap();
    }
    let doc = folder.gnomon("render demo --size 64x48 --json").json();
    let traffic = doc["totals"]["traffic"].as_object().unwrap();
    let total = |t: &Value| t["read_bytes"].as_u64().unwrap() + t["write_bytes"].as_u64().unwrap();
    assert_eq!(traffic.values().map(total).sum::<u64>(), bytes);
    for (client, moved) in traffic {
        let of_client: Vec<_> = of("C").filter(|e| e["name"] == client.as_str()).collect();
        let last = of_client.last().unwrap();
        assert_eq!(last["args"]["bytes"], total(moved), "{client}");
    }
    folder
        .gnomon(&format!(
            "{SHOT} --out b.html --chrome b.json --technique pcf --technique pcss"
        ))
        .refused(&["--chrome", "one --technique"]);
}

#[test]
fn wrong_names_of_files_are_refused_before_any_work() {
    let folder = Folder::new("report-names");
    folder
        .gnomon(&format!("{SHOT} --out a.png"))
        .refused(&["--out", ".html"]);
    folder
        .gnomon(&format!("{SHOT} --out a.html --chrome a.txt"))
        .refused(&["--chrome", ".json"]);
    assert!(folder.names().is_empty());
}

/// Maps hold every fragment and byte that the counters do: their sums are printed.
#[test]
fn maps_add_up_to_the_counters() {
    let folder = Folder::new("report-maps");
    let page = page(&folder, "");
    let doc = folder.gnomon("render demo --size 64x48 --json").json();
    let totals = &doc["totals"];
    let traffic = |client: &str, key: &str| totals["traffic"][client][key].as_u64().unwrap_or(0);
    let both = |client: &str, unit: &str| {
        ["read", "write"].map(|way| traffic(client, &format!("{way}_{unit}")))
    };
    let stencil: u64 = both("stencil", "accesses").iter().sum();
    let clients = ["z", "stencil", "color[0]"].map(|c| both(c, "bytes").iter().sum::<u64>());
    let bytes: u64 = clients.iter().sum();
    assert_has(
        &page,
        &[
            &format!("Reads and writes of the stencil at each pixel: {stencil} in all"),
            &format!(
                "at each pixel: {} in all",
                totals["fragments"]["hiz_killed"]
            ),
            &format!("vertices have no pixel: {bytes} in all"),
        ],
    );
}

/// Reasons against HiZ stand beside the draws, and each profile beside logical bytes.
#[test]
fn profiles_judge_the_frame() {
    let folder = Folder::new("report-profiles");
    let fail = "--technique shadow-volumes:method=zfail:color-format=rgba8";
    let page = page(
        &folder,
        &format!("{fail} --profile imr-2003,tbr-mali --chrome a.json"),
    );
    assert_has(
        &page,
        &[
            "imr-2003 HiZ",
            "off: depth-fail operation",
            "Under imr-2003, memory moves",
            "Bytes to and from memory under tbr-mali",
            "· tbr-mali",
        ],
    );
    let text = std::fs::read_to_string(folder.path("a.json")).unwrap();
    assert!(text.contains("imr-2003 DRAM kilobytes so far, not time"));
    folder
        .gnomon(&format!("{SHOT} --out b.html --profile imr-1999"))
        .refused(&["imr-1999", "imr-2008"]);
}

/// Bytes under a profile are those that its judge finds in the recorded frame.
#[test]
fn bytes_of_profiles_are_the_judges() {
    let folder = Folder::new("report-judge");
    let page = page(&folder, "--profile imr-2008,tbr-adreno");
    record_demo(&folder.path("a.gnt"));
    let trace = Trace::open(folder.path("a.gnt")).unwrap();
    for name in ["imr-2008", "tbr-adreno"] {
        let shape = trace.shape(0).unwrap();
        let mut judge = Judge::new(&profile(name).unwrap(), &shape).unwrap();
        trace.events(0, &mut judge).unwrap();
        let traffic = judge.finish();
        let bytes = traffic.total().dram.bytes();
        assert_has(
            &page,
            &[&format!("Under {name}, memory moves {bytes} bytes")],
        );
        for row in traffic.rows.iter().filter(|r| r.draw.is_some()) {
            let why = row
                .disabled
                .map_or("used".to_owned(), |d| format!("off: {d}"));
            let cells = format!("<td>{why}</td><td>{}</td>", row.total().dram.bytes());
            assert_has(&page, &[&cells]);
        }
    }
}

/// Tilers stand there twice where passes can share their tiles, others once.
#[test]
fn tilers_are_shown_merged_too() {
    let folder = Folder::new("report-merged");
    let page = page(&folder, "--profile imr-2008,tbr-mali");
    record_demo(&folder.path("a.gnt"));
    let trace = Trace::open(folder.path("a.gnt")).unwrap();
    let shape = trace.shape(0).unwrap();
    let bytes = [false, true].map(|merged| {
        let options = JudgeOptions {
            merged,
            ..JudgeOptions::default()
        };
        let mali = profile("tbr-mali").unwrap();
        let mut judge = Judge::with_options(&mali, &shape, options).unwrap();
        trace.events(0, &mut judge).unwrap();
        judge.finish().total().dram.bytes()
    });
    assert!(bytes[1] < bytes[0], "{bytes:?}");
    let said = ["tbr-mali", "tbr-mali (passes merged)"];
    for (name, bytes) in said.into_iter().zip(bytes) {
        assert_has(
            &page,
            &[&format!("Under {name}, memory moves {bytes} bytes")],
        );
    }
    assert!(!page.contains("imr-2008 (passes merged)"));
}

/// Hardware that cannot do what the frame does says so on the page.
#[test]
fn a_profile_that_cannot_is_told() {
    let folder = Folder::new("report-refused");
    let page = page(&folder, "--profile imr-2003,imr-2008");
    assert_has(&page, &["Not judged: profile `imr-2003`", "Under imr-2008"]);
}

/// The frame of [`SHOT`] in a file.
fn record_demo(to: &std::path::Path) {
    let scene = gnomon_pipeline::world::scene::builtin::build("demo").unwrap();
    let technique = gnomon_pipeline::techniques::find("shadow-volumes").unwrap();
    let params = Params::parse(technique, std::iter::empty::<String>()).unwrap();
    let frame = technique.frame(&scene, [64, 48], &params).unwrap();
    let trace = record(
        Meta::new("demo"),
        &frame.recording,
        RecordOptions::default(),
    );
    trace.unwrap().write(to).unwrap();
}

/// A recorded frame has the page of its scene: the same picture, draws and history.
#[test]
fn a_trace_has_the_page_of_its_scene() {
    let folder = Folder::new("report-trace");
    record_demo(&folder.path("a.gnt"));
    let of_scene = page(&folder, "--pixel 30,20");
    folder
        .gnomon("report a.gnt --out a.html --pixel 30,20")
        .fine();
    let of_trace = std::fs::read_to_string(folder.path("a.html")).unwrap();
    for part in ["<div class=\"history\"", "<tbody>"] {
        let rest = |page: &str| page[page.find(part).unwrap()..].to_owned();
        let end = |page: &str| page.find("<footer>").unwrap();
        let (a, b) = (rest(&of_scene), rest(&of_trace));
        assert_eq!(a[..end(&a)], b[..end(&b)], "{part}");
    }
    let hash = |page: &str| {
        let at = page.find("<dt>Picture").unwrap();
        page[at..].split("<dd>").nth(1).unwrap()[..64].to_owned()
    };
    assert_eq!(hash(&of_scene), hash(&of_trace));
    folder
        .gnomon("report a.gnt --out b.html --technique pcf")
        .refused(&["--technique", "leave it out"]);
    folder
        .gnomon("report a.gnt --out b.html --frame 7")
        .refused(&["frame 7"]);
}
