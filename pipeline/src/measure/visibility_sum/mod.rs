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

use crate::geometry::area_light::{AreaLight, AreaLightError, Clipped};
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

/// The casters of a scene before one area light.
#[derive(Clone, Debug)]
pub struct VisibilitySum {
    plane: LightPlane,
    /// The light's sides: two of a flat one, which shines to both.
    sides: Vec<AreaLight>,
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
        let sides = match area {
            AreaLight::Sphere { .. } => vec![area],
            flat => vec![flat.clone(), flat.reversed()],
        };
        let centre = HardLight::Point(plane.centre());
        let objects = scene.objects.iter().enumerate().filter(|(_, o)| o.casts);
        let triangles = objects.flat_map(|(number, o)| {
            let all = 0..o.mesh.triangles().len();
            all.map(move |t| (number, o.mesh.corners(t)))
        });
        Ok(Self {
            plane,
            sides,
            edges: silhouette_edges(scene, centre)?,
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
        let wedges = sides.flat_map(|s| Wedge::of_edge(construction, s, ends, statistics));
        wedges.collect()
    }

    /// What a receiver sees of the light; `None` in the light's plane or inside a sphere.
    pub fn seen_from(&self, receiver: DVec3) -> Option<SeenLight> {
        let projection = self.plane.seen_from(receiver)?;
        let side = self.side_of(receiver);
        let edges = self.edges.iter().enumerate();
        let seen = edges.flat_map(|(number, edge)| {
            self.parts(side, edge)
                .into_iter()
                .filter_map(move |ends| self.seen(&projection, number, edge, ends, receiver))
        });
        Some(SeenLight {
            is_square: self.is_square(),
            centre_hidden: self.hard.shadow_count_at(receiver),
            edges: seen.collect(),
        })
    }

    /// The share, signed, that edge number `edge` adds at a receiver.
    ///
    /// # Panics
    /// There is no such edge.
    pub fn contribution(&self, edge: usize, receiver: DVec3) -> f64 {
        let Some(projection) = self.plane.seen_from(receiver) else {
            return 0.0;
        };
        let edge_seen = &self.edges[edge];
        let parts = self.parts(self.side_of(receiver), edge_seen).into_iter();
        let seen = parts
            .filter_map(|ends| self.seen(&projection, edge, edge_seen, ends, receiver))
            .map(|s| s.contribution());
        seen.sum()
    }

    /// Triangles of casters between a receiver and the light, as they look on the light.
    pub fn triangles_seen_from(&self, receiver: DVec3) -> Vec<SeenTriangle> {
        let Some(projection) = self.plane.seen_from(receiver) else {
            return Vec::new();
        };
        let side = self.side_of(receiver);
        let seen = self.triangles.iter();
        seen.filter_map(|(object, corners)| {
            SeenTriangle::of(&projection, side, *object, corners)
        })
        .collect()
    }

    /// The side of the light that shines on a receiver.
    fn side_of(&self, receiver: DVec3) -> &AreaLight {
        let front = |s: &&AreaLight| {
            s.normal()
                .is_none_or(|n| n.dot(receiver - s.centre()) > 0.0)
        };
        self.sides.iter().find(front).unwrap_or(&self.sides[0])
    }

    /// What of an edge is before the light.
    fn parts(&self, side: &AreaLight, edge: &SilhouetteEdge) -> Vec<[DVec3; 2]> {
        match side.clip(edge.ends) {
            Clipped::Parts(parts) => parts.into_iter().map(|p| p.ends).collect(),
            Clipped::Behind | Clipped::InPlane => Vec::new(),
        }
    }

    fn seen(
        &self,
        projection: &Projection,
        number: usize,
        edge: &SilhouetteEdge,
        ends: [DVec3; 2],
        receiver: DVec3,
    ) -> Option<SeenEdge> {
        let on_light: LightSegment = projection.clip(ends)?;
        Some(SeenEdge {
            number,
            object: edge.object,
            on_light,
            coverage: Projection::covered(on_light, self.is_square()),
            inside: umbra_side(self.centre(), edge.ends, receiver),
        })
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
    for caster in casters::examine(scene, CasterPolicy::RequireClosed)? {
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
