//! The depth test of a block and its write, for whatever the fragments' depths come from.

use super::config::DrawConfig;
use super::target::DepthTile;
use super::{COUNT, TileStageCounters, block, depth};
use crate::simd::{I32, Lanes, Mask, each4};
use crate::state::CompareFunction;
use crate::texture::PACKETS;
use crate::texture::{Block, HIZ_STALE};

/// Pixels whose depth, of packet k `z(k)`, compares as asked with the stored one: of all
/// 64, covered or not, since a branch on which packets matter costs more.
#[inline(always)]
pub(super) fn compare<L: Lanes>(
    l: L,
    f: CompareFunction,
    stored: &Block<u32>,
    z: impl Fn(usize) -> I32<L>,
) -> u64 {
    match f {
        CompareFunction::Less => block::packets(
            #[inline(always)]
            |k| z(k).lt(depth::load(l, stored, k)).bits(),
        ),
        CompareFunction::LessEqual => block::packets(
            #[inline(always)]
            |k| z(k).le(depth::load(l, stored, k)).bits(),
        ),
        CompareFunction::Equal => block::packets(
            #[inline(always)]
            |k| z(k).eq(depth::load(l, stored, k)).bits(),
        ),
        _ => {
            let (mut less, mut equal) = (0, 0);
            for k in 0..PACKETS {
                let (z, s) = (z(k), depth::load(l, stored, k));
                less |= u64::from(z.lt(s).bits()) << (16 * k);
                equal |= u64::from(z.eq(s).bits()) << (16 * k);
            }
            depth::outcome(f, less, equal)
        }
    }
}

/// Writes depth where `mask` is set. zmin/zmax become `span`, that of a plane that covers
/// all of the block, or stale.
#[inline(always)]
#[allow(
    clippy::too_many_arguments,
    reason = "the inputs of one pipeline stage"
)]
pub(super) fn write<L: Lanes>(
    l: L,
    config: &DrawConfig<'_>,
    c: &mut TileStageCounters,
    d: &mut DepthTile<'_>,
    index: usize,
    span: Option<[i32; 2]>,
    mask: u64,
    z: impl Fn(usize) -> I32<L>,
) {
    if COUNT {
        c.accesses.hiz_write += 1;
    }
    if !config.lean {
        block::count(&mut c.accesses.z_write, mask);
    }
    let stored = &mut d.depth[index];
    if COUNT && !passes_only_other_depths(config.compare) {
        let same = each4(
            #[inline(always)]
            |k| {
                let m = Mask::from_bits(l, (mask >> (16 * k)) as u16);
                z(k).eq(depth::load(l, stored, k)) & m
            },
        );
        block::count_lanes(&mut c.events.silent_z_writes, &same);
    }
    for k in 0..PACKETS {
        depth::store(l, stored, k, z(k), (mask >> (16 * k)) as u16);
    }
    [d.hiz_min[index], d.hiz_max[index]] = span.unwrap_or(HIZ_STALE);
}

/// Whether no fragment of the stored depth passes.
#[inline(always)]
fn passes_only_other_depths(f: CompareFunction) -> bool {
    matches!(
        f,
        CompareFunction::Less | CompareFunction::Greater | CompareFunction::NotEqual
    )
}
