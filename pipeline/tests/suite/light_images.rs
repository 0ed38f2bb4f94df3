//! Images and videos on rectangle lights (paper III, §3.3): from files, frame after
//! frame, blended, and against the truth about the same image.

use std::fs;
use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind, Score, shaded};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::light_image::LightImage;
use gnomon_pipeline::world::scene::{Scene, builtin};

const SIZE: [u32; 2] = [96, 64];

/// A small table that is read well.
const TABLE: [&str; 3] = [
    "texture-size=20",
    "texture-filter=quadlinear",
    "texture-centred=vertex",
];

/// A folder of pictures, removed at the end.
struct Pictures(PathBuf);

impl Pictures {
    fn new(name: &str) -> Self {
        let name = format!("light-images-{name}-{}", std::process::id());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// A picture of `side` texels with one bright quarter, whose number is `bright`.
    fn quarter(&self, name: &str, side: u32, bright: u32) -> String {
        let quarter = |x: u32, y: u32| u32::from(2 * x >= side) + 2 * u32::from(2 * y >= side);
        self.save(name, side, |x, y| match quarter(x, y) == bright {
            true => [255, 240, 200],
            false => [60, 20, 0],
        })
    }

    fn save(&self, name: &str, side: u32, texel: impl Fn(u32, u32) -> [u8; 3]) -> String {
        let path = self.0.join(name);
        let picture = image::RgbImage::from_fn(side, side, |x, y| image::Rgb(texel(x, y)));
        picture.save(&path).unwrap();
        path.display().to_string()
    }
}

impl Drop for Pictures {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn settings() -> RenderSettings {
    RenderSettings {
        size: SIZE,
        ..RenderSettings::default()
    }
}

fn params(set: &[&str]) -> Params {
    let technique = find("soft-shadow-volumes").unwrap();
    Params::parse(technique, TABLE.iter().chain(set)).unwrap()
}

fn drawn_with(scene: &Scene, params: &Params) -> Rendered {
    let technique = find("soft-shadow-volumes").unwrap();
    render(scene, technique, params, &settings()).unwrap()
}

fn drawn(scene: &Scene, set: &[&str]) -> Rendered {
    drawn_with(scene, &params(set))
}

fn plates() -> Scene {
    builtin::build("parallel-plates").unwrap()
}

/// Red visibility as the sum over cells, each a light of its own to the oracle.
fn summed(scene: &Scene, image: &LightImage) -> Vec<f64> {
    let LightShape::Rectangle {
        centre,
        edge_u,
        edge_v,
    } = scene.lights[0].shape
    else {
        unreachable!()
    };
    let (side, n) = (image.side(), image.side() as f64);
    let mut sum = vec![0.0; (SIZE[0] * SIZE[1]) as usize];
    let shares = image.shares();
    let cells = shares.iter().enumerate();
    for (k, share) in cells.filter(|(_, s)| s[0] > 0.0) {
        let place = |i: usize| (i as f64 + 0.5) / n - 0.5;
        let mut one = scene.clone();
        one.lights[0].shape = LightShape::Rectangle {
            centre: centre + edge_u * place(k % side) + edge_v * place(k / side),
            edge_u: edge_u / n,
            edge_v: edge_v / n,
        };
        let seen = VisibilityImage::of_scene(&one, 0, SIZE, &|| ()).unwrap();
        for (to, v) in sum.iter_mut().zip(&seen.values) {
            *to += v * share[0];
        }
    }
    sum
}

fn rmse(picture: &[f32], truth: &[f64]) -> f64 {
    let pairs = picture.iter().zip(truth);
    let known = pairs.filter(|(v, t)| !v.is_nan() && !t.is_nan());
    let off = known.map(|(v, t)| f64::from(*v) - t);
    let squares: Vec<f64> = off.map(|d| d * d).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// Sixteen lights with black between them, and frames of a fire: visibility is the mean
/// of the cells' own, weighted by their red; and so says the oracle.
#[test]
fn an_image_is_the_sum_of_its_cells() {
    let scene = plates();
    let fire = |frame: u32| (LightImage::fire(frame), format!("light-frame={frame}"));
    let windows = (LightImage::windows(), "light-frame=0".to_owned());
    let white = drawn(&scene, &["light-image=white"]).visibility;
    let mut pictures = Vec::new();
    for (name, (image, frame)) in [("windows", windows), ("fire", fire(0)), ("fire", fire(9))] {
        let picture = drawn(&scene, &[&format!("light-image={name}"), &frame]).visibility;
        let truth = summed(&scene, &image);
        let [own, plain] = [&picture, &white].map(|p| rmse(p, &truth));
        println!("{name} {frame}: {own:.2e}, as a plain light {plain:.2e}");
        assert!(
            own < 6e-3 && plain > 3.0 * own,
            "{name} {frame}: {own} {plain}"
        );
        let told = VisibilityImage::of_light_image(&scene, 0, (&image, 0), SIZE, &|| ()).unwrap();
        let off = told.values.iter().zip(&truth).map(|(a, b)| (a - b).abs());
        assert!(off.filter(|d| !d.is_nan()).fold(0.0, f64::max) < 1e-9);
        pictures.push(picture);
    }
    // One frame's fire is not another's.
    assert!(pictures[1] != pictures[2]);
}

/// Frame f shows image f, the first again after the last, as if it were alone.
#[test]
fn frames_of_a_video_are_its_images_to_the_bit() {
    let (scene, folder) = (plates(), Pictures::new("frames"));
    let names: Vec<String> = (0..3)
        .map(|k| folder.quarter(&format!("{k}.png"), 8, k))
        .collect();
    let video = params(&[&format!("light-image={}", names.join(","))]);
    let frame = |f: u32| drawn_with(&scene, &video.with_later_image(f64::from(f)));
    let hashes = |d: &Rendered| (d.color_hash(), d.visibility_hash());
    let frames: Vec<_> = (0..4).map(|f| hashes(&frame(f))).collect();
    for (f, name) in names.iter().enumerate() {
        let alone = drawn(&scene, &[&format!("light-image={name}")]);
        assert_eq!(frames[f], hashes(&alone), "frame {f}");
    }
    assert_eq!(frames[3], frames[0]);
    assert!(frames[0] != frames[1] && frames[1] != frames[2] && frames[0] != frames[2]);
}

/// Between two images both their coverage textures are blended: every pixel lies between
/// the images', and as far as the truth about the blended image says.
#[test]
fn half_way_between_two_images_lies_between_them() {
    let (scene, folder) = (plates(), Pictures::new("between"));
    let names = [folder.quarter("a.png", 8, 0), folder.quarter("b.png", 8, 3)];
    let video = params(&[&format!("light-image={}", names.join(","))]);
    let at = |position: f64| drawn_with(&scene, &video.with_later_image(position));
    let [from, first, middle, to] = [0.0, 0.25, 0.5, 1.0].map(at);
    // A quarter of the way is nearer to the first image.
    let nearer = |d: &Rendered| {
        let pairs = d.visibility.iter().zip(&from.visibility);
        let off = pairs.map(|(a, b)| f64::from((a - b).abs()));
        off.filter(|d| !d.is_nan()).sum::<f64>()
    };
    let (quarter, half) = (nearer(&first), nearer(&middle));
    assert!((quarter / half - 0.5).abs() < 0.01, "{quarter} {half}");
    let (mut between, mut apart) = (0, 0);
    for k in 0..middle.visibility.len() {
        let [a, v, b] = [&from, &middle, &to].map(|d| d.visibility[k]);
        if v.is_nan() {
            continue;
        }
        assert!(v >= a.min(b) - 1e-5 && v <= a.max(b) + 1e-5, "{a} {v} {b}");
        between += u32::from((a - b).abs() > 0.1 && (v - 0.5 * (a + b)).abs() < 1e-5);
        apart += u32::from((a - b).abs() > 0.1);
    }
    // But where one of both is limited to 0 or 1.
    assert!(
        apart > 500 && 100 * between > 99 * apart,
        "{between} of {apart}"
    );
    let image = find("soft-shadow-volumes")
        .unwrap()
        .light_image(&video.with_later_image(0.5))
        .unwrap();
    let truth = summed(&scene, &image.unwrap());
    assert!(rmse(&middle.visibility, &truth) < 6e-3);
    assert!(rmse(&from.visibility, &truth) > 0.02);
}

/// The largest image, against the truth about it, in visibility and in colours.
#[test]
fn compare_knows_the_image_on_the_light() {
    let (scene, folder) = (plates(), Pictures::new("truth"));
    let wave = |x: u32, y: u32| [(x * 8) as u8, (y * 8) as u8, 255 - (x * 4 + y * 4) as u8];
    let name = folder.save("wave.png", 32, wave);
    let params = params(&[&format!("light-image={name}")]);
    let done = drawn_with(&scene, &params);
    let technique = find("soft-shadow-volumes").unwrap();
    let image = technique.light_image(&params).unwrap().unwrap();
    let score = |image: Option<&LightImage>| {
        let kind = ReferenceKind::Exact;
        let of = (0, image);
        let truth = Reference::with_light_image(&scene, of, SIZE, kind, None, &|| ()).unwrap();
        let under = truth.under(&done.depth).unwrap();
        let picture = shaded(&scene, &truth, &under, &params, &settings()).unwrap();
        Score::measure(&under, &done, &picture).unwrap()
    };
    let (own, plain) = (score(Some(&image)), score(None));
    let [a, b] = [&own, &plain].map(|s| s.visibility.all.unwrap().rmse);
    println!("{a} {b}, {} dB, {} dB", own.psnr, plain.psnr);
    // A gradient: what is left is the small texture's.
    assert!(a < 0.016 && b > 4.0 * a, "{a} {b}");
    assert!(own.psnr > 33.0 && own.psnr > plain.psnr + 6.0);
    let of = (0, Some(&image));
    let rays = Reference::with_light_image(&scene, of, SIZE, ReferenceKind::Rays, None, &|| ());
    assert!(rays.unwrap_err().to_string().contains("'exact' alone"));
}

/// The light is as bright as its image, and black texels are no light.
#[test]
fn an_image_gives_a_light_its_colour() {
    let (mut scene, folder) = (plates(), Pictures::new("colour"));
    scene.ambient = [0.0; 3];
    let name = folder.save("red.png", 4, |_, _| [255, 0, 0]);
    let done = drawn(&scene, &[&format!("light-image={name}")]);
    let white = drawn(&scene, &["light-image=white", "backend=texture4d"]);
    assert!(done.color.iter().map(|c| c[0]).fold(0.0, f32::max) > 0.3);
    for (own, plain) in done.color.iter().zip(&white.color) {
        let background = own == plain;
        assert!(background || (own[1] == 0.0 && own[2] == 0.0), "{own:?}");
    }
}

/// A light that is no rectangle has no image, and says so.
#[test]
fn only_rectangles_have_images() {
    let mut scene = plates();
    let LightShape::Rectangle { centre, .. } = scene.lights[0].shape else {
        unreachable!()
    };
    let radius = 0.3;
    scene.lights[0].shape = LightShape::Sphere { centre, radius };
    let technique = find("soft-shadow-volumes").unwrap();
    let refused = technique.frame(&scene, SIZE, &params(&["light-image=fire"]));
    let message = refused.err().unwrap().to_string();
    assert!(message.contains("rectangles for light-image"), "{message}");
}

/// Green and blue are covered as their own half of the light is, red as the other.
#[test]
fn green_and_blue_are_covered_apart_from_red() {
    let mut scene = plates();
    scene.ambient = [0.0; 3];
    let done = drawn(&scene, &["light-image=halves"]);
    let technique = find("unshadowed").unwrap();
    let none = Params::defaults(technique);
    let lit = render(&scene, technique, &none, &settings()).unwrap();
    let image = LightImage::halves();
    for (colour, other) in [(0, 1), (1, 0), (2, 0)] {
        let truth = |c| VisibilityImage::of_light_image(&scene, 0, (&image, c), SIZE, &|| ());
        let [own, wrong] = [colour, other].map(|c| truth(c).unwrap().values);
        let share = |k: usize| done.color[k][colour] / lit.color[k][colour];
        let seen: Vec<usize> = (0..own.len())
            .filter(|k| !own[*k].is_nan() && lit.color[*k][colour] > 0.01)
            .collect();
        let off = |truth: &[f64]| {
            let errors = seen.iter().map(|k| f64::from(share(*k)) - truth[*k]);
            let squares = errors.map(|d| d * d);
            (squares.sum::<f64>() / seen.len() as f64).sqrt()
        };
        let (right, swapped) = (off(&own), off(&wrong));
        println!("{colour}: {right} {swapped}");
        assert!(
            seen.len() > 1000 && right < 0.02 && swapped > 0.1,
            "{right} {swapped}"
        );
    }
}
