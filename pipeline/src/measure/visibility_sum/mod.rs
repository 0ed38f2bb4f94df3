//! What soft shadow volumes add up at one receiver, edge by edge, in f64.
//!
//! Papers III and IV (docs/papers.md): seen from a receiver, `V = 1 - w + sum s c`, where
//! w counts the casters' layers before the light's centre, c is the coverage of a
//! silhouette edge, and s its sign. Here each summand can be looked at, and what is wrong
//! with the sum has a name ([`Cause`]).

mod causes;
mod seen;

use glam::DVec3;

pub use causes::{Cause, Causes};
pub use seen::{SeenEdge, SeenLight, SeenTriangle};

use crate::geometry::area_light::{AreaLight, AreaLightError};
use crate::geometry::caster::CasterPolicy;
use crate::geometry::coverage::{LightPlane, LightSegment, Projection, SphereOutline, umbra_side};
use crate::geometry::wedge::{Construction, Wedge, WedgeStatistics};
use crate::parts::casters;
use crate::technique::TechniqueError;
use crate::truth::oracle::hard::HardOracle;
use crate::world::light::{HardLight, LightShape};
use crate::world::scene::Scene;

/// A silhouette edge of a caster, seen from the centre of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SilhouetteEdge {
    /// Index into [`Scene::objects`].
    pub object: usize,
    /// Positions of the object's mesh that it joins.
    pub vertices: [u32; 2],
    /// Ends, world space, the occluder on the left seen from the light.
    pub ends: [DVec3; 2],
}

/// Why there is no sum.
#[derive(Debug, thiserror::Error)]
pub enum SumError {
    /// The scene has fewer lights.
    #[error("light {light}: the scene has {count}; valid are 0 to {}", count.saturating_sub(1))]
    NoSuchLight {
        /// The number asked for.
        light: usize,
        /// How many there are.
        count: usize,
    },
    /// The light is of a kind whose coverage is not added up.
    #[error("light {light} is {kind}; valid are rectangles, discs and spheres")]
    Light {
        /// Its number.
        light: usize,
        /// What it is.
        kind: &'static str,
    },
    /// The light has no area.
    #[error("light {light}: {source}")]
    Area {
        /// Its number.
        light: usize,
        /// Why.
        source: AreaLightError,
    },
    /// A caster has no silhouette.
    #[error(transparent)]
    Caster(#[from] TechniqueError),
}

/// A side of a light, and the penumbrae before it.
#[derive(Clone, Debug)]
struct Side {
    light: AreaLight,
    /// Edge after edge.
    penumbrae: Vec<Penumbra>,
}

/// Where a part of an edge can be seen before the light.
#[derive(Clone, Debug)]
struct Penumbra {
    /// Number of its edge.
    edge: usize,
    wedge: Wedge,
}

/// The casters of a scene before one area light.
#[derive(Clone, Debug)]
pub struct VisibilitySum {
    plane: LightPlane,
    /// Two of a flat light, which shines to both.
    sides: Vec<Side>,
    edges: Vec<SilhouetteEdge>,
    /// Counts what hides the centre.
    hard: HardOracle,
    /// Triangles of casters, with their object.
    triangles: Vec<(usize, [DVec3; 3])>,
}

impl VisibilitySum {
    /// Prepares the sum for light number `light`, spheres seen as large as they look.
    ///
    /// # Errors
    /// There is no such light, it is no rectangle, disc or sphere, or a caster is not
    /// closed.
    pub fn new(scene: &Scene, light: usize) -> Result<Self, SumError> {
        let count = scene.lights.len();
        let source = scene.lights.get(light);
        let source = source.ok_or(SumError::NoSuchLight { light, count })?;
        let plane = LightPlane::new(&source.shape, SphereOutline::Seen);
        let kind = kind_of(&source.shape);
        let plane = plane.ok_or(SumError::Light { light, kind })?;
        let area =
            AreaLight::new(&source.shape).map_err(|source| SumError::Area { light, source })?;
        let centre = HardLight::Point(plane.centre());
        let objects = scene.objects.iter().enumerate().filter(|(_, o)| o.casts);
        let triangles = objects.flat_map(|(number, o)| {
            let all = 0..o.mesh.triangles().len();
            all.map(move |t| (number, o.mesh.corners(t)))
        });
        let edges = silhouette_edges(scene, centre)?;
        let lights = match area {
            AreaLight::Sphere { .. } => vec![area],
            flat => vec![flat.clone(), flat.reversed()],
        };
        let sides = lights.into_iter().map(|light| Side::new(light, &edges));
        Ok(Self {
            plane,
            sides: sides.collect(),
            edges,
            hard: HardOracle::new(scene, centre),
            triangles: triangles.collect(),
        })
    }

    /// All silhouette edges, caster after caster: their places are their numbers.
    pub fn edges(&self) -> &[SilhouetteEdge] {
        &self.edges
    }

    /// The light's centre.
    pub fn centre(&self) -> DVec3 {
        self.plane.centre()
    }

    /// Whether coverage is of a square, not of a disc.
    pub fn is_square(&self) -> bool {
        matches!(self.plane, LightPlane::Rectangle { .. })
    }

    /// The penumbra wedges of edge number `edge`, on each side to which the light shines.
    ///
    /// # Panics
    /// There is no such edge.
    pub fn wedges(&self, edge: usize, construction: Construction) -> Vec<Wedge> {
        let ends = self.edges[edge].ends;
        let statistics = &mut WedgeStatistics::default();
        let sides = self.sides.iter();
        let wedges = sides.flat_map(|s| Wedge::of_edge(construction, &s.light, ends, statistics));
        wedges.collect()
    }

    /// What a receiver sees of the light; `None` in the light's plane or inside a sphere.
    pub fn seen_from(&self, receiver: DVec3) -> Option<SeenLight> {
        let projection = self.plane.seen_from(receiver)?;
        let penumbrae = self.side_of(receiver).penumbrae.iter();
        let seen = penumbrae.filter_map(|p| self.seen(&projection, p, receiver));
        Some(SeenLight {
            is_square: self.is_square(),
            centre_hidden: self.hard.shadow_count_at(receiver),
            edges: seen.collect(),
        })
    }

    /// The share, signed, that edge number `edge` adds at a receiver.
    pub fn contribution(&self, edge: usize, receiver: DVec3) -> f64 {
        let Some(projection) = self.plane.seen_from(receiver) else {
            return 0.0;
        };
        let seen = self.side_of(receiver).of_edge(edge).iter();
        let seen = seen.filter_map(|p| self.seen(&projection, p, receiver));
        seen.map(|s| s.contribution()).sum()
    }

    /// Triangles of casters between a receiver and the light, as they look on the light.
    pub fn triangles_seen_from(&self, receiver: DVec3) -> Vec<SeenTriangle> {
        let Some(projection) = self.plane.seen_from(receiver) else {
            return Vec::new();
        };
        let side = &self.side_of(receiver).light;
        let seen = self.triangles.iter();
        seen.filter_map(|(object, corners)| SeenTriangle::of(&projection, side, *object, corners))
            .collect()
    }

    /// The side of the light that shines on a receiver.
    fn side_of(&self, receiver: DVec3) -> &Side {
        let front = |s: &&Side| {
            let height = |n: DVec3| n.dot(receiver - s.light.centre());
            s.light.normal().is_none_or(|n| height(n) > 0.0)
        };
        self.sides.iter().find(front).unwrap_or(&self.sides[0])
    }

    fn seen(
        &self,
        projection: &Projection,
        penumbra: &Penumbra,
        receiver: DVec3,
    ) -> Option<SeenEdge> {
        if !penumbra.may_hold(receiver, self.sides[0].light.bounding_radius()) {
            return None;
        }
        let on_light: LightSegment = projection.clip(penumbra.wedge.edge)?;
        let edge = &self.edges[penumbra.edge];
        Some(SeenEdge {
            number: penumbra.edge,
            object: edge.object,
            on_light,
            coverage: Projection::covered(on_light, self.is_square()),
            inside: umbra_side(self.centre(), edge.ends, receiver),
        })
    }
}

impl Side {
    fn new(light: AreaLight, edges: &[SilhouetteEdge]) -> Self {
        let statistics = &mut WedgeStatistics::default();
        let mut penumbrae = Vec::new();
        for (number, edge) in edges.iter().enumerate() {
            let wedges = Wedge::of_edge(Construction::Exact, &light, edge.ends, statistics);
            penumbrae.extend(wedges.into_iter().map(|wedge| Penumbra {
                edge: number,
                wedge,
            }));
        }
        Self { light, penumbrae }
    }

    fn of_edge(&self, edge: usize) -> &[Penumbra] {
        let first = self.penumbrae.partition_point(|p| p.edge < edge);
        let last = self.penumbrae.partition_point(|p| p.edge <= edge);
        &self.penumbrae[first..last]
    }
}

/// How far outside a penumbra a receiver may be, in radii of the light, before it is left
/// out: more than rounding.
const NEAR: f64 = 1e-6;

impl Penumbra {
    /// Whether the edge may be seen before the light.
    fn may_hold(&self, receiver: DVec3, radius: f64) -> bool {
        let volume = &self.wedge.volume;
        // Half-spaces, of edges that touch the light, may have no planes.
        let mut planes = volume.planes().iter();
        planes.all(|plane| plane.distance(receiver) >= -NEAR * radius)
    }
}

/// What a light is, in words.
fn kind_of(shape: &LightShape) -> &'static str {
    match shape {
        LightShape::Polygon(_) => "a polygon",
        LightShape::Point { .. } => "a point",
        LightShape::Directional { .. } => "directional",
        LightShape::Rectangle { .. } | LightShape::Disc { .. } | LightShape::Sphere { .. } => {
            "without area"
        }
    }
}

fn silhouette_edges(scene: &Scene, light: HardLight) -> Result<Vec<SilhouetteEdge>, SumError> {
    let mut edges = Vec::new();
    for caster in casters::examine(scene, CasterPolicy::AsObjectsSay)? {
        let mesh = &caster.object.mesh;
        let silhouette = caster.silhouette(light).edges.into_iter();
        edges.extend(silhouette.map(|vertices| SilhouetteEdge {
            object: caster.number,
            vertices,
            ends: vertices.map(|i| mesh.position(i)),
        }));
    }
    Ok(edges)
}
