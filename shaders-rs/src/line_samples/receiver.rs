//! Receivers in the light's coordinates, and the lines as they have them.

use gnomon_raster::math::{dot3, length};
use gnomon_raster::shader::Fragment;
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, Mask};

use super::{EDGES, LINES, LineSamples, MOST_CORNERS, MOST_LINES};

/// Sixteen receivers.
pub(super) struct Receiver<L: Lanes> {
    /// Relative to the view's origin.
    pub(super) world: [F32<L>; 3],
    /// Relative to the source's origin, in its axes.
    pub(super) at: [F32<L>; 3],
    /// From the light's centre: along lines, across them.
    pub(super) x: F32<L>,
    pub(super) y: F32<L>,
    /// Out of the light's plane, with its sign; and without.
    pub(super) side: F32<L>,
    pub(super) z: F32<L>,
    /// 1 over z.
    pub(super) inverse: F32<L>,
    /// -1 behind the light, where all is seen the other way round.
    pub(super) mirror: F32<L>,
    /// Of a sphere the axes of the disc that is seen.
    pub(super) turned: [[F32<L>; 3]; 3],
    /// Size of that disc; 1 of flat lights.
    pub(super) scale: F32<L>,
    /// In a sphere.
    pub(super) inside: Mask<L>,
    /// Number of the own plane; -1 on what casts nothing.
    pub(super) own: F32<L>,
    /// Its normal on the side seen, in the light's coordinates.
    normal: [F32<L>; 3],
    has_own: Mask<L>,
    /// Receivers whose own plane cuts the light, and where D is counted for them.
    pub(super) cut: Mask<L>,
    pub(super) anchor: [F32<L>; 2],
    /// Sum of the lengths of lines of which all is seen.
    pub(super) whole: F32<L>,
    /// D at the anchor.
    pub(super) base: F32<L>,
    /// Receivers that do not know it.
    pub(super) uncounted: Mask<L>,
    /// How far a volume may be drawn from where it is, times the distance from the light.
    pub(super) slack: F32<L>,
}

/// Least distance from the light's plane.
const LEAST: f32 = 1e-30;
/// Share of a pixel's size that volumes may be off, and a factor for edges aslant.
const OFF: f32 = 4.0 / 64.0;

impl LineSamples {
    /// Receivers at positions `texel`, with the stencil's count.
    #[inline(always)]
    pub(super) fn receiver<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        texel: [F32<L>; 4],
        count: F32<L>,
    ) -> Receiver<L> {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let world = [texel[0], texel[1], texel[2]];
        let from = each3(
            #[inline(always)]
            |i| world[i] - self.source.origin[i],
        );
        let at = each3(
            #[inline(always)]
            |k| uniform_dot(self.source.axes[k], from),
        );
        let own = texel[3] - 2.0;
        let mut receiver = Receiver {
            world,
            at,
            x: at[0] + self.source.offset[0],
            y: at[1] + self.source.offset[1],
            side: at[2] + self.source.offset[2],
            z: one,
            inverse: one,
            mirror: one,
            turned: [[zero; 3]; 3],
            scale: one,
            inside: Mask::splat(l, false),
            own,
            normal: [zero; 3],
            has_own: own.ge(zero),
            cut: Mask::splat(l, false),
            anchor: [zero; 2],
            whole: one,
            base: count,
            uncounted: Mask::splat(l, false),
            slack: zero,
        };
        if self.source.radius > 0.0 {
            self.turn_to(l, &mut receiver);
        }
        let behind = receiver.side.lt(zero);
        receiver.mirror = behind.select_f32(-one, one);
        receiver.z = receiver.side.abs().max(F32::splat(l, LEAST));
        receiver.inverse = one / receiver.z;
        receiver.slack = self.slack(l, &receiver) * receiver.z;
        if !self.counted {
            receiver.uncounted = count.ne(zero);
        }
        receiver.whole = receiver.scale * self.whole;
        self.look_before_own_plane(l, f, &mut receiver);
        receiver
    }

    /// The disc in place of a sphere.
    #[inline(always)]
    fn turn_to<L: Lanes>(&self, l: L, r: &mut Receiver<L>) {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let away = [r.x, r.y, r.side];
        let square = dot3(away, away).max(F32::splat(l, LEAST));
        let distance = square.sqrt();
        let z = each3(
            #[inline(always)]
            |i| away[i] / distance,
        );
        // An axis that z is not along.
        let upright = z[1].abs().lt(F32::splat(l, 0.7));
        let least = [
            upright.select_f32(zero, one),
            upright.select_f32(one, zero),
            zero,
        ];
        let x = cross(z, least);
        let long = length(x);
        let x = each3(
            #[inline(always)]
            |i| x[i] / long,
        );
        r.turned = [x, cross(z, x), z];
        let share = F32::splat(l, self.source.radius * self.source.radius) / square;
        r.inside = share.ge(one);
        let seen = (one - share).max(F32::splat(l, 1e-7)).sqrt();
        r.scale = F32::splat(l, self.source.radius) / seen;
        (r.x, r.y, r.side) = (zero, zero, distance);
    }

    /// A direction in the light's coordinates from one in the source's axes.
    #[inline(always)]
    pub(super) fn turned<L: Lanes>(&self, r: &Receiver<L>, d: [F32<L>; 3]) -> [F32<L>; 3] {
        if self.source.radius > 0.0 {
            return each3(
                #[inline(always)]
                |k| dot3(r.turned[k], d),
            );
        }
        d
    }

    /// How far hard volumes may be off around a receiver: as far as positions of neighbours
    /// differ in a part of a pixel, and by the steps of depth.
    #[inline(always)]
    fn slack<L: Lanes>(&self, l: L, r: &Receiver<L>) -> F32<L> {
        let mut step = F32::splat(l, 0.0);
        let mut square = step;
        for k in 0..3 {
            let across = r.world[k].quad_ddx().abs();
            let down = r.world[k].quad_ddy().abs();
            step = step.max(across).max(down);
            let from_eye = r.at[k] - self.source.eye[k];
            square = square + from_eye * from_eye;
        }
        step * OFF + square * self.depth_step
    }

    /// Finds the own plane, whether it cuts the light, and then the middle of the longest
    /// part of a line before it.
    #[inline(always)]
    fn look_before_own_plane<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>, r: &mut Receiver<L>) {
        if !r.has_own.any() {
            return;
        }
        let zero = F32::splat(l, 0.0);
        let number = r.has_own.select_f32(r.own, zero).to_i32() + I32::splat(l, self.planes as i32);
        let [x, y, z, _] = self.table(EDGES).read(l, f, EDGES, number);
        let to_eye = each3(
            #[inline(always)]
            |k| F32::splat(l, self.source.eye[k]) - r.at[k],
        );
        let averted = dot3([x, y, z], to_eye).lt(zero);
        let normal = self.turned(r, [x, y, z]);
        r.normal = each3(
            #[inline(always)]
            |k| averted.select_f32(-normal[k], normal[k]),
        );
        let (mut longest, mut sum) = (zero, zero);
        for k in 0..self.lines.min(MOST_LINES) {
            let [y, left, right, _] = self.one(f, LINES, k);
            let y = r.scale * y;
            let whole = [r.scale * left, r.scale * right];
            let [low, high] = self.before(l, r, y, whole);
            r.cut = r.cut | (r.has_own & (low.ne(whole[0]) | high.ne(whole[1])));
            let long = high - low;
            sum = sum + long;
            let longer = r.has_own & long.gt(longest);
            longest = longer.select_f32(long, longest);
            let middle = (low + high) * 0.5;
            r.anchor = [
                longer.select_f32(middle, r.anchor[0]),
                longer.select_f32(y, r.anchor[1]),
            ];
        }
        r.anchor = [
            r.cut.select_f32(r.anchor[0], zero),
            r.cut.select_f32(r.anchor[1], zero),
        ];
        r.uncounted = r.uncounted | (r.cut & longest.gt(zero));
        self.take_share_before_own_plane(l, f, r, sum);
    }

    /// Of a polygon that the own plane cuts, the area before it is known: lines that are
    /// seen up to there, whose lengths give `sum`, are worth that.
    #[inline(always)]
    fn take_share_before_own_plane<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        r: &mut Receiver<L>,
        sum: F32<L>,
    ) {
        if !r.cut.any() || self.corners == 0 || self.sums.steps > 0 {
            return;
        }
        let zero = F32::splat(l, 0.0);
        let (mut twice, mut left, mut entered) = (zero, [zero; 2], [zero; 2]);
        for k in 0..self.corners.min(MOST_CORNERS) {
            let [ax, ay, bx, by] = self.one(f, LINES, self.lines.min(MOST_LINES) + k);
            let (a, b) = (self.height(r, [ax, ay]), self.height(r, [bx, by]));
            let (first, second) = (a.ge(zero), b.ge(zero));
            let along = a / (a - b);
            let x = along * (bx - ax) + ax;
            let y = along * (by - ay) + ay;
            let from = [
                first.select_f32(F32::splat(l, ax), x),
                first.select_f32(F32::splat(l, ay), y),
            ];
            let to = [
                second.select_f32(F32::splat(l, bx), x),
                second.select_f32(F32::splat(l, by), y),
            ];
            let part = from[0] * to[1] - from[1] * to[0];
            twice = twice + (first | second).select_f32(part, zero);
            let (leaves, enters) = (first & !second, second & !first);
            left = [leaves.select_f32(x, left[0]), leaves.select_f32(y, left[1])];
            entered = [
                enters.select_f32(x, entered[0]),
                enters.select_f32(y, entered[1]),
            ];
        }
        twice = twice + (left[0] * entered[1] - left[1] * entered[0]);
        let some = r.cut & twice.gt(zero) & sum.gt(zero);
        let whole = sum * (F32::splat(l, self.double_area) / twice);
        r.whole = some.select_f32(whole, r.whole);
    }

    /// How far a point of the light is before the own plane.
    #[inline(always)]
    fn height<L: Lanes>(&self, r: &Receiver<L>, [x, y]: [f32; 2]) -> F32<L> {
        let n = r.normal;
        (n[0] * (-r.x + x) + n[1] * (-r.y + y)) - n[2] * r.side
    }

    /// The part of a line before the own plane; empty as from its left end to there.
    #[inline(always)]
    pub(super) fn before<L: Lanes>(
        &self,
        l: L,
        r: &Receiver<L>,
        y: F32<L>,
        [left, right]: [F32<L>; 2],
    ) -> [F32<L>; 2] {
        let zero = F32::splat(l, 0.0);
        let n = r.normal;
        let at_zero = (n[1] * (y - r.y) - n[0] * r.x) - n[2] * r.side;
        let end = -at_zero / n[0];
        let (rises, falls) = (n[0].gt(zero) & r.has_own, n[0].lt(zero) & r.has_own);
        let level = r.has_own & !rises & !falls & at_zero.le(zero);
        let low = rises.select_f32(left.max(end), left);
        let high = falls.select_f32(right.min(end), right);
        [low, level.select_f32(low, high).max(low)]
    }
}

#[inline(always)]
fn uniform_dot<L: Lanes>(a: [f32; 3], b: [F32<L>; 3]) -> F32<L> {
    (b[0] * a[0] + b[1] * a[1]) + b[2] * a[2]
}

#[inline(always)]
pub(super) fn cross<L: Lanes>(a: [F32<L>; 3], b: [F32<L>; 3]) -> [F32<L>; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
