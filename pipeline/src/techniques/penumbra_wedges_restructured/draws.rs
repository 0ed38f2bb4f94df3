//! The draws of one light.

use std::sync::Arc;

use gnomon_raster::state::{
    ColorTargetState, CullMode, DepthStencilState, PrimitiveState, StencilFaceState,
    StencilOperation, StencilState,
};
use gnomon_raster::{RenderPipeline, TextureBinding, VertexBuffer};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::inside::{Part, WedgeInside};
use gnomon_shaders::penumbra::intensity::IntensityRates;
use gnomon_shaders::penumbra::plane::ScreenPlane;
use gnomon_shaders::transform::HomogeneousPoints;

use super::InsideDraws;
use super::list::{LightDraws, Shaded};
use crate::geometry::wedge::paper1::LinkedWedge;
use crate::parts::casters::Examined;
use crate::parts::passes::{self, View};
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::visibility::binding;
use crate::parts::volumes::near_pyramid::NearPyramid;
use crate::parts::wedges::penumbra::hard::{self, Method};
use crate::parts::wedges::penumbra::light::{self, LightSphere};
use crate::parts::wedges::penumbra::report::LinkedReport;
use crate::parts::wedges::penumbra::shape::{self, Faces, WedgeShape};
use crate::parts::wedges::penumbra::volume::SoftVolume;
use crate::parts::wedges::penumbra::{axes, screen};
use crate::technique::{CasterUse, VolumeMethod};
use crate::world::scene::Scene;

impl InsideDraws<'_> {
    pub(super) fn hard_light(&self, turn: &mut LightTurn<'_, '_>, draws: &mut LightDraws) {
        draws.hard = true;
        for caster in self.casters {
            let (scene, view, light) = (turn.scene, turn.view(), turn.number);
            let forced = self.choices.forced;
            let (draw, used) = hard::draw(scene, view, self.size, light, caster, forced);
            draws.tested.push(draw);
            turn.notes.casters.push(used);
        }
    }

    pub(super) fn soft_light(
        &self,
        turn: &mut LightTurn<'_, '_>,
        sphere: &LightSphere,
        draws: &mut LightDraws,
    ) {
        let mut report = LinkedReport::default();
        let settings = self.choices.penumbra.linked();
        let view = turn.view();
        let (points, others): (Vec<_>, Vec<_>) = self
            .casters
            .iter()
            .partition(|c| sphere.is_point_for(&c.object.mesh));
        points.iter().for_each(|c| self.hard_volume(turn, c, draws));
        let warning = light::point_warning(turn.number, points.len());
        turn.notes.warnings.extend(warning);
        for caster in others {
            let volume = caster.soft_volume(sphere, &settings, &mut report);
            let method = self
                .choices
                .forced
                .unwrap_or_else(|| choose(turn.scene, self.size, caster, &volume));
            if method == Method::DepthFail {
                self.caps(view, caster, &volume, draws);
                draws.start -= FULL * volume.all_around as f32;
            }
            for wedge in &volume.wedges {
                self.wedge(view, &caster.object.name, wedge, method, draws);
            }
            for gap in &volume.gaps {
                let faces = shape::triangles(view, &gap.triangles);
                let planes = [self.screen.plane(view, &gap.plane); 4];
                let shader = self.shader(view, planes, None, Part::Umbra, method);
                self.umbra(view, "gap", &faces, shader, draws);
            }
            let bottom = volume.bottom.len();
            let sides = 2 * volume.wedges.len() + volume.gaps.len();
            turn.notes.casters.push(CasterUse {
                object: caster.number,
                light: turn.number,
                method: method.reported(),
                triangles: [volume.cap.len() + volume.patches.len(), bottom, sides],
            });
        }
        let (light, warnings) = (turn.number, &mut turn.notes.warnings);
        warnings.extend(report.warnings(light));
        if self.choices.three {
            warnings.extend(report.stencil_warning(light));
        }
    }

    /// The volume of a caster for which the light has no extent, counted with the caps.
    fn hard_volume(
        &self,
        turn: &mut LightTurn<'_, '_>,
        caster: &Examined<'_>,
        draws: &mut LightDraws,
    ) {
        let (scene, view, light) = (turn.scene, turn.view(), turn.number);
        let forced = self.choices.forced;
        let (mut draw, used) = hard::draw(scene, view, self.size, light, caster, forced);
        if self.choices.three {
            let method = match used.method {
                VolumeMethod::DepthPass => Method::DepthPass,
                _ => Method::DepthFail,
            };
            draw.pipeline = Arc::new(into_stencil((*draw.pipeline).clone(), method));
        }
        draws.tested.push(draw);
        turn.notes.casters.push(used);
    }

    /// Top, patches and bottom of a volume, for z-fail.
    fn caps(
        &self,
        view: &View,
        caster: &Examined<'_>,
        volume: &SoftVolume,
        draws: &mut LightDraws,
    ) {
        let mesh = &caster.object.mesh;
        // The caster's own vertices, as the scene draws them: equal depth.
        let points = mesh.positions().iter().map(|p| view.point(*p));
        let top = Faces {
            vertices: Arc::new(VertexBuffer {
                data: points.flat_map(|[x, y, z]| [x, y, z, 1.0]).collect(),
                stride: 4,
            }),
            indices: passes::index_buffer(&volume.cap),
        };
        let patches = shape::triangles(view, &volume.patches);
        let bottom = shape::triangles(view, &volume.bottom);
        for (label, faces) in [("top", top), ("patches", patches), ("bottom", bottom)] {
            if faces.indices.indices().is_empty() {
                continue;
            }
            let mut pipeline = hard::boundary_pipeline(label, view, Method::DepthFail);
            if self.choices.three {
                pipeline = into_stencil(pipeline, Method::DepthFail);
            }
            draws.tested.push(faces.draw(label, pipeline, Vec::new()));
        }
    }

    fn wedge(
        &self,
        view: &View,
        label: &str,
        wedge: &LinkedWedge,
        method: Method,
        draws: &mut LightDraws,
    ) {
        let shape = WedgeShape::new(view, wedge);
        let planes = self.screen.wedge(view, wedge);
        let shader = |part| self.shader(view, planes, Some(wedge), part, method);
        // Faces through which the penumbra is drawn, and the other facing.
        let (drawn, other) = match method {
            Method::DepthPass => (CullMode::Back, CullMode::Front),
            Method::DepthFail => (CullMode::Front, CullMode::Back),
        };
        match &shape.others {
            Some(others) if !self.choices.three => {
                let all = [
                    (&shape.front, drawn, Part::Both),
                    (&shape.front, other, Part::Umbra),
                    (others, drawn, Part::Penumbra),
                ];
                let shaded =
                    all.map(|(f, cull, part)| self.shaded(view, label, f, cull, shader(part)));
                draws.intensity.extend(shaded);
            }
            _ => {
                self.umbra(view, label, &shape.front, shader(Part::Umbra), draws);
                let penumbra = self.shaded(view, label, &shape.all, drawn, shader(Part::Penumbra));
                draws.intensity.push(penumbra);
            }
        }
    }

    /// A boundary of the umbra by itself.
    fn umbra(
        &self,
        view: &View,
        label: &str,
        faces: &Faces,
        shader: WedgeInside,
        draws: &mut LightDraws,
    ) {
        if !self.choices.three {
            let draw = self.shaded(view, label, faces, CullMode::None, shader);
            draws.intensity.push(draw);
            return;
        }
        let method = if shader.depth_fail {
            Method::DepthFail
        } else {
            Method::DepthPass
        };
        for (pass, cull) in draws
            .umbra
            .iter_mut()
            .zip([CullMode::Back, CullMode::Front])
        {
            let mut pipeline = pipeline(view, cull, &shader);
            pipeline.color_targets.clear();
            pipeline.depth_stencil.stencil = counted(method);
            let draw = faces.draw(label, pipeline, self.bindings());
            pass.push((draw, Some(shader.clone())));
        }
    }

    fn shader(
        &self,
        view: &View,
        planes: [ScreenPlane; 4],
        wedge: Option<&LinkedWedge>,
        part: Part,
        method: Method,
    ) -> WedgeInside {
        let interpolation = self.choices.penumbra.interpolation;
        let mut tiles = self.choices.tiles.clone();
        if let Some(wedge) = wedge.filter(|_| part != Part::Umbra) {
            let wanted = self.choices.axes;
            if wanted.range {
                tiles.range = axes::of_depth(view, wedge, self.size);
            }
            if wanted.edges {
                tiles.axes = axes::of_edges(&self.screen, view, wedge, self.size);
            }
        }
        let none = IntensityRates {
            back_over_front: [1.0; 2],
            first_over_second: 1.0,
            interpolation,
        };
        WedgeInside {
            planes,
            rates: wedge.map_or(none, |w| screen::rates(w, interpolation)),
            part,
            depth_fail: method == Method::DepthFail,
            tiles,
        }
    }

    fn shaded(
        &self,
        view: &View,
        label: &str,
        faces: &Faces,
        cull: CullMode,
        shader: WedgeInside,
    ) -> Shaded {
        let pipeline = pipeline(view, cull, &shader);
        let draw = faces.draw(label, pipeline, self.bindings());
        (draw, Some(shader))
    }

    fn bindings(&self) -> Vec<TextureBinding> {
        self.inputs.iter().map(|&t| binding(t)).collect()
    }
}

/// A boundary counted in a stencil instead of in the light-intensity buffer.
fn into_stencil(mut pipeline: RenderPipeline, method: Method) -> RenderPipeline {
    pipeline.fragment = None;
    pipeline.color_targets.clear();
    pipeline.depth_stencil.stencil = counted(method);
    pipeline
}

/// z-fail where the eye is in or next to a wedge, or in the umbra, or where the near
/// plane cuts the caster, so that rays enter the umbra through its surface.
fn choose(scene: &Scene, size: [u32; 2], caster: &Examined<'_>, volume: &SoftVolume) -> Method {
    let camera = &scene.camera;
    // Next to: where a wedge's nearest face may be seen edge-on.
    let margin = camera.near + 1e-4 * (camera.target - camera.eye).length();
    let in_shadow =
        volume.may_hold(camera.eye, margin) || volume.winding(&caster.object.mesh, camera.eye) != 0;
    let before_near_plane = NearPyramid::before_near_plane(camera, size);
    if in_shadow || before_near_plane.may_touch(&caster.object.mesh) {
        Method::DepthFail
    } else {
        Method::DepthPass
    }
}

fn pipeline(view: &View, cull_mode: CullMode, shader: &WedgeInside) -> RenderPipeline {
    let label = match shader.part {
        Part::Umbra => "umbra",
        Part::Penumbra => "penumbra",
        Part::Both => "umbra and penumbra",
    };
    RenderPipeline {
        label: label.to_owned(),
        vertex: HomogeneousPoints(view.clip_from_world).stage(),
        fragment: Some(shader.clone().stage()),
        primitive: PrimitiveState {
            cull_mode,
            ..passes::clamped()
        },
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::ADDITIVE],
    }
}

/// Front faces of the umbra's boundary take one from a stencil, or add one where
/// they are counted beyond the surface; back faces the other way round.
fn counted(method: Method) -> StencilState {
    let face = |pass_op| StencilFaceState {
        pass_op,
        ..StencilFaceState::IGNORE
    };
    let [more, less] = [
        StencilOperation::IncrementWrap,
        StencilOperation::DecrementWrap,
    ]
    .map(face);
    match method {
        Method::DepthPass => StencilState {
            front: less,
            back: more,
        },
        Method::DepthFail => StencilState {
            front: more,
            back: less,
        },
    }
}
