//! Stencil buffers of the peer scenes against another rasteriser's, count for
//! count, each differing pixel explained by the f64 truth.
//!
//! `GNOMON_PEER_STENCIL` names a folder with the files that the peers'
//! `gl_shadow_volumes.py --out FOLDER` writes: `gl_DRIVER_SCENE_SIZE_stencil.npy`.
//! Without it there is nothing to compare with and the test passes.

use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::render::{RenderSettings, render};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques;
use gnomon_pipeline::truth::oracle::hard::{EdgeTolerance, HardOracle, HardTruth};
use gnomon_pipeline::world::scene::{EyeRays, Scene, builtin};
use gnomon_raster::GpuConfig;
use gnomon_tests::npy::ByteImage;

/// Why the two may differ at a pixel, or who is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    /// Within half a pixel of an outline of an object.
    Silhouette,
    /// Within half a pixel of an edge of a shadow.
    ShadowEdge,
    /// Moving the surface by four steps of the depth buffer changes the count.
    DepthGrazing,
    /// No excuse, and ours is the truth.
    PeerWrong,
    /// No excuse, and ours is not the truth.
    OursWrong,
}

const CAUSES: [(Cause, &str); 5] = [
    (Cause::Silhouette, "silhouette"),
    (Cause::ShadowEdge, "shadow edge"),
    (Cause::DepthGrazing, "depth-grazing"),
    (Cause::PeerWrong, "peer wrong"),
    (Cause::OursWrong, "ours wrong"),
];

/// One peer file: driver, scene letter, size.
struct PeerFile {
    path: PathBuf,
    driver: String,
    scene: String,
    size: u32,
}

impl PeerFile {
    fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        let stem = name.strip_prefix("gl_")?.strip_suffix("_stencil.npy")?;
        let [driver, scene, size] = stem.split('_').collect::<Vec<_>>()[..] else {
            return None;
        };
        Some(Self {
            path: path.to_owned(),
            driver: driver.into(),
            scene: scene.to_lowercase(),
            size: size.parse().ok()?,
        })
    }
}

/// Samples to each side of a pixel's centre, over half a pixel, where a thin
/// shadow may have slipped between the truth's own samples.
const FINE: i32 = 32;

/// The truth with and without the tolerance in depth.
struct Truths {
    lenient: HardTruth,
    strict: HardTruth,
    oracle: HardOracle,
    rays: EyeRays,
    width: u32,
}

impl Truths {
    fn new(scene: &Scene, size: u32) -> Self {
        let of = |tolerance| HardTruth::of_scene(scene, 0, [size; 2], tolerance);
        Self {
            lenient: of(EdgeTolerance::HALF_PIXEL_AND_DEPTH),
            strict: of(EdgeTolerance::HALF_PIXEL),
            oracle: HardOracle::new(scene, scene.lights[0].hard()),
            rays: scene.camera.eye_rays(size, size),
            width: size,
        }
    }

    /// What the stencil should hold; the background has no count of its own.
    fn count(&self, i: usize) -> u8 {
        (self.strict.pixels[i].centre.shadow_count % 256) as u8
    }

    /// Whether a surface is seen, away from every edge by the truth's samples.
    fn is_interior(&self, i: usize) -> bool {
        self.lenient.pixels[i].interior && self.strict.pixels[i].centre.hit.is_some()
    }

    /// Whether dense samples within half a pixel all agree with the centre.
    fn holds_closely(&self, i: usize) -> bool {
        let width = self.width as usize;
        let centre = self.strict.pixels[i].centre;
        let [x, y] = [i % width, i / width].map(|k| k as f64 + 0.5);
        let offset = |k: i32| f64::from(k) / f64::from(2 * FINE);
        let agrees = |dx: i32, dy: i32| {
            let s = self
                .oracle
                .sample(&self.rays, x + offset(dx), y + offset(dy));
            s.shadow_count == centre.shadow_count
                && s.hit.map(|h| h.object) == centre.hit.map(|h| h.object)
        };
        (-FINE..=FINE).all(|dy| (-FINE..=FINE).all(|dx| agrees(dx, dy)))
    }

    fn cause(&self, i: usize, ours: u8) -> Cause {
        let interior = self.lenient.pixels[i].interior;
        if interior && self.holds_closely(i) {
            return if ours == self.count(i) {
                Cause::PeerWrong
            } else {
                Cause::OursWrong
            };
        }
        if !interior && self.strict.pixels[i].interior {
            return Cause::DepthGrazing;
        }
        if self.near_outline(i) {
            Cause::Silhouette
        } else {
            Cause::ShadowEdge
        }
    }

    /// Whether a neighbouring pixel's centre shows another object.
    fn near_outline(&self, i: usize) -> bool {
        let width = i64::from(self.width);
        let object = |x: i64, y: i64| {
            let (x, y) = (x.clamp(0, width - 1), y.clamp(0, width - 1));
            let pixel = &self.strict.pixels[(y * width + x) as usize];
            pixel.centre.hit.map(|h| h.object)
        };
        let (x, y) = (i as i64 % width, i as i64 / width);
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
        around
            .into_iter()
            .any(|(dx, dy)| object(x + dx, y + dy) != object(x, y))
    }

    /// Pixels without an excuse that do not hold the truth.
    fn unexcused(&self, stencil: &[u8]) -> Vec<usize> {
        (0..stencil.len())
            .filter(|&i| self.is_interior(i) && stencil[i] != self.count(i))
            .filter(|&i| self.holds_closely(i))
            .collect()
    }
}

fn our_stencil(scene: &Scene, size: u32) -> Vec<u8> {
    let technique = techniques::find("shadow-volumes").expect("a built-in technique");
    let params = Params::parse(technique, ["method=zfail", "depth-format=d24"]).expect("valid");
    let settings = RenderSettings {
        size: [size; 2],
        gpu: GpuConfig::default(),
        repeat: 1,
    };
    let rendered = render(scene, technique, &params, &settings).expect("a peer scene renders");
    rendered.stencil
}

/// Prints a row of the table; pixels in which ours has no excuse.
fn compare(file: &PeerFile) -> usize {
    let path = file.path.display();
    let bytes = std::fs::read(&file.path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let peer = ByteImage::parse(&bytes).unwrap_or_else(|e| panic!("{path}: {e}"));
    assert_eq!(
        [peer.width, peer.height],
        [file.size as usize; 2],
        "{path}: the size in its name"
    );
    let name = format!("peer-{}", file.scene);
    let scene = builtin::build(&name).unwrap_or_else(|e| panic!("{path}: {e}"));
    let ours = our_stencil(&scene, file.size);
    let truths = Truths::new(&scene, file.size);

    let all = 0..ours.len();
    let interior = all.clone().filter(|&i| truths.is_interior(i)).count();
    let wrong = truths.unexcused(&ours);
    let peer_wrong = truths.unexcused(&peer.pixels);
    let differing: Vec<usize> = all.filter(|&i| ours[i] != peer.pixels[i]).collect();
    let causes: Vec<Cause> = differing
        .iter()
        .map(|&i| truths.cause(i, ours[i]))
        .collect();
    let shadowed = |s: &[u8]| s.iter().filter(|v| **v != 0).count();
    let right = |s: &[u8]| {
        differing
            .iter()
            .filter(|&&i| s[i] == truths.count(i))
            .count()
    };

    let mut row = vec![shadowed(&ours), shadowed(&peer.pixels), differing.len()];
    row.extend(CAUSES.map(|(cause, _)| causes.iter().filter(|c| **c == cause).count()));
    row.extend([right(&ours), right(&peer.pixels)]);
    row.extend([interior, wrong.len(), peer_wrong.len()]);
    let (driver, scene) = (&file.driver, file.scene.to_uppercase());
    print!("| {driver} | {scene} | {} |", file.size);
    row.iter().for_each(|n| print!(" {n} |"));
    println!();
    for &i in wrong.iter().chain(&peer_wrong) {
        let (x, y) = (i % peer.width, i / peer.width);
        let (peer, truth) = (peer.pixels[i], truths.count(i));
        println!(
            "    ({x}, {y}): ours {}, peer {peer}, truth {truth}",
            ours[i]
        );
    }
    wrong.len()
}

fn peer_files(folder: &str) -> Vec<PeerFile> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{folder}: {e}"));
    let paths = entries.map(|e| e.unwrap_or_else(|e| panic!("{folder}: {e}")).path());
    let mut files: Vec<PeerFile> = paths.filter_map(|p| PeerFile::of(&p)).collect();
    files.sort_by(|a, b| a.path.cmp(&b.path));
    files
}

#[test]
fn differences_from_the_peers_are_explained() {
    let Ok(folder) = std::env::var("GNOMON_PEER_STENCIL") else {
        println!("GNOMON_PEER_STENCIL is not set: nothing to compare with");
        return;
    };
    let files = peer_files(&folder);
    assert!(
        !files.is_empty(),
        "{folder}: no gl_DRIVER_SCENE_SIZE_stencil.npy"
    );
    print!("| peer | scene | size | shadowed, ours | shadowed, peer | differing |");
    CAUSES.iter().for_each(|(_, name)| print!(" {name} |"));
    println!(
        " ours true | peer true | interior pixels | ours wrong there | peer wrong there |\n|{}",
        " --- |".repeat(16)
    );
    let wrong: usize = files.iter().map(compare).sum();
    assert_eq!(
        wrong, 0,
        "pixels away from every edge that are not the truth"
    );
}
