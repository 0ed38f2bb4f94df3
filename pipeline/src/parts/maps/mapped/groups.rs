//! Receivers in groups that have pictures of their own, without themselves: a method that
//! takes all that a picture shows for occluders wants occluders and receivers apart.
//!
//! A convex piece hides no light from itself, and has a picture of all others. Everything
//! else shares one of all that casts: what does not cast is not in it, and what casts and is
//! not convex is in it itself.

use std::collections::BTreeMap;

use crate::parts::maps::light_view::Surroundings;
use crate::world::convexity::{is_convex, piece, pieces};
use crate::world::scene::{Object, Scene};

/// Of receivers with a picture of everything.
const SHARED: f32 = 1.0;

/// Objects of more pieces are not taken apart.
const MOST_PIECES: u32 = 64;

/// Groups of a scene's receivers.
pub(super) struct ReceiverGroups {
    /// Numbers of the groups of each object's triangles; 0 of what does not receive.
    numbers: BTreeMap<*const Object, Vec<f32>>,
    /// The scene as each group has it: it alone receives, and all others cast.
    scenes: Vec<(f32, Scene)>,
}

/// What pictures are of, and which receivers look shadows up in them.
#[derive(Clone, Copy)]
pub(super) struct Group<'a> {
    /// w of the receivers' positions; `None`: all of them.
    pub(super) number: Option<f32>,
    pub(super) scene: &'a Scene,
    pub(super) around: &'a Surroundings<'a>,
}

/// An object taken apart, and the number of each triangle's part.
fn parts(object: &Object) -> (Vec<Object>, Vec<u32>) {
    let whole = || (vec![object.clone()], vec![0; object.mesh.triangles().len()]);
    if !(object.casts && object.receives) {
        return whole();
    }
    let own = pieces(&object.mesh);
    let count = own.iter().max().map_or(0, |last| last + 1);
    if !(2..=MOST_PIECES).contains(&count) {
        return whole();
    }
    let part = |number: u32| {
        let mesh = piece(&object.mesh, &own, number)?.into();
        let object = object.clone();
        Some(Object { mesh, ..object })
    };
    let apart: Option<Vec<Object>> = (0..count).map(part).collect();
    apart.map_or_else(whole, |apart| (apart, own))
}

/// Objects that cast, receive, and are in their own pictures, being not convex.
pub(crate) fn receivers_in_their_own_pictures(scene: &Scene) -> usize {
    let both = scene.objects.iter().filter(|o| o.casts && o.receives);
    let mixed = |o: &&Object| !parts(o).0.iter().all(|p| is_convex(&p.mesh));
    both.filter(mixed).count()
}

impl ReceiverGroups {
    /// Of the scene whose objects are drawn.
    pub(super) fn new(scene: &Scene) -> Self {
        let mut whole = scene.clone();
        whole.objects.clear();
        let (mut last, mut own, mut numbers) = (SHARED, Vec::new(), BTreeMap::new());
        for object in &scene.objects {
            let (apart, of_triangle) = parts(object);
            let first = own.len();
            for part in apart {
                own.push(match (part.receives, part.casts && is_convex(&part.mesh)) {
                    (false, _) => 0.0,
                    (true, false) => SHARED,
                    (true, true) => {
                        last += 1.0;
                        last
                    }
                });
                whole.objects.push(part);
            }
            let of_triangle = of_triangle.iter().map(|p| own[first + *p as usize]);
            numbers.insert(std::ptr::from_ref(object), of_triangle.collect());
        }
        let all = (SHARED as usize..=last as usize).map(|n| n as f32);
        Self {
            scenes: all.map(|n| (n, seen_by(&whole, &own, n))).collect(),
            numbers,
        }
    }

    /// The group of a triangle; its object must be that of the scene itself.
    pub(super) fn number(&self, object: &Object, triangle: u32) -> f32 {
        let known = self.numbers.get(&std::ptr::from_ref(object));
        known
            .and_then(|k| k.get(triangle as usize))
            .copied()
            .unwrap_or(0.0)
    }

    /// Groups that the camera sees and that something can hide, with their surroundings.
    pub(super) fn around(&self, size: [u32; 2]) -> Vec<(f32, &Scene, Surroundings<'_>)> {
        let all = self.scenes.iter();
        let all = all.map(|(n, scene)| (*n, scene, Surroundings::new(scene, size)));
        all.filter(|(_, _, around)| around.middle().is_some() && !around.casters().is_empty())
            .collect()
    }
}

/// The scene in which group `group` receives and, unless it shares its picture, does not cast.
fn seen_by(scene: &Scene, numbers: &[f32], group: f32) -> Scene {
    let mut own = scene.clone();
    for (object, number) in own.objects.iter_mut().zip(numbers) {
        object.receives = *number == group;
        object.casts &= group == SHARED || *number != group;
    }
    own
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    /// Convex pieces are never in the pictures in which they look shadows up, and everything
    /// else that casts is.
    #[test]
    fn convex_receivers_are_never_in_their_own_pictures() {
        for (name, convex) in [("spheres", true), ("peer-c", false)] {
            let scene = builtin::build(name).unwrap();
            let groups = ReceiverGroups::new(&scene);
            let around = groups.around([48, 32]);
            assert!(
                around.len() > usize::from(convex),
                "{name}: {}",
                around.len()
            );
            assert_eq!(receivers_in_their_own_pictures(&scene) == 0, convex);
            let mut triangles = 0;
            for (number, own, around) in &around {
                let all: usize = own.casters().map(|o| o.mesh.triangles().len()).sum();
                let mine = own.objects.iter().filter(|o| o.receives);
                let mine: usize = mine.map(|o| o.mesh.triangles().len()).sum();
                let cast = around.casters().iter().map(|(_, m)| m.triangles().len());
                assert_eq!(cast.sum::<usize>(), all);
                let whole: usize = scene.casters().map(|o| o.mesh.triangles().len()).sum();
                let left = if *number == SHARED { 0 } else { mine };
                assert_eq!(all + left, whole, "{name} {number}");
                triangles += mine;
            }
            let numbered = scene.objects.iter().flat_map(|o| {
                let count = o.mesh.triangles().len() as u32;
                (0..count).map(|t| groups.number(o, t))
            });
            assert_eq!(numbered.filter(|n| *n > 0.0).count(), triangles, "{name}");
        }
    }
}
