//! Pass 1, the hard shadow count, in the ways that buffers ask for (paper III, §3.2.1
//! and §4): blended into floats or alphas, copied back one quad after the other, or in
//! the stencil.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthState, DepthStencilState, StencilFaceState,
    StencilOperation, StencilState,
};
use gnomon_raster::{Draw, LoadOp, RenderPass, RenderPipeline, TextureBinding, TextureId};
use gnomon_shaders::soft_volumes::{CountTo, CoverTo, Resolve};
use gnomon_shaders::visibility_buffers::{QuadCount, QuadTest};

use super::buffers::Buffers;
use crate::parts::passes::{Targets, View};
use crate::parts::visibility::{Positions, attachment, binding};
use crate::parts::wedges::soft::count::Counting;
use crate::parts::wedges::soft::edges::Silhouettes;
use crate::parts::wedges::soft::light::SoftLight;
use crate::parts::wedges::soft::pieces::{Piece, pieces};
use crate::technique::{Pass, PassRole, Warning};

/// Layers of umbrae that a stencil of 8 bits counts, a half of its values being kept for
/// counts below 0.
const MOST_LAYERS: usize = 127;

/// The hard shadows of one light.
pub(super) struct Umbra<'a> {
    pub(super) view: &'a View,
    pub(super) targets: &'a Targets,
    pub(super) positions: Positions,
    pub(super) buffers: &'a Buffers,
    pub(super) light: &'a SoftLight,
    /// Count quads that pass the depth test.
    pub(super) by_depth: bool,
}

impl Umbra<'_> {
    /// The count before wedges, if it is not in the stencil.
    pub(super) fn passes(&self, label: &str, silhouettes: &Silhouettes) -> Vec<Pass> {
        match self.buffers.cover_to() {
            CoverTo::RedGreen => Vec::new(),
            CoverTo::SixBits => {
                let draws = self.counting(CountTo::Alpha).draws(silhouettes);
                vec![self.pass(
                    label,
                    self.buffers.targets(),
                    LoadOp::Clear([0.0; 4]),
                    draws,
                )]
            }
            CoverTo::Visibility | CoverTo::Copied => self.float_passes(label, silhouettes),
        }
    }

    fn float_passes(&self, label: &str, silhouettes: &Silhouettes) -> Vec<Pass> {
        let (visibility, lit) = (vec![self.buffers.visibility], LoadOp::Clear([1.0; 4]));
        if let Some(aside) = self.buffers.aside {
            let clear = self.pass(label, visibility, lit, Vec::new());
            let each = pieces(self.view, self.light, silhouettes, true);
            let copied = each.iter().flat_map(|p| self.copied(label, p, aside));
            return std::iter::once(clear).chain(copied).collect();
        }
        let draws = if self.by_depth {
            let all = pieces(self.view, self.light, silhouettes, false);
            all.iter().map(|p| self.blended(p)).collect()
        } else {
            self.counting(CountTo::Visibility).draws(silhouettes)
        };
        vec![self.pass(label, visibility, lit, draws)]
    }

    fn counting(&self, to: CountTo) -> Counting<'_> {
        Counting {
            view: self.view,
            positions: self.positions,
            light: self.light,
            to,
        }
    }

    fn pass(
        &self,
        label: &str,
        color: Vec<TextureId>,
        load: LoadOp<[f32; 4]>,
        draws: Vec<Draw>,
    ) -> Pass {
        let tested = draws
            .iter()
            .any(|d| d.pipeline.depth_stencil != DepthStencilState::default());
        let depth_stencil = self.targets.depth_stencil(LoadOp::Load, LoadOp::Load);
        let pass = RenderPass {
            label: label.to_owned(),
            color: color.into_iter().map(|t| attachment(t, load)).collect(),
            depth_stencil: depth_stencil.filter(|_| tested),
            draws,
        };
        Pass::new(PassRole::HardCount, pass)
    }

    fn blended(&self, piece: &Piece) -> Draw {
        let shader = self.shader(piece, false).stage();
        let state = self.tested(piece);
        let textures = vec![binding(self.positions.texture)];
        self.draw(
            piece,
            Some(shader),
            ColorTargetState::ADDITIVE,
            state,
            textures,
        )
    }

    /// Reads visibility as a texture, writes the sum aside, copies it back.
    fn copied(&self, label: &str, piece: &Piece, aside: TextureId) -> [Pass; 2] {
        let visibility = self.buffers.visibility;
        let opaque = ColorTargetState::OPAQUE;
        let (shader, state) = (self.shader(piece, true).stage(), self.tested(piece));
        let from = vec![binding(self.positions.texture), binding(visibility)];
        let add = self.draw(piece, Some(shader), opaque, state, from);
        let copy = Some(Resolve::Copy.stage());
        let back = self.draw(piece, copy, opaque, state, vec![binding(aside)]);
        [
            self.pass(label, vec![aside], LoadOp::Load, vec![add]),
            self.pass(label, vec![visibility], LoadOp::Load, vec![back]),
        ]
    }

    fn shader(&self, piece: &Piece, copied: bool) -> QuadCount {
        QuadCount {
            origin: self.light.shader_origin(self.view),
            test: if self.by_depth && piece.is_quad {
                QuadTest::Depth
            } else {
                QuadTest::Sides
            },
            copied,
        }
    }

    /// Of quads those before the surface.
    fn tested(&self, piece: &Piece) -> DepthStencilState {
        if self.by_depth && piece.is_quad {
            before_surface(StencilState::default())
        } else {
            DepthStencilState::default()
        }
    }

    fn draw(
        &self,
        piece: &Piece,
        fragment: Option<FragmentStage>,
        target: ColorTargetState,
        depth_stencil: DepthStencilState,
        textures: Vec<TextureBinding>,
    ) -> Draw {
        let pipeline = RenderPipeline {
            label: piece.label.to_owned(),
            vertex: piece.vertex.clone(),
            fragment,
            primitive: piece.primitive.clone(),
            depth_stencil,
            color_targets: vec![target],
        };
        piece.draw(pipeline, textures)
    }

    /// The count in the stencil after wedges, which leave it at 0: the eye's own count,
    /// then quads and what the near plane cuts away (§4.2).
    pub(super) fn stencil_pass(&self, label: &str, silhouettes: &Silhouettes) -> Option<Pass> {
        if self.buffers.cover_to() != CoverTo::RedGreen {
            return None;
        }
        let eye = silhouettes.eye_count as u8;
        let all = pieces(self.view, self.light, silhouettes, false);
        let counted = all.iter().filter(|p| !p.is_eye());
        let pass = RenderPass {
            label: label.to_owned(),
            color: Vec::new(),
            depth_stencil: self.targets.depth_stencil(LoadOp::Load, LoadOp::Clear(eye)),
            draws: counted.map(|p| self.stenciled(p)).collect(),
        };
        Some(Pass::new(PassRole::HardCount, pass))
    }

    fn stenciled(&self, piece: &Piece) -> Draw {
        let face = StencilFaceState {
            pass_op: if piece.entered > 0 {
                StencilOperation::IncrementWrap
            } else {
                StencilOperation::DecrementWrap
            },
            ..StencilFaceState::IGNORE
        };
        let stencil = StencilState {
            front: face,
            back: face,
        };
        let state = if piece.is_quad {
            before_surface(stencil)
        } else {
            DepthStencilState {
                stencil,
                ..DepthStencilState::default()
            }
        };
        let pipeline = RenderPipeline {
            label: piece.label.to_owned(),
            vertex: piece.vertex.clone(),
            fragment: None,
            primitive: piece.primitive.clone(),
            depth_stencil: state,
            color_targets: Vec::new(),
        };
        piece.draw(pipeline, Vec::new())
    }

    /// Of more layers than the stencil counts.
    pub(super) fn warning(&self, label: &str, layers: impl FnOnce() -> usize) -> Option<Warning> {
        if self.buffers.cover_to() != CoverTo::RedGreen {
            return None;
        }
        let layers = layers();
        (layers > MOST_LAYERS).then(|| Warning {
            code: "umbrae-exceed-stencil",
            count: layers,
            message: format!(
                "{label}: up to {layers} umbrae may lie over one another, and the stencil counts \
                 {MOST_LAYERS}; buffer=r32f counts all"
            ),
        })
    }
}

/// Passes where the surface is behind.
fn before_surface(stencil: StencilState) -> DepthStencilState {
    DepthStencilState {
        depth: DepthState {
            compare: CompareFunction::Less,
            write: false,
            bounds: None,
        },
        stencil,
        ..DepthStencilState::default()
    }
}
