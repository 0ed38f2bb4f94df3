//! A suite that can be measured.

use std::fmt::{self, Write};
use std::path::Path;

use gnomon_pipeline::measure::comparison::{CompareError, ReferenceKind};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::scene::{Scene, SceneSource};

use super::entry::Entry;
use super::grid;
use super::request::{Given, Request};
use crate::error::CliError;
use crate::verbs;

/// A suite, ready to be measured.
pub(crate) struct Suite {
    pub(crate) name: String,
    pub(crate) scenes: Vec<Subject>,
    pub(crate) entries: Vec<Entry>,
    pub(crate) sizes: Vec<[u32; 2]>,
    pub(crate) threads: Vec<usize>,
    pub(crate) repeat: u32,
    pub(crate) light: usize,
    pub(crate) reference: ReferenceKind,
}

/// A scene.
pub(crate) struct Subject {
    /// What it is called in tables and file names.
    pub(crate) name: String,
    pub(crate) scene: Scene,
    /// Of everything in the scene but its name.
    pub(crate) hash: String,
}

/// Most cells of a suite.
const MOST_CELLS: usize = 1_000_000;

/// What is said of a suite of so many cells, if it is too many.
pub(crate) fn too_many(cells: Option<usize>) -> Option<String> {
    let fits = cells.is_some_and(|n| n <= MOST_CELLS);
    (!fits).then(|| format!("the suite has more than {MOST_CELLS} cells; give fewer values"))
}

impl Suite {
    /// Opens the scenes, finds the techniques, expands the grids.
    pub(crate) fn new(request: &Request, registry: &Registry) -> Result<Self, CliError> {
        let light = request.light.value;
        let mut entries = Vec::new();
        for given in &request.techniques {
            entries.extend(grid::expand(given, registry, light)?);
        }
        let mut scenes: Vec<Subject> = Vec::new();
        for given in &request.scenes {
            let subject = Subject::open(given, request)?;
            if scenes.iter().any(|s| s.name == subject.name) {
                let name = &subject.name;
                return Err(given.wrong(format!("two scenes would be called `{name}` in tables")));
            }
            let count = subject.scene.lights.len();
            if light >= count {
                let error = CompareError::NoSuchLight {
                    given: light,
                    count,
                };
                let name = &subject.name;
                return Err(request.light.wrong(format!("scene `{name}`: {error}")));
            }
            scenes.push(subject);
        }
        Ok(Self {
            name: request.name.clone(),
            scenes,
            entries,
            sizes: request.sizes.clone(),
            threads: request.threads.clone(),
            repeat: request.repeat,
            light,
            reference: request.reference,
        })
    }
}

impl Subject {
    fn open(given: &Given<String>, request: &Request) -> Result<Self, CliError> {
        let path = Path::new(&given.value);
        let (mut stem, mut name) = (given.value.clone(), given.value.clone());
        if path.extension().is_some() {
            let file_stem = path.file_stem().unwrap_or_default();
            stem = file_stem.to_string_lossy().into_owned();
            name = request.folder.join(path).to_string_lossy().into_owned();
        }
        let opened = SceneSource::open_with(&name, request.outside);
        let scene = opened.and_then(|mut s| s.at(request.time));
        Self::new(verbs::file_stem(&stem), scene.map_err(|e| given.wrong(e))?)
            .map_err(|e| given.wrong(e))
    }

    fn new(name: String, mut scene: Scene) -> Result<Self, fmt::Error> {
        // A model is called by its path, which decides nothing.
        scene.name.clone_from(&name);
        let hash = hash_of(&scene)?;
        Ok(Self { name, scene, hash })
    }
}

/// Hash of all fields as they print themselves: numbers with the digits that tell them
/// from all others.
fn hash_of(scene: &Scene) -> Result<String, fmt::Error> {
    struct Hashing(blake3::Hasher);
    impl Write for Hashing {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.update(text.as_bytes());
            Ok(())
        }
    }
    let mut hashing = Hashing(blake3::Hasher::new());
    write!(hashing, "{scene:?}")?;
    Ok(hashing.0.finalize().to_hex().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_changes_a_scene_changes_its_hash() {
        type Change = fn(&mut Scene);
        let changes: [Change; 7] = [
            |_| {},
            |s| s.ambient[1] += 1e-7,
            |s| s.lights[0].colour[0] *= 0.5,
            |s| s.objects[0].material.albedo[2] = 0.123,
            |s| s.objects[1].casts = false,
            |s| s.camera.eye.x += 1e-12,
            |s| s.objects.swap(0, 1),
        ];
        let hash = |change: &Change| {
            let mut scene = gnomon_pipeline::world::scene::open("peer-a").unwrap();
            change(&mut scene);
            Subject::new("peer-a".to_owned(), scene).unwrap().hash
        };
        let mut hashes: Vec<String> = changes.iter().map(hash).collect();
        assert_eq!(hashes[0], hash(&changes[0]));
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), changes.len());
    }
}
