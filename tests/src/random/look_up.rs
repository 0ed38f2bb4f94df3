//! Random texture look-ups.

use super::Random;
use crate::twin::{
    ColorSource, Coordinate, DepthSource, Discard, LookUp, LookUpKind, MAX_LOOK_UPS, Origin,
    Program, TexelAt,
};

/// Makes a program look up textures in `slots` slots, and show what it finds.
pub(super) fn add(r: &mut Random, p: &mut Program, slots: usize) {
    let count = r.between(1, MAX_LOOK_UPS as i32) as usize;
    for k in 0..count {
        let look_up = look_up(r, k, slots);
        p.look_ups.push(look_up);
    }
    p.color = ColorSource::LookUps;
    p.textures = r.below(slots as u32 + 1) as usize;
    if p.depth.is_some() && r.one_in(2) {
        p.depth = Some(DepthSource::LookUp(r.below(count as u32) as usize));
    }
    match p.discard {
        Some(_) if r.one_in(2) => {
            let k = r.below(count as u32) as usize;
            p.discard = Some(Discard::LookUpBelow(k, r.float(0.0, 1.0)));
        }
        Some(_) => p.discards_first = r.one_in(2),
        None => {}
    }
}

fn look_up(r: &mut Random, earlier: usize, slots: usize) -> LookUp {
    // Once in a while a slot without texture.
    let slot = if r.one_in(16) {
        r.pick(&[7, 8, 100])
    } else {
        r.below(slots as u32) as usize
    };
    let kind = match r.below(16) {
        0..7 => LookUpKind::Sample(coordinate(r, earlier)),
        7 | 8 => LookUpKind::Gradients(
            coordinate(r, earlier),
            [coordinate(r, earlier), coordinate(r, earlier)],
        ),
        9..12 => LookUpKind::Level(coordinate(r, earlier), coordinate(r, earlier)),
        12 | 13 => LookUpKind::Fetch(texel_at(r)),
        14 => LookUpKind::Bits(texel_at(r)),
        _ => LookUpKind::Stencil(texel_at(r)),
    };
    LookUp { slot, kind }
}

fn coordinate(r: &mut Random, earlier: usize) -> Coordinate {
    let same = |v| [v; 3];
    match r.below(6) {
        0 if earlier > 0 => Coordinate {
            of: Origin::LookUp(r.below(earlier as u32) as usize),
            scale: same(r.pick(&[1.0, 0.5, 3.0])),
            offset: same(r.pick(&[0.0, -0.25])),
        },
        // Texels of the order of pixels.
        0..=2 => Coordinate {
            of: Origin::Position,
            scale: r.array(|r| r.pick(&[1.0, 0.125, 0.02, -0.06, 0.3])),
            offset: r.array(|r| r.float(-1.0, 1.0)),
        },
        // A direction, for cubes.
        3 => Coordinate {
            of: Origin::Position,
            scale: [r.float(0.01, 0.2), -r.float(0.01, 0.2), r.pick(&[0.0, 4.0])],
            offset: [
                r.float(-2.0, 0.0),
                r.float(0.0, 2.0),
                r.pick(&[1.0, -1.0, 0.3]),
            ],
        },
        _ => Coordinate {
            of: Origin::Varyings(r.below(5) as usize),
            scale: same(r.pick(&[1.0, 1.0, 2.0, 8.0, -0.5])),
            offset: same(r.pick(&[0.0, 0.0, -1.0, 0.5])),
        },
    }
}

fn texel_at(r: &mut Random) -> TexelAt {
    TexelAt {
        shift: r.below(4),
        offset: [r.between(-3, 1), r.between(-3, 1), r.between(-1, 6)],
        mip: r.pick(&[0, 0, 0, 1, 2, 9]),
    }
}
