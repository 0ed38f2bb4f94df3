//! Coverage of a light for edges between any two of its points: the contents of
//! the four-dimensional texture of paper III (§3.3).

use std::sync::Arc;

use glam::{DVec2, DVec3};
use gnomon_raster::{Format, Recording, Subresource, TextureDescriptor, TextureId};
use gnomon_shaders::coverage::{Image, Outline};
use gnomon_shaders::coverage_table::CoverageTable;

use crate::geometry::coverage::{ImageSums, LightPlane, PolygonImage, Spoke};
use crate::technique::TechniqueError;
use crate::world::light_image::LightImage;
use crate::world::memo::Memo;

/// What the light looks like.
pub(crate) enum Contents<'a> {
    /// One colour, of any shape: 8 bits.
    Plain(Image),
    /// An image on a rectangle: three half floats, or bytes of the share itself, since a
    /// colour in one part of the light can be covered altogether; and one unused.
    Coloured(&'a LightImage),
}

/// Makes the texture.
pub(crate) fn create(
    table: &CoverageTable,
    contents: &Contents<'_>,
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let side = table.size * table.size;
    let format = match contents {
        Contents::Plain(_) => Format::R8Unorm,
        Contents::Coloured(_) if table.whole => Format::Rgba8Unorm,
        Contents::Coloured(_) => Format::Rgba16Float,
    };
    let desc = TextureDescriptor::d2("coverage", format, side, side);
    let texture = recording.create(&desc)?;
    recording.write(texture, Subresource::default(), &entries(table, contents))?;
    Ok(texture)
}

/// Entries of images, of which videos show the same ones again.
static IMAGES: Memo<Vec<[f32; 4]>> = Memo::new(256 << 20);

/// Twice the covered share, or the share, in the order of the texture's rows.
fn entries(table: &CoverageTable, contents: &Contents<'_>) -> Arc<Vec<[f32; 4]>> {
    match contents {
        Contents::Plain(image) => Arc::new(plain(table, *image)),
        Contents::Coloured(image) => {
            let bytes = |e: &Vec<[f32; 4]>| size_of_val(&e[..]);
            IMAGES.get(key(table, image), bytes, || coloured(table, image))
        }
    }
}

/// Hash of what entries depend on.
fn key(table: &CoverageTable, image: &LightImage) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&table.size.to_le_bytes());
    hasher.update(&[table.vertex_centred, table.whole].map(u8::from));
    for v in image.cells().iter().flatten() {
        hasher.update(&v.to_bits().to_le_bytes());
    }
    *hasher.finalize().as_bytes()
}

fn plain(table: &CoverageTable, image: Image) -> Vec<[f32; 4]> {
    let point = |p: DVec2| p;
    filled(table, point, |p, q| [covered(image, *p, *q), 0.0, 0.0])
}

fn coloured(table: &CoverageTable, image: &LightImage) -> Vec<[f32; 4]> {
    let sums = ImageSums::new(image);
    let spoke = |p: DVec2| sums.spoke(p);
    filled(table, spoke, |p: &Spoke, q: &Spoke| sums.covered(p, q))
}

/// Entries from what `prepare` makes of the points of a side.
fn filled<P>(
    table: &CoverageTable,
    prepare: impl Fn(DVec2) -> P,
    share: impl Fn(&P, &P) -> [f64; 3],
) -> Vec<[f32; 4]> {
    let n = table.size;
    let at = |i: u32| table.coordinate(i);
    let rows = (0..n).flat_map(|y| (0..n).map(move |x| DVec2::new(at(x), at(y))));
    let points: Vec<P> = rows.map(prepare).collect();
    let point = |x: u32, y: u32| &points[(y * n + x) as usize];
    let scale = if table.whole { 1.0 } else { 2.0 };
    let mut texels = Vec::with_capacity((n * n * n * n) as usize);
    for row in 0..n * n {
        for column in 0..n * n {
            let (p, q) = (point(column % n, row % n), point(column / n, row / n));
            let [r, g, b] = share(p, q).map(|v| scale * v as f32);
            texels.push([r, g, b, 1.0]);
        }
    }
    texels
}

/// Covered share of a light for an edge between two points of its plane, in units
/// of half its size.
fn covered(image: Image, p: DVec2, q: DVec2) -> f64 {
    let light = match image {
        Image::Square => LightPlane::Rectangle {
            centre: DVec3::ZERO,
            half_edges: [DVec3::X, DVec3::Y],
        },
        Image::Disc => LightPlane::Disc {
            centre: DVec3::ZERO,
            normal: DVec3::Z,
            radius: 1.0,
        },
        Image::Polygon(outline) => return polygon_image(&outline).coverage([p, q]),
    };
    // An edge in the light's plane is its own image, whatever the receiver.
    let projection = light.seen_from(DVec3::Z);
    projection.map_or(0.0, |s| s.coverage([p.extend(0.0), q.extend(0.0)]))
}

/// A polygon as shaders have it.
pub(super) fn polygon_image(outline: &Outline) -> PolygonImage {
    let corners = outline.corners.iter().take(outline.count as usize);
    let corner = |c: &[f32; 2]| DVec2::new(f64::from(c[0]), f64::from(c[1]));
    PolygonImage::new(corners.map(corner).collect())
}
