//! Events along lines: kept sorted, swept, and where D is 0 added up.

use gnomon_raster::shader::Fragment;
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, Mask};

use super::receiver::Receiver;
use super::{LINES, LineSamples, MOST_CORNERS, MOST_LINES};
use crate::soft_volumes::texel_of;

/// Lines at hand at a time.
pub(super) const AT_ONCE: usize = 16;
/// Events of a line that are kept at a time; more take a second look.
pub(super) const CAPACITY: usize = 8;

/// A line as receivers have it, and how far it has been swept.
#[derive(Clone, Copy)]
pub(super) struct Line<L: Lanes> {
    /// How high receivers are over it, over their distance from the light's plane.
    pub(super) level: F32<L>,
    /// Its ends before the horizon.
    pub(super) left: F32<L>,
    pub(super) right: F32<L>,
    /// Of the spine.
    pub(super) slope: F32<L>,
    /// Where sweeping goes on, and D there less that at the anchor.
    pub(super) at: F32<L>,
    pub(super) depth: F32<L>,
    /// Events up to there have been swept; infinite where none are left.
    pub(super) floor: F32<L>,
    /// Events in use.
    used: usize,
    /// Receivers with more.
    overflown: Mask<L>,
}

/// Lines at hand with their events.
pub(super) struct Events<L: Lanes> {
    /// Number of the first line.
    pub(super) first: u32,
    /// How many.
    pub(super) lines: usize,
    pub(super) line: [Line<L>; AT_ONCE],
    x: [[F32<L>; CAPACITY]; AT_ONCE],
    change: [[F32<L>; CAPACITY]; AT_ONCE],
    /// Receivers that have lines with more events.
    pub(super) overflown: Mask<L>,
}

/// The widest part of a line without event.
pub(super) struct Gap<L: Lanes> {
    pub(super) width: F32<L>,
    /// A point in it.
    pub(super) middle: [F32<L>; 2],
    /// D there less that at the anchor.
    pub(super) depth: F32<L>,
}

impl<L: Lanes> Events<L> {
    #[inline(always)]
    pub(super) fn new(l: L) -> Self {
        let (zero, end) = (F32::splat(l, 0.0), F32::splat(l, f32::INFINITY));
        let none = Mask::splat(l, false);
        let line = Line {
            level: zero,
            left: zero,
            right: zero,
            slope: zero,
            at: zero,
            depth: zero,
            floor: zero,
            used: 0,
            overflown: none,
        };
        Self {
            first: 0,
            lines: 0,
            line: [line; AT_ONCE],
            x: [[end; CAPACITY]; AT_ONCE],
            change: [[zero; CAPACITY]; AT_ONCE],
            overflown: none,
        }
    }

    /// Forgets all events.
    #[inline(always)]
    pub(super) fn begin(&mut self, l: L) {
        let (zero, end) = (F32::splat(l, 0.0), F32::splat(l, f32::INFINITY));
        for k in 0..self.lines {
            for slot in 0..self.line[k].used {
                self.x[k][slot] = end;
                self.change[k][slot] = zero;
            }
            self.line[k].used = 0;
            self.line[k].overflown = Mask::splat(l, false);
        }
        self.overflown = Mask::splat(l, false);
    }

    /// Adds an event where `some`, keeping the order; those at one place are one. The last
    /// gives way where there is no room.
    #[inline(always)]
    pub(super) fn insert(&mut self, l: L, k: usize, x: F32<L>, change: F32<L>, some: Mask<L>) {
        let (zero, end) = (F32::splat(l, 0.0), F32::splat(l, f32::INFINITY));
        let (mut x, mut change) = (some.select_f32(x, end), some.select_f32(change, zero));
        let (xs, changes) = (&mut self.x[k], &mut self.change[k]);
        let line = &mut self.line[k];
        for slot in 0..CAPACITY {
            let (there, its) = (xs[slot], changes[slot]);
            let (same, less) = (x.eq(there), x.lt(there));
            xs[slot] = less.select_f32(x, there);
            changes[slot] = same.select_f32(its + change, less.select_f32(change, its));
            x = same.select_f32(end, less.select_f32(there, x));
            change = same.select_f32(zero, less.select_f32(its, change));
            let left = x.lt(end);
            if slot >= line.used {
                line.used = slot + 1;
            }
            if !left.any() {
                return;
            }
        }
        line.overflown = line.overflown | x.lt(end);
        self.overflown = self.overflown | line.overflown;
    }
}

impl<L: Lanes> Gap<L> {
    #[inline(always)]
    pub(super) fn new(l: L) -> Self {
        let zero = F32::splat(l, 0.0);
        Self {
            width: -F32::splat(l, 1.0),
            middle: [zero; 2],
            depth: zero,
        }
    }
}

impl LineSamples {
    /// Lines number `first` and on, as receivers have them.
    #[inline(always)]
    pub(super) fn place_lines<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        r: &Receiver<L>,
        events: &mut Events<L>,
        [first, count]: [u32; 2],
    ) {
        let zero = F32::splat(l, 0.0);
        events.first = first;
        events.lines = count as usize;
        for k in 0..events.lines {
            let [y, left, right, slope] = self.one(f, LINES, first + k as u32);
            let y = r.scale * y;
            let [low, high] = self.before(l, r, y, [r.scale * left, r.scale * right]);
            let rise = y - r.anchor[1];
            let level = rise.eq(zero);
            let spoke =
                (((low + high) * 0.5) - r.anchor[0]) / level.select_f32(F32::splat(l, 1.0), rise);
            let spoke = level.select_f32(zero, spoke);
            let line = &mut events.line[k];
            line.level = (r.y - y) * r.inverse;
            line.left = low;
            line.right = high;
            line.slope = r.cut.select_f32(spoke, F32::splat(l, slope));
            line.at = low;
        }
    }

    /// Takes the widest gap of lines at hand, if it is wider than that known.
    #[inline(always)]
    pub(super) fn widen<L: Lanes>(
        &self,
        f: &mut Fragment<'_, L>,
        r: &Receiver<L>,
        events: &Events<L>,
        gap: &mut Gap<L>,
    ) {
        for k in 0..events.lines {
            let [y, ..] = self.one(f, LINES, events.first + k as u32);
            let y = r.scale * y;
            let line = &events.line[k];
            let (mut at, mut depth) = (line.left, line.depth);
            for slot in 0..=line.used {
                let last = slot == line.used;
                let next = if last {
                    line.right
                } else {
                    events.x[k][slot].min(line.right)
                };
                let mut wider = (next - at).gt(gap.width);
                if last {
                    wider = wider & !line.overflown;
                }
                gap.width = wider.select_f32(next - at, gap.width);
                // Not the very middle: symmetric scenes have edges there.
                let x = at + (next - at) * 0.437_5;
                gap.middle = [
                    wider.select_f32(x, gap.middle[0]),
                    wider.select_f32(y, gap.middle[1]),
                ];
                gap.depth = wider.select_f32(depth, gap.depth);
                if !last {
                    at = next;
                    depth = depth + events.change[k][slot];
                }
            }
        }
    }

    /// Goes through the events that there are.
    #[inline(always)]
    pub(super) fn sweep<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        base: F32<L>,
        events: &mut Events<L>,
        visible: &mut [F32<L>; 3],
        negative: &mut Mask<L>,
    ) {
        let end = F32::splat(l, f32::INFINITY);
        for k in 0..events.lines {
            let mut line = events.line[k];
            let mut last = end;
            for slot in 0..line.used {
                let x = events.x[k][slot];
                let some = x.lt(end);
                let next = some.select_f32(x, line.at);
                self.pass(
                    l,
                    f,
                    base,
                    events.first + k as u32,
                    (&line, next),
                    visible,
                    negative,
                );
                line.at = next;
                line.depth = line.depth + events.change[k][slot];
                last = x;
            }
            line.floor = line.overflown.select_f32(last, end);
            events.line[k] = line;
        }
    }

    /// What is left of lines behind their last events.
    #[inline(always)]
    pub(super) fn finish<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        base: F32<L>,
        events: &mut Events<L>,
        visible: &mut [F32<L>; 3],
        negative: &mut Mask<L>,
    ) {
        for k in 0..events.lines {
            let line = events.line[k];
            let number = events.first + k as u32;
            self.pass(l, f, base, number, (&line, line.right), visible, negative);
        }
    }

    /// From where a line was swept to, to `next`.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one step of two loops")]
    fn pass<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        base: F32<L>,
        number: u32,
        (line, next): (&Line<L>, F32<L>),
        visible: &mut [F32<L>; 3],
        negative: &mut Mask<L>,
    ) {
        let zero = F32::splat(l, 0.0);
        let depth = line.depth + base;
        let some = next.gt(line.at);
        *negative = *negative | (some & depth.lt(zero));
        let lit = some & depth.eq(zero);
        if !lit.any() {
            return;
        }
        if self.sums.steps == 0 {
            visible[0] = visible[0] + lit.select_f32(next - line.at, zero);
            return;
        }
        let low = self.sum_to(l, f, number, line.at);
        let high = self.sum_to(l, f, number, next);
        for c in 0..3 {
            visible[c] = visible[c] + lit.select_f32(high[c] - low[c], zero);
        }
    }

    /// The image's sum along a line up to x, between those of steps.
    #[inline(always)]
    fn sum_to<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        number: u32,
        x: F32<L>,
    ) -> [F32<L>; 3] {
        let [_, left, right, _] = self.one(f, LINES, number);
        let steps = self.sums.steps as f32;
        let place = ((x - left) * (steps / (right - left))).clamp(0.0, steps);
        let whole = place.floor().min(F32::splat(l, steps - 1.0));
        let part = place - whole;
        let before = self.lines.min(MOST_LINES) + self.corners.min(MOST_CORNERS);
        let row = before + number * (self.sums.steps + 1);
        let at = whole.to_i32() + I32::splat(l, row as i32);
        let table = self.table(LINES);
        let [low, high] = [table.place(l, at), table.place(l, at + I32::splat(l, 1))];
        let low = texel_of(l, f, LINES, low);
        let high = texel_of(l, f, LINES, high);
        each3(
            #[inline(always)]
            |c| low[c] + (high[c] - low[c]) * part,
        )
    }
}
