//! The part of a caster's lit surface that the near plane cuts away.
//!
//! Soft techniques count an umbra from the eye on, and need no caps as long as no
//! ray passes a caster's surface on its way to what it shows. Where the near plane
//! cuts a caster open, rays do: through the lit triangles before the near plane,
//! each of which is the umbra's beginning, or its end. They are drawn with the
//! scene's own arithmetic and its clip plane turned round, so that a pixel has
//! either the triangle or its cap, and never both.

use glam::DVec3;
use gnomon_raster::state::PrimitiveState;
use gnomon_shaders::transform::ClipFromWorld;

use super::near_pyramid::NearPyramid;
use crate::parts::passes::{self, View};
use crate::world::mesh::{Mesh, narrow};

/// Corners as the scene has them.
pub(crate) type CapTriangle = [[f32; 3]; 3];

/// Those triangles of a volume's light cap, on the mesh's own vertices, that may
/// lie before the near plane in view.
pub(crate) fn cut_away(pyramid: &NearPyramid, mesh: &Mesh, cap: &[[u32; 3]]) -> Vec<CapTriangle> {
    if !pyramid.may_touch(mesh) {
        return Vec::new();
    }
    let corners = |t: &[u32; 3]| t.map(|i| mesh.position(i));
    let touching = cap.iter().map(corners);
    touching
        .filter(|t| pyramid.may_touch_triangle(*t))
        .map(|t: [DVec3; 3]| t.map(narrow))
        .collect()
}

/// Homogeneous corners of the triangles relative to the view's origin.
pub(crate) fn corners(view: &View, caps: &[CapTriangle]) -> impl Iterator<Item = [f32; 4]> {
    let points = caps.iter().flatten().map(|p| view.point(*p));
    let points: Vec<[f32; 3]> = points.collect();
    points.into_iter().map(|[x, y, z]| [x, y, z, 1.0])
}

/// The view's transform with a depth that is of no use but for its sign: geometry
/// is kept much nearer to the eye than depth clamp keeps it otherwise.
pub(crate) fn clip_from_world(view: &View) -> ClipFromWorld {
    const SHALLOW: f32 = 1.0 / 1_048_576.0; // a power of two: exact
    let mut rows = view.clip_from_world.0;
    rows[2] = rows[2].map(|c| c * SHALLOW);
    ClipFromWorld(rows)
}

/// What the scene's draws leave out: fragments before the near plane.
pub(crate) fn primitive() -> PrimitiveState {
    PrimitiveState {
        clip_planes: vec![[0.0, 0.0, -1.0, 0.0]],
        ..passes::clamped()
    }
}
