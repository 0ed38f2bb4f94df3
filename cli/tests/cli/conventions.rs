//! What is written alike for every verb, and where things go.

use std::fs;

use crate::common::Folder;

/// Settings behind the name or in `--set`, either spelling of the flag, and any order give one
/// picture.
#[test]
fn techniques_are_written_alike_everywhere() {
    let folder = Folder::new("written-alike");
    let hash = |arguments: &str| {
        let line = format!("render cylinder --size 40x30 --json {arguments}");
        folder.gnomon(&line).json()["hash"]["color"].clone()
    };
    let wanted = hash("--technique pcf --set taps=2 --set map-size=64");
    assert_eq!(hash("--technique pcf:taps=2:map-size=64"), wanted);
    assert_eq!(hash("--techniques pcf:map-size=64 --set taps=2"), wanted);
    assert_ne!(hash("--technique pcf"), wanted);
    for verb in [
        "render cylinder --technique",
        "compare cylinder --technique",
        "stress --technique",
        "tune cylinder --max-error 1 --technique",
        "bench cylinder --technique",
        "report cylinder --out r.html --technique",
        "record cylinder --out t.gnt --technique",
    ] {
        for (given, told) in [
            ("pcf:taps", "`taps` of `pcf:taps`"),
            (":taps=2", "names no technique"),
            ("pcff", "did you mean 'pcf'"),
            ("pcf:tabs=2", "did you mean 'taps'"),
        ] {
            for verb in [verb.to_owned(), verb.replace("--technique", "--techniques")] {
                folder.gnomon(&format!("{verb} {given}")).refused(&[told]);
            }
        }
    }
    assert_eq!(folder.names(), ["out"]);
}

/// `-o`, `--out` and `--out-dir` are one flag.
#[test]
fn outputs_are_asked_for_alike() {
    let folder = Folder::new("outputs-alike");
    for (number, flag) in ["-o", "--out", "--out-dir"].into_iter().enumerate() {
        let render = format!("render cylinder --size 20x15 {flag} {number}.png");
        folder.gnomon(&render).fine();
        assert!(folder.path(&format!("{number}.png")).is_file());
        let compare = format!("compare cylinder --technique pcf --size 20x15 {flag} {number}");
        folder.gnomon(&compare).fine();
        let picture = format!("{number}/cylinder-compare.png");
        assert!(folder.path(&picture).is_file());
        let export = format!("export cylinder --size 20x15 {flag} {number}");
        folder.gnomon(&export).fine();
        assert!(folder.path(&format!("{number}/cylinder.glb")).is_file());
    }
}

/// The scene that is exported is none of the files that are written.
#[test]
fn exports_do_not_replace_what_they_are_made_of() {
    let folder = Folder::new("export-onto-itself");
    let toml = "[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n\
        [[lights]]\nshape.point = { position = [0, 4, 0] }\n[[objects]]\nmesh.plane = { half = 2 }\n";
    folder.write("mine.toml", toml);
    folder
        .gnomon("export mine.toml --out .")
        .refused(&["mine.toml", "another folder"]);
    assert_eq!(
        std::fs::read_to_string(folder.path("mine.toml")).unwrap(),
        toml
    );
    folder.gnomon("export mine.toml --out other").fine();
    folder.gnomon("render other/mine.toml --size 20x15").fine();
}

/// Four techniques where none is named, and those that take the light for `all`.
#[test]
fn comparisons_have_a_default() {
    let folder = Folder::new("compare-default");
    let run = folder
        .gnomon("compare parallel-plates --size 24x16 --csv -")
        .fine();
    let table = run.stdout();
    let names: Vec<&str> = (table.lines().skip(1))
        .filter_map(|l| l.split(',').next())
        .collect();
    let principal = [
        "shadow-volumes",
        "pcss",
        "convolution-soft-shadows",
        "soft-shadow-volumes",
    ];
    assert_eq!(names, principal);
    assert!(run.stderr().contains("RMSE"));
    let columns = table.lines().next().unwrap().split(',').count();
    assert!(table.lines().all(|l| l.split(',').count() == columns));
    folder
        .gnomon("compare parallel-plates --size 24x16 --technique pcf,pcf:taps=2 --csv t.csv")
        .fine();
    let table = fs::read_to_string(folder.path("t.csv")).unwrap();
    assert!(
        table.contains("\npcf,") && table.contains("\npcf taps=2,"),
        "{table}"
    );
    folder
        .gnomon("compare parallel-plates --size 24x16 --csv - --json")
        .refused(&["stdout is for the document of --json"]);
}

/// A picture on stdout is the file's, and nothing else is there.
#[test]
fn pictures_go_to_stdout() {
    let folder = Folder::new("to-stdout");
    let line = "render cylinder --size 40x30 --technique pcf:taps=2";
    folder.gnomon(&format!("{line} --out a.png")).fine();
    let run = folder.gnomon(&format!("{line} --out -")).fine();
    assert_eq!(run.bytes(), fs::read(folder.path("a.png")).unwrap());
    assert!(run.stderr().contains("visibility"));
    assert_eq!(folder.names(), ["a.png"]);
    for (more, told) in [
        ("--json", "--json prints there"),
        ("--overlay stencil", "overlays"),
        ("--show color", "buffers"),
        ("--frames 2", "stdout holds one picture"),
    ] {
        folder
            .gnomon(&format!("{line} --out - {more}"))
            .refused(&[told]);
    }
}

/// Linear light in floats: equal files for any number of threads, and what the PNG encodes.
#[test]
fn exr_pictures_are_the_same_each_time() {
    let folder = Folder::new("exr");
    let of = |name: &str, threads: u32| {
        let line = format!("render demo --size 70x50 --threads {threads} --out {name}");
        folder.gnomon(&line).fine();
        fs::read(folder.path(name)).unwrap()
    };
    let bytes = of("a.exr", 1);
    assert_eq!(bytes, of("b.exr", 2));
    of("c.png", 2);
    let open = |name: &str| image::open(folder.path(name)).unwrap();
    let (linear, shown) = (open("a.exr").to_rgb32f(), open("c.png").to_rgb8());
    let encode = |v: f32| match v {
        v if v <= 0.003_130_8 => 12.92 * v,
        v => 1.055 * libm::powf(v, 1.0 / 2.4) - 0.055,
    };
    let mut seen = 0;
    for (a, b) in linear.pixels().zip(shown.pixels()) {
        for (x, y) in a.0.iter().zip(&b.0) {
            let off = encode(x.clamp(0.0, 1.0)) * 255.0 - f32::from(*y);
            assert!(off.abs() < 0.51, "{x} {y}");
            seen += usize::from(*y > 20 && *y < 235);
        }
    }
    assert!(seen > 1000);
}

/// Pictures say what they are of, and nothing of the machine.
#[test]
fn pictures_say_what_they_are() {
    let folder = Folder::new("png-text");
    let of = |name: &str, more: &str| {
        let line = format!("render cylinder --size 40x30 --technique pcf:taps=2 {more}");
        folder
            .gnomon(&format!("{line} --overlay stencil --out {name}.png"))
            .fine();
        let names = [format!("{name}.png"), format!("{name}-stencil.png")];
        names.map(|n| fs::read(folder.path(&n)).unwrap())
    };
    let first = of("a", "--threads 1 --simd scalar");
    assert_eq!(first, of("b", "--threads 2 --tile 16"));
    for bytes in &first {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let software = concat!("tEXtSoftware\0gnomon ", env!("CARGO_PKG_VERSION"));
        for part in [
            software,
            "tEXtScene\0cylinder",
            "tEXtTechnique\0pcf",
            "taps=2",
        ] {
            assert!(text.contains(part), "{part}");
        }
    }
    let hash = folder.gnomon("render cylinder --size 40x30 --technique pcf:taps=2 --json -o c.png");
    let hash = hash.json()["hash"]["color"].as_str().unwrap().to_owned();
    assert!(String::from_utf8_lossy(&first[0]).contains(&hash));
}

/// Without being asked nothing is said but what was asked for; errors are.
#[test]
fn quiet_runs_say_nothing() {
    let folder = Folder::new("quiet");
    let run = folder
        .gnomon("-q render cylinder --size 20x15 -o a.png")
        .fine();
    assert!(run.stdout().is_empty() && run.stderr().is_empty());
    assert!(folder.path("a.png").is_file());
    let run = folder.gnomon("render cylinder --size 20x15 -o a.png --quiet --json");
    assert!(run.stderr().is_empty() && run.json()["hash"]["color"].is_string());
    let run = folder.gnomon("scenes -q");
    assert!(run.stdout().contains("cylinder"));
    folder.gnomon("render nothing -q").refused(&["nothing"]);
}

/// What cannot be written is told before a scene is even opened.
#[cfg(target_os = "linux")]
#[test]
fn outputs_are_probed_before_the_work() {
    let folder = Folder::new("probed");
    for line in [
        "render no-such-scene --out /proc/gnomon/a.png",
        "stress --scene no-such-scene --out /proc/gnomon",
        "record no-such-scene --out /proc/gnomon.gnt",
    ] {
        folder.gnomon(line).refused(&["/proc/gnomon"]);
    }
    // A folder that can be written is left as it was.
    folder
        .gnomon("render no-such-scene --out new/a.png")
        .refused(&[]);
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

/// Names of files carry what was set, so that one does not replace another.
#[test]
fn names_carry_what_distinguishes_pictures() {
    let folder = Folder::new("names");
    for more in ["pcf", "pcf:taps=2", "pcf --set taps=3 --time 0.5"] {
        let line = format!("render cylinder --size 20x15 --technique {more}");
        folder.gnomon(&line).fine();
    }
    let mut names: Vec<String> = fs::read_dir(folder.path("out"))
        .unwrap()
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let wanted = [
        "cylinder-pcf-taps-2.png",
        "cylinder-pcf-taps-3-time-0-5.png",
        "cylinder-pcf.png",
    ];
    assert_eq!(names, wanted);
}

/// Pictures of a longer animation would be played behind those of a shorter one.
#[test]
fn frames_of_earlier_runs_are_told_of() {
    let folder = Folder::new("leftover");
    let of = |count: u32| {
        let line = format!("render cylinder --size 20x15 --frames {count} --out f");
        let run = folder.gnomon(&line);
        run.fine().stdout()
    };
    assert!(!of(4).contains("leftover-frames"));
    let told = of(2);
    let line = told
        .lines()
        .find(|l| l.contains("leftover-frames"))
        .unwrap();
    assert!(line.contains("2 pictures") && line.contains("frame-0002.png to frame-0003.png"));
    assert!(!of(4).contains("leftover-frames"));
}

/// One technique with all of its parameters; completions and pages of every verb.
#[test]
fn help_is_there_in_every_form() {
    let folder = Folder::new("help-forms");
    let one = folder.gnomon("techniques pcss").stdout();
    assert!(one.contains("pcss") && one.contains("light=") && !one.contains("evsm"));
    let all = folder.gnomon("techniques").stdout();
    assert!(all.matches("color-format=").count() < 3, "listed once");
    let document = folder.gnomon("techniques pcss vsm --json").json();
    assert_eq!(document["techniques"].as_array().unwrap().len(), 2);
    folder
        .gnomon("techniques pcsss")
        .refused(&["did you mean 'pcss'"]);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.gnomon(&format!("completions {shell}")).stdout();
        assert!(
            script.contains("compare") && script.contains("visibility"),
            "{shell}"
        );
    }
    folder.gnomon("man pages").fine();
    let page = fs::read_to_string(folder.path("pages/gnomon-render.1")).unwrap();
    assert!(page.contains(".TH"));
    assert!(folder.path("pages/gnomon-bench-merge.1").is_file());
}
