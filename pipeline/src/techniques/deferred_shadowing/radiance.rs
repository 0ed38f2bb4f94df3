//! Radiance of vertices, one pixel each, and of the surfaces between them (§6.1).

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::shader::{FragmentStage, VertexStage};
use gnomon_raster::state::{
    ColorTargetState, DepthStencilState, PrimitiveState, PrimitiveTopology,
};
use gnomon_raster::{
    ColorAttachment, Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline,
    TextureDescriptor, TextureId, VertexBuffer,
};
use gnomon_shaders::deferred::radiance::{
    Carried, Corners, GlossyRadiance, Reflections, SurfaceRadiance, VertexRadiance,
};

use super::bodies::{Body, Evaluation, normal_of};
use super::grazing::Gain;
use super::light::HarmonicLight;
use super::settings::Settings;
use super::sheets::{Sheet, Sheets};
use super::transported::Transported;
use crate::geometry::harmonics::{Product, dot, phong_lobe, scale_bands, terms};
use crate::parts::passes::{SceneDraws, Targets, equal_depth};
use crate::parts::visibility::{attachment, binding};
use crate::technique::{Pass, PassRole, TechniqueError};
use crate::world::mesh::narrow;

/// Luminance of linear Rec. 709 RGB.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Textures of vertices, and images of surfaces.
pub(super) struct RadianceTextures {
    /// Diffuse, a pixel a vertex.
    vertices: TextureId,
    glossy: Option<GlossyTextures>,
    /// L_s at each pixel.
    pub(super) image: TextureId,
}

/// The same of glossy surfaces.
struct GlossyTextures {
    /// Coefficients of G, block after block.
    transport: TextureId,
    /// L'_s, a pixel a vertex.
    vertices: TextureId,
    /// L'_s at each pixel.
    image: TextureId,
}

impl RadianceTextures {
    pub(super) fn create(
        sheets: &Sheets<'_, '_>,
        size: [u32; 2],
        glossy: bool,
        settings: &Settings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let format = float_format(settings);
        let mut create = |label: &str, [width, height]: [u32; 2]| {
            recording.create(&TextureDescriptor::d2(label, format, width, height))
        };
        let (width, rows) = (sheets.width, sheets.rows);
        let blocks = terms(settings.transport.glossy_bands) as u32;
        Ok(Self {
            vertices: create("vertex radiance", [width, rows])?,
            image: create("self-shadowed radiance", size)?,
            glossy: match glossy {
                false => None,
                true => Some(GlossyTextures {
                    transport: create("glossy transport", [width, rows * blocks])?,
                    vertices: create("glossy vertex radiance", [width, rows])?,
                    image: create("self-shadowed glossy radiance", size)?,
                }),
            },
        })
    }

    /// L'_s at each pixel, where something is glossy.
    pub(super) fn glossy_image(&self) -> Option<TextureId> {
        self.glossy.as_ref().map(|g| g.image)
    }

    fn images(&self) -> impl Iterator<Item = TextureId> {
        std::iter::once(self.image).chain(self.glossy_image())
    }

    fn vertex_textures(&self) -> impl Iterator<Item = TextureId> {
        std::iter::once(self.vertices).chain(self.glossy.as_ref().map(|g| g.vertices))
    }
}

/// Four channels of the wanted precision.
pub(super) fn float_format(settings: &Settings) -> Format {
    if settings.half_floats {
        Format::Rgba16Float
    } else {
        Format::Rgba32Float
    }
}

/// What passes of radiance are made from.
pub(super) struct Radiance<'f, 'a> {
    pub(super) bodies: &'f [Body<'a>],
    pub(super) sheets: &'f Sheets<'f, 'a>,
    pub(super) light: &'f HarmonicLight,
    pub(super) settings: &'f Settings,
    pub(super) draws: &'f SceneDraws<'a>,
    pub(super) textures: &'f RadianceTextures,
    /// Of each sheet.
    pub(super) transported: &'f [Transported],
}

impl Radiance<'_, '_> {
    /// Vertices, then surfaces.
    pub(super) fn passes(&self, targets: &Targets) -> Vec<Pass> {
        let sheets = || self.sheets.all.iter();
        let to = |texture| vec![attachment(texture, LoadOp::Clear([0.0; 4]))];
        let mut passes = vec![off_screen(
            "vertex radiance",
            to(self.textures.vertices),
            (sheets().zip(self.transported))
                .map(|(s, t)| self.diffuse_points(s, &t.gains))
                .collect(),
        )];
        if let Some(glossy) = &self.textures.glossy {
            let specular = || sheets().filter(|s| is_glossy(s));
            let transport = specular().flat_map(|s| self.glossy_transport(s));
            let light = specular().map(|s| self.glossy_points(s, glossy.transport));
            passes.push(off_screen(
                "glossy transport",
                to(glossy.transport),
                transport.collect(),
            ));
            passes.push(off_screen(
                "glossy vertex radiance",
                to(glossy.vertices),
                light.collect(),
            ));
        }
        passes.push(self.surfaces(targets));
        passes
    }

    /// Equation 2 for each vertex, with the luminance that an open surface would have. What
    /// it gains of small lights is three coefficients more, of light of one colour each.
    fn diffuse_points(&self, sheet: &Sheet<'_, '_>, gains: &[Gain]) -> Draw {
        let bands = self.settings.transport.bands;
        let body = &self.bodies[sheet.body];
        let light = self.light.turned(&body.rotation(bands));
        let evaluation = Evaluation::new(self.settings);
        let open = |v: u32| {
            let normal = body.own(normal_of(sheet.surface, v, sheet.sign.into()));
            if normal == DVec3::ZERO {
                return 0.0;
            }
            let open = evaluation.open(normal);
            let of = |c: usize| LUMINANCE[c] * dot(&light[c], &open);
            (of(0) + of(1) + of(2)) as f32
        };
        let rows = sheet.vertices.iter().enumerate().flat_map(|(k, &v)| {
            let [x, y] = self.sheets.place(sheet, k);
            let own = sheet.transport.diffuse_of(v as usize);
            let gain = gains.get(k);
            let open = open(v) + gain.map_or(0.0, |g| g.open as f32);
            let gained = gain.into_iter().flat_map(|g| g.light.map(|c| c as f32));
            let row = [x, y, open].into_iter().chain(own.iter().copied());
            row.chain(gained)
        });
        let colors = if gains.is_empty() { 0 } else { 3 };
        let vertices = buffer(rows.collect(), 3 + terms(bands) + colors);
        let light = (0..terms(bands)).map(|k| [0, 1, 2].map(|c| light[c][k] as f32));
        let pure = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let shader = VertexRadiance {
            light: light.chain(pure.into_iter().take(colors)).collect(),
        };
        self.points(sheet, 0, shader.stage(), Carried.stage(), &vertices)
    }

    /// A draw for each coefficient of G: a row of light's matrix times what a vertex
    /// sees, convolved with the highlight's lobe (equation 12).
    fn glossy_transport(&self, sheet: &Sheet<'_, '_>) -> Vec<Draw> {
        let bands = self.settings.transport.glossy_bands;
        let Some(product) = &self.light.product else {
            return Vec::new();
        };
        let turn = self.bodies[sheet.body].rotation(bands);
        let product: [Product; 3] = product.each_ref().map(|p| p.turned(&turn));
        let mut lobe = vec![1.0 / std::f64::consts::PI; terms(bands)];
        scale_bands(
            &mut lobe,
            &phong_lobe(sheet.surface.material.shininess, bands),
        );
        let rows = sheet.vertices.iter().enumerate().flat_map(|(k, &v)| {
            let [x, y] = self.sheets.place(sheet, k);
            let own = sheet.transport.glossy_of(v as usize);
            [x, y, 0.0].into_iter().chain(own.iter().copied())
        });
        let vertices = buffer(rows.collect(), 3 + terms(bands));
        let coefficient = |i: usize| {
            let of = |j: usize| [0, 1, 2].map(|c| (product[c].row(i)[j] * lobe[i]) as f32);
            let shader = VertexRadiance {
                light: (0..terms(bands)).map(of).collect(),
            };
            self.points(sheet, i as u32, shader.stage(), Carried.stage(), &vertices)
        };
        (0..terms(bands)).map(coefficient).collect()
    }

    /// Equation 13 for each vertex.
    fn glossy_points(&self, sheet: &Sheet<'_, '_>, transport: TextureId) -> Draw {
        let rows = sheet.vertices.iter().enumerate().flat_map(|(k, &v)| {
            let (position, normal) = sheet.vertex(v);
            let place = self.sheets.place(sheet, k);
            place.into_iter().chain(position).chain(normal)
        });
        let vertices = buffer(rows.collect(), 8);
        let turn = self.bodies[sheet.body].turn;
        let shader = Reflections {
            eye: narrow(self.draws.view.eye()),
            turn: [turn.x_axis, turn.y_axis, turn.z_axis].map(narrow),
        };
        let fragment = GlossyRadiance {
            bands: self.settings.transport.glossy_bands as u32,
            rows: self.sheets.rows,
        };
        let draw = self.points(sheet, 0, shader.stage(), fragment.stage(), &vertices);
        Draw {
            textures: vec![binding(transport)],
            ..draw
        }
    }

    fn points(
        &self,
        sheet: &Sheet<'_, '_>,
        block: u32,
        vertex: VertexStage,
        fragment: FragmentStage,
        vertices: &Arc<VertexBuffer>,
    ) -> Draw {
        let pipeline = RenderPipeline {
            label: "vertex radiance".into(),
            vertex,
            fragment: Some(fragment),
            primitive: PrimitiveState {
                topology: PrimitiveTopology::PointList,
                ..PrimitiveState::default()
            },
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        Draw {
            viewport: Some(self.sheets.viewport(sheet, block)),
            ..sheet.draw_points(pipeline, vertices)
        }
    }

    /// Surfaces with the radiance of their vertices.
    fn surfaces(&self, targets: &Targets) -> Pass {
        let cleared = |t| attachment(t, LoadOp::Clear([0.0; 4]));
        let pass = RenderPass {
            label: "self-shadowed radiance".into(),
            color: self.textures.images().map(cleared).collect(),
            depth_stencil: targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws: self.sheets.all.iter().map(|s| self.surface(s)).collect(),
        };
        Pass::new(PassRole::Radiance, pass)
    }

    fn surface(&self, sheet: &Sheet<'_, '_>) -> Draw {
        let glossy = self.textures.glossy.is_some() && is_glossy(sheet);
        let shader = SurfaceRadiance {
            width: self.sheets.width,
            glossy,
        };
        let pipeline = RenderPipeline {
            label: "self-shadowed radiance".into(),
            vertex: Corners(self.draws.view.clip_from_world).stage(),
            fragment: Some(shader.stage()),
            primitive: sheet.primitive(),
            depth_stencil: equal_depth(),
            color_targets: vec![ColorTargetState::OPAQUE; self.textures.images().count()],
        };
        let first = sheet.first_row * self.sheets.width;
        let draw = sheet.draw_apart(pipeline, |k, triangle| {
            let (position, _) = sheet.vertex(sheet.vertices[triangle[k] as usize]);
            let share = |corner| if k == corner { 1.0 } else { 0.0 };
            let numbers = triangle.map(|v| (first + v) as f32);
            let shares = [share(0), share(1)];
            position.into_iter().chain(shares).chain(numbers).collect()
        });
        let count = if glossy { 2 } else { 1 };
        Draw {
            textures: self
                .textures
                .vertex_textures()
                .take(count)
                .map(binding)
                .collect(),
            ..draw
        }
    }
}

/// Whether a sheet's material has highlights.
pub(super) fn is_glossy(sheet: &Sheet<'_, '_>) -> bool {
    sheet.surface.material.specular != [0.0; 3]
}

fn buffer(data: Vec<f32>, stride: usize) -> Arc<VertexBuffer> {
    Arc::new(VertexBuffer { data, stride })
}

fn off_screen(label: &str, color: Vec<ColorAttachment>, draws: Vec<Draw>) -> Pass {
    let pass = RenderPass {
        label: label.into(),
        color,
        depth_stencil: None,
        draws,
    };
    Pass::new(PassRole::Radiance, pass)
}
