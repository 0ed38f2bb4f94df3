//! Textures of base colours: where they are, in every technique, filtered and counted.

use std::io::Cursor;
use std::sync::Arc;

use glam::DVec3;
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques;
use gnomon_pipeline::world::environment::FitSettings;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::environment::EnvironmentRequest;
use gnomon_pipeline::world::scene::{
    Camera, CornerCoordinates, Material, MaterialPart, Object, Scene, SceneSource, SurfaceTexture,
    builtin,
};
use gnomon_pipeline::world::shape::Shape;
use gnomon_pipeline::world::texture::{Picture, REPEATED};
use gnomon_raster::state::{AddressMode, FilterMode, Sampler};

/// A picture of sRGB texels, rows from the top.
pub(crate) fn picture(width: u32, texels: &[[u8; 3]]) -> Arc<Picture> {
    let height = texels.len() as u32 / width;
    let image = image::RgbImage::from_raw(width, height, texels.concat()).unwrap();
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    Arc::new(Picture::decode(&bytes.into_inner()).unwrap())
}

/// Lays a picture on all of an object.
pub(crate) fn lay(object: &mut Object, texture: SurfaceTexture, coordinates: &[CornerCoordinates]) {
    let count = object.mesh.triangles().len();
    let repeated = coordinates.iter().copied().cycle().take(count);
    object.coordinates = Some(repeated.collect());
    object.parts = vec![MaterialPart {
        material: object.material,
        texture: Some(texture),
        triangles: (0..count as u32).collect(),
    }];
}

const SIDE: u32 = 8;

/// A square that fills the picture, u to the right and v down, with ambient light alone.
fn facing(sampler: Sampler, picture: Arc<Picture>, reach: f32) -> Rendered {
    let corners = [[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]];
    let square = Shape {
        positions: corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let at = |i: usize| corners[i].map(f64::from);
    let texel = |i: usize| {
        let [x, y] = at(i);
        [(x + 1.0) / 2.0, (1.0 - y) / 2.0].map(|c| c as f32 * reach)
    };
    let mut object = Object::new(
        "square",
        square.into_mesh(Shading::Flat).unwrap(),
        Material::matt([1.0; 3]),
    )
    .receiver_only();
    let coordinates = [[0, 1, 2], [0, 2, 3]].map(|t: [usize; 3]| t.map(texel));
    lay(
        &mut object,
        SurfaceTexture { picture, sampler },
        &coordinates,
    );
    let camera = Camera {
        fov_y_degrees: 90.0,
        ..Camera::look_at(DVec3::Z, DVec3::ZERO)
    };
    let light = Light {
        colour: [0.0; 3],
        ..Light::horizontal_square(DVec3::new(0.0, 4.0, 1.0), 1.0)
    };
    let mut scene = Scene::new(camera, vec![light], vec![object]);
    scene.ambient = [1.0; 3];
    drawn(&scene, techniques::find("unshadowed").unwrap(), SIDE)
}

fn drawn(scene: &Scene, technique: &dyn Technique, side: u32) -> Rendered {
    let settings = RenderSettings {
        size: [side, side],
        ..RenderSettings::default()
    };
    let params = Params::defaults(technique);
    render(scene, technique, &params, &settings).unwrap()
}

fn nearest(address: AddressMode) -> Sampler {
    Sampler {
        address: [address; 3],
        mag: FilterMode::Nearest,
        min: FilterMode::Nearest,
        mip: FilterMode::Nearest,
        ..REPEATED
    }
}

const RED: [u8; 3] = [255, 0, 0];
const GREEN: [u8; 3] = [0, 255, 0];
const BLUE: [u8; 3] = [0, 0, 255];
const GREY: [u8; 3] = [128, 128, 128];

/// The sRGB colours seen in the middle of four quarters, rows from the top.
fn quarters(rendered: &Rendered) -> [[u8; 3]; 4] {
    [[2, 2], [6, 2], [2, 6], [6, 6]].map(|[x, y]| {
        let [r, g, b, _] = rendered.srgb[(y * SIDE + x) as usize];
        [r, g, b]
    })
}

/// u goes to the right, v down, channels stay in order, and sRGB comes out as it went in.
#[test]
fn texels_are_seen_where_their_coordinates_say() {
    let four = picture(2, &[RED, GREEN, BLUE, GREY]);
    let rendered = facing(nearest(AddressMode::Repeat), four, 1.0);
    assert_eq!(quarters(&rendered), [RED, GREEN, BLUE, GREY]);
    // A half of the light, not of the number.
    let grey = rendered.color[(6 * SIDE + 6) as usize];
    assert!((grey[0] - 0.2158).abs() < 1e-3, "{grey:?}");
}

#[test]
fn coordinates_are_wrapped_as_the_sampler_says() {
    let four = || picture(2, &[RED, GREEN, BLUE, GREY]);
    // Quarters show 0..1, 1..2 along both axes.
    let all = |address| quarters(&facing(nearest(address), four(), 2.0));
    let repeated = all(AddressMode::Repeat);
    assert_eq!(repeated, [GREY; 4], "pixel 2 of 4 is in the second texel");
    let clamped = all(AddressMode::ClampToEdge);
    assert_eq!(clamped, [GREY; 4]);
    let row = |address| {
        let rendered = facing(nearest(address), four(), 2.0);
        [0, 3, 4, 7].map(|x| {
            let [r, g, b, _] = rendered.srgb[x];
            [r, g, b]
        })
    };
    assert_eq!(row(AddressMode::Repeat), [RED, GREEN, RED, GREEN]);
    assert_eq!(row(AddressMode::ClampToEdge), [RED, GREEN, GREEN, GREEN]);
    assert_eq!(row(AddressMode::MirrorRepeat), [RED, GREEN, GREEN, RED]);
}

/// What a pixel covers is averaged as light: a fine chequerboard is half as bright as white,
/// and the level is the one that the distance asks for.
#[test]
fn what_is_far_is_averaged_light() {
    let fine: Vec<[u8; 3]> = (0..64 * 64)
        .map(|k| {
            if (k % 64 + k / 64) % 2 == 0 {
                [255; 3]
            } else {
                [0; 3]
            }
        })
        .collect();
    let rendered = facing(REPEATED, picture(64, &fine), 1.0);
    for color in &rendered.color {
        assert!((color[0] - 0.5).abs() < 2e-3, "{color:?}");
    }
    // Stripes as wide as a pixel: the level of one texel a pixel shows them, the next none.
    let stripes: Vec<[u8; 3]> = (0..64 * 64)
        .map(|k| {
            if k % 64 / 8 % 2 == 0 {
                [255; 3]
            } else {
                [0; 3]
            }
        })
        .collect();
    let rendered = facing(REPEATED, picture(64, &stripes), 1.0);
    for (k, color) in rendered.color.iter().enumerate() {
        let expected = if k % 2 == 0 { 1.0 } else { 0.0 };
        assert!((color[0] - expected).abs() < 2e-3, "{k}: {color:?}");
    }
}

/// A level larger would show stripes of half a pixel, of which the nearest texel is black.
#[test]
fn the_level_is_not_larger_than_a_pixel_asks_for() {
    let stripes: Vec<[u8; 3]> = (0..64 * 64)
        .map(|k| {
            if k % 64 / 4 % 2 == 0 {
                [255; 3]
            } else {
                [0; 3]
            }
        })
        .collect();
    let sampler = nearest(AddressMode::Repeat);
    let rendered = facing(sampler, picture(64, &stripes), 1.0);
    for color in &rendered.color {
        assert!((color[0] - 0.5).abs() < 2e-3, "{color:?}");
    }
}

/// As many texels are read as the rules say: four a pixel at one level.
#[test]
fn look_ups_are_counted() {
    let four = picture(2, &[RED, GREEN, BLUE, GREY]);
    let rendered = facing(REPEATED, four, 1.0);
    let pixels = u64::from(SIDE * SIDE);
    let mut total = gnomon_raster::Counters::default();
    rendered
        .report
        .passes
        .iter()
        .for_each(|p| total.add(&p.totals()));
    assert_eq!(total.traffic.tex_fetches[0], 2 * pixels, "ambient and lit");
    // Magnified: the first level alone, four texels of eight bytes.
    assert_eq!(total.traffic.tex[0].read_bytes, 2 * pixels * 4 * 8);
}

/// A square of half the picture's width before the eye, from x on.
fn half(x: f64, material: Material, texel: [u8; 3]) -> Object {
    let corners = [[x, 1.0], [x, -1.0], [x + 1.0, -1.0], [x + 1.0, 1.0]];
    let square = Shape {
        positions: corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let mesh = square.into_mesh(Shading::Flat).unwrap();
    let mut object = Object::new("half", mesh, material).receiver_only();
    let texture = SurfaceTexture::repeated(picture(1, &[texel]));
    lay(&mut object, texture, &[[[0.5; 2]; 3]]);
    object
}

fn halves(objects: Vec<Object>, ambient: f32, light: Light) -> Rendered {
    let camera = Camera {
        fov_y_degrees: 90.0,
        ..Camera::look_at(DVec3::Z, DVec3::ZERO)
    };
    let mut scene = Scene::new(camera, vec![light], objects);
    scene.ambient = [ambient; 3];
    drawn(&scene, techniques::find("unshadowed").unwrap(), SIDE)
}

/// Each surface has its own picture; a copy of one is no other.
#[test]
fn surfaces_have_their_own_pictures() {
    let white = Material::matt([1.0; 3]);
    let dark = Light {
        colour: [0.0; 3],
        ..Light::horizontal_square(DVec3::new(0.0, 4.0, 1.0), 1.0)
    };
    let rendered = halves(
        vec![half(-1.0, white, RED), half(0.0, white, GREEN)],
        1.0,
        dark,
    );
    assert_eq!(quarters(&rendered), [RED, GREEN, RED, GREEN]);
}

/// A picture is of the base colour: what shines on black still shines.
#[test]
fn highlights_keep_their_colour() {
    let shining = Material {
        specular: [0.5, 0.25, 0.0],
        shininess: 4.0,
        ..Material::matt([1.0; 3])
    };
    let lamp = Light {
        shape: LightShape::Point {
            position: DVec3::new(-0.5, 0.0, 1.0),
        },
        colour: [1.0; 3],
    };
    let rendered = halves(vec![half(-1.0, shining, [0; 3])], 0.0, lamp);
    let [r, g, b] = rendered.color[(4 * SIDE + 2) as usize];
    assert!(
        r > 0.1 && (g - r / 2.0).abs() < 1e-3 && b == 0.0,
        "{r} {g} {b}"
    );
}

const TINT: [u8; 3] = [200, 90, 30];

fn tint() -> [f32; 3] {
    let level = picture(1, &[TINT]);
    let texel = &level.levels()[0].packed;
    [0, 1, 2].map(|c| {
        let bits = u16::from_le_bytes([texel[2 * c], texel[2 * c + 1]]);
        gnomon_raster::format::f32_from_f16(bits)
    })
}

/// A picture of one colour is the material of that colour, in every technique, under every
/// kind of light.
#[test]
fn every_technique_draws_textures() {
    let mut request = EnvironmentRequest::new("sky");
    request.settings.side = 32;
    request.fit = FitSettings {
        lights: 2,
        ..FitSettings::default()
    };
    let sky = SceneSource::open("cylinder").unwrap();
    let sky = sky.with_environment(Some(request)).at(0.0).unwrap();
    let mut count = 0;
    for scene in [builtin::build("cylinder").unwrap(), sky] {
        let (mut painted, mut textured) = (scene.clone(), scene);
        for object in painted.objects.iter_mut() {
            object.material.albedo = tint();
        }
        for object in textured.objects.iter_mut() {
            object.material.albedo = [1.0; 3];
            let texture = SurfaceTexture::repeated(picture(1, &[TINT]));
            lay(object, texture, &[[[0.1, 0.2], [0.7, 0.3], [0.4, 0.9]]]);
        }
        for technique in techniques::all() {
            let params = Params::defaults(*technique);
            let size = [24, 18];
            let settings = RenderSettings {
                size,
                ..RenderSettings::default()
            };
            let all = [&painted, &textured];
            let all = all.map(|s| render(s, *technique, &params, &settings));
            let [Ok(one), Ok(other)] = all else {
                continue; // not every technique takes every light
            };
            count += 1;
            let pairs = one.color.iter().flatten().zip(other.color.iter().flatten());
            for (a, b) in pairs {
                let name = technique.name();
                assert!((a - b).abs() <= 4e-3 * (1.0 + a.abs()), "{name}: {a} {b}");
            }
            assert_eq!(one.visibility_hash(), other.visibility_hash());
        }
    }
    assert!(count > 30, "{count}");
}
