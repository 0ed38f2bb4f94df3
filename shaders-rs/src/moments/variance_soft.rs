//! Variance soft shadow maps: the width of the kernel follows from the same means as
//! the shadow (Yang et al. 2010).
//!
//! In a kernel with mean m of which a share P is no nearer than the receiver at d, what
//! is nearer has the mean `(m - P d) / (1 - P)`. The kernel is cut into cells, for the
//! bound says nothing where the mean is beyond the receiver: of such a cell four texels
//! are compared one by one. Cells are held against the receiver's plane, else those off
//! its place would shadow it.

use gnomon_raster::shader::Fragment;
use gnomon_raster::{F32, I32, Lanes, Mask};

use super::bound::chebyshev;
use super::filter::MomentTables;
use crate::bounded::bounded_uniforms;
use crate::convolution::look_up::{IntegerTables, Prefiltered};
use crate::light_view::LightMapping;
use crate::shadow_maps::{Receiver, ShadowFilter, blocker, kernel};
use crate::vector::each2;

/// Soft shadows by means of depth and its square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VarianceSoft {
    /// Half width of the light along the picture's axes, world units.
    pub light_half: [f32; 2],
    /// Cells along a side of each kernel.
    pub cells: u32,
    /// Tables of [`super::Moments::Variance`].
    pub tables: MomentTables,
}
bounded_uniforms!(VarianceSoft { light_half, cells, tables }: |v| [
    ("cells along a side", v.cells.into(), 16),
]);

/// What of a kernel is nearer than a receiver.
#[derive(Clone, Copy)]
struct Nearer<L: Lanes> {
    /// Its share of the kernel.
    share: F32<L>,
    /// That times its mean depth.
    weighted: F32<L>,
}

/// Least share that has a mean depth.
const SOME: f32 = 1e-4;

impl VarianceSoft {
    /// Over all cells of a kernel.
    #[inline(always)]
    fn nearer<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
        half: [F32<L>; 2],
    ) -> Nearer<L> {
        let zero = F32::splat(l, 0.0);
        let cell_share = 1.0 / self.cells as f32;
        let cell_half = each2(
            #[inline(always)]
            |k| half[k] * cell_share,
        );
        let mut sum = Nearer {
            share: zero,
            weighted: zero,
        };
        for row in 0..self.cells {
            for column in 0..self.cells {
                let place = [column, row];
                let centre = each2(
                    #[inline(always)]
                    |k| {
                        let shift = (2 * place[k] + 1) as f32 - self.cells as f32;
                        receiver.at[k] + cell_half[k] * shift
                    },
                );
                let found = self.of_cell(l, f, mapping, receiver, centre, cell_half);
                sum.share = sum.share + found.share;
                sum.weighted = sum.weighted + found.weighted;
            }
        }
        let per_cell = cell_share * cell_share;
        Nearer {
            share: sum.share * per_cell,
            weighted: sum.weighted * per_cell,
        }
    }

    #[inline(always)]
    fn of_cell<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
        centre: [F32<L>; 2],
        half: [F32<L>; 2],
    ) -> Nearer<L> {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let window = self.tables.window(l, mapping, centre, half);
        let inside = IntegerTables::share(&window);
        let some = inside.gt(zero) & f.live();
        if !some.any() {
            return Nearer {
                share: zero,
                weighted: zero,
            };
        }
        let [mean, square, ..] = self.tables.means(l, f, &window);
        let depth = receiver.reference_over(centre);
        let beyond = chebyshev(l, [mean, square], depth, self.tables.least);
        let share = one - beyond;
        let weighted = (mean - beyond * depth).max(zero).min(share * depth);
        let bounded = Nearer {
            share: share * inside,
            weighted: weighted * inside,
        };
        let open = !depth.gt(mean) & some;
        if !open.any() {
            return bounded;
        }
        let compared = four_texels(l, f, receiver, centre, half, open);
        Nearer {
            share: open.select_f32(compared.share, bounded.share),
            weighted: open.select_f32(compared.weighted, bounded.weighted),
        }
    }
}

/// Four texels of a cell, compared one by one.
#[inline(always)]
fn four_texels<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    receiver: &Receiver<L>,
    centre: [F32<L>; 2],
    half: [F32<L>; 2],
    wanted: Mask<L>,
) -> Nearer<L> {
    let zero = F32::splat(l, 0.0);
    let mut sum = Nearer {
        share: zero,
        weighted: zero,
    };
    // Lanes that ask for nothing read nothing.
    let outside = I32::splat(l, -1);
    for row in [-0.5, 0.5] {
        for column in [-0.5, 0.5] {
            let place = [column, row];
            let at = each2(
                #[inline(always)]
                |k| {
                    let texel = (centre[k] + half[k] * place[k]).floor().to_i32();
                    wanted.select_i32(texel, outside)
                },
            );
            let (blocked, depth) = blocker(l, f, receiver, at);
            sum.share = sum.share + blocked.select_f32(F32::splat(l, 0.25), zero);
            sum.weighted = sum.weighted + blocked.select_f32(depth * 0.25, zero);
        }
    }
    sum
}

impl ShadowFilter for VarianceSoft {
    fn textures(&self) -> usize {
        1
    }

    #[inline(always)]
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L> {
        let one = F32::splat(l, 1.0);
        let near = F32::splat(l, mapping.range.near);
        let half = kernel(mapping, self.light_half, near, receiver);
        let found = self.nearer(l, f, mapping, receiver, half);
        let some = found.share.gt(F32::splat(l, SOME));
        f.discard(!some);
        if !(some & f.live()).any() {
            return one;
        }
        let mean = some.select_f32(found.weighted / found.share, receiver.reference);
        let half = kernel(
            mapping,
            self.light_half,
            mapping.range.distance(mean),
            receiver,
        );
        let found = self.nearer(l, f, mapping, receiver, half);
        (one - found.share).clamp(0.0, 1.0)
    }
}
