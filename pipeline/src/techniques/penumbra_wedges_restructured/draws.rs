//! The draws of one light.

use std::sync::Arc;

use gnomon_raster::state::{
    ColorTargetState, CullMode, DepthStencilState, PrimitiveState, StencilFaceState,
    StencilOperation, StencilState,
};
use gnomon_raster::{RenderPipeline, TextureBinding, VertexBuffer};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::inside::{FrontTest, WedgeInside};
use gnomon_shaders::penumbra::tiles::{Culling, TileLookUp, TileTest, WedgePlanes};
use gnomon_shaders::transform::HomogeneousPoints;

use super::list::LightDraws;
use super::{Adds, InsideDraws, WedgeModel};
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
use crate::parts::wedges::penumbra::{axes, reach, screen};
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
            let volume = caster.soft_volume(sphere, &settings, self.choices.length, &mut report);
            let method = self
                .choices
                .forced
                .unwrap_or_else(|| choose(turn.scene, self.size, caster, &volume));
            self.caps(view, caster, &volume, method, draws);
            if method == Method::DepthFail {
                draws.start -= FULL * volume.all_around as f32;
            }
            for (k, wedge) in volume.wedges.iter().enumerate() {
                let drawn = Drawn {
                    label: &caster.object.name,
                    wedge,
                    planes: self.screen.wedge_planes(view, wedge, &volume.ends[k]),
                    shape: WedgeShape::new(view, volume.parts(k)),
                    method,
                };
                self.wedge(view, &drawn, draws);
            }
            for gap in &volume.gaps {
                let plane = self.screen.plane(view, &gap.plane);
                let model = WedgeModel {
                    wedge: WedgePlanes {
                        planes: [plane; 4],
                        front_margin: self.screen.depth_margin(&plane),
                        bottom: None,
                    },
                    adds: Adds::Umbra,
                    depth_fail: method == Method::DepthFail,
                    tiles: self.choices.tiles.clone(),
                };
                let faces = shape::triangles(view, &gap.triangles);
                self.umbra(view, "gap", (&faces, CullMode::None), &model, draws);
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

    /// What closes a volume besides its sides: for z-fail top, patches and bottom; for
    /// z-pass the bottom where it is not at infinity.
    fn caps(
        &self,
        view: &View,
        caster: &Examined<'_>,
        volume: &SoftVolume,
        method: Method,
        draws: &mut LightDraws,
    ) {
        let fail = method == Method::DepthFail;
        let ends = volume.ends_somewhere;
        let bottom = (fail || ends).then(|| shape::triangles(view, &volume.bottom));
        let top = fail.then(|| top(view, caster, volume));
        let patches = fail.then(|| shape::triangles(view, &volume.patches));
        for (label, faces) in [("top", top), ("patches", patches), ("bottom", bottom)] {
            let Some(faces) = faces.filter(|f| !f.indices.indices().is_empty()) else {
                continue;
            };
            let mut pipeline = hard::boundary_pipeline(label, view, method);
            if self.choices.three {
                pipeline = into_stencil(pipeline, method);
            }
            draws.tested.push(faces.draw(label, pipeline, Vec::new()));
        }
    }

    /// The wedge by its faces on the front plane's side of the eye: which they are does
    /// not depend on the method, since both cover the same pixels.
    fn wedge(&self, view: &View, drawn: &Drawn<'_>, draws: &mut LightDraws) {
        let Drawn {
            label,
            wedge,
            planes,
            shape,
            method,
        } = drawn;
        let leaves = planes.planes[0].eye_is_inside();
        let (facing, other) = match leaves {
            false => (CullMode::Back, CullMode::Front),
            true => (CullMode::Front, CullMode::Back),
        };
        let model = |adds| WedgeModel {
            wedge: *planes,
            adds,
            depth_fail: *method == Method::DepthFail,
            tiles: self.tests(view, wedge, shape),
        };
        let both = !self.choices.three && leaves == (*method == Method::DepthFail);
        let boundary = (&shape.front, if both { other } else { CullMode::None });
        self.umbra(view, label, boundary, &model(Adds::Umbra), draws);
        if let Some(beyond) = &shape.beyond {
            let boundary = (beyond, CullMode::None);
            self.umbra(view, label, boundary, &model(Adds::Umbra), draws);
        }
        let Some(pixels) = reach::pixels(view, &shape.whole, self.size) else {
            return;
        };
        let classes = self.classes(pixels, &model(Adds::Penumbra), draws);
        let of_front = match (both, leaves) {
            (true, _) => FrontTest::Counted,
            (false, false) => FrontTest::Entered,
            (false, true) => FrontTest::Left,
        };
        for (faces, front) in [
            (&shape.front, of_front),
            (&shape.others, FrontTest::Implied),
        ] {
            let shader = WedgeInside {
                wedge: *planes,
                rates: screen::rates(wedge, self.choices.penumbra.interpolation),
                front,
                classes,
            };
            let adds = match front {
                FrontTest::Counted => Adds::Both,
                _ => Adds::Penumbra,
            };
            let pipeline = penumbra_pipeline(view, facing, *method, &shader);
            let draw = faces.draw(label, pipeline, self.bindings());
            draws.wedges().push((draw, Some(model(adds))));
        }
    }

    /// A boundary of the umbra by itself.
    fn umbra(
        &self,
        view: &View,
        label: &str,
        (faces, cull): (&Faces, CullMode),
        model: &WedgeModel,
        draws: &mut LightDraws,
    ) {
        let method = match model.depth_fail {
            true => Method::DepthFail,
            false => Method::DepthPass,
        };
        let pipeline = |cull_mode| {
            let mut pipeline = hard::boundary_pipeline("umbra", view, method);
            pipeline.primitive.cull_mode = cull_mode;
            pipeline
        };
        if !self.choices.three {
            let draw = faces.draw(label, pipeline(cull), Vec::new());
            draws.wedges().push((draw, Some(model.clone())));
            return;
        }
        // Hardware as there was draws these: no modelled tiles are culled.
        let model = WedgeModel {
            tiles: TileTest {
                culling: Culling::None,
                ..model.tiles.clone()
            },
            ..model.clone()
        };
        let facings = [CullMode::Back, CullMode::Front];
        for (pass, cull) in draws.umbra.iter_mut().zip(facings) {
            let pipeline = into_stencil(pipeline(cull), method);
            let draw = faces.draw(label, pipeline, Vec::new());
            pass.push((draw, Some(model.clone())));
        }
    }

    /// What tiles are tested against for a wedge.
    fn tests(&self, view: &View, wedge: &LinkedWedge, shape: &WedgeShape) -> TileTest {
        let mut tiles = self.choices.tiles.clone();
        let wanted = self.choices.axes;
        if wanted.range {
            let vertices = shape.whole.iter().flatten().copied();
            tiles.range = axes::of_depth(view, vertices, self.size);
        }
        if wanted.edges {
            tiles.axes = axes::of_edges(&self.screen, view, wedge, self.size);
        }
        tiles
    }

    /// Has the tiles under `pixels` classified before the wedge is drawn.
    fn classes(
        &self,
        pixels: [[u32; 2]; 2],
        model: &WedgeModel,
        draws: &mut LightDraws,
    ) -> Option<TileLookUp> {
        if model.tiles.culling == Culling::None {
            return None;
        }
        let atlas = self.atlas?;
        let tested = (&model.wedge, &model.tiles);
        let place = |draws: &mut LightDraws| {
            atlas.place(&mut draws.batch().shelves, pixels, tested, &self.bounds)
        };
        // A new batch holds any wedge: the atlas is larger than the image.
        let placed = place(draws).or_else(|| {
            draws.next_batch();
            place(draws)
        })?;
        draws.batch().classes.push(placed.draw);
        Some(placed.look_up)
    }

    fn bindings(&self) -> Vec<TextureBinding> {
        self.inputs.iter().map(|&t| binding(t)).collect()
    }
}

/// A wedge that is drawn.
struct Drawn<'a> {
    label: &'a str,
    wedge: &'a LinkedWedge,
    planes: WedgePlanes,
    shape: WedgeShape,
    method: Method,
}

/// The light-facing triangles of a caster.
fn top(view: &View, caster: &Examined<'_>, volume: &SoftVolume) -> Faces {
    // The caster's own vertices, as the scene draws them: equal depth.
    let points = caster
        .object
        .mesh
        .positions()
        .iter()
        .map(|p| view.point(*p));
    Faces {
        vertices: Arc::new(VertexBuffer {
            data: points.flat_map(|[x, y, z]| [x, y, z, 1.0]).collect(),
            stride: 4,
        }),
        indices: passes::index_buffer(&volume.cap),
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

/// State of a wedge's faces. Depth is tested only where the test counts the umbra too.
fn penumbra_pipeline(
    view: &View,
    cull_mode: CullMode,
    method: Method,
    shader: &WedgeInside,
) -> RenderPipeline {
    let counts = shader.front == FrontTest::Counted;
    RenderPipeline {
        label: match counts {
            true => "umbra and penumbra".to_owned(),
            false => "penumbra".to_owned(),
        },
        vertex: HomogeneousPoints(view.clip_from_world).stage(),
        fragment: Some(shader.stage()),
        primitive: PrimitiveState {
            cull_mode,
            ..passes::clamped()
        },
        depth_stencil: match counts {
            true => method.depth_test(),
            false => DepthStencilState::default(),
        },
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
