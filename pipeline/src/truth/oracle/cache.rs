//! Oracle images on disk, found by the content of what they show.
//!
//! The name of a file is a BLAKE3 hash of everything that decides the image:
//! geometry to the bit, who casts, the light's shape, the camera, the size and
//! [`super::area::ORACLE_VERSION`], for images by shadow rays also their number,
//! their seed and [`super::sampled::SAMPLED_VERSION`], for an image on the light its
//! texels and the colour. Names, materials and colours do not. A file is
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | `GNOMVIS` and a line feed |
//! | 4 | format version, 1 |
//! | 4, 4 | width, height |
//! | 32 | the hash that is its name |
//! | 8 per pixel | visibility, IEEE double, row 0 on top |
//! | 32 | BLAKE3 hash of all before |
//!
//! with all numbers little-endian. A file that fails any check is ignored with a
//! warning, and replaced. It is written under another name and then renamed, so
//! that no reader, and no crash, meets half of one. A cache that cannot be
//! written costs time, not the result.

mod key;
mod transport;

use std::fs;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::area::VisibilityImage;
use super::sampled::SampledOracle;
use super::surfaces::Surfaces;
use crate::world::error::LightError;
use crate::world::files::{self, FileError};
use crate::world::light::LightShape;
use crate::world::light_image::LightImage;
use crate::world::scene::Scene;
use key::Key;
pub use transport::CachedTransport;

const MAGIC: &[u8; 8] = b"GNOMVIS\n";
const FORMAT_VERSION: u32 = 1;
const HEADER: usize = 8 + 4 + 4 + 4 + 32;
const CHECKSUM: usize = 32;

/// A folder of oracle images.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OracleCache {
    folder: PathBuf,
}

/// An image and how it was come by.
#[derive(Clone, Debug, PartialEq)]
pub struct Cached {
    /// The image.
    pub image: VisibilityImage,
    /// Whether it was read; else it was computed.
    pub was_read: bool,
    /// What went wrong with the cache; the image is right all the same.
    pub warnings: Vec<CacheWarning>,
}

/// What went wrong with a cache.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum CacheWarning {
    /// A file was not used.
    #[error("{}: {problem}; ignored, and computed anew", .path.display())]
    Ignored {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// The image could not be kept.
    #[error("{}: cannot be written: {problem}; it will be computed again", .path.display())]
    NotWritten {
        /// The file.
        path: PathBuf,
        /// What the system says.
        problem: String,
    },
}

impl OracleCache {
    /// A cache in `folder`, which is made when first written to.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
        }
    }

    /// Visibility of light number `light` for every pixel of `scene` at `size`:
    /// read if it is there, else computed and kept. `row_done` is called for
    /// each row computed.
    ///
    /// # Errors
    /// The light should have an extent and has none.
    ///
    /// # Panics
    /// There is no such light.
    pub fn visibility(
        &self,
        scene: &Scene,
        light: usize,
        size: [u32; 2],
        row_done: &(dyn Fn() + Sync),
    ) -> Result<Cached, LightError> {
        let key = Key::of(scene, &scene.lights[light].shape, size);
        self.image(&key, size, || {
            VisibilityImage::of_scene(scene, light, size, row_done)
        })
    }

    /// The same by shadow rays, `rays` being the side of the square of strata and
    /// the seed; see [`SampledOracle`].
    ///
    /// # Errors
    /// As [`OracleCache::visibility`].
    ///
    /// # Panics
    /// There is no such light.
    pub fn sampled(
        &self,
        scene: &Scene,
        light: usize,
        size: [u32; 2],
        rays: (u32, u64),
        row_done: &(dyn Fn() + Sync),
    ) -> Result<Cached, LightError> {
        let shape = &scene.lights[light].shape;
        self.image(&Key::of_rays(scene, shape, size, rays), size, || {
            let surfaces = Surfaces::new(scene);
            let oracle = SampledOracle::new(&surfaces, shape, rays.0, rays.1)?;
            Ok(oracle.image(&surfaces, scene, size, row_done))
        })
    }

    /// The same of one colour, 0 for red, of an image on the light, a rectangle.
    ///
    /// # Errors
    /// As [`OracleCache::visibility`].
    ///
    /// # Panics
    /// There is no such light.
    pub fn of_light_image(
        &self,
        scene: &Scene,
        light: usize,
        of: (&LightImage, usize),
        size: [u32; 2],
        row_done: &(dyn Fn() + Sync),
    ) -> Result<Cached, LightError> {
        let key = Key::of_light_image(scene, &scene.lights[light].shape, size, of);
        self.image(&key, size, || {
            VisibilityImage::of_light_image(scene, light, of, size, row_done)
        })
    }

    /// The image called `key`: read, or else computed and kept.
    fn image(
        &self,
        key: &Key,
        size: [u32; 2],
        compute: impl FnOnce() -> Result<VisibilityImage, LightError>,
    ) -> Result<Cached, LightError> {
        let path = self.folder.join(key.file_name());
        let mut warnings = Vec::new();
        match read(&path, key, size) {
            Ok(Some(image)) => {
                let was_read = true;
                return Ok(Cached {
                    image,
                    was_read,
                    warnings,
                });
            }
            Ok(None) => {}
            Err(problem) => warnings.push(CacheWarning::Ignored {
                path: path.clone(),
                problem,
            }),
        }
        let image = compute()?;
        if let Err(error) = self.write(&path, &encode(key, &image)) {
            let problem = error.to_string();
            warnings.push(CacheWarning::NotWritten { path, problem });
        }
        Ok(Cached {
            image,
            was_read: false,
            warnings,
        })
    }

    /// Where the image of a light is kept.
    pub fn path(&self, scene: &Scene, light: &LightShape, size: [u32; 2]) -> PathBuf {
        self.folder.join(Key::of(scene, light, size).file_name())
    }

    /// Writes whole files, into a folder that is made where there is none.
    fn write(&self, path: &Path, bytes: &[u8]) -> std::io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        files::write(path, bytes)
    }
}

/// The image in a file; `None` if there is no such file.
fn read(path: &Path, key: &Key, size: [u32; 2]) -> Result<Option<VisibilityImage>, String> {
    let length = HEADER + size[0] as usize * size[1] as usize * 8 + CHECKSUM;
    let bytes = match files::read(path, length as u64) {
        Ok(bytes) => bytes,
        Err(FileError::Unreadable(e)) if e.kind() == std::io::ErrorKind::NotFound => {
            return Ok(None);
        }
        Err(FileError::TooLong { .. }) => {
            return Err(format!("too long: {length} bytes are expected"));
        }
        Err(e) => return Err(e.to_string()),
    };
    decode(&bytes, length, key, size).map(Some)
}

fn encode(key: &Key, image: &VisibilityImage) -> Vec<u8> {
    let mut bytes = Vec::from(*MAGIC);
    for number in [FORMAT_VERSION, image.size[0], image.size[1]] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(key.0);
    bytes.extend(image.values.iter().flat_map(|v| v.to_le_bytes()));
    let checksum = *blake3::hash(&bytes).as_bytes();
    bytes.extend(checksum);
    bytes
}

fn decode(
    bytes: &[u8],
    length: usize,
    key: &Key,
    size: [u32; 2],
) -> Result<VisibilityImage, String> {
    if !bytes.starts_with(MAGIC) {
        return Err("not an oracle image".into());
    }
    let number = |at: usize| bytes.get(at..at + 4).map(|b| [b[0], b[1], b[2], b[3]]);
    let number = |at: usize| number(at).map(u32::from_le_bytes);
    if let Some(version) = number(8).filter(|v| *v != FORMAT_VERSION) {
        return Err(format!(
            "format {version}, but this is for format {FORMAT_VERSION}"
        ));
    }
    if bytes.len() != length {
        let relation = if bytes.len() < length {
            "truncated"
        } else {
            "too long"
        };
        return Err(format!("{relation}: {length} bytes are expected"));
    }
    if [number(12), number(16)] != size.map(Some) || bytes[20..HEADER] != key.0 {
        return Err("an image of something else".into());
    }
    let (content, checksum) = bytes.split_at(length - CHECKSUM);
    if blake3::hash(content).as_bytes() != checksum {
        return Err("damaged: the checksum differs".into());
    }
    let values = content[HEADER..].as_chunks::<8>().0;
    Ok(VisibilityImage {
        size,
        values: values.iter().map(|v| f64::from_le_bytes(*v)).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;
    use crate::world::scratch::Scratch;

    const SIZE: [u32; 2] = [24, 16];

    struct Folder(Scratch);

    impl Folder {
        fn new(test: &str) -> Self {
            Self(Scratch::new(&format!("oracle-cache-{test}")))
        }

        fn files(&self) -> Vec<String> {
            let entries = fs::read_dir(&*self.0).unwrap();
            let name = |e: std::io::Result<fs::DirEntry>| e.unwrap().file_name().into_string();
            entries.map(|e| name(e).unwrap()).collect()
        }
    }

    fn scene() -> Scene {
        builtin::build("peer-a").unwrap()
    }

    fn get(cache: &OracleCache, scene: &Scene) -> Cached {
        cache.visibility(scene, 0, SIZE, &|| {}).unwrap()
    }

    #[test]
    fn the_second_time_it_is_read_with_the_same_bits() {
        let folder = Folder::new("read");
        let cache = OracleCache::new(&*folder.0);
        let first = get(&cache, &scene());
        let never = || panic!("nothing is computed the second time");
        let second = cache.visibility(&scene(), 0, SIZE, &never).unwrap();
        assert_eq!((first.was_read, second.was_read), (false, true));
        assert!(first.image == second.image && first.image.values.iter().any(|v| v.is_nan()));
        assert!(first.warnings.is_empty() && second.warnings.is_empty());
        assert_eq!(folder.files().len(), 1, "no unfinished file is left");
    }

    #[test]
    fn images_by_rays_are_kept_apart() {
        let folder = Folder::new("rays");
        let cache = OracleCache::new(&*folder.0);
        let exact = get(&cache, &scene()).image;
        let by = |rays| cache.sampled(&scene(), 0, SIZE, rays, &|| {}).unwrap();
        let (first, again, other) = (by((4, 7)), by((4, 7)), by((4, 8)));
        assert_eq!(
            [&first, &again, &other].map(|c| c.was_read),
            [false, true, false]
        );
        assert!(first.image == again.image && first.image != other.image);
        assert!(first.image != exact && folder.files().len() == 3);
    }

    #[test]
    fn damaged_and_foreign_files_are_ignored_and_replaced() {
        let folder = Folder::new("damaged");
        let cache = OracleCache::new(&*folder.0);
        let truth = get(&cache, &scene()).image;
        let path = cache.path(&scene(), &scene().lights[0].shape, SIZE);
        let whole = fs::read(&path).unwrap();
        let flipped = |at: usize| {
            let mut bytes = whole.clone();
            bytes[at] ^= 1;
            bytes
        };
        let damages = [
            (Vec::new(), "not an oracle image"),
            (b"P6\n24 16\n255\n".to_vec(), "not an oracle image"),
            (flipped(8), "format 0"),
            (flipped(12), "something else"),
            (flipped(30), "something else"),
            (flipped(HEADER + 70), "damaged"),
            (flipped(whole.len() - 1), "damaged"),
            (whole[..whole.len() - 9].to_vec(), "truncated"),
            (whole[..11].to_vec(), "truncated"),
            ([&whole[..], &[0; 3]].concat(), "too long"),
        ];
        for (bytes, problem) in damages {
            fs::write(&path, bytes).unwrap();
            let found = get(&cache, &scene());
            assert!(!found.was_read && found.image == truth);
            let [warning] = &found.warnings[..] else {
                panic!("{:?}", found.warnings);
            };
            assert!(warning.to_string().contains(problem), "{warning}");
            assert_eq!(fs::read(&path).unwrap(), whole, "{problem}: replaced");
        }
    }

    #[test]
    fn a_cache_that_cannot_be_written_only_warns() {
        let folder = Folder::new("blocked");
        fs::write(&*folder.0, "a file where the folder should be").unwrap();
        let found = get(&OracleCache::new(&*folder.0), &scene());
        assert!(found.image.values.contains(&1.0));
        let written = |w: &CacheWarning| matches!(w, CacheWarning::NotWritten { .. });
        assert!(found.warnings.iter().any(written), "{:?}", found.warnings);
        fs::remove_file(&*folder.0).unwrap();
    }
}
