//! What `bench` measures, keeps, joins and refuses.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common::Folder;

/// Three scenes by five techniques with parameters, small.
const SMALL: &str = "bench cylinder parallel-plates two-box --size 32x24 --threads 1 \
    --techniques unshadowed,shadow-volumes,pcf:taps=2|4|8";
const CELLS: usize = 15;

/// Files of cells by name.
fn cells(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder.join("cells")).unwrap();
    let entries = entries.map(|e| e.unwrap().path());
    let whole = entries.filter(|p| p.extension().is_some_and(|e| e == "cell"));
    let name = |p: &Path| p.file_name().unwrap().to_string_lossy().into_owned();
    whole.map(|p| (name(&p), fs::read(&p).unwrap())).collect()
}

/// Everything that is made of the results, by name.
fn tables(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let name = |p: &Path| p.file_name().unwrap().to_string_lossy().into_owned();
    let files = entries.filter(|p| p.is_file());
    files.map(|p| (name(&p), fs::read(&p).unwrap())).collect()
}

/// How many cells a run says that it measured.
fn measured(stderr: &str) -> usize {
    stderr.lines().filter(|l| l.starts_with('[')).count()
}

/// The document without what differs from run to run.
fn without_times(mut doc: Value) -> Value {
    let object = doc.as_object_mut().unwrap();
    for key in ["fronts", "advice"] {
        let kept = object[key].as_array_mut().unwrap();
        kept.retain(|f| f["cost"] == "bytes");
    }
    for cell in object["cells"].as_array_mut().unwrap() {
        cell.as_object_mut().unwrap().remove("time_ms");
    }
    doc
}

#[test]
fn tables_have_what_compare_measures() {
    let folder = Folder::new("bench-tables");
    let run = folder.gnomon(&format!("{SMALL} --out-dir b --json")).fine();
    let stderr = run.stderr();
    assert_eq!(measured(&stderr), CELLS, "{stderr}");
    assert!(
        stderr.contains(" left, ") && !stderr.contains('\u{1b}'),
        "{stderr}"
    );
    let doc = run.json();
    let found = doc["cells"].as_array().unwrap();
    assert_eq!((found.len(), &doc["missing"]), (CELLS, &0.into()));
    let compared = folder
        .gnomon("compare two-box --size 32x24 --techniques shadow-volumes,pcf:taps=8 --json")
        .json();
    for (number, label) in [(0, "shadow-volumes"), (1, "pcf")] {
        let expected = &compared["results"][number];
        let is_it = |c: &&Value| {
            let taps = c["params"]["taps"].as_str().unwrap_or("8");
            (c["scene"] == "two-box", &c["technique"], taps) == (true, &label.into(), "8")
        };
        let cell = found.iter().find(is_it).unwrap();
        for key in [
            "rmse",
            "max",
            "p99",
            "mean",
            "rmse_umbra",
            "rmse_penumbra",
            "flip",
            "psnr",
            "ssim",
        ] {
            assert_eq!(cell["error"][key], expected[key], "{label} {key}");
        }
        for key in ["bytes", "shaded_fragments", "params"] {
            assert_eq!(cell[key], expected[key], "{label} {key}");
        }
        assert_eq!(cell["hash"], expected["hash"]);
        let clients = cell["clients"].as_object().unwrap().values();
        let bytes =
            clients.map(|c| c["read_bytes"].as_u64().unwrap() + c["write_bytes"].as_u64().unwrap());
        assert_eq!(Value::from(bytes.sum::<u64>()), cell["bytes"]);
        let time = &cell["time_ms"];
        assert!(time["frames"].as_array().unwrap().len() >= 5 && time["build"].is_number());
    }
    let csv = fs::read_to_string(folder.path("b/bench.csv")).unwrap();
    let columns = csv.lines().next().unwrap().split(',').count();
    assert_eq!(csv.lines().count(), CELLS + 1);
    assert!(
        csv.lines().all(|l| l.split(',').count() == columns),
        "{csv}"
    );
    assert!(
        csv.contains("\ntwo-box,pcf,taps=8,32,24,1,measured,,"),
        "{csv}"
    );
}

/// Whatever was measured is not measured again, and the tables come out the same.
#[test]
fn a_run_that_stopped_goes_on_where_it_was() {
    let folder = Folder::new("bench-resume");
    let all = format!("{SMALL} --out-dir b");
    let first = folder.gnomon(&format!("{all} --limit 4")).fine();
    assert!(
        first.stdout().contains("11 of 15 cells have no result yet"),
        "{}",
        first.stdout()
    );
    let before = cells(&folder.path("b"));
    assert_eq!((measured(&first.stderr()), before.len()), (4, 4));
    let second = folder.gnomon(&all).fine();
    let after = cells(&folder.path("b"));
    assert_eq!(
        (measured(&second.stderr()), after.len()),
        (CELLS - 4, CELLS)
    );
    assert!(before.iter().all(|(name, bytes)| after[name] == *bytes));
    let written = tables(&folder.path("b"));
    assert_eq!(measured(&folder.gnomon(&all).fine().stderr()), 0);
    assert!(tables(&folder.path("b")) == written && cells(&folder.path("b")) == after);
}

/// Killed while it measures: what lies there is whole, and the next run goes on.
#[test]
fn a_killed_run_leaves_whole_results() {
    let folder = Folder::new("bench-kill");
    let all = format!("{SMALL} --repeat 40 --out-dir b");
    let mut child = Command::new(env!("CARGO_BIN_EXE_gnomon"))
        .args(all.split_whitespace())
        .current_dir(folder.path(""))
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    let some = || folder.path("b/cells").is_dir() && cells(&folder.path("b")).len() >= 2;
    while !some() && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let before = cells(&folder.path("b"));
    assert!((2..CELLS).contains(&before.len()), "{}", before.len());
    let run = folder.gnomon(&all).fine();
    assert!(!run.stderr().contains("warning"), "{}", run.stderr());
    assert_eq!(measured(&run.stderr()), CELLS - before.len());
    let after = cells(&folder.path("b"));
    assert!(before.iter().all(|(name, bytes)| after[name] == *bytes));
}

#[test]
fn a_corrupt_result_is_named_and_measured_again() {
    let folder = Folder::new("bench-corrupt");
    let all = format!("{SMALL} --out-dir b");
    folder.gnomon(&all).fine();
    let whole = cells(&folder.path("b"));
    let names: Vec<&String> = whole.keys().take(2).collect();
    let path = |name: &str| folder.path(&format!("b/cells/{name}"));
    let bytes = &whole[names[0]];
    fs::write(path(names[0]), &bytes[..bytes.len() / 2]).unwrap();
    // A whole result in the place of another one.
    fs::write(path(names[1]), &whole[whole.keys().last().unwrap()]).unwrap();
    let run = folder.gnomon(&all).fine();
    let stderr = run.stderr();
    assert_eq!(measured(&stderr), 2, "{stderr}");
    for name in names {
        assert!(stderr.contains(&format!("{name}: it is ")), "{stderr}");
    }
    assert!(stderr.contains("measured again"), "{stderr}");
}

/// Parts of one measurement, joined, are the measurement, however many parts.
#[test]
fn merged_parts_make_the_same_tables() {
    let folder = Folder::new("bench-merge");
    folder.gnomon(&format!("{SMALL} --out-dir whole")).fine();
    let [expected, all] = [tables(&folder.path("whole")), cells(&folder.path("whole"))];
    for count in 1..=3 {
        let mut folders = String::new();
        let mut sum = 0;
        for part in 1..=count {
            let name = format!("p{count}-{part}");
            fs::create_dir_all(folder.path(&format!("{name}/cells"))).unwrap();
            let shard = format!("{SMALL} --shard {part}/{count} --out-dir {name}");
            // Which cells are its own is told by a run that has none.
            folder.gnomon(&shard).fine();
            let own = cells(&folder.path(&name));
            sum += own.len();
            for cell in own.keys() {
                fs::write(folder.path(&format!("{name}/cells/{cell}")), &all[cell]).unwrap();
            }
            assert_eq!(measured(&folder.gnomon(&shard).fine().stderr()), 0);
            folders += &format!(" {name}");
        }
        assert_eq!(sum, CELLS);
        folder
            .gnomon(&format!("bench merge{folders} --out-dir m{count}"))
            .fine();
        assert!(
            tables(&folder.path(&format!("m{count}"))) == expected,
            "{count} parts"
        );
    }
}

/// Everything but times is the same in another run, on more threads, in parts.
#[test]
fn everything_but_times_is_the_same_each_time() {
    let folder = Folder::new("bench-again");
    let whole = |flags: &str| folder.gnomon(&format!("{SMALL} {flags} --json")).json();
    let first = without_times(whole("--out-dir a"));
    assert_eq!(first, without_times(whole("--out-dir b")));
    for part in 1..=2 {
        folder
            .gnomon(&format!("{SMALL} --shard {part}/2 --out-dir s{part}"))
            .fine();
    }
    let merged = folder.gnomon("bench merge s2 s1 --out-dir m --json").json();
    assert_eq!(first, without_times(merged));
    let more = SMALL.replace("--threads 1", "--threads 3");
    let threads = without_times(folder.gnomon(&format!("{more} --out-dir t --json")).json());
    for key in [
        "error",
        "bytes",
        "clients",
        "shaded_fragments",
        "hash",
        "warnings",
    ] {
        let of = |doc: &Value| -> Vec<Value> {
            doc["cells"]
                .as_array()
                .unwrap()
                .iter()
                .map(|c| c[key].clone())
                .collect()
        };
        assert_eq!(of(&first), of(&threads), "{key}");
    }
}

/// The script of a Slurm array, as two of its tasks run it, and as the last one joins them.
#[test]
fn the_slurm_script_makes_the_tables_of_one_run() {
    let folder = Folder::new("bench-slurm");
    folder.write(
        "mini.toml",
        "[suite]\nscenes = [\"cylinder\"]\nsizes = [\"16x12\"]\nthreads = [1]\n\
         techniques = [\"unshadowed\", \"pcf:taps=2|4\"]\n",
    );
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/bench/slurm.sh");
    let run = |what: &str, task: &str| {
        let mut command = Command::new("bash");
        command
            .arg(&script)
            .args([what, "out"])
            .current_dir(folder.path(""));
        command.env("GNOMON", env!("CARGO_BIN_EXE_gnomon"));
        command
            .env("SLURM_ARRAY_TASK_ID", task)
            .env("SLURM_ARRAY_TASK_COUNT", "2");
        let output = command.output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    };
    run("mini.toml", "1");
    run("mini.toml", "2");
    run("--merge", "1");
    let csv = fs::read_to_string(folder.path("out/all/bench.csv")).unwrap();
    assert_eq!(csv.matches(",measured,").count(), 3, "{csv}");
}

/// `text` sealed again after a change.
fn sealed(bytes: &[u8], change: impl Fn(&str) -> String) -> Vec<u8> {
    let text = String::from_utf8(bytes.to_vec()).unwrap();
    let (head, body) = text.split_once('\n').unwrap();
    let body = change(body);
    let (title, _) = head.rsplit_once(' ').unwrap();
    format!("{title} {}\n{body}", blake3::hash(body.as_bytes()).to_hex()).into_bytes()
}

#[test]
fn results_that_contradict_each_other_are_refused_and_times_may_differ() {
    let folder = Folder::new("bench-conflict");
    let one = "bench cylinder --size 32x24 --threads 1 --techniques pcf";
    folder.gnomon(&format!("{one} --out-dir a")).fine();
    folder.gnomon(&format!("{one} --out-dir b")).fine();
    folder.gnomon("bench merge a b --out-dir m").fine();
    let (name, bytes) = cells(&folder.path("b")).pop_first().unwrap();
    let changed = sealed(&bytes, |body| {
        let at = body.find("\"flip\": \"").unwrap() + 9;
        format!("{}9{}", &body[..at], &body[at + 1..])
    });
    fs::write(folder.path(&format!("b/cells/{name}")), changed).unwrap();
    folder
        .gnomon("bench merge a b --out-dir n")
        .refused(&[&name, "`pcf` of cylinder", "figures"]);
    fs::write(folder.path(&format!("b/cells/{name}")), &bytes[1..]).unwrap();
    folder
        .gnomon("bench merge a b --out-dir n")
        .refused(&[&name, "does not begin"]);
    folder
        .gnomon("bench cylinder --size 8x6 --threads 1 --techniques pcf --out-dir c")
        .fine();
    folder
        .gnomon("bench merge a c --out-dir n")
        .refused(&["c/bench.plan", "cell 0"]);
    folder
        .gnomon("bench merge a nowhere --out-dir n")
        .refused(&["nowhere/bench.plan"]);
    assert!(!folder.path("n").exists());
}

/// A bent sheet: it has no inside, and volumes refuse it.
const OPEN: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n";

#[test]
fn what_a_technique_refuses_is_a_row_with_the_reason() {
    let folder = Folder::new("bench-refused");
    folder.write("open.obj", OPEN);
    let scene = "[camera]\neye = [2, 2, 5]\ntarget = [0, 0, 0]\n[[lights]]\n\
        shape.point = { position = [0, 4, 0] }\n[[objects]]\nmesh.model = \"open.obj\"\n";
    folder.write("open.toml", scene);
    let run = folder.gnomon(
        "bench open.toml --size 16x12 --threads 1 --techniques unshadowed,shadow-volumes --out-dir b --json",
    );
    let run_text = run.stderr();
    let doc = run.json();
    let cell = &doc["cells"][1];
    assert_eq!(
        (&cell["status"], &cell["error"]),
        (&"refused".into(), &Value::Null)
    );
    let reason = cell["reason"].as_str().unwrap();
    assert!(
        reason.contains("open") && run_text.contains("refused: "),
        "{reason}"
    );
    assert_eq!(doc["cells"][0]["status"], "measured");
    let csv = fs::read_to_string(folder.path("b/bench.csv")).unwrap();
    assert!(csv.contains(",refused,"), "{csv}");
}

/// Everything stands in the page: nothing is fetched, and all of it is there without
/// scripts.
#[test]
fn page_and_plots_show_every_measurement() {
    let folder = Folder::new("bench-page");
    let doc = folder.gnomon(&format!("{SMALL} --out-dir b --json")).json();
    let page = fs::read_to_string(folder.path("b/bench.html")).unwrap();
    let fetched = page.replace("http://www.w3.org/2000/svg", "");
    assert!(!fetched.contains("http") && !page.contains("NaN"));
    assert!(page.contains("prefers-color-scheme: dark") && page.contains("width=device-width"));
    let script = page.find("<script>").unwrap();
    for cell in doc["cells"].as_array().unwrap() {
        let technique = cell["technique"].as_str().unwrap();
        let bytes = format!("<td>{:.2}</td>", cell["bytes"].as_f64().unwrap() / 1e6);
        assert!(page[..script].contains(technique) && page[..script].contains(&bytes));
    }
    assert_eq!(page.matches("<figure class=\"cloud\">").count(), 9);
    for scene in ["cylinder", "parallel-plates", "two-box"] {
        for cost in ["time", "frame", "bytes"] {
            let name = format!("b/{scene}-32x24-1-{cost}");
            let svg = fs::read_to_string(folder.path(&format!("{name}.svg"))).unwrap();
            let picture = image::open(folder.path(&format!("{name}.png"))).unwrap();
            assert!(svg.contains(&format!("width=\"{}\"", picture.width())));
            for label in ["unshadowed", "pcf", "shadow-volumes"] {
                assert!(svg.contains(&format!(">{label}")), "{name}: {label}");
            }
            // Five measurements, each with words for whoever points at it.
            assert_eq!(svg.matches("<polygon").count(), 5, "{name}");
        }
    }
}

#[test]
fn suites_come_from_files_and_flags_replace_what_they_say() {
    let folder = Folder::new("bench-suite");
    folder.write(
        "mine.toml",
        "[suite]\nscenes = [\"cylinder\"]\ntechniques = [\"unshadowed\", \"pcf:taps=2|4\"]\n\
         sizes = [\"16x12\", \"24x16\"]\nthreads = [1]\n",
    );
    let doc = folder.gnomon("bench mine.toml --out-dir b --json").json();
    assert_eq!(
        (&doc["suite"], doc["cells"].as_array().unwrap().len()),
        (&"mine".into(), 6)
    );
    let doc = folder
        .gnomon("bench mine.toml --size 8x6 --out-dir c --json")
        .json();
    assert_eq!(doc["cells"].as_array().unwrap().len(), 3);
}

#[test]
fn bad_input_is_refused_and_leaves_nothing() {
    let folder = Folder::new("bench-bad");
    let suite = |lines: &str| folder.write("s.toml", &format!("[suite]\n{lines}\n"));
    let refused = |arguments: &str, parts: &[&str]| {
        folder.gnomon(arguments).refused(parts);
        assert_eq!(folder.names(), ["s.toml"], "{arguments}");
    };
    suite("scenes = [\"cylinder\"]\nrepeats = 5");
    refused("bench s.toml", &["s.toml:3: ", "repeats"]);
    suite("scenes = [\"cylinder\",\n \"cylindre\"]");
    refused("bench s.toml", &["s.toml:3: ", "'cylindre'", "cylinder"]);
    suite("scenes = [\"cylinder\"]\ntechniques = [\n\"pcf:taps=1|0\"]");
    refused("bench s.toml", &["s.toml:4: ", "'0'", "1 to 64"]);
    suite("scenes = [\"cylinder\"]\nlight = 7");
    refused("bench s.toml", &["s.toml:3: ", "light 7", "has 1"]);
    refused("bench s.toml cylinder", &["`s.toml` is a suite"]);
    refused("bench cylinder cylinder", &["two scenes", "`cylinder`"]);
    refused("bench nothing", &["SCENE: ", "'nothing'"]);
    refused(
        "bench cylinder --techniques pfc",
        &["--techniques: ", "'pfc'", "pcss"],
    );
    refused(
        "bench cylinder --light 3 --techniques pcf",
        &["--light: ", "has 1"],
    );
    refused("bench cylinder --shard 3/2", &["I/N"]);
    refused("bench cylinder --repeat 4", &["--repeat"]);
    refused("bench cylinder --size 0x3", &["WIDTHxHEIGHT"]);
    refused("bench cylinder --out-dir s.toml", &["--out-dir", "s.toml"]);
    refused("bench", &["SCENE|SUITE"]);
    refused("bench merge --out-dir m", &["DIR"]);
    refused("bench merge nowhere --out-dir m", &["nowhere/bench.plan"]);
}
