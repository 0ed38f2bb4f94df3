//! Damaged models, material libraries, maps and scenes: whatever the bytes, they
//! are read or refused, without a panic and without memory that they do not hold.
//!
//! A thousand of each kind always; a hundred thousand with
//! `cargo test --release -p gnomon-pipeline --test mutated_files -- --ignored`.

use std::path::{Path, PathBuf};

use gnomon_pipeline::world::environment::{Environment, MapSettings};
use gnomon_pipeline::world::obj;
use gnomon_pipeline::world::scene::file;

/// Whole numbers, always the same (Marsaglia's xorshift).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    /// A few changes: bytes, pieces of the kind, repetitions, cuts.
    fn mutated(&mut self, bytes: &[u8], pieces: &[&str]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for _ in 0..=self.below(6) {
            let at = self.below(bytes.len() + 1);
            match self.below(6) {
                0 if at < bytes.len() => bytes[at] = self.next() as u8,
                1 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
                2 => {
                    let piece = pieces[self.below(pieces.len())];
                    bytes.splice(at..at, piece.bytes());
                }
                3 => {
                    let end = (at + self.below(40)).min(bytes.len());
                    bytes.drain(at..end);
                }
                4 => {
                    let end = (at + self.below(40)).min(bytes.len());
                    let copy = bytes[at..end].to_vec();
                    bytes.splice(at..at, copy);
                }
                _ if self.below(20) == 0 => bytes.truncate(at),
                _ => {}
            }
        }
        bytes
    }
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const OBJ: &str = "# model\nmtllib m.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 0.25 0\nv 0 1 0\n\
v 0 0 1\nvt 0 0\nvn 0 0 1\nusemtl red\nf 1 2 3 4 5\nf 1/1/1 2//1 6\ng b\nf -1 -2 -3\nf 5 4 \\\n3 2 1\n";
const OBJ_PIECES: [&str; 16] = [
    "\n",
    "\r",
    "\\\n",
    "#",
    " ",
    "f 1 2 3 4 5 6\n",
    "f 1 4 2 5 3\n",
    "f 1 1 2\n",
    "-",
    "1e39",
    "nan",
    "v 0 0 0\n",
    "mtllib ",
    "usemtl ",
    "\"",
    "\u{feff}",
];
const MTL: &str =
    "newmtl red\nKd 0.8 0.1 0.1 # r\nKs 0.5\nNs 30\nillum 2\nmap_Kd a.png\nnewmtl b #2\nKd 1\n";
const MTL_PIECES: [&str; 10] = [
    "\n",
    "\r",
    "\\\n",
    "#",
    "newmtl ",
    "Kd ",
    "illum 999",
    "1e99",
    "\"",
    "\u{feff}",
];
const TOML: &str = "name = \"w\"\nsize = [16, 12]\nambient = [0.1, 0.1, 0.1]\n[camera]\neye = [0, 2, 5]\n\
target = [0, 0.5, 0]\nfov = 40\n[[lights]]\nshape.square = { centre = [1, 4, 1], side = 1 }\n[[objects]]\n\
mesh.box = { size = [1, 1, 1] }\nscale = [1, 2, 1]\nrotate = [0, 30, 0]\n[objects.motion]\nspin = [0, 1, 0]\n";
const TOML_PIECES: [&str; 14] = [
    "\n",
    "[",
    "]",
    ",",
    "{",
    "}",
    "nan",
    "-inf",
    "1e308",
    "[[objects]]\n",
    "\"",
    "=",
    "mesh.sphere = { subdivisions = 2, radius = 1 }\n",
    "0",
];

fn hdr() -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n".to_vec();
    for line in 0..4 {
        if line % 2 == 0 {
            bytes.extend([2, 2, 0, 8]);
            bytes.extend([136, 64, 136, 32, 4, 1, 2, 3, 4, 132, 7, 136, 129]);
        } else {
            bytes.extend([64, 32, 16, 129, 1, 1, 1, 3]);
            bytes.extend([9, 8, 7, 130].repeat(4));
        }
    }
    bytes
}
const HDR_PIECES: [&str; 10] = [
    "\n",
    "\n\n",
    "EXPOSURE=1e-300\n",
    "COLORCORR=1 2 3\n",
    "-Y 30000 +X 60000\n",
    "+X 4 -Y 8\n",
    "\u{1}\u{1}\u{1}\u{0}\u{1}\u{1}\u{1}\u{0}\u{1}\u{1}\u{1}\u{7f}",
    "\u{2}\u{2}\u{7f}",
    "#?RGBE\n",
    "FORMAT=32-bit_rle_xyze\n",
];

fn models(count: usize) {
    let folder = Folder::new("mutated-obj");
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut read = 0;
    for _ in 0..count {
        let text = random.mutated(OBJ.as_bytes(), &OBJ_PIECES);
        if let Ok(model) = obj::parse(&text, "m.obj") {
            let positions = model.shape.positions.len() as u32;
            assert!(
                model
                    .shape
                    .triangles
                    .iter()
                    .flatten()
                    .all(|i| *i < positions)
            );
            read += 1;
        }
    }
    assert!(read > count / 10, "{read} of {count} are models");
    let path = folder.write("m.obj", OBJ.as_bytes());
    for _ in 0..count / 4 {
        folder.write("m.mtl", &random.mutated(MTL.as_bytes(), &MTL_PIECES));
        obj::load(&path).unwrap();
    }
}

fn maps(count: usize) {
    let folder = Folder::new("mutated-hdr");
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let whole = hdr();
    let mut read = 0;
    for _ in 0..count {
        let path = folder.write("m.hdr", &random.mutated(&whole, &HDR_PIECES));
        let settings = MapSettings {
            side: 4,
            ..MapSettings::default()
        };
        read += usize::from(Environment::open(path.to_str().unwrap(), settings).is_ok());
    }
    assert!(read > count / 50, "{read} of {count} are maps");
}

fn scenes(count: usize) {
    let mut random = Random(0x1234_5678_9abc_def1);
    let mut read = 0;
    for _ in 0..count {
        let text = random.mutated(TOML.as_bytes(), &TOML_PIECES);
        let text = String::from_utf8_lossy(&text);
        read += usize::from(file::parse(&text, "s.toml", Path::new(".")).is_ok());
    }
    assert!(read > count / 100, "{read} of {count} are scenes");
}

/// The most memory that the process has had, where the system tells.
fn peak_kib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

fn all(count: usize) {
    assert!(file::parse(TOML, "s.toml", Path::new(".")).is_ok());
    models(count);
    maps(count);
    scenes(count);
    if let Some(peak) = peak_kib() {
        eprintln!("{count} of each: at most {peak} KiB");
        assert!(peak < 1 << 20, "{peak} KiB");
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    all(1_000);
}

#[test]
#[ignore = "minutes"]
fn a_hundred_thousand_damaged_files_are_read_or_refused() {
    all(100_000);
}
