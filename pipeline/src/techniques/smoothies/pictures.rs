//! Pictures of blockers, of all surfaces, and of smoothies; and the look-up in them.

use std::sync::Arc;

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{BlendState, ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    DepthStencilAttachment, Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, StoreOp,
    Subresource, TextureBinding, TextureDescriptor, TextureId, VertexBuffer,
};
use gnomon_shaders::smoothies::{
    AlphaFrom, SmoothieAlpha, SmoothieDepth, SmoothieShadow, SmoothieVertices,
};

use super::attached::{Attached, attached};
use super::settings::{Construction, Settings};
use crate::parts::maps::light_view::{CasterGeometry, Fitted, LightMap, Surroundings};
use crate::parts::maps::mapped::Margin;
use crate::parts::maps::pictured::{PictureLookUp, PicturedLight, PicturedView, Pictures};
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::visibility::{attachment, binding};
use crate::technique::{Pass, PassRole, TechniqueError};

/// Textures of all views, which use them in turn.
pub(super) struct SmoothiePictures {
    technique: &'static str,
    settings: Settings,
    /// Depths of blockers.
    map: LightMap,
    /// Depths of all surfaces.
    surfaces: TextureId,
    /// Depths of smoothies.
    depth: TextureId,
    alpha: TextureId,
}

/// What is drawn for a light.
pub(super) struct SmoothieLight {
    /// All objects.
    surfaces: CasterGeometry,
    /// What is attached to each caster, for each view.
    views: Vec<Vec<Attached>>,
}

impl SmoothiePictures {
    pub(super) fn create(
        technique: &'static str,
        settings: &Settings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let side = settings.maps.view.fitting.size;
        let mut map = LightMap::create(side, recording)?;
        map.slope = settings.maps.slope_bias.unwrap_or(MARGIN.slope);
        let mut create = |label: &str| {
            recording.create(&TextureDescriptor::d2(label, Format::R32Float, side, side))
        };
        Ok(Self {
            technique,
            settings: *settings,
            map,
            surfaces: create("surfaces")?,
            depth: create("smoothie depth")?,
            alpha: create("smoothie alpha")?,
        })
    }

    fn pipeline(
        label: &str,
        view: &PicturedView<'_>,
        fragment: FragmentStage,
        depth_stencil: DepthStencilState,
        target: ColorTargetState,
    ) -> Arc<RenderPipeline> {
        let clip_from_world = view.fitted.clip_from_world(view.view);
        Arc::new(RenderPipeline {
            label: label.to_owned(),
            vertex: SmoothieVertices(clip_from_world).stage(),
            fragment: Some(fragment),
            primitive: PrimitiveState::default(),
            depth_stencil,
            color_targets: vec![target],
        })
    }

    /// The nearest depths of smoothies.
    fn depth_pass(&self, label: String, view: &PicturedView<'_>, all: &[Attached]) -> RenderPass {
        let shader = SmoothieDepth {
            range: view.fitted.depth_range(),
        };
        let state = DepthStencilState::opaque();
        let target = ColorTargetState::OPAQUE;
        let pipeline = Self::pipeline("smoothie depth", view, shader.stage(), state, target);
        RenderPass {
            label,
            color: vec![attachment(self.depth, LoadOp::Clear([1.0; 4]))],
            depth_stencil: Some(DepthStencilAttachment {
                texture: self.map.buffer(),
                subresource: Subresource::default(),
                depth_load: LoadOp::Clear(1.0),
                depth_store: StoreOp::Discard,
                stencil_load: LoadOp::DontCare,
                stencil_store: StoreOp::Discard,
            }),
            draws: draws(all, &pipeline, &[]),
        }
    }

    /// The least alpha of smoothies.
    fn alpha_pass(&self, label: String, view: &PicturedView<'_>, all: &[Attached]) -> RenderPass {
        let shader = SmoothieAlpha {
            range: view.fitted.depth_range(),
            base: view.fitted.base as f32,
            from: match self.settings.construction {
                Construction::Cones => AlphaFrom::Distances,
                Construction::Smoothies if self.settings.remapped => AlphaFrom::RemappedLength,
                Construction::Smoothies => AlphaFrom::Length,
            },
        };
        let target = ColorTargetState {
            blend: Some(BlendState::MIN),
            ..ColorTargetState::OPAQUE
        };
        let state = DepthStencilState::default();
        let pipeline = Self::pipeline("smoothie alpha", view, shader.stage(), state, target);
        RenderPass {
            label,
            color: vec![attachment(self.alpha, LoadOp::Clear([1.0; 4]))],
            depth_stencil: None,
            draws: draws(all, &pipeline, &[binding(self.surfaces)]),
        }
    }
}

/// Texels are the nearest ones, or four of them.
const MARGIN: Margin = Margin::ONE_TEXEL;

fn draws(
    all: &[Attached],
    pipeline: &Arc<RenderPipeline>,
    textures: &[TextureBinding],
) -> Vec<Draw> {
    let draw = |attached: &Attached| Draw {
        vertices: Some(Arc::<VertexBuffer>::clone(&attached.vertices)),
        textures: textures.to_vec(),
        ..Draw::vertices_only(&attached.name, pipeline, attached.vertices.len() as u32)
    };
    all.iter().map(draw).collect()
}

impl Pictures for SmoothiePictures {
    type Light = SmoothieLight;

    fn light(
        &self,
        turn: &mut LightTurn<'_, '_>,
        around: &Surroundings<'_>,
    ) -> Result<PicturedLight<SmoothieLight>, TechniqueError> {
        let found = attached(self.technique, &self.settings, turn, around)?;
        let reference = found.viewed.reference(around);
        Ok(PicturedLight {
            viewed: found.viewed,
            views: found.views,
            data: SmoothieLight {
                surfaces: CasterGeometry::of_all(turn.scene, turn.view(), reference),
                views: found.attached,
            },
        })
    }

    fn bias(&self, fitted: &Fitted) -> f64 {
        self.settings.maps.bias(fitted, MARGIN)
    }

    fn slope(&self) -> f64 {
        self.map.slope
    }

    fn passes(
        &self,
        light: &SmoothieLight,
        view: &PicturedView<'_>,
        label: &dyn Fn(&str) -> String,
    ) -> Vec<Pass> {
        let (fitted, map) = (view.fitted, &self.map);
        let blockers = fitted.pass(
            label("light view"),
            view.geometry,
            view.view,
            map,
            view.skip,
        );
        let surfaces = fitted.pass_of_all(
            label("surfaces"),
            &light.surfaces,
            view.view,
            map,
            self.surfaces,
        );
        let all = &light.views[view.number];
        let depth = self.depth_pass(label("smoothie depth"), view, all);
        let alpha = self.alpha_pass(label("smoothie alpha"), view, all);
        vec![
            Pass::new(PassRole::LightView, blockers),
            Pass::new(PassRole::LightView, surfaces),
            Pass::new(PassRole::Smoothies, depth),
            Pass::new(PassRole::Smoothies, alpha),
        ]
    }

    fn look_up(&self, _: &SmoothieLight, view: &PicturedView<'_>) -> PictureLookUp {
        let shader = SmoothieShadow {
            mapping: view.fitted.mapping(view.view, self.map.size),
            bias: self.bias(view.fitted) as f32,
            filtered: self.settings.filtered,
        };
        PictureLookUp {
            stage: shader.stage(),
            textures: vec![self.map.depth, self.depth, self.alpha],
        }
    }
}
