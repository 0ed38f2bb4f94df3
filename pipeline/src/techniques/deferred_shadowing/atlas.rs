//! Occlusion maps in an atlas: occluders drawn into cells, then a box across and a box
//! down (§6.2.1).

use gnomon_raster::state::{
    ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect, Viewport,
};
use gnomon_raster::{
    Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::deferred::maps::{BoxAlong, MOST_REACH};
use gnomon_shaders::deferred::obscured::OcclusionMap;
use gnomon_shaders::surface::Constant;
use gnomon_shaders::transform::{FullScreen, Points};

use super::bodies::Body;
use super::placing::PlacedMap;
use crate::parts::passes::SceneDraws;
use crate::parts::view::View;
use crate::parts::visibility::{attachment, binding, full_screen};
use crate::technique::{Pass, PassRole, TechniqueError};

/// Most texels along a side of an atlas: what does not fit waits for another turn.
const MOST_SIDE: u32 = 2048;

/// Three textures that all maps use in turn.
pub(super) struct Atlas {
    hard: TextureId,
    across: TextureId,
    down: TextureId,
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
            side,
            all,
        })
    }

    /// Maps that it holds at a time.
    pub(super) fn capacity(&self) -> usize {
        let along = (self.all / self.side) as usize;
        along * along
    }

    /// The finished maps.
    pub(super) fn texture(&self) -> TextureId {
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

    /// Passes that fill the cells with `maps`, in order.
    pub(super) fn passes(
        &self,
        maps: &[PlacedMap],
        bodies: &[Body<'_>],
        draws: &SceneDraws<'_>,
        label: &dyn Fn(&str) -> String,
    ) -> Vec<Pass> {
        let cells = || maps.iter().enumerate();
        let hard = cells().flat_map(|(k, map)| self.occluders(k, map, bodies, draws));
        let boxes = |axis: u32| {
            let box_of = move |(k, map): (usize, &PlacedMap)| self.box_along(k, map, axis);
            cells().map(box_of).collect()
        };
        let pass = |role, name: &str, to, draws| {
            let color = vec![attachment(to, LoadOp::Clear([0.0; 4]))];
            let pass = RenderPass {
                label: label(name),
                color,
                depth_stencil: None,
                draws,
            };
            Pass::new(role, pass)
        };
        vec![
            pass(PassRole::LightView, "occluders", self.hard, hard.collect()),
            pass(PassRole::Prefilter, "box across", self.across, boxes(0)),
            pass(PassRole::Prefilter, "box down", self.down, boxes(1)),
        ]
    }

    fn occluders(
        &self,
        number: usize,
        map: &PlacedMap,
        bodies: &[Body<'_>],
        draws: &SceneDraws<'_>,
    ) -> Vec<Draw> {
        let of_group = |object| {
            let numbers = &map.group.bodies;
            numbers
                .iter()
                .any(|&b| std::ptr::eq(bodies[b].object, object))
        };
        let surfaces = draws.surfaces().iter().filter(|s| of_group(s.object));
        let pipeline = || RenderPipeline {
            label: "occluders".into(),
            vertex: Points(map.clip_from_world(&draws.view)).stage(),
            fragment: Some(Constant([1.0; 4]).stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        surfaces
            .map(|s| self.within(number, s.draw(pipeline())))
            .collect()
    }

    fn box_along(&self, number: usize, map: &PlacedMap, axis: u32) -> Draw {
        let width = map.square[axis as usize] * f64::from(self.side);
        let width = width.min(f64::from(2 * self.side + 2));
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
