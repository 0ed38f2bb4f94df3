//! Maps from files: Radiance `.hdr` and OpenEXR, by way of the `image` crate.
//!
//! The only place of this crate that knows that crate, and it only reads.

use std::path::Path;

use image::{ImageFormat, ImageReader};

use super::EnvironmentError;
use super::layout::Picture;

/// Files of a folder of six, in the order of faces.
const NAMES: [&str; 6] = ["px", "nx", "py", "ny", "pz", "nz"];

/// A file, or a folder of six.
pub(super) fn open(path: &Path) -> Result<Picture, EnvironmentError> {
    let name = path.display().to_string();
    if path.is_dir() {
        return six(path, &name);
    }
    let (size, texels) = file(path)?;
    Picture::new(&name, size, texels)
}

type Read = ([usize; 2], Vec<[f32; 3]>);

fn file(path: &Path) -> Result<Read, EnvironmentError> {
    let name = path.display().to_string();
    let unreadable = |why: String| EnvironmentError::Unreadable {
        name: name.clone(),
        why,
    };
    let reader = ImageReader::open(path).map_err(|e| unreadable(e.to_string()))?;
    let reader = reader
        .with_guessed_format()
        .map_err(|e| unreadable(e.to_string()))?;
    let known = [Some(ImageFormat::Hdr), Some(ImageFormat::OpenExr)];
    if !known.contains(&reader.format()) {
        return Err(EnvironmentError::UnknownKind { name });
    }
    let decoded = reader.decode().map_err(|e| unreadable(e.to_string()))?;
    let picture = decoded.into_rgb32f();
    let size = [picture.width() as usize, picture.height() as usize];
    Ok((size, picture.pixels().map(|p| p.0).collect()))
}

/// The six faces below each other.
fn six(folder: &Path, name: &str) -> Result<Picture, EnvironmentError> {
    let mut all = Vec::new();
    let mut side = 0;
    for face in NAMES {
        let path = ["hdr", "exr"].map(|e| folder.join(format!("{face}.{e}")));
        let found = path.iter().find(|p| p.is_file());
        let (size, texels) = file(found.ok_or_else(|| EnvironmentError::Unreadable {
            name: name.to_owned(),
            why: format!("the folder has no {face}.hdr or {face}.exr"),
        })?)?;
        side = if all.is_empty() { size[0] } else { side };
        if size != [side, side] {
            return Err(EnvironmentError::Faces {
                name: name.to_owned(),
                face: face.to_owned(),
                width: size[0],
                height: size[1],
                side,
            });
        }
        all.extend(texels);
    }
    Picture::new(name, [side, 6 * side], all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::environment::{Environment, MapSettings};
    use image::{ImageBuffer, Rgb};
    use std::fs;
    use std::path::PathBuf;

    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let id = std::process::id();
            let folder = std::env::temp_dir().join(format!("gnomon-environment-{name}-{id}"));
            let _ = fs::remove_dir_all(&folder);
            fs::create_dir_all(&folder).unwrap();
            Self(folder)
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

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
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
        let of = |path: PathBuf| open(&path).unwrap();
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
        let wrong = open(&folder.0).unwrap_err().to_string();
        assert!(wrong.contains("ny is 5x4"), "{wrong}");
        fs::remove_file(folder.0.join("py.exr")).unwrap();
        let missing = open(&folder.0).unwrap_err().to_string();
        assert!(missing.contains("no py.hdr or py.exr"), "{missing}");
    }

    #[test]
    fn what_is_no_map_is_refused() {
        let folder = Folder::new("wrong");
        let message = |path: &Path| open(path).unwrap_err().to_string();
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
