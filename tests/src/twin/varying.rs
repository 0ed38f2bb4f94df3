//! Interpolated varyings (rules, §6).

use gnomon_raster::MAX_VARYINGS;
use gnomon_raster::shader::Interpolation;

use super::plane::Plane;
use super::setup::Triangle;

enum Source {
    Flat(f32),
    Linear(Plane),
    Perspective(Plane),
}

/// All varyings over one triangle.
pub(super) struct Varyings {
    sources: Vec<Source>,
    inverse_w: Option<Plane>,
}

impl Varyings {
    pub(super) fn new(t: &Triangle, interpolation: &[Interpolation]) -> Self {
        let xy = t.xy();
        let source = |(k, mode): (usize, &Interpolation)| match mode {
            Interpolation::Flat => Source::Flat(t.flat[k]),
            Interpolation::Linear => {
                Source::Linear(Plane::through(xy, t.corners.map(|c| c.vertex.varyings[k])))
            }
            Interpolation::Perspective => Source::Perspective(Plane::through(
                xy,
                t.corners.map(|c| c.vertex.varyings[k] * c.inverse_w),
            )),
        };
        let perspective = interpolation.contains(&Interpolation::Perspective);
        Self {
            sources: interpolation.iter().enumerate().map(source).collect(),
            inverse_w: perspective.then(|| Plane::through(xy, t.corners.map(|c| c.inverse_w))),
        }
    }

    /// Clip-space w at a pixel; 1 without perspective varyings.
    pub(super) fn w(&self, x: u32, y: u32) -> f32 {
        self.inverse_w.as_ref().map_or(1.0, |p| 1.0 / p.at(x, y))
    }

    pub(super) fn at(&self, x: u32, y: u32) -> [f32; MAX_VARYINGS] {
        let w = self.w(x, y);
        let mut v = [0.0; MAX_VARYINGS];
        for (slot, source) in v.iter_mut().zip(&self.sources) {
            *slot = match source {
                Source::Flat(v) => *v,
                Source::Linear(p) => p.at(x, y),
                Source::Perspective(p) => p.at(x, y) * w,
            };
        }
        v
    }
}
