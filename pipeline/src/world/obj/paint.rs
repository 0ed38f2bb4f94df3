//! The materials of a model: its libraries, and which triangles each one has.

use std::collections::BTreeMap;
use std::sync::Arc;

use gnomon_raster::Sampler;

use super::library;
use super::map::MapLine;
use super::mesh::Faces;
use super::mtl::Materials;
use super::scan::Scan;
use crate::world::files::FileError;
use crate::world::material::MaterialPart;
use crate::world::tally::Tally;
use crate::world::texture::{CornerCoordinates, Gallery, Picture, REPEATED, SurfaceTexture};

/// Where material libraries come from.
pub(super) trait Libraries {
    /// Whether there is a library of that name.
    fn has(&self, name: &str) -> bool;

    /// The library's name for messages, and its bytes.
    fn read(&self, name: &str) -> Result<(String, Vec<u8>), FileError>;

    /// Whether there is a picture of that name beside a library.
    fn has_picture(&self, library: &str, name: &str) -> bool;

    /// Its bytes.
    fn picture(&self, library: &str, name: &str) -> Result<Vec<u8>, FileError>;
}

/// What the material libraries said.
#[derive(Default)]
pub(super) struct Paint {
    pub(super) materials: Materials,
    /// The materials in use, each with its triangles, in order of first use.
    pub(super) parts: Vec<MaterialPart>,
    /// Libraries that cannot be read.
    pub(super) missing: Tally,
    /// Materials that no library defines.
    pub(super) unknown: Tally,
    /// Pictures that cannot be used.
    pub(super) missing_maps: Tally,
    /// Of each part how coordinates become those of its picture.
    maps: Vec<Option<MapLine>>,
}

impl Paint {
    pub(super) fn of(
        scan: &Scan,
        faces: &Faces,
        libraries: &dyn Libraries,
        gallery: &mut Gallery,
    ) -> Self {
        let mut paint = Self::default();
        for line in &scan.libraries {
            for name in library::names(line, |name| libraries.has(name)) {
                match libraries.read(&name) {
                    Ok((file, bytes)) => paint.materials.read(&bytes, &name, &file),
                    Err(error) => paint.missing.add(|| format!("'{name}': {error}")),
                }
            }
        }
        let materials = paint.find_all(scan);
        let mut pictures = Pictures {
            libraries,
            known: BTreeMap::new(),
            gallery,
        };
        paint.share_out(&materials, faces, &mut pictures);
        paint
    }

    /// The material of each name that the model uses.
    fn find_all(&mut self, scan: &Scan) -> Vec<Option<usize>> {
        // Where libraries are missing, what is in them is no news.
        let news = self.materials.libraries > 0 || scan.libraries.is_empty();
        let find = |name: &String| {
            let found = self.materials.find(name);
            if found.is_none() && news {
                self.unknown.add(|| format!("'{name}'"));
            }
            found
        };
        scan.materials.iter().map(find).collect()
    }

    fn share_out(
        &mut self,
        materials: &[Option<usize>],
        faces: &Faces,
        pictures: &mut Pictures<'_>,
    ) {
        // The part of each material, once it has one.
        let mut part_of = vec![None; self.materials.len()];
        let mut next = 0;
        for &(count, name) in &faces.painted {
            let range = next..next + count as u32;
            next = range.end;
            let Some(material) = name.and_then(|n| materials[n as usize]) else {
                continue;
            };
            if range.is_empty() {
                continue;
            }
            let part = match part_of[material] {
                Some(part) => part,
                None => self.begin(material, pictures),
            };
            part_of[material] = Some(part);
            self.parts[part].triangles.extend(range);
        }
    }

    /// A part of a material, which no triangle has yet.
    fn begin(&mut self, material: usize, pictures: &mut Pictures<'_>) -> usize {
        let map = self.materials.map(material);
        let read = map.map(|(map, library)| pictures.read(map, library));
        let picture = match read {
            Some(Err(problem)) => {
                self.missing_maps.add(|| problem);
                None
            }
            Some(Ok(picture)) => Some(picture),
            None => None,
        };
        self.maps.push(map.map(|(map, _)| map.clone()));
        let texture = map.zip(picture).map(|((map, _), picture)| SurfaceTexture {
            sampler: Sampler {
                address: [map.address; 3],
                ..REPEATED
            },
            picture,
        });
        self.parts.push(MaterialPart {
            material: self.materials.material(material),
            texture,
            triangles: Vec::new(),
        });
        self.parts.len() - 1
    }

    /// Texture coordinates of all triangles, as their materials place them, v from above.
    pub(super) fn coordinates(&self, faces: &Faces) -> Vec<CornerCoordinates> {
        let turned = |[u, v]: [f64; 2]| [u as f32, (1.0 - v) as f32];
        let mut all: Vec<CornerCoordinates> = (faces.coordinates.iter())
            .map(|triangle| triangle.map(turned))
            .collect();
        for (part, map) in self.parts.iter().zip(&self.maps) {
            let Some(map) = map else { continue };
            let placed =
                |at: [f64; 2]| turned([0, 1].map(|k| at[k] * map.scale[k] + map.offset[k]));
            for &t in &part.triangles {
                if let Some(triangle) = faces.coordinates.get(t as usize) {
                    all[t as usize] = triangle.map(placed);
                }
            }
        }
        all
    }
}

/// Pictures of a model's materials, each read once.
struct Pictures<'a> {
    libraries: &'a dyn Libraries,
    known: BTreeMap<(String, String), Result<Arc<Picture>, String>>,
    gallery: &'a mut Gallery,
}

impl Pictures<'_> {
    /// The picture of a line of a library, or what is wrong with it.
    fn read(&mut self, map: &MapLine, library: &str) -> Result<Arc<Picture>, String> {
        let there = |name: &&String| self.libraries.has_picture(library, name);
        let name = map.names.iter().find(there);
        let name = name.or(map.names.first()).cloned().unwrap_or_default();
        let key = (library.to_owned(), name);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let read = self.load(library, &key.1);
        let read = read.map_err(|why| format!("'{}' of {library}: {why}", key.1));
        self.known.insert(key, read.clone());
        read
    }

    fn load(&mut self, library: &str, name: &str) -> Result<Arc<Picture>, String> {
        let bytes = self.libraries.picture(library, name);
        let bytes = bytes.map_err(|e| e.to_string())?;
        self.gallery.picture(&bytes).map_err(|e| e.to_string())
    }
}
