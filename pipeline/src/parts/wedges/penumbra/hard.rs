//! Lights without extent: shadow volumes counted in the light-intensity buffer.
//!
//! A wedge of a light of radius 0 has no inside, and its front plane is the hard
//! shadow quad (paper I, §4.1). Then the depth test counts boundaries, as in the
//! hard technique and with its choice between z-pass and z-fail: the picture is
//! the hard one, byte for byte.

use std::sync::Arc;

use gnomon_raster::state::{ColorTargetState, CompareFunction, DepthState, DepthStencilState};
use gnomon_raster::{Draw, RenderPipeline, VertexBuffer};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::buffers::Boundary;
use gnomon_shaders::transform::HomogeneousPoints;

use crate::parts::casters::Examined;
use crate::parts::passes::{self, View};
use crate::parts::volumes::near_pyramid::NearPyramid;
use crate::technique::{CasterUse, VolumeMethod};
use crate::world::light::HardLight;
use crate::world::scene::Scene;

/// Which side of the surfaces counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// Before them, from the eye.
    DepthPass,
    /// Beyond them.
    DepthFail,
}

impl Method {
    /// What a front face adds.
    pub(crate) fn front(self) -> f32 {
        match self {
            Self::DepthPass => -FULL,
            Self::DepthFail => FULL,
        }
    }

    /// For reports.
    pub(crate) fn reported(self) -> VolumeMethod {
        match self {
            Self::DepthPass => VolumeMethod::DepthPass,
            Self::DepthFail => VolumeMethod::DepthFail,
        }
    }

    /// Passes where a boundary lies on the side that counts; ties are beyond, so
    /// that a cap on the surface counts as beyond it.
    pub(crate) fn depth_test(self) -> DepthStencilState {
        let compare = match self {
            Self::DepthPass => CompareFunction::Less,
            Self::DepthFail => CompareFunction::GreaterEqual,
        };
        DepthStencilState {
            depth: DepthState {
                compare,
                write: false,
                bounds: None,
            },
            ..DepthStencilState::default()
        }
    }
}

/// State of a boundary whose depth is tested, into a light-intensity buffer.
pub(crate) fn boundary_pipeline(label: &str, view: &View, method: Method) -> RenderPipeline {
    let shader = Boundary {
        front: method.front(),
    };
    RenderPipeline {
        label: label.to_owned(),
        vertex: HomogeneousPoints(view.clip_from_world).stage(),
        fragment: Some(shader.stage()),
        primitive: passes::clamped(),
        depth_stencil: method.depth_test(),
        color_targets: vec![ColorTargetState::ADDITIVE],
    }
}

/// The volume of one caster for a light without extent. `forced` overrides the
/// choice of method.
pub(crate) fn draw(
    scene: &Scene,
    view: &View,
    size: [u32; 2],
    light: usize,
    examined: &Examined<'_>,
    forced: Option<Method>,
) -> (Draw, CasterUse) {
    let hard = scene.lights[light].hard();
    let mesh = &examined.object.mesh;
    let chosen = || choose(scene, size, hard, examined);
    let method = forced.unwrap_or_else(chosen);
    let volume = examined.caster.volume(mesh, hard);
    let triangles = match method {
        Method::DepthPass => volume.sides(),
        Method::DepthFail => volume.triangles(),
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
    let pipeline = boundary_pipeline("hard boundary", view, method);
    let indices = passes::index_buffer(triangles);
    let draw = Draw::indexed(
        &examined.object.name,
        &Arc::new(pipeline),
        &Arc::new(vertices),
        &indices,
    );
    let used = CasterUse {
        object: examined.number,
        light,
        method: method.reported(),
        triangles: volume.ranges().map(|r| r.len()),
    };
    (draw, used)
}

fn choose(scene: &Scene, size: [u32; 2], hard: HardLight, examined: &Examined<'_>) -> Method {
    let pyramid = NearPyramid::new(&scene.camera, size, hard);
    if pyramid.may_touch(&examined.object.mesh) {
        Method::DepthFail
    } else {
        Method::DepthPass
    }
}
