//! Pictures of materials: on which triangles, where on them, and what if there are none.

use std::fs;
use std::io::Cursor;

use gnomon_raster::state::AddressMode;

use super::*;
use crate::world::scratch::Scratch;

const SQUARE: &str = "mtllib lib/paint.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\
    vt 0 0\nvt 1 0\nvt 1 0.75\nvt 0 0.75\nusemtl wood\n";

fn png() -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = image::RgbImage::from_raw(2, 1, vec![255, 0, 0, 0, 0, 255]).unwrap();
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A model whose library is in a folder of its own, with a picture beside it.
fn read(faces: &str, library: &str) -> ObjMesh {
    let folder = Scratch::made(&format!(
        "obj-map-{}",
        blake3::hash((faces.to_owned() + library).as_bytes())
    ));
    fs::create_dir_all(folder.join("lib")).unwrap();
    fs::write(folder.join("it.obj"), format!("{SQUARE}{faces}")).unwrap();
    fs::write(folder.join("lib/paint.mtl"), library).unwrap();
    fs::write(folder.join("lib/a.png"), png()).unwrap();
    fs::write(folder.join("out.png"), png()).unwrap();
    load(&folder.join("it.obj")).unwrap()
}

const LIBRARY: &str = "newmtl wood\nmap_Kd a.png\n";

#[test]
fn corners_have_the_coordinates_of_their_lines() {
    // v counts from below in the file.
    let [a, b, c, d] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.25], [0.0, 0.25]];
    for faces in ["f 1/1 2/2 3/3 4/4\n", "f 1/-4/9 2/-3 3/-2 4/-1\n"] {
        let read = read(faces, LIBRARY);
        assert_eq!(read.coordinates, [[a, b, c], [a, c, d]], "{faces}");
        let texture = read.parts[0].texture.as_ref().unwrap();
        assert_eq!(texture.picture.size(), [2, 1]);
        assert_eq!(texture.sampler.address[0], AddressMode::Repeat);
        assert_eq!(
            read.parts[0].material.albedo, [1.0; 3],
            "of its own colours"
        );
        assert_eq!(read.warnings, []);
    }
    // Where faces share a corner and a texture has a seam, each keeps its own.
    let two = read("f 1/1 2/2 3/3\nf 1/3 3/1 4/4\n", LIBRARY);
    assert_eq!(two.coordinates, [[a, b, c], [c, a, d]]);
}

#[test]
fn options_scale_and_move() {
    let library = "newmtl wood\nKd 0.5 0.25 1\nmap_Kd -s 2 4 1 -o 0.5 0.25 -clamp on a.png\n";
    let read = read("f 1/1 2/2 3/3\n", library);
    let expected = [[0.5, 0.75], [2.5, 0.75], [2.5, 1.0 - 3.25]];
    assert_eq!(read.coordinates, [expected]);
    assert_eq!(read.parts[0].material.albedo, [0.5, 0.25, 1.0]);
    let texture = read.parts[0].texture.as_ref().unwrap();
    assert_eq!(texture.sampler.address[1], AddressMode::ClampToEdge);
}

#[test]
fn pictures_that_cannot_be_had_are_warnings() {
    let text = |name: &str| {
        let read = read("f 1/1 2/2 3/3\n", &format!("newmtl wood\nmap_Kd {name}\n"));
        assert!(read.parts[0].texture.is_none());
        assert_eq!(read.parts[0].material.albedo, [1.0; 3]);
        let found = read.warnings.iter().find(|w| w.code == "missing-maps");
        found.unwrap().message.clone()
    };
    for (name, what) in [
        ("none.png", "cannot be read"),
        ("paint.mtl", "is no PNG or JPEG"),
        ("../../../etc/hostname", "lies outside"),
    ] {
        let message = text(name);
        assert!(
            message.contains(what) && message.contains(name),
            "{message}"
        );
        assert!(message.contains("lib/paint.mtl"), "{message}");
    }
    // In the model's folder, though not in the library's.
    let read = read("f 1/1 2/2 3/3\n", "newmtl wood\nmap_Kd ..\\out.png\n");
    assert!(read.parts[0].texture.is_some(), "{:?}", read.warnings);
}

#[test]
fn coordinates_that_are_wrong_are_zeros_and_told() {
    let faces = "f 1/1 2/99 3/\n";
    for (corner, what) in [
        ("/99", "vt 99 of 4"),
        ("/x", "'2/x' in line"),
        ("/0", "'2/0'"),
        ("/-5", "'2/-5'"),
    ] {
        let found = read(&format!("f 1/1 2{corner} 3/\n"), LIBRARY);
        assert_eq!(found.coordinates, [[[0.0, 1.0]; 3]], "{corner}");
        let warning = &found.warnings[0];
        assert_eq!(
            (warning.code, warning.count),
            ("bad-coordinates", 1),
            "{corner}"
        );
        assert!(warning.message.contains(what), "{}", warning.message);
    }
    let counted = read("f 1/-4 2/-3 3/-2\n", LIBRARY);
    assert_eq!(counted.warnings, []);
    // Each is one, counted from whichever end; none is of a face that is skipped.
    let many = read("f 1/99 2/-5\nf 1/99 2/-5 3/-99\n", LIBRARY);
    let counts: Vec<_> = many.warnings.iter().map(|w| (w.code, w.count)).collect();
    assert_eq!(counts, [("skipped-faces", 1), ("bad-coordinates", 3)]);
    // Nobody looks at them without a picture.
    assert_eq!(read(faces, "newmtl wood\n").warnings, []);
}
