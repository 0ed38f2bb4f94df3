//! What is said of a frame: sizes, and everything that was limited or left out.

use super::bodies::{Body, coarse_triangles};
use super::keeping::Keeping;
use super::settings::Settings;
use super::shadows::MapCounts;
use crate::parts::shadowed_frame::Notes;
use crate::technique::{Figure, Warning};

/// Numbers gathered on the way.
#[derive(Default)]
pub(super) struct Found {
    vertices: usize,
    transport_bytes: usize,
    rays: u64,
    buried: u64,
    lights: usize,
    map_bytes: usize,
    /// Vertices times lights at which transport rang below 0.
    ringing: usize,
    /// Maps that the frame before left, where there is one.
    kept: Option<usize>,
    pub(super) maps: MapCounts,
}

impl Found {
    pub(super) fn of(bodies: &[Body<'_>]) -> Self {
        let sides = || bodies.iter().flat_map(|b| &b.sides);
        Self {
            vertices: sides().map(|t| t.vertices()).sum(),
            transport_bytes: sides().map(|t| t.diffuse_bytes()).sum(),
            rays: sides().map(|t| t.rays).sum(),
            buried: sides().map(|t| t.buried).sum(),
            ..Self::default()
        }
    }

    pub(super) fn lights(&mut self, count: usize, settings: &Settings) {
        self.lights = count;
        let texel = if settings.half_floats { 2 } else { 4 };
        self.map_bytes = (settings.side * settings.side * texel) as usize;
    }

    /// Takes note of what was kept of the frame before.
    pub(super) fn keeping(&mut self, keeping: Option<&Keeping<'_>>) {
        self.kept = keeping.map(Keeping::found);
    }

    /// Counts a transport that is limited to 0.
    pub(super) fn ringing(&mut self, transport: f64) {
        self.ringing += usize::from(transport < 0.0);
    }

    /// Says it.
    pub(super) fn tell(&self, bodies: &[Body<'_>], notes: &mut Notes) {
        let figures = [
            ("deferred lights", self.lights),
            ("transport vertices", self.vertices),
            ("transport bytes", self.transport_bytes),
            ("transport rays", self.rays as usize),
            ("vertices inside their object", self.buried as usize),
            ("occlusion maps", self.maps.maps),
            ("occlusion map bytes", self.maps.maps * self.map_bytes),
            ("maps across their plane", self.maps.across_plane),
            ("transport below 0", self.ringing),
        ];
        let drawn = self.maps.maps - self.maps.left_out;
        let kept = self.kept.map(|kept| {
            [
                ("occlusion maps kept", kept),
                ("occlusion maps drawn", drawn - kept),
            ]
        });
        let figure = |(name, value): (&str, usize)| Figure {
            name: name.to_owned(),
            value: value as f64,
        };
        notes.figures.extend(figures.map(figure));
        notes.figures.extend(kept.into_iter().flatten().map(figure));
        notes.warnings.extend(bodies.iter().filter_map(coarse));
        if self.maps.left_out > 0 {
            let count = self.maps.left_out;
            notes.warnings.push(Warning {
                code: "occlusion-maps-left-out",
                count,
                message: format!(
                    "{count} occlusion maps of one object and light do not fit into an atlas and cast no shadow; use groups=near or a smaller map-size"
                ),
            });
        }
    }
}

/// That a mesh is too coarse for light at its vertices.
fn coarse(body: &Body<'_>) -> Option<Warning> {
    let count = coarse_triangles(body);
    (count > 0).then(|| Warning {
        code: "coarse-transport",
        count,
        message: format!(
            "{count} triangles of '{}' are too large for light at their corners: what the object hides of itself changes by more than half over them; subdivide its mesh",
            body.object.name
        ),
    })
}
