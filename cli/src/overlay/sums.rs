//! What soft shadow volumes add up at each pixel, for overlays.

use gnomon_pipeline::measure::visibility_sum::{SeenLight, VisibilitySum};
use gnomon_pipeline::truth::oracle::surfaces::{Receiver, Surfaces};
use gnomon_pipeline::world::scene::Scene;
use rayon::prelude::*;

/// The lights of a scene whose visibility is a sum of edges.
pub(super) struct Sums {
    /// Number and sum of each such light.
    pub(super) lights: Vec<(usize, VisibilitySum)>,
    /// Why others are left out, a sentence each.
    left_out: Vec<String>,
}

/// A visible surface.
pub(crate) struct Place<'a> {
    pub(crate) surfaces: &'a Surfaces,
    /// Index over all surfaces.
    pub(crate) surface: u32,
    pub(crate) receiver: Receiver,
}

impl Sums {
    pub(super) fn new(scene: &Scene) -> Self {
        let (mut lights, mut left_out) = (Vec::new(), Vec::new());
        for number in 0..scene.lights.len() {
            match VisibilitySum::new(scene, number) {
                Ok(sum) => lights.push((number, sum)),
                Err(why) => left_out.push(format!("left out: {why}")),
            }
        }
        Self { lights, left_out }
    }

    /// What the legend says about lights.
    pub(super) fn notes(&self) -> Vec<String> {
        let edges: usize = self.lights.iter().map(|(_, s)| s.edges().len()).sum();
        let mut notes = vec![format!(
            "in f64, of {} area lights with {edges} silhouette edges, whatever technique drew the picture",
            self.lights.len()
        )];
        notes.extend(self.left_out.iter().cloned());
        notes
    }

    /// What each light looks like from a place, where it is seen.
    pub(super) fn seen_from(&self, place: &Place<'_>) -> impl Iterator<Item = SeenLight> + '_ {
        let point = place.receiver.point;
        self.lights
            .iter()
            .filter_map(move |(_, s)| s.seen_from(point))
    }
}

/// What `of` finds at each pixel of a picture; nothing where no surface is.
pub(crate) fn each_pixel<T: Send>(
    scene: &Scene,
    size: [u32; 2],
    of: impl Fn(&Place<'_>) -> T + Sync,
) -> Vec<Option<T>> {
    let surfaces = Surfaces::new(scene);
    let rays = scene.camera.eye_rays(size[0], size[1]);
    let at = |i: usize| {
        let x = (i % size[0] as usize) as f64 + 0.5;
        let y = (i / size[0] as usize) as f64 + 0.5;
        let hit = surfaces.hit(&rays, x, y)?;
        Some(of(&Place {
            surface: surfaces.index_of(&hit),
            receiver: surfaces.receiver_of(&hit, &rays, x, y),
            surfaces: &surfaces,
        }))
    };
    let pixels = size[0] as usize * size[1] as usize;
    (0..pixels).into_par_iter().map(at).collect()
}
