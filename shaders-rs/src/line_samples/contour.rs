//! Edges that are contours from receivers, and what they cross.

use gnomon_raster::shader::Fragment;
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, Lanes, Mask};

use super::events::Events;
use super::receiver::Receiver;
use super::{EDGE_TESTS, EDGES, KIND_STEP, LISTS, LineSamples, List, MOST_EDGES};

/// An edge relative to receivers: along lines, across them, and towards the light.
pub(super) struct Image<L: Lanes> {
    from: [F32<L>; 3],
    to: [F32<L>; 3],
    /// What D is more on its left.
    jump: F32<L>,
    /// Receivers of which it is a contour.
    some: Mask<L>,
}

/// The spine that lines are reached by: coordinates of an edge's ends across it, and where
/// the edge crosses it.
struct Spine<L: Lanes> {
    from_left: Mask<L>,
    to_left: Mask<L>,
    at: F32<L>,
    /// Receivers that it is crossed for, between them and the light.
    some: Mask<L>,
    /// What D is more beyond, and whether the crossing is before the anchor.
    more: F32<L>,
    before_anchor: Mask<L>,
}

impl LineSamples {
    /// Goes through a list, and adds what its edges do to lines. From the second look on
    /// only events beyond those that have been swept.
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "one loop, whose state is in registers"
    )]
    pub(super) fn collect<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        r: &mut Receiver<L>,
        events: &mut Events<L>,
        list: List,
        look: u32,
        wanted: Mask<L>,
    ) {
        events.begin(l);
        let shared = self.straight && !r.cut.any();
        let find_near = look == 0 && events.first == 0;
        let [first, count] = [self.all[0], self.all[1].min(MOST_EDGES)];
        let all = count > 0;
        if all && find_near {
            self.find_near(l, f, r, list, wanted);
        }
        let list = if all { List { first, count } } else { list };
        let mut numbers = [0.0; 4];
        for k in 0..list.count {
            if k % 4 == 0 {
                numbers = self.one(f, LISTS, list.first + k / 4);
            }
            let number = numbers[k as usize % 4];
            let image = self.image(l, f, r, number);
            let image = Image {
                some: image.some & wanted,
                ..image
            };
            if look == 0 {
                f.count(EDGE_TESTS, wanted);
            }
            if !image.some.any() {
                continue;
            }
            if find_near && !all {
                r.uncounted = r.uncounted | near_anchor(l, r, &image);
            }
            if shared {
                self.cross_shared(l, r, events, &image, look == 0);
            } else {
                cross_each(l, r, events, &image, look == 0);
            }
        }
    }

    /// Goes through a block's list for what passes the anchor; other edges do not.
    #[inline(always)]
    fn find_near<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        r: &mut Receiver<L>,
        list: List,
        wanted: Mask<L>,
    ) {
        let mut numbers = [0.0; 4];
        for k in 0..list.count {
            if k % 4 == 0 {
                numbers = self.one(f, LISTS, list.first + k / 4);
            }
            let mut image = self.image(l, f, r, numbers[k as usize % 4]);
            image.some = image.some & wanted;
            r.uncounted = r.uncounted | near_anchor(l, r, &image);
        }
    }

    /// Edge number `number`, counted from 1.
    #[inline(always)]
    fn image<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        r: &Receiver<L>,
        number: f32,
    ) -> Image<L> {
        let first = (number as u32).saturating_sub(1) << 2;
        let from = self.one(f, EDGES, first);
        let to = self.one(f, EDGES, first + 1);
        let planes = [self.one(f, EDGES, first + 2), self.one(f, EDGES, first + 3)];
        let kind = (from[3] / KIND_STEP).floor();
        let own =
            r.own.eq(F32::splat(l, from[3] - kind * KIND_STEP)) | r.own.eq(F32::splat(l, to[3]));
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let [a, b] = [faces(l, r, planes[0]), faces(l, r, planes[1])];
        let factor = if kind > 0.0 { 2.0 } else { 1.0 };
        let less = if kind > 1.0 { 1.0 } else { 0.0 };
        let jump = (a.select_f32(one, zero) - b.select_f32(one, zero)) * factor - less;
        Image {
            from: self.seen_from_here(l, r, from),
            to: self.seen_from_here(l, r, to),
            jump: jump * r.mirror,
            some: jump.ne(zero) & !own,
        }
    }

    #[inline(always)]
    fn seen_from_here<L: Lanes>(&self, l: L, r: &Receiver<L>, end: [f32; 4]) -> [F32<L>; 3] {
        let away = each3(
            #[inline(always)]
            |k| F32::splat(l, end[k]) - r.at[k],
        );
        let [x, y, z] = self.turned(r, away);
        [x, y, -z * r.mirror]
    }

    /// With one spine for all receivers: what crosses neither it nor lines near is left
    /// out.
    #[inline(always)]
    fn cross_shared<L: Lanes>(
        &self,
        l: L,
        r: &Receiver<L>,
        events: &mut Events<L>,
        image: &Image<L>,
        is_first: bool,
    ) {
        let spine = Spine::new(l, r, image, events.line[0].slope);
        let [low, high] = self.lines_met(l, r, events, image);
        if is_first && spine.some.any() {
            for k in 0..events.lines {
                meet(l, r, events, image, &spine, k, true);
            }
            return;
        }
        for k in low..high {
            meet(l, r, events, image, &spine, k, is_first);
        }
    }

    /// Which line a point is on, between those next to it.
    #[inline(always)]
    fn line_of<L: Lanes>(&self, r: &Receiver<L>, end: &[F32<L>; 3]) -> F32<L> {
        let y = (r.y + r.z * (end[1] / end[2])) / r.scale;
        (y - self.spacing[0]) / self.spacing[1]
    }

    /// The lines that an edge may cross for some receiver, and one more on each side.
    #[inline(always)]
    fn lines_met<L: Lanes>(
        &self,
        l: L,
        r: &Receiver<L>,
        events: &Events<L>,
        image: &Image<L>,
    ) -> [usize; 2] {
        let zero = F32::splat(l, 0.0);
        let before = image.from[2].gt(zero) & image.to[2].gt(zero);
        let most = events.lines as f32;
        let first = events.first as f32;
        let a = self.line_of(r, &image.from) - first;
        let b = self.line_of(r, &image.to) - first;
        let low = before.select_f32(a.min(b), zero).clamp(0.0, most);
        let high = before
            .select_f32(a.max(b), F32::splat(l, most))
            .clamp(-2.0, most);
        let low = image.some.select_f32(low, F32::splat(l, most));
        let high = image.some.select_f32(high, F32::splat(l, -2.0));
        let low = low.floor().to_i32().reduce_min().max(1) - 1;
        let high = (high.floor().to_i32().reduce_max() + 2).clamp(0, events.lines as i32);
        [low as usize, high as usize]
    }
}

/// With a spine for each line.
#[inline(always)]
fn cross_each<L: Lanes>(
    l: L,
    r: &Receiver<L>,
    events: &mut Events<L>,
    image: &Image<L>,
    is_first: bool,
) {
    for k in 0..events.lines {
        let spine = Spine::new(l, r, image, events.line[k].slope);
        meet(l, r, events, image, &spine, k, is_first);
    }
}

/// Where a plane faces receivers.
#[inline(always)]
fn faces<L: Lanes>(l: L, r: &Receiver<L>, [x, y, z, offset]: [f32; 4]) -> Mask<L> {
    let height = (r.at[0] * x + r.at[1] * y) + (r.at[2] * z + offset);
    height.gt(F32::splat(l, 0.0))
}

/// Receivers for which a contour passes the anchor so near that volumes, drawn on a grid of
/// pixels, may count it on the wrong side.
#[inline(always)]
fn near_anchor<L: Lanes>(l: L, r: &Receiver<L>, image: &Image<L>) -> Mask<L> {
    let ([x0, y0, z0], [x1, y1, z1]) = (from_anchor(r, &image.from), from_anchor(r, &image.to));
    let zero = F32::splat(l, 0.0);
    let before = z0.gt(zero) & z1.gt(zero);
    let far = before & (beside(r.slack, x0, x1) | beside(r.slack, y0, y1));
    let area = (x0 * y1 - x1 * y0).abs() * z0.min(z1);
    let size = (x1 * z0 - x0 * z1).abs() + (y1 * z0 - y0 * z1).abs();
    let close = area.le(r.slack * size) | !before;
    image.some & !far & close
}

/// An edge's end from the light's centre, times its distance.
#[inline(always)]
fn from_anchor<L: Lanes>(r: &Receiver<L>, end: &[F32<L>; 3]) -> [F32<L>; 3] {
    let x = end[0] + end[2] * (r.x * r.inverse);
    let y = end[1] + end[2] * (r.y * r.inverse);
    [x, y, end[2]]
}

/// Whether both are beyond a limit on one side.
#[inline(always)]
fn beside<L: Lanes>(limit: F32<L>, a: F32<L>, b: F32<L>) -> Mask<L> {
    a.min(b).gt(limit) | a.max(b).lt(-limit)
}

/// Along an edge, where a coordinate is 0; infinite where it is not.
#[inline(always)]
fn along<L: Lanes>(l: L, from: F32<L>, to: F32<L>) -> (F32<L>, Mask<L>) {
    let zero = F32::splat(l, 0.0);
    let crosses = from.lt(zero) ^ to.lt(zero);
    let at = from / (from - to);
    (
        crosses.select_f32(at, F32::splat(l, f32::INFINITY)),
        crosses,
    )
}

impl<L: Lanes> Spine<L> {
    #[inline(always)]
    fn new(l: L, r: &Receiver<L>, image: &Image<L>, slope: F32<L>) -> Self {
        let zero = F32::splat(l, 0.0);
        let (from, to) = (&image.from, &image.to);
        let offset = ((r.x - r.anchor[0]) - slope * (r.y - r.anchor[1])) * r.inverse;
        let start = (from[0] - slope * from[1]) + from[2] * offset;
        let end = (to[0] - slope * to[1]) + to[2] * offset;
        let (at, crosses) = along(l, start, end);
        let depth = from[2] + (to[2] - from[2]) * at;
        let level = (r.y - r.anchor[1]) * r.inverse;
        let (below, above) = (from[1] + from[2] * level, to[1] + to[2] * level);
        let (at_anchor, _) = along(l, below, above);
        let first = at.lt(at_anchor);
        let start_left = start.lt(zero);
        Self {
            from_left: start_left,
            to_left: end.lt(zero),
            at,
            some: image.some & crosses & depth.gt(zero) & depth.lt(r.z),
            more: start_left.select_f32(image.jump, -image.jump),
            before_anchor: (first & below.lt(zero)) | (!first & above.lt(zero)),
        }
    }
}

/// Adds what an edge does to line `k` of those at hand.
#[inline(always)]
fn meet<L: Lanes>(
    l: L,
    r: &Receiver<L>,
    events: &mut Events<L>,
    image: &Image<L>,
    spine: &Spine<L>,
    k: usize,
    is_first: bool,
) {
    let zero = F32::splat(l, 0.0);
    let (from, to) = (&image.from, &image.to);
    let level = events.line[k].level;
    let (below, above) = (from[1] + from[2] * level, to[1] + to[2] * level);
    let (at, crosses) = along(l, below, above);
    let spine_first = spine.at.lt(at);
    if is_first && spine.some.any() {
        let before = (spine_first & below.lt(zero)) | (!spine_first & above.lt(zero));
        let (more, less) = (before & !spine.before_anchor, !before & spine.before_anchor);
        let change = more.select_f32(spine.more, less.select_f32(-spine.more, zero));
        let line = &mut events.line[k];
        line.depth = line.depth + spine.some.select_f32(change, zero);
    }
    let crosses = crosses & image.some;
    if !crosses.any() {
        return;
    }
    let depth = from[2] + (to[2] - from[2]) * at;
    let between = crosses & depth.gt(zero) & depth.lt(r.z);
    let x = r.x + r.z * ((from[0] + (to[0] - from[0]) * at) / depth);
    let is_left = (spine_first & spine.to_left) | (!spine_first & spine.from_left);
    let change = below.lt(zero).select_f32(-image.jump, image.jump);
    let line = &mut events.line[k];
    let left = between & is_left & x.gt(line.left);
    if is_first {
        line.depth = line.depth - left.select_f32(change, zero);
    }
    let right = between & !is_left & x.lt(line.right);
    let x = x.max(line.left).min(line.right);
    let mut met = left | right;
    if !is_first {
        met = met & x.gt(line.floor);
    }
    if met.any() {
        events.insert(l, k, x, change, met);
    }
}
