//! The materials of a model: its libraries, and which triangles each one has.

use super::library;
use super::mesh::Faces;
use super::mtl::Materials;
use super::scan::Scan;
use crate::world::files::FileError;
use crate::world::material::MaterialPart;
use crate::world::tally::Tally;

/// Where material libraries come from.
pub(super) trait Libraries {
    /// Whether there is a library of that name.
    fn has(&self, name: &str) -> bool;

    /// The library's name for messages, and its bytes.
    fn read(&self, name: &str) -> Result<(String, Vec<u8>), FileError>;
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
}

impl Paint {
    pub(super) fn of(scan: &Scan, faces: &Faces, libraries: &dyn Libraries) -> Self {
        let mut paint = Self::default();
        for line in &scan.libraries {
            for name in library::names(line, |name| libraries.has(name)) {
                match libraries.read(&name) {
                    Ok((file, bytes)) => paint.materials.read(&bytes, &file),
                    Err(error) => paint.missing.add(|| format!("'{name}': {error}")),
                }
            }
        }
        let materials = paint.find_all(scan);
        paint.share_out(&materials, faces);
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

    fn share_out(&mut self, materials: &[Option<usize>], faces: &Faces) {
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
            let part = *part_of[material].get_or_insert_with(|| {
                self.parts.push(MaterialPart {
                    material: self.materials.material(material),
                    triangles: Vec::new(),
                });
                self.parts.len() - 1
            });
            self.parts[part].triangles.extend(range);
        }
    }
}
