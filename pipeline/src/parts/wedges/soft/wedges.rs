//! Wedges as draws: which pixels a penumbra may touch.
//!
//! Back faces are shaded where the scene is in front of them, and, with skipping,
//! only where front faces found the scene behind them, which a stencil value
//! notes (paper IV, §4.2.2; its depth functions are reversed, docs/papers.md, paper IV).
//! The shader gives exactly 0 outside the penumbra, so what is drawn only has to
//! hold it: wedges are built for an edge and a light that are a little larger, and
//! depth is biased outwards. Then skipping changes no bit.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{
    ColorTargetState, CompareFunction, CullMode, DepthBias, DepthState, DepthStencilState,
    PrimitiveState, StencilFaceState, StencilOperation, StencilState,
};
use gnomon_raster::{Draw, RenderPipeline, TextureBinding, VertexBuffer};
use gnomon_shaders::split_volumes::resolve::COUNT_BITS;
use gnomon_shaders::transform::{FullScreen, HomogeneousPoints};

use crate::geometry::area_light::AreaLight;
use crate::geometry::wedge::{Construction, Wedge, WedgeMesh, WedgeStatistics};
use crate::parts::passes::{self, View};
use crate::parts::visibility::{full_screen, homogeneous, homogeneous_draw};
use crate::technique::{DrawRole, Warning};

/// The stencil's bit that notes pixels of wedges; the others may hold a count.
const NOTED: u8 = !COUNT_BITS;

/// By how much the light, and the edge, are enlarged.
const LARGER_LIGHT: f64 = 2e-4;
const LARGER_EDGE: f64 = 1e-4;

/// The pixels that one penumbra may touch.
pub(crate) struct WedgeArea {
    /// Vertices and triangles; `None` for the whole screen.
    mesh: Option<(Arc<VertexBuffer>, Vec<[u32; 3]>)>,
    /// Whether the eye may be inside, so that front faces are not to be seen.
    around_eye: bool,
}

/// What became of wedges besides [`WedgeStatistics`].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AreaStatistics {
    /// Wedges drawn as the whole screen, because there is no one mesh for them.
    pub(crate) whole_screen: u64,
    /// Wedges drawn whole for one of their halves, because nothing splits them.
    pub(crate) unsplit: u64,
}

/// What is done with the pixels of a wedge.
pub(crate) struct WedgePipeline<'a> {
    pub(crate) label: &'a str,
    pub(crate) fragment: FragmentStage,
    pub(crate) targets: Vec<ColorTargetState>,
    pub(crate) textures: Vec<TextureBinding>,
    /// Leave out pixels whose surface is in front of the wedge or behind it.
    pub(crate) skip: bool,
    /// Whether pixels are noted, and whether the note is removed.
    pub(crate) note: Note,
    /// What the draws are for that run the shader.
    pub(crate) role: DrawRole,
}

/// What a draw does with the stencil's note.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Note {
    /// Takes it and removes it.
    TakeAndRemove,
    /// Takes it and leaves it.
    Take,
    /// Uses the one that is there and removes it.
    Remove,
}

impl WedgeArea {
    pub(crate) fn new(
        view: &View,
        construction: Construction,
        light: &AreaLight,
        ends: [DVec3; 2],
        statistics: &mut AreaStatistics,
    ) -> Self {
        let larger = enlarged(light);
        let ends = enlarged_edge(light.centre(), ends);
        let mut met = WedgeStatistics::default();
        let wedges = Wedge::of_edge(construction, &larger, ends, &mut met);
        let meshes: Vec<_> = wedges.iter().map(|w| w.volume.mesh()).collect();
        let one = match (&meshes[..], &wedges[..]) {
            // A half-space at the enlarged light holds less, not more.
            ([mesh], [wedge]) if met.touching_light == 0 => {
                Self::of_mesh(view, mesh, wedge.volume.depth(view.camera().eye))
            }
            _ => None,
        };
        one.unwrap_or_else(|| {
            statistics.whole_screen += 1;
            Self {
                mesh: None,
                around_eye: true,
            }
        })
    }

    /// The pixels of a closed mesh in which the eye is `depth` deep, negative
    /// outside; `None` without triangles.
    pub(crate) fn of_mesh(view: &View, mesh: &WedgeMesh, depth: f64) -> Option<Self> {
        let triangles = mesh.triangles.clone();
        (!triangles.is_empty()).then(|| Self {
            mesh: Some((Arc::new(homogeneous(view, &mesh.vertices)), triangles)),
            around_eye: depth > -view.camera().near,
        })
    }

    /// Draws over the area, in order.
    pub(crate) fn draws(&self, view: &View, p: WedgePipeline<'_>) -> Vec<(Draw, DrawRole)> {
        let Some((vertices, triangles)) = &self.mesh else {
            let pipeline = RenderPipeline {
                label: p.label.to_owned(),
                vertex: FullScreen.stage(),
                fragment: Some(p.fragment),
                primitive: PrimitiveState::default(),
                depth_stencil: DepthStencilState::default(),
                color_targets: p.targets,
            };
            return vec![(full_screen(pipeline, p.textures), p.role)];
        };
        let noted = p.skip && !self.around_eye;
        let vertex = HomogeneousPoints(view.clip_from_world).stage();
        let mut draws = Vec::new();
        if noted && p.note != Note::Remove {
            let pipeline = RenderPipeline {
                label: "note".into(),
                vertex: vertex.clone(),
                fragment: None,
                primitive: culled(CullMode::Back),
                depth_stencil: note_front(),
                color_targets: vec![ColorTargetState::NONE; p.targets.len()],
            };
            let mut draw = homogeneous_draw("note", pipeline, vertices, triangles, Vec::new());
            draw.stencil_reference = [NOTED; 2];
            draws.push((draw, DrawRole::Note));
        }
        let pipeline = RenderPipeline {
            label: p.label.to_owned(),
            vertex,
            fragment: Some(p.fragment),
            primitive: culled(CullMode::Front),
            depth_stencil: shade_back(p.skip, noted, p.note),
            color_targets: p.targets,
        };
        let mut draw = homogeneous_draw(p.label, pipeline, vertices, triangles, p.textures);
        draw.stencil_reference = [NOTED; 2];
        draws.push((draw, p.role));
        draws
    }
}

fn culled(cull_mode: CullMode) -> PrimitiveState {
    PrimitiveState {
        cull_mode,
        ..passes::clamped()
    }
}

/// Depth outwards, by the rounding of depth and several times what the snapping
/// of vertices to 1/256 pixel moves a sloping plane.
pub(super) fn bias(sign: f32) -> DepthBias {
    DepthBias {
        constant: 4.0 * sign,
        slope: sign / 64.0,
        clamp: 0.0,
    }
}

/// Notes where the scene is behind front faces.
fn note_front() -> DepthStencilState {
    let face = StencilFaceState {
        pass_op: StencilOperation::Replace,
        write_mask: NOTED,
        ..StencilFaceState::IGNORE
    };
    DepthStencilState {
        depth: DepthState {
            compare: CompareFunction::LessEqual,
            write: false,
            bounds: None,
        },
        stencil: StencilState {
            front: face,
            back: face,
        },
        bias: bias(-1.0),
    }
}

/// Passes where the scene is in front of back faces, and noted. Every noted pixel
/// has a back face, so a removed note leaves none behind.
fn shade_back(skip: bool, noted: bool, note: Note) -> DepthStencilState {
    let after = if note == Note::Take {
        StencilOperation::Keep
    } else {
        StencilOperation::Zero
    };
    let face = StencilFaceState {
        compare: CompareFunction::Equal,
        pass_op: after,
        depth_fail_op: after,
        read_mask: NOTED,
        write_mask: NOTED,
        ..StencilFaceState::IGNORE
    };
    DepthStencilState {
        depth: DepthState {
            compare: if skip {
                CompareFunction::GreaterEqual
            } else {
                CompareFunction::Always
            },
            write: false,
            bounds: None,
        },
        stencil: if noted {
            StencilState {
                front: face,
                back: face,
            }
        } else {
            StencilState::default()
        },
        bias: if skip {
            bias(1.0)
        } else {
            DepthBias::default()
        },
    }
}

/// The light, a little larger.
pub(super) fn enlarged(light: &AreaLight) -> AreaLight {
    let mut larger = light.clone();
    match &mut larger {
        AreaLight::Polygon {
            corners, centre, ..
        } => {
            for corner in corners {
                *corner = *centre + (*corner - *centre) * (1.0 + LARGER_LIGHT);
            }
        }
        AreaLight::Disc { radius, .. } | AreaLight::Sphere { radius, .. } => {
            *radius *= 1.0 + LARGER_LIGHT;
        }
    }
    larger
}

/// The edge a little nearer to the light and longer at both ends.
fn enlarged_edge(centre: DVec3, [a, b]: [DVec3; 2]) -> [DVec3; 2] {
    let nearer = |e: DVec3| e + (centre - e) * LARGER_EDGE;
    longer([nearer(a), nearer(b)])
}

/// The edge a little longer at both ends.
pub(super) fn longer([a, b]: [DVec3; 2]) -> [DVec3; 2] {
    let more = (b - a) * LARGER_EDGE;
    [a - more, b + more]
}

/// What wedge construction found, for people.
pub(crate) fn warnings_of(
    label: &str,
    wedges: &WedgeStatistics,
    areas: &AreaStatistics,
) -> impl Iterator<Item = Warning> + use<> {
    let counted = [
        (
            "edges-touching-light",
            wedges.touching_light,
            "silhouette edges touch the light; their wedges are half-spaces",
        ),
        (
            "wedges-built-exactly",
            wedges.aimed_at_centre + wedges.meets_light,
            "wedges are not defined as asked for, and built exactly instead",
        ),
        (
            "wedges-whole-screen",
            areas.whole_screen,
            "wedges have no one mesh that is sure to hold them, and are drawn over the whole screen",
        ),
        (
            "wedges-unsplit",
            areas.unsplit,
            "wedges are drawn whole for one of their halves, because nothing splits them",
        ),
    ];
    let label = label.to_owned();
    counted
        .into_iter()
        .filter(|(_, count, _)| *count != 0)
        .map(move |(code, count, what)| Warning {
            code,
            count: count as usize,
            message: format!("{label}: {count} {what}"),
        })
}
