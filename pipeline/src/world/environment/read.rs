//! Maps from files: Radiance `.hdr` and OpenEXR, by way of the `image` crate.
//!
//! Only this file and its two modules know that crate, and they only read.

mod exr;
mod hdr;

use std::path::Path;

use super::EnvironmentError;
use super::layout::Picture;
use crate::world::files::{self, FileError, SceneFolder};
use crate::world::warning::SceneWarning;

/// Files of a folder of six, in the order of faces.
const NAMES: [&str; 6] = ["px", "nx", "py", "ny", "pz", "nz"];

/// Bytes of a map that are read at most.
const MAX_MAP_BYTES: u64 = 512 << 20;

/// Texels of a map at most: 11,585 x 5,792, far more than its lights are fitted to.
const MAX_TEXELS: usize = 1 << 26;

/// A picture as its file has it.
#[derive(Debug)]
struct Read {
    size: [usize; 2],
    /// Linear radiance, rows from the top.
    texels: Vec<[f32; 3]>,
    warnings: Vec<SceneWarning>,
}

/// Size and linear RGB of an OpenEXR picture, rows from the top; sizes that its bytes cannot
/// hold are refused.
///
/// # Errors
/// What is wrong with the file.
pub fn decode_exr(bytes: &[u8]) -> Result<([u32; 2], Vec<[f32; 3]>), String> {
    if !bytes.starts_with(exr::MAGIC) {
        return Err("is no OpenEXR file; those begin with 76 2f 31 01".to_owned());
    }
    let read = exr::decode(bytes)?;
    // At most 2^26 texels.
    Ok((read.size.map(|s| s as u32), read.texels))
}

/// A file, or a folder of six, which must lie in `within` if there is such.
pub(super) fn open(path: &Path, within: Option<&SceneFolder>) -> Result<Picture, EnvironmentError> {
    let name = path.display().to_string();
    let inside = within.map_or(Ok(()), |folder| folder.check(path));
    inside.map_err(|e| unreadable(&name, e))?;
    let read = if path.is_dir() {
        six(path, &name, within)?
    } else {
        file(path, within)?
    };
    let mut picture = Picture::new(&name, read.size, read.texels)?;
    picture.warnings.extend(read.warnings);
    Ok(picture)
}

fn unreadable(name: &str, why: FileError) -> EnvironmentError {
    EnvironmentError::Unreadable {
        name: name.to_owned(),
        why: why.to_string(),
    }
}

fn file(path: &Path, within: Option<&SceneFolder>) -> Result<Read, EnvironmentError> {
    let name = path.display().to_string();
    let bytes = match within {
        Some(folder) => folder.read(path, MAX_MAP_BYTES),
        None => files::read(path, MAX_MAP_BYTES),
    };
    let bytes = bytes.map_err(|e| unreadable(&name, e))?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    match decoded(bytes) {
        Some(read) => read.map_err(|why| EnvironmentError::Unreadable { name, why }),
        None => Err(EnvironmentError::UnknownKind { name }),
    }
}

/// What a Radiance or OpenEXR file holds; `None` for files of other kinds.
fn decoded(bytes: &[u8]) -> Option<Result<Read, String>> {
    if bytes.starts_with(hdr::MAGIC) {
        Some(hdr::decode(bytes))
    } else if bytes.starts_with(exr::MAGIC) {
        Some(exr::decode(bytes))
    } else {
        None
    }
}

/// Size and texels, rows from the top, of a picture that is no map.
pub(in crate::world) fn decode(bytes: &[u8]) -> Option<Result<DecodedPicture, String>> {
    Some(decoded(bytes)?.map(|read| (read.size, read.texels)))
}

/// Width and height, and linear texels in rows from the top.
pub(in crate::world) type DecodedPicture = ([usize; 2], Vec<[f32; 3]>);

/// The six faces below each other.
fn six(folder: &Path, name: &str, within: Option<&SceneFolder>) -> Result<Read, EnvironmentError> {
    let mut all = Read {
        size: [0; 2],
        texels: Vec::new(),
        warnings: Vec::new(),
    };
    for face in NAMES {
        let path = ["hdr", "exr"].map(|e| folder.join(format!("{face}.{e}")));
        let found = path.iter().find(|p| p.exists());
        let missing = || EnvironmentError::Unreadable {
            name: name.to_owned(),
            why: format!("the folder has no {face}.hdr or {face}.exr"),
        };
        let read = file(found.ok_or_else(missing)?, within)?;
        let side = if all.texels.is_empty() {
            read.size[0]
        } else {
            all.size[0]
        };
        if read.size != [side, side] {
            return Err(EnvironmentError::Faces {
                name: name.to_owned(),
                face: face.to_owned(),
                width: read.size[0],
                height: read.size[1],
                side,
            });
        }
        all.size = [side, 6 * side];
        all.texels.extend(read.texels);
        all.warnings.extend(read.warnings);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::environment::{Environment, MapSettings};
    use crate::world::scratch::Scratch;
    use image::{ImageBuffer, Rgb};
    use std::fs;
    use std::path::PathBuf;

    struct Folder(Scratch);

    impl Folder {
        fn new(name: &str) -> Self {
            Self(Scratch::made(&format!("environment-{name}")))
        }

        fn save(
            &self,
            name: &str,
            [w, h]: [u32; 2],
            texel: impl Fn(u32, u32) -> [f32; 3],
        ) -> PathBuf {
            let path = self.0.join(name);
            let picture = ImageBuffer::from_fn(w, h, |x, y| Rgb(texel(x, y)));
            picture.save(&path).unwrap();
            path
        }
    }

    /// Powers of two, which both formats hold exactly.
    fn texel(x: u32, y: u32) -> [f32; 3] {
        let v = f32::from(1u16 << ((x + 3 * y) % 5));
        [v, v / 2.0, v / 4.0]
    }

    #[test]
    fn hdr_and_exr_files_hold_the_same_map() {
        let folder = Folder::new("formats");
        let of = |path: PathBuf| open(&path, None).unwrap();
        let hdr = of(folder.save("a.hdr", [8, 4], texel));
        let exr = of(folder.save("a.exr", [8, 4], texel));
        assert_eq!(hdr.texels, exr.texels);
        assert_eq!(hdr.texels[9], texel(1, 1));
    }

    #[test]
    fn six_files_are_a_cube() {
        let folder = Folder::new("six");
        for (face, name) in NAMES.iter().enumerate() {
            let bright = [face as f32 + 1.0; 3];
            folder.save(&format!("{name}.exr"), [4, 4], |_, _| bright);
        }
        let name = folder.0.display().to_string();
        let map = Environment::open(&name, MapSettings::default()).unwrap();
        assert_eq!(map.cube.side(), 4);
        for (i, rgb) in map.cube.radiance().enumerate() {
            assert!(
                (rgb[0] - (i / 16 + 1) as f64).abs() < 1e-6,
                "texel {i}: {rgb:?}"
            );
        }
        folder.save("ny.exr", [5, 4], |_, _| [1.0; 3]);
        let wrong = open(&folder.0, None).unwrap_err().to_string();
        assert!(wrong.contains("ny is 5x4"), "{wrong}");
        fs::remove_file(folder.0.join("py.exr")).unwrap();
        let missing = open(&folder.0, None).unwrap_err().to_string();
        assert!(missing.contains("no py.hdr or py.exr"), "{missing}");
    }

    #[test]
    fn what_is_no_map_is_refused() {
        let folder = Folder::new("wrong");
        let message = |path: &Path| open(path, None).unwrap_err().to_string();
        assert!(message(&folder.0.join("none.hdr")).contains("none.hdr"));
        let text = folder.0.join("text.hdr");
        fs::write(&text, "not a picture").unwrap();
        assert!(!message(&text).is_empty());
        let cut = folder.save("cut.hdr", [64, 32], texel);
        let bytes = fs::read(&cut).unwrap();
        fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
        assert!(message(&cut).contains("cut.hdr"));
        let png = folder.0.join("a.png");
        image::RgbImage::new(4, 2).save(&png).unwrap();
        assert!(message(&png).contains(".exr"), "{}", message(&png));
    }
}
