//! Which texels a coordinate selects along one axis (texture rules, §2).

use gnomon_raster::AddressMode;

use super::super::convert::rne;

/// `a = if v > lo { v } else { lo }`, then `if a < hi { a } else { hi }`.
pub(super) fn limit(v: f32, lo: f32, hi: f32) -> f32 {
    let a = if v > lo { v } else { lo };
    if a < hi { a } else { hi }
}

/// The one or two texels along an axis.
pub(super) struct Selected {
    /// `None` where the border is.
    pub(super) texels: Vec<Option<i64>>,
    /// Of the second texel.
    pub(super) weight: f32,
}

/// What index a texel has that lies outside.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Outside {
    /// That of the address mode.
    Mode(AddressMode),
    /// Its own: a neighbouring cube face's texel.
    Kept,
}

/// One axis of `n` texels at coordinate `u`.
pub(super) fn select(
    mode: AddressMode,
    outside: Outside,
    linear: bool,
    u: f32,
    n: u32,
) -> Selected {
    let x = wrap(mode, u) * n as f32;
    let (first, texels, weight) = if linear {
        let s = limit(x - 0.5, -2.0, n as f32 + 1.0);
        (s.floor(), 2, s - s.floor())
    } else {
        (limit(x, -1.0, n as f32).floor(), 1, 0.0)
    };
    let first = first as i64;
    Selected {
        texels: (first..first + texels)
            .map(|i| index(outside, linear, i, i64::from(n)))
            .collect(),
        weight,
    }
}

/// Step 1.
fn wrap(mode: AddressMode, u: f32) -> f32 {
    let p = match mode {
        AddressMode::ClampToEdge | AddressMode::ClampToBorder => u,
        AddressMode::Repeat => u - u.floor(),
        AddressMode::MirrorRepeat => {
            let nearest = rne(f64::from(u * 0.5)) as f32;
            (u - 2.0 * nearest).abs()
        }
    };
    if p.is_nan() { 0.0 } else { p }
}

/// Step 4.
fn index(outside: Outside, linear: bool, i: i64, n: i64) -> Option<i64> {
    let inside = (0..n).contains(&i);
    match outside {
        Outside::Kept => Some(i),
        Outside::Mode(AddressMode::Repeat) if linear => Some(i.rem_euclid(n)),
        Outside::Mode(AddressMode::ClampToBorder) => inside.then_some(i),
        Outside::Mode(_) => Some(i.clamp(0, n - 1)),
    }
}
