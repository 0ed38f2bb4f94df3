//! Where on the screen a light may add anything: tiles of pixels in which some
//! receiver can face it. In the others look-ups of its shadow are left out.
//!
//! A light adds nothing where the cosine between shading normal and direction to the
//! light's centre is not positive, whatever the shadow there, and a black one nowhere.
//! Which receivers a tile may show, and which way they face, is known from the scene
//! before anything is drawn; what is hidden counts as shown. So leaving look-ups out
//! changes no colour. It does change the light's visibility there (to 1), so that it
//! is never done for the light whose visibility is an output of the frame.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use gnomon_raster::{Draw, RenderPipeline, TextureBinding, VertexBuffer};
use gnomon_shaders::transform::{ClipFromWorld, HomogeneousPoints};

use super::light_view::Surroundings;
use crate::parts::view::View;
use crate::parts::visibility::full_screen;
use crate::world::light::{HardLight, Light};
use crate::world::mesh::widen;
use crate::world::scene::Scene;

/// Pixels along a side of a tile.
const TILE: u32 = 16;
/// Cosines down to minus this count as facing the light, for shaders in f32.
const SLACK: f64 = 1e-3;
/// The same as a share of coordinates' magnitude: their rounding.
const ROUNDING: f64 = 1e-5;
/// By how much snapping may move outlines, pixels; more than enough.
const SNAPPING: f64 = 1.0;

/// A triangle that receives shadow, and the tiles that it may be seen in.
struct Facet {
    corners: [DVec3; 3],
    normals: [DVec3; 3],
    /// Seen from the side that normals point to, from the other one.
    seen: [bool; 2],
    /// Columns and rows of tiles, the high ends excluded.
    low: [u32; 2],
    high: [u32; 2],
}

/// The lights of a frame whose look-ups may be left out in tiles: all but the first,
/// whose visibility is an output and needed everywhere.
pub(crate) struct FurtherLights<'a> {
    scene: &'a Scene,
    first: usize,
    /// Found only where there are such lights.
    receivers: Option<ReceiverTiles>,
}

impl<'a> FurtherLights<'a> {
    /// Of `lights`, if anything is to be skipped.
    pub(crate) fn new(
        scene: &'a Scene,
        around: &Surroundings<'_>,
        view: &View,
        lights: &[usize],
        skip: bool,
    ) -> Self {
        Self {
            scene,
            first: lights.first().copied().unwrap_or(0),
            receivers: (skip && lights.len() > 1).then(|| ReceiverTiles::new(scene, around, view)),
        }
    }

    /// The tiles in which a light may add something; `None` for all of the screen.
    pub(crate) fn tiles(&self, light: usize) -> Option<LitTiles> {
        let receivers = self.receivers.as_ref().filter(|_| light != self.first)?;
        Some(receivers.lit_by(&self.scene.lights[light]))
    }
}

/// All receivers of a frame.
struct ReceiverTiles {
    facets: Vec<Facet>,
    size: [u32; 2],
    /// Largest coordinate relative to the view's origin.
    magnitude: f64,
    origin: DVec3,
}

impl ReceiverTiles {
    fn new(scene: &Scene, around: &Surroundings<'_>, view: &View) -> Self {
        let size = view.size();
        let mut facets = Vec::new();
        let mut magnitude = 0.0f64;
        for (owner, polygon) in around.owned_receivers() {
            let mesh = &scene.objects[owner.object].mesh;
            let corners = mesh.corners(owner.triangle);
            let normals = mesh.normal_triangles()[owner.triangle];
            let normals = normals.map(|n| widen(mesh.normals()[n as usize]));
            let [low, high] = tiles_of(polygon, view);
            for p in corners {
                magnitude = magnitude.max(view.relative(p).abs().max_element());
            }
            facets.push(Facet {
                corners,
                normals,
                seen: seen_sides(corners, view.camera().eye),
                low,
                high,
            });
        }
        Self {
            facets,
            size,
            magnitude,
            origin: view.absolute(DVec3::ZERO),
        }
    }

    /// The tiles in which `light` may add something.
    fn lit_by(&self, light: &Light) -> LitTiles {
        let mut tiles = LitTiles::none(self.size);
        if light.colour == [0.0; 3] {
            return tiles;
        }
        let hard = light.hard();
        let far = match hard {
            HardLight::Point(p) => (p - self.origin).abs().max_element(),
            HardLight::Directional(_) => 0.0,
        };
        let rounding = ROUNDING * self.magnitude.max(far);
        for facet in &self.facets {
            if facet.may_face(hard, rounding) {
                tiles.mark(facet.low, facet.high);
            }
        }
        tiles
    }
}

impl Facet {
    /// Whether somewhere on it an interpolated normal, turned to the viewer, may be
    /// less than a quarter turn from the light. Normal and place are means of the
    /// corners', so that no product of theirs is above the largest one of corners.
    fn may_face(&self, light: HardLight, rounding: f64) -> bool {
        let facing = |side: f64| {
            self.normals.iter().any(|n| {
                self.corners.iter().any(|p| {
                    let towards = light.towards_from(*p);
                    let slack = SLACK * towards.length() + rounding;
                    let away = side * n.dot(towards) < -slack;
                    !away // NaN counts as facing
                })
            })
        };
        (self.seen[0] && facing(1.0)) || (self.seen[1] && facing(-1.0))
    }
}

/// From which sides a triangle may be seen; edge on it is both.
fn seen_sides([a, b, c]: [DVec3; 3], eye: DVec3) -> [bool; 2] {
    let normal = (b - a).cross(c - a);
    let height = normal.dot(eye - a);
    let slack = SLACK * normal.length() * (eye - a).length();
    let (behind, before) = (height < -slack, height > slack);
    [!behind, !before]
}

/// Low and high ends of the tiles that a polygon inside the camera's pyramid covers.
fn tiles_of(polygon: &[DVec3], view: &View) -> [[u32; 2]; 2] {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for p in polygon {
        let at = pixel_of(*p, view);
        low = low.min(at);
        high = high.max(at);
    }
    let tile = |v: f64| (v / f64::from(TILE)).clamp(0.0, f64::from(u32::MAX));
    let limit = tiles(view.size());
    [
        (low - SNAPPING).to_array().map(|v| tile(v) as u32),
        [0, 1].map(|k| (tile((high + SNAPPING)[k]).ceil() as u32).min(limit[k])),
    ]
}

/// Where a point before the eye is in the picture, pixels from the top left corner.
fn pixel_of(p: DVec3, view: &View) -> DVec2 {
    let camera = view.camera();
    let [right, up, forward] = camera.basis();
    let [width, height] = view.size().map(f64::from);
    let from = p - camera.eye;
    let half = forward.dot(from) * camera.tan_half_fov();
    let across = right.dot(from) / (half * width / height);
    let above = up.dot(from) / half;
    DVec2::new((across + 1.0) * 0.5 * width, (1.0 - above) * 0.5 * height)
}

fn tiles(size: [u32; 2]) -> [u32; 2] {
    size.map(|s| s.div_ceil(TILE))
}

/// A set of tiles of a picture.
pub(crate) struct LitTiles {
    size: [u32; 2],
    /// Row by row.
    marked: Vec<bool>,
}

impl LitTiles {
    fn none(size: [u32; 2]) -> Self {
        let [columns, rows] = tiles(size);
        Self {
            size,
            marked: vec![false; (columns * rows) as usize],
        }
    }

    fn mark(&mut self, low: [u32; 2], high: [u32; 2]) {
        let columns = tiles(self.size)[0];
        for row in low[1]..high[1] {
            let first = (row * columns) as usize;
            let own = first + low[0] as usize..first + high[0].max(low[0]) as usize;
            self.marked[own].fill(true);
        }
    }

    /// Tiles that are not in the set.
    pub(crate) fn skipped(&self) -> usize {
        self.marked.iter().filter(|m| !**m).count()
    }

    /// Whether no tile is in the set.
    pub(crate) fn is_empty(&self) -> bool {
        self.skipped() == self.marked.len()
    }

    /// `pipeline` over the tiles of the set, at depth 0 of the viewport: one triangle
    /// over everything where that is all of them, else rectangles of them.
    pub(crate) fn draw(&self, mut pipeline: RenderPipeline, textures: Vec<TextureBinding>) -> Draw {
        if self.skipped() == 0 {
            return full_screen(pipeline, textures);
        }
        const AS_IT_IS: ClipFromWorld = ClipFromWorld([
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]);
        pipeline.vertex = HomogeneousPoints(AS_IT_IS).stage();
        let vertices = Arc::new(VertexBuffer {
            data: self.rectangles(),
            stride: 4,
        });
        let label = pipeline.label.clone();
        let count = vertices.len() as u32;
        Draw {
            textures,
            vertices: Some(vertices),
            ..Draw::vertices_only(&label, &Arc::new(pipeline), count)
        }
    }

    /// Two triangles for each run of tiles in a row, clip space.
    fn rectangles(&self) -> Vec<f32> {
        let [columns, rows] = tiles(self.size);
        let mut data = Vec::new();
        for row in 0..rows {
            let marked = |c: u32| self.marked[(row * columns + c) as usize];
            let mut column = 0;
            while column < columns {
                if !marked(column) {
                    column += 1;
                    continue;
                }
                let first = column;
                while column < columns && marked(column) {
                    column += 1;
                }
                let low = self.corner([first, row]);
                let high = self.corner([column, row + 1]);
                let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
                for k in [0, 1, 2, 0, 2, 3] {
                    let [x, y]: [f32; 2] = corners[k];
                    data.extend([x, y, 0.0, 1.0]);
                }
            }
        }
        data
    }

    /// Clip-space place of the corner between tiles, or of the picture's border.
    fn corner(&self, tile: [u32; 2]) -> [f32; 2] {
        let [x, y] = [0, 1].map(|k| {
            let pixel = (tile[k] * TILE).min(self.size[k]);
            f64::from(pixel) / f64::from(self.size[k]) * 2.0 - 1.0
        });
        [x as f32, -y as f32]
    }
}
