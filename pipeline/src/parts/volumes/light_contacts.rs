//! Warnings of lights whose centre is not free of the casters.

use glam::DVec3;

use crate::geometry::light_contact::{Contact, contact};
use crate::geometry::winding::mesh_winding;
use crate::technique::Warning;
use crate::world::adjacency::EdgeAdjacency;
use crate::world::scene::{Object, Scene};
use crate::world::warning::first_few;

/// How many objects a message names.
const NAMED: usize = 4;

/// A warning if a caster cuts, touches or contains light number `number`.
pub(crate) fn warning(scene: &Scene, number: usize) -> Option<Warning> {
    let light = &scene.lights[number];
    let met = scene.casters().filter_map(|object| {
        let how = contact(light, &object.mesh, || is_closed(object))?;
        let is_room = how == Contact::Inside && holds(object, scene.camera.eye);
        (!is_room).then_some((how, object.name.as_str()))
    });
    let met: Vec<(Contact, &str)> = met.collect();
    let first = met.first()?;
    let names: Vec<String> = met
        .iter()
        .map(|(how, name)| match how {
            Contact::Touches => format!("touched or cut by '{name}'"),
            Contact::Inside => format!("inside '{name}'"),
        })
        .collect();
    let consequence = match first.0 {
        Contact::Inside => "nothing outside sees its centre",
        Contact::Touches => {
            "shadows are taken from its centre, which may be hidden where the rest of it shines; \
             sampled-shadow-volumes takes all of it"
        }
    };
    Some(Warning {
        code: "light-in-caster",
        count: met.len(),
        message: format!(
            "light {number} is {}: {consequence}",
            first_few(&names, NAMED)
        ),
    })
}

/// Whether the point is inside the object: with the light inside too it is a room.
fn holds(object: &Object, p: DVec3) -> bool {
    let within = |(low, high): (DVec3, DVec3)| p.cmpge(low).all() && p.cmple(high).all();
    object.mesh.bounds().is_some_and(within) && mesh_winding(&object.mesh, p) != 0
}

fn is_closed(object: &Object) -> bool {
    let mesh = &object.mesh;
    EdgeAdjacency::new(mesh.triangles())
        .closedness(mesh)
        .is_closed()
}
