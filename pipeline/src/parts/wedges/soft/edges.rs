//! Silhouette edges of all casters for one light, with what decides sides.
//!
//! One plane per edge, through the light's centre, rounded once: hard shadow
//! quads and penumbrae use its very bits. The eye's own hard count and its sides
//! are taken a hair in front of the eye, in f64, so that an eye on a plane is on
//! one side of it for both. What the near plane cuts out of a caster between eye and
//! surface is kept too ([`near_cap`]).

use glam::DVec3;

use crate::geometry::caster::CasterPolicy;
use crate::geometry::layers::most_layers;
use crate::geometry::outlines::pieces;
use crate::geometry::silhouette::{Orientation, Silhouette};
use crate::geometry::slivers::{Slivers, facing};
use crate::geometry::volume::ShadowVolume;
use crate::geometry::wedge::hard_plane;
use crate::geometry::winding::volume_winding;
use crate::parts::casters::{self, Examined};
use crate::parts::volumes::near_cap::{self, CapTriangle};
use crate::parts::volumes::near_pyramid::NearPyramid;
use crate::technique::TechniqueError;
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::HardLight;
use crate::world::mesh::{Mesh, narrow};
use crate::world::scene::{Camera, Scene};

/// A silhouette edge.
pub(crate) struct SoftEdge {
    /// Ends, world space, the occluder on the left seen from the light.
    pub(crate) ends: [DVec3; 2],
    /// Normal of its hard plane, out of the umbra; zero where the edge points at
    /// the light and has none.
    pub(crate) normal: [f32; 3],
    /// Whether the eye is on the umbra side.
    pub(crate) eye_inside: bool,
}

/// Silhouettes of one or all casters.
#[derive(Default)]
pub(crate) struct Silhouettes {
    /// Edges, caster after caster.
    pub(crate) edges: Vec<SoftEdge>,
    /// How many casters hide the light's centre from the eye.
    pub(crate) eye_count: i32,
    /// Lit triangles that the near plane may cut away.
    pub(crate) near_caps: Vec<CapTriangle>,
}

/// The casters of a scene, examined once for all lights.
pub(crate) struct SoftCasters<'a> {
    pub(super) camera: &'a Camera,
    before_near_plane: NearPyramid,
    pub(super) examined: Vec<Examined<'a>>,
}

impl<'a> SoftCasters<'a> {
    /// All casters of `scene`.
    pub(crate) fn new(
        scene: &'a Scene,
        size: [u32; 2],
        policy: CasterPolicy,
    ) -> Result<Self, TechniqueError> {
        Ok(Self {
            camera: &scene.camera,
            before_near_plane: NearPyramid::before_near_plane(&scene.camera, size),
            examined: casters::examine(scene, policy)?,
        })
    }

    /// The size of the largest caster; infinite without any.
    pub(crate) fn size(&self) -> f64 {
        let bounds = self.examined.iter().filter_map(|e| e.object.mesh.bounds());
        let sizes = bounds.map(|(low, high)| (high - low).length());
        sizes.reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// How many umbrae may lie over one another, of the light at `centre`.
    pub(crate) fn most_layers(&self, centre: DVec3) -> usize {
        let light = HardLight::Point(centre);
        let volume = |e: &Examined<'_>| e.caster.volume(&e.object.mesh, light);
        let volumes: Vec<ShadowVolume> = self.examined.iter().map(volume).collect();
        most_layers(light, &volumes.iter().collect::<Vec<_>>())
    }

    /// Silhouettes seen from `centre`, of all casters together.
    pub(crate) fn silhouettes(&self, centre: DVec3) -> Silhouettes {
        Silhouettes::together(self.each(centre))
    }

    /// Silhouettes seen from `centre`, caster by caster.
    fn each(&self, centre: DVec3) -> impl Iterator<Item = Silhouettes> {
        let all = 0..self.examined.len();
        all.map(move |index| self.of_caster(index, centre))
    }

    pub(super) fn of_caster(&self, index: usize, centre: DVec3) -> Silhouettes {
        let light = HardLight::Point(centre);
        let examined = &self.examined[index];
        let mesh = &examined.object.mesh;
        let volume = examined.caster.volume(mesh, light);
        self.of_mesh(mesh, &examined.silhouette(light), &volume, centre)
    }

    /// Silhouettes seen from `centre`, outline by outline with its holes, caster
    /// after caster.
    pub(crate) fn outlines(&self, centre: DVec3) -> Vec<Silhouettes> {
        let light = HardLight::Point(centre);
        let pieces = self.examined.iter().flat_map(|examined| {
            let adjacency = examined.caster.adjacency();
            pieces(
                &examined.object.mesh,
                adjacency,
                &examined.orientation(light),
            )
        });
        let parts = pieces.flat_map(|piece| self.parts_of_piece(&piece, centre));
        let all = parts.map(|(silhouettes, _)| silhouettes);
        all.filter(Silhouettes::hides_anything).collect()
    }

    /// Of a surface all of which casts.
    pub(super) fn of_piece(&self, piece: &Mesh, centre: DVec3) -> Silhouettes {
        let light = HardLight::Point(centre);
        let adjacency = EdgeAdjacency::new(piece.triangles());
        let facing = facing(piece, &adjacency, light, Slivers::WithoutArea);
        let orientation = Orientation::generalised(&facing);
        let silhouette = Silhouette::new(piece, &adjacency, &orientation);
        let volume = ShadowVolume::generalised(piece, &adjacency, light);
        self.of_mesh(piece, &silhouette, &volume, centre)
    }

    pub(super) fn of_mesh(
        &self,
        mesh: &Mesh,
        silhouette: &Silhouette,
        volume: &ShadowVolume,
        centre: DVec3,
    ) -> Silhouettes {
        let eye = beside_eye(self.camera);
        let point = |i: u32| mesh.position(i);
        let edges = silhouette.edges.iter();
        Silhouettes {
            edges: edges
                .map(|&[a, b]| SoftEdge::new([point(a), point(b)], centre, eye))
                .collect(),
            eye_count: volume_winding(volume, eye),
            near_caps: near_cap::cut_away(&self.before_near_plane, mesh, volume.light_cap()),
        }
    }
}

impl Silhouettes {
    /// Those of several as one.
    pub(super) fn together(several: impl IntoIterator<Item = Self>) -> Self {
        let mut all = Self::default();
        for caster in several {
            all.edges.extend(caster.edges);
            all.eye_count += caster.eye_count;
            all.near_caps.extend(caster.near_caps);
        }
        all
    }

    pub(super) fn hides_anything(&self) -> bool {
        !self.edges.is_empty() || self.eye_count != 0 || !self.near_caps.is_empty()
    }
}

impl SoftEdge {
    pub(super) fn new(ends: [DVec3; 2], centre: DVec3, eye: DVec3) -> Self {
        let plane = hard_plane(centre, ends);
        let normal = plane.map_or(DVec3::ZERO, |p| p.normal);
        Self {
            ends,
            normal: narrow(normal),
            eye_inside: normal.dot(eye - centre) < 0.0,
        }
    }

    /// Whether the edge has a hard plane; without one it covers nothing.
    pub(crate) fn has_plane(&self) -> bool {
        self.normal != [0.0; 3]
    }

    /// Away from the light through both ends, not normalised.
    pub(crate) fn away(&self, centre: DVec3) -> [DVec3; 2] {
        self.ends.map(|e| e - centre)
    }
}

/// A point next to the eye, on no plane that a scene is likely to have.
pub(super) fn beside_eye(camera: &Camera) -> DVec3 {
    let [right, up, forward] = camera.basis();
    let hair = camera.near * 1e-6;
    camera.eye + (forward + right * 0.389_1 + up * 0.217_3) * hair
}
