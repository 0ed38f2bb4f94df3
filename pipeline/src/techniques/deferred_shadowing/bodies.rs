//! Objects with their transport.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::settings::Settings;
use crate::geometry::harmonics::{Basis, Rotation, about_axis, cosine_power, dot};
use crate::parts::passes::SceneDraws;
use crate::parts::surface_draw::SurfaceDraw;
use crate::parts::surface_vertices::STRIDE;
use crate::truth::oracle::transport::{Transport, TransportObject};
use crate::world::adjacency::EdgeAdjacency;
use crate::world::mesh::{Mesh, widen};
use crate::world::scene::{Object, Scene};

/// An object that is drawn, as a receiver.
pub(super) struct Body<'a> {
    pub(super) object: &'a Object,
    /// From the axes of its transport to the world's.
    pub(super) turn: DMat3,
    /// Of its outside, and of its inside where that can be seen.
    pub(super) sides: Vec<Arc<Transport>>,
    /// World-space bounds.
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

/// All bodies of a scene, in drawing order.
pub(super) fn bodies<'a>(
    scene: &'a Scene,
    draws: &SceneDraws<'a>,
    settings: &Settings,
) -> Vec<Body<'a>> {
    with_transport(scene, draws, &|object| {
        Transport::kept(object, settings.transport)
    })
}

/// What gives an object's transport.
type Source<'s> = &'s dyn Fn(&TransportObject<'_>) -> Arc<Transport>;

/// The same with transport from anywhere.
pub(super) fn with_transport<'a>(
    scene: &'a Scene,
    draws: &SceneDraws<'a>,
    source: Source<'_>,
) -> Vec<Body<'a>> {
    let body = |object: &'a Object| {
        let surfaces = draws.surfaces();
        let own = surfaces.iter().find(|s| std::ptr::eq(s.object, object))?;
        Body::new(object, own, source)
    };
    scene.objects.iter().filter_map(body).collect()
}

impl<'a> Body<'a> {
    fn new(object: &'a Object, surface: &SurfaceDraw<'_>, source: Source<'_>) -> Option<Self> {
        let (low, high) = object.mesh.bounds()?;
        let hides = object.casts && object.receives;
        let rest = object
            .rest
            .as_ref()
            .filter(|rest| hides && rest.is_of(&object.mesh));
        let geometry = match (hides, rest) {
            (true, rest) => Geometry::of_mesh(rest.map_or(&object.mesh, |r| &r.mesh)),
            (false, _) => Geometry::of_surface(surface),
        };
        let closed = || {
            let mesh = &object.mesh;
            let adjacency = EdgeAdjacency::new(mesh.triangles());
            adjacency.closedness(mesh).is_closed()
        };
        let both = if closed() { &[1.0][..] } else { &[1.0, -1.0] };
        let side = |sign: &f32| geometry.transport(*sign, source);
        Some(Self {
            object,
            turn: rest.map_or(DMat3::IDENTITY, |rest| rest.turn),
            sides: both.iter().map(side).collect(),
            low,
            high,
        })
    }

    pub(super) fn centre(&self) -> DVec3 {
        (self.low + self.high) * 0.5
    }

    /// A direction of the world in the axes of its transport.
    pub(super) fn own(&self, direction: DVec3) -> DVec3 {
        self.turn.transpose() * direction
    }

    /// Turns functions of the world's directions into its axes.
    pub(super) fn rotation(&self, bands: usize) -> Rotation {
        Rotation::new(&self.turn.transpose(), bands)
    }
}

/// What transport is computed of.
struct Geometry {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    casts: bool,
}

impl Geometry {
    fn of_mesh(mesh: &Mesh) -> Self {
        let list = mesh.shading_vertices();
        Self {
            positions: list.positions,
            normals: list.normals,
            triangles: list.triangles,
            casts: true,
        }
    }

    /// Where nothing is hidden only normals count.
    fn of_surface(surface: &SurfaceDraw<'_>) -> Self {
        let rows = surface.vertices().data.chunks_exact(STRIDE);
        let normals: Vec<_> = rows.map(|r| [r[3], r[4], r[5]]).collect();
        Self {
            positions: vec![[0.0; 3]; normals.len()],
            normals,
            triangles: Vec::new(),
            casts: false,
        }
    }

    fn transport(&self, sign: f32, source: Source<'_>) -> Arc<Transport> {
        let normals: Vec<_> = self.normals.iter().map(|n| n.map(|c| c * sign)).collect();
        let object = TransportObject {
            positions: &self.positions,
            normals: &normals,
            triangles: &self.triangles,
            casts: self.casts,
        };
        source(&object)
    }
}

/// Evaluates transport in directions of light.
pub(super) struct Evaluation {
    diffuse: Basis,
    glossy: Basis,
    lobe: Vec<f64>,
}

/// What an open surface's transport gains before it is divided by, so that next to the
/// horizon, where both are nearly nothing, all counts as visible.
const NEXT_TO_NOTHING: f64 = 0.02;

impl Evaluation {
    pub(super) fn new(settings: &Settings) -> Self {
        let bands = settings.transport.bands;
        Self {
            diffuse: Basis::new(bands),
            glossy: Basis::new(settings.transport.glossy_bands),
            lobe: cosine_power(1.0, bands),
        }
    }

    /// The bases at directions of a body's axes.
    pub(super) fn towards(&self, directions: &[DVec3]) -> Vec<Towards> {
        let at = |d: &DVec3| Towards {
            diffuse: self.diffuse.at(*d),
            glossy: self.glossy.at(*d),
        };
        directions.iter().map(at).collect()
    }

    /// T of a vertex towards `own`, which may ring below 0.
    fn diffuse(&self, transport: &Transport, vertex: usize, own: DVec3) -> f64 {
        dot(&wide(transport.diffuse_of(vertex)), &self.diffuse.at(own))
    }

    /// Coefficients of T where nothing is hidden.
    pub(super) fn open(&self, own_normal: DVec3) -> Vec<f64> {
        let mut open = about_axis(&self.diffuse, own_normal, &self.lobe);
        open.iter_mut().for_each(|c| *c /= PI);
        open
    }

    /// How much of the light from `own` a vertex leaves visible: its transport over that
    /// of an open surface.
    pub(super) fn visible(
        &self,
        transport: &Transport,
        vertex: usize,
        own: DVec3,
        own_normal: DVec3,
    ) -> f64 {
        let open = dot(&self.open(own_normal), &self.diffuse.at(own));
        Self::share(self.diffuse(transport, vertex, own), open)
    }

    /// Share of transport `open` that is left where there is `left`; both may ring below 0.
    pub(super) fn share(left: f64, open: f64) -> f64 {
        let little = NEXT_TO_NOTHING / PI;
        ((left.max(0.0) + little) / (open.max(0.0) + little)).clamp(0.0, 1.0)
    }
}

/// Both bases in a direction.
pub(super) struct Towards {
    diffuse: Vec<f64>,
    glossy: Vec<f64>,
}

impl Towards {
    /// What diffuse coefficients are in that direction.
    pub(super) fn diffuse(&self, coefficients: &[f64]) -> f64 {
        dot(coefficients, &self.diffuse)
    }

    /// T and V in that direction, which may ring below 0, and V above 1, of a vertex
    /// with those coefficients.
    pub(super) fn of(&self, [diffuse, glossy]: &[Vec<f64>; 2]) -> [f64; 2] {
        [dot(diffuse, &self.diffuse), dot(glossy, &self.glossy)]
    }
}

/// Coefficients of T and V of a vertex.
pub(super) fn coefficients(transport: &Transport, vertex: usize) -> [Vec<f64>; 2] {
    [
        wide(transport.diffuse_of(vertex)),
        wide(transport.glossy_of(vertex)),
    ]
}

/// Coefficients in f64.
fn wide(row: &[f32]) -> Vec<f64> {
    row.iter().map(|v| f64::from(*v)).collect()
}

/// Triangles over which transport changes by more than half of what an open surface
/// has: between such vertices interpolation says little.
pub(super) fn coarse_triangles(body: &Body<'_>) -> usize {
    let Some(transport) = body.sides.first() else {
        return 0;
    };
    if !body.object.casts || !body.object.receives {
        return 0;
    }
    let mesh = body
        .object
        .rest
        .as_ref()
        .map_or(&body.object.mesh, |r| &r.mesh);
    let list = mesh.shading_vertices();
    let apart = |a: u32, b: u32| {
        let [a, b] = [a, b].map(|i| transport.diffuse_of(i as usize));
        let squares = a
            .iter()
            .zip(b)
            .map(|(a, b)| f64::from(a - b) * f64::from(a - b));
        squares.sum::<f64>()
    };
    let lobe = cosine_power(1.0, transport.settings.bands);
    let open: f64 = (lobe.iter().enumerate())
        .map(|(l, v)| v * v * (2 * l + 1) as f64 / (4.0 * PI * PI * PI))
        .sum();
    let vertices = transport.vertices() as u32;
    let coarse = |t: &&[u32; 3]| {
        let [a, b, c] = **t;
        t.iter().all(|i| *i < vertices)
            && apart(a, b).max(apart(b, c)).max(apart(c, a)) > 0.25 * open
    };
    list.triangles.iter().filter(coarse).count()
}

/// A vertex of a surface: position relative to the view's origin, and normal.
pub(super) fn vertex_of(surface: &SurfaceDraw<'_>, vertex: u32) -> ([f32; 3], [f32; 3]) {
    let at = vertex as usize * STRIDE;
    let row = &surface.vertices().data[at..at + STRIDE];
    ([row[0], row[1], row[2]], [row[3], row[4], row[5]])
}

/// The same normal as a vector.
pub(super) fn normal_of(surface: &SurfaceDraw<'_>, vertex: u32, sign: f64) -> DVec3 {
    widen(vertex_of(surface, vertex).1).normalize_or_zero() * sign
}
