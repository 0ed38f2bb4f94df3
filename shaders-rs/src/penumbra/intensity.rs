//! The interpolated intensity inside a wedge (paper I, §4.2, equations (2), (3)).

use gnomon_raster::{F32, Lanes, uniforms};

/// How intensity varies between front and back plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// With the distances to the planes.
    #[default]
    Linear,
    /// `3 s^2 - 2 s^3` of the linear value.
    Smoothstep,
}
uniforms!(enum Interpolation { 0: Linear, 1: Smoothstep });

/// What equation (3) needs besides the distances from the planes. Rates are the
/// absolute cosines between a plane's normal and a direction, which turn
/// distances from the plane into distances along the direction; only their
/// quotients matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntensityRates {
    /// For the direction in each side plane: the back plane's rate over the front's.
    pub back_over_front: [f32; 2],
    /// Along the edge: the first side plane's rate over the second's.
    pub first_over_second: f32,
    /// Linear or smooth.
    pub interpolation: Interpolation,
}
uniforms!(IntensityRates {
    back_over_front,
    first_over_second,
    interpolation
});

/// Distances from the planes of a wedge, not negative, in any common unit.
#[derive(Clone, Copy)]
pub struct Distances<L: Lanes> {
    /// From the front plane.
    pub front: F32<L>,
    /// From the back plane.
    pub back: F32<L>,
    /// From the first side plane.
    pub first: F32<L>,
    /// From the second side plane.
    pub second: F32<L>,
}

impl IntensityRates {
    /// 1 on the front plane and where all distances vanish, 0 on the back plane;
    /// one division (paper I, §4.2).
    #[inline(always)]
    pub fn intensity<L: Lanes>(&self, d: &Distances<L>) -> F32<L> {
        let [k, m] = self.back_over_front;
        let (at_first, at_second) = (d.front * k + d.back, d.front * m + d.back);
        let second = d.second * self.first_over_second;
        let above = d.back * (second * at_second + d.first * at_first);
        let below = (at_first * at_second) * (d.first + second);
        self.interpolation.apply(quotient(above, below))
    }
}

impl Interpolation {
    /// The intensity for the linear one.
    #[inline(always)]
    pub fn apply<L: Lanes>(self, s: F32<L>) -> F32<L> {
        match self {
            Self::Linear => s,
            Self::Smoothstep => (s * s) * (F32::splat(s.lanes(), 3.0) - s * 2.0),
        }
    }
}

/// `above / below` limited to 0..=1; 1 where `below` is 0.
#[inline(always)]
pub(super) fn quotient<L: Lanes>(above: F32<L>, below: F32<L>) -> F32<L> {
    let l = above.lanes();
    let one = F32::splat(l, 1.0);
    let exists = below.gt(F32::splat(l, 0.0));
    exists.select_f32(above / below, one).clamp(0.0, 1.0)
}
