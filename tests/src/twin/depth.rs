//! Depth of fragments (rules, §5).

use gnomon_raster::Format;
use gnomon_raster::state::{DepthBias, Viewport};

use super::convert::{d24, floor_log2, pow2, rne};
use super::plane::{Plane, in_block};
use super::setup::Triangle;

/// Stored form of depth: D24 integers, or bits of floats in 0..=1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    D24,
    Float,
}

impl Encoding {
    pub(super) fn of(format: Option<Format>) -> Self {
        if format == Some(Format::Depth24Stencil8) {
            Self::D24
        } else {
            Self::Float
        }
    }

    /// A depth value in its stored form; limited to 0..=1, NaN is 0.
    pub(super) fn encode(self, v: f32) -> u32 {
        match self {
            Self::D24 => d24(v),
            Self::Float => super::convert::unit(v).to_bits(),
        }
    }

    /// A stored value as shaders see it.
    pub(super) fn decode(self, stored: u32) -> f32 {
        match self {
            Self::D24 => stored as f32 / 16_777_215.0f32,
            Self::Float => f32::from_bits(stored),
        }
    }
}

/// The viewport's depth range, smaller end first.
pub(super) fn range(v: &Viewport) -> [f32; 2] {
    if v.min_depth > v.max_depth {
        [v.max_depth, v.min_depth]
    } else {
        [v.min_depth, v.max_depth]
    }
}

/// A float depth limited to the viewport's range, positive zero for zero.
pub(super) fn limit(z: f32, [lo, hi]: [f32; 2]) -> f32 {
    let z = if z > lo { z } else { lo };
    let z = if z < hi { z } else { hi };
    if z == 0.0 { 0.0 } else { z }
}

/// Depth over one triangle.
pub(super) struct DepthPlane {
    encoding: Encoding,
    plane: Plane,
    bias: f64,
    range: [f32; 2],
    /// The viewport's far end, and whether depth falls towards it.
    far: (f32, bool),
}

impl DepthPlane {
    pub(super) fn new(
        t: &Triangle,
        encoding: Encoding,
        bias: &DepthBias,
        viewport: &Viewport,
    ) -> Self {
        let z = t.corners.map(|c| c.z);
        let plane = Plane::through(t.xy(), z);
        Self {
            encoding,
            bias: offset(bias, &plane, z, encoding),
            plane,
            range: range(viewport),
            far: (
                viewport.max_depth,
                encoding.encode(viewport.min_depth) > encoding.encode(viewport.max_depth),
            ),
        }
    }

    /// Whether the D24 slope is beyond fixed point.
    pub(super) fn is_steep(&self) -> bool {
        let beyond = |g| scaled(g).abs() > pow2(25);
        self.encoding == Encoding::D24 && (beyond(self.plane.gx) || beyond(self.plane.gy))
    }

    /// Stored depth at pixel (x, y), and whether it is beyond the far end before limiting.
    pub(super) fn at(&self, x: u32, y: u32) -> (u32, bool) {
        let base = self.plane.base(x - x % 8, y - y % 8);
        let (ix, iy) = (x % 8, y % 8);
        match self.encoding {
            Encoding::D24 => {
                let [lo, hi] = self.range.map(|v| i64::from(d24(v)));
                let z = self.integer(base + self.bias, ix, iy);
                let beyond = self.is_beyond(self.integer(base, ix, iy), i64::from(d24(self.far.0)));
                (z.max(lo).min(hi) as u32, beyond)
            }
            Encoding::Float => {
                let at = |base| in_block(base, self.plane.gx, self.plane.gy, ix, iy);
                let beyond = self.is_beyond(at(base), self.far.0);
                (limit(at(base + self.bias), self.range).to_bits(), beyond)
            }
        }
    }

    fn is_beyond<T: PartialOrd>(&self, z: T, far: T) -> bool {
        if self.far.1 { z < far } else { z > far }
    }

    fn integer(&self, base: f64, ix: u32, iy: u32) -> i64 {
        if self.is_steep() {
            let z = (base + self.plane.gx * f64::from(ix)) + self.plane.gy * f64::from(iy);
            return rne((z * 16_777_215.0).clamp(-pow2(30), pow2(30))) as i64;
        }
        let base = scaled(base).clamp(-1_677_721_583.0, 1_677_721_583.0) as i64;
        let slope = |g: f64| scaled(g) as i64;
        let fixed =
            base + slope(self.plane.gx) * i64::from(ix) + slope(self.plane.gy) * i64::from(iy);
        (fixed + 16).div_euclid(32)
    }
}

/// `rne(v·16777215·32)`.
fn scaled(v: f64) -> f64 {
    rne(v * 16_777_215.0 * 32.0)
}

fn offset(bias: &DepthBias, plane: &Plane, z: [f32; 3], encoding: Encoding) -> f64 {
    if bias.constant == 0.0 && bias.slope == 0.0 {
        return 0.0;
    }
    let r = match encoding {
        Encoding::D24 => pow2(-24),
        Encoding::Float => float_step(z),
    };
    let steepest = plane.gx.abs().max(plane.gy.abs());
    let b = f64::from(bias.constant) * r + f64::from(bias.slope) * steepest;
    let clamp = f64::from(bias.clamp);
    if clamp > 0.0 {
        b.min(clamp)
    } else if clamp < 0.0 {
        b.max(clamp)
    } else {
        b
    }
}

/// 2^(e − 23), e being the exponent of the largest |z|; 0 if all are 0.
fn float_step(z: [f32; 3]) -> f64 {
    let largest = z.iter().fold(0.0f32, |m, z| m.max(z.abs()));
    if largest == 0.0 {
        0.0
    } else {
        pow2(floor_log2(f64::from(largest)) - 23)
    }
}
