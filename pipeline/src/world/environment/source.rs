//! A map as its file has it: what references sample, and what is seen behind a scene.

use glam::DVec3;

use super::layout::{Picture, Place, turned};
use super::settings::MapSettings;
use super::spread::{Faces, spread};
use crate::world::shape::on_circle;

/// Texels with the directions that they show, turned and scaled as was asked.
#[derive(Clone, Debug, PartialEq)]
pub struct MapSource {
    picture: Picture,
    places: Vec<Place>,
    settings: MapSettings,
    /// Cosine and sine of the turn.
    angle: (f64, f64),
}

impl MapSource {
    pub(super) fn new(picture: Picture, settings: MapSettings) -> Self {
        Self {
            places: picture.places(),
            picture,
            settings,
            angle: on_circle(settings.turn.to_radians()),
        }
    }

    pub(super) fn faces(&self) -> Faces {
        let mut faces = spread(&self.picture, self.settings.side, self.settings.turn);
        for energy in &mut faces.energy {
            *energy = energy.map(|e| e * self.settings.brightness);
        }
        faces
    }

    /// Number of texels that show a direction.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are none, which no map that was read has.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Radiance of texel number `index` times its solid angle, linear RGB.
    pub fn energy(&self, index: usize) -> [f64; 3] {
        let place = &self.places[index];
        let angle = self.picture.angle(place) * self.settings.brightness;
        self.picture.texels[place.texel].map(|v| f64::from(v) * angle)
    }

    /// The direction of length 1 of a point at `inside` (0..1, right and down) of a
    /// texel, and the solid angle there over its mean in the texel.
    pub fn direction(&self, index: usize, inside: [f64; 2]) -> (DVec3, f64) {
        let place = &self.places[index];
        let (towards, density) = self.picture.direction(place, inside);
        let mean = self.picture.angle(place) / self.picture.area(place);
        let towards = turned(towards, self.angle);
        (towards / towards.length(), density / mean)
    }

    /// Radiance towards a direction that is not zero: that of the texel that shows it.
    pub fn radiance(&self, towards: DVec3) -> [f64; 3] {
        let (cos, sin) = self.angle;
        let rgb = self.picture.radiance(turned(towards, (cos, -sin)));
        rgb.map(|v| f64::from(v) * self.settings.brightness)
    }
}
