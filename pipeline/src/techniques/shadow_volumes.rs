//! Hard shadows by stencil volumes: z-pass, z-fail, or the cheaper one that is
//! right, caster by caster (IMPLEMENTING §1.1).
//!
//! Per light: count the volumes into the stencil, wrapping modulo 256, then add
//! the light where the count is 0. Volumes reach to infinity. z-fail draws both
//! caps and the sides where they *fail* the depth test; the light cap is the
//! caster's own triangles through the caster's own arithmetic, so it fails
//! against the surface by equality. z-pass draws the sides where they pass; it
//! miscounts where the view starts inside the volume, so `auto` takes it only
//! where [`NearPyramid`] proves that it does not.
//!
//! Visibility is that of the first light asked for, which is drawn last, so
//! that the final stencil is its own.

use std::sync::Arc;

use gnomon_raster::state::DepthStencilState;
use gnomon_raster::{Draw, LoadOp, RenderPass, RenderPipeline, VertexBuffer};
use gnomon_shaders::transform::HomogeneousPoints;

use super::near_pyramid::{NearPyramid, outside_view};
use super::passes::{self, LitTest, SceneDraws, Targets, View};
use crate::caster::{Caster, CasterPolicy, UnknownPolicy};
use crate::scene::{Object, Scene};
use crate::technique::{
    CasterUse, Frame, ParamInfo, Params, Technique, TechniqueError, TextureSource,
    VisibilityOutput, VolumeMethod, Warning,
};
use crate::volume::ShadowVolume;

/// The registry's entry.
pub(crate) struct ShadowVolumes;

const METHOD: ParamInfo = ParamInfo {
    name: "method",
    default: "auto",
    valid: "auto|zpass|zfail",
    summary: "auto: z-pass for casters that cannot shadow the near rectangle, z-fail for the others",
};

pub(super) const OPEN_CASTERS: ParamInfo = ParamInfo {
    name: "open-casters",
    default: "refuse",
    valid: "refuse|generalised",
    summary: "casters that are not closed: refuse them, or use the multiplicity-weighted silhouette",
};

pub(super) const SKIP: ParamInfo = ParamInfo {
    name: "skip",
    default: "on",
    valid: "on|off",
    summary: "leave out casters whose volume is outside the view; same bits",
};

impl Technique for ShadowVolumes {
    fn name(&self) -> &'static str {
        "shadow-volumes"
    }

    fn summary(&self) -> &'static str {
        "hard shadows by stencil volumes to infinity, z-pass or z-fail"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            METHOD,
            OPEN_CASTERS,
            passes::LIGHT,
            SKIP,
            passes::SHADING,
            passes::COLOR_FORMAT,
            passes::DEPTH_FORMAT,
        ];
        PARAMS
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
        textures: &mut dyn TextureSource,
    ) -> Result<Frame, TechniqueError> {
        let targets = Targets::create(size, params, textures)?;
        let draws = SceneDraws::new(scene, size, params);
        let casters = Casters::new(scene, params)?;
        let lights = passes::lights(scene, params)?;
        let mut list = vec![draws.ambient_pass(&targets)];
        let mut uses = Vec::new();
        let mut warnings = Vec::new();
        for (turn, &light) in lights.iter().rev().enumerate() {
            let built = casters.volumes(light, size, params, &mut uses, &mut warnings);
            let label = passes::label("volumes", light, &lights);
            list.push(volumes_pass(&targets, label, built, turn == 0));
            let label = passes::label("lit", light, &lights);
            list.push(draws.lit_pass(&targets, light, &label, LitTest::StencilZero));
        }
        let mut frame = targets.frame(list, VisibilityOutput::StencilZero);
        frame.warnings = warnings;
        frame.casters = uses;
        Ok(frame)
    }
}

/// The stencil is zero in the first of several passes, the ambient pass having
/// cleared it; the others clear it themselves.
fn volumes_pass(targets: &Targets, label: String, draws: Vec<Draw>, first: bool) -> RenderPass {
    let stencil = if first {
        LoadOp::Load
    } else {
        LoadOp::Clear(0)
    };
    RenderPass {
        label,
        color: Vec::new(),
        depth_stencil: targets.depth_stencil(LoadOp::Load, stencil),
        draws,
    }
}

/// The casters of a scene, examined once for all lights.
struct Casters<'a> {
    scene: &'a Scene,
    examined: Vec<(usize, &'a Object, Caster)>,
}

impl<'a> Casters<'a> {
    fn new(scene: &'a Scene, params: &Params) -> Result<Self, TechniqueError> {
        let policy = policy(ShadowVolumes.name(), params)?;
        let casters = scene
            .objects
            .iter()
            .enumerate()
            .filter(|(_, o)| o.casts && !o.mesh.triangles().is_empty());
        let examined = casters.map(|(i, o)| Ok((i, o, Caster::of_object(o, policy)?)));
        Ok(Self {
            scene,
            examined: examined.collect::<Result<_, TechniqueError>>()?,
        })
    }

    /// Draws of the volumes for one light.
    fn volumes(
        &self,
        light: usize,
        size: [u32; 2],
        params: &Params,
        uses: &mut Vec<CasterUse>,
        warnings: &mut Vec<Warning>,
    ) -> Vec<Draw> {
        let hard = self.scene.lights[light].hard();
        let pyramid = NearPyramid::new(&self.scene.camera, size, hard);
        let mut draws = Vec::new();
        for (number, object, caster) in &self.examined {
            let mesh = &object.mesh;
            let hidden = params.get(SKIP.name) != "off"
                && outside_view(&self.scene.camera, size, mesh, hard);
            let method = match params.get(METHOD.name) {
                _ if hidden => VolumeMethod::Skipped,
                "zpass" => VolumeMethod::DepthPass,
                "zfail" => VolumeMethod::DepthFail,
                _ if pyramid.may_touch(mesh) => VolumeMethod::DepthFail,
                _ => VolumeMethod::DepthPass,
            };
            let mut used = CasterUse {
                object: *number,
                light,
                method,
                triangles: [0; 3],
            };
            if !hidden {
                let volume = caster.volume(mesh, hard);
                used.triangles = volume.ranges().map(|r| r.len());
                warnings.extend(wrap_warning(object, &volume));
                draws.push(self.draw(object, &volume, method, size));
            }
            uses.push(used);
        }
        draws
    }

    fn draw(
        &self,
        object: &Object,
        volume: &ShadowVolume,
        method: VolumeMethod,
        size: [u32; 2],
    ) -> Draw {
        let view = View::new(&self.scene.camera, size);
        let depth_pass = method == VolumeMethod::DepthPass;
        let (depth_stencil, triangles) = if depth_pass {
            (DepthStencilState::z_pass_volumes(), volume.sides())
        } else {
            (DepthStencilState::z_fail_volumes(), volume.triangles())
        };
        let pipeline = RenderPipeline {
            label: if depth_pass {
                "z-pass".into()
            } else {
                "z-fail".into()
            },
            vertex: HomogeneousPoints(view.clip_from_world).stage(),
            fragment: None,
            primitive: passes::clamped(),
            depth_stencil,
            color_targets: Vec::new(),
        };
        // Points move with the origin, directions stay.
        let moved = |&[x, y, z, w]: &[f32; 4]| {
            let [x, y, z] = if w == 0.0 {
                [x, y, z]
            } else {
                view.point([x, y, z])
            };
            [x, y, z, w]
        };
        let vertices = VertexBuffer {
            data: volume.positions().iter().flat_map(moved).collect(),
            stride: 4,
        };
        let indices = passes::index_buffer(triangles);
        Draw::indexed(
            &object.name,
            &Arc::new(pipeline),
            &Arc::new(vertices),
            &indices,
        )
    }
}

/// What is to be done with casters that are not closed.
pub(super) fn policy(
    technique: &'static str,
    params: &Params,
) -> Result<CasterPolicy, TechniqueError> {
    let bad = |UnknownPolicy(value)| TechniqueError::BadValue {
        technique,
        key: OPEN_CASTERS.name,
        value,
        valid: OPEN_CASTERS.valid,
    };
    params.get(OPEN_CASTERS.name).parse().map_err(bad)
}

fn wrap_warning(object: &Object, volume: &ShadowVolume) -> Option<Warning> {
    (volume.max_multiplicity() > 255).then(|| Warning {
        code: "edge-multiplicity",
        count: 1,
        message: format!(
            "object '{}': {} volume sides leave one edge; a multiple of 256 counts as lit",
            object.name,
            volume.max_multiplicity()
        ),
    })
}
