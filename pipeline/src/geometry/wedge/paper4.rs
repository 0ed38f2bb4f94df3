//! Tight wedges (paper IV, §4.1): the edge is moved as in paper III, but the ends
//! are pyramids, the light reflected through each end.
//!
//! Front and back plane hold the moved edge and touch the light; each side is
//! closed by the faces of its end's pyramid between the corners that front and
//! back plane touch. Those are the two extreme faces when the planes touch
//! opposite corners of a rectangle, as in the paper; when they touch neighbours,
//! one side has one face and the other three, which is what closes the wedge.
//!
//! For spheres the paper keeps the wedge of paper III; a disc's pyramid has the
//! tangent planes of [`super::exact`].

use glam::DVec3;

use super::paper3::{self, Undefined};
use super::{exact, polyhedron::Ends};
use crate::geometry::area_light::AreaLight;

/// Ends of the tight wedge.
///
/// # Errors
/// Where the construction is undefined.
pub fn ends(light: &AreaLight, edge: [DVec3; 2]) -> Result<Ends, Undefined> {
    if let AreaLight::Sphere { centre, radius } = light {
        return paper3::ends(*centre, *radius, edge);
    }
    let moved = paper3::relocated(light.centre(), edge)?;
    match exact::ends(light, moved) {
        two @ Ends::Two(_) => Ok(two),
        _ => Err(Undefined::MeetsLight),
    }
}
