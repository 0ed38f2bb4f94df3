//! What is drawn of a body in one material, from one side, with its vertices in rows of
//! the radiance textures.

use std::sync::Arc;

use gnomon_raster::state::{CullMode, PrimitiveState, Viewport};
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, VertexBuffer};

use super::bodies::{Body, vertex_of};
use crate::parts::passes::SceneDraws;
use crate::parts::surface_draw::{SurfaceDraw, index_buffer};
use crate::truth::oracle::transport::Transport;

/// A material of a body from one side.
pub(super) struct Sheet<'s, 'a> {
    pub(super) surface: &'s SurfaceDraw<'a>,
    /// Index into the bodies.
    pub(super) body: usize,
    pub(super) transport: Arc<Transport>,
    /// 1, or -1 for the inside.
    pub(super) sign: f32,
    /// Its vertices, as numbers of the body's.
    pub(super) vertices: Vec<u32>,
    /// Triangles over `vertices`.
    triangles: Vec<[u32; 3]>,
    /// The only side of its body.
    alone: bool,
    /// First row in radiance textures.
    pub(super) first_row: u32,
    pub(super) rows: u32,
}

/// Sheets, and the size of their radiance textures.
pub(super) struct Sheets<'s, 'a> {
    pub(super) all: Vec<Sheet<'s, 'a>>,
    /// Texels along a row.
    pub(super) width: u32,
    pub(super) rows: u32,
}

impl<'s, 'a> Sheets<'s, 'a> {
    pub(super) fn new(bodies: &[Body<'a>], draws: &'s SceneDraws<'a>) -> Self {
        let of = |surface: &'s SurfaceDraw<'a>| {
            let own = |b: &Body<'_>| std::ptr::eq(b.object, surface.object);
            let body = bodies.iter().position(own);
            let sides = body.map_or(0, |b| bodies[b].sides.len());
            (0..sides).map(move |side| {
                let body = body.unwrap_or_default();
                Sheet::new(surface, body, &bodies[body], side)
            })
        };
        let mut all: Vec<_> = draws.surfaces().iter().flat_map(of).collect();
        let (width, rows) = lay_out(&mut all);
        Self { all, width, rows }
    }

    /// Where a vertex of a sheet is in the sheet's rows, as clip-space x and y.
    pub(super) fn place(&self, sheet: &Sheet<'_, '_>, vertex: usize) -> [f32; 2] {
        let (column, row) = (vertex as u32 % self.width, vertex as u32 / self.width);
        let centre = |k: u32, of: u32| (2 * k + 1) as f32 / of as f32 - 1.0;
        [centre(column, self.width), -centre(row, sheet.rows)]
    }

    /// A sheet's rows, `block` textures further down.
    pub(super) fn viewport(&self, sheet: &Sheet<'_, '_>, block: u32) -> Viewport {
        Viewport {
            y: (sheet.first_row + block * self.rows) as f32,
            ..Viewport::full(self.width, sheet.rows)
        }
    }
}

/// Most blocks of rows that one texture holds: coefficients of glossy transport.
const MOST_BLOCKS: u32 = 16;

/// Gives sheets their rows, which are as long as it takes to fit all into a texture.
fn lay_out(sheets: &mut [Sheet<'_, '_>]) -> (u32, u32) {
    let most = gnomon_raster::MAX_TEXTURE_SIZE;
    let mut width = 64;
    loop {
        let mut rows = 0;
        for sheet in sheets.iter_mut() {
            sheet.first_row = rows;
            sheet.rows = (sheet.vertices.len() as u32).div_ceil(width).max(1);
            rows += sheet.rows;
        }
        if rows * MOST_BLOCKS <= most || width == most {
            return (width, rows.max(1));
        }
        width *= 2;
    }
}

impl<'s, 'a> Sheet<'s, 'a> {
    fn new(surface: &'s SurfaceDraw<'a>, number: usize, body: &Body<'_>, side: usize) -> Self {
        let mut vertices: Vec<u32> = surface.triangles().flatten().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let local = |v: u32| vertices.partition_point(|known| *known < v) as u32;
        let triangles = surface.triangles().map(|t| t.map(local)).collect();
        Self {
            surface,
            body: number,
            transport: body.sides[side].clone(),
            sign: if side == 0 { 1.0 } else { -1.0 },
            vertices,
            triangles,
            alone: body.sides.len() == 1,
            first_row: 0,
            rows: 0,
        }
    }

    /// Position relative to the view's origin, and normal on this side.
    pub(super) fn vertex(&self, vertex: u32) -> ([f32; 3], [f32; 3]) {
        let (position, normal) = vertex_of(self.surface, vertex);
        (position, normal.map(|c| c * self.sign))
    }

    /// As the surface is drawn, but from this side only.
    pub(super) fn primitive(&self) -> PrimitiveState {
        let cull_mode = match (self.alone, self.sign > 0.0) {
            (true, _) => CullMode::None,
            (false, true) => CullMode::Back,
            (false, false) => CullMode::Front,
        };
        PrimitiveState {
            cull_mode,
            ..self.surface.primitive.clone()
        }
    }

    /// Its triangles over a vertex buffer of its vertices.
    pub(super) fn draw(&self, pipeline: RenderPipeline, vertices: &Arc<VertexBuffer>) -> Draw {
        let indices = index_buffer(&self.triangles);
        let name = &self.surface.object.name;
        Draw::indexed(name, &Arc::new(pipeline), vertices, &indices)
    }

    /// Its triangles apart, each corner with what `corner` gives for its number in the
    /// triangle and the triangle.
    pub(super) fn draw_apart(
        &self,
        pipeline: RenderPipeline,
        corner: impl Fn(usize, [u32; 3]) -> Vec<f32>,
    ) -> Draw {
        let rows: Vec<Vec<f32>> = self
            .triangles
            .iter()
            .flat_map(|t| [0, 1, 2].map(|k| corner(k, *t)))
            .collect();
        let stride = rows.first().map_or(1, Vec::len);
        let data = rows.concat();
        let vertices = Arc::new(VertexBuffer { data, stride });
        let indices = Arc::new(IndexBuffer::new((0..vertices.len() as u32).collect()));
        let name = &self.surface.object.name;
        Draw::indexed(name, &Arc::new(pipeline), &vertices, &indices)
    }

    /// Its vertices as points.
    pub(super) fn draw_points(
        &self,
        pipeline: RenderPipeline,
        vertices: &Arc<VertexBuffer>,
    ) -> Draw {
        let name = &self.surface.object.name;
        Draw {
            vertices: Some(vertices.clone()),
            ..Draw::vertices_only(name, &Arc::new(pipeline), vertices.len() as u32)
        }
    }
}
