//! Wedges by their faces, where side planes cancel (paper I, §5 and §6).

use gnomon_raster::state::{
    ColorTargetState, CompareFunction, CullMode, DepthBias, DepthState, DepthStencilState,
    PrimitiveState,
};
use gnomon_raster::{Draw, RenderPipeline};
use gnomon_shaders::penumbra::face::{CrossedFace, WedgeFace};
use gnomon_shaders::penumbra::tiles::WedgePlanes;
use gnomon_shaders::transform::HomogeneousPoints;

use super::{CrossingDraws, Culling, LightWedges};
use crate::geometry::wedge::paper1::LinkedWedge;
use crate::parts::passes::{self, View};
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::visibility::binding;
use crate::parts::wedges::penumbra::screen;
use crate::parts::wedges::penumbra::shape::{self, Faces, WedgeShape};
use crate::parts::wedges::penumbra::volume::SoftVolume;

impl CrossingDraws<'_> {
    /// The wedges of a volume, and what bounds its umbra besides.
    pub(super) fn faces(
        &self,
        turn: &LightTurn<'_, '_>,
        label: &str,
        volume: &SoftVolume,
        found: &mut LightWedges,
    ) {
        let view = turn.view();
        for (k, wedge) in volume.wedges.iter().enumerate() {
            let planes = self.screen.wedge_planes(view, wedge, &volume.ends[k]);
            let shape = WedgeShape::new(view, volume.parts(k));
            self.wedge(view, label, (wedge, planes, &shape), found);
        }
        for gap in &volume.gaps {
            let plane = self.screen.plane(view, &gap.plane);
            let planes = WedgePlanes {
                planes: [plane; 4],
                front_margin: 0.0,
                bottom: None,
            };
            let faces = shape::triangles(view, &gap.triangles);
            found
                .wedges
                .push(self.boundary(view, (&faces, planes), None));
        }
    }

    fn wedge(
        &self,
        view: &View,
        label: &str,
        (wedge, planes, shape): (&LinkedWedge, WedgePlanes, &WedgeShape),
        found: &mut LightWedges,
    ) {
        let rates = screen::rates(wedge, self.settings.penumbra.interpolation);
        let (front, cull) = match planes.planes[0].eye_is_inside() {
            false => (CrossedFace::FrontEntered, CullMode::Back),
            true => (CrossedFace::FrontLeft, CullMode::Front),
        };
        for (faces, face) in [(&shape.front, front), (&shape.others, CrossedFace::Other)] {
            let shader = WedgeFace {
                wedge: planes,
                rates,
                face,
                shades: self.settings.full(),
            };
            found
                .wedges
                .push(self.face(view, label, (faces, cull), &shader));
        }
        if let Some(beyond) = &shape.beyond {
            found
                .wedges
                .push(self.boundary(view, (beyond, planes), Some(wedge)));
        }
    }

    /// A piece of the umbra's boundary without wedge, in the first of the planes.
    fn boundary(
        &self,
        view: &View,
        (faces, planes): (&Faces, WedgePlanes),
        wedge: Option<&LinkedWedge>,
    ) -> Draw {
        let interpolation = self.settings.penumbra.interpolation;
        let shader = WedgeFace {
            wedge: planes,
            rates: wedge.map_or_else(
                || screen::no_rates(interpolation),
                |w| screen::rates(w, interpolation),
            ),
            face: CrossedFace::Boundary,
            shades: self.settings.full(),
        };
        self.face(view, "boundary", (faces, CullMode::None), &shader)
    }

    fn face(
        &self,
        view: &View,
        label: &str,
        (faces, cull_mode): (&Faces, CullMode),
        shader: &WedgeFace,
    ) -> Draw {
        // Nothing that rays leave by can be culled: what is before it may be inside.
        let culled = self.settings.culling == Culling::Zmax && cull_mode == CullMode::Back;
        let pipeline = RenderPipeline {
            label: match shader.face {
                CrossedFace::Boundary => "boundary".to_owned(),
                _ => "wedge".to_owned(),
            },
            vertex: HomogeneousPoints(view.clip_from_world).stage(),
            fragment: Some(shader.stage()),
            primitive: PrimitiveState {
                cull_mode,
                ..passes::clamped()
            },
            depth_stencil: if culled {
                before_surfaces()
            } else {
                DepthStencilState::default()
            },
            color_targets: vec![ColorTargetState::ADDITIVE],
        };
        faces.draw(label, pipeline, vec![binding(self.depth)])
    }
}

/// Passes where a face may lie before the surface: nearer by a pixel of its slope, since
/// the shader decides by planes that are not snapped.
fn before_surfaces() -> DepthStencilState {
    DepthStencilState {
        depth: DepthState {
            compare: CompareFunction::Less,
            write: false,
            bounds: None,
        },
        bias: DepthBias {
            constant: -16.0,
            slope: -1.0,
            clamp: 0.0,
        },
        ..DepthStencilState::default()
    }
}
