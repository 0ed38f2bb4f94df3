//! Occlusion maps in an atlas: occluders drawn into cells, then a box across and a box
//! down (§6.2.1).

use gnomon_raster::state::{
    ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect, Viewport,
};
use gnomon_raster::{
    Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, Subresource, TextureDescriptor,
    TextureId,
};
use gnomon_shaders::deferred::maps::{BoxAlong, MOST_REACH};
use gnomon_shaders::deferred::obscured::OcclusionMap;
use gnomon_shaders::surface::Constant;
use gnomon_shaders::transform::{FullScreen, Points};

use super::bodies::Body;
use super::keeping::Keeping;
use super::placing::PlacedMap;
use super::shadows::Job;
use crate::parts::passes::SceneDraws;
use crate::parts::surface_draw::SurfaceDraw;
use crate::parts::view::View;
use crate::parts::visibility::{attachment, binding, full_screen};
use crate::technique::{Pass, PassRole, PictureKey, TechniqueError};

/// What maps are drawn from.
pub(super) struct Occluders<'f, 'a> {
    pub(super) bodies: &'f [Body<'a>],
    pub(super) draws: &'f SceneDraws<'a>,
    /// Labels of passes.
    pub(super) label: &'f dyn Fn(&str) -> String,
}

impl<'f, 'a> Occluders<'f, 'a> {
    /// Surfaces of a map's occluders, with their numbers.
    fn of(&self, map: &PlacedMap) -> impl Iterator<Item = (usize, &'f SurfaceDraw<'a>)> {
        let bodies = map.group.bodies.iter().map(|&b| self.bodies[b].object);
        let objects: Vec<_> = bodies.collect();
        let surfaces = self.draws.surfaces().iter().enumerate();
        surfaces.filter(move |(_, s)| objects.iter().any(|o| std::ptr::eq(*o, s.object)))
    }
}

/// A turn's maps.
pub(super) struct Filled {
    /// Where they are.
    pub(super) maps: TextureId,
    /// What draws them.
    pub(super) passes: Vec<Pass>,
}

/// Maps of jobs with the cells that they have.
fn cells(jobs: &[Job]) -> Vec<(usize, &PlacedMap)> {
    let mut first = 0;
    let mut all = Vec::new();
    for job in jobs {
        all.extend(job.placed().map(|(k, map)| (first + k, map)));
        first += job.maps.len();
    }
    all
}

/// Most texels along a side of an atlas: what does not fit waits for another turn.
const MOST_SIDE: u32 = 2048;

/// Three textures that all maps use in turn; finished maps that are kept for the next
/// frame have one a turn instead.
pub(super) struct Atlas {
    hard: TextureId,
    across: TextureId,
    down: TextureId,
    /// Of finished maps.
    soft: Format,
    /// Texels along a side of a cell, and of the atlas.
    side: u32,
    all: u32,
}

impl Atlas {
    /// For up to `maps` maps, as far as they fit.
    pub(super) fn create(
        maps: usize,
        side: u32,
        half_floats: bool,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let mut all = side;
        while all < MOST_SIDE && ((all / side) * (all / side)) < maps as u32 {
            all *= 2;
        }
        let soft = match half_floats {
            true => Format::R16Float,
            false => Format::R32Float,
        };
        let mut create =
            |label, format| recording.create(&TextureDescriptor::d2(label, format, all, all));
        Ok(Self {
            hard: create("occluders", Format::R8Unorm)?,
            across: create("occlusion across", soft)?,
            down: create("occlusion maps", soft)?,
            soft,
            side,
            all,
        })
    }

    /// Maps that it holds at a time.
    pub(super) fn capacity(&self) -> usize {
        let along = (self.all / self.side) as usize;
        along * along
    }

    /// Where maps are that are kept for no other frame.
    pub(super) fn shared(&self) -> TextureId {
        self.down
    }

    /// First column and row of a cell.
    fn cell(&self, number: usize) -> [u32; 2] {
        let along = self.all / self.side;
        let number = number as u32;
        [number % along * self.side, number / along * self.side]
    }

    /// Where the map in a cell is looked up.
    pub(super) fn look_up(&self, map: &PlacedMap, number: usize, view: &View) -> OcclusionMap {
        map.look_up(view, self.cell(number), self.side, self.all)
    }

    /// Fills the cells with the maps of `jobs`, in order; those that the frame before left
    /// are not drawn.
    pub(super) fn fill(
        &self,
        jobs: &[Job],
        scene: &Occluders<'_, '_>,
        recording: &mut Recording,
        keeping: Option<&mut Keeping<'_>>,
    ) -> Result<Filled, TechniqueError> {
        let maps = cells(jobs);
        let keeping = keeping.filter(|_| !maps.is_empty());
        let Some(keeping) = keeping.and_then(|k| k.takes(self.bytes()).then_some(k)) else {
            let clear = LoadOp::Clear([0.0; 4]);
            return Ok(Filled {
                maps: self.down,
                passes: self.passes(&maps, scene, (self.down, clear)),
            });
        };
        let kept = TextureDescriptor::d2("kept occlusion maps", self.soft, self.all, self.all);
        let kept = recording.create(&kept)?;
        let (mut image, mut missing) = (vec![0; self.bytes()], Vec::new());
        for (number, map) in maps {
            let key = self.key(number, map, scene, keeping);
            let place = (self.cell(number), self.side);
            match keeping.keep(key, kept, place) {
                (_, None) => missing.push((number, map)),
                (picture, Some(rows)) => {
                    picture.paste(rows, &mut image, self.all, self.texel());
                }
            }
        }
        recording.write_packed(kept, Subresource::default(), image.into())?;
        Ok(Filled {
            maps: kept,
            passes: self.passes(&missing, scene, (kept, LoadOp::Load)),
        })
    }

    /// Bytes of a texel of finished maps.
    fn texel(&self) -> u32 {
        self.soft.bytes() as u32
    }

    /// Of a texture of finished maps.
    fn bytes(&self) -> usize {
        self.all as usize * self.all as usize * self.texel() as usize
    }

    /// Of everything that decides the texels of a map.
    fn key(
        &self,
        number: usize,
        map: &PlacedMap,
        scene: &Occluders<'_, '_>,
        keeping: &Keeping<'_>,
    ) -> PictureKey {
        let mut hasher = blake3::Hasher::new();
        let [x, y] = self.cell(number);
        for whole in [x, y, self.side, self.all, self.texel()] {
            hasher.update(&whole.to_le_bytes());
        }
        for value in map.clip_from_world(&scene.draws.view).0.as_flattened() {
            hasher.update(&value.to_bits().to_le_bytes());
        }
        for axis in 0..2 {
            hasher.update(&self.width(map, axis).to_bits().to_le_bytes());
        }
        for (number, _) in scene.of(map) {
            hasher.update(keeping.surface(number));
        }
        *hasher.finalize().as_bytes()
    }

    /// Passes that draw `maps` into their cells.
    fn passes(
        &self,
        maps: &[(usize, &PlacedMap)],
        scene: &Occluders<'_, '_>,
        (finished, load): (TextureId, LoadOp<[f32; 4]>),
    ) -> Vec<Pass> {
        if maps.is_empty() {
            return Vec::new();
        }
        let cells = || maps.iter();
        let hard = cells().flat_map(|(k, map)| self.occluders(*k, map, scene));
        let boxes = |axis: u32| {
            let box_of = move |(k, map): &(usize, &PlacedMap)| self.box_along(*k, map, axis);
            cells().map(box_of).collect()
        };
        let pass = |role, name: &str, to, load, draws| {
            let pass = RenderPass {
                label: (scene.label)(name),
                color: vec![attachment(to, load)],
                depth_stencil: None,
                draws,
            };
            Pass::new(role, pass)
        };
        let (light, filter) = (PassRole::LightView, PassRole::Prefilter);
        let clear = LoadOp::Clear([0.0; 4]);
        vec![
            pass(light, "occluders", self.hard, clear, hard.collect()),
            pass(filter, "box across", self.across, clear, boxes(0)),
            pass(filter, "box down", finished, load, boxes(1)),
        ]
    }

    fn occluders(&self, number: usize, map: &PlacedMap, scene: &Occluders<'_, '_>) -> Vec<Draw> {
        let surfaces = scene.of(map);
        let draws = scene.draws;
        let pipeline = || RenderPipeline {
            label: "occluders".into(),
            vertex: Points(map.clip_from_world(&draws.view)).stage(),
            fragment: Some(Constant([1.0; 4]).stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        surfaces
            .map(|(_, s)| self.within(number, s.draw(pipeline())))
            .collect()
    }

    fn box_along(&self, number: usize, map: &PlacedMap, axis: u32) -> Draw {
        let width = self.width(map, axis);
        let shader = BoxAlong {
            low: self.cell(number),
            side: self.side,
            axis,
            width: width as f32,
            reach: ((width * 0.5).ceil() as u32 + 1)
                .min(self.side)
                .min(MOST_REACH),
        };
        let pipeline = RenderPipeline {
            label: "box".into(),
            vertex: FullScreen.stage(),
            fragment: Some(shader.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        let from = if axis == 0 { self.hard } else { self.across };
        self.within(number, full_screen(pipeline, vec![binding(from)]))
    }

    /// Texels that the light's square is wide along an axis.
    fn width(&self, map: &PlacedMap, axis: u32) -> f64 {
        let width = map.square[axis as usize] * f64::from(self.side);
        width.min(f64::from(2 * self.side + 2))
    }

    /// In its cell and nowhere else.
    fn within(&self, number: usize, draw: Draw) -> Draw {
        let [x, y] = self.cell(number);
        let (width, height) = (self.side, self.side);
        Draw {
            viewport: Some(Viewport {
                x: x as f32,
                y: y as f32,
                ..Viewport::full(width, height)
            }),
            scissor: Some(ScissorRect {
                x,
                y,
                width,
                height,
            }),
            ..draw
        }
    }
}
